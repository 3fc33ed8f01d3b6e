// Which turning points a contact remembers. At constant load Madelung's rule holds: a path that returns to a turning point
// erases it, and the one before.

/** The states of `history` at which the remembered turns are, oldest first; nothing where the load has changed. `slip` is the
 *  displacement at which a virgin contact slips as a whole. */
export function rememberedTurns(first, history, slip) {
  const states = [first, ...history].map(({ state }) => state);
  if (first.sequence > 0 || states.some((state) => state.indentation !== first.state.indentation)) return [];
  const turns = [];
  let direction = 0;
  for (const [index, state] of states.entries()) {
    const before = states[index - 1];
    const step = before ? Math.sign(state.displacement - before.displacement) : 0;
    if (step === 0) continue;
    if (direction !== 0 && step !== direction) turns.push(before);
    direction = step;
    while (turns.length && isErased(turns, state.displacement, direction, slip)) turns.splice(-2);
  }
  return turns;
}

/** Whether the path has returned so far that the last turn is erased. */
function isErased(turns, displacement, direction, slip) {
  const last = turns.at(-1).displacement;
  const before = turns.at(-2)?.displacement;
  // The first turn is met by its mirror image, or by gross slip on the other side.
  const end = before ?? last + 2 * direction * Math.min(Math.abs(last), slip);
  return direction * (displacement - end) >= -1e-9 * slip;
}
