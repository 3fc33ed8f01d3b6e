// The parts of a plot: bands, the grid with its numbers, levels and series.
import { svgWithSubscripts, svg } from "./dom.js";

/** Ranges of x with a colour and a name. */
export function drawBands(chart) {
  const group = svg("g", {});
  for (const { from, to, kind, label } of chart.data.bands ?? []) {
    const [left, right] = [chart.x.at(from), chart.x.at(to)].map((place) =>
      Math.min(Math.max(place, chart.box.left), chart.box.right),
    );
    if (right - left < 0.5) continue;
    group.append(
      svg("rect", {
        class: `band ${kind}`,
        x: left,
        y: chart.box.top,
        width: right - left,
        height: chart.box.bottom - chart.box.top,
      }),
    );
    if (right - left > 34)
      group.append(
        svg(
          "text",
          { class: `band-name ${kind}`, x: (left + right) / 2, y: chart.box.top + 15, "text-anchor": "middle" },
          label,
        ),
      );
  }
  return group;
}

/** The middle of a pixel, where a line of one pixel is as dark as any other. */
const crisp = (place) => Math.floor(place) + 0.5;

/** The lines of the grid, their numbers, and the titles of the axes. */
export function drawGrid(chart) {
  const { left, right, top, bottom } = chart.box;
  const group = svg("g", { class: "grid" });
  for (const [value, text] of chart.x.ticks(80)) {
    const x = crisp(chart.x.at(value));
    group.append(
      svg("line", { class: value === 0 ? "zero" : "", x1: x, x2: x, y1: top, y2: bottom }),
      svg("text", { x, y: bottom + 17, "text-anchor": "middle" }, text),
    );
  }
  for (const [value, text] of chart.y.ticks(45)) {
    const y = crisp(chart.y.at(value));
    group.append(
      svg("line", { class: value === 0 ? "zero" : "", x1: left, x2: right, y1: y, y2: y }),
      svg("text", { x: left - 7, y: y + 4, "text-anchor": "end" }, text),
    );
  }
  const middle = (top + bottom) / 2;
  group.append(
    svg(
      "text",
      { class: "title", x: (left + right) / 2, y: bottom + 37, "text-anchor": "middle" },
      ...svgWithSubscripts(chart.x.title()),
    ),
    svg(
      "text",
      { class: "title", x: 13, y: middle, "text-anchor": "middle", transform: `rotate(-90 13 ${middle})` },
      ...svgWithSubscripts(chart.y.title()),
    ),
  );
  return group;
}

/** Sets titles closer that are longer than the plot. */
export function shrinkTitles({ svg: drawing }) {
  const { width, height } = drawing.viewBox.baseVal;
  for (const title of drawing.querySelectorAll("text.title")) {
    const room = title.hasAttribute("transform") ? height : width;
    if (title.getComputedTextLength() <= room) continue;
    title.setAttribute("textLength", String(room - 4));
    title.setAttribute("lengthAdjust", "spacingAndGlyphs");
    // The middle of the plot lies above that of the drawing.
    if (title.hasAttribute("transform")) title.setAttribute("transform", `rotate(-90 13 ${height / 2})`);
    title.setAttribute(title.hasAttribute("transform") ? "y" : "x", String(room / 2));
  }
}

/** A labelled value of y. */
export function drawLevel(chart, { y, label, kind }) {
  const at = crisp(chart.y.at(y));
  return svg(
    "g",
    { class: `level ${kind ?? ""}` },
    svg("line", { x1: chart.box.left, x2: chart.box.right, y1: at, y2: at }),
    svg(
      "text",
      {
        x: y > 0 ? chart.box.left + 6 : chart.box.right - 6,
        y: at + (y > 0 ? 15 : -6),
        "text-anchor": y > 0 ? "start" : "end",
      },
      ...svgWithSubscripts(label ?? ""),
    ),
  );
}

/** A series: its line, interrupted where values are missing, and its dots. */
export function drawSeries(chart, { name, points, kind, dots, label, size = 3, line = true }) {
  const places = points.map(([x, y]) =>
    y === null || (chart.y.log && y <= 0) ? null : [chart.x.at(x), chart.y.at(y)],
  );
  const drawn = [];
  if (line) {
    let pen = "M";
    const path = places.map((place) => {
      const step = place ? `${pen}${place[0].toFixed(2)},${place[1].toFixed(2)}` : "";
      pen = place ? "L" : "M";
      return step;
    });
    drawn.push(svg("path", { class: `line ${kind}`, d: path.join("") }));
  }
  if (dots)
    for (const place of places)
      if (place) drawn.push(svg("circle", { class: `dot ${kind}`, cx: place[0], cy: place[1], r: size }));
  const last = places.findLast(Boolean);
  if (label && last) {
    const late = last[0] > (chart.box.left + chart.box.right) / 2;
    drawn.push(
      svg(
        "text",
        {
          class: "small over series-name",
          x: last[0] + (late ? -8 : 8),
          y: last[1] + (line ? -5 : 4),
          "text-anchor": late ? "end" : "start",
        },
        name,
      ),
    );
  }
  return drawn;
}

/** Moves the names of series apart that lie on each other, downwards, or upwards where there is no room. */
export function spreadNames(chart) {
  const placed = [];
  const names = [...chart.svg.querySelectorAll(".series-name")].map((text) => ({ text, box: text.getBBox() }));
  for (const { text, box } of names.sort((one, two) => one.box.y - two.box.y)) {
    const collides = (y) =>
      placed.some(
        (other) => box.x < other.x + other.width && other.x < box.x + box.width && Math.abs(y - other.y) < box.height,
      );
    const offsets = Array.from({ length: 40 }, (_, index) => Math.ceil(index / 2) * (index % 2 ? 7 : -7));
    const inside = (y) => y >= chart.box.top && y + box.height <= chart.box.bottom;
    const isFree = (by) => !collides(box.y + by) && (by === 0 || inside(box.y + by));
    const offset = offsets.find(isFree) ?? 0;
    text.setAttribute("dy", offset);
    placed.push({ x: box.x, y: box.y + offset, width: box.width });
  }
}
