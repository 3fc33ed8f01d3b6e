// One record of a bench in the form of a fit: its text or file, which columns it has, and what else is known of it.
import { el } from "./dom.js";
import { fileSource, loopColumns, readingText } from "./file_source.js";
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
    "Displacement and force, one point a line",
    el("textarea", { name: "loop", rows: 6, spellcheck: "false", value: "" }),
  );
  const prefix = index ? `record ${index + 1}: ` : "";
  const columns = loopColumns(prefix);
  const start = new Choice(form, () => `${at()}/start`, "The record begins", STARTS, "steady");
  const optional = (name, label, more) => new NumberField(form, () => `${at()}/${name}`, { label, optional: true, ...more });
  const load = optional("normal_force", "Load, if not that of the contact", { units: FORCE, unit: "N" });
  const weight = optional("weight", "Weight beside the other records");
  const said = el("p", { class: "note", "aria-live": "polite" });
  let found = null;
  // The header says what is what until somebody chooses otherwise.
  let isChosen = false;
  const taken = (reply, error) => {
    found = reply;
    said.textContent = readingText(reply, error);
    if (reply && !isChosen) columns.show(reply);
  };
  const fresh = () => (isChosen = false);
  const source = fileSource("loop", text.control, () => (isChosen ? columns.query() : {}), taken, fresh);
  const chosen = () => {
    isChosen = true;
    source.read();
  };
  const element = el(
    "fieldset",
    { class: "record" },
    el("legend", {}, `Record ${index + 1}`),
    text.element,
    el("label", {}, "or a file ", source.input),
    said,
    el("div", { onchange: chosen }, ...columns.rows, columns.time),
    start.element,
    el("details", {}, el("summary", {}, "Load and weight"), load.element, weight.element),
  );
  /** The record in units of these powers of ten. */
  const value = (powers) => {
    const { displacement = [], force = [], time, normal_force } = found?.loop ?? {};
    const scaled = (name, values) => {
      const factor = 10 ** (columns.power(name) - powers[name]);
      return factor === 1 ? values : values.map((value) => value * factor);
    };
    return {
      displacement: scaled("displacement", displacement),
      force: scaled("force", force),
      time: Number(columns.columns.time.value) > 0 ? time : undefined,
      ...(start.value === "unknown" ? {} : { start: start.value }),
      normal_force: load.value ?? normal_force,
      weight: weight.value,
    };
  };
  return { element, value, units: columns.units, settled: source.settled };
}
