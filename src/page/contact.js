// One contact: what it does, what it remembers, and what moves it.
import { call, follow, pages } from "./api.js";
import { copying } from "./code.js";
import { knob } from "./controls.js";
import { el, latest, notice, settled } from "./dom.js";
import { listed } from "./form.js";
import { plots } from "./plots.js";
import { curved, cuts, straight } from "./replay.js";
import { guide } from "./run.js";
import { story } from "./story.js";
import { studies } from "./study.js";

const KEPT = 1000;
const FIELDS = "points=300&residual=true&fields=pressure,shear,slip,displacement";
const LIVE = { live: "live", waiting: "connecting again …", deleted: "deleted", expired: "expired", refused: "not allowed" };

/** Shows a contact in `main`, until `signal`. */
export async function contact(main, id, signal) {
  const [session, definition] = await Promise.all([call("GET", `/contacts/${id}`), call("GET", `/contacts/${id}/definition`)]);
  const begin = Math.max(0, session.sequence - KEPT);
  const history = await pages(`/contacts/${id}/history`, KEPT, begin || undefined);
  const { contact: figures } = session;
  const virgin = { displacement: 0, force: 0, indentation: figures.indentation, normal_force: figures.normal_force, contact_radius: figures.contact_radius, stick_radius: figures.contact_radius, regime: "stick", dissipated_energy: 0, elastic_energy: 0, memory_depth: 0 };
  // What is known of it. A long past begins in the middle, and its way is drawn straight.
  const about = {
    id, definition, figures, history, signal, friction: definition.friction, state: history.at(-1)?.state ?? session.state,
    first: begin ? history.shift() : { sequence: 0, state: virgin }, whole: begin === 0, stress: null, path: [],
  };
  const ratio = about.friction * figures.e_star / figures.g_star;
  about.slip = (state) => ratio * Math.max(0, state.indentation);
  about.reach = (state) => 1.5 * (Math.max(about.slip(state), figures.gross_slip_displacement) || 1e-7);
  about.move = latest((body) => call("POST", `/contacts/${id}/move`, body, signal));

  const view = layout(about, session);
  // However many moves come, there is one drawing a frame.
  let frame = null;
  const redraw = () => {
    frame ??= requestAnimationFrame(() => {
      frame = null;
      view.plots.draw(about);
      view.show(about.state);
    });
  };
  const look = latest(async () => {
    const stress = await call("GET", `/contacts/${id}/stress?${FIELDS}`, undefined, signal);
    about.stress = stress;
    redraw();
  });
  const bend = latest(async () => {
    const past = [...history];
    const counts = cuts(about.first, past, span(about));
    if (!about.whole || counts.every((count) => count === 1)) return;
    const path = await curved(definition, about.first, past, counts, signal);
    // What has come meanwhile goes on from there.
    about.path = [...path, ...straight(about.first, history.slice(past.length)).slice(1)];
    redraw();
  });
  const excuse = (error) => { if (!signal.aborted) notice(error.message, true); };
  const later = settled(() => bend().catch(excuse), 120);
  about.path = straight(about.first, history);
  redraw();
  look().catch(excuse);
  bend().catch(excuse);

  const take = (event) => {
    if (event.sequence <= (history.at(-1)?.sequence ?? about.first.sequence)) return;
    about.state = event.state;
    history.push({ sequence: event.sequence, move: event.move ?? {}, state: event.state, at: event.at });
    about.path.push([event.state.displacement, event.state.force, event.sequence]);
    if (history.length > 2 * KEPT) {
      about.first = history[history.length - KEPT - 1];
      history.splice(0, history.length - KEPT);
      about.whole = false;
      about.path = straight(about.first, history);
    }
    redraw();
    look().catch(excuse);
    later();
  };
  follow(id, history.at(-1)?.sequence ?? about.first.sequence, take, view.report, signal);
  main.replaceChildren(view.element);
  view.plots.all.forEach((plot) => plot.redraw());
}

/** The size of what the loop shows. */
function span({ first, history, figures }) {
  const states = [first, ...history].map(({ state }) => state);
  const most = (name) => states.reduce((most, state) => Math.max(most, Math.abs(state[name])), 0);
  return { displacement: most("displacement") || figures.gross_slip_displacement || 1, force: most("force") || figures.gross_slip_force || 1 };
}

function layout(about, session) {
  const { id, figures } = about;
  const drawn = plots();
  const live = el("span", { class: "badge", role: "status" }, "connecting …");
  const told = el("div", { class: "story", "aria-live": "polite" });
  const knobs = [
    knob({ name: "displacement", label: "Displacement U", unit: "m", value: (state) => state.displacement, limits: (state) => { const reach = Math.max(about.reach(state), Math.abs(state.displacement)); return [-reach, reach]; }, send: (displacement) => about.move({ displacement }) }),
    knob({ name: "force", label: "Tangential force F", unit: "N", value: (state) => state.force, limits: (state) => { const limit = 0.999 * about.friction * state.normal_force || 1; return [-limit, limit]; }, send: (force) => about.move({ force }) }),
    knob({ name: "load", label: "Normal load F_N", unit: "N", value: (state) => state.normal_force, limits: (state) => [0, Math.max(2 * figures.normal_force, state.normal_force) || 10], send: (normal_force) => about.move({ normal_force }) }),
  ];
  const jump = (text, displacement) => el("button", { type: "button", onclick: () => about.move({ displacement: displacement() }).catch((error) => notice(error.message, true)) }, text);
  const remove = async () => {
    if (!confirm("Delete this contact and its past?")) return;
    try {
      await call("DELETE", `/contacts/${id}`);
      location.hash = "#/";
    } catch (error) { notice(error.message, true); }
  };
  const fork = async () => {
    try {
      location.hash = `#/contacts/${(await call("POST", `/contacts/${id}/fork`, {})).id}`;
    } catch (error) { notice(error.message, true); }
  };
  const calls = () => {
    const last = about.history.at(-1)?.move;
    return [{ method: "GET", path: `/contacts/${id}` }, { method: "GET", path: `/contacts/${id}/stress?${FIELDS}` }, { method: "GET", path: `/contacts/${id}/history?limit=1000` },
      ...(last ? [{ method: "POST", path: `/contacts/${id}/move`, body: last }] : [])];
  };
  const side = el("aside", { class: "side" }, told,
    el("section", { class: "card hands", "aria-label": "Move it" }, el("h2", {}, "Move it"), ...knobs.map((one) => one.element),
      el("div", { class: "row" }, jump("← slip", () => -about.reach(about.state) / 1.5), jump("U = 0", () => 0), jump("slip →", () => about.reach(about.state) / 1.5))),
    el("details", { class: "card preload" }, el("summary", {}, "Figures at the preload"), el("dl", { class: "figures" }, listed(figures))));
  const element = el("div", { class: "contact" },
    el("div", { class: "head" }, el("h1", {}, session.label ?? "Unnamed contact"), live, el("span", { class: "faint" }, id), copying(calls),
      el("button", { type: "button", class: "quiet", onclick: fork }, "Fork"), el("button", { type: "button", class: "quiet danger", onclick: remove }, "Delete")),
    el("div", { class: "bench" }, side, el("div", { class: "plots" }, ...drawn.all.map((plot) => plot.element))),
    guide(about), studies(about));
  return {
    element, plots: drawn,
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
