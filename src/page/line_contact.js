// What a line contact has that a round one has not: places along x in place of radii, two edges that a bulk stress
// makes unlike, and another area.
import { LINE_CONTACTS } from "./form_options.js";

/** Whether the contact of a definition is along a line. */
export const isLine = ({ profile }) => LINE_CONTACTS.includes(profile.type);

/** Whether a bulk stress moves the stick zone: a rigid body is not strained by one. */
export function isEccentric({ bulk, material }) {
  const bodies = material.bodies ?? material.effective.bodies;
  return Boolean(bulk?.stress_per_force) && bodies?.[bulk.body === "first" ? 0 : 1] !== "rigid";
}

/** The radii of a reply or, of a line contact, its places along x. */
export const placesOf = ({ radius, x }) => x ?? radius;

/** The finite extrema of the shear stress as `[place, stress]`. Those at −x, which the service leaves out where both
 *  halves are alike, are among them. */
export function peaksOf({ peaks }, definition) {
  const given = peaks.filter(({ shear }) => shear !== null).map(({ radius, x, shear }) => [x ?? radius, shear]);
  const isHalf = isLine(definition) && !isEccentric(definition);
  return isHalf ? [...given, ...given.map(([x, shear]) => [-x, shear])] : given;
}

/** Where the last move of a state stuck and where it slipped: from the centre to the edge or, of a line contact, from
 *  edge to edge. */
export function zonesOf({ contact_radius: a, stick_radius: c, stick_centre: e = 0 }, isAlongLine) {
  const start = isAlongLine ? -a : 0;
  if (!(c > 0)) return [{ from: start, to: a, kind: "slip" }];
  const [left, right] = [isAlongLine ? e - c : 0, e + c];
  return [
    { from: start, to: left, kind: "slip" },
    { from: left, to: right, kind: "stick" },
    { from: right, to: a, kind: "slip" },
  ].filter(({ from, to }) => to > from);
}

/** Load over area, Pa. */
export const meanPressure = (definition, { normal_force: load, contact_radius: a }) =>
  load / (isLine(definition) ? 2 * a * definition.profile.length : Math.PI * a * a);
