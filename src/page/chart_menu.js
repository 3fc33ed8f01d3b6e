// The menu of a plot: zoom, and files to save.
import { el, notice, save } from "./dom.js";

// The properties that keep the look of a plot without the style sheet of the page.
const STYLES = [
  "fill",
  "fill-opacity",
  "fill-rule",
  "stroke",
  "stroke-width",
  "stroke-dasharray",
  "stroke-opacity",
  "opacity",
  "font-family",
  "font-size",
  "font-weight",
];

/** A menu for a chart. */
export function menu(chart) {
  const entry = (text, act) =>
    el(
      "button",
      {
        type: "button",
        onclick: (event) => {
          event.currentTarget.closest("details").open = false;
          act();
        },
      },
      text,
    );
  return el(
    "details",
    {
      class: "menu",
      onkeydown: (event) => {
        if (event.key !== "Escape") return;
        event.currentTarget.open = false;
        event.currentTarget.firstElementChild.focus();
      },
      onfocusout: (event) => {
        if (!event.currentTarget.contains(event.relatedTarget)) event.currentTarget.open = false;
      },
    },
    el("summary", { "aria-label": `Zoom or save: ${chart.title}`, title: "Zoom or save" }, "⋯"),
    el(
      "div",
      {},
      entry("Zoom in", () => chart.zoom(0.6)),
      entry("Zoom out", () => chart.zoom(1 / 0.6)),
      entry("Show all", () => chart.reset()),
      entry("Save PNG", () => savePng(chart)),
      entry("Save SVG", () => save(`${chart.name}.svg`, "image/svg+xml", svgText(chart))),
      entry("Save CSV", () => save(`${chart.name}.csv`, "text/csv", csvText(chart))),
    ),
  );
}

/** The plot as an SVG document. */
export function svgText(chart) {
  const copy = chart.svg.cloneNode(true);
  const [originals, copies] = [chart.svg, copy].map((root) => [root, ...root.querySelectorAll("*")]);
  for (const [index, element] of originals.entries()) {
    const style = getComputedStyle(element);
    for (const name of element.localName === "stop" ? ["stop-color"] : STYLES)
      copies[index].setAttribute(name, plainColour(style.getPropertyValue(name)));
    copies[index].removeAttribute("class");
  }
  const { width, height } = chart.svg.viewBox.baseVal;
  copy.setAttribute("xmlns", "http://www.w3.org/2000/svg");
  copy.setAttribute("width", width);
  copy.setAttribute("height", height);
  const background = document.createElementNS("http://www.w3.org/2000/svg", "rect");
  background.setAttribute("width", width);
  background.setAttribute("height", height);
  background.setAttribute("fill", getComputedStyle(chart.element).backgroundColor);
  copy.prepend(background);
  return new XMLSerializer().serializeToString(copy);
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
    const { width, height } = chart.svg.viewBox.baseVal;
    const canvas = el("canvas", { width: 2 * width, height: 2 * height });
    canvas.getContext("2d").drawImage(picture, 0, 0, 2 * width, 2 * height);
    canvas.toBlob((blob) => save(`${chart.name}.png`, "image/png", blob));
  } catch (error) {
    notice(`The image could not be saved: ${error.message}`, true);
  } finally {
    URL.revokeObjectURL(url);
  }
}

/** The data of a plot: the table that it was given, or the points of its series one below the other. */
export function csvText(chart) {
  const { columns, rows } = chart.data.table?.() ?? {
    columns: ["series", `${chart.x.label} ${chart.x.unit}`.trim(), `${chart.y.label} ${chart.y.unit}`.trim()],
    rows: chart.data.series.flatMap(({ name, points }) => points.map(([x, y]) => [name, x, y])),
  };
  const cell = (value) => (/[",\n]/.test(value) ? `"${String(value).replaceAll('"', '""')}"` : (value ?? ""));
  return `${[columns, ...rows].map((row) => row.map(cell).join(",")).join("\n")}\n`;
}
