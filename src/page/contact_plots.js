// The four linked plots of a contact.
import { nearestIndex } from "./axis.js";
import { Chart } from "./chart.js";
import { columnsOf } from "./chart_menu.js";
import { isLine, meanPressure, peaksOf, placesOf, zonesOf } from "./line_contact.js";
import { forceOverTime } from "./relaxation.js";
import { sideView } from "./side_view.js";
import { alongOf, isTwisted } from "./state_text.js";
import { topView } from "./top_view.js";
import { formatQuantity } from "./units.js";

const TURNS =
  "Rings on the curve mark the turning points that the contact remembers. A move beyond one closes its loop and " +
  "erases it.";

/** The plots, and a function that draws them from the model of a contact; `overlay` says what else the first two
 *  show. */
export function contactPlots({ hasStress, hasMemory, definition }) {
  const isAlongLine = isLine(definition);
  const loop = new Chart({
    name: "loop",
    title: "Hysteresis loop",
    mode: "nearest",
    x: { label: "Displacement U", unit: "m" },
    y: { label: "Force F", unit: "N" },
  });
  const stress = new Chart({
    name: "stress",
    title: "Stress under the contact",
    x: { label: isAlongLine ? "x, along the motion" : "Radius r", unit: "m" },
    y: { label: "Stress", unit: "Pa" },
    note: "Where τ touches its bound the surfaces slip; where they stick, the stress left by earlier moves stays.",
  });
  const view = isAlongLine ? sideView() : topView();
  const work = new Chart({
    name: "work",
    title: "Friction work and stored energy",
    x: { label: "Move" },
    y: { label: "Energy", unit: "J" },
    note:
      "Friction work only grows; stored energy is released on unloading. Both are shown at the ends of moves, " +
      "joined by straight lines.",
  });

  const time = forceOverTime();

  // What is drawn over the loop has no moves of this contact.
  loop.more = ([, , sequence], { name }) => [sequence === undefined ? name : sequence ? `move ${sequence}` : "start"];
  loop.onhover = (hit) => work.showCursor(hit && atMove(work, hit.datum[2]));
  work.onhover = (hit) => loop.showCursor(hit && atSequence(loop, hit.x));
  stress.onhover = (hit) => view.showCursor(hit && view.at(hit.x, hit.x, 0));
  view.onhover = (hit) => stress.showCursor(hit && atPlace(stress, hit.ring ?? hit.x));

  const draw = (model, overlay) => {
    const twists = isTwisted(model.state);
    [loop.x.label, loop.x.unit] = twists ? ["Angle of twist ω", "rad"] : ["Displacement U", "m"];
    [loop.y.label, loop.y.unit] = twists ? ["Torque M", "N·m"] : ["Force F", "N"];
    const data = loopData(model, overlay.loop());
    loop.draw(data);
    if (model.stress) {
      stress.draw(stressData(model, overlay.shear()));
      view.drawModel(model);
    }
    if (hasMemory) time.drawModel(model);
    work.draw(energyData(model, data.recent !== undefined));
  };
  const all = [loop, ...(hasStress ? [stress, view] : []), ...(hasMemory ? [time] : []), work];
  return { all, loop, stress, view, time, work, draw };
}

/** The points of a move in the plot of energies. */
function atMove(chart, sequence) {
  const found = chart
    .visible()
    .map(({ name, points }) => ({ name, dot: points.find((point) => point[0] === sequence) }))
    .filter(({ dot }) => dot);
  const lines = found.map(({ name, dot }) => `${name} ${formatQuantity(dot[1], "J")}`);
  return found.length
    ? { x: sequence, dots: found.map(({ dot }) => dot), lines: [`move ${sequence}`, ...lines] }
    : null;
}

function atSequence(chart, sequence) {
  const points = chart.visible()[0]?.points ?? [];
  const point = points.findLast(([, , own]) => own <= sequence);
  return point ? { x: point[0], y: point[1], dots: [point], lines: [] } : null;
}

function atPlace(chart, place) {
  const series = chart.visible().filter((one) => one.hover !== false);
  const nearest = (points) =>
    points[
      nearestIndex(
        points.map(([x]) => x),
        place,
      )
    ];
  return { x: place, dots: series.map(({ points }) => nearest(points)), lines: [] };
}

/** The newest moves, which the axes fit; and how many times wider all of them may be before the older ones are left
 *  outside. */
const [RECENT, MOST_WIDER] = [10, 5];
const OLDER = "Older moves lie far outside: “Show all”, or the key 0, shows them.";

/** The part of points `[x, y, sequence]` that the newest moves have, where all points would make it hardly visible. */
function recentPart(points, first, history) {
  if (history.length <= RECENT) return undefined;
  const from = history.at(-RECENT - 1)?.sequence ?? first.sequence;
  const part = points.filter(([, , sequence]) => sequence >= from);
  const wide = (some) => {
    const x = some.map((point) => point[0]);
    return x.reduce((most, one) => Math.max(most, one)) - x.reduce((least, one) => Math.min(least, one));
  };
  return part.length > 1 && wide(points) > MOST_WIDER * wide(part) ? part : undefined;
}

/** The states at which the turning points lie that a contact remembers, oldest first; none where the load has changed.
 *  A state says of how many pieces its slip history is: one after gross slip, two on first loading, and one more for
 *  each turning point. What a move erases are the newest of them. */
