// A steady cycle in full: under a load that oscillates too, its harmonics, where it wears, and the load that damps
// most.
import { Refusal, call } from "./api.js";
import { Chart } from "./chart.js";
import { el, figure } from "./dom.js";
import { Fields, NumberField } from "./form_fields.js";
import { FORCE, LENGTH } from "./form_options.js";
import { placesOf } from "./line_contact.js";
import { virginContact } from "./protocol_run.js";
import { study } from "./study.js";
import { formatNumber, formatQuantity } from "./units.js";

/** Radii, or places along x, of the friction work, loads of the search, and harmonics. */
const [RADII, LOADS, HARMONICS] = [100, 60, 5];

/** The figures of a cycle in rows. */
function figureRows(cycle, unit) {
  const ratio = (value) => (value === null ? "–" : formatNumber(value));
  const { best_load: best, harmonics = [] } = cycle;
  const [first] = harmonics;
  const part = ({ in_phase: real, quadrature: other }) => Math.hypot(real, other);
  return [
    figure("Friction work of a cycle", formatQuantity(cycle.dissipated_energy, "J")),
    figure("Loss factor", ratio(cycle.loss_factor)),
    ...(best
      ? [
          figure("Load that damps most", formatQuantity(best.normal_force, "N")),
          figure("Friction work under that load", formatQuantity(best.dissipated_energy, "J")),
        ]
      : []),
    ...harmonics
      .filter((one) => part(one) > 0)
      .map((one) =>
        figure(
          `Harmonic ${one.order}`,
          one === first
            ? formatQuantity(part(one), unit)
            : `${formatNumber((100 * part(one)) / part(first), 3)} % of the first`,
        ),
      ),
  ];
}

/** The figures of the limit of wear in rows. */
function wearRows({ stick_radius: stick, worn_radius: worn, normal_force: force, depth, removed_volume: volume }) {
  return [
    figure("Wear ends at a contact radius of", formatQuantity(stick, "m")),
    figure("Worn up to", formatQuantity(worn, "m")),
    figure("Largest depth", formatQuantity(depth.largest, "m")),
    figure("Removed volume", `${formatNumber(volume * 1e18)} µm³`),
    figure("Remaining load", formatQuantity(force.after, "N")),
  ];
}

/** The card, its plots and the request behind it. */
export function cycleStudyCard(model) {
  const form = new Fields();
  const field = (pointer, about) => new NumberField(form, () => pointer, about);
  const slip = Math.max(model.slip(model.state), 0) || model.figures.gross_slip_displacement || 1e-7;
  const amplitude = field("/drive/displacement", {
    label: "Amplitude U_0",
    units: LENGTH,
    unit: "nm",
    value: String(Number((0.5e9 * slip).toPrecision(3))),
  });
  const load = field("/normal/normal_force", {
    label: "Amplitude of the load",
    units: FORCE,
    unit: "N",
    optional: true,
  });
  const phase = field("/normal/phase", { label: "Its phase lead over the displacement, degrees", optional: true });
  const work = new Chart({
    name: "density",
    title: "Friction work per area and cycle",
    height: 220,
    x: { label: model.isLine ? "x, along the motion" : "Radius r", unit: "m" },
    y: { label: "Work per area", unit: "J/m²" },
  });
  const loads = new Chart({
    name: "best-load",
    title: "Friction work over the load",
    height: 220,
    x: { label: "Normal force F_N", unit: "N" },
    y: { label: "Friction work of a cycle", unit: "J" },
  });
  const shape = new Chart({
    name: "wear",
    title: "Shape before wear and in the limit, at constant indentation",
    height: 220,
    x: { label: "Radius r", unit: "m" },
    y: { label: "Height z", unit: "m" },
  });
  const wearRequest = () => ({
    contact: virginContact(model),
    drive: { displacement: amplitude.value },
    hold: "indentation",
  });
  /** Whether wear at this load has a limit that the service computes. */
  const hasLimit = () => load.value === undefined && model.hasStress && !model.isLine;
  const request = () => {
    const isConstant = load.value === undefined;
    return {
      contact: virginContact(model),
      drive: { displacement: amplitude.value },
      harmonics: HARMONICS,
      // The service gives these at a constant load.
      ...(isConstant ? { best_load: { points: LOADS } } : { normal: { normal_force: load.value, phase: phase.value } }),
      ...(isConstant && model.hasStress ? { work_density: { points: RADII } } : {}),
    };
  };
  const show = async ({ cycles: [{ friction_work: density, best_load: best, regime }] }, _, figures) => {
    for (const chart of [work, loads, shape]) chart.element.hidden = true;
    const draw = (chart, name, x, y) =>
      chart.draw({ series: [{ name, kind: "work", points: x.map((at, index) => [at, y[index]]) }], least: { y: [0] } });
    if (density) draw(work, "friction work per area", placesOf(density), density.density);
    if (best?.curve) draw(loads, "friction work", best.curve.normal_force, best.curve.dissipated_energy);
    if (!hasLimit()) return;
    if (regime === "gross_slip") {
      figures.append(figure("Wear", "The whole contact slips: it wears without a limit"));
      return;
    }
    try {
      const reply = await call("POST", "/wear", wearRequest(), model.signal);
      figures.append(...wearRows(reply));
      const { radius, before, after } = reply.shape;
      const points = (heights) => radius.map((at, index) => [at, heights[index]]);
      shape.draw({
        series: [
          { name: "before", kind: "past", points: points(before) },
          { name: "in the limit", kind: "work", points: points(after) },
        ],
        least: { y: [0] },
      });
    } catch (error) {
      if (!(error instanceof Refusal)) throw error;
      figures.append(figure("Wear", error.message));
    }
  };
  return study({
    name: "study",
    title: "Load, harmonics and wear",
    text:
      "A cycle at the present load, or while the load oscillates with it: its harmonics and, at a constant load, " +
      "where it wears, which load damps most, and the limiting shape of wear at constant indentation.",
    form,
    parts: [
      amplitude.element,
      ...(model.hasBulk
        ? []
        : [el("details", {}, el("summary", {}, "The load oscillates too"), load.element, phase.element)]),
    ],
    charts: [work, loads, shape],
    signal: model.signal,
    path: "/cycle",
    request,
    calls: () => [
      { method: "POST", path: "/cycle", body: request() },
      ...(hasLimit() ? [{ method: "POST", path: "/wear", body: wearRequest() }] : []),
    ],
    rows: ({ cycles: [cycle] }) => figureRows(cycle, "N"),
    show,
  });
}
