// The page: a list of contacts, and one contact with its loop.
import { call, follow, pages } from "./api.js";
import { el, latest, notice } from "./dom.js";
import { shown } from "./units.js";

const main = document.getElementById("main");
let leave = new AbortController();

async function list() {
  const items = await pages("/contacts", 5000);
  const rows = el("ul", { class: "list" });
  const fill = (word) => rows.replaceChildren(...items.filter((item) => `${item.label ?? ""} ${item.id}`.toLowerCase().includes(word.toLowerCase()))
    .reverse().map((item) => el("li", {}, el("a", { href: `#/contacts/${item.id}` }, item.label ?? item.id), ` ${item.sequence} moves`)));
  fill("");
  main.replaceChildren(el("h1", {}, "Contacts"), el("label", {}, "Search ", el("input", { type: "search", oninput: (event) => fill(event.target.value) })), rows,
    el("p", {}, items.length ? "" : "There is no contact yet: make one by POST /contacts."));
}

async function contact(id, signal) {
  const session = await call("GET", `/contacts/${id}`);

  const figures = el("p", { "aria-live": "polite" });
  const limit = 1.5 * session.contact.gross_slip_displacement || 1e-6;
  const move = latest((displacement) => call("POST", `/contacts/${id}/move`, { displacement }).catch((error) => notice(error.message, true)));
  const slider = el("input", { type: "range", min: -limit, max: limit, step: limit / 300, oninput: () => move(Number(slider.value)) });
  const show = (state) => {
    figures.textContent = `U ${shown(state.displacement, "m")}, F ${shown(state.force, "N")}, F_N ${shown(state.normal_force, "N")}, ${state.regime.replace("_", " ")}`;
    if (document.activeElement !== slider) slider.value = state.displacement;
  };
  show(session.state);
  main.replaceChildren(el("h1", {}, session.label ?? id), figures, el("label", {}, "Displacement ", slider));
  follow(id, session.sequence, (event) => { show(event.state); }, () => {}, signal);
}

async function route() {
  leave.abort();
  leave = new AbortController();
  const found = location.hash.match(/^#\/contacts\/([\w-]+)$/);
  try { await (found ? contact(found[1], leave.signal) : list()); } catch (error) { main.replaceChildren(el("p", { role: "alert" }, error.message)); }
}
addEventListener("hashchange", route);
route();
