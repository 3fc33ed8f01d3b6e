// The cursor over a plot, and its legend.
import { el, svg, withSubscripts } from "./dom.js";

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
            chart.onlook?.();
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
  const texts = hit.lines.map((line, index) => svg("text", { x: 8, y: 17 + 16 * index }, line));
  const label = svg("g", { class: "label" }, ...texts);
  chart.cursor.append(label);
  const wide = label.getBBox().width + 16;
  const high = 10 + 16 * texts.length;
  label.prepend(svg("rect", { width: wide, height: high, rx: 4 }));
  const left = x + 12 + wide > chart.box.right ? Math.max(2, x - 12 - wide) : x + 12;
  label.setAttribute("transform", `translate(${left} ${Math.min(Math.max(y - high / 2, 2), chart.box.bottom - high)})`);
  chart.said.textContent = hit.lines.join(", ");
}
