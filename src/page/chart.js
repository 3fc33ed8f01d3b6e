// A plot of lines over two axes, as SVG: values under the pointer, zoom, keyboard, and a menu to save it.
import { Axis, dataRange } from "./axis.js";
import { drawCursor, drawLegend, inkedPlaces } from "./chart_cursor.js";
import { handleInput } from "./chart_input.js";
import { menu } from "./chart_menu.js";
import { drawBands, drawGrid, drawLevel, drawSeries, shrinkTitles, spreadNames } from "./chart_parts.js";
import { el, svg, withSubscripts } from "./dom.js";
import { formatQuantity } from "./units.js";

const PAD = { left: 62, right: 14, top: 12, bottom: 46 };

/**
 * A bare axis has no numbers.
 * @typedef {{ label: string, unit?: string, log?: boolean, isBare?: boolean }} AxisOptions
 */

/** A plot. `draw` sets its data; `onhover` is called with what is under the pointer. */
export class Chart {
  /** What else than its values a point has: lines of text. @type {(point: any, series: any) => string[]} */
  more = () => [];
  /** What is under a place of a plot of this `mode`. @type {(x: number, y: number) => any} */
  read = null;
  /** Called with what is under the pointer, and when another part or other series are to be seen. */
  /** @type {(hit: any) => void} */
  onhover = () => {};
  onlook = () => {};
  /** Reads again what is under a pointer that rests. */
  refresh = () => {};

  /** `mode`: whether the pointer selects all series at its `x`, the `nearest` point, or a `radius` that `read` finds;
   *  `aspect`: height over width of its field.
   * @param {{ name: string, title: string, x: AxisOptions, y: AxisOptions, mode?: "x" | "nearest" | "radius",
   *  square?: boolean, aspect?: number, height?: number, note?: string }} about */
  constructor({ name, title, x, y, mode = "x", square = false, aspect, height = 300, note }) {
    this.name = name;
    this.title = title;
    this.x = new Axis(x);
    this.y = new Axis(y);
    this.mode = mode;
    this.square = square;
    this.aspect = aspect;
    this.height = height;
    this.clip = `clip-${name}`;
    /** @type {Record<string, any>} */
    this.data = { series: [] };
    /** @type {{ x: number[], y: number[] } | null} */
    this.view = null;
    this.hidden = new Set();
    this.svg = svg("svg", {
      class: "chart",
      tabindex: 0,
      role: "application",
      "aria-roledescription": "plot",
      "aria-label": `${title}. Arrow keys read values, plus and minus zoom, 0 shows all.`,
    });
    this.legend = el("div", { class: "legend" });
    this.said = el("output", { class: "said", "aria-live": "polite" });
    this.note = el("p", { class: "note" }, withSubscripts(note ?? ""));
    this.element = el(
      "figure",
      { class: "plot", id: `plot-${name}` },
      el("figcaption", {}, el("h3", {}, withSubscripts(title)), menu(this)),
      this.legend,
      this.svg,
      this.said,
      this.note,
    );
    new ResizeObserver(() => this.redraw()).observe(this.element);
    handleInput(this);
  }

  /** Zooms to ranges of both axes, or, with nothing, to the recent part or to all there is. */
  look(view, isWhole = false) {
    this.view = view;
    this.isWhole = isWhole;
    this.onlook();
    this.redraw();
  }

  /** Shows data: `series`, and optionally the `recent` points that the axes fit where older ones lie far from them,
   *  `bands` along x, `levels` of y, `marks`, a `range` or what it covers at `least`, a `layer` below, a `table`, and a
   *  text for when it is `empty`. */
  draw(data) {
    this.data = data;
    this.element.hidden = false;
    this.redraw();
  }

  redraw() {
    this.frame ??= requestAnimationFrame(() => {
      this.frame = null;
      this.render();
    });
  }

  /** The series that are not switched off. */
  visible() {
    return this.data.series.filter((series) => !this.hidden.has(series.name));
  }

  ranges() {
    if (this.view) return this.view;
    const { range: own = {}, least = {}, recent } = this.data;
    const points = (!this.isWhole && recent) || this.visible().flatMap((series) => series.points);
    const x = own.x ?? dataRange(points.map((point) => point[0]).concat(least.x ?? []), this.x.log);
    const y =
      own.y ??
      dataRange(
        points
          .map((point) => point[1])
          .filter((value) => value !== null)
          .concat(least.y ?? []),
        this.y.log,
      );
    const cap = this.data.cap ?? Infinity;
    return { x, y: [Math.max(y[0], -cap), Math.min(y[1], cap)] };
  }

  render() {
    const { width } = this.svg.getBoundingClientRect();
    if (!width) return;
    const height = this.aspect
      ? Math.round(this.aspect * (width - PAD.left - PAD.right)) + PAD.top + PAD.bottom
      : this.square
        ? Math.min(this.height, width)
        : this.height;
    const ranges = this.ranges();
    this.box = { left: PAD.left, right: Math.floor(width) - PAD.right, top: PAD.top, bottom: height - PAD.bottom };
    const box = this.box;
    if (this.square) ranges.x = this.evened(ranges);
    this.x.fit(ranges.x, box.left, box.right);
    this.y.fit(ranges.y, box.bottom, box.top);
    this.svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    this.svg.setAttribute("height", String(height));
    const inside = svg("g", { "clip-path": `url(#${this.clip})` });
    const size = { x: box.left, y: box.top, width: box.right - box.left, height: box.bottom - box.top };
    this.cursor = svg("g", { class: "cursor" });
    this.svg.replaceChildren(
      svg("defs", {}, svg("clipPath", { id: this.clip }, svg("rect", size))),
      svg("rect", { class: "field", ...size }),
      drawBands(this),
      drawGrid(this),
      inside,
      svg("rect", { class: "frame", ...size, x: box.left + 0.5, y: box.top + 0.5 }),
      this.cursor,
    );
    shrinkTitles(this);
    this.data.layer?.(this, inside);
    if (this.data.empty && !this.visible().some((series) => series.points.some((point) => point[1] !== null))) {
      inside.append(
        svg(
          "text",
          { class: "small", x: (box.left + box.right) / 2, y: (box.top + box.bottom) / 2, "text-anchor": "middle" },
          this.data.empty,
        ),
      );
    }
    for (const one of this.data.levels ?? []) inside.append(drawLevel(this, one));
    for (const series of this.visible()) inside.append(...drawSeries(this, series));
    for (const mark of this.data.marks ?? []) {
      inside.append(
        svg("circle", {
          class: `mark ${mark.class ?? ""}`,
          cx: this.x.at(mark.x),
          cy: this.y.at(mark.y),
          r: mark.size ?? 6,
        }),
      );
    }
    spreadNames(this);
    this.inked = this.mode === "radius" || this.data.layer ? [] : inkedPlaces(this);
    if (this.data.note !== undefined) this.note.textContent = this.data.note;
    drawLegend(this);
    this.refresh();
  }

  /** A range of x with the same scale as that of y. */
  evened({ x, y }) {
    const { left, right, top, bottom } = this.box;
    const half = (((y[1] - y[0]) / (bottom - top)) * (right - left)) / 2;
    const middle = (x[0] + x[1]) / 2;
    return [middle - half, middle + half];
  }

  /** Marks a position, with lines of text beside it: `{ x, y, dots, lines, ring }`, or nothing. */
  showCursor(hit) {
    drawCursor(this, hit);
  }

  /** A value of an axis as text. */
  formatted(axis, value) {
    return formatQuantity(value, axis.unit);
  }
}
