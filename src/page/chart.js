// Lines over two axes, as SVG: with values under the pointer, zoom, the keyboard, and a menu to save.
import { drawnWords, el, svg, words } from "./dom.js";
import { Axis, around } from "./scale.js";
import { menu } from "./save.js";
import { pointing } from "./pointing.js";
import { shown } from "./units.js";

const PAD = { left: 62, right: 14, top: 12, bottom: 46 };
let count = 0;

/** A plot. `draw` gives it something to show; `onhover` tells where the pointer is. */
export class Chart {
  /** `mode`: whether the pointer looks for the nearest value of `x`, the `nearest` point, or what the owner `reads`. */
  constructor({ name, title, x, y, mode = "x", square = false, height = 300, note }) {
    Object.assign(this, { name, title, mode, square, height, x: new Axis(x), y: new Axis(y) });
    this.clip = `clip-${count += 1}`;
    this.data = { series: [] };
    this.view = null;
    this.hidden = new Set();
    this.svg = svg("svg", { class: "chart", tabindex: 0, role: "application", "aria-roledescription": "plot", "aria-label": `${title}. Arrow keys read values, plus and minus zoom, 0 shows all.` });
    this.legend = el("div", { class: "legend" });
    this.said = el("output", { class: "said", "aria-live": "polite" });
    this.note = el("p", { class: "note" }, words(note ?? ""));
    this.element = el("figure", { class: "plot", id: `plot-${name}` }, el("figcaption", {}, el("h3", {}, words(title)), menu(this)), this.legend, this.svg, this.said, this.note);
    new ResizeObserver(() => this.redraw()).observe(this.element);
    pointing(this);
  }

  /** Shows data: `series`, and if wanted `bands` along x, `levels` of y, `marks`, a `range` or what it covers at `least`, a `layer` below,
   *  a `table`, and words for when there are no values. */
  draw(data) {
    this.data = data;
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
    const points = this.visible().flatMap((series) => series.points);
    const { range: own = {}, least = {} } = this.data;
    const x = own.x ?? around(points.map((point) => point[0]).concat(least.x ?? []), this.x.log);
    const y = own.y ?? around(points.map((point) => point[1]).filter((value) => value !== null).concat(least.y ?? []), this.y.log);
    const cap = this.data.cap ?? Infinity;
    return { x, y: [Math.max(y[0], -cap), Math.min(y[1], cap)] };
  }

  render() {
    const width = this.element.clientWidth;
    if (!width) return;
    const height = this.square ? Math.min(this.height, width) : this.height;
    const ranges = this.ranges();
    this.box = { left: PAD.left, right: width - PAD.right, top: PAD.top, bottom: height - PAD.bottom };
    const box = this.box;
    if (this.square) ranges.x = this.evened(ranges);
    this.x.fit(ranges.x, box.left, box.right);
    this.y.fit(ranges.y, box.bottom, box.top);
    this.svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    this.svg.setAttribute("height", height);
    const inside = svg("g", { "clip-path": `url(#${this.clip})` });
    const size = { x: box.left, y: box.top, width: box.right - box.left, height: box.bottom - box.top };
    this.cursor = svg("g", { class: "cursor" });
    this.svg.replaceChildren(svg("defs", {}, svg("clipPath", { id: this.clip }, svg("rect", size))),
      svg("rect", { class: "field", ...size }), this.bands(), this.grid(), inside, svg("rect", { class: "frame", ...size }), this.cursor);
    this.data.layer?.(this, inside);
    if (this.data.empty && !this.visible().some((series) => series.points.some((point) => point[1] !== null))) {
      inside.append(svg("text", { class: "small", x: (box.left + box.right) / 2, y: (box.top + box.bottom) / 2, "text-anchor": "middle" }, this.data.empty));
    }
    for (const level of this.data.levels ?? []) inside.append(this.level(level));
    for (const series of this.visible()) inside.append(...this.line(series));
    for (const mark of this.data.marks ?? []) {
      inside.append(svg("circle", { class: `mark ${mark.class ?? ""}`, cx: this.x.at(mark.x), cy: this.y.at(mark.y), r: mark.size ?? 6 }));
    }
    if (this.data.note) this.note.textContent = this.data.note;
    this.keys();
    this.point(this.pointed);
  }

  /** A range of x with the same scale as that of y. */
  evened({ x, y }) {
    const { left, right, top, bottom } = this.box;
    const half = (y[1] - y[0]) / (bottom - top) * (right - left) / 2;
    const middle = (x[0] + x[1]) / 2;
    return [middle - half, middle + half];
  }

  bands() {
    const group = svg("g", {});
    for (const { from, to, kind, label } of this.data.bands ?? []) {
      const [left, right] = [this.x.at(from), this.x.at(to)].map((place) => Math.min(Math.max(place, this.box.left), this.box.right));
      if (right - left < 0.5) continue;
      group.append(svg("rect", { class: `band ${kind}`, x: left, y: this.box.top, width: right - left, height: this.box.bottom - this.box.top }));
      if (right - left > 34) group.append(svg("text", { class: `band-name ${kind}`, x: (left + right) / 2, y: this.box.top + 15, "text-anchor": "middle" }, label));
    }
    return group;
  }

