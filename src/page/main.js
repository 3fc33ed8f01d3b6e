// The page: which view the address names.
import { contact } from "./contact.js";
import { el } from "./dom.js";
import { create } from "./form.js";
import { list } from "./list.js";

const main = document.getElementById("main");
let leave = new AbortController();

async function route(event) {
  leave.abort();
  leave = new AbortController();
  const { signal } = leave;
  const [, id] = location.hash.match(/^#\/contacts\/([\w-]+)$/) ?? [];
  document.title = id ? "Contact – stickslip" : location.hash === "#/new" ? "New contact – stickslip" : "stickslip";
  // What is made for a view that has been left goes nowhere.
  const view = el("div", {});
  main.replaceChildren(view);
  try {
    if (id) await contact(view, id, signal);
    else if (location.hash === "#/new") create(view, signal);
    else await list(view);
  } catch (error) {
    if (!signal.aborted)
      view.replaceChildren(
        el("h1", {}, "That did not work"),
        el("p", { role: "alert" }, error.message),
        el("p", {}, el("a", { href: "#/" }, "To the list of contacts")),
      );
  }
  if (event) main.focus();
}
addEventListener("hashchange", route);
route();
