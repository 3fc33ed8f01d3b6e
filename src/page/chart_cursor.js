// The cursor over a plot, and its legend.
import { el, svg, svgWithSubscripts, withSubscripts } from "./dom.js";

/** Draws the legend, whose entries switch their series off and on. */
export function drawLegend(chart) {
  const named = chart.data.series.filter((series) => series.legend !== false);
  const text = named.map((series) => series.name).join();
  if (named.length < 2 || text === chart.keyed) return;
  chart.keyed = text;
  chart.legend.replaceChildren(
    ...named.map(({ name, kind }) =>
      el(
        "button",
        {
          type: "button",
          class: `key ${kind}`,
          "aria-pressed": String(!chart.hidden.has(name)),
          onclick: ({ currentTarget }) => {
            if (!chart.hidden.delete(name)) chart.hidden.add(name);
            currentTarget.setAttribute("aria-pressed", String(!chart.hidden.has(name)));
            chart.onlook();
            chart.redraw();
          },
        },
        withSubscripts(name),
      ),
    ),
  );
}

/** Marks a position, with lines of text beside it: `{ x, y, dots, lines, ring }`, or nothing. */
export function drawCursor(chart, hit) {
  chart.pointed = hit;
  if (!chart.cursor) return;
  chart.cursor.replaceChildren();
  if (!hit) {
    chart.said.textContent = "";
    return;
  }
  const [x, y] = [chart.x.at(hit.x), hit.y === undefined ? chart.box.top + 14 : chart.y.at(hit.y)];
  if (chart.mode === "x") chart.cursor.append(svg("line", { x1: x, x2: x, y1: chart.box.top, y2: chart.box.bottom }));
  for (const dot of hit.dots ?? [])
    if (dot[1] !== null) chart.cursor.append(svg("circle", { cx: chart.x.at(dot[0]), cy: chart.y.at(dot[1]), r: 4 }));
  if (hit.ring)
    chart.cursor.append(
      svg("circle", {
        class: "ring",
        cx: chart.x.at(0),
        cy: chart.y.at(0),
        r: Math.abs(chart.x.at(hit.ring) - chart.x.at(0)),
      }),
    );
  if (!hit.lines?.length) return;
  const texts = hit.lines.map((line, index) => svg("text", { x: 8, y: 17 + 16 * index }, ...svgWithSubscripts(line)));
  const label = svg("g", { class: "label" }, ...texts);
  chart.cursor.append(label);
  const wide = label.getBBox().width + 16;
  const high = 10 + 16 * texts.length;
  label.prepend(svg("rect", { width: wide, height: high, rx: 4 }));
  const [left, top] = labelPlace(chart, x, y, wide, high);
  label.setAttribute("transform", `translate(${left} ${top})`);
  chart.said.textContent = hit.lines.join(", ");
}

/** Where a label hides least of the lines: beside what is pointed at if nothing is hidden there, else in a corner. */
function labelPlace(chart, x, y, wide, high) {
  const { left, right, top, bottom } = chart.box;
  const across = (place) => Math.min(Math.max(place, 2), Math.max(2, right - wide - 2));
  const down = (place) => Math.min(Math.max(place, 2), Math.max(2, bottom - high - 2));
  const beside = [x + 14, x - 14 - wide].flatMap((one) =>
    [y - high / 2, y - high - 10, y + 10].map((two) => [one, two]),
  );
  const corners = [left + 6, right - wide - 6].flatMap((one) => [top + 6, bottom - high - 6].map((two) => [one, two]));
  const places = [...beside, ...corners].map(([one, two]) => [across(one), down(two)]);
  const hides = ([one, two]) => {
    const isHidden = ([px, py]) => px > one - 3 && px < one + wide + 3 && py > two - 3 && py < two + high + 3;
    return chart.inked.filter(isHidden).length + (isHidden([x, y]) ? 1e6 : 0);
  };
  const counts = places.map(hides);
  return places[counts.indexOf(Math.min(...counts))];
}

/** Places on the visible lines, a few pixels from each other. */
export function inkedPlaces(chart) {
  const apart = 6;
  const places = [];
  for (const { points, line = true } of chart.visible()) {
    let last = null;
    for (const [px, py] of points) {
      const place = py === null || (chart.y.log && py <= 0) ? null : [chart.x.at(px), chart.y.at(py)];
      const steps =
        line && last && place ? Math.min(Math.hypot(place[0] - last[0], place[1] - last[1]) / apart, 200) : 0;
      for (let step = 1; step < steps; step += 1) {
        const part = step / steps;
        places.push([last[0] + part * (place[0] - last[0]), last[1] + part * (place[1] - last[1])]);
      }
      if (place) places.push(place);
      last = place;
    }
  }
  return places;
}
