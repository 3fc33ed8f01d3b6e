// The steady cycle of a contact between plus and minus the displacement that the slider stands at.
import { call } from "./api.js";
import { el, figure, reason } from "./dom.js";
import { latestAnswer } from "./study.js";
import { formatNumber, formatQuantity } from "./units.js";

/** How long the slider rests before the service is asked, ms. */
const REST = 120;

/** The amplitude that the slider stands at, m. */
export const amplitudeOf = (state) => Math.abs(state.displacement ?? 0);

function sentence({ regime, stick_radius: c }, { contact_radius: a }, isLine) {
  if (regime === "stick") return "Back and forth, nothing slips, and no work is lost.";
  if (regime === "gross_slip") return "Back and forth, the whole contact slides in each stroke.";
  if (isLine) {
    const width = `${formatQuantity(2 * c, "m", 3)} (${formatNumber((100 * c) / a, 2)} % of the contact)`;
    return `Back and forth, a zone of the width ${width} sticks in each stroke; beside it the surfaces slip.`;
  }
  const part = a > 0 ? ` (${formatNumber((100 * c) / a, 2)} % of the contact radius)` : "";
  return `Back and forth, the ring outside r = ${formatQuantity(c, "m", 3)}${part} slips; inside, the surfaces stick.`;
}

function figures(cycle) {
  const ratio = (value) => (value === null ? "–" : formatNumber(value, 4));
  return [
    figure("Amplitude U_0", formatQuantity(cycle.displacement_amplitude, "m")),
    figure("Friction work of a cycle", formatQuantity(cycle.dissipated_energy, "J")),
    ...(cycle.friction_energy === undefined
      ? []
      : [figure("All friction work, with the bulk stress", formatQuantity(cycle.friction_energy, "J"))]),
    figure("Secant stiffness", formatQuantity(cycle.secant_stiffness, "N/m")),
    figure("Loss factor", ratio(cycle.loss_factor)),
    figure("Sliding ratio", ratio(cycle.sliding_ratio)),
  ];
}

/** The card, and a function that shows the cycle that belongs to a state. */
export function steadyCard(model) {
  const text = el("p", { id: "steady-text", "aria-live": "polite" });
  const list = el("dl", { class: "figures", id: "steady-figures" });
  const path = () => `/contacts/${model.id}/cycle?displacement=${amplitudeOf(model.state)}`;
  const say = (words, shown = []) => {
    text.textContent = words;
    list.replaceChildren(...shown);
  };
  const follow = latestAnswer(model, REST, {
    ask: () => call("GET", path(), undefined, model.signal),
    show: ({ contact, cycles: [cycle] }) => say(sentence(cycle, contact, model.isLine), figures(cycle)),
    fail: (error) => say(reason(error)),
  });
  const show = (state) =>
    follow(`${amplitudeOf(state)} ${state.indentation}`, () => {
      if (!(state.normal_force > 0)) say("Without a load there is no friction: press the bodies together.");
      else if (amplitudeOf(state) === 0) say("Pull the displacement: its distance from zero is the amplitude.");
      else return state;
    });
  const element = el(
    "section",
    { class: "card steady", id: "steady-card" },
    el("h2", {}, "Steady cycle"),
    text,
    list,
    el(
      "p",
      { class: "note" },
      "Loss factor: friction work of a cycle over 2π times the largest stored energy. Sliding ratio: " +
        "displacement at zero force over the amplitude.",
    ),
  );
  return { element, show, calls: () => [{ method: "GET", path: path() }] };
}
