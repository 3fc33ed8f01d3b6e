// A section through a body: a stress as shades over x and depth, the edge of the contact, and the largest value.
import { Chart } from "./chart.js";
import { svg } from "./dom.js";
import { formatQuantity } from "./units.js";

const SHADES = 16;

/** The plot; `show` draws points `[x, z, value]` in rows of so many `columns`, and returns its smallest, largest and first infinite one. */
export function sectionPlot() {
  const chart = new Chart({
    name: "below",
    title: "Section along the motion",
    mode: "nearest",
    aspect: 1.5 / 4,
    x: { label: "x, along the motion", unit: "m" },
    y: { label: "Depth z", unit: "m" },
    note: "The plane y = 0, x along the motion of the first body, at 61 × 31 points. Dashed: the edge of the contact. The ring marks the largest value.",
  });
  chart.show = (points, { field, name, columns, radius }) => {
    const finite = points.filter((point) => point[2] !== null);
    const low = finite.reduce((least, point) => (point[2] < least[2] ? point : least));
    const high = finite.reduce((most, point) => (point[2] > most[2] ? point : most));
    const largest = -low[2] > high[2] ? low : high;
    const [from, to] = [Math.min(low[2], 0), Math.max(high[2], 0)];
    const scale = { from, step: (to - from) / SHADES || 1, full: Math.abs(largest[2]) || 1 };
    chart.more = ([, , value]) => [`${name} ${formatQuantity(value, "Pa")}`];
    chart.draw({
      series: [{ name, points, line: false }],
      // Depth grows downwards.
      range: { x: [points[0][0], points.at(-1)[0]], y: [points.at(-1)[1], 0] },
      marks: [{ x: largest[0], y: largest[1], class: "turn" }],
      layer: (plot, group) =>
        group.append(...shades(plot, points, columns, scale), ...edges(plot, radius), ...shadeScale(plot, scale)),
      table: () => ({ columns: ["x_m", "depth_m", `${field}_pa`], rows: points }),
    });
    return { low, high, infinite: points.find((point) => point[2] === null) };
  };
  return chart;
}

/** The colour of a shade: green for tension and quantities without a sign, purple for compression. */
function colour(index, { from, step, full }) {
  const value = (from + (index + 0.5) * step) / full;
  return `color-mix(in oklab, var(${value < 0 ? "--minus" : "--plus"}) ${Math.round(100 * Math.abs(value))}%, var(--none))`;
}

/** One path for each shade, of the cells about its points; neighbours in a row are one rectangle. */
function shades(plot, points, columns, scale) {
  const [dx, dz] = [points[1][0] - points[0][0], points[columns][1] - points[0][1]];
  // An infinite value has the shade of the largest.
  const shadeOf = ([, , value]) => Math.min(SHADES - 1, Math.floor(((value ?? Infinity) - scale.from) / scale.step));
  const paths = Array.from({ length: SHADES }, () => []);
  for (let begin = 0, end = 1; end <= points.length; end += 1) {
    const shade = shadeOf(points[begin]);
    if (end % columns !== 0 && shadeOf(points[end]) === shade) continue;
    const [left, right] = [points[begin][0] - dx / 2, points[end - 1][0] + dx / 2].map((x) => plot.x.at(x).toFixed(2));
    const [top, bottom] = [-dz / 2, dz / 2].map((z) => plot.y.at(points[begin][1] + z).toFixed(2));
    paths[shade].push(`M${left},${top}H${right}V${bottom}H${left}Z`);
    begin = end;
  }
  return paths.map((path, index) =>
    svg("path", { class: "shade", d: path.join(""), fill: colour(index, scale), "shape-rendering": "crispEdges" }),
  );
}

/** The edge of the contact on both sides. */
function edges(plot, radius) {
  return [-radius, radius].flatMap((edge) => {
    const x = plot.x.at(edge);
    return [
      svg("line", { class: "contact-edge", x1: x, x2: x, y1: plot.box.top, y2: plot.box.bottom }),
      svg("text", { class: "small over", x: x + 4, y: plot.box.top + 14 }, edge < 0 ? "−a" : "a"),
    ];
  });
}

/** The shades with the values at their ends. */
function shadeScale(plot, scale) {
  const { left, bottom } = plot.box;
  const [x, y, wide] = [left + 8, bottom - 14, 5];
  const ends = [scale.from, scale.from + SHADES * scale.step].map((value) => (value === 0 ? "0" : formatQuantity(value, "Pa", 2)));
  return [
    ...Array.from({ length: SHADES }, (_, index) =>
      svg("rect", { x: x + wide * index, y, width: wide, height: 8, fill: colour(index, scale), "shape-rendering": "crispEdges" }),
    ),
    svg("text", { class: "small over", x, y: y - 4 }, ends.join(" to ")),
  ];
}
