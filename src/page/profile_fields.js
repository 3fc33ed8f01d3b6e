// The part of the form for the shape of the indenter; a sum contains several shapes.
import { el } from "./dom.js";
import { chooseUnit, fileSource, readingText } from "./file_source.js";
import { Choice, NumberField, TextField } from "./form_fields.js";
import { COLUMNS, PROFILES, WITHOUT_STRESS } from "./form_options.js";
import { scanFit } from "./scan_fit.js";
import { inPower } from "./units.js";

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
  const said = el("p", { class: "note", "aria-live": "polite" });
  const isScan = type === "tabulated";
  const spacing = el("input", { type: "number", min: 0, step: "any", "aria-label": "Distance of neighbours in a map" });
  let found = null;
  let isChosen = false;
  const powers = () => units.map((unit) => Number(unit.value));
  const symbols = () => units.map((unit) => unit.selectedOptions[0].text.replace("µ", "u"));
  // Any other table is two columns of numbers, whatever they are of.
  const query = () => {
    if (!isScan) return { displacement: 1, force: 2 };
    const [lateral, height] = symbols();
    return { ...(isChosen ? { lateral, height } : {}), ...(Number(spacing.value) > 0 ? { spacing: spacing.value } : {}) };
  };
  const taken = (reply, error) => {
    found = reply;
    const isAssumed = (name) => reply.preview.columns.some(({ quantity, assumed }) => quantity === name && assumed);
    if (isScan && reply && !isChosen) {
      if (!isAssumed("x")) chooseUnit(units[0], reply.units.lateral);
      if (!isAssumed("z")) chooseUnit(units[1], reply.units.height);
    }
    said.textContent = error || isScan ? readingText(reply, error) : "";
    changed();
  };
  const source = fileSource(isScan ? "scan" : "loop", text.control, query, taken, () => (isChosen = false));
  const chosen = () => {
    isChosen = true;
    if (isScan) source.read();
  };
  /** The two columns as they were read; those of a scan of a surface are none. */
  const pair = () => {
    const { x, z } = found?.scan?.line ?? {};
    return isScan ? [x ?? [], z ?? []] : [found?.loop.displacement ?? [], found?.loop.force ?? []];
  };
  // The power goes to the digits, so that 10 mm are 0.01 m to the last bit.
  const inMetres = (value, power) => (value === null ? null : Number(inPower(value, -power, 17)));
  const read = () => {
    const values = pair();
    return Object.fromEntries(described.map(([name], index) => [name, values[index].map((value) => inMetres(value, powers()[index]))]));
  };
  const scan = () => {
    const [lateral, height] = symbols();
    return { scan: found?.scan ?? { line: { x: [], z: [] } }, units: { lateral, height } };
  };
  const write = ({ r, z }) => {
    const inUnit = (value, unit) => Number((value / 10 ** Number(unit.value)).toPrecision(12));
    text.control.value = r.map((radius, index) => `${inUnit(radius, units[0])}\t${inUnit(z[index], units[1])}`).join("\n");
    text.control.dispatchEvent(new Event("input", { bubbles: true }));
  };
  const first = type === "tabulated" ? " The first radius is 0, unless it is a scan to be fitted." : "";
  body.append(
    text.element,
    said,
    el("div", { class: "row", onchange: chosen }, ...described.map(([, name], index) => el("label", {}, name, units[index]))),
    el(
      "p",
      { class: "note" },
      `Paste two columns from a spreadsheet or a file; they are separated by tabs, blanks, commas or semicolons.${first}`,
    ),
  );
  if (isScan) {
    const label = el("label", {}, "Distance of neighbours in a map, if its header does not say ", spacing);
    body.append(el("p", { class: "row", onchange: chosen }, label), scanFit(source, scan, write));
  }
  form.settle(source.settled);
  source.read();
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
