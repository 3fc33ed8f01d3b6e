// A steady cycle in full: under a load that oscillates too, its harmonics, where it wears, and the load that damps most.
import { call } from "./api.js";
import { Chart } from "./chart.js";
import { el, notice, withSubscripts } from "./dom.js";
import { Fields, NumberField } from "./form_fields.js";
import { FORCE, LENGTH } from "./form_options.js";
import { virginContact } from "./protocol_run.js";
import { formatNumber, formatQuantity } from "./units.js";
import { showWarnings, warningList } from "./warning_list.js";

/** Radii of the friction work, loads of the search, and harmonics. */
const [RADII, LOADS, HARMONICS] = [100, 60, 5];

const pair = (name, value) => el("div", {}, el("dt", {}, withSubscripts(name)), el("dd", {}, value));

/** The figures of a cycle in rows. */
function figureRows(cycle, unit) {
  const ratio = (value) => (value === null ? "–" : formatNumber(value));
  const { best_load: best, harmonics = [] } = cycle;
  const [first] = harmonics;
  const part = ({ in_phase: real, quadrature: other }) => Math.hypot(real, other);
  return [
    pair("Friction work of a cycle", formatQuantity(cycle.dissipated_energy, "J")),
    pair("Loss factor", ratio(cycle.loss_factor)),
    ...(best
      ? [
          pair("Load that damps most", formatQuantity(best.normal_force, "N")),
          pair("Friction work under it", formatQuantity(best.dissipated_energy, "J")),
        ]
      : []),
    ...harmonics
      .filter((one) => part(one) > 0)
      .map((one) =>
        pair(
          `Harmonic ${one.order}`,
          one === first ? formatQuantity(part(one), unit) : `${formatNumber((100 * part(one)) / part(first), 3)} % of the first`,
        ),
      ),
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
  const load = field("/normal/normal_force", { label: "Amplitude of the load", units: FORCE, unit: "N", optional: true });
  const phase = field("/normal/phase", { label: "Its phase before the displacement, degrees", optional: true });
  const work = new Chart({
    name: "density",
    title: "Friction work per area and cycle",
    height: 220,
    x: { label: "Radius r", unit: "m" },
    y: { label: "Work per area", unit: "J/m²" },
  });
  const loads = new Chart({
    name: "best-load",
    title: "Friction work over the load",
    height: 220,
    x: { label: "Normal force F_N", unit: "N" },
    y: { label: "Friction work of a cycle", unit: "J" },
  });
  for (const chart of [work, loads]) chart.element.hidden = true;
  const figures = el("dl", { class: "figures", id: "study-figures", "aria-live": "polite" });
  const warnings = warningList("study-warnings");
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
  const show = ({ cycles: [cycle], warnings: said }) => {
    figures.replaceChildren(...figureRows(cycle, "N"));
    showWarnings(warnings, said);
    const { friction_work: density, best_load: best } = cycle;
    work.element.hidden = !density;
    loads.element.hidden = !best?.curve;
    if (density) {
      const points = density.radius.map((r, index) => [r, density.density[index]]);
      work.draw({ series: [{ name: "friction work per area", kind: "work", points }], least: { y: [0] } });
    }
    if (best?.curve) {
      const points = best.curve.normal_force.map((force, index) => [force, best.curve.dissipated_energy[index]]);
      loads.draw({ series: [{ name: "friction work", kind: "work", points }], least: { y: [0] } });
    }
  };
  const compute = async (event) => {
    event.preventDefault();
    const first = form.check();
    if (first) return first.control.focus();
    button.disabled = true;
    try {
      show(await call("POST", "/cycle", request(), model.signal));
      form.clear();
    } catch (error) {
      if (model.signal.aborted) return;
      if (!form.place(error)) notice(error.message, true);
    } finally {
      button.disabled = false;
    }
  };
  const button = el("button", { class: "primary", id: "compute-study" }, "Compute");
  const element = el(
    "section",
    { class: "card", id: "study-card" },
    el("h2", {}, "Load, harmonics and wear"),
    el("p", {}, "A cycle at the present load, or while the load oscillates with it: its harmonics and, at a constant load, where it wears and which load damps most."),
    el(
      "form",
      { onsubmit: compute },
      amplitude.element,
      el("details", {}, el("summary", {}, "The load oscillates too"), load.element, phase.element),
      form.rest,
      el("p", { class: "row" }, button),
    ),
    figures,
    warnings,
    work.element,
    loads.element,
  );
  return { element, charts: [work, loads], calls: () => [{ method: "POST", path: "/cycle", body: request() }] };
}
