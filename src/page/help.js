// What the page can do, and what its figures mean: the view of the address `#/help`.
import { el, withSubscripts } from "./dom.js";
import { MEANINGS } from "./meanings.js";

/** The questions of the tabs, and where each is answered. */
const QUESTIONS = [
  ["Where does it stick, and where does it slip?", "Live: pull the displacement, or type a force or a load."],
  ["What are friction and stiffness in the loop that I measured?", "Measured loop: give the file of the rig."],
  ["Would a crack start?", "Will it crack?: criteria over a steady cycle, the worst place, margin and life."],
  ["How much does it damp, and what will wear?", "Damping: a steady cycle, a fretting map, a mass on the contact."],
  ["Which stress remains, and which motion removes it?", "Residual stress: protocols, and how much they leave."],
  ["How sure are the numbers?", "Accuracy: the stated errors, the warnings, and the solvers beside each other."],
];

const list = (rows) =>
  el(
    "dl",
    { class: "help" },
    ...rows.flatMap(([name, text]) => [el("dt", {}, withSubscripts(name)), el("dd", {}, text)]),
  );

/** Shows the help in `main`. */
export function showHelp(main) {
  document.title = "Help – stickslip";
  main.replaceChildren(
    el("h1", {}, "Help"),
    el("section", { class: "card" }, el("h2", {}, "By question"), list(QUESTIONS)),
    el("section", { class: "card" }, el("h2", {}, "What the figures mean"), list(Object.entries(MEANINGS))),
    el(
      "section",
      { class: "card" },
      el("h2", {}, "Beside the page"),
      el(
        "p",
        {},
        "Copy or save has the requests behind each tab, for curl and for Python. ",
        el("a", { href: "docs/" }, "All calls"),
        " can be tried in a form.",
      ),
    ),
  );
}
