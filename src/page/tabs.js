// The tabs of a contact, one for each question. Each has an address of its own, so that reload, back and links lead to
// it.
import { el, mapped } from "./dom.js";

/** The tabs by the last part of their address, in their order. */
export const TABS = {
  live: "Live",
  loop: "Measured loop",
  crack: "Will it crack?",
  damping: "Damping",
  residual: "Residual stress",
  accuracy: "Accuracy",
};

/** The contact, the tab and the query of an address; nothing where the address is of another view. */
export function contactAddress(hash) {
  const [, id, tab = "live", query = ""] = hash.match(/^#\/contacts\/([\w-]+)(?:\/(\w+))?(\?.*)?$/) ?? [];
  return id && { id, tab: tab in TABS ? tab : "live", query };
}

/** The address of a tab, without its query. */
export const addressOf = (id, tab) => `#/contacts/${id}${tab === "live" ? "" : `/${tab}`}`;

/** The links of the tabs, and the function that shows the panel of one of them. `panels` are those of this contact, by
 *  tab. */
export function tabBar(id, panels) {
  const links = mapped(panels, (_, tab) => el("a", { href: addressOf(id, tab), id: `to-${tab}` }, TABS[tab]));
  const element = el("nav", { class: "tabs", "aria-label": "Questions" }, ...Object.values(links));
  let current = links.live;
  // On a phone the bar is wider than the window.
  const bringIntoView = () => element.scrollTo({ left: current.offsetLeft - 40 });
  new ResizeObserver(bringIntoView).observe(element);
  const open = (wanted) => {
    const tab = wanted in panels ? wanted : "live";
    for (const [name, panel] of Object.entries(panels)) panel.hidden = name !== tab;
    current.removeAttribute("aria-current");
    current = links[tab];
    current.setAttribute("aria-current", "page");
    bringIntoView();
    return tab;
  };
  return { element, open };
}

/** Columns of cards, so that a tall card leaves no blank beside a short one. */
export const columns = (...lists) =>
  el("div", { class: "columns" }, ...lists.map((cards) => el("div", { class: "column" }, ...cards)));
