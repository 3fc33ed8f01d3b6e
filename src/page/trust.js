// How far the results of a contact can be trusted: the estimated errors over its whole history, and the warnings.
import { call } from "./api.js";
import { debounce, el, withSubscripts } from "./dom.js";
import { formatNumber } from "./units.js";

/** How long the contact rests before the service is asked, ms. */
const REST = 400;

/** The card, and a function that asks anew when the contact has moved. */
export function trustCard(model) {
  const figures = el("dl", { class: "figures" });
  const warnings = el("ul", { class: "warnings", id: "warnings" });
  const summary = el("summary", {}, "Accuracy and warnings");
  const element = el("details", { class: "card trust", id: "trust-card" }, summary, figures, warnings);
  let wanted = null;
  const ask = debounce(async (question) => {
    if (model.signal.aborted || model.isGone) return;
    // The history as it was sent; of a long one only its contact is judged.
    const moves = model.isComplete ? model.history.map(({ move }) => move) : [];
    const path = moves.length ? { moves } : { displacement: [0] };
    try {
      const reply = await call("POST", "/simulate", { contact: model.definition, path, steps: "last" }, model.signal);
      if (question === wanted) show(reply);
    } catch (error) {
      if (!model.signal.aborted && question === wanted) say(error.message);
    }
  }, REST);
  const say = (text) => figures.replaceChildren(el("div", {}, el("dd", {}, text)));
  const show = ({ accuracy, warnings: found }) => {
    const pair = (name, value) => el("div", {}, el("dt", {}, withSubscripts(name)), el("dd", {}, value));
    const share = (error) => `${formatNumber(error, 2)}`;
    figures.replaceChildren(
      pair("Error of forces, of μ F_N", share(accuracy.force_error)),
      ...(model.stress ? [pair("Error of stresses, of μ p_max", share(accuracy.stress_error))] : []),
      ...(model.isComplete ? [] : [pair("Of", "the contact alone: its history is long")]),
    );
    const count = found.length === 1 ? "1 warning" : `${found.length} warnings`;
    summary.textContent = found.length ? `Accuracy, and ${count}` : "Accuracy: no warnings";
    warnings.replaceChildren(...found.map(({ message }) => el("li", {}, message)));
  };
  const refresh = () => {
    const question = model.history.at(-1)?.sequence ?? model.first.sequence;
    if (question === wanted) return;
    wanted = question;
    ask(question);
  };
  return { element, show: refresh };
}