export function rememberedTurns(first, history) {
  const states = [first, ...history].map(({ state }) => state);
  if (first.sequence > 0 || states.some((state) => state.indentation !== first.state.indentation)) return [];
  // Bodies with memory have no turning points that a move erases.
  if (states.some((state) => isTwisted(state) || state.time !== undefined)) return [];
  const turns = [];
  let [direction, outer] = [0, 2];
  for (const [index, state] of states.entries()) {
    const before = states[index - 1] ?? state;
    const step = Math.sign(state.displacement - before.displacement);
    if (step === 0) continue;
    if (direction === -step) turns.push(before);
    direction = step;
    if (state.regime === "gross_slip") outer = 1;
    turns.length = Math.min(turns.length, Math.max(state.memory_depth - outer, 0));
  }
  return turns;
}

/** The loop: the whole path, the part since the last reversal, what was measured, and the present state. */
function loopData({ path, state, friction, first, history, slip, isComplete }, overlaid) {
  let turn = path.length - 1;
  const direction = (index) => Math.sign(path[index][0] - path[index - 1][0]);
  while (turn > 1 && (direction(turn) === 0 || direction(turn - 1) === 0 || direction(turn) === direction(turn - 1)))
    turn -= 1;
  const twists = isTwisted(state);
  const limit = twists ? 0 : friction * state.normal_force;
  const measured = history
    .filter(({ observation }) => observation && !twists)
    .map(({ sequence, state: s, observation }) => [s.displacement, observation.force, sequence]);
  const least = limit > 0 ? { x: [-slip(state), slip(state)], y: [-limit, limit] } : {};
  // What is far beyond slip has to be wide beside the least range, too.
  const reach = least.x ? [...least.x, ...least.x].map((x) => [x, 0, Infinity]) : [];
  const recent = recentPart([...path, ...reach], first, history);
  const turns = state.time === undefined && !twists ? [TURNS] : [];
  const notes = isComplete ? turns : ["Only the last moves of this long history are drawn."];
  return {
    recent,
    series: [
      { name: "whole path", kind: "past", points: path },
      { name: "since the last reversal", kind: "now", points: path.slice(Math.max(0, turn - 1)), hover: false },
      ...overlaid,
      ...(measured.length ? [{ name: "measured", kind: "measured", points: measured, dots: true, line: false }] : []),
    ],
    note: [...notes, ...(recent ? [OLDER] : [])].join(" "),
    least,
    levels:
      limit > 0
        ? [
            { y: limit, label: "+μ F_N: all slips" },
            { y: -limit, label: "−μ F_N" },
          ]
        : [],
    marks: [
      ...rememberedTurns(first, history).map(({ displacement: x, force: y }) => ({ x, y, class: "turn", size: 4.5 })),
      { x: alongOf(state)[0], y: alongOf(state)[1], class: state.regime },
    ],
    table: () => {
      const moves = history.map(({ sequence, state: s, observation }) => ({
        sequence,
        ...s,
        measured: observation?.force,
      }));
      return columnsOf(moves, {
        sequence: "sequence",
        displacement_m: "displacement",
        force_n: "force",
        ...(twists ? { twist_rad: "twist", torque_nm: "torque" } : {}),
        normal_force_n: "normal_force",
        indentation_m: "indentation",
        stick_radius_m: "stick_radius",
        contact_radius_m: "contact_radius",
        regime: "regime",
        friction_work_j: "dissipated_energy",
        elastic_energy_j: "elastic_energy",
        measured_force_n: "measured",
      });
    },
  };
}

/** Pressure, bound and shear stress over the radius or x; the peaks at their exact places. */
function stressData({ stress, state, friction, definition }, overlaid) {
  const { pressure, shear } = stress;
  const [places, isAlongLine] = [placesOf(stress), isLine(definition)];
  const a = state.contact_radius;
  const scale = (factor) => places.map((x, index) => [x, pressure[index] === null ? null : factor * pressure[index]]);
  const tau = [...places.map((x, index) => [x, shear[index]]), ...peaksOf(stress.residual, definition)];
  const mean = meanPressure(definition, state);
  const most = Math.min(4 * mean || 1, Math.max(...pressure.filter((value) => value !== null), 0) || 1);
  const reach = (a || 1) * 1.04;
  return {
    series: [
      { name: "shear stress τ", kind: "tau", points: tau.sort((one, two) => one[0] - two[0]) },
      { name: "bound ±μ p", kind: "bound", points: scale(friction) },
      { name: "bound ±μ p", kind: "bound", points: scale(-friction), hover: false, legend: false },
      { name: "pressure p", kind: "pressure", points: scale(1) },
      ...overlaid,
    ],
    bands: a > 0 ? zonesOf(state, isAlongLine).map((zone) => ({ ...zone, label: zone.kind })) : [],
    range: { x: [isAlongLine ? -reach : 0, reach] },
    // Infinite values at an edge would hide the rest.
    cap: 1.1 * most,
    table: () => ({
      [isAlongLine ? "x_m" : "radius_m"]: places,
      pressure_pa: pressure,
      shear_pa: shear,
      slip_m: stress.slip,
      displacement_m: stress.displacement,
    }),
  };
}

/** The energies; `isRecent` has the axes fit those of the newest moves. */
function energyData({ first, history, figures, hasMemory }, isRecent) {
  const all = [first, ...history];
  const points = (of, states = all) => states.map(({ sequence, state }) => [sequence, state[of] ?? 0]);
  const range = isRecent
    ? { recent: ["dissipated_energy", "elastic_energy"].flatMap((of) => points(of, all.slice(-RECENT - 1))) }
    : {
        least: {
          x: [first.sequence, first.sequence + 5],
          y: [0, (figures.gross_slip_force * figures.gross_slip_displacement) / 2],
        },
      };
  return {
    ...range,
    series: [
      { name: "friction work", kind: "work", points: points("dissipated_energy") },
      { name: "stored", kind: "stored", points: points("elastic_energy") },
      ...(hasMemory ? [{ name: "work of the bodies", kind: "bound", points: points("viscous_work") }] : []),
    ],
  };
}
