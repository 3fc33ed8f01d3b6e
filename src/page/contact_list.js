// The list of contacts, with a search by the service.
import { call, pages } from "./api.js";
import { copyMenu } from "./copy_as_code.js";
import { debounce, el, latestOnly } from "./dom.js";
import { firstContact } from "./first_contact.js";
import { PROFILES } from "./form_options.js";
import { formatQuantity } from "./units.js";

const MOST = 5000;
const SHOWN = 200;
/** How long one must not type before the service searches, ms. */
const REST = 200;
const PRELOADS = { normal_force: ["", "N"], indentation: ["d = ", "m"], contact_radius: ["a = ", "m"] };

/** Shows the list in `main`, until `signal`. */
export async function contactList(main, signal) {
  const items = await pages("/contacts?order=newest", MOST);
  const rows = el("ul", { class: "list" });
  const said = el("p", { class: "note", "aria-live": "polite" });
  // Shape and load of those rows alone that are looked at: a definition may be long.
  const seen = new IntersectionObserver((entries) => {
    for (const { target, isIntersecting } of entries) {
      if (!isIntersecting) continue;
      seen.unobserve(target);
      describe(target, signal).catch(() => {});
    }
  });
  const show = (found) => {
    seen.disconnect();
    rows.replaceChildren(...found.slice(0, SHOWN).map(row));
    for (const one of rows.querySelectorAll(".shape")) seen.observe(one);
    const more = found.length > SHOWN ? `, the newest ${SHOWN} of which are shown` : "";
    said.textContent = items.length
      ? `${found.length} of ${items.length < MOST ? "" : "the newest "}${items.length} contacts${more}`
      : "";
  };
  const search = latestOnly(async (text) => {
    const wanted = text.trim();
    if (!wanted) return show(items);
    const labelled = await pages(`/contacts?order=newest&label=${encodeURIComponent(wanted)}`, MOST);
    const named = items.filter(({ id }) => id.startsWith(wanted.toLowerCase()));
    show([...named, ...labelled.filter(({ id }) => !named.some((one) => one.id === id))]);
  });
  const ask = debounce((text) => search(text).catch((error) => (said.textContent = error.message)), REST);
  show(items);
  const field = el(
    "div",
    { class: "field search" },
    el("label", { for: "search" }, "Search"),
    el("input", {
      type: "search",
      id: "search",
      autocomplete: "off",
      placeholder: "part of a label, or an identifier",
      maxlength: 200,
      oninput: (event) => ask(event.target.value),
    }),
  );
  main.replaceChildren(
    el(
      "div",
      { class: "head" },
      el("h1", {}, "Contacts"),
      el("a", { class: "button primary", href: "#/new", id: "new" }, "New contact"),
      copyMenu(() => [{ method: "GET", path: "/contacts?limit=1000" }]),
    ),
    ...(items.length ? [field, said, rows] : [firstContact(signal)]),
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
      el("span", { class: "shape", "data-id": item.id }),
      el("span", { class: "faint" }, item.id),
      el("span", {}, moves),
      time,
    ),
  );
}

/** Fills in the shape of a contact and the load that it began with. */
async function describe(place, signal) {
  const { profile, preload } = await call("GET", `/contacts/${place.dataset.id}/definition`, undefined, signal);
  const [[kind, value]] = Object.entries(preload);
  const [prefix, unit] = PRELOADS[kind];
  place.textContent = `${PROFILES[profile.type][0]}, ${prefix}${formatQuantity(value, unit)}`;
}
