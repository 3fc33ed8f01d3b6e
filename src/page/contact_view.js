// The elements of the view of a contact: its plots, its state in words, and the controls that move it.
import { call } from "./api.js";
import { belowSurfaceCard } from "./below_surface.js";
import { contactPlots } from "./contact_plots.js";
import { copyButtons } from "./copy_as_code.js";
import { contactTitle } from "./contact_title.js";
import { figureList } from "./create_form.js";
import { el, notice } from "./dom.js";
import { goBack } from "./go_back.js";
import { loopOverlay } from "./loop_overlay.js";
import { moveControl } from "./move_controls.js";
import { pathCard } from "./path_run.js";
import { protocolCard } from "./protocol_run.js";
import { stateText } from "./state_text.js";
import { steadyCard } from "./steady_cycle.js";
import { studyCards } from "./studies.js";
import { trustCard } from "./trust.js";
import { viewLink } from "./view_link.js";

/** The query for the stresses that are shown. */
export const FIELDS = "points=300&residual=true&fields=pressure,shear,slip,displacement";
const CONNECTION = { live: "live", waiting: "reconnecting …", deleted: "deleted", expired: "expired", damaged: "damaged", refused: "not allowed" };

/** The elements for a contact, and functions that update them; `changed` asks for new plots. */
export function contactView(model, contact, changed) {
  const { id, figures } = model;
  const plots = contactPlots();
  const steady = steadyCard(model);
  const below = belowSurfaceCard(model);
  const studies = studyCards(model);
  const trust = trustCard(model);
  const back = goBack(model);
  const title = contactTitle(id, contact.label);
  const overlay = loopOverlay(model, plots.loop, changed);
  const live = el("span", { class: "badge", role: "status" }, "connecting …");
  const stateElement = el("div", { class: "state-text", "aria-live": "polite" });
  const controls = [
    moveControl({
      name: "displacement",
      label: "Displacement U",
      unit: "m",
      value: (state) => state.displacement,
      limits: (state) => {
        const reach = Math.max(model.reach(state), Math.abs(state.displacement));
        return [-reach, reach];
      },
      send: (displacement) => model.move({ displacement }),
    }),
    moveControl({
      name: "force",
      label: "Tangential force F",
      unit: "N",
      value: (state) => state.force,
      limits: (state) => {
        const limit = 0.999 * model.friction * state.normal_force || 1;
        return [-limit, limit];
      },
      send: (force) => model.move({ force }),
    }),
    moveControl({
      name: "load",
      label: "Normal load F_N",
      unit: "N",
      value: (state) => state.normal_force,
      limits: (state) => [0, Math.max(2 * figures.normal_force, state.normal_force) || 10],
      send: (normal_force) => model.move({ normal_force }),
    }),
  ];
  const jump = (text, displacement) =>
    el(
      "button",
      {
        type: "button",
        onclick: () => model.move({ displacement: displacement() }).catch((error) => notice(error.message, true)),
      },
      text,
    );
  const remove = async () => {
    if (!confirm("Delete this contact and its history?")) return;
    try {
      await call("DELETE", `/contacts/${id}`);
      location.hash = "#/";
    } catch (error) {
      notice(error.message, true);
    }
  };
  const fork = async () => {
    try {
      location.hash = `#/contacts/${(await call("POST", `/contacts/${id}/fork`, {})).id}`;
    } catch (error) {
      notice(error.message, true);
    }
  };
  const calls = () => {
    const last = model.history.at(-1)?.move;
    return [
      { method: "GET", path: `/contacts/${id}` },
      { method: "GET", path: `/contacts/${id}/stress?${FIELDS}` },
      { method: "GET", path: `/contacts/${id}/history?limit=1000` },
      ...(last ? [{ method: "POST", path: `/contacts/${id}/move`, body: last }] : []),
    ];
  };
  const side = el(
    "aside",
    { class: "side" },
    stateElement,
    el(
      "section",
      { class: "card hands", "aria-label": "Move it" },
      el("h2", {}, "Move it"),
      ...controls.map((one) => one.element),
      el(
        "div",
        { class: "row" },
        jump("← slip", () => -model.reach(model.state) / 1.5),
        jump("U = 0", () => 0),
        jump("slip →", () => model.reach(model.state) / 1.5),
      ),
      back.element,
    ),
    trust.element,
    steady.element,
    el(
      "details",
      { class: "card preload" },
      el("summary", {}, "Figures at the preload"),
      el("dl", { class: "figures" }, figureList(figures)),
    ),
  );
  const element = el(
    "div",
    { class: "contact" },
    el(
      "div",
      { class: "head" },
      title.heading,
      title.form,
      live,
      el("span", { class: "faint" }, id),
      copyButtons(calls),
      viewLink({ plots: [...plots.all, below.chart], units: controls.map((one) => one.unit), overlay }),
      title.button,
      el("button", { type: "button", class: "quiet", onclick: fork }, "Fork"),
      el("button", { type: "button", class: "quiet danger", onclick: remove }, "Delete"),
    ),
    el("div", { class: "contact-view" }, side, el("div", { class: "plots" }, ...plots.all.map((plot) => plot.element), below.element)),
    protocolCard(model),
    pathCard(model),
    studies.element,
  );
  return {
    element,
    plots: plots.all,
    draw: () => plots.draw(model, overlay),
    show: (state) => {
      stateElement.replaceChildren(...stateText(state, model));
      for (const one of [...controls, back, trust, steady, below, studies]) one.show(state);
    },
    report: (what) => {
      live.textContent = CONNECTION[what] ?? what;
      // Nothing more is asked of a contact that is no longer there.
      model.isGone ||= what === "deleted" || what === "expired" || what === "damaged";
      live.classList.toggle("on", what === "live");
    },
  };
}
