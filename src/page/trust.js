// How far the results of a contact can be trusted: the estimated errors over its whole history, and the warnings.
import { call } from "./api.js";
import { debounce, el, withSubscripts } from "./dom.js";
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
  let wanted = null;
  const request = () => {
    // The history as it was sent; of a long one only its contact is judged.
    const moves = model.isComplete ? model.history.map(({ move }) => move) : [];
    const path = moves.length ? { moves } : { displacement: [0] };
    return { contact: model.definition, path, steps: "last" };
  };
  const ask = debounce(async (question) => {
    if (model.signal.aborted || model.isGone) return;
    try {
      const reply = await call("POST", "/simulate", request(), model.signal);
      if (question === wanted) showReply(reply);
    } catch (error) {
      if (!model.signal.aborted && question === wanted) say(error.message);
    }
  }, REST);
  const say = (text) => figures.replaceChildren(el("div", {}, el("dd", {}, text)));
  const showReply = ({ accuracy, warnings: found }) => {
    const pair = (name, value) => el("div", {}, el("dt", {}, withSubscripts(name)), el("dd", {}, value));
    const share = (error) => `${formatNumber(error, 2)}`;
    figures.replaceChildren(
      pair("Error of forces, of μ F_N", share(accuracy.force_error)),
      ...(model.stress ? [pair("Error of stresses, of μ p_max", share(accuracy.stress_error))] : []),
      ...(model.isComplete ? [] : [pair("Of", "the contact alone: its history is long")]),
    );
    const number = found.length === 1 ? "1 warning" : `${found.length} warnings`;
    heading.textContent = found.length ? `Accuracy, and ${number}` : "Accuracy: no warnings";
    count.textContent = number;
    line.hidden = found.length === 0;
    showWarnings(warnings, found);
    showWarnings(beside, found);
  };
  const show = () => {
    const question = model.history.at(-1)?.sequence ?? model.first.sequence;
    if (question === wanted) return;
    wanted = question;
    ask(question);
  };
  return { element, line, show, calls: () => [{ method: "POST", path: "/simulate", body: request() }] };
}
