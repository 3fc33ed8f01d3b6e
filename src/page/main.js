// The page: shows the view that the address names.
import { showContact } from "./contact.js";
import { contactList } from "./contact_list.js";
import { createForm } from "./create_form.js";
import { el } from "./dom.js";
import { showHelp } from "./help.js";
import { contactAddress } from "./tabs.js";

const main = document.getElementById("main");
let leave = new AbortController();
/** The contact on screen: its identifier, and the function that opens one of its tabs. */
let shown = null;

async function route(event) {
  const address = contactAddress(location.hash);
  // Another tab of the same contact, but for a link that carries another view of it.
  if (address && shown?.id === address.id && (!address.query || address.query === shown.query()))
    return shown.open(address.tab);
  leave.abort();
  leave = new AbortController();
  const { signal } = leave;
  // A copy of the contact on screen takes its place when it has been loaded, where one was.
  const follows = address && shown !== null;
  shown = null;
  document.title = location.hash === "#/new" ? "New contact – stickslip" : "stickslip";
  // A view that was left meanwhile is not shown.
  const view = el("div", {}, el("p", { class: "note" }, "Loading …"));
  if (!follows) main.replaceChildren(view);
  const [scrolled, focused] = [scrollY, document.activeElement?.id];
  try {
    if (address) {
      const opened = await showContact(view, address, signal, () => follows && main.replaceChildren(view));
      if (!signal.aborted) shown = { id: address.id, ...opened };
    } else if (location.hash === "#/new") createForm(view, signal);
    else if (location.hash === "#/help") showHelp(view);
    else await contactList(view, signal);
  } catch (error) {
    if (signal.aborted) return;
    main.replaceChildren(view);
    view.replaceChildren(
      el("h1", {}, "This view could not be loaded"),
      el("p", { role: "alert" }, error.message),
      el("p", {}, el("a", { href: "#/" }, "To the list of contacts")),
    );
  }
  if (!event || signal.aborted) return;
  if (!follows) return main.focus();
  scrollTo(0, scrolled);
  (document.getElementById(focused) ?? main).focus({ preventScroll: true });
}
addEventListener("hashchange", route);
route();
