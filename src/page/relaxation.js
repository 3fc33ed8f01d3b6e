// Bodies with memory: the Prony terms of the form, the time that moves take, and the force over the time.
import { Chart } from "./chart.js";
import { columnsOf } from "./chart_menu.js";
import { el, noticing } from "./dom.js";
import { Choice, Fields, NumberField } from "./form_fields.js";
import { prefixed } from "./units.js";

const TIME = prefixed("s", "", "m", "µ");
/** The most terms that the service takes, and the first of them as examples: ratio, time and its unit. */
const MOST_TERMS = 16;
const EXAMPLES = [
  ["0.4", "10", "ms"],
  ["0.3", "1", "s"],
];

/** Whether the bodies of a contact have a memory: no stress of it is known, and no steady state but by a path. */
export const hasMemory = ({ prony }) => prony !== undefined;

/** The fields of a Prony series. */
export function pronyFields(form, changed) {
  const kinds = { none: "None: elastic", prony: "Relax, by a Prony series" };
  const choice = new Choice(form, () => "/prony", "Memory of the bodies", kinds, "none");
  const rows = el("div", {});
  const terms = [];
  const note =
    "Each term takes its ratio off the modulus, which is that of the instant, with its relaxation time. The bodies " +
    "are alike, or one is rigid.";
  const add = () => {
    const [ratio, time, unit] = EXAMPLES[terms.length] ?? ["0.1", "1", "s"];
    const at = `/prony/${terms.length}`;
    const of = `of term ${terms.length + 1}`;
    const term = {
      ratio: new NumberField(form, () => `${at}/ratio`, { label: `Ratio ${of}`, value: ratio }),
      time: new NumberField(form, () => `${at}/time`, {
        label: `Relaxation time ${of}`,
        units: TIME,
        unit,
        value: time,
      }),
    };
    terms.push(term);
    rows.append(term.ratio.element, term.time.element);
    offer();
  };
  const drop = () => {
    for (const field of Object.values(terms.pop())) field.element.remove();
    offer();
  };
  const more = el("button", { type: "button", id: "add-term", onclick: add }, "Add a term");
  const less = el("button", { type: "button", onclick: drop }, "Remove the last");
  const offer = () => {
    more.disabled = terms.length >= MOST_TERMS;
    less.disabled = terms.length < 2;
    changed();
  };
  const given = el(
    "div",
    { hidden: true },
    rows,
    el("p", { class: "row" }, more, less),
    el("p", { class: "note" }, note),
  );
  choice.control.addEventListener("change", () => {
    given.hidden = choice.value === "none";
    while (!given.hidden && terms.length < 1) add();
    while (given.hidden && terms.length) drop();
  });
  const read = () => terms.map(({ ratio, time }) => ({ ratio: ratio.value, time: time.value }));
  return { element: el("div", {}, choice.element, given), value: () => (terms.length ? read() : undefined) };
}

/** The time that moves take, and a wait. `timed` gives a move its time. */
export function paceOfMoves(model) {
  const form = new Fields();
  const pace = new NumberField(form, () => "/pace", {
    label: "Time of a move (empty: at once)",
    units: TIME,
    unit: "ms",
    value: "10",
    optional: true,
  });
  const time = new NumberField(form, () => "/duration", { label: "Wait for", units: TIME, unit: "s", value: "1" });
  const hold = el("input", { type: "checkbox", id: "hold-load" });
  const timed = (target) => {
    pace.showFault(pace.mistake);
    if (pace.mistake) throw new Error(pace.mistake);
    return { ...target, duration: pace.value };
  };
  const wait = async () => {
    const wrong = form.check();
    if (wrong) return wrong.control.focus();
    const load = hold.checked ? { normal_force: model.state.normal_force } : {};
    try {
      await model.move({ duration: time.value, ...load });
    } catch (error) {
      form.place(error);
    }
  };
  const begin = (event) => {
    event.preventDefault();
    noticing(wait, model.signal)();
  };
  const element = el(
    "form",
    { class: "move-control", onsubmit: begin },
    pace.element,
    time.element,
    form.rest,
    el(
      "p",
      { class: "row" },
      el("button", { id: "wait" }, "Wait"),
      el("label", { for: "hold-load" }, hold, " and hold the load, not the indentation"),
    ),
  );
  return { element, timed };
}

/** The forces over the time, and a function that draws them from the model of a contact. */
export function forceOverTime() {
  const chart = new Chart({
    name: "time",
    title: "Force over the time",
    x: { label: "Time t", unit: "s" },
    y: { label: "Force", unit: "N" },
    note: "The tangential force is followed through moves; its limit is known at their ends, joined by straight lines.",
  });
  const drawModel = ({ first, history, path, state, friction }) => {
    const all = [first, ...history];
    const limit = (sign) => all.map(({ state: at }) => [at.time ?? 0, sign * friction * at.normal_force]);
    chart.draw({
      series: [
        { name: "tangential force F", kind: "tau", points: followed(all, path) },
        { name: "limit ±μ F_N", kind: "bound", points: limit(1) },
        { name: "limit ±μ F_N", kind: "bound", points: limit(-1), hover: false, legend: false },
      ],
      least: { x: [0, 1e-3], y: [0] },
      marks: [{ x: state.time ?? 0, y: state.force, class: state.regime }],
      table: () =>
        columnsOf(
          all.map(({ sequence, state: at }) => ({ sequence, ...at })),
          {
            sequence: "sequence",
            time_s: "time",
            displacement_m: "displacement",
            force_n: "force",
            normal_force_n: "normal_force",
            friction_work_j: "dissipated_energy",
            viscous_work_j: "viscous_work",
          },
        ),
    });
  };
  return Object.assign(chart, { drawModel });
}

/** The points `[time, force, sequence]` of a path `[displacement, force, sequence, part]`, whose moves go at an even
 *  pace. */
export function followed(all, path) {
  const timeOf = new Map(all.map(({ sequence, state }) => [sequence, state.time ?? 0]));
  return path
    .filter(([, , sequence]) => timeOf.has(sequence))
    .map(([, force, sequence, part = 1]) => {
      const end = timeOf.get(sequence);
      const begin = timeOf.get(sequence - 1) ?? end;
      return [begin + part * (end - begin), force, sequence];
    });
}
