// The part of the form for the shape of the indenter; a sum contains several shapes.
import { el } from "./dom.js";
import { Choice, NumberField, TextField } from "./form_fields.js";
import { LENGTH, PROFILES, TABLE } from "./form_options.js";
import { scanFit } from "./scan_fit.js";
import { parseNumber } from "./units.js";

/** An editor of a profile at the pointer that `at` gives; `changed` is called when its fields change. */
export function profileFields(form, at, changed, nested = false) {
  const names = Object.entries(PROFILES)
    .filter(([key]) => !nested || key !== "sum")
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
    read = (choice.value === "tabulated" ? table : choice.value === "sum" ? sum : numbers)(
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
  const fields = PROFILES[type][1].map((about) => [about.name, new NumberField(form, () => `${at()}/${about.name}`, about)]);
  body.append(...fields.map(([, field]) => field.element));
  return () => Object.fromEntries(fields.map(([name, field]) => [name, field.value]));
}

function table(form, at, changed, body) {
  const units = () =>
    el(
      "select",
      {},
      LENGTH.map(([name, power]) => el("option", { value: power, selected: name === "µm" }, name)),
    );
  const [across, up] = [units(), units()];
  const text = new TextField(
    form,
    at,
    "Radius and height, one pair a line",
    el("textarea", { rows: 8, spellcheck: "false", value: "" }),
  );
  text.control.value = TABLE;
  const read = () => {
    const lines = text.value
      .split("\n")
      .map((line) => line.trim())
      .filter((line) => line && !line.startsWith("#"));
    // Lines before the first number are a header.
    const rows = lines.slice(Math.max(0, lines.findIndex((line) => /^[+−-]?[\d.,]/.test(line))));
    // Where something else separates a pair, a comma between digits is a decimal comma.
    const pairs = rows.map((line) =>
      (/[\t;]|\s/.test(line.replace(/,\s+/, "")) ? line.split(/[\t;]+|\s+/) : line.split(","))
        .map((cell) => cell.replace(/,$/, ""))
        .filter(Boolean),
    );
    const column = (index, unit) => pairs.map((pair) => parseNumber(pair[index] ?? "", Number(unit.value)) ?? null);
    return { r: column(0, across), z: column(1, up) };
  };
  const write = ({ r, z }) => {
    const inUnit = (value, unit) => Number((value / 10 ** Number(unit.value)).toPrecision(12));
    text.control.value = r.map((radius, index) => `${inUnit(radius, across)}\t${inUnit(z[index], up)}`).join("\n");
    changed();
  };
  body.append(
    text.element,
    el("div", { class: "row" }, el("label", {}, "Radii in ", across), el("label", {}, "Heights in ", up)),
    el(
      "p",
      { class: "note" },
      "Paste two columns from a spreadsheet or a file; they are separated by tabs, blanks, commas or semicolons. The first radius is 0, unless it is a scan to be fitted.",
    ),
    scanFit(text.control, read, write),
  );
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
