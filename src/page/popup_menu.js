// A menu that opens below its button, and closes by Escape, by a choice, or when the focus leaves it.
import { el } from "./dom.js";

/** An entry; `label` is its name where the text alone would not say what it does. */
export const menuEntry = (text, act, label) =>
  el(
    "button",
    {
      type: "button",
      "aria-label": label,
      onclick: (event) => {
        event.currentTarget.closest("details").open = false;
        act();
      },
    },
    text,
  );

/** A menu of entries; `label` is its name where the text of its button would not say it. */
export function popupMenu(text, { label, ...attributes }, entries) {
  return el(
    "details",
    {
      ...attributes,
      onkeydown: (event) => {
        if (event.key !== "Escape") return;
        event.currentTarget.open = false;
        event.currentTarget.firstElementChild.focus();
      },
      onfocusout: (event) => {
        if (!event.currentTarget.contains(event.relatedTarget)) event.currentTarget.open = false;
      },
    },
    el("summary", { "aria-label": label, title: label }, text),
    el("div", {}, ...entries),
  );
}
