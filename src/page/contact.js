// The view of one contact: loads it, follows its events, and redraws.
import { call, follow, pages } from "./api.js";
import { FIELDS, contactView } from "./contact_view.js";
import { latestOnly, notice, debounce } from "./dom.js";
import { WITHOUT_STRESS } from "./form_options.js";
import { isLine } from "./line_contact.js";
import { hasMemory } from "./relaxation.js";
import { alongOf, isTwisted } from "./state_text.js";

/** Moves that are drawn of a long history, and moves and points of the loop that the service draws between their
 *  states. */
const [MAX_HISTORY, MAX_LOOP, MAX_POINTS] = [1000, 1000, 8000];
const [MIN_POINTS_OF_A_MOVE, MAX_POINTS_OF_A_MOVE] = [16, 32];

/** Shows a tab of a contact in `main`, until `signal`; `ready` is called when there is something to show. What it
 *  returns opens another tab, and says which query the address of the view has. */
export async function showContact(main, { id, tab }, signal, ready) {
  const [contact, definition] = await Promise.all([
    call("GET", `/contacts/${id}`),
    call("GET", `/contacts/${id}/definition`),
  ]);
  const begin = Math.max(0, contact.sequence - MAX_HISTORY);
  const history = await pages(`/contacts/${id}/history?cycles=false`, MAX_HISTORY, begin || undefined);
  const { contact: figures } = contact;
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
  // A long history is cut at its beginning.
  const model = {
    id,
    definition,
    figures,
    history,
    signal,
    friction: definition.friction,
    // A contact that is known by its load curve alone has no stress, and that of bodies with memory is not computed.
    hasStress: !WITHOUT_STRESS.includes(definition.profile.type) && !hasMemory(definition),
    hasMemory: hasMemory(definition),
    isLine: isLine(definition),
    // A stick zone that a bulk stress moves is known at a constant load.
    hasBulk: definition.bulk !== undefined,
    state: history.at(-1)?.state ?? contact.state,
    first: begin ? history.shift() : { sequence: 0, state: virgin },
    isComplete: begin === 0,
    stress: null,
    measured: null,
    path: [],
  };
  const ratio = (model.friction * figures.e_star) / figures.g_star;
  model.slip = (state) => ratio * Math.max(0, state.indentation);
  model.reach = (state) => 1.5 * (Math.max(model.slip(state), figures.gross_slip_displacement) || 1e-7);
  model.move = latestOnly((body) => call("POST", `/contacts/${id}/move`, body, signal));

  if (signal.aborted) return;
  const view = contactView(model, contact, () => redraw());
  // At most one redraw a frame, however many moves arrive.
  let frame = null;
  const redraw = () => {
    frame ??= requestAnimationFrame(() => {
      frame = null;
      view.draw();
      view.show(model.state);
    });
  };
  const loadStress = latestOnly(async () => {
    if (!model.hasStress) return;
    model.stress = await stressOf(model);
    redraw();
  });
  const loadFriction = latestOnly(async () => {
    model.measured = (await call("GET", `/contacts/${id}/friction`, undefined, signal)).friction ?? null;
    redraw();
  });
  // The force is curved during a move. What takes the service too long stays straight.
  const refinePath = latestOnly(async () => {
    if (!history.length) return;
    const fitting = Math.floor(MAX_POINTS / history.length);
    const points = Math.max(MIN_POINTS_OF_A_MOVE, Math.min(MAX_POINTS_OF_A_MOVE, fitting));
    const query = `last=${MAX_LOOP}&points_per_move=${points}`;
    const page = await call("GET", `/contacts/${id}/loop?${query}`, undefined, signal);
    const [x, y] = isTwisted(model.state) ? [page.twist, page.torque] : [page.displacement, page.force];
    const curved = page.sequence
      .map((sequence, index) => [x?.[index] ?? null, y?.[index] ?? null, sequence, page.part[index]])
      .filter(([place]) => place !== null);
    const isDrawn = (sequence) => sequence >= page.sequence[0] && sequence <= page.sequence.at(-1);
    const straight = straightPath(model).filter(([, , sequence]) => !isDrawn(sequence));
    model.path = [...straight, ...curved].sort((one, two) => one[2] - two[2]);
    redraw();
  });
  const showError = (error) => {
    if (!signal.aborted) notice(error.message, true);
  };
  const refine = () => refinePath().catch((error) => error.status === 422 || showError(error));
  const refineLater = debounce(refine, 120);
  model.path = straightPath(model);
  redraw();
  loadStress().catch(showError);
  if (history.some(({ observation }) => observation)) loadFriction().catch(showError);
  refine();

  const addMove = (event) => {
    if (event.sequence <= (history.at(-1)?.sequence ?? model.first.sequence)) return;
    // What a twist and a shift have led through has no axis in common.
    const isOther = isTwisted(event.state) !== isTwisted(model.state);
    model.state = event.state;
    const { sequence, move, state, observation, at } = event;
    history.push({ sequence, move: move ?? {}, state, observation, at });
    if (isOther) model.path = straightPath(model);
    else model.path.push([...alongOf(event.state), event.sequence]);
    if (history.length > 2 * MAX_HISTORY) {
      model.first = history[history.length - MAX_HISTORY - 1];
      history.splice(0, history.length - MAX_HISTORY);
      model.isComplete = false;
      model.path = straightPath(model);
    }
    redraw();
    loadStress().catch(showError);
    if (observation && event.cycle) loadFriction().catch(showError);
    refineLater();
  };
  follow(id, history.at(-1)?.sequence ?? model.first.sequence, addMove, view.report, signal);
  signal.addEventListener("abort", () => view.report("left"));
  main.replaceChildren(view.element);
  ready?.();
  view.open(tab);
  view.plots.forEach((plot) => plot.redraw());
  return view;
}

/** The path of a contact from state to state, of the states that are twisted as the present one is or is not: what
 *  `alongOf` has, and the sequence. */
const straightPath = ({ first, history, state: now }) =>
  [first, ...history]
    .filter(({ state }) => isTwisted(state) === isTwisted(now))
    .map(({ state, sequence }) => [...alongOf(state), sequence]);

/** The stresses of a contact; of one that is twisted its hoop stress stands for the shear stress. */
async function stressOf({ id, signal, state }) {
  const ask = (fields) => call("GET", `/contacts/${id}/stress?${fields}`, undefined, signal);
  if (!isTwisted(state)) return ask(FIELDS);
  const found = await ask("points=300&fields=pressure,hoop");
  const max = found.hoop.reduce((most, value) => Math.max(most, Math.abs(value ?? 0)), 0);
  const none = found.hoop.map(() => null);
  return { ...found, shear: found.hoop, slip: none, residual: { peaks: [], max, relative: null } };
}
