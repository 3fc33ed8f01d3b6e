// A table in a form, as text or as a file of an instrument: the service reads it, and says what it took for what.
import { call } from "./api.js";
import { el, reason } from "./dom.js";
import { FORCE, LENGTH } from "./form_options.js";

/** How long a text rests before it is read, ms. */
const REST = 150;

/** The units that fields say, by the entries of a mapping. */
const UNITS = { displacement: "displacement_unit", force: "force_unit", x: "lateral", y: "lateral", z: "height" };

/** A query with a mapping, in which what the fields say of units stands in place of its own. */
export function withMapping(given, mapping) {
  const entry = (text) => {
    const [name, column] = text.split(":");
    const unit = given[UNITS[name]];
    return unit === undefined ? text : `${name}:${column}:${unit}`;
  };
  return mapping ? { ...given, mapping: mapping.split(";").map(entry).join(";") } : given;
}

/** What the service reads in the text field `control`, or in a file that is chosen for it or dropped on it. `query`
 *  says what is known beside, `taken` gets each reply, or the error in its place, and `fresh` is called when there is
 *  something else to read. */
export function fileSource(kind, control, query, taken, fresh) {
  let file = null;
  let mapping = "";
  let latest = 0;
  let reading = Promise.resolve();
  const body = () => file ?? new Blob([control.value]);
  const read = (rest = 0) => {
    const number = (latest += 1);
    reading = new Promise((resolve) => setTimeout(resolve, rest)).then(async () => {
      if (number !== latest || !body().size) return;
      const said = () => new URLSearchParams(withMapping(query(), mapping));
      const ask = async () => call("POST", `/files/${kind}?${said()}`, body());
      const [reply, error] = await ask().then(
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
    mapping = "";
    control.value = "";
    control.placeholder = chosen.name;
    fresh();
    read();
  };
  control.addEventListener("input", () => {
    file = null;
    mapping = "";
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
  const settled = async () => {
    let last;
    do await (last = reading);
    while (last !== reading);
  };
  /** Reads again with entries that precede all else. */
  const map = (entries) => {
    mapping = entries;
    read();
  };
  return { input, open, read, map, settled };
}

/** What a reply took for what, without how the text is written, or what is wrong with the file. */
export function readingText(reply, error) {
  const text = reply ? reply.preview.reading.slice(1).join(" ") : reason(error);
  return plain(text.replace(/name the unit by `[^`]*`( or `[^`]*`)?/, "choose the unit below"));
}

/** What a quantity of a reply is called. */
const NAMES = { x: "place x", y: "place y", z: "height", normal_force: "normal load" };
/** Columns that are shown one by one. */
const MOST_COLUMNS = 40;

/** What may be chosen for a column, by the kind of file. */
const CHOICES = { loop: ["displacement", "force", "time", "load"], scan: ["x", "y", "z"] };
/** What a kind of line is called. */
const KINDS = {
  preamble: "before the table",
  names: "names",
  units: "units",
  remark: "remark",
  data: "row",
  figure: "figure of many rows",
  second_table: "other table",
  zeros: "zeros at the end",
};

/** A mapping in which a column is another quantity, or none, and the others are as they were. */
export function remapped(mapping, column, quantity) {
  const entries = mapping.split(";").filter(Boolean);
  const of = (entry) => entry.split(":");
  const isColumn = (entry) => [...CHOICES.loop, ...CHOICES.scan].includes(of(entry)[0]);
  const own = entries.find((entry) => isColumn(entry) && of(entry)[1] === String(column));
  const kept = entries.filter((entry) => entry !== own && of(entry)[0] !== quantity);
  // What may be absent stays away; the unit of another column is not its own.
  const [was] = own ? of(own) : [];
  const away = ["time", "load", "y"].includes(was) && was !== quantity ? [`${was}:none`] : [];
  return [...kept, ...away, ...(quantity ? [`${quantity}:${column}`] : [])].join(";");
}

/** What each column and line of a file was taken for, in colours, with a choice for each column; or what the file may
 *  mean, as buttons. `map` reads the file again with a mapping; `show` fills all from a reply, an error, or nothing. */
export function columnsTable(kind, map) {
  const rows = el("tbody", {});
  const rest = el("p", { class: "note" });
  const head = el(
    "tr",
    {},
    ["Column", "Name in the file", "Taken for", "Choose"].map((name) => el("th", { scope: "col" }, name)),
  );
  const lines = el("tbody", {});
  const shown = el("table", { class: "file-lines", "aria-label": "Lines of the file" }, lines);
  const candidates = el("ul", { class: "candidates", "aria-label": "What the file may mean" });
  const table = el("table", {}, el("thead", {}, head), rows);
  const element = el("div", { class: "columns", hidden: true }, candidates, table, shown, rest);
  const taken = ({ quantity, unit, assumed, left_out: why }) =>
    quantity
      ? `${NAMES[quantity] ?? quantity}, in ${unit}${assumed ? ", which is assumed" : ""}`
      : `left out: ${plain(why ?? "")}`;
  const choice = (reply, column, index) => {
    const own = column.quantity === "normal_force" ? "load" : (column.quantity ?? "");
    const option = (value) => el("option", { value, selected: value === own }, value || "nothing");
    const onchange = (event) => map(remapped(reply.mapping, index + 1, event.target.value));
    return el("select", { "aria-label": `Column ${index + 1} is`, onchange }, ["", ...CHOICES[kind()]].map(option));
  };
  const row = (reply) => (column, index) =>
    el(
      "tr",
      { class: column.quantity ? false : "faint" },
      [index + 1, column.name ?? "–", taken(column)].map((cell) => el("td", {}, String(cell))),
      el("td", {}, choice(reply, column, index)),
    );
  const line = ({ line: number, kind: what, cells }) =>
    el(
      "tr",
      { class: `line-${what}`, title: KINDS[what] },
      el("th", { scope: "row" }, `${number}: ${KINDS[what]}`),
      cells.map((cell) => el("td", {}, cell)),
    );
  const candidate = ({ name, column, values, mapping }) =>
    el(
      "li",
      {},
      el(
        "button",
        { type: "button", class: "quiet", onclick: () => map(mapping) },
        `${column ? `Column ${column}: ` : ""}${name}`,
      ),
      values.length ? ` ${values.join(", ")}` : "",
    );
  const show = (reply, error) => {
    const { columns = [], table: some = [], rows_left_out: left = { count: 0, lines: [] } } = reply?.preview ?? {};
    const open = error?.candidates ?? [];
    element.hidden = !columns.length && !left.count && !open.length;
    table.hidden = !columns.length;
    shown.hidden = !some.length;
    candidates.replaceChildren(...open.map(candidate));
    rows.replaceChildren(...columns.slice(0, MOST_COLUMNS).map(row(reply)));
    lines.replaceChildren(...some.map(line));
    const more = columns.length > MOST_COLUMNS ? `${columns.length - MOST_COLUMNS} more columns are not shown. ` : "";
    const numbers = left.lines.slice(0, 10).join(", ") + (left.count > 10 ? ` and ${left.count - 10} more` : "");
    rest.textContent = more + (left.count ? `Lines that were left out: ${numbers}.` : "");
  };
  return { element, show };
}

const plain = (text) => text.replace(/`([^`]*)`/g, "“$1”");

/** The symbol of a unit in the API, and the option of a list of units that has it. */
export const symbolOf = (select) => select.selectedOptions[0].textContent.replace("µ", "u");
export function chooseUnit(select, symbol) {
  const option = [...select.options].find(({ text }) => text.replace("µ", "u") === symbol);
  if (option) select.value = option.value;
}

/** The power of ten of a unit in which a reply has its numbers. */
export const powerOfUnit = (symbol) => [...LENGTH, ...FORCE].find(([text]) => text.replace("µ", "u") === symbol)[1];

/** Columns and units of a loop, as the file says unless somebody chooses otherwise: fields for that, the query that
 *  asks for it, and what shows those of a reply. */
export function loopColumns(prefix) {
  const QUANTITIES = { displacement: LENGTH, force: FORCE, time: null };
  /** @type {Record<string, HTMLInputElement>} */
  const columns = {};
  /** @type {Record<string, HTMLSelectElement>} */
  const units = {};
  /** @type {Record<string, HTMLOptionElement>} */
  const asRead = {};
  for (const [name, offered] of Object.entries(QUANTITIES)) {
    columns[name] = el("input", {
      type: "text",
      autocomplete: "off",
      size: 12,
      "aria-label": `Column of ${prefix}${name}`,
    });
    if (!offered) continue;
    asRead[name] = el("option", { value: "" });
    units[name] = el(
      "select",
      { "aria-label": `Unit of ${prefix}${name}` },
      asRead[name],
      offered.map(([text, power]) => el("option", { value: power }, text)),
    );
  }
  const query = () => ({
    ...Object.fromEntries(
      Object.entries(columns)
        .map(([name, { value }]) => [name, value.trim()])
        .filter(([, column]) => column && column !== "0"),
    ),
    ...Object.fromEntries(
      Object.entries(units)
        .filter(([, { value }]) => value !== "")
        .map(([name, unit]) => [`${name}_unit`, symbolOf(unit)]),
    ),
  });
  const show = (reply) => {
    for (const [name, box] of Object.entries(columns)) {
      const index = reply?.preview.columns.findIndex(({ quantity }) => quantity === name) ?? -1;
      const { unit, assumed } = reply?.preview.columns[index] ?? {};
      box.placeholder = index < 0 ? (name === "time" ? "none" : "by its name") : `${index + 1}, as read`;
      if (name in asRead && (!reply || units[name].value === ""))
        asRead[name].textContent = unit ? `${unit}${assumed ? ", assumed" : ", as read"}` : "as the file says";
    }
  };
  /** As the file says, for another file. */
  const reset = () => {
    for (const control of [...Object.values(columns), ...Object.values(units)]) control.value = "";
    show();
  };
  reset();
  const row = (title, name) =>
    el(
      "div",
      { class: "row" },
      el("label", {}, `${title}: column `, columns[name]),
      ...(name in units ? [units[name]] : []),
    );
  const rows = [row("Displacement", "displacement"), row("Force", "force")];
  const time = row("Time, for a drift (0: none)", "time");
  return { query, show, reset, rows, time, hasTime: () => columns.time.value.trim() !== "0" };
}
