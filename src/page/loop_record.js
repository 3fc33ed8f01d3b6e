// One record of a bench in the form of a fit: its text or file, which columns it has, and what else is known of it.
import { el } from "./dom.js";
import { columnsTable, fileSource, loopColumns, powerOfUnit, readingText } from "./file_source.js";
import { Choice, NumberField, TextField } from "./form_fields.js";
import { FORCE } from "./form_options.js";

const STARTS = {
  steady: "in a cycle that was repeated before",
  virgin: "with a contact that was never moved",
  unknown: "not known",
};

/** The record of this number in a form. */
export function loopRecord(form, index) {
  const at = () => `/loops/${index}`;
  const text = new TextField(
    form,
    at,
    "Displacement and force, one point per line",
    el("textarea", { name: "loop", rows: 6, spellcheck: "false", value: "" }),
  );
  const prefix = index ? `record ${index + 1}: ` : "";
  const columns = loopColumns(prefix);
  const start = new Choice(form, () => `${at()}/start`, "The record begins", STARTS, "steady");
  const optional = (name, label, more) =>
    new NumberField(form, () => `${at()}/${name}`, { label, optional: true, ...more });
  const load = optional("normal_force", "Load, if not that of the contact", { units: FORCE, unit: "N" });
  const weight = optional("weight", "Weight relative to the other records");
  const said = el("p", { class: "note", "aria-live": "polite" });
  const table = columnsTable(
    () => "loop",
    (mapping) => source.map(mapping),
  );
  let found = null;
  const taken = (reply, error) => {
    found = reply;
    said.textContent = readingText(reply, error);
    columns.show(reply);
    table.show(reply, error);
  };
  const source = fileSource("loop", text.control, columns.query, taken, columns.reset);
  const element = el(
    "fieldset",
    { class: "record" },
    el("legend", {}, `Record ${index + 1}`),
    text.element,
    el("label", {}, "or a file ", source.input),
    said,
    table.element,
    el("div", { onchange: () => source.read() }, ...columns.rows, columns.time),
    start.element,
    el("details", {}, el("summary", {}, "Load and weight"), load.element, weight.element),
  );
  const units = () => found?.units ?? { displacement: "um", force: "N" };
  /** The record in these units. */
  const value = (wanted) => {
    const { displacement = [], force = [], time, normal_force } = found?.loop ?? {};
    const scaled = (name, values) => {
      const factor = 10 ** (powerOfUnit(units()[name]) - powerOfUnit(wanted[name]));
      return factor === 1 ? values : values.map((number) => number * factor);
    };
    return {
      displacement: scaled("displacement", displacement),
      force: scaled("force", force),
      time: columns.hasTime() ? time : undefined,
      ...(start.value === "unknown" ? {} : { start: start.value }),
      normal_force: load.value ?? normal_force,
      weight: weight.value,
    };
  };
  /** What has to be asked before the record can be fitted, if anything has. */
  const question = () => {
    const unnamed = (found?.preview.columns ?? []).filter(({ quantity, assumed }) => quantity in units() && assumed);
    const names = unnamed.map(({ quantity }) => quantity).join(", nor of the ");
    return names ? `Record ${index + 1}: nothing says the unit of the ${names}: choose it.` : undefined;
  };
  return { element, value, units, question, settled: source.settled };
}
