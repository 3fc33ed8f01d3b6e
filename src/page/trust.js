// How far the results of a contact can be trusted: the estimated errors over its whole history, and the warnings.
import { call } from "./api.js";
import { el, figure } from "./dom.js";
import { latestAnswer } from "./study.js";
import { formatNumber } from "./units.js";
import { showWarnings, warningList } from "./warning_list.js";

/** How long the contact rests before the service is asked, ms. */
const REST = 400;

/** The card, the warnings to stand beside the state, and a function that asks anew when the contact has moved. */
export function trustCard(model) {
  const figures = el("dl", { class: "figures" });
  const warnings = warningList("warnings");
  const heading = el("summary", {}, "Accuracy and warnings");
  const element = el("details", { class: "card trust", id: "trust-card", open: true }, heading, figures, warnings);
  const count = el("summary", {});
  const beside = warningList("state-warnings");
  const line = el("details", { class: "warned", id: "warned", hidden: true }, count, beside);
  // The history as it was sent; of a long one only its contact is judged.
  const request = () => {
    const moves = model.isComplete ? model.history.map(({ move }) => move) : [];
    const path = moves.length ? { moves } : { displacement: [0] };
    return { contact: model.definition, path, steps: "last" };
  };
  const showReply = ({ accuracy, warnings: found }) => {
    figures.replaceChildren(
      figure("Error of forces, of μ F_N", formatNumber(accuracy.force_error, 2)),
      ...(model.stress ? [figure("Error of stresses, of μ p_max", formatNumber(accuracy.stress_error, 2))] : []),
      ...(typeof accuracy.coupling_bound === "number"
        ? [figure("Stiffer by coupling, at most", `${formatNumber(100 * accuracy.coupling_bound, 2)} %`)]
        : []),
      ...(model.isComplete ? [] : [figure("Of", "the contact alone: its history is long")]),
    );
    const number = found.length === 1 ? "1 warning" : `${found.length} warnings`;
    heading.textContent = found.length ? `Accuracy, and ${number}` : "Accuracy: no warnings";
    count.textContent = number;
    line.hidden = found.length === 0;
    for (const list of [warnings, beside]) showWarnings(list, found);
  };
  const follow = latestAnswer(model, REST, {
    ask: (asked) => call("POST", "/simulate", asked, model.signal),
    show: showReply,
    fail: (error) => figures.replaceChildren(el("div", {}, el("dd", {}, error.message))),
  });
  const show = () => follow(model.history.at(-1)?.sequence ?? model.first.sequence, request);
  return { element, line, show, calls: () => [{ method: "POST", path: "/simulate", body: request() }] };
}
