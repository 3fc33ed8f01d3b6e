// The fewest reversals that reach a target, and how robust the protocol is where it is not followed exactly.
import { call, offered } from "./api.js";
import { el, notice, withSubscripts } from "./dom.js";
import { Choice, Fields, NumberField } from "./form_fields.js";
import { virginContact } from "./protocol_run.js";
import { formatNumber, formatQuantity } from "./units.js";
import { showWarnings, warningList } from "./warning_list.js";

const KINDS = { minimax: "Least possible", equal_peaks: "Equal peaks", linear: "Linear" };
const ENDS = { displacement_zero: "at displacement zero", force_zero: "at force zero", free: "wherever it is best" };
/** Trials of a protocol that is not followed exactly. */
const [SAMPLES, SEED] = [200, 1];
const PERCENT = [["%", -2]];

const pair = (name, value) => el("div", {}, el("dt", {}, withSubscripts(name)), el("dd", {}, value));
const percent = (part) => (part === null || part === undefined ? "–" : `${formatNumber(100 * part, 3)} %`);

function figureRows({ reversals, relative, largest, gap, robustness, path }) {
  return [
    pair("Reversals", String(reversals)),
    pair("Remains, of μ p_max", percent(relative)),
    pair("Largest shear stress", formatQuantity(largest, "Pa")),
    ...(gap?.lower_bound === null || gap?.lower_bound === undefined ? [] : [pair(`No ${reversals} reversals leave less than`, formatQuantity(gap.lower_bound, "Pa"))]),
    ...(robustness
      ? [pair("With these errors, on average", percent(robustness.mean)), pair("In 95 of 100 trials at most", percent(robustness.percentile_95))]
      : []),
    pair("First displacement", formatQuantity(path.displacement[0], "m")),
  ];
}

/** The card; it stays hidden where the service does not offer protocols. */
export function protocolSearchCard(model) {
  const form = new Fields();
  const field = (pointer, about) => new NumberField(form, () => pointer, { units: PERCENT, unit: "%", ...about });
  const target = field("/target", { label: "May remain, of μ p_max", value: "20" });
  const kind = new Choice(form, () => "/kind", "Protocol", KINDS, "minimax");
  const end = new Choice(form, () => "/end", "It ends", ENDS, "displacement_zero");
  const amplitude = field("/robustness/amplitude_error", { label: "Error of the displacements", optional: true });
  const friction = field("/robustness/friction_error", { label: "Error of the coefficient of friction", optional: true });
  const figures = el("dl", { class: "figures", id: "search-figures", "aria-live": "polite" });
  const warnings = warningList("search-warnings");
  const request = () => {
    const [amplitude_error, friction_error] = [amplitude.value ?? 0, friction.value ?? 0];
    const hasErrors = amplitude.value !== undefined || friction.value !== undefined;
    return {
      contact: virginContact(model),
      target: target.value,
      kind: kind.value,
      end: end.value,
      robustness: hasErrors ? { amplitude_error, friction_error, samples: SAMPLES, seed: SEED } : undefined,
    };
  };
  const find = async (event) => {
    event.preventDefault();
    const first = form.check();
    if (first) return first.control.focus();
    button.disabled = true;
    try {
      const reply = await call("POST", "/protocols", request(), model.signal);
      form.clear();
      figures.replaceChildren(...figureRows(reply));
      showWarnings(warnings, reply.warnings);
    } catch (error) {
      if (model.signal.aborted) return;
      if (!form.place(error)) notice(error.message, true);
    } finally {
      button.disabled = false;
    }
  };
  const button = el("button", { class: "primary", id: "find-protocol" }, "Find");
  const element = el(
    "section",
    { class: "card", id: "search-card", hidden: true },
    el("h2", {}, "The fewest reversals"),
    el("p", {}, "Which path leaves no more than that much shear stress on a contact that was never moved, and how much it leaves where it is not followed exactly."),
    el(
      "form",
      { onsubmit: find },
      target.element,
      kind.element,
      end.element,
      el("details", {}, el("summary", {}, "Errors of the bench"), amplitude.element, friction.element),
      form.rest,
      el("p", { class: "row" }, button),
    ),
    figures,
    warnings,
  );
  offered("/protocols").then((is) => {
    element.hidden = !is;
  });
  return { element, calls: () => [{ method: "POST", path: "/protocols", body: request() }] };
}
