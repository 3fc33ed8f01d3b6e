// What an empty service shows: an example computed without storing anything, which one press makes a contact.
import { call } from "./api.js";
import { el, reason } from "./dom.js";
import { formatNumber, formatQuantity } from "./units.js";

const STEEL = { youngs_modulus: 2.1e11, poisson_ratio: 0.3 };
/** The first contact of `stickslip demo`. */
const BALL = {
  profile: { type: "sphere", radius: 0.01 },
  material: { bodies: [STEEL, STEEL] },
  friction: 0.3,
  preload: { normal_force: 10 },
};
const PATH = { falling_amplitude: { reversals: 20 } };

/** The card of a service without contacts. What is computed for it ends with `signal`. */
export function firstContact(signal) {
  const found = el("p", { id: "example", "aria-live": "polite" });
  const fault = el("p", { class: "fault", role: "alert" });
  const open = el("button", { class: "primary", id: "open-example" }, "Make this contact");
  call("POST", "/simulate", { contact: BALL, path: PATH, steps: "last", residual: true }, signal).then(
    ({ contact, residual }) => {
      const share = formatNumber(100 * residual.relative, 2);
      found.textContent =
        `For example: a steel ball of 10 mm radius on steel under 10 N, μ = 0.3: contact radius ` +
        `${formatQuantity(contact.contact_radius, "m")}, largest pressure ` +
        `${formatQuantity(contact.max_pressure, "Pa")}. Slid to gross slip and moved back and forth 20 times with ` +
        `falling amplitude, it keeps a shear stress of ${share} % of μ p_max.`;
    },
    () => {},
  );
  open.addEventListener("click", async () => {
    open.disabled = true;
    fault.textContent = "";
    try {
      const label = "ball, 20 reversals of falling amplitude";
      const { id } = await call("POST", "/contacts", { ...BALL, label });
      await call("POST", `/contacts/${id}/path`, { path: PATH, steps: "last" });
      location.hash = `#/contacts/${id}`;
    } catch (error) {
      fault.textContent = reason(error);
      open.disabled = false;
    }
  });
  return el(
    "section",
    { class: "card welcome" },
    el("h2", {}, "No contact yet"),
    el(
      "p",
      {},
      "A ball is pressed on a plane and moved sideways: its middle sticks, a ring at its edge slips, and what it " +
        "does next depends on all that it has done before.",
    ),
    found,
    fault,
    el("div", { class: "row" }, open, el("a", { class: "button", href: "#/new" }, "Make another contact")),
    el("p", { class: "note" }, "stickslip demo has a contact of each kind. ", el("a", { href: "#/help" }, "Help")),
  );
}
