// Pointer and keyboard of a plot: read values, drag a box to zoom, step from point to point.
import { nearestIndex } from "./axis.js";
import { svg } from "./dom.js";

/** Adds the handlers of pointer and keyboard to a chart. */
export function handleInput(chart) {
  const { svg: root } = chart;
  let start = null;
  let pointer = null;
  const place = (event) => {
    const area = root.getBoundingClientRect();
    return [event.clientX - area.left, event.clientY - area.top];
  };
  const select = (hit) => {
    chart.showCursor(hit);
    chart.onhover(hit);
  };
  root.addEventListener("pointermove", (event) => {
    if (!chart.box) return;
    pointer = place(event);
    if (start && isDrag(start, pointer)) return drawBox(chart, start, pointer);
    select(hitAt(chart, pointer));
  });
  root.addEventListener("pointerdown", (event) => {
    if (event.pointerType !== "mouse" || event.button !== 0 || !chart.box) return;
    start = place(event);
    root.setPointerCapture(event.pointerId);
  });
  root.addEventListener("pointerup", (event) => {
    const now = place(event);
    if (start && isDrag(start, now)) zoomToBox(chart, start, now);
    start = null;
  });
  root.addEventListener("pointercancel", () => {
    start = null;
  });
  root.addEventListener("pointerleave", () => {
    pointer = null;
    if (!start) select(null);
  });
  // The data under a resting pointer may have changed.
  chart.refresh = () => (pointer && !start ? select(hitAt(chart, pointer)) : chart.showCursor(chart.pointed));
  root.addEventListener("dblclick", () => chart.reset());
  root.addEventListener("blur", () => select(null));
  root.addEventListener("keydown", (event) => {
    const steps = { ArrowRight: 1, ArrowLeft: -1, PageDown: 20, PageUp: -20, Home: -1e9, End: 1e9 };
    const acts = {
      "+": () => chart.zoom(0.6),
      "-": () => chart.zoom(1 / 0.6),
      0: () => chart.reset(),
      Escape: () => select(null),
    };
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    // The keyboard takes pointer from a resting pointer.
    pointer = null;
    if (event.key in steps) select(stepBy(chart, steps[event.key]));
    else if (event.key in acts) acts[event.key]();
    else return;
    event.preventDefault();
  });
  chart.reset = () => chart.look(null, true);
  chart.zoom = (by) => {
    const { x, y } = chart;
    const kept = (axis) => {
      const middle = (axis.start + axis.end) / 2;
      return [axis.back(middle + (axis.start - middle) * by), axis.back(middle + (axis.end - middle) * by)];
    };
    chart.look({ x: kept(x), y: kept(y) });
  };
}

const isDrag = (start, now) => Math.hypot(start[0] - now[0], start[1] - now[1]) > 8;

const sorted = (one, two) => (one < two ? [one, two] : [two, one]);

function drawBox(chart, start, now) {
  const [left, right] = sorted(start[0], now[0]);
  const [top, bottom] = sorted(start[1], now[1]);
  chart.cursor.replaceChildren(
    svg("rect", { class: "choice", x: left, y: top, width: right - left, height: bottom - top }),
  );
}

function zoomToBox(chart, start, now) {
  const x = sorted(start[0], now[0]).map((place) => chart.x.back(place));
  // From the lower border up, whichever way the axis points.
  const y = sorted(now[1], start[1])
    .reverse()
    .map((place) => chart.y.back(place));
  // A flat box zooms along x alone.
  chart.showCursor(null);
  chart.look({ x, y: Math.abs(start[1] - now[1]) < 12 ? chart.ranges().y : y });
}

/** What is at a position: the points of all series nearest in x, or the one nearest point. */
function hitAt(chart, [left, top]) {
  if (chart.read) return chart.read(chart.x.back(left), chart.y.back(top));
  const series = chart.visible().filter((one) => one.points.length && one.hover !== false);
  if (!series.length) return null;
  if (chart.mode === "x") return hitsAtX(chart, series, chart.x.back(left));
  let best = null;
  for (const one of series) {
    for (const [index, point] of one.points.entries()) {
      if (point[1] === null) continue;
      const distance = Math.hypot(chart.x.at(point[0]) - left, chart.y.at(point[1]) - top);
      if (!best || distance < best.distance) best = { distance, one, index };
    }
  }
  return best && at(chart, best.one, best.index);
}

function at(chart, series, index) {
  const point = series.points[index];
  chart.index = index;
  const lines = [
    `${chart.x.label} ${chart.formatted(chart.x, point[0])}`,
    `${chart.y.label} ${chart.formatted(chart.y, point[1])}`,
    ...chart.more(point, series),
  ];
  return { x: point[0], y: point[1], dots: [point], lines, datum: point };
}

function hitsAtX(chart, series, x) {
  const near = series.map(({ name, points }) => {
    const index = nearestIndex(
      points.map((point) => point[0]),
      x,
    );
    return { name, index, point: points[index] };
  });
  chart.index = near[0].index;
  const first = near[0].point;
  const lines = near.map(({ name, point }) => `${name} ${chart.formatted(chart.y, point[1])}`);
  return {
    x: first[0],
    dots: near.map(({ point }) => point),
    lines: [`${chart.x.label} ${chart.formatted(chart.x, first[0])}`, ...lines],
    datum: first,
  };
}

function stepBy(chart, by) {
  const [series] = chart.visible().filter((one) => one.points.length && one.hover !== false);
  if (!series) return null;
  const now = chart.pointed || Math.abs(by) > 1e6 ? (chart.index ?? 0) + by : 0;
  const index = Math.min(Math.max(now, 0), series.points.length - 1);
  if (chart.read) {
    chart.index = index;
    return chart.read(series.points[index][0], 0);
  }
  if (chart.mode !== "x") return at(chart, series, index);
  const hit = hitsAtX(
    chart,
    chart.visible().filter((one) => one.points.length && one.hover !== false),
    series.points[index][0],
  );
  chart.index = index;
  return hit;
}
