// Asks before a move that is so far that it is probably a slip of the finger: it would make all other moves invisible in the plots.
import { formatQuantity } from "./units.js";

/** As the warning `far_beyond_slip` of the service has it: times the displacement of gross slip, and part of the profile's length. */
const [MAX_GROSS_SLIPS, MAX_PART_OF_LENGTH] = [100, 0.1];
/** The lengths that make a profile large or small. */
const LENGTHS = ["radius", "radii", "flat_radius", "edge_radius", "tip_radius", "r"];

/** The largest length of a profile and its parts. */
function longest(profile) {
  const own = LENGTHS.flatMap((name) => profile[name] ?? []);
  return [...own, ...(profile.parts ?? []).map(longest)].reduce((most, length) => Math.max(most, length), 0);
}

/** Whether a displacement is far beyond slip for a contact in its present state. */
export function isFar(model, displacement) {
  const slip = Math.max(model.slip(model.state), model.figures.gross_slip_displacement);
  const length = Math.max(longest(model.definition.profile), model.state.contact_radius);
  return Math.abs(displacement) > Math.max(MAX_GROSS_SLIPS * slip, MAX_PART_OF_LENGTH * length);
}

/** Asks whether a displacement is meant; whether it is. */
export function confirmFar(model, displacement) {
  const dialog = document.getElementById("far");
  const slip = Math.max(model.slip(model.state), model.figures.gross_slip_displacement);
  const times = slip > 0 ? `, ${formatQuantity(Math.abs(displacement) / slip, "", 2)} times the displacement of gross slip` : "";
  dialog.querySelector("#far-text").textContent =
    `The move would lead to ${formatQuantity(displacement, "m")}${times}. All other moves would be too small to be seen in the plots.`;
  dialog.returnValue = "";
  dialog.showModal();
  return new Promise((resolve) => {
    dialog.addEventListener("close", () => resolve(dialog.returnValue === "send"), { once: true });
  });
}
