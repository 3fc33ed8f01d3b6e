// The fewest reversals that reach a target, and how robust the protocol is where it is not followed exactly.
import { el, figure } from "./dom.js";
import { Choice, Fields, NumberField } from "./form_fields.js";
import { virginContact } from "./protocol_run.js";
import { study } from "./study.js";
import { formatNumber, formatQuantity } from "./units.js";

const KINDS = { minimax: "Minimax", equal_peaks: "Equal peaks", linear: "Linear" };
const ENDS = { displacement_zero: "at displacement zero", force_zero: "at force zero", free: "wherever it is best" };
/** Trials of a protocol that is not followed exactly. */
const [SAMPLES, SEED] = [200, 1];
const PERCENT = [["%", -2]];

const percent = (part) => (part === null || part === undefined ? "–" : `${formatNumber(100 * part, 3)} %`);

function figureRows({ reversals, relative, largest, gap, robustness, path }) {
  return [
    figure("Reversals", String(reversals)),
    figure("Remains, of μ p_max", percent(relative)),
    figure("Largest shear stress", formatQuantity(largest, "Pa")),
    ...(gap?.lower_bound === null || gap?.lower_bound === undefined
      ? []
      : [figure(`No ${reversals} reversals leave less than`, formatQuantity(gap.lower_bound, "Pa"))]),
    ...(robustness
      ? [
          figure("With these errors, on average", percent(robustness.mean)),
          figure("In 95 of 100 trials at most", percent(robustness.percentile_95)),
        ]
      : []),
    figure("First displacement", formatQuantity(path.displacement[0], "m")),
  ];
}

/** The card. */
export function protocolSearchCard(model) {
  const form = new Fields();
  const field = (pointer, about) => new NumberField(form, () => pointer, { units: PERCENT, unit: "%", ...about });
  const target = field("/target", { label: "May remain, of μ p_max", value: "20" });
  const kind = new Choice(form, () => "/kind", "Protocol", KINDS, "minimax");
  const end = new Choice(form, () => "/end", "It ends", ENDS, "displacement_zero");
  const amplitude = field("/robustness/amplitude_error", { label: "Error of the displacements", optional: true });
  const friction = field("/robustness/friction_error", {
    label: "Error of the coefficient of friction",
    optional: true,
  });
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
  return study({
    name: "search",
    button: "Find",
    title: "The fewest reversals",
    text:
      "Which path leaves no more than that much shear stress on a contact that was never moved, and how much it " +
      "leaves " +
      "if it is not followed exactly.",
    form,
    parts: [
      target.element,
      kind.element,
      end.element,
      el("details", {}, el("summary", {}, "Errors of the bench"), amplitude.element, friction.element),
    ],
    signal: model.signal,
    path: "/protocols",
    request,
    isQuick: model.state.normal_force > 0,
    rows: figureRows,
  });
}
