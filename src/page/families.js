// The families of shapes whose parameters are plain numbers: printed by `./check print`.

/** @type {Record<string, [string, { name: string; label: string; si: string; example: string }[]]>} */
// prettier-ignore
export const FAMILIES = {
  sphere: [
    "Sphere (Hertz’s parabola)",
    [
      { name: "radius", label: "Radius R", si: "m", example: "0.01" },
    ],
  ],
  exact_sphere: [
    "Exact sphere",
    [
      { name: "radius", label: "Radius R", si: "m", example: "0.01" },
    ],
  ],
  cone: [
    "Cone",
    [
      { name: "slope", label: "Slope dz/dr", si: "", example: "0.05" },
    ],
  ],
  power_law: [
    "Power law z = c rⁿ",
    [
      { name: "exponent", label: "Exponent n", si: "", example: "4" },
      { name: "coefficient", label: "Coefficient c (m to the 1 − n)", si: "m^(1-n)", example: "1000000" },
    ],
  ],
  flat_punch: [
    "Flat punch",
    [
      { name: "radius", label: "Radius R", si: "m", example: "0.001" },
    ],
  ],
  truncated_cone: [
    "Truncated cone",
    [
      { name: "slope", label: "Slope dz/dr", si: "", example: "0.05" },
      { name: "flat_radius", label: "Radius of the flat", si: "m", example: "0.00005" },
    ],
  ],
  truncated_sphere: [
    "Truncated (worn) sphere",
    [
      { name: "radius", label: "Radius R", si: "m", example: "0.01" },
      { name: "flat_radius", label: "Radius of the flat", si: "m", example: "0.00005" },
    ],
  ],
  rounded_punch: [
    "Punch with a rounded edge",
    [
      { name: "flat_radius", label: "Radius of the flat", si: "m", example: "0.00005" },
      { name: "edge_radius", label: "Radius of the edge", si: "m", example: "0.005" },
    ],
  ],
  rounded_cone: [
    "Cone with a rounded tip",
    [
      { name: "slope", label: "Slope dz/dr", si: "", example: "0.05" },
      { name: "tip_radius", label: "Radius of the tip", si: "m", example: "0.00005" },
    ],
  ],
};
