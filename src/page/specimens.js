// Small pictures of the specimens of line contacts, from the side, for the form that creates a contact.
import { svg } from "./dom.js";

/** Where the side of each specimen is, its outline above the contact, what is measured on it, and it in words. */
const SPECIMENS = {
  cylinder: {
    side: 210,
    outline: "M93.4,15A60,60 0 1 0 206.6,15Z",
    measures: [
      ["M150,35L108,78", 114, 54, "R"],
      ["M30,115H8l6,-4M8,115l6,4M270,115h22l-6,-4M292,115l-6,4", 276, 106, "σ"],
    ],
    words: "A cylinder of radius R is pressed on a flat; the flat may carry a bulk stress σ along the motion.",
  },
  rounded_pad: {
    side: 237,
    outline: "M63,15V65A60,60 0 0 0 115,95H185A60,60 0 0 0 237,65V15Z",
    measures: [
      ["M115,80H185M115,75v10M185,75v10", 142, 74, "2b"],
      ["M185,35L215,87", 206, 58, "R"],
    ],
    words: "A pad with a flat of the width 2b and edges of radius R is pressed on a flat.",
  },
};

/** The picture of a specimen. */
export function specimenPicture(type) {
  const { side, outline, measures, words } = SPECIMENS[type];
  const text = (x, y, value) => svg("text", { x, y }, value);
  const force = (x, y, name) => svg("text", { x, y }, name[0], svg("tspan", { class: "index", dy: 4 }, name.slice(1)));
  return svg(
    "svg",
    { class: "specimen", viewBox: "0 0 300 150", role: "img", "aria-label": `${words} Its length L is across.` },
    svg("rect", { class: "solid", x: 30, y: 95, width: 240, height: 40 }),
    svg("path", { class: "solid", d: outline }),
    ...measures.flatMap(([d, x, y, name]) => [svg("path", { class: "measure", d }), text(x, y, name)]),
    svg("path", { class: "arrow", d: "M150,2V28l-4,-7M150,28l4,-7" }),
    force(156, 13, "FN"),
    svg("path", { class: "arrow", d: `M${side},45h38l-7,-4m7,4l-7,4` }),
    text(side + 16, 37, "F"),
    text(40, 128, "length L across the picture"),
  );
}
