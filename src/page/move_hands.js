// The card that moves a contact: by displacement, force or load, to places of note, and back. On a phone it stays in
// reach.
import { call } from "./api.js";
import { answerOf, el, noticing } from "./dom.js";
import { goBack } from "./go_back.js";
import { moveControl } from "./move_controls.js";
import { virginContact } from "./protocol_run.js";
import { paceOfMoves } from "./relaxation.js";

/** As the style sheet has it: windows in which the card stands at the lower edge, folded but for the displacement. */
const NARROW = matchMedia("(max-width: 62rem)");

/** Asks whether a displacement is meant that the service calls far beyond slip. */
async function isMeant(model, displacement) {
  const contact = model.state.normal_force > 0 ? virginContact(model) : model.definition;
  const body = { contact, path: { displacement: [displacement] }, steps: "last" };
  const { warnings } = await call("POST", "/simulate", body, model.signal);
  const far = warnings.find(({ code }) => code === "far_beyond_slip");
  if (!far) return true;
  const message = far.message[0].toUpperCase() + far.message.slice(1);
  document.getElementById("far-text").textContent = `${message} All other moves would be too small to be seen.`;
  return (await answerOf("far")) === "send";
}

/** The card, the choices of units, and a function that shows a state. */
export function moveHands(model) {
  const { figures } = model;
  const pace = model.hasMemory ? paceOfMoves(model) : null;
  const move = (target) => model.move(pace ? pace.timed(target) : target);
  const reach = (state) => Math.max(model.reach(state), Math.abs(state.displacement ?? 0));
  const displacement = moveControl({
    name: "displacement",
    label: "Displacement U",
    unit: "m",
    value: (state) => state.displacement ?? 0,
    limits: (state) => [-reach(state), reach(state)],
    send: async (wanted) => {
      if (Math.abs(wanted) > reach(model.state) && !(await isMeant(model, wanted))) throw new Error("Not sent.");
      await move({ displacement: wanted });
    },
  });
  const force = moveControl({
    name: "force",
    label: "Tangential force F",
    unit: "N",
    value: (state) => state.force ?? 0,
    limits: (state) => {
      const limit = 0.999 * model.friction * state.normal_force || 1;
      return [-limit, limit];
    },
    send: async (wanted) => move({ force: wanted }),
  });
  const load = moveControl({
    name: "load",
    label: "Normal load F_N",
    unit: "N",
    value: (state) => state.normal_force,
    limits: (state) => [0, Math.max(2 * figures.normal_force, state.normal_force) || 10],
    send: async (wanted) => move({ normal_force: wanted }),
  });
  if (model.hasBulk) load.element.hidden = true;
  const back = goBack(model);
  const jump = (text, to) =>
    el(
      "button",
      {
        type: "button",
        onclick: noticing(async () => move({ displacement: to() })),
      },
      text,
    );
  const more = el(
    "details",
    { class: "more-moves", id: "more-moves", open: !NARROW.matches },
    el("summary", {}, model.hasBulk ? "Force, undo" : "Force, load, undo"),
    force.element,
    load.element,
    el(
      "div",
      { class: "row" },
      jump("← slip", () => -model.reach(model.state) / 1.5),
      jump("U = 0", () => 0),
      jump("slip →", () => model.reach(model.state) / 1.5),
    ),
    back.element,
  );
  const refold = () => (more.open = !NARROW.matches);
  NARROW.addEventListener("change", refold, { signal: model.signal });
  const element = el(
    "section",
    { class: "card hands", "aria-label": "Move it" },
    el("h2", {}, "Move it"),
    displacement.element,
    pace?.element,
    more,
  );
  const controls = [displacement, force, load];
  const show = (state) => {
    for (const one of [...controls, back]) one.show(state);
  };
  return { element, show, units: controls.map((one) => one.unit) };
}
