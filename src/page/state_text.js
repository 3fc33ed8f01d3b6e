// A state in words.
import { el, figure, withSubscripts } from "./dom.js";
import { zonesOf } from "./line_contact.js";
import { formatInterval, formatNumber, formatQuantity } from "./units.js";

const NAMES = {
  stick: "Stick",
  partial_slip: "Partial slip",
  gross_slip: "Gross slip",
  separated: "Lifted off",
  pulled_off: "Pulled off",
};

/** The part of the contact radius from which on a stick radius would read as all of it. */
const MOST_SHOWN = 0.995;

/** The regime of a state; bodies that do not adhere are apart without a load, whatever the last move did. */
export const regimeOf = ({ regime, normal_force: load, surface_energy: surface }) =>
  load > 0 || surface !== undefined ? regime : "separated";

function sentence(state, moved, isLine) {
  const { stick_radius: c, contact_radius: a } = state;
  const regime = regimeOf(state);
  if (regime === "pulled_off") return "The contact has been pulled off. A load, or touching, brings it back.";
  if (regime === "separated")
    return "The bodies are apart: there is no load, no friction and no history. A load brings them together.";
  if (!moved) {
    const slipping = isLine ? "slip grow from the edges" : "the ring that slips grow from the edge";
    return `Nothing has moved yet: pull the slider, and watch ${slipping}.`;
  }
  if (regime === "stick") return "The last move slipped nowhere: the whole contact stuck.";
  if (regime === "gross_slip")
    return "The last move slipped everywhere: the whole contact slid, and its history is erased.";
  if (c > MOST_SHOWN * a) {
    const outermost = `the outermost ${formatQuantity(isLine ? 2 * (a - c) : a - c, "m", 2)}`;
    const ring = isLine ? `${outermost}, both edges together` : `${outermost} of the contact radius`;
    return `The last move has just turned: all but ${ring} sticks.`;
  }
  if (isLine) {
    const { from, to } = zonesOf(state, true).find(({ kind }) => kind === "stick");
    const part = `${formatNumber((100 * c) / a, 2)} % of the contact`;
    const where = formatInterval([from, to], "m", 3);
    return `From x = ${where} (${part}) the surfaces stuck in the last move; beside that they slipped.`;
  }
  const inside = `Inside r = ${formatQuantity(c, "m", 3)} (${formatNumber((100 * c) / a, 2)} % of the contact radius)`;
  return `${inside} the surfaces stuck in the last move; the ring outside slipped.`;
}

/** A coefficient of friction with its interval. */
function measuredText({ value, interval: [low, high], from, to }) {
  const [middle, least, most] = [value, low, high].map((number) => formatNumber(number, 4));
  return `${middle} (95 %: ${least} to ${most}, moves ${from} to ${to})`;
}

/** The largest shear stress, and what part of μ times the largest pressure it is. */
function shearText({ max, relative }) {
  if (max === null) return "∞ at one radius";
  return [
    formatQuantity(max, "Pa"),
    ...(relative === null ? [] : withSubscripts(` = ${formatNumber(100 * relative, 3)} % of μ p_max`)),
  ];
}

/** How well a contact conducts, where its bodies have the numbers; the resistance is that of the constriction. */
export function conductanceFigures({ electrical_conductance: electrical, thermal_conductance: thermal }) {
  const resistance = () => (electrical > 0 ? `, ${formatQuantity(1 / electrical, "Ω")}` : "");
  return [
    ...(electrical === undefined
      ? []
      : [figure("Electrical conductance", `${formatQuantity(electrical, "S")}${resistance()}`)]),
    ...(thermal === undefined ? [] : [figure("Thermal conductance", formatQuantity(thermal, "W/K"))]),
  ];
}

/** Whether a state is of a contact that is twisted. */
export const isTwisted = ({ twist }) => twist !== undefined;

/** What a contact is moved to along its surface, and what that takes: angle and torque of one that is twisted. */
export const alongOf = (state) => (isTwisted(state) ? [state.twist, state.torque] : [state.displacement, state.force]);

/** Lines about a state. */
export function stateText(state, { friction, history, first, measured, stress, isLine }) {
  const limit = friction * state.normal_force;
  const use = limit > 0 ? Math.min(1, Math.abs(state.force) / limit) : 0;
  return [
    el("p", { class: `regime ${regimeOf(state)}` }, NAMES[regimeOf(state)]),
    el("p", {}, sentence(state, history.length > 0 || first.sequence > 0, isLine)),
    isTwisted(state)
      ? ""
      : el(
          "p",
          { class: "meter" },
          el("meter", { min: 0, max: 1, value: use, "aria-label": "Share of the friction limit" }),
          el("span", {}, withSubscripts(`${formatNumber(100 * use, 3)} % of the friction limit μ F_N`)),
        ),
    el(
      "dl",
      { class: "figures" },
      ...(isTwisted(state)
        ? [
            figure("Angle ω", formatQuantity(state.twist, "rad")),
            figure("Torque M", formatQuantity(state.torque, "N·m")),
          ]
        : [
            figure("Displacement U", formatQuantity(state.displacement, "m")),
            figure("Force F", formatQuantity(state.force, "N")),
          ]),
      figure("Load F_N", `${formatQuantity(state.normal_force, "N")}`),
      figure(isLine ? "Half-width a" : "Contact radius a", `${formatQuantity(state.contact_radius, "m")}`),
      ...(state.stick_centre && state.stick_radius > 0
        ? [figure("Middle of the stick zone e", formatQuantity(state.stick_centre, "m"))]
        : []),
      ...(stress && state.normal_force > 0 ? [figure("Largest shear stress", shearText(stress.residual))] : []),
      ...conductanceFigures(state),
      figure("Friction work W", `${formatQuantity(state.dissipated_energy, "J")}`),
      ...(state.time === undefined
        ? [figure("Slip history", `${state.memory_depth} ${state.memory_depth === 1 ? "piece" : "pieces"}`)]
        : [
            figure("Work of the bodies", formatQuantity(state.viscous_work, "J")),
            figure("Time t", formatQuantity(state.time, "s")),
          ]),
      ...(measured ? [figure("Measured friction μ", measuredText(measured))] : []),
    ),
  ];
}
