// The list of contacts, with a search.
import { pages } from "./api.js";
import { copyButtons } from "./copy_as_code.js";
import { el } from "./dom.js";

const MOST = 5000;
const SHOWN = 200;

/** Shows the list in `main`. */
export async function contactList(main) {
  const items = (await pages("/contacts", MOST)).reverse();
  const rows = el("ul", { class: "list" });
  const said = el("p", { class: "note", "aria-live": "polite" });
  const fill = (text) => {
    const words = text.toLowerCase().split(/\s+/).filter(Boolean);
    const found = items.filter((item) =>
      words.every((word) => `${item.label ?? ""} ${item.id}`.toLowerCase().includes(word)),
    );
    rows.replaceChildren(...found.slice(0, SHOWN).map(row));
    const more = found.length > SHOWN ? `, the newest ${SHOWN} of which are shown` : "";
    said.textContent = items.length ? `${found.length} of ${items.length} contacts${more}` : "";
  };
  fill("");
  const search = el(
    "div",
    { class: "field search" },
    el("label", { for: "search" }, "Search"),
    el("input", {
      type: "search",
      id: "search",
      autocomplete: "off",
      placeholder: "label or identifier",
      oninput: (event) => fill(event.target.value),
    }),
  );
  const empty = el(
    "section",
    { class: "card welcome" },
    el("h2", {}, "No contact yet"),
    el(
      "p",
      {},
      "A ball is pressed on a plane and moved sideways: its middle sticks, a ring at its edge slips, and what it does next depends on all that it has done before. Make a contact, move it, and watch.",
    ),
    el("a", { class: "button primary", href: "#/new" }, "Make the first contact"),
  );
  main.replaceChildren(
    el(
      "div",
      { class: "head" },
      el("h1", {}, "Contacts"),
      el("a", { class: "button primary", href: "#/new", id: "new" }, "New contact"),
      copyButtons(() => [{ method: "GET", path: "/contacts?limit=1000" }]),
    ),
    ...(items.length ? [search, said, rows] : [empty]),
  );
}

function row(item) {
  const moves = `${item.sequence} ${item.sequence === 1 ? "move" : "moves"}`;
  const time = el("time", { datetime: item.updated_at }, new Date(item.updated_at).toLocaleString());
  return el(
    "li",
    {},
    el(
      "a",
      { href: `#/contacts/${item.id}` },
      el("strong", {}, item.label ?? "Unnamed contact"),
      el("span", { class: "faint" }, item.id),
      el("span", {}, moves),
      time,
    ),
  );
}
