// A line contact from the side: the two bodies, the shear stress between them as colour, where the last move slipped,
// and the bulk stress that comes with the force.
import { nearestIndex } from "./axis.js";
import { Chart } from "./chart.js";
import { svg } from "./dom.js";
import { isEccentric, meanPressure, zonesOf } from "./line_contact.js";
import { arrow, colourScale, fullScale, noContact, shearStops, stripes, valuesAt } from "./top_view.js";
import { formatQuantity } from "./units.js";

/** How far the plot reaches in half-widths; of its height, from −1 to 1: half of the coloured strip, and the gap at the
 *  side. */
const [REACH, STRIP, GAP] = [1.5, 0.09, 0.4];
/** Points of the outline of the first body on one side. */
const OUTLINE = 24;

/** The plot. */
export function sideView() {
  const chart = new Chart({
    name: "side",
    title: "The contact from the side",
    height: 300,
    x: { label: "x, along the motion", unit: "m" },
    y: { label: "Height, not to scale", isBare: true },
    note:
      "Colour is the shear stress between the bodies, green towards +x and purple towards −x, on a scale up to the " +
      "largest value in the contact; it is striped where the last move slipped.",
  });
  let stress = null;
  let half = 0;
  const at = (x) => {
    if (!stress || Math.abs(x) > half) return null;
    return { x, lines: [`x ${formatQuantity(x, "m")}`, ...valuesAt(stress, nearestIndex(stress.x, x))] };
  };
  chart.read = at;
  const drawModel = (model) => {
    stress = model.stress;
    half = model.state.contact_radius;
    const reach = (half || 1e-6) * REACH;
    const points = stress.x.map((x, index) => [x, stress.shear[index]]);
    chart.draw({
      series: [{ name: "shear stress τ", points, kind: "none", line: false }],
      range: { x: [-reach, reach], y: [-1, 1] },
      layer: (plot, group) => group.append(...drawn(plot, model)),
      table: () => ({ x_m: stress.x, shear_pa: stress.shear, slip_m: stress.slip }),
    });
  };
  return Object.assign(chart, { at, drawModel });
}

function drawn(plot, { stress, state, friction, history, definition }) {
  const a = state.contact_radius;
  if (!(a > 0)) return [noContact(plot)];
  const full = fullScale(stress, friction, meanPressure(definition, state));
  const [left, right] = [plot.x.at(-a), plot.x.at(a)];
  const [top, bottom] = [plot.y.at(STRIP), plot.y.at(-STRIP)];
  const zones = zonesOf(state, true);
  const id = `${plot.clip}-strip`;
  const gradient = svg(
    "linearGradient",
    { id, gradientUnits: "userSpaceOnUse", x1: left, x2: right, y1: 0, y2: 0 },
    ...shearStops(stress.x, stress.shear, full, (x) => (x + a) / (2 * a)),
  );
  const { element, fill } = stripes(plot);
  const strip = (from, to, more) => svg("rect", { x: from, y: top, width: to - from, height: bottom - top, ...more });
  const of = (kind) =>
    zones.filter((zone) => zone.kind === kind).map(({ from, to }) => [from, to].map((x) => plot.x.at(x)));
  return [
    ...bodies(plot, a),
    svg("defs", {}, gradient),
    element,
    strip(left, right, { class: "disc", fill: `url(#${id})` }),
    ...of("slip").map(([from, to]) => strip(from, to, { class: "slipping", fill })),
    ...of("stick").flatMap(([from, to]) => stickZone([from, to], [top, bottom], state)),
    ...bulkStress(plot, definition, state),
    ...colourScale(plot, full),
    ...arrow(plot, history),
  ];
}

/** The two bodies: flat on each other between −a and a, and a gap outside, whose form is that beside any such edge. */
function bodies(plot, a) {
  const [low, high] = [plot.x.from, plot.x.to];
  const gap = (x) => GAP * ((x / a - 1) / (REACH - 1)) ** 1.5;
  const side = (sign) =>
    Array.from({ length: OUTLINE + 1 }, (_, index) => a * (1 + (index / OUTLINE) * (REACH - 1))).map((x) => [
      plot.x.at(sign * x),
      plot.y.at(gap(x)),
    ]);
  const outline = [...side(-1).reverse(), ...side(1)].map(([x, y]) => `${x.toFixed(2)},${y.toFixed(2)}`);
  const ends = [low, high].map((x) => plot.x.at(x));
  const [surface, { top, bottom }] = [plot.y.at(0), plot.box];
  return [
    svg("path", { class: "solid", d: `M${ends[0]},${surface}H${ends[1]}V${bottom}H${ends[0]}Z` }),
    svg("path", { class: "solid", d: `M${outline.join("L")}V${top}H${plot.x.at(-REACH * a)}Z` }),
    svg("text", { class: "small", x: plot.box.left + 8, y: top + 16 }, "first body"),
    svg("text", { class: "small", x: plot.box.left + 8, y: plot.y.at(-STRIP) + 18 }, "second body"),
  ];
}

/** The ends of the zone that stuck, its name, and its middle where that is not that of the contact. */
function stickZone([from, to], [top, bottom], { stick_centre: e = 0, contact_radius: a, stick_radius: c }) {
  const middle = (from + to) / 2;
  const name = e === 0 ? "stick" : `stick, its middle at x = ${formatQuantity(e, "m", 3)}`;
  return [
    ...(c < a
      ? [from, to].map((x) => svg("line", { class: "front", x1: x, x2: x, y1: top - 10, y2: bottom + 10 }))
      : []),
    ...(e === 0 ? [] : [svg("line", { class: "middle", x1: middle, x2: middle, y1: top - 10, y2: bottom + 10 })]),
    svg("text", { class: "band-name stick over", x: middle, y: top - 16, "text-anchor": "middle" }, name),
  ];
}

/** The bulk stress now, as arrows in the body that carries it. */
function bulkStress(plot, { bulk, material }, { force }) {
  if (!isEccentric({ bulk, material })) return [];
  const stress = bulk.stress_per_force * force;
  const { left, right } = plot.box;
  const y = plot.y.at(bulk.body === "first" ? 0.75 : -0.45);
  const name = `bulk σ = ${formatQuantity(stress, "Pa", 3)}`;
  const label = svg("text", { class: "small", x: (left + right) / 2, y: y + 22, "text-anchor": "middle" }, name);
  if (stress === 0) return [label];
  // Tension pulls outwards on both sides.
  const end = (x, sign) =>
    svg("path", {
      class: "arrow",
      d: `M${x - sign * 30},${y}h${sign * 60}m${-sign * 8},-5l${sign * 8},5l${-sign * 8},5`,
    });
  const out = Math.sign(stress);
  return [label, end(left + 50, -out), end(right - 50, out)];
}
