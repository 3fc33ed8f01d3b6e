// The view in the address: the zoom of plots, the lines switched off, chosen units, and the contact compared with. A
// link, a bookmark or a reload shows the same again.
import { notice } from "./dom.js";
import { menuEntry } from "./popup_menu.js";

/** The view that the address has, as it stands behind the identifier of a contact and its tab. */
export const viewQuery = () => location.hash.match(/\?.*$/)?.[0] ?? "";

/** Keeps the address in step with plots, unit choices and the contact compared with, once it has been applied to them.
 *  What it returns copies the link, and writes the view to the address of a tab that was opened. */
export function viewLink({ plots, units, overlay }) {
  const given = new URLSearchParams(viewQuery());
  for (const plot of plots) {
    const range = given.get(plot.name)?.split(",").map(Number) ?? [];
    if (range.length === 4 && range.every(Number.isFinite) && range[0] < range[1] && range[2] !== range[3])
      plot.view = { x: range.slice(0, 2), y: range.slice(2) };
    for (const name of given.getAll(`${plot.name}-off`)) plot.hidden.add(name);
  }
  for (const choice of units) {
    const wanted = [...choice.options].find((option) => option.text === given.get(choice.id));
    if (wanted) choice.value = wanted.value;
  }
  let query = "";
  const write = () => {
    const now = new URLSearchParams();
    for (const plot of plots) {
      if (plot.view)
        now.set(plot.name, [...plot.view.x, ...plot.view.y].map((value) => Number(value.toPrecision(5))).join());
      for (const name of plot.hidden) now.append(`${plot.name}-off`, name);
    }
    for (const choice of units) if (choice.value !== "") now.set(choice.id, choice.selectedOptions[0].text);
    if (overlay.other()) now.set("with", overlay.other());
    const [path] = location.hash.split("?");
    query = now.size ? `?${now}` : "";
    // Not through `location`, which would load the view anew.
    history.replaceState(null, "", `${path}${query}`);
  };
  for (const plot of plots) plot.onlook = write;
  for (const choice of units) choice.addEventListener("change", write);
  overlay.oncompare = write;
  if (given.get("with")) overlay.compare(given.get("with"));
  return { write, query: () => query, entry: menuEntry("Copy link", copy) };
}

async function copy() {
  try {
    await navigator.clipboard.writeText(location.href);
    notice("The link to this view is copied.");
  } catch {
    notice("The address of this page is the link to this view.");
  }
}
