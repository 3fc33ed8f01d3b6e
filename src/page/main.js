// The page: shows the view that the address names.
import { showContact } from "./contact.js";
import { contactList } from "./contact_list.js";
import { createForm } from "./create_form.js";
import { el } from "./dom.js";

const main = document.getElementById("main");
let leave = new AbortController();

async function route(event) {
  leave.abort();
  leave = new AbortController();
  const { signal } = leave;
  const [, id] = location.hash.match(/^#\/contacts\/([\w-]+)(\?.*)?$/) ?? [];
  document.title = id ? "Contact – stickslip" : location.hash === "#/new" ? "New contact – stickslip" : "stickslip";
  // A view that was left meanwhile is not shown.
  const view = el("div", {}, el("p", { class: "note" }, "Loading …"));
  main.replaceChildren(view);
  try {
    if (id) await showContact(view, id, signal);
    else if (location.hash === "#/new") createForm(view, signal);
    else await contactList(view, signal);
  } catch (error) {
    if (!signal.aborted)
      view.replaceChildren(
        el("h1", {}, "This view could not be loaded"),
        el("p", { role: "alert" }, error.message),
        el("p", {}, el("a", { href: "#/" }, "To the list of contacts")),
      );
  }
  if (event) main.focus();
}
addEventListener("hashchange", route);
route();
