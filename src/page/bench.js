// What one contact looks like on the page: its plots, its words, and what moves it.
import { call } from "./api.js";
import { copying } from "./code.js";
import { knob } from "./controls.js";
import { el, notice } from "./dom.js";
import { listed } from "./form.js";
import { plots } from "./plots.js";
import { guide } from "./run.js";
import { story } from "./story.js";
import { studies } from "./study.js";

/** The stresses that are shown. */
export const FIELDS = "points=300&residual=true&fields=pressure,shear,slip,displacement";
const LIVE = { live: "live", waiting: "connecting again …", deleted: "deleted", expired: "expired", refused: "not allowed" };

/** The elements for a contact, and what tells them of changes. */
export function layout(about, session) {
  const { id, figures } = about;
  const drawn = plots();
  const live = el("span", { class: "badge", role: "status" }, "connecting …");
  const told = el("div", { class: "story", "aria-live": "polite" });
  const knobs = [
    knob({
      name: "displacement",
      label: "Displacement U",
      unit: "m",
      value: (state) => state.displacement,
      limits: (state) => {
        const reach = Math.max(about.reach(state), Math.abs(state.displacement));
        return [-reach, reach];
      },
      send: (displacement) => about.move({ displacement }),
    }),
    knob({
      name: "force",
      label: "Tangential force F",
      unit: "N",
      value: (state) => state.force,
      limits: (state) => {
        const limit = 0.999 * about.friction * state.normal_force || 1;
        return [-limit, limit];
      },
      send: (force) => about.move({ force }),
    }),
    knob({
      name: "load",
      label: "Normal load F_N",
      unit: "N",
      value: (state) => state.normal_force,
      limits: (state) => [0, Math.max(2 * figures.normal_force, state.normal_force) || 10],
      send: (normal_force) => about.move({ normal_force }),
    }),
  ];
  const jump = (text, displacement) =>
    el(
      "button",
      {
        type: "button",
        onclick: () => about.move({ displacement: displacement() }).catch((error) => notice(error.message, true)),
      },
      text,
    );
  const remove = async () => {
    if (!confirm("Delete this contact and its past?")) return;
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
    const last = about.history.at(-1)?.move;
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
    told,
    el(
      "section",
      { class: "card hands", "aria-label": "Move it" },
      el("h2", {}, "Move it"),
      ...knobs.map((one) => one.element),
      el(
        "div",
        { class: "row" },
        jump("← slip", () => -about.reach(about.state) / 1.5),
        jump("U = 0", () => 0),
        jump("slip →", () => about.reach(about.state) / 1.5),
      ),
    ),
    el(
      "details",
      { class: "card preload" },
      el("summary", {}, "Figures at the preload"),
      el("dl", { class: "figures" }, listed(figures)),
    ),
  );
  const element = el(
    "div",
    { class: "contact" },
    el(
      "div",
      { class: "head" },
      el("h1", {}, session.label ?? "Unnamed contact"),
      live,
      el("span", { class: "faint" }, id),
      copying(calls),
      el("button", { type: "button", class: "quiet", onclick: fork }, "Fork"),
      el("button", { type: "button", class: "quiet danger", onclick: remove }, "Delete"),
    ),
    el("div", { class: "bench" }, side, el("div", { class: "plots" }, ...drawn.all.map((plot) => plot.element))),
    guide(about),
    studies(about),
  );
  return {
    element,
    plots: drawn,
    show: (state) => {
      told.replaceChildren(...story(state, about));
      for (const one of knobs) one.show(state);
    },
    report: (what) => {
      live.textContent = LIVE[what] ?? what;
      live.classList.toggle("on", what === "live");
    },
  };
}
