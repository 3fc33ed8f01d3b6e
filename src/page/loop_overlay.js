// What is drawn over the loop of a contact: a loop that a bench has measured, from a file, and the loop of another contact.
import { call, follow, pages } from "./api.js";
import { debounce, el, notice } from "./dom.js";
import { FORCE, LENGTH } from "./form_options.js";
import { columnOf, unitOf } from "./loop_record.js";
import { guessColumn, tableRows, textOf } from "./table_text.js";
import { parseNumber } from "./units.js";

/** Moves of the other contact, and contacts to choose from. */
const [MOVES, CHOICES] = [1000, 200];

/** The controls below the plot, and what they add to it; `changed` draws it anew. */
export function loopOverlay(model, loop, changed) {
  const measured = measuredFile(loop, changed);
  const other = otherContact(model, changed);
  const element = el(
    "details",
    { class: "overlay", id: "overlay", ontoggle: other.list },
    el("summary", {}, "Compare with a measured file or another contact"),
    measured.element,
    other.element,
  );
  measured.opened = () => (element.open = true);
  loop.element.append(element);
  return {
    loop: () => [...measured.series(), ...other.loop()],
    shear: other.shear,
    other: other.id,
    compare: other.compare,
    set oncompare(act) {
      other.chosen = act;
    },
  };
}

/** A file of two columns, chosen or dropped on the plot. It stays in the browser. */
function measuredFile(loop, changed) {
  const one = { opened: () => {} };
  const units = { displacement: unitOf("measured displacement", LENGTH, "µm"), force: unitOf("measured force", FORCE, "N") };
  const columns = { displacement: columnOf("measured displacement", 1), force: columnOf("measured force", 2) };
  const said = el("p", { class: "note", id: "overlay-said", "aria-live": "polite" });
  let file = null;
  let points = [];
  const read = () => {
    if (!file) return;
    const value = (row, name) => parseNumber(row[Number(columns[name].value) - 1] ?? "", Number(units[name].value));
    const pairs = tableRows(file.text).map((row) => [value(row, "displacement"), value(row, "force")]);
    const whole = pairs.filter((pair) => pair.every((number) => typeof number === "number"));
    // A row that lacks a number is a gap of the line.
    points = whole.length ? pairs.map((pair) => (whole.includes(pair) ? pair : [0, null])) : [];
    said.textContent = whole.length
      ? `${whole.length} points of ${file.name}.`
      : `There are no numbers in columns ${columns.displacement.value} and ${columns.force.value} of ${file.name}.`;
    changed();
  };
  const open = async (chosen) => {
    if (!chosen) return;
    file = { name: chosen.name, text: await textOf(chosen) };
    for (const name of ["displacement", "force"]) {
      const guess = guessColumn(file.text, name);
      if (!guess) continue;
      columns[name].value = String(guess.column);
      const unit = [...units[name].options].find((option) => option.text.replace("µ", "u") === guess.unit);
      if (unit) units[name].value = unit.value;
    }
    one.opened();
    read();
  };
  const input = el("input", { type: "file", id: "overlay-file", onchange: (event) => open(event.target.files[0]) });
  const clear = () => {
    file = null;
    points = [];
    input.value = "";
    said.textContent = "";
    changed();
  };
  const mark = (is) => loop.element.classList.toggle("dropping", is);
  loop.element.addEventListener("dragover", (event) => {
    event.preventDefault();
    mark(true);
  });
  loop.element.addEventListener("dragleave", () => mark(false));
  loop.element.addEventListener("drop", (event) => {
    event.preventDefault();
    mark(false);
    open(event.dataTransfer.files[0]);
  });
  one.element = el(
    "fieldset",
    { onchange: (event) => event.target !== input && read() },
    el("legend", {}, "A measured loop, chosen or dropped on the plot"),
    el("label", {}, "File ", input),
    el("div", { class: "row" }, el("label", {}, "Displacement: column ", columns.displacement), units.displacement),
    el("div", { class: "row" }, el("label", {}, "Force: column ", columns.force), units.force),
    el("button", { type: "button", class: "quiet", onclick: clear }, "Clear"),
    said,
  );
  one.series = () => (points.length ? [{ name: `file ${file.name.slice(0, 40).replaceAll("_", " ")}`, kind: "file", points }] : []);
  return one;
}

/** Another contact, whose loop and shear stress follow its moves. */
function otherContact(model, changed) {
  const one = { chosen: () => {} };
  const choice = el("select", { id: "compare" }, el("option", { value: "" }, "none"));
  const name = () => `other: ${(choice.selectedOptions[0]?.text ?? "").replaceAll("_", " ")}`;
  let leave = new AbortController();
  let points = [];
  let shear = [];
  const load = async (id, signal) => {
    const page = await call("GET", `/contacts/${id}/loop?last=${MOVES}&points_per_move=16`, undefined, signal);
    points = page.displacement.map((x, index) => [x, page.force[index]]);
    // A contact that is known by its load curve alone has no stress.
    const stress = await call("GET", `/contacts/${id}/stress?points=300&fields=shear`, undefined, signal).catch(() => null);
    shear = stress ? stress.radius.map((r, index) => [r, stress.shear[index]]) : [];
    changed();
  };
  one.compare = async (id) => {
    leave.abort();
    leave = new AbortController();
    const signal = AbortSignal.any([leave.signal, model.signal]);
    [points, shear] = [[], []];
    try {
      if (id) {
        const contact = await call("GET", `/contacts/${id}`, undefined, signal);
        if (![...choice.options].some((option) => option.value === id))
          choice.append(el("option", { value: id }, contact.label ?? `${id.slice(0, 8)}…`));
        choice.value = id;
        await load(id, signal);
        const again = debounce(() => load(id, signal).catch(() => {}), 200);
        follow(id, contact.sequence, again, () => {}, signal);
      }
    } catch (error) {
      choice.value = "";
      if (!signal.aborted) notice(error.message, true);
    }
    one.chosen();
    changed();
  };
  one.list = async () => {
    one.list = () => {};
    const items = (await pages("/contacts", 5 * MOVES)).reverse().slice(0, CHOICES);
    for (const { id, label } of items)
      if (id !== model.id && ![...choice.options].some((option) => option.value === id))
        choice.append(el("option", { value: id }, label ?? `${id.slice(0, 8)}…`));
  };
  choice.addEventListener("change", () => one.compare(choice.value));
  one.element = el("p", { class: "row" }, el("label", {}, "Another contact ", choice));
  one.id = () => choice.value;
  one.loop = () => (points.length ? [{ name: name(), kind: "other", points }] : []);
  one.shear = () => (shear.length ? [{ name: `τ of ${name()}`, kind: "other", points: shear }] : []);
  return one;
}