  grid() {
    const { left, right, top, bottom } = this.box;
    const group = svg("g", { class: "grid" });
    for (const [value, text] of this.x.ticks(80)) {
      const x = this.x.at(value);
      group.append(svg("line", { class: value === 0 ? "zero" : "", x1: x, x2: x, y1: top, y2: bottom }), svg("text", { x, y: bottom + 17, "text-anchor": "middle" }, text));
    }
    for (const [value, text] of this.y.ticks(45)) {
      const y = this.y.at(value);
      group.append(svg("line", { class: value === 0 ? "zero" : "", x1: left, x2: right, y1: y, y2: y }), svg("text", { x: left - 7, y: y + 4, "text-anchor": "end" }, text));
    }
    const middle = (top + bottom) / 2;
    group.append(svg("text", { class: "title", x: (left + right) / 2, y: bottom + 37, "text-anchor": "middle" }, ...drawnWords(this.x.title())),
      svg("text", { class: "title", x: 13, y: middle, "text-anchor": "middle", transform: `rotate(-90 13 ${middle})` }, ...drawnWords(this.y.title())));
    return group;
  }

  level({ y, label, kind }) {
    const at = this.y.at(y);
    return svg("g", { class: `level ${kind ?? ""}` }, svg("line", { x1: this.box.left, x2: this.box.right, y1: at, y2: at }),
      svg("text", { x: y > 0 ? this.box.left + 6 : this.box.right - 6, y: at + (y > 0 ? 15 : -6), "text-anchor": y > 0 ? "start" : "end" }, ...drawnWords(label ?? "")));
  }

  line({ name, points, kind, dots, label, line = true }) {
    const places = points.map(([x, y]) => (y === null || this.y.log && y <= 0 ? null : [this.x.at(x), this.y.at(y)]));
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
    if (dots) for (const place of places) if (place) drawn.push(svg("circle", { class: `dot ${kind}`, cx: place[0], cy: place[1], r: 3 }));
    const last = places.findLast(Boolean);
    if (label && last) {
      const late = last[0] > (this.box.left + this.box.right) / 2;
      drawn.push(svg("text", { class: "small", x: last[0] + (late ? -8 : 8), y: last[1] + 4, "text-anchor": late ? "end" : "start" }, name));
    }
    return drawn;
  }

  /** The legend, whose entries switch their series off and on. */
  keys() {
    const named = this.data.series.filter((series) => series.legend !== false);
    const text = named.map((series) => series.name).join();
    if (named.length < 2 || text === this.keyed) return;
    this.keyed = text;
    this.legend.replaceChildren(...named.map(({ name, kind }) => el("button", { type: "button", class: `key ${kind}`, "aria-pressed": String(!this.hidden.has(name)), onclick: ({ currentTarget }) => {
      if (!this.hidden.delete(name)) this.hidden.add(name);
      currentTarget.setAttribute("aria-pressed", String(!this.hidden.has(name)));
      this.redraw();
    } }, words(name))));
  }

  /** Marks a place, with lines of text beside it: `{ x, y, dots, lines, ring }`, or nothing. */
  point(hit) {
    this.pointed = hit;
    if (!this.cursor) return;
    this.cursor.replaceChildren();
    if (!hit) { this.said.textContent = ""; return; }
    const [x, y] = [this.x.at(hit.x), hit.y === undefined ? this.box.top + 14 : this.y.at(hit.y)];
    if (this.mode === "x") this.cursor.append(svg("line", { x1: x, x2: x, y1: this.box.top, y2: this.box.bottom }));
    for (const dot of hit.dots ?? []) if (dot[1] !== null) this.cursor.append(svg("circle", { cx: this.x.at(dot[0]), cy: this.y.at(dot[1]), r: 4 }));
    if (hit.ring) this.cursor.append(svg("circle", { class: "ring", cx: this.x.at(0), cy: this.y.at(0), r: Math.abs(this.x.at(hit.ring) - this.x.at(0)) }));
    if (!hit.lines?.length) return;
    const texts = hit.lines.map((line, index) => svg("text", { x: 8, y: 17 + 16 * index }, line));
    const label = svg("g", { class: "label" }, ...texts);
    this.cursor.append(label);
    const wide = label.getBBox().width + 16;
    const high = 10 + 16 * texts.length;
    label.prepend(svg("rect", { width: wide, height: high, rx: 4 }));
    const left = x + 12 + wide > this.box.right ? Math.max(2, x - 12 - wide) : x + 12;
    label.setAttribute("transform", `translate(${left} ${Math.min(Math.max(y - high / 2, 2), this.box.bottom - high)})`);
    this.said.textContent = hit.lines.join(", ");
  }

  /** A value of an axis as people read it. */
  reading(axis, value) {
    return shown(value, axis.unit);
  }
}
