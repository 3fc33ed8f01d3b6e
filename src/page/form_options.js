// The shapes, the materials and the units that the form offers.
import { FAMILIES } from "./families.js";
import { inPower, prefixed } from "./units.js";

export const LENGTH = prefixed("m", "", "m", "µ", "n");
export const FORCE = prefixed("N", "k", "", "m", "µ");
export const MODULUS = prefixed("Pa", "G", "M", "k", "");
export const STRESS = prefixed("Pa", "M", "G", "");

/** A stress over a force. @type {[string, number][]} */
export const STRESS_PER_FORCE = [
  ["MPa/kN", 3],
  ["MPa/N", 6],
  ["Pa/N", 0],
];

const radius = { name: "radius", label: "Radius R", units: LENGTH, unit: "mm", value: "10" };
const length = { name: "length", label: "Length L of the contact", units: LENGTH, unit: "mm", value: "10" };
const reference = { name: "reference_length", units: LENGTH, unit: "mm", optional: true };

/** The field for a parameter of a family: a length in the unit of which the example is at least one. */
function field({ name, label, si, example }) {
  if (si !== "m") return { name, label, value: example };
  const [unit, power] = LENGTH.find((choice) => Number(inPower(Number(example), choice[1])) >= 1);
  return { name, label, units: LENGTH, unit, value: inPower(Number(example), power) };
}

const families = Object.entries(FAMILIES).map(([type, [title, parameters]]) => [type, [title, parameters.map(field)]]);

/** What each shape is called, and its fields. */
export const PROFILES = {
  ...Object.fromEntries(families),
  cylinder: [
    "Cylinder along a line",
    [{ ...radius, value: "50" }, length, { ...reference, label: "Reference length, if not 2 R" }],
  ],
  rounded_pad: [
    "Rounded pad along a line",
    [
      { ...radius, name: "flat_half_width", label: "Half-width b of the flat", value: "0.5" },
      { ...radius, name: "edge_radius", label: "Radius R of the edges", value: "50" },
      length,
      { ...reference, label: "Reference length, if not L" },
    ],
  ],
  tabulated: ["Table of measured heights", []],
  sum: ["Sum of shapes", []],
  ellipsoid: [
    "Ellipsoid (Hertz’s ellipse)",
    [
      { ...radius, name: "radii/0", label: "Radius R_x along the motion" },
      { ...radius, name: "radii/1", label: "Radius R_y across it", value: "5" },
      { name: "direction", label: "Motion along", options: { x: "x", y: "y" } },
    ],
  ],
  asperities: ["Rough: many asperities", []],
  load_curve: ["Measured load curve", []],
};

/** Those that are known by their load curve alone: no stress, and no part of a sum. */
export const WITHOUT_STRESS = ["ellipsoid", "asperities", "load_curve"];

/** Those along a line, with stresses over x in place of the radius; they are no part of a sum either. */
export const LINE_CONTACTS = ["cylinder", "rounded_pad"];

const lines = (count, line) => Array.from({ length: count }, (_, index) => line(index)).join("\n");

/** The shapes that are given by two columns: what the text field is called, its columns with their units, and an
 *  example. */
export const COLUMNS = {
  // A ball of 10 mm in radius.
  tabulated: [
    "Radius and height, one pair a line",
    [
      ["r", "Radii in ", LENGTH, "µm"],
      ["z", "Heights in ", LENGTH, "µm"],
    ],
    lines(11, (index) => `${index * 20}\t${(index * index * 0.02).toFixed(2)}`),
  ],
  asperities: [
    "Radius of curvature of an asperity and its gap, one pair a line",
    [
      ["radii", "Radii in ", LENGTH, "µm"],
      ["gaps", "Gaps in ", LENGTH, "nm"],
    ],
    lines(20, (index) => `${50 + 5 * (index % 7)}\t${index * 25}`),
  ],
  // A ball of 10 mm against a flat one, both of steel: F = (4/3) E* sqrt(R d^3).
  load_curve: [
    "Indentation and normal force, one pair a line",
    [
      ["indentation", "Indentations in ", LENGTH, "µm"],
      ["normal_force", "Forces in ", FORCE, "N"],
    ],
    lines(21, (index) => `${(index * 0.1).toFixed(1)}\t${(0.4866 * index ** 1.5).toFixed(4)}`),
  ],
};

export const PRELOADS = {
  normal_force: { label: "Normal force F_N", units: FORCE, unit: "N", value: "10" },
  indentation: { label: "Indentation d", units: LENGTH, unit: "µm", value: "1" },
  contact_radius: { label: "Contact radius a", units: LENGTH, unit: "µm", value: "100" },
};
