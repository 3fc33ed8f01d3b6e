// The steady cycle of a contact between plus and minus the displacement that the slider stands at.
import { call } from "./api.js";
import { debounce, el, withSubscripts } from "./dom.js";
import { formatNumber, formatQuantity } from "./units.js";

/** How long the slider rests before the service is asked, ms. */
const REST = 120;

/** The amplitude that the slider stands at, m. */
export const amplitudeOf = (state) => Math.abs(state.displacement);

function sentence({ regime, stick_radius: c }, { contact_radius: a }) {
  if (regime === "stick") return "Back and forth, nothing slips, and no work is lost.";
  if (regime === "gross_slip") return "Back and forth, the whole contact slides in each stroke.";
  const part = a > 0 ? ` (${formatNumber((100 * c) / a, 2)} % of the contact radius)` : "";
  return `Back and forth, the ring outside r = ${formatQuantity(c, "m", 3)}${part} slips; inside, the surfaces stick.`;
}

function figures(cycle) {
  const pair = (name, value) => el("div", {}, el("dt", {}, withSubscripts(name)), el("dd", {}, value));
  const ratio = (value) => (value === null ? "–" : formatNumber(value, 4));
  return [
    pair("Amplitude U_0", formatQuantity(cycle.displacement_amplitude, "m")),
    pair("Friction work of a cycle", formatQuantity(cycle.dissipated_energy, "J")),
    pair("Secant stiffness", formatQuantity(cycle.secant_stiffness, "N/m")),
    pair("Loss factor", ratio(cycle.loss_factor)),
    pair("Sliding ratio", ratio(cycle.sliding_ratio)),
  ];
}

/** The card, and a function that shows the cycle that belongs to a state. */
export function steadyCard(model) {
  const text = el("p", { id: "steady-text", "aria-live": "polite" });
  const list = el("dl", { class: "figures", id: "steady-figures" });
  const path = () => `/contacts/${model.id}/cycle?displacement=${amplitudeOf(model.state)}`;
  let wanted = null;

  const say = (words, shown = []) => {
    text.textContent = words;
    list.replaceChildren(...shown);
  };
  const ask = debounce(async (question) => {
    // A reply counts only for the question that was asked last.
    const isStale = () => question !== wanted || model.signal.aborted || model.isGone;
    if (isStale()) return;
    try {
      const { contact, cycles } = await call("GET", path(), undefined, model.signal);
      if (!isStale()) say(sentence(cycles[0], contact), figures(cycles[0]));
    } catch (error) {
      if (!isStale()) say(error.errors?.[0]?.detail ?? error.message);
    }
  }, REST);
  const show = (state) => {
    const question = `${amplitudeOf(state)} ${state.indentation}`;
    if (question === wanted) return;
    wanted = question;
    if (!(state.normal_force > 0)) say("Without a load there is no friction: press the bodies together.");
    else if (state.displacement === 0) say("Pull the displacement: its distance from zero is the amplitude.");
    else ask(question);
  };
  const element = el(
    "section",
    { class: "card steady", id: "steady-card" },
    el("h2", {}, "Steady cycle"),
    text,
    list,
    el("p", { class: "note" }, "Loss factor: friction work of a cycle over 2π times the largest stored energy. Sliding ratio: displacement at zero force over the amplitude."),
  );
  return { element, show, calls: () => [{ method: "GET", path: path() }] };
}
