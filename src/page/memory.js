// Which turning points a contact remembers. At constant load the rule is Madelung's: what comes back to a turning point
// forgets it, and the one before.

/** The states of `history` at which the remembered turns are, oldest first; nothing where the load has changed. `slip` is the
 *  displacement at which a virgin contact slips as a whole. */
export function remembered(first, history, slip) {
  const states = [first, ...history].map(({ state }) => state);
  if (first.sequence > 0 || states.some((state) => state.indentation !== first.state.indentation)) return [];
  const turns = [];
  let way = 0;
  for (const [index, state] of states.entries()) {
    const before = states[index - 1];
    const step = before ? Math.sign(state.displacement - before.displacement) : 0;
    if (step === 0) continue;
    if (way !== 0 && step !== way) turns.push(before);
    way = step;
    while (turns.length && passed(turns, state.displacement, way, slip)) turns.splice(-2);
  }
  return turns;
}

/** Whether the way from the last turn has come to where it is forgotten. */
function passed(turns, displacement, way, slip) {
  const last = turns.at(-1).displacement;
  const before = turns.at(-2)?.displacement;
  // The first turn is met by its mirror image, or by gross slip on the other side.
  const goal = before ?? last + 2 * way * Math.min(Math.abs(last), slip);
  return way * (displacement - goal) >= -1e-9 * slip;
}
