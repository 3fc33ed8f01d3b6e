// The path between recorded states. The force is curved during a move, so the service computes the history again in small
// steps.
import { call } from "./api.js";

const MAX_STEPS = 4000;
const MAX_STEPS_OF_A_MOVE = 32;

/** The path of a contact from `first` over the states of `history`: `[displacement, force, sequence]`. */
export function straightPath(first, history) {
  return [first, ...history].map(({ state, sequence }) => [state.displacement, state.force, sequence]);
}

/** Into how many steps to split the move from one state to another. */
function stepCount(from, to, span) {
  const wide = Math.abs(to.displacement - from.displacement) / span.displacement;
  const high = Math.abs(to.force - from.force) / span.force;
  return Math.max(1, Math.min(MAX_STEPS_OF_A_MOVE, Math.ceil(MAX_STEPS_OF_A_MOVE * Math.max(wide || 0, high || 0))));
}

/** Into how many steps to split each move, for a loop of the width and height of `span`. */
export function stepCounts(first, history, span) {
  const counts = history.map(({ state }, index) => stepCount((history[index - 1] ?? first).state, state, span));
  const sum = counts.reduce((sum, count) => sum + count, 0);
  const coarser = Math.max(1, sum / MAX_STEPS);
  return counts.map((count) => Math.max(1, Math.floor(count / coarser)));
}

/** The same path with its curves, as the service computes it. */
export async function curvedPath(definition, first, history, counts, signal) {
  const moves = [];
  const owners = [];
  for (const [index, item] of history.entries()) {
    const from = (history[index - 1] ?? first).state;
    const { state, move, sequence } = item;
    const tangential = move.force !== undefined ? "force" : "displacement";
    const normal = move.normal_force !== undefined ? "normal_force" : "indentation";
    // At constant indentation a move by force goes through the same states as one by displacement.
    const named =
      tangential === "force" && normal === "indentation" && from.indentation === state.indentation
        ? "displacement"
        : tangential;
    for (let piece = 1; piece <= counts[index]; piece += 1) {
      const part = piece / counts[index];
      const between = (name) => (piece === counts[index] ? state[name] : from[name] + part * (state[name] - from[name]));
      moves.push({ [named]: between(named), [normal]: between(normal) });
      owners.push(sequence);
    }
  }
  const { steps } = await call("POST", "/simulate", { contact: definition, path: { moves } }, signal);
  return [
    [first.state.displacement, first.state.force, first.sequence],
    ...steps.map((step, index) => [step.displacement, step.force, owners[index]]),
  ];
}
