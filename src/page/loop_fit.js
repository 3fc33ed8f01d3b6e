// A loop that a bench has measured, as a file or pasted: the service fits friction and stiffness to it.
import { call } from "./api.js";
import { Chart } from "./chart.js";
import { el, notice } from "./dom.js";
import { Choice, Fields, NumberField, TextField } from "./form_fields.js";
import { FORCE, LENGTH } from "./form_options.js";
import { fileInput, tableRows } from "./table_text.js";
import { formatQuantity, parseNumber } from "./units.js";

/** What may be free: its name on the page, its unit, and whether it is so at first. */
const PARAMETERS = {
  friction: ["friction μ", "", true],
  g_star: ["modulus G*", "Pa", true],
  machine_compliance: ["compliance of the machine", "m/N", false],
  displacement_offset: ["zero of the displacement", "m", false],
  force_offset: ["zero of the force", "N", true],
  e_star: ["modulus E*", "Pa", false],
  radius: ["radius", "m", false],
};
const COMPLIANCE = [
  ["m/N", 0],
  ["µm/N", -6],
  ["nm/N", -9],
];
const STARTS = {
  steady: "in a cycle that was repeated before",
  virgin: "with a contact that was never moved",
  unknown: "not known",
};
/** The symbols of units in the API. */
const symbol = (select) => select.selectedOptions[0].textContent.replace("µ", "u");

/** A list of units. */
export function unitOf(name, units, usual) {
  const options = units.map(([text, power]) => el("option", { value: power, selected: text === usual }, text));
  return el("select", { "aria-label": `Unit of ${name}` }, options);
}

/** A field for the number of a column. */
export const columnOf = (name, number) =>
  el("input", { type: "number", min: 1, max: 99, value: String(number), "aria-label": `Column of ${name}` });

/** A row for each quantity that was estimated. */
function estimateRows(estimates) {
  const end = (value, unit) => (value === null ? "open" : formatQuantity(value, unit));
  return Object.entries(estimates).map(([name, { value, interval, at_bound: bound }]) => {
    const [text, unit] = PARAMETERS[name] ?? [name, ""];
    const between = `${end(interval[0], unit)} to ${end(interval[1], unit)}${bound ? ", at its bound" : ""}`;
    return el("div", {}, el("dt", {}, text), el("dd", {}, `${formatQuantity(value, unit)} (${between})`));
  });
}

/** What a card of a study needs, with the form as its `body` and what was found as its `results`. */
export function loopFit(model) {
  const form = new Fields();
  const text = new TextField(
    form,
    () => "/loops",
    "Displacement and force, one point a line",
    el("textarea", { name: "loop", rows: 6, spellcheck: "false", value: "" }),
  );
  const [displacementUnit, forceUnit] = [unitOf("displacements", LENGTH, "µm"), unitOf("forces", FORCE, "N")];
  const [displacementColumn, forceColumn] = [columnOf("displacements", 1), columnOf("forces", 2)];
  const start = new Choice(form, () => "/loops/0/start", "The record begins", STARTS, "steady");
  const compliance = new NumberField(form, () => "/known/machine_compliance/value", {
    label: "Compliance of the machine, if it is known",
    units: COMPLIANCE,
    unit: "nm/N",
  });
  const error = new NumberField(form, () => "/known/machine_compliance/standard_error", {
    label: "Its standard error",
    units: COMPLIANCE,
    unit: "nm/N",
  });
  const offered = Object.entries(PARAMETERS).filter(
    ([name]) => !["radius", "e_star"].includes(name) || model.definition.profile.type === "sphere",
  );
  const boxes = offered.map(([name, [label, , checked]]) => {
    const box = el("input", { type: "checkbox", name, checked });
    return [box, el("label", {}, box, ` ${label}`)];
  });
  const column = (rows, place) => rows.map((row) => parseNumber(row[Number(place.value) - 1] ?? ""));
  const request = () => {
    const rows = tableRows(text.value);
    const [displacement, force] = [displacementColumn, forceColumn].map((place) => column(rows, place));
    // A row that lacks a number is a gap.
    const whole = displacement.map((value, index) => value !== undefined && force[index] !== undefined);
    const present = (values) => values.filter((_, index) => whole[index]);
    const record = { displacement: present(displacement), force: present(force) };
    if (start.value !== "unknown") record.start = start.value;
    const known = { value: compliance.value, ...(error.value === undefined ? {} : { standard_error: error.value }) };
    return {
      contact: model.definition,
      loops: [record],
      units: { displacement: symbol(displacementUnit), force: symbol(forceUnit) },
      free: boxes.filter(([box]) => box.checked).map(([box]) => box.name),
      ...(compliance.value === undefined ? {} : { known: { machine_compliance: known } }),
    };
  };

  const chart = new Chart({
    name: "fit",
    title: "Measured and fitted",
    mode: "nearest",
    x: { label: "Displacement", unit: "m" },
    y: { label: "Tangential force F", unit: "N" },
  });
  chart.more = (_, series) => [series.name];
  const estimates = el("dl", { class: "figures", id: "loop-estimates", "aria-live": "polite" });
  const said = el("p", { class: "note", id: "loop-said" });
  const warnings = el("ul", { class: "warnings", id: "loop-warnings" });
  let fitted = null;
  const create = async () => {
    try {
      location.hash = `#/contacts/${(await call("POST", "/contacts", fitted)).id}`;
    } catch (refusal) {
      notice(refusal.message, true);
    }
  };
  const button = el("button", { type: "button", id: "create-fitted", hidden: true, onclick: create }, "Create this contact");
  const compute = async () => {
    let reply;
    try {
      reply = await call("POST", "/fit", request(), model.signal);
    } catch (refusal) {
      form.place(refusal);
      throw refusal;
    }
    form.clear();
    fitted = reply.contact;
    button.hidden = false;
    estimates.replaceChildren(...estimateRows(reply.estimates));
    said.textContent = `Determined: ${reply.identifiable.join(", ")}. Residual ${formatQuantity(reply.residual.rms, "N", 3)} rms.`;
    warnings.replaceChildren(...reply.warnings.map((warning) => el("li", {}, warning.message)));
    const line = (name, kind, of) => ({
      name,
      kind,
      // Loops are not joined with each other.
      points: reply.curve.flatMap((one) => [...one.displacement.map((x, index) => [x, of(one)[index]]), [0, null]]),
    });
    chart.draw({
      series: [line("measured", "past", (one) => one.measured), line("fitted", "now", (one) => one.force)],
    });
  };
  const body = el(
    "div",
    {},
    text.element,
    el("label", {}, "or a file ", fileInput(text.control)),
    el(
      "div",
      { class: "row" },
      el("label", {}, "Displacement: column ", displacementColumn),
      displacementUnit,
      el("label", {}, "Force: column ", forceColumn),
      forceUnit,
    ),
    start.element,
    el("fieldset", {}, el("legend", {}, "To be found"), el("div", { class: "row" }, ...boxes.map(([, label]) => label))),
    el("div", { class: "row choices" }, compliance.element, error.element),
    form.rest,
  );
  const results = el("div", {}, estimates, said, warnings, button);
  return { chart, compute, body, results, calls: () => [{ method: "POST", path: "/fit", body: request() }] };
}
