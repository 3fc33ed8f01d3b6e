// A table in a form, as text or as a file of an instrument: the service reads it, and says what it took for what.
import { call } from "./api.js";
import { el } from "./dom.js";
import { FORCE, LENGTH } from "./form_options.js";

/** How long a text rests before it is read, ms. */
const REST = 150;

/** What the service reads in the text field `control`, or in a file that is chosen for it or dropped on it. `query` says what is
 *  known beside, `taken` gets each reply, or the error in its place, and `fresh` is called when there is something else to read. */
export function fileSource(kind, control, query, taken, fresh) {
  let file = null;
  let latest = 0;
  let reading = Promise.resolve();
  const body = () => file ?? new Blob([control.value]);
  const read = (rest = 0) => {
    const number = (latest += 1);
    reading = new Promise((resolve) => setTimeout(resolve, rest)).then(async () => {
      if (number !== latest || !body().size) return;
      const asked = new URLSearchParams(query());
      const [reply, error] = await call("POST", `/files/${kind}?${asked}`, body()).then(
        (reply) => [reply],
        (error) => [null, error],
      );
      // A reply counts only for what was read last.
      if (number === latest) taken(reply, error);
    });
    return reading;
  };
  const open = (chosen) => {
    if (!chosen) return;
    file = chosen;
    control.value = "";
    control.placeholder = chosen.name;
    fresh();
    read();
  };
  control.addEventListener("input", () => {
    file = null;
    control.placeholder = "";
    fresh();
    read(REST);
  });
  control.addEventListener("dragover", (event) => event.preventDefault());
  control.addEventListener("drop", (event) => {
    if (!event.dataTransfer.files.length) return;
    event.preventDefault();
    open(event.dataTransfer.files[0]);
  });
  const input = el("input", { type: "file", onchange: (event) => open(event.target.files[0]) });
  return { input, open, read, settled: () => reading };
}

/** What a reply took for what, without how the text is written, or what is wrong with the file. */
export function readingText(reply, error) {
  const text = reply ? reply.preview.reading.slice(1).join(" ") : (error.errors?.[0]?.detail ?? error.message);
  return text.replace(/`([^`]*)`/g, "“$1”");
}

/** The symbol of a unit in the API, and the option of a list of units that has it. */
export const symbolOf = (select) => select.selectedOptions[0].textContent.replace("µ", "u");
export function chooseUnit(select, symbol) {
  const option = [...select.options].find(({ text }) => text.replace("µ", "u") === symbol);
  if (option) select.value = option.value;
}

/** Columns and units of a loop: fields for them, the query that asks for what they say, and what shows those of a reply. */
export function loopColumns(prefix) {
  const unitOf = (name, units, usual) =>
    el(
      "select",
      { "aria-label": `Unit of ${prefix}${name}` },
      units.map(([text, power]) => el("option", { value: power, selected: text === usual }, text)),
    );
  const columnOf = (name, number) =>
    el("input", { type: "number", min: 0, max: 99, value: String(number), "aria-label": `Column of ${prefix}${name}` });
  const units = { displacement: unitOf("displacement", LENGTH, "µm"), force: unitOf("force", FORCE, "N") };
  const columns = { displacement: columnOf("displacement", 1), force: columnOf("force", 2), time: columnOf("time", 0) };
  const query = () => ({
    ...Object.fromEntries(
      Object.entries(columns)
        .filter(([, { value }]) => Number(value) > 0)
        .map(([name, { value }]) => [name, value]),
    ),
    displacement_unit: symbolOf(units.displacement),
    force_unit: symbolOf(units.force),
  });
  const show = ({ preview }) => {
    columns.time.value = "0";
    for (const [index, { quantity, unit, assumed }] of preview.columns.entries()) {
      if (quantity in columns) columns[quantity].value = String(index + 1);
      if (quantity in units && !assumed) chooseUnit(units[quantity], unit);
    }
  };
  const row = (title, name) => el("div", { class: "row" }, el("label", {}, `${title}: column `, columns[name]), units[name]);
  const rows = [row("Displacement", "displacement"), row("Force", "force")];
  const time = row("Time, for a drift (0: none)", "time");
  const power = (name) => Number(units[name].value);
  return { query, show, rows, time, columns, units, power };
}
