// Back to an earlier move: by a fork, so that the contact keeps what it has done.
import { call } from "./api.js";
import { el, notice, noticing } from "./dom.js";
import { numberBox, numberIn } from "./form_fields.js";
import { addressOf, contactAddress } from "./tabs.js";
import { viewQuery } from "./view_link.js";

/** The controls, and a function that shows how far back they may go. */
export function goBack(model) {
  const sequence = () => model.history.at(-1)?.sequence ?? model.first.sequence;
  const to = noticing(async (read) => {
    // The copy of an earlier press is on its way.
    if (model.signal.aborted) return;
    const move = read();
    const { id } = await call("POST", `/contacts/${model.id}/fork`, { sequence: move });
    location.hash = `${addressOf(id, contactAddress(location.hash).tab)}${viewQuery()}`;
    const moves = `${move} ${move === 1 ? "move" : "moves"}`;
    const more = "a copy of the same name. The one with all its moves stays in the list.";
    notice(`The contact as it was after ${moves}: ${more}`);
  }, model.signal);
  const undo = el("button", { type: "button", id: "undo", onclick: () => to(() => sequence() - 1) }, "Undo");
  const box = numberBox({ id: "back-to", size: 5, value: "0", "aria-label": "Move to go back to" });
  const go = el("button", { id: "go-back" }, "Back to move");
  const begin = (event) => {
    event.preventDefault();
    to(() => numberIn(box) ?? 0);
  };
  const element = el("form", { class: "row", onsubmit: begin }, undo, go, box);
  const show = () => {
    const last = sequence();
    for (const one of [undo, go, box]) one.disabled = last === 0;
  };
  return { element, show };
}
