// What the pointer and the keyboard do to a plot: read values, drag a box to zoom, step from point to point.
import { svg } from "./dom.js";

/** Teaches a chart to listen. */
export function pointing(chart) {
  const { svg: root } = chart;
  let start = null;
  let over = null;
  const place = (event) => {
    const area = root.getBoundingClientRect();
    return [event.clientX - area.left, event.clientY - area.top];
  };
  const tell = (hit) => {
    chart.point(hit);
    chart.onhover?.(hit);
  };
  root.addEventListener("pointermove", (event) => {
    if (!chart.box) return;
    over = place(event);
    if (start && drawn(start, over)) return box(chart, start, over);
    tell(found(chart, over));
  });
  root.addEventListener("pointerdown", (event) => {
    if (event.pointerType !== "mouse" || event.button !== 0 || !chart.box) return;
    start = place(event);
    root.setPointerCapture(event.pointerId);
  });
  root.addEventListener("pointerup", (event) => {
    const now = place(event);
    if (start && drawn(start, now)) zoomTo(chart, start, now);
    start = null;
  });
  root.addEventListener("pointercancel", () => {
    start = null;
  });
  root.addEventListener("pointerleave", () => {
    over = null;
    if (!start) tell(null);
  });
  // What is under a pointer that rests may have changed.
  chart.refresh = () => (over && !start ? tell(found(chart, over)) : chart.point(chart.pointed));
  root.addEventListener("dblclick", () => chart.reset());
  root.addEventListener("blur", () => tell(null));
  root.addEventListener("keydown", (event) => {
    const steps = { ArrowRight: 1, ArrowLeft: -1, PageDown: 20, PageUp: -20, Home: -1e9, End: 1e9 };
    const acts = {
      "+": () => chart.zoom(0.6),
      "-": () => chart.zoom(1 / 0.6),
      0: () => chart.reset(),
      Escape: () => tell(null),
    };
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    // The keyboard reads on, wherever the pointer rests.
    over = null;
    if (event.key in steps) tell(stepped(chart, steps[event.key]));
    else if (event.key in acts) acts[event.key]();
    else return;
    event.preventDefault();
  });
  chart.reset = () => {
    chart.view = null;
    chart.redraw();
  };
  chart.zoom = (by) => {
    const { x, y } = chart;
    const kept = (axis) => {
      const middle = (axis.start + axis.end) / 2;
      return [axis.back(middle + (axis.start - middle) * by), axis.back(middle + (axis.end - middle) * by)];
    };
    chart.view = { x: kept(x), y: kept(y) };
    chart.redraw();
  };
}

const drawn = (start, now) => Math.hypot(start[0] - now[0], start[1] - now[1]) > 8;

const sorted = (one, two) => (one < two ? [one, two] : [two, one]);

function box(chart, start, now) {
  const [left, right] = sorted(start[0], now[0]);
  const [top, bottom] = sorted(start[1], now[1]);
  chart.cursor.replaceChildren(svg("rect", { class: "choice", x: left, y: top, width: right - left, height: bottom - top }));
}

function zoomTo(chart, start, now) {
  const x = sorted(chart.x.back(start[0]), chart.x.back(now[0]));
  const y = sorted(chart.y.back(start[1]), chart.y.back(now[1]));
  // A box that is hardly higher than wide means a piece of the axis.
  chart.view = { x, y: Math.abs(start[1] - now[1]) < 12 ? chart.ranges().y : y };
  chart.point(null);
  chart.redraw();
}

/** What lies under a place: the points of all series nearest in x, or the one nearest point. */
function found(chart, [left, top]) {
  if (chart.read) return chart.read(chart.x.back(left), chart.y.back(top));
  const series = chart.visible().filter((one) => one.points.length && one.hover !== false);
  if (!series.length) return null;
  if (chart.mode === "x") return along(chart, series, chart.x.back(left));
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
    `${chart.x.label} ${chart.reading(chart.x, point[0])}`,
    `${chart.y.label} ${chart.reading(chart.y, point[1])}`,
    ...(chart.more?.(point, series) ?? []),
  ];
  return { x: point[0], y: point[1], dots: [point], lines, datum: point };
}

function along(chart, series, x) {
  const near = series.map(({ name, points }) => {
    const index = points.reduce(
      (best, point, index) => (Math.abs(point[0] - x) < Math.abs(points[best][0] - x) ? index : best),
      0,
    );
    return { name, index, point: points[index] };
  });
  chart.index = near[0].index;
  const first = near[0].point;
  const lines = near.map(({ name, point }) => `${name} ${chart.reading(chart.y, point[1])}`);
  return {
    x: first[0],
    dots: near.map(({ point }) => point),
    lines: [`${chart.x.label} ${chart.reading(chart.x, first[0])}`, ...lines],
    datum: first,
  };
}

function stepped(chart, by) {
  const [series] = chart.visible().filter((one) => one.points.length && one.hover !== false);
  if (!series) return null;
  const now = chart.pointed || Math.abs(by) > 1e6 ? (chart.index ?? 0) + by : 0;
  const index = Math.min(Math.max(now, 0), series.points.length - 1);
  if (chart.read) {
    chart.index = index;
    return chart.read(series.points[index][0], 0);
  }
  if (chart.mode !== "x") return at(chart, series, index);
  const hit = along(
    chart,
    chart.visible().filter((one) => one.points.length && one.hover !== false),
    series.points[index][0],
  );
  chart.index = index;
  return hit;
}
