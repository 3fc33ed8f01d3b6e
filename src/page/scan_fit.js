// A scan in the field of a table: chosen or dropped as a file, or pasted; the service fits a profile to it.
import { call } from "./api.js";
import { Chart } from "./chart.js";
import { el, noticing } from "./dom.js";
import { formatQuantity } from "./units.js";

/** Controls below a table that `source` reads. `scan` gives what it found, `write` takes the table of the profile, and
 *  `take` another shape, where one may stand here. */
export function scanFit(source, scan, write, take) {
  const chart = new Chart({
    name: "scan",
    title: "Scan and profile",
    height: 220,
    x: { label: "Radius r", unit: "m" },
    y: { label: "Height of the gap", unit: "m" },
  });
  chart.element.hidden = true;
  const said = el("p", { class: "note", id: "scan-said", "aria-live": "polite" });
  const fit = noticing(async () => {
    await source.settled();
    const reply = await call("POST", "/profiles/fit", scan());
    const points = ({ radius, height }) => radius.map((r, index) => [r, height[index]]);
    chart.draw({
      series: [
        { name: "scan", kind: "bound", points: points(reply.raw) },
        { name: "profile", kind: "pressure", points: points(reply.used) },
      ],
    });
    said.textContent = [summary(reply), ...reply.warnings.map((warning) => warning.message)].join(". ");
    write(reply.profile);
    const offered = take && reply.suggested;
    suggested.hidden = !offered;
    if (offered) {
      suggested.textContent = `Use the ${offered.profile.type} that the scan suggests`;
      suggested.onclick = () => take(offered.profile);
    }
  });
  const suggested = el("button", { type: "button", id: "use-suggested", hidden: true });
  return el(
    "div",
    {},
    el("label", {}, "A scan: a line through the axis, points, or a map, as a file ", source.input),
    el("button", { type: "button", id: "fit-scan", onclick: fit }, "Fit a profile to the scan"),
    said,
    suggested,
    chart.element,
  );
}

/** What a fit says in a sentence. */
function summary({ radius_of_curvature: { value, standard_error: error }, residual, centre }) {
  const radius =
    value === null ? "Flat on the axis" : `Radius ${formatQuantity(value, "m")} ± ${formatQuantity(error, "m", 2)}`;
  const left = `residual ${formatQuantity(residual.rms, "m", 3)}, ${residual.outliers} points left out`;
  return `${radius}, axis at ${formatQuantity(centre.x, "m", 3)}, ${left}`;
}
