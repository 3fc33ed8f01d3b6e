// The contact from above: the shear stress as colour, and the slip ring of the last move.
import { nearestIndex } from "./axis.js";
import { Chart } from "./chart.js";
import { svg } from "./dom.js";
import { meanPressure } from "./line_contact.js";
import { isTwisted } from "./state_text.js";
import { formatNumber, formatQuantity, unitScale } from "./units.js";

const STOPS = 160;

const note = (plus, minus) =>
  `Colour is the shear stress on the contact, green ${plus} and purple ${minus}, on a scale up to the largest value ` +
  "in the contact; in the striped ring the last move slipped.";

/** The plot. */
export function topView() {
  const chart = new Chart({
    name: "above",
    title: "The contact from above",
    mode: "radius",
    square: true,
    height: 340,
    x: { label: "x, along the motion", unit: "m" },
    y: { label: "y", unit: "m" },
    note: note("towards +x", "towards −x"),
  });
  let stress = null;
  let radius = 0;
  const at = (r, x, y) => {
    if (!stress || r > radius) return null;
    const index = nearestIndex(stress.radius, r);
    return { x, y, ring: r, lines: [`radius ${formatQuantity(r, "m")}`, ...valuesAt(stress, index)] };
  };
  chart.read = (x, y) => at(Math.hypot(x, y), x, y);
  const drawModel = (model) => {
    stress = model.stress;
    radius = model.state.contact_radius;
    const half = (radius || 1e-6) * 1.12;
    const ways = isTwisted(model.state) ? ["anticlockwise", "clockwise"] : ["towards +x", "towards −x"];
    chart.note.textContent = note(...ways);
    chart.x.label = isTwisted(model.state) ? "x" : "x, along the motion";
    const points = stress.radius.map((r, index) => [r, stress.shear[index]]);
    chart.draw({
      series: [{ name: "shear stress τ", points, kind: "none", line: false }],
      range: { x: [-half, half], y: [-half, half] },
      layer: (plot, group) => group.append(...disc(plot, model)),
      table: () => ({ radius_m: stress.radius, shear_pa: stress.shear, slip_m: stress.slip }),
    });
  };
  return Object.assign(chart, { at, drawModel });
}

/** What a contact carries at one of the places of a reply, as lines of text. */
export function valuesAt(stress, index) {
  const value = (name, unit) => formatQuantity(stress[name][index], unit);
  // That of a contact that is twisted is not computed.
  const slip = stress.slip[index] === null ? [] : [`slip ${value("slip", "m")}`];
  return [`shear τ ${value("shear", "Pa")}`, `pressure p ${value("pressure", "Pa")}`, ...slip];
}

/** The colour of a stress between −1 and 1; small ones show too. */
function colour(value) {
  const part = Math.round(100 * Math.min(1, Math.abs(value)) ** 0.6);
  return `color-mix(in oklab, var(${value < 0 ? "--minus" : "--plus"}) ${part}%, var(--none))`;
}

/** What stands in a plot of a contact whose bodies are apart. */
export const noContact = ({ box }) =>
  svg(
    "text",
    { x: (box.left + box.right) / 2, y: (box.top + box.bottom) / 2, "text-anchor": "middle" },
    "There is no area of contact.",
  );

/** The stops of a gradient that has the shear stress as colour: at each place its `part` of the way, from 0 to 1. */
export function shearStops(places, shear, full, part) {
  const every = Math.max(1, Math.floor(places.length / STOPS));
  return places
    .map((place, index) => [part(place), shear[index]])
    .filter((_, index) => index % every === 0 || index === places.length - 1)
    .map(([offset, tau]) => svg("stop", { offset, "stop-color": colour((tau ?? full) / full) }));
}

/** The stripes of what slipped, and the fill that they are. */
export function stripes({ clip }) {
  const id = `${clip}-stripes`;
  const pattern = svg(
    "pattern",
    { id, width: 6, height: 6, patternUnits: "userSpaceOnUse", patternTransform: "rotate(45)" },
    svg("line", { class: "stripe", y2: 6 }),
  );
  return { element: svg("defs", {}, pattern), fill: `url(#${id})` };
}

