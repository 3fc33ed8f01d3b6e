// The elements of the view of a contact: its state in words, the controls that move it, and a tab for each question.
import { call } from "./api.js";
import { belowSurfaceCard } from "./below_surface.js";
import { saveRow } from "./chart_menu.js";
import { Chart } from "./chart.js";
import { contactPlots } from "./contact_plots.js";
import { contactTitle } from "./contact_title.js";
import { copyMenu } from "./copy_as_code.js";
import { crackCard } from "./crack_search.js";
import { figureList } from "./create_form.js";
import { cycleStudyCard } from "./cycle_study.js";
import { el, mapped, noticing } from "./dom.js";
import { fittedLoop } from "./loop_fit.js";
import { loopOverlay } from "./loop_overlay.js";
import { moveHands } from "./move_hands.js";
import { pathCard } from "./path_run.js";
import { protocolCard } from "./protocol_run.js";
import { protocolSearchCard } from "./protocol_search.js";
import { responseCard } from "./frequency_response.js";
import { stateText } from "./state_text.js";
import { steadyCard } from "./steady_cycle.js";
import { accuracyCard, mapCard, residualCard } from "./studies.js";
import { TABS, columns, tabBar } from "./tabs.js";
import { trustCard } from "./trust.js";
import { viewLink } from "./view_link.js";

/** The query for the stresses that are shown. */
export const FIELDS = "points=300&residual=true&fields=pressure,shear,slip,displacement";
const CONNECTION = {
  live: "live",
  waiting: "reconnecting …",
  left: "loading …",
  deleted: "deleted",
  expired: "expired",
  damaged: "damaged",
  failed: "not readable",
  refused: "not allowed",
};
/** The tabs that do not follow the present state, so that it does not stand beside them. */
const WITHOUT_STATE = ["loop", "accuracy"];

/** The elements for a contact, and functions that update them; `changed` asks for new plots. */
export function contactView(model, contact, changed) {
  const { id, figures } = model;
  const plots = contactPlots(model);
  const hands = moveHands(model);
  const trust = trustCard(model);
  const path = pathCard(model);
  const title = contactTitle(id, contact.label);
  const overlay = loopOverlay(model, plots.loop, changed);
  const live = el("span", { class: "badge", role: "status" }, "connecting …");
  const stateElement = el("div", { class: "state-text", "aria-live": "polite" });
  const preload = el(
    "details",
    { class: "card preload" },
    el("summary", {}, "Figures at the preload"),
    el("dl", { class: "figures" }, figureList(figures, model.definition)),
  );

  // The columns of cards of each tab; some have plots, requests, and a part that follows the state.
  const { loop, stress, view: contactFrom, time, work } = plots;
  const { hasMemory } = model;
  const fit = fittedLoop(model);
  const crack = model.hasStress && crackCard(model);
  /** @type {Record<string, any[][]>} */
  const lists = {
    live: model.hasStress
      ? [
          [loop, contactFrom],
          [stress, work, path],
        ]
      : [[loop, path], hasMemory ? [time, work] : [work]],
    // Bodies with memory have neither fits nor closed cycles.
    loop: !hasMemory && [[fit.form], [fit.results]],
    crack: crack && [[crack.form], [crack.results, belowSurfaceCard(model)]],
    damping: !hasMemory && [[steadyCard(model), cycleStudyCard(model), mapCard(model)], [responseCard(model)]],
    residual: model.hasStress && [
      [protocolCard(model), ...(model.hasBulk ? [] : [protocolSearchCard(model)])],
      model.hasBulk ? [] : [residualCard(model)],
    ],
    // The solvers that are compared are of round contacts of elastic bodies.
    accuracy: model.isLine || hasMemory ? [[trust]] : [[trust], [accuracyCard(model)]],
  };
  const offered = Object.fromEntries(Object.entries(lists).filter(([, list]) => list));
  const views = mapped(offered, (list, tab) => ({
    parts: list.flat().filter((card) => card.show),
    firsts: list.flat().flatMap((card) => card.first ?? []),
    plots: list.flat().flatMap((card) => (card instanceof Chart ? card : (card.charts ?? []))),
    calls: () => (tab === "live" ? stateCalls(model) : list.flat().flatMap((card) => card.calls?.() ?? [])),
  }));
  const panels = mapped(offered, (list, tab) => {
    const cards = columns(...list.map((column) => column.map((one) => one.element)));
    return el("section", { class: "panel", id: `tab-${tab}`, "aria-label": TABS[tab], hidden: true }, cards);
  });
  const all = Object.values(views).flatMap((view) => view.plots);
  const link = viewLink({ plots: all, units: hands.units, overlay });
  const tabs = tabBar(id, panels);
  const menu = el("div", {});
  let view = views.live;
  let state = model.state;

  const side = el("aside", { class: "side" }, stateElement, trust.line, hands.element, preload);
  const element = el(
    "div",
    { class: "contact" },
    el("div", { class: "head" }, title.heading, title.form, live, el("span", { class: "faint" }, id), title.button),
    el("div", { class: "tab-row" }, tabs.element, menu),
    el("div", { class: "contact-view" }, side, el("div", { class: "panels" }, ...Object.values(panels))),
    el("p", { class: "row last" }, forkButton(model), removeButton(model)),
  );
  /** Opens a tab, and brings it up to date. */
  const open = (wanted) => {
    const tab = tabs.open(wanted);
    view = views[tab];
    side.classList.toggle("aside", WITHOUT_STATE.includes(tab));
    side.classList.toggle("beside", tab !== "live");
    menu.replaceChildren(copyMenu(view.calls, [link.entry, ...view.plots.map(saveRow)]));
    document.title = `${TABS[tab]} · ${title.heading.textContent} – stickslip`;
    link.write();
    show(state);
    for (const first of view.firsts.splice(0)) first();
    // The lines of a plot that was hidden have the width of nothing.
    for (const plot of view.plots) plot.redraw();
  };
  const show = (now) => {
    state = now;
    stateElement.replaceChildren(...stateText(state, model));
    for (const one of [hands, trust, ...view.parts]) one.show(state);
  };
  return {
    element,
    open,
    query: link.query,
    plots: plots.all,
    draw: () => plots.draw(model, overlay),
    show,
    report: (what) => {
      live.textContent = CONNECTION[what] ?? what;
      // Nothing more is asked of a contact that is no longer there.
      model.isGone ||= what === "deleted" || what === "expired" || what === "damaged";
      live.classList.toggle("on", what === "live");
    },
  };
}

/** The requests behind the state of a contact. */
function stateCalls({ id, history, hasStress }) {
  const last = history.at(-1)?.move;
  return [
    { method: "GET", path: `/contacts/${id}` },
    ...(hasStress ? [{ method: "GET", path: `/contacts/${id}/stress?${FIELDS}` }] : []),
    { method: "GET", path: `/contacts/${id}/history?limit=1000` },
    ...(last ? [{ method: "POST", path: `/contacts/${id}/move`, body: last }] : []),
  ];
}

function forkButton({ id }) {
  const fork = noticing(async () => {
    location.hash = `#/contacts/${(await call("POST", `/contacts/${id}/fork`, {})).id}`;
  });
  return el("button", { type: "button", class: "quiet", onclick: fork }, "Fork: a copy to continue with");
}

function removeButton({ id }) {
  const remove = noticing(async () => {
    if (!confirm("Delete this contact and its history?")) return;
    await call("DELETE", `/contacts/${id}`);
    location.hash = "#/";
  });
  return el("button", { type: "button", class: "quiet danger", id: "delete", onclick: remove }, "Delete this contact");
}
