// A section through a body: a stress as shades over x and depth, the edge of the contact, and the largest value.
import { Chart } from "./chart.js";
import { columnsOf } from "./chart_menu.js";
import { svg } from "./dom.js";
import { formatNumber, formatQuantity } from "./units.js";

const SHADES = 24;
/** How far beyond the surface a section with a mark reaches, so that one on the surface is seen whole; a part of its
 *  depth. */
const RIM = 0.06;
/** How far a name stays from a mark, pixels. */
const CLEAR = 32;

/** The points of a reply over a grid, `[x, z, value]`, from left to right and then down. */
export function gridPoints({ x, z }, values, rows) {
  const points = x.map((place, index) => [place, z[index], values[index]]);
  return Array.from({ length: rows }, (_, row) => points.filter((_point, index) => index % rows === row)).flat();
}

/** The plot; `drawPoints` draws points `[x, z, value]` in rows of so many `columns`, marks the `worst` place, by
 *  default the largest of them, and returns its smallest, largest and first infinite one. */
export function sectionPlot({ name, title, note }) {
  const chart = new Chart({
    name,
    title,
    mode: "nearest",
    aspect: 1.5 / 4,
    x: { label: "x, along the motion", unit: "m" },
    y: { label: "Depth z", unit: "m" },
    note,
  });
  const drawPoints = (points, { field, quantity, columns, radius, unit = "Pa", worst = undefined }) => {
    const finite = points.filter((point) => point[2] !== null);
    const low = finite.reduce((least, point) => (point[2] < least[2] ? point : least));
    const high = finite.reduce((most, point) => (point[2] > most[2] ? point : most));
    const largest = -low[2] > high[2] ? low : high;
    const [from, to] = [Math.min(low[2], 0), Math.max(high[2], worst?.value ?? 0, 0)];
    const text = (value, digits) => (unit ? formatQuantity(value, unit, digits) : formatNumber(value, digits));
    const scale = {
      from,
      to,
      step: (to - from) / SHADES || 1,
      full: Math.max(Math.abs(from), Math.abs(to)) || 1,
      text,
      name: quantity,
    };
    const [x, z] = worst ? [worst.point[0], worst.point[2]] : largest;
    chart.more = ([, , value]) => [`${quantity} ${text(value)}`];
    chart.draw({
      series: [{ name: quantity, points, line: false }],
      // Depth grows downwards.
      range: { x: [points[0][0], points.at(-1)[0]], y: [points.at(-1)[1], worst ? -RIM * points.at(-1)[1] : 0] },
      marks: [{ x, y: z, class: "turn worst" }],
      layer: (plot, group) =>
        group.append(
          ...shades(plot, points, columns, scale),
          ...edges(plot, radius, [plot.x.at(x), plot.y.at(z)]),
          ...shadeScale(plot, scale),
        ),
      table: () => columnsOf(points, { x_m: 0, depth_m: 1, [unit === "Pa" ? `${field}_pa` : field]: 2 }),
    });
    return { low, high, infinite: points.find((point) => point[2] === null) };
  };
  return Object.assign(chart, { drawPoints });
}

/** The colour of a shade: green for tension and quantities without a sign, purple for compression. */
function colour(index, { from, step, full }) {
  const value = (from + (index + 0.5) * step) / full;
  const part = Math.round(100 * Math.abs(value));
  return `color-mix(in oklab, var(${value < 0 ? "--minus" : "--plus"}) ${part}%, var(--none))`;
}

/** The part of a polygon of corners `[x, y, value]` in which values, straight between the corners, are at least
 *  `level`. */
function above(corners, level) {
  return corners.flatMap((corner, index) => {
    const next = corners[(index + 1) % corners.length];
    const own = corner[2] >= level ? [corner] : [];
    if (corner[2] >= level === next[2] >= level) return own;
    const part = (level - corner[2]) / (next[2] - corner[2]);
    return [...own, [corner[0] + part * (next[0] - corner[0]), corner[1] + part * (next[1] - corner[1]), level]];
  });
}

/** One path for each shade, of all that is at least as large, so that each is drawn over the one before. */
function shades(plot, points, columns, scale) {
  const rows = points.length / columns;
  // An infinite value has the shade of the largest.
  const corner = (row, column) => {
    const [x, z, value] = points[row * columns + column];
    return [plot.x.at(x), plot.y.at(z), value ?? scale.to];
  };
  const paths = Array.from({ length: SHADES }, () => []);
  const place = ([x, y]) => `${x.toFixed(2)},${y.toFixed(2)}`;
  const write = (path, corners) => path.push(`M${corners.map(place).join("L")}Z`);
  for (let row = 0; row + 1 < rows; row += 1) {
    // Cells that are above a level as a whole are one rectangle with their neighbours.
    const begun = paths.map(() => null);
    for (let column = 0; column + 1 < columns; column += 1) {
      const cell = [corner(row, column), corner(row, column + 1), corner(row + 1, column + 1), corner(row + 1, column)];
      const [least, most] = [
        Math.min(...cell.map(([, , value]) => value)),
        Math.max(...cell.map(([, , value]) => value)),
      ];
      for (const [index, path] of paths.entries()) {
        const level = index === 0 ? -Infinity : scale.from + index * scale.step;
        if (least >= level && begun[index]) [begun[index][1], begun[index][2]] = [cell[1], cell[2]];
        else if (least >= level) begun[index] = [...cell];
        else {
          if (begun[index]) write(path, begun[index]);
          begun[index] = null;
          if (most >= level) write(path, above(cell, level));
        }
      }
    }
    for (const [index, path] of paths.entries()) if (begun[index]) write(path, begun[index]);
  }
  return paths.map((path, index) => svg("path", { class: "shade", d: path.join(""), fill: colour(index, scale) }));
}

/** The edge of the contact on both sides, with names that keep clear of the mark. */
function edges(plot, radius, mark) {
  return [-radius, radius].flatMap((edge) => {
    const x = plot.x.at(edge);
    const top = plot.box.top + 14;
    const y = Math.hypot(mark[0] - x, mark[1] - top) > CLEAR ? top : (plot.box.top + plot.box.bottom) / 2;
    return [
      svg("line", { class: "contact-edge", x1: x, x2: x, y1: plot.box.top, y2: plot.box.bottom }),
      svg("text", { class: "small over", x: x + 4, y }, edge < 0 ? "−a" : "a"),
    ];
  });
}

/** The shades with the values at their ends. */
function shadeScale(plot, scale) {
  const { left, bottom } = plot.box;
  const [x, y, wide] = [left + 8, bottom - 14, 4];
  const ends = [scale.from, scale.to].map((value) => (value === 0 ? "0" : scale.text(value, 2)));
  return [
    ...Array.from({ length: SHADES }, (_, index) =>
      svg("rect", {
        x: x + wide * index,
        y,
        width: wide,
        height: 8,
        fill: colour(index, scale),
        "shape-rendering": "crispEdges",
      }),
    ),
    svg("text", { class: "small over", x, y: y - 4 }, `${scale.name}: ${ends.join(" to ")}`),
  ];
}
