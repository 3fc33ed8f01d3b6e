// One contact: what it does, what it remembers, and what moves it.
import { call, follow, pages } from "./api.js";
import { FIELDS, layout } from "./bench.js";
import { latest, notice, settled } from "./dom.js";
import { curved, cuts, straight } from "./replay.js";

const KEPT = 1000;

/** Shows a contact in `main`, until `signal`. */
export async function contact(main, id, signal) {
  const [session, definition] = await Promise.all([
    call("GET", `/contacts/${id}`),
    call("GET", `/contacts/${id}/definition`),
  ]);
  const begin = Math.max(0, session.sequence - KEPT);
  const history = await pages(`/contacts/${id}/history`, KEPT, begin || undefined);
  const { contact: figures } = session;
  const virgin = {
    displacement: 0,
    force: 0,
    indentation: figures.indentation,
    normal_force: figures.normal_force,
    contact_radius: figures.contact_radius,
    stick_radius: figures.contact_radius,
    regime: "stick",
    dissipated_energy: 0,
    elastic_energy: 0,
    memory_depth: 0,
  };
  // What is known of it. A long past begins in the middle, and its way is drawn straight.
  const about = {
    id,
    definition,
    figures,
    history,
    signal,
    friction: definition.friction,
    state: history.at(-1)?.state ?? session.state,
    first: begin ? history.shift() : { sequence: 0, state: virgin },
    whole: begin === 0,
    stress: null,
    path: [],
  };
  const ratio = (about.friction * figures.e_star) / figures.g_star;
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
  const excuse = (error) => {
    if (!signal.aborted) notice(error.message, true);
  };
  // A way that the service cannot compute in small steps stays straight.
  const bent = () => bend().catch((error) => error.status === 422 || excuse(error));
  const later = settled(bent, 120);
  about.path = straight(about.first, history);
  redraw();
  look().catch(excuse);
  bent();

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
  return {
    displacement: most("displacement") || figures.gross_slip_displacement || 1,
    force: most("force") || figures.gross_slip_force || 1,
  };
}
