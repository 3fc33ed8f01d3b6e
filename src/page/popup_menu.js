// A menu that opens below its button: a popover, which Escape, a choice or a click elsewhere closes.
import { el } from "./dom.js";

let count = 0;

/** An entry; `label` is its name where the text alone would not say what it does. */
export const menuEntry = (text, act, label) =>
  el(
    "button",
    {
      type: "button",
      "aria-label": label,
      onclick: ({ currentTarget }) => {
        currentTarget.closest("[popover]").hidePopover();
        act();
      },
    },
    text,
  );

/** A menu of entries; `label` is its name where the text of its button would not say it.
 * @param {string} text
 * @param {{ label?: string, class: string, id?: string }} about
 * @param {HTMLElement[]} entries */
export function popupMenu(text, { label, ...attributes }, entries) {
  const id = `menu-${(count += 1)}`;
  return el(
    "div",
    attributes,
    el("button", { type: "button", popovertarget: id, "aria-label": label, title: label }, text),
    el("div", { popover: "", id }, ...entries),
  );
}
