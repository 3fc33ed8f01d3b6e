// What is drawn over the loop of a contact: a loop that a bench has measured, from a file, and the loop of another
// contact.
import { call, follow, pages } from "./api.js";
import { debounce, el, notice } from "./dom.js";
import { columnsTable, fileSource, loopColumns, powerOfUnit, readingText } from "./file_source.js";
import { placesOf } from "./line_contact.js";

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

/** A file of a bench, chosen or dropped on the plot; the service reads it, and keeps nothing of it. */
function measuredFile(loop, changed) {
  const one = { opened: () => {} };
  const columns = loopColumns("measured ");
  const said = el("p", { class: "note", id: "overlay-said", "aria-live": "polite" });
  const table = columnsTable(
    () => "loop",
    (mapping) => source.map(mapping),
  );
  let name = "";
  let points = [];
  const taken = (reply, error) => {
    columns.show(reply);
    table.show(reply, error);
    const { displacement = [], force = [] } = reply?.loop ?? {};
    const factor = (quantity) => 10 ** powerOfUnit(reply.units[quantity]);
    points = displacement.map((value, index) => [value * factor("displacement"), force[index] * factor("force")]);
    const unnamed = (reply?.preview.columns ?? []).filter(
      ({ quantity, assumed }) => quantity in reply.units && assumed,
    );
    const assumed = unnamed.map(
      ({ quantity, unit }) => ` Nothing says the unit of the ${quantity}: ${unit} is assumed.`,
    );
    said.textContent = reply
      ? `${points.length} points of ${name}.${assumed.join("")}`
      : `${name}: ${readingText(reply, error)}`;
    changed();
  };
  const source = fileSource("loop", el("textarea", {}), columns.query, taken, columns.reset);
  const open = (chosen) => {
    if (!chosen) return;
    name = chosen.name;
    one.opened();
    source.open(chosen);
  };
  const input = el("input", { type: "file", id: "overlay-file", onchange: (event) => open(event.target.files[0]) });
  const clear = () => {
    [name, points, input.value, said.textContent] = ["", [], "", ""];
    table.show();
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
    {},
    el("legend", {}, "A measured loop, chosen or dropped on the plot"),
    el("label", {}, "File ", input),
    table.element,
    el("div", { onchange: () => name && source.read() }, ...columns.rows),
    el("button", { type: "button", class: "quiet", onclick: clear }, "Clear"),
    said,
  );
  one.series = () =>
    points.length ? [{ name: `file ${name.slice(0, 40).replaceAll("_", " ")}`, kind: "file", points }] : [];
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
    const stress = await call("GET", `/contacts/${id}/stress?points=300&fields=shear`, undefined, signal).catch(
      () => null,
    );
    // Stresses over x and over the radius do not belong into one plot.
    const isComparable = stress && (stress.x !== undefined) === model.isLine;
    shear = isComparable ? placesOf(stress).map((x, index) => [x, stress.shear[index]]) : [];
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
    const items = (await pages("/contacts?order=newest", CHOICES)).slice(0, CHOICES);
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
