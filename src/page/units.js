// Numbers with their units as text, and back.

/** @type {[number, string][]} */
const PREFIXES = [
  [1e12, "T"],
  [1e9, "G"],
  [1e6, "M"],
  [1e3, "k"],
  [1, ""],
  [1e-3, "m"],
  [1e-6, "µ"],
  [1e-9, "n"],
  [1e-12, "p"],
  [1e-15, "f"],
];

/** A unit with each of some prefixes, and the powers of ten of these. @typedef {[string, number][]} Units */

/** A unit with each of these prefixes, the empty prefix leaves the unit as it is. @returns {Units} */
export const prefixed = (unit, ...prefixes) =>
  prefixes.map((prefix) => [prefix + unit, Math.round(Math.log10(PREFIXES.find(([, name]) => name === prefix)[0]))]);

/** The unit with the prefix that fits a value: its factor and its name. */
export function unitScale(value, unit) {
  const size = Math.abs(value);
  const fits = PREFIXES.find(([power]) => size >= power * 0.9999) ?? PREFIXES[size ? PREFIXES.length - 1 : 4];
  const [factor, prefix] = fits;
  return { factor, unit: prefix + unit };
}

/** The power of ten of the prefix that fits a value. */
export const powerOf = (value) => Math.round(Math.log10(unitScale(value, "").factor));

/** A value in units of 10^power, as one would type it: by way of its digits, so that 0.3 µm are not
 *  0.30000000000000004. */
export function inPower(value, power, precision = 6) {
  const [digits, own = 0] = (precision > 16 ? String(value) : value.toPrecision(precision)).split("e");
  return String(Number(`${digits}e${Number(own) - power}`));
}

/** The digits of a power, raised. */
export const raised = (power) => String(power).replace(/./g, (sign) => (sign === "-" ? "⁻" : "⁰¹²³⁴⁵⁶⁷⁸⁹"[sign]));

/** A number with `digits` significant digits, and a true minus. */
export function formatNumber(value, digits = 4) {
  if (value === null || value === undefined) return "∞";
  if (value === 0) return "0";
  const size = Math.abs(value);
  const minus = (number) => String(number).replace("-", "−");
  if (size >= 1e-3 && size < 1e6) return minus(Number(value.toPrecision(digits)));
  const [mantissa, power] = value
    .toExponential(digits - 1)
    .split("e")
    .map(Number);
  return `${minus(mantissa)} × 10${raised(power)}`;
}

/** A value with its unit: `160.2 nm`. */
export function formatQuantity(value, unit, digits = 4) {
  if (value === null || value === undefined) return "∞";
  if (!unit) return formatNumber(value, digits);
  const scale = unitScale(value, unit);
  return `${formatNumber(value / scale.factor, digits)} ${scale.unit}`.trim();
}

/** The ends of an interval in one unit, `−0.2 to 3.1 nm`; an end that is not known is open. */
export function formatInterval(ends, unit, digits = 4) {
  const scale = unit ? unitScale(Math.max(...ends.map((end) => Math.abs(end ?? 0))), unit) : { factor: 1, unit: "" };
  const [low, high] = ends.map((end) => (end === null ? "open" : formatNumber(end / scale.factor, digits)));
  return `${low} to ${high} ${scale.unit}`.trim();
}

/** A comma before three digits: it separates thousands for some readers, and decimals for others. */
const ONE_COMMA = /^[+-]?[1-9]\d{0,2},\d{3}(?:e[+-]?\d+)?$/i;

/** What is wrong with the text of a number, in words; nothing where it is a number or empty. */
export function numberMistake(text) {
  const trimmed = text.trim().replace("−", "-");
  if (ONE_COMMA.test(trimmed))
    return `Write ${trimmed.replace(",", ".")} or ${trimmed.replace(",", "")}: ${trimmed} may be either.`;
  const isNumber = typeof parseNumber(trimmed) !== "string";
  return isNumber ? undefined : "This must be a number, without its unit and without separators of thousands.";
}

/** The text of a field in units of 10^power: a number in SI units, or the text itself if it is no number, or may be
 *  two. */
export function parseNumber(text, power = 0) {
  const trimmed = text.trim().replace("−", "-");
  if (trimmed === "") return undefined;
  const number = ONE_COMMA.test(trimmed) ? "" : trimmed.replace(",", ".");
  const parts = number.match(/^([+-]?(?:\d+\.?\d*|\.\d+))(?:e([+-]?\d+))?$/i);
  // The power goes to the digits, so that 10 mm are 0.01 m to the last bit.
  return parts ? Number(`${parts[1]}e${Number(parts[2] ?? 0) + power}`) : trimmed;
}
