// The fatigue criteria of the form: which are asked for, their numbers and limits, and what they say in words.
import { el, mapped } from "./dom.js";
import { NumberField } from "./form_fields.js";
import { MODULUS, STRESS } from "./form_options.js";
import { formatNumber, formatQuantity } from "./units.js";

const alpha = { alpha: { label: "Weight α of the hydrostatic stress", value: "0.3" } };
const k = (value) => ({ k: { label: "Weight k of the normal stress", value } });
const modulus = { youngs_modulus: { label: "Young’s modulus of the body", units: MODULUS, unit: "GPa", value: "" } };

/** What each criterion is called, what it rates, its unit, its numbers, and whether it is of the surface alone.
 * @type {Record<string, { name: string, text: string, unit: string, numbers: any, isOfSurface?: boolean }>} */
const CRITERIA = {
  crossland: {
    name: "Crossland",
    text: "shear amplitude and the largest hydrostatic stress",
    unit: "Pa",
    numbers: alpha,
  },
  dang_van: { name: "Dang Van", text: "shear and hydrostatic stress at one instant", unit: "Pa", numbers: alpha },
  findley: { name: "Findley", text: "shear amplitude and normal stress on a plane", unit: "Pa", numbers: k("0.3") },
  swt: {
    name: "Smith, Watson and Topper",
    text: "tension times strain amplitude on a plane",
    unit: "Pa",
    numbers: modulus,
  },
  fatemi_socie: {
    name: "Fatemi and Socie",
    text: "shear strain amplitude, raised by the normal stress",
    unit: "",
    numbers: { ...k("1"), yield: { label: "Yield stress", units: STRESS, unit: "MPa", value: "" }, ...modulus },
  },
  ruiz: { name: "Ruiz", text: "shear stress times slip, at the surface", unit: "N/m", numbers: {}, isOfSurface: true },
  friction_work: {
    name: "Friction work",
    text: "per area and cycle, at the surface",
    unit: "J/m²",
    numbers: {},
    isOfSurface: true,
  },
};
/** What comes with Ruiz’s criterion. */
const TENSION = { name: "Ruiz, times the tension", unit: "N²/m³", isOfSurface: true };

/** A criterion by its key in a reply. */
export const criterion = (key) => CRITERIA[key] ?? (key === "ruiz_tension" ? TENSION : undefined);

/** A value in the unit of a criterion. */
export function amountOf(key, value, digits) {
  const { unit } = criterion(key);
  // A prefix would be squared with its unit.
  return unit.includes("²/") ? `${formatNumber(value, digits)} ${unit}` : formatQuantity(value, unit, digits);
}

const elements = (fields) => Object.values(fields).map((one) => one.element);

/** The numbers of Basquin's curve: so many cycles at a value, and fewer by a power of it above. */
const lifeFields = (units) => ({
  reference: { label: "Value of the criterion", units, unit: "MPa", value: "", optional: true },
  cycles: { label: "Cycles at this value", value: "", optional: true },
  exponent: { label: "Exponent", value: "", optional: true },
});
/** Why there is no life, by its code. */
const NO_LIFE = {
  not_positive: "the value is not positive, which is no proof of an infinite life",
  too_long: "more than 10¹² cycles, beyond all tests",
  too_short: "less than half a cycle",
  infinite_stress: "the stress is infinite",
};

/** A life in words. */
function lifeText({ cycles, shortest, longest, no_life: reason }) {
  if (typeof cycles !== "number") return `No life: ${NO_LIFE[reason] ?? reason}.`;
  const bracket = `${formatNumber(shortest, 2)} to ${longest === null ? "any number" : formatNumber(longest, 2)}`;
  const scatter = "by the error of the value; lives scatter by a factor of three";
  return `Life ${formatNumber(cycles, 2)} cycles (${bracket} ${scatter}).`;
}

