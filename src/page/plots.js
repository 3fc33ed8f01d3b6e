// The four linked plots of a contact.
import { above } from "./above.js";
import { Chart } from "./chart.js";
import { remembered } from "./memory.js";
import { shown } from "./units.js";

const TURNS = "Rings mark the turning points that the contact remembers. Going past one wipes it out, and its loop closes.";

/** The plots, and a function that draws them from what is known of a contact. */
export function plots() {
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
    x: { label: "Radius r", unit: "m" },
    y: { label: "Stress", unit: "Pa" },
    note: "Where τ touches its bound the surfaces slip; where they stick, what earlier moves left stays frozen in.",
  });
  const seen = above();
  const work = new Chart({
    name: "work",
    title: "Friction work and stored energy",
    x: { label: "Move" },
    y: { label: "Energy", unit: "J" },
    note: "The work done against friction only grows; what is stored comes back when the contact is let go.",
  });

  loop.more = ([, , sequence]) => [sequence ? `move ${sequence}` : "start"];
  loop.onhover = (hit) => work.point(hit && beside(work, hit.datum[2]));
  work.onhover = (hit) => loop.point(hit && nearest(loop, hit.x));
  stress.onhover = (hit) => seen.point(hit && seen.at(hit.x, hit.x, 0));
  seen.onhover = (hit) => stress.point(hit && under(stress, hit.ring));

  const draw = (about) => {
    loop.draw(looped(about));
    if (about.stress) {
      stress.draw(stressed(about));
      seen.show(about);
    }
    work.draw(worked(about));
  };
  return { all: [loop, stress, seen, work], draw };
}

/** The place of a move in the plot of work. */
function beside(chart, sequence) {
  const dots = chart
    .visible()
    .map((series) => series.points.find((point) => point[0] === sequence))
    .filter(Boolean);
  return dots.length ? { x: sequence, dots, lines: [`move ${sequence}`, ...dots.map((dot) => shown(dot[1], "J"))] } : null;
}

function nearest(chart, sequence) {
  const points = chart.visible()[0]?.points ?? [];
  const point = points.findLast(([, , own]) => own <= sequence);
  return point ? { x: point[0], y: point[1], dots: [point], lines: [] } : null;
}

function under(chart, radius) {
  const dots = chart
    .visible()
    .filter((series) => series.hover !== false)
    .map(({ points }) =>
      points.reduce((best, point) => (Math.abs(point[0] - radius) < Math.abs(best[0] - radius) ? point : best)),
    );
  return { x: radius, dots, lines: [] };
}

/** The loop: all of it, what came since the last reversal, and where it is now. */
function looped({ path, state, friction, first, history, slip, whole }) {
  let turn = path.length - 1;
  const way = (index) => Math.sign(path[index][0] - path[index - 1][0]);
  while (turn > 1 && (way(turn) === 0 || way(turn - 1) === 0 || way(turn) === way(turn - 1))) turn -= 1;
  const limit = friction * state.normal_force;
  return {
    series: [
      { name: "the way so far", kind: "past", points: path },
      { name: "since the last turn", kind: "now", points: path.slice(Math.max(0, turn - 1)), hover: false },
    ],
    note: whole ? TURNS : "Of this long past the last moves are drawn, straight from state to state.",
    least: limit > 0 ? { x: [-slip(state), slip(state)], y: [-limit, limit] } : {},
    levels:
      limit > 0
        ? [
            { y: limit, label: "+μ F_N: all slips" },
            { y: -limit, label: "−μ F_N" },
          ]
        : [],
    marks: [
      ...remembered(first, history, slip(state)).map((turn) => ({
        x: turn.displacement,
        y: turn.force,
        class: "turn",
        size: 4.5,
      })),
      { x: state.displacement, y: state.force, class: state.regime },
    ],
    table: () => ({
      columns: [
        "sequence",
        "displacement_m",
        "force_n",
        "normal_force_n",
        "indentation_m",
        "stick_radius_m",
        "contact_radius_m",
        "regime",
        "friction_work_j",
        "elastic_energy_j",
      ],
      rows: history.map(({ sequence, state: s }) => [
        sequence,
        s.displacement,
        s.force,
        s.normal_force,
        s.indentation,
        s.stick_radius,
        s.contact_radius,
        s.regime,
        s.dissipated_energy,
        s.elastic_energy,
      ]),
    }),
  };
}

/** Pressure, bound and shear stress along the radius; the peaks stand where they are exactly. */
function stressed({ stress, state, friction }) {
  const { radius, pressure, shear, residual } = stress;
  const a = state.contact_radius;
  const scale = (factor) => radius.map((r, index) => [r, pressure[index] === null ? null : factor * pressure[index]]);
  const peaks = residual.peaks.filter((peak) => peak.shear !== null).map((peak) => [peak.radius, peak.shear]);
  const tau = [...radius.map((r, index) => [r, shear[index]]), ...peaks].sort((one, two) => one[0] - two[0]);
  const mean = state.normal_force / (Math.PI * a * a);
  const most = Math.min(4 * mean || 1, Math.max(...pressure.filter((value) => value !== null), 0) || 1);
  return {
    series: [
      { name: "shear stress τ", kind: "tau", points: tau },
      { name: "bound ±μ p", kind: "bound", points: scale(friction) },
      { name: "bound ±μ p", kind: "bound", points: scale(-friction), hover: false, legend: false },
      { name: "pressure p", kind: "pressure", points: scale(1) },
    ],
    bands:
      a > 0
        ? [
            { from: 0, to: state.stick_radius, kind: "stick", label: "stick" },
            { from: state.stick_radius, to: a, kind: "slip", label: "slip" },
          ]
        : [],
    range: { x: [0, (a || 1) * 1.04] },
    // What is infinite at an edge would leave nothing to see of the rest.
    cap: 1.1 * most,
    table: () => ({
      columns: ["radius_m", "pressure_pa", "shear_pa", "slip_m", "displacement_m"],
      rows: radius.map((r, index) => [r, pressure[index], shear[index], stress.slip[index], stress.displacement[index]]),
    }),
  };
}

function worked({ first, history, figures }) {
  const all = [first, ...history];
  return {
    least: {
      x: [first.sequence, first.sequence + 5],
      y: [0, (figures.gross_slip_force * figures.gross_slip_displacement) / 2],
    },
    series: [
      { name: "friction work", kind: "work", points: all.map(({ sequence, state }) => [sequence, state.dissipated_energy]) },
      { name: "stored", kind: "stored", points: all.map(({ sequence, state }) => [sequence, state.elastic_energy]) },
    ],
  };
}
