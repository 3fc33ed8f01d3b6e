// The part of the form for the shape of the indenter; a sum contains several shapes.
import { el } from "./dom.js";
import { Choice, NumberField, TextField } from "./form_fields.js";
import { COLUMNS, PROFILES, WITHOUT_STRESS } from "./form_options.js";
import { scanFit } from "./scan_fit.js";
import { guessColumn, tableRows } from "./table_text.js";
import { parseNumber } from "./units.js";

/** An editor of a profile at the pointer that `at` gives; `changed` is called when its fields change. */
export function profileFields(form, at, changed, nested = false) {
  const names = Object.entries(PROFILES)
    .filter(([key]) => !nested || (key !== "sum" && !WITHOUT_STRESS.includes(key)))
    .map(([key, [text]]) => [key, text]);
  const choice = new Choice(
    form,
    () => `${at()}/type`,
    nested ? "Shape" : "Shape of the indenter",
    Object.fromEntries(names),
    "sphere",
  );
  const body = el("div", { class: "fields" });
  let read;
  const fill = () => {
    body.replaceChildren();
    read = (choice.value in COLUMNS ? columns : choice.value === "sum" ? sum : numbers)(
      form,
      at,
      changed,
      body,
      choice.value,
    );
    changed();
  };
  choice.control.addEventListener("change", fill);
  const element = el("div", {}, choice.element, body);
  fill();
  return { element, value: () => ({ type: choice.value, ...read() }) };
}

function numbers(form, at, changed, body, type) {
  const fields = PROFILES[type][1].map((about) => {
    const place = () => `${at()}/${about.name}`;
    const field = about.options
      ? new Choice(form, place, about.label, about.options, Object.keys(about.options)[0])
      : new NumberField(form, place, about);
    return [about.name, field];
  });
  body.append(...fields.map(([, field]) => field.element));
  return () => {
    const members = {};
    for (const [name, field] of fields) {
      const [list, index] = name.split("/");
      if (index === undefined) members[name] = field.value;
      else (members[list] ??= [])[index] = field.value;
    }
    return members;
  };
}

function columns(form, at, changed, body, type) {
  const [label, described, example] = COLUMNS[type];
  const units = described.map(([, , offered, usual]) =>
    el(
      "select",
      {},
      offered.map(([name, power]) => el("option", { value: power, selected: name === usual }, name)),
    ),
  );
  const text = new TextField(form, at, label, el("textarea", { rows: 8, spellcheck: "false", value: "" }));
  text.control.value = example;
  const rows = () => tableRows(text.value);
  const column = (index, unit = units[index]) => rows().map((row) => parseNumber(row[index] ?? "", Number(unit.value)) ?? null);
  const read = () => Object.fromEntries(described.map(([name], index) => [name, column(index)]));
  /** The scan in the text: a line through the axis, or points of the surface where there are three columns. */
  const scan = () =>
    rows().some((row) => row.length > 2)
      ? { points: { x: column(0), y: column(1, units[0]), z: column(2, units[1]) } }
      : { line: { x: column(0), z: column(1) } };
  // A header that names units chooses them.
  const readUnits = () => {
    for (const [index, name] of ["radius", "height"].entries()) {
      const unit = guessColumn(text.value, name)?.unit;
      const option = [...units[index].options].find(({ text }) => text.replace("µ", "u") === unit);
      if (option) units[index].value = option.value;
    }
  };
  if (type === "tabulated") text.control.addEventListener("input", readUnits);
  const write = ({ r, z }) => {
    const inUnit = (value, unit) => Number((value / 10 ** Number(unit.value)).toPrecision(12));
    text.control.value = r.map((radius, index) => `${inUnit(radius, units[0])}\t${inUnit(z[index], units[1])}`).join("\n");
    changed();
  };
  const first = type === "tabulated" ? " The first radius is 0, unless it is a scan to be fitted." : "";
  body.append(
    text.element,
    el("div", { class: "row" }, ...described.map(([, name], index) => el("label", {}, name, units[index]))),
    el(
      "p",
      { class: "note" },
      `Paste two columns from a spreadsheet or a file; they are separated by tabs, blanks, commas or semicolons.${first}`,
    ),
  );
  if (type === "tabulated") body.append(scanFit(text.control, scan, write));
  return read;
}

function sum(form, at, changed, body) {
  const parts = [];
  const list = el("div", { class: "parts" });
  const add = () => {
    const part = {};
    const place = () => `${at()}/parts/${Math.max(0, parts.indexOf(part))}`;
    parts.push(part);
    const remove = el(
      "button",
      {
        type: "button",
        onclick: () => {
          parts.splice(parts.indexOf(part), 1);
          box.remove();
          changed();
        },
      },
      "Remove this shape",
    );
    const box = el("fieldset", {}, el("legend", {}, "Part of the sum"));
    list.append(box);
    part.editor = profileFields(form, place, changed, true);
    box.append(part.editor.element, remove);
  };
  body.append(
    list,
    el(
      "button",
      {
        type: "button",
        onclick: () => {
          add();
          changed();
        },
      },
      "Add a shape",
    ),
  );
  add();
  add();
  return () => ({ parts: parts.filter((part) => part.editor).map((part) => part.editor.value()) });
}
