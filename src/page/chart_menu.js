// The menu of a plot: zoom, and files to save.
import { el, mapped, notice, save, svg, svgWithSubscripts, withSubscripts } from "./dom.js";
import { menuEntry, popupMenu } from "./popup_menu.js";

// The properties that keep the look of a plot without the style sheet of the page.
const STYLES = [
  "fill",
  "fill-opacity",
  "fill-rule",
  "stroke",
  "stroke-width",
  "stroke-dasharray",
  "stroke-opacity",
  "stroke-linejoin",
  "stroke-linecap",
  "paint-order",
  "opacity",
  "font-family",
  "font-size",
  "font-weight",
];

/** What a chart can be saved as, and how. */
const FORMATS = {
  PNG: savePng,
  SVG: (chart) => save(`${chart.name}.svg`, "image/svg+xml", svgText(chart)),
  CSV: (chart) => save(`${chart.name}.csv`, "text/csv", csvText(chart)),
};

/** A menu for a chart. */
export function menu(chart) {
  const entries = [
    menuEntry("Zoom in", () => chart.zoom(0.6)),
    menuEntry("Zoom out", () => chart.zoom(1 / 0.6)),
    menuEntry("Show all", () => chart.reset()),
    ...Object.entries(FORMATS).map(([name, act]) => menuEntry(`Save ${name}`, () => act(chart))),
  ];
  return popupMenu("⋯", { class: "menu", label: `Zoom or save: ${chart.title}` }, entries);
}

/** A row of a menu that saves a chart in each format. */
export const saveRow = (chart) =>
  el(
    "div",
    { class: "save-row" },
    el("span", { class: "faint" }, withSubscripts(chart.title)),
    ...Object.entries(FORMATS).map(([name, act]) => menuEntry(name, () => act(chart), `${chart.title} as ${name}`)),
  );

/** The plot as an SVG document, with its title and its legend above it. */
export function svgText(chart) {
  const head = savedHead(chart);
  const copy = chart.svg.cloneNode(true);
  const [originals, copies] = [chart.svg, copy].map((root) => [root, ...root.querySelectorAll("*")]);
  for (const [index, element] of originals.entries()) {
    const style = getComputedStyle(element);
    for (const name of element.localName === "stop" ? ["stop-color"] : STYLES)
      copies[index].setAttribute(name, plainColour(style.getPropertyValue(name)));
    copies[index].removeAttribute("class");
  }
  head.element.remove();
  const [width, height] = savedSize(chart, head.height);
  const size = { y: -head.height, width, height };
  copy.setAttribute("xmlns", "http://www.w3.org/2000/svg");
  copy.setAttribute("viewBox", `0 ${-head.height} ${width} ${height}`);
  copy.setAttribute("width", width);
  copy.setAttribute("height", height);
  copy.prepend(svg("rect", { ...size, fill: getComputedStyle(chart.element).backgroundColor }));
  return new XMLSerializer().serializeToString(copy);
}

/** Whole pixels, so that each line of a picture of twice the size is as wide as the others. */
function savedSize(chart, more) {
  const { width, height } = chart.svg.viewBox.baseVal;
  return [Math.ceil(width), Math.ceil(height) + more];
}

/** The title and a sample of each visible series with its name, above the drawing, and their height. */
function savedHead(chart) {
  const [width] = savedSize(chart, 0);
  const title = svg("text", { class: "saved-title", x: 12 }, ...svgWithSubscripts(chart.title));
  const element = svg("g", {}, title);
  chart.svg.append(element);
  const named = chart.visible().filter((series) => series.legend !== false);
  const places = [];
  let [x, row] = [12, 0];
  for (const { name, kind, line: isLine = true } of named.length > 1 ? named : []) {
    const sample = isLine
      ? svg("path", { class: `line ${kind}`, d: "M0,-4h18" })
      : svg("circle", { class: `dot ${kind}`, cx: 9, cy: -4, r: 3 });
    const text = svg("text", { x: 24 }, ...svgWithSubscripts(name));
    const entry = svg("g", {}, sample, text);
    element.append(entry);
    const wide = 36 + text.getComputedTextLength();
    if (x > 12 && x + wide > width) [x, row] = [12, row + 1];
    places.push({ entry, left: x, line: row });
    x += wide;
  }
  const rows = places.length ? row + 1 : 0;
  const height = 32 + 18 * rows;
  title.setAttribute("y", String(22 - height));
  for (const { entry, left, line } of places)
    entry.setAttribute("transform", `translate(${left} ${42 + 18 * line - height})`);
  return { element, height };
}

/** Mixed colours as red, green and blue, which every program understands; other values unchanged. */
function plainColour(value) {
  if (!/^(oklab|oklch|color)\(/.test(value)) return value;
  const context = el("canvas", { width: 1, height: 1 }).getContext("2d");
  context.fillStyle = value;
  context.fillRect(0, 0, 1, 1);
  return `rgb(${[...context.getImageData(0, 0, 1, 1).data.slice(0, 3)].join(", ")})`;
}

async function savePng(chart) {
  const url = URL.createObjectURL(new Blob([svgText(chart)], { type: "image/svg+xml" }));
  try {
    const picture = new Image();
    picture.src = url;
    await picture.decode();
    const [width, height] = [picture.naturalWidth, picture.naturalHeight].map((pixels) => 2 * pixels);
    const canvas = el("canvas", { width, height });
    canvas.getContext("2d").drawImage(picture, 0, 0, width, height);
    canvas.toBlob((blob) => save(`${chart.name}.png`, "image/png", blob));
  } catch (error) {
    notice(`The image could not be saved: ${error.message}`, true);
  } finally {
    URL.revokeObjectURL(url);
  }
}

/** Columns of a table: of each item the member that a column names. */
export const columnsOf = (items, columns) => mapped(columns, (key) => items.map((item) => item[key]));

/** The data of a plot: the table that it was given, or the points of its series one below the other. */
export function csvText(chart) {
  const [x, y] = [chart.x, chart.y].map(({ label, unit }) => `${label} ${unit}`.trim());
  const points = chart.data.series.flatMap((one) => one.points.map((point) => [one.name, ...point]));
  const table = chart.data.table?.() ?? columnsOf(points, { series: 0, [x]: 1, [y]: 2 });
  const columns = Object.values(table);
  const rows = columns[0].map((_, index) => columns.map((column) => column[index]));
  const cell = (value) => (/[",\n]/.test(value) ? `"${String(value).replaceAll('"', '""')}"` : (value ?? ""));
  return `${[Object.keys(table), ...rows].map((row) => row.map(cell).join(",")).join("\n")}\n`;
}
