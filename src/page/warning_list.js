// Warnings of the service, in colour beside the result that they concern.
import { el } from "./dom.js";

/** An empty list of warnings; `id` is that of its element. */
export const warningList = (id) => el("ul", { class: "warnings", id });

/** Shows the warnings of a reply in a list. */
export function showWarnings(list, warnings = []) {
  list.replaceChildren(...warnings.map(({ message }) => el("li", {}, message[0].toUpperCase() + message.slice(1))));
}
