// One record of a bench in the form of a fit: its text or file, which columns it has, and what else is known of it.
import { el } from "./dom.js";
import { Choice, NumberField, TextField } from "./form_fields.js";
import { FORCE, LENGTH } from "./form_options.js";
import { fileInput, guessColumn, headerOf, tableRows } from "./table_text.js";
import { parseNumber } from "./units.js";

const STARTS = {
  steady: "in a cycle that was repeated before",
  virgin: "with a contact that was never moved",
  unknown: "not known",
};
/** The columns that a record may have: how a header names them, and their number at first; none is 0. */
const COLUMNS = { displacement: ["displacements", 1], force: ["forces", 2], time: ["times", 0] };

/** A list of units. */
export function unitOf(name, units, usual) {
  const options = units.map(([text, power]) => el("option", { value: power, selected: text === usual }, text));
  return el("select", { "aria-label": `Unit of ${name}` }, options);
}

/** A field for the number of a column; 0 where there is none. */
export const columnOf = (name, number) =>
  el("input", { type: "number", min: 0, max: 99, value: String(number), "aria-label": `Column of ${name}` });

/** The record of this number in a form; `units` are the lists of units, which all records share. */
export function loopRecord(form, index, units) {
  const at = () => `/loops/${index}`;
  const text = new TextField(
    form,
    at,
    "Displacement and force, one point a line",
    el("textarea", { name: "loop", rows: 6, spellcheck: "false", value: "" }),
  );
  const columns = Object.fromEntries(Object.entries(COLUMNS).map(([name, [plural, number]]) => [name, columnOf(plural, number)]));
  const start = new Choice(form, () => `${at()}/start`, "The record begins", STARTS, "steady");
  const optional = (name, label, more) => new NumberField(form, () => `${at()}/${name}`, { label, optional: true, ...more });
  const load = optional("normal_force", "Load, if not that of the contact", { units: FORCE, unit: "N" });
  const weight = optional("weight", "Weight beside the other records");
  const said = el("p", { class: "note", "aria-live": "polite" });
  /** Takes columns and units from the header, if there is one, and says so. */
  const readHeader = () => {
    const found = Object.keys(COLUMNS).map((name) => [name, guessColumn(text.value, name)]);
    for (const [name, guess] of found) {
      if (!guess) continue;
      columns[name].value = String(guess.column);
      const option = units[name] && [...units[name].options].find(({ text }) => text.replace("µ", "u") === guess.unit);
      if (option) units[name].value = option.value;
    }
    const cells = headerOf(text.value);
    const named = found.filter(([, guess]) => guess).map(([name, { column }]) => `“${cells[column - 1].trim()}” is the ${name}`);
    said.textContent = named.length ? `From the header: ${named.join(", ")}.` : "";
  };
  text.control.addEventListener("input", readHeader);
  const labelled = (name, title) => el("label", {}, `${title}: column `, columns[name]);
  const element = el(
    "fieldset",
    { class: "record" },
    el("legend", {}, `Record ${index + 1}`),
    text.element,
    el("label", {}, "or a file ", fileInput(text.control)),
    said,
    el("div", { class: "row" }, labelled("displacement", "Displacement"), index ? null : units.displacement),
    el("div", { class: "row" }, labelled("force", "Force"), index ? null : units.force),
    el("div", { class: "row" }, labelled("time", "Time in s, for a drift (0: none)")),
    start.element,
    el("details", {}, el("summary", {}, "Load and weight"), load.element, weight.element),
  );
  const value = () => {
    const rows = tableRows(text.value);
    const names = Object.keys(columns).filter((name) => Number(columns[name].value) > 0);
    const cells = rows.map((row) => names.map((name) => parseNumber(row[Number(columns[name].value) - 1] ?? "")));
    // A row that lacks a number is a gap.
    const whole = cells.filter((row) => row.every((cell) => cell !== undefined));
    return {
      ...Object.fromEntries(names.map((name, place) => [name, whole.map((row) => row[place])])),
      ...(start.value === "unknown" ? {} : { start: start.value }),
      normal_force: load.value,
      weight: weight.value,
    };
  };
  return { element, value };
}