function disc(plot, { stress, state, friction, history, definition }) {
  const a = state.contact_radius;
  if (!(a > 0)) return [noContact(plot)];
  const full = fullScale(stress, friction, meanPressure(definition, state));
  const [cx, cy] = [plot.x.at(0), plot.y.at(0)];
  const size = (radius) => Math.abs(plot.x.at(radius) - cx);
  const id = `${plot.clip}-rings`;
  const gradient = svg(
    "radialGradient",
    { id, gradientUnits: "userSpaceOnUse", cx, cy, r: size(a) },
    ...shearStops(stress.radius, stress.shear, full, (r) => r / a),
  );
  const drawn = [svg("defs", {}, gradient), svg("circle", { cx, cy, r: size(a), fill: `url(#${id})`, class: "disc" })];
  const c = state.stick_radius;
  if (c < a) {
    const { element, fill } = stripes(plot);
    drawn.push(element, svg("path", { class: "slipping", fill, d: ring(cx, cy, size(a), size(c)) }));
    if (c > 0) drawn.push(svg("circle", { class: "front", cx, cy, r: size(c) }));
  }
  drawn.push(...colourScale(plot, full), ...arrow(plot, history));
  return drawn;
}

/** The stress of the strongest colour: the largest that is there, so that what little is left shows too. */
export function fullScale({ pressure, residual: { max, relative } }, friction, mean) {
  // Round-off is no stress.
  if (max !== null && relative > 1e-9) return max;
  // Where the pressure is infinite, four times its mean.
  const largest = pressure.reduce((most, value) => Math.max(most, value ?? Infinity), 0);
  return friction * Math.min(largest, 4 * mean) || 1;
}

/** The area between two circles. */
function ring(x, y, outer, inner) {
  const circle = (r) => `M${x - r},${y}a${r},${r} 0 1,0 ${2 * r},0a${r},${r} 0 1,0 ${-2 * r},0Z`;
  return circle(outer) + (inner > 0 ? circle(inner) : "");
}

/** The width of a small plot, pixels. */
const SMALL = 300;

/** The legend of the colours. */
export function colourScale(plot, full) {
  const { left, right, bottom } = plot.box;
  // In the corner of a small plot there is no room for more beside the ring.
  const isSmall = right - left < SMALL;
  const [x, y, width] = [left + 8, bottom - 14, isSmall ? 60 : 128];
  const id = `${plot.clip}-scale`;
  const stops = Array.from({ length: 21 }, (_, index) =>
    svg("stop", { offset: index / 20, "stop-color": colour(index / 10 - 1) }),
  );
  const scale = unitScale(full, "Pa");
  const most = formatNumber(full / scale.factor, 3);
  return [
    svg("defs", {}, svg("linearGradient", { id }, ...stops)),
    svg("rect", { x, y, width, height: 8, fill: `url(#${id})` }),
    svg(
      "text",
      { class: "small over", x, y: y - 4 },
      isSmall ? `±${most} ${scale.unit}` : `τ: −${most} to +${most} ${scale.unit}`,
    ),
  ];
}

/** The direction of the last move. */
export function arrow(plot, history) {
  const last = history.at(-1)?.state.displacement ?? 0;
  const before = history.at(-2)?.state.displacement ?? 0;
  if (last === before) return [];
  const { right, top } = plot.box;
  const sign = Math.sign(last - before);
  const [x, y] = [right - 12 - (sign > 0 ? 0 : 46), top + 16];
  return [
    svg("path", { class: "arrow", d: `M${x - sign * 46},${y}H${x}m${-sign * 8},-5l${sign * 8},5l${-sign * 8},5` }),
    svg("text", { class: "small", x: right - 12, y: y + 18, "text-anchor": "end" }, "last move"),
  ];
}
