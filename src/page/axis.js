// From values to pixels and back: ranges, ticks, and the unit prefix.
import { formatNumber, raised, unitScale } from "./units.js";

/** One axis of a plot, linear or logarithmic. */
export class Axis {
  /** The range, in SI units, and the pixels of its ends. */
  from = 0;
  to = 1;
  start = 0;
  end = 1;
  scale = { factor: 1, unit: "" };

  constructor({ label, unit = "", log = false, isBare = false }) {
    this.label = label;
    this.isBare = isBare;
    this.unit = unit;
    this.log = log;
  }

  /** Shows values from `range[0]` to `range[1]` between the pixels `start` and `end`. */
  fit(range, start, end) {
    [this.from, this.to] = range;
    this.start = start;
    this.end = end;
    const shown = unitScale(Math.max(Math.abs(this.from), Math.abs(this.to)), this.unit);
    this.scale = this.unit ? shown : { factor: 1, unit: this.unit };
  }

  at(value) {
    const [from, to, place] = this.log ? [this.from, this.to, value].map(Math.log10) : [this.from, this.to, value];
    return this.start + ((place - from) / (to - from)) * (this.end - this.start);
  }

  back(pixel) {
    const part = (pixel - this.start) / (this.end - this.start);
    return this.log ? this.from * (this.to / this.from) ** part : this.from + part * (this.to - this.from);
  }

  title() {
    return this.scale.unit ? `${this.label} (${this.scale.unit})` : this.label;
  }

  /** Values with their texts, about one in so many pixels. */
  ticks(apart) {
    if (this.isBare) return [];
    const count = Math.max(2, Math.floor(Math.abs(this.end - this.start) / apart));
    const { factor } = this.scale;
    if (this.log)
      return decadeTicks(this.from / factor, this.to / factor, count).map(([value, text]) => [value * factor, text]);
    // A depth grows downwards.
    const [low, high] = this.from < this.to ? [this.from, this.to] : [this.to, this.from];
    const span = (high - low) / factor;
    const wide = roundStep(span / count);
    // Fewer than three ticks hardly show a scale.
    const step = span < 3 * wide ? roundStep(0.4 * wide) : wide;
    const first = Math.ceil(low / factor / step - 1e-9);
    const last = Math.floor(high / factor / step + 1e-9);
    const numbers = Array.from({ length: Math.max(0, last - first + 1) }, (_, index) => (first + index) * step);
    return numbers.map((number) => [number * factor, formatNumber(Number(number.toPrecision(10)), 6)]);
  }
}

/** The next larger of 1, 2, 5, 10, … */
function roundStep(step) {
  const power = 10 ** Math.floor(Math.log10(step));
  return power * [1, 2, 5, 10].find((digit) => digit * power >= step * 0.999);
}

function decadeTicks(from, to, count) {
  const [first, last] = [Math.floor(Math.log10(from)), Math.ceil(Math.log10(to))];
  const narrow = last - first <= 2;
  const every = Math.max(1, Math.ceil((last - first) / count));
  const found = [];
  for (let power = first; power <= last; power += narrow ? 1 : every) {
    for (const digit of narrow ? [1, 2, 5] : [1]) found.push(digit * 10 ** power);
  }
  const inside = found.filter((value) => value >= from * 0.999 && value <= to * 1.001);
  return inside.map((value) => [value, value >= 1e-3 && value < 1e5 ? formatNumber(value) : powerOfTen(value)]);
}

/** A value as a power of ten with raised digits. */
function powerOfTen(value) {
  const power = Math.floor(Math.log10(value) + 1e-9);
  const digit = Math.round(value / 10 ** power);
  return `${digit === 1 ? "" : `${digit} · `}10${raised(power)}`;
}

/** The range of some values, with a margin. */
export function dataRange(values, log) {
  const finite = values.filter((value) => Number.isFinite(value) && (!log || value > 0));
  if (!finite.length) return log ? [0.1, 10] : [-1, 1];
  const low = finite.reduce((least, value) => Math.min(least, value));
  const high = finite.reduce((most, value) => Math.max(most, value));
  if (log) {
    const margin = Math.max(1.4, (high / low) ** 0.06);
    return [low / margin, high * margin];
  }
  const margin = (high - low) * 0.06 || Math.abs(high) * 0.5 || 1;
  return [low - margin, high + margin];
}

/** Which of some numbers is nearest to another. */
export const nearestIndex = (values, wanted) =>
  values.reduce((best, value, index) => (Math.abs(value - wanted) < Math.abs(values[best] - wanted) ? index : best), 0);