/** The fieldsets of all criteria; `isModulusKnown` leaves Young’s modulus out. */
export function criteriaFields(form, isModulusKnown) {
  const all = Object.entries(CRITERIA).map(([key, { name, text, unit, numbers }]) => {
    const box = el("input", { type: "checkbox", name: key, checked: key === "crossland" });
    const field = (member, about) => new NumberField(form, () => `/criteria/${key}/${member}`, about);
    const units = unit === "Pa" ? STRESS : undefined;
    const title = units || !unit ? "Limit" : `Limit in ${unit}`;
    const { youngs_modulus: own, ...others } = numbers;
    const asked = own && !isModulusKnown ? numbers : others;
    const limit = { label: title, units, unit: "MPa", value: "", optional: true };
    const fields = mapped({ ...asked, limit }, (about, member) => field(member, about));
    const life = mapped(lifeFields(units), (about, member) => field(`life/s_n/${member}`, about));
    const curve = el("details", {}, el("summary", {}, "Life by a curve of tests"), ...elements(life));
    const body = el("div", { class: "fields" }, ...elements(fields), curve);
    const fold = () => {
      body.hidden = !box.checked;
      // The numbers of a criterion that is not asked for are not checked.
      for (const one of [...Object.values(fields), ...Object.values(life)]) one.isLeftOut = !box.checked;
    };
    box.addEventListener("change", fold);
    fold();
    const element = el("fieldset", {}, el("label", {}, box, ` ${name} `, el("span", { class: "note" }, text)), body);
    /** @returns {Record<string, any>} */
    const value = () => {
      const s_n = mapped(life, (one) => one.value);
      const hasLife = Object.values(s_n).some((one) => one !== undefined);
      return { ...mapped(fields, (one) => one.value), ...(hasLife ? { life: { s_n } } : {}) };
    };
    return { key, box, element, value };
  });
  const chosen = () => all.filter(({ box }) => box.checked);
  return {
    elements: all.map((one) => one.element),
    value: () => Object.fromEntries(chosen().map(({ key, value }) => [key, value()])),
  };
}

/** Where a point is, in words. */
function placeText([x, y, z]) {
  const depth = z === 0 ? "on the surface" : `${formatQuantity(z, "m", 3)} below the surface`;
  // What rounding leaves of the plane of symmetry is no place beside it.
  const aside = Math.abs(y) > 1e-6 * Math.hypot(x, z) ? `, y = ±${formatQuantity(Math.abs(y), "m", 3)}` : "";
  return `${depth}, x = ${formatQuantity(x, "m", 3)}${aside}`;
}

/** How far a move has come, where a turn is not told from its first or last thousandth. */
function instantText({ part }) {
  if (part < 1e-3) return "at the beginning of";
  return part > 1 - 1e-3 ? "at the end of" : `after ${formatNumber(100 * part, 3)} % of`;
}

/** What a criterion says, as elements. */
export function verdict(key, { largest, margin, life, critical_distance: below }, hasLimit) {
  const about = criterion(key);
  const lines = [];
  if (largest) {
    const error = largest.error > 0 ? ` ± ${amountOf(key, largest.error, 1)}` : "";
    lines.push(el("p", {}, `Largest ${amountOf(key, largest.value)}${error}, ${placeText(largest.point)}.`));
  } else lines.push(el("p", {}, "There is no largest value: the stress is infinite somewhere."));
  if (margin !== undefined) {
    const says = margin < 1 ? "the criterion predicts crack growth" : "the criterion does not predict crack growth";
    lines.push(el("p", { class: margin < 1 ? "bad" : "good" }, `Margin ${formatNumber(margin, 3)}: ${says}.`));
  } else if (hasLimit) lines.push(el("p", { class: "bad" }, "There is no margin; the warnings say why."));
  else lines.push(el("p", { class: "note" }, "Give a limit, the value that the material withstands, to get a margin."));
  if (life) lines.push(el("p", {}, lifeText(life)));
  if (below) {
    const share = below.margin === undefined ? "" : `, margin ${formatNumber(below.margin, 3)}`;
    lines.push(el("p", {}, `At the critical distance ${amountOf(key, below.value)}${share}.`));
    if (below.life) lines.push(el("p", {}, `There: ${lifeText(below.life)}`));
  }
  if (largest?.plane) {
    const normal = largest.plane.map((part) => formatNumber(Math.abs(part) < 1e-9 ? 0 : part, 2)).join(", ");
    lines.push(el("p", { class: "note" }, `The critical plane has the normal (${normal}).`));
  }
  if (largest?.at) {
    lines.push(
      el("p", { class: "note" }, `It is reached ${instantText(largest.at)} move ${largest.at.move + 1} of the cycle.`),
    );
  }
  return el("div", { class: "verdict", id: `verdict-${key}` }, el("h3", {}, about.name), ...lines);
}
