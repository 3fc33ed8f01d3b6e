// The part of the form for the shape of the indenter; a sum contains several shapes.
import { el } from "./dom.js";
import { chooseUnit, columnsTable, fileSource, readingText } from "./file_source.js";
import { Choice, NumberField, TextField, numberBox, numberIn } from "./form_fields.js";
import { COLUMNS, LINE_CONTACTS, PROFILES, WITHOUT_STRESS } from "./form_options.js";
import { scanFit } from "./scan_fit.js";
import { specimenPicture } from "./specimens.js";
import { inPower } from "./units.js";

const LINE_NOTE =
  "In plane strain; forces are totals over the length. The reference length fixes the displacements, which a line " +
  "contact leaves open: stresses and the work of closed cycles do not depend on it.";

/** An editor of a profile at the pointer that `at` gives; `changed` is called when its fields change. */
export function profileFields(form, at, changed, nested = false) {
  const names = Object.entries(PROFILES)
    .filter(([key]) => !nested || !["sum", ...WITHOUT_STRESS, ...LINE_CONTACTS].includes(key))
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
  const fill = (given) => {
    body.replaceChildren();
    read = (choice.value in COLUMNS ? columns : choice.value === "sum" ? sum : numbers)(
      form,
      at,
      changed,
      body,
      choice.value,
      given,
      nested ? undefined : take,
    );
    changed();
  };
  /** Takes a whole profile in place of the one that stands here. */
  const take = (profile) => {
    choice.control.value = profile.type;
    fill(profile);
  };
  choice.control.addEventListener("change", () => fill());
  const element = el("div", {}, choice.element, body);
  fill();
  return { element, type: () => choice.value, value: () => ({ type: choice.value, ...read() }) };
}

function numbers(form, at, _changed, body, type, given) {
  const fields = PROFILES[type][1].map((about) => {
    const place = () => `${at()}/${about.name}`;
    const field = about.options
      ? new Choice(form, place, about.label, about.options, Object.keys(about.options)[0])
      : new NumberField(form, place, about);
    const [list, index] = about.name.split("/");
    const value = index === undefined ? given?.[list] : given?.[list]?.[index];
    if (typeof value === "number" && field instanceof NumberField) {
      field.control.value = inPower(value, Number(field.choice?.value ?? 0), 6);
    }
    return [about.name, field];
  });
  if (LINE_CONTACTS.includes(type)) body.append(specimenPicture(type));
  body.append(...fields.map(([, field]) => field.element));
  if (LINE_CONTACTS.includes(type)) body.append(el("p", { class: "note" }, LINE_NOTE));
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

function columns(form, at, changed, body, type, _given, take) {
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
  const table = columnsTable(
    () => kind,
    (mapping) => source.map(mapping),
  );
  const isScan = type === "tabulated";
  const spacing = numberBox({ size: 8, "aria-label": "Distance of neighbours in a map" });
  let found = null;
  /** The lists of units in which somebody chose, or of which the file says nothing: they count, and not the file. */
  const chosen = new Set();
  // Two lengths are read as a line of a scan, a length and a force as a loop.
  const [kind, quantities, hints] =
    type === "load_curve"
      ? ["loop", ["displacement", "force"], ["displacement_unit", "force_unit"]]
      : ["scan", ["x", "z"], ["lateral", "height"]];
  const unitsOf = ({ units: own }) => (kind === "scan" ? [own.lateral, own.height] : [own.displacement, own.force]);
  const powers = () => units.map((unit) => Number(unit.value));
  const symbols = () => units.map((unit) => unit.selectedOptions[0].text.replace("µ", "u"));
  const query = () => {
    const given = hints.map((name, index) => [name, chosen.has(units[index]) ? symbols()[index] : undefined]);
    const more = kind === "loop" ? { displacement: 1, force: 2 } : { spacing: numberIn(spacing) };
    return Object.fromEntries([...given, ...Object.entries(more)].filter(([, hint]) => hint !== undefined));
  };
  const taken = (reply, error) => {
    found = reply;
    const unnamed = [];
    for (const [index, unit] of units.entries()) {
      if (!reply || chosen.has(unit)) continue;
      const isAssumed = reply.preview.columns.some(
        ({ quantity, assumed }) => quantity === quantities[index] && assumed,
      );
      if (isAssumed) unnamed.push(unit);
      else chooseUnit(unit, unitsOf(reply)[index]);
    }
    // Once more with the units that stand here, so that what is said of the file is in them.
    if (unnamed.length) {
      for (const unit of unnamed) chosen.add(unit);
      return void source.read();
    }
    table.show(reply, error);
    said.textContent = error || isScan ? readingText(reply, error) : "";
    changed();
  };
  const source = fileSource(kind, text.control, query, taken, () => chosen.clear());
  const choose = ({ target }) => {
    if (units.includes(target)) chosen.add(target);
    source.read();
  };
  /** The two columns as they were read; a scan of a surface has no such columns. */
  const pair = () => {
    const { x = [], z = [] } = found?.scan?.line ?? {};
    return kind === "scan" ? [x, z] : [found?.loop.displacement ?? [], found?.loop.force ?? []];
  };
  // The power goes to the digits, so that 10 mm are 0.01 m to the last bit.
  const inMetres = (value, power) => (value === null ? null : Number(inPower(value, -power, 17)));
  const read = () => {
    const values = pair();
    return Object.fromEntries(
      described.map(([name], index) => [name, values[index].map((value) => inMetres(value, powers()[index]))]),
    );
  };
  const scan = () => {
    const [lateral, height] = symbols();
    return { scan: found?.scan ?? { line: { x: [], z: [] } }, units: { lateral, height } };
  };
  const write = ({ r, z }) => {
    const inUnit = (value, unit) => Number((value / 10 ** Number(unit.value)).toPrecision(12));
    text.control.value = r
      .map((radius, index) => `${inUnit(radius, units[0])}\t${inUnit(z[index], units[1])}`)
      .join("\n");
    text.control.dispatchEvent(new Event("input", { bubbles: true }));
  };
  const first = type === "tabulated" ? " The first radius is 0, unless it is a scan to be fitted." : "";
  body.append(
    text.element,
    said,
    table.element,
    el(
      "div",
      { class: "row", onchange: choose },
      ...described.map(([, name], index) => el("label", {}, name, units[index])),
    ),
    el(
      "p",
      { class: "note" },
      "Paste two columns from a spreadsheet or a file; they are separated by tabs, blanks, commas or semicolons.",
      first,
    ),
  );
  if (isScan) {
    const distance = el("label", {}, "Distance of neighbours in a map, if its header does not say ", spacing);
    body.append(el("p", { class: "row", onchange: choose }, distance), scanFit(source, scan, write, take));
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
