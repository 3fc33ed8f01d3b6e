// A fretting map of a contact: regime and lines of equal friction work over load and amplitude, with a mark at the
// present ones.
import { call } from "./api.js";
import { Chart } from "./chart.js";
import { columnsOf } from "./chart_menu.js";
import { amplitudeOf } from "./steady_cycle.js";
import { formatQuantity } from "./units.js";

/** Loads, and amplitudes under each. */
const COUNT = 40;
/** The smallest load and amplitude over the largest. */
const [LOADS, AMPLITUDES] = [1e-2, 1e-3];

const ABOUT =
  "Grey: equal friction work of a cycle. Below the dashed line the middle sticks, above it the whole contact slides.";

const spaced = (from, to) => Array.from({ length: COUNT }, (_, index) => from * (to / from) ** (index / (COUNT - 1)));

/** The request for a map about the load of a contact: up to `most` N. */
function request({ definition, reach, state }, most) {
  const widest = 2 * reach(state);
  return {
    contact: definition,
    drive: { displacement: spaced(AMPLITUDES * widest, widest) },
    map: { normal_force: { from: LOADS * most, to: most, count: COUNT } },
  };
}

/** The amplitude that does this work under one load, between those of the map; nothing outside. */
function amplitudeFor(work, column) {
  const next = column.findIndex((cycle) => cycle.dissipated_energy >= work);
  if (next < 1 || !(column[next - 1].dissipated_energy > 0)) return null;
  const [low, high] = [column[next - 1], column[next]];
  const share = Math.log(work / low.dissipated_energy) / Math.log(high.dissipated_energy / low.dissipated_energy);
  return low.displacement_amplitude * (high.displacement_amplitude / low.displacement_amplitude) ** share;
}

/** The series of a map. */
function lines(cycles) {
  const columns = Array.from({ length: COUNT }, (_, index) => cycles.slice(index * COUNT, (index + 1) * COUNT));
  const widest = columns[0].at(-1).displacement_amplitude;
  const slips = columns.map(([cycle]) => [cycle.normal_force, cycle.gross_slip_displacement]);
  const works = cycles.map((cycle) => cycle.dissipated_energy).filter((work) => work > 0);
  const [first, last] = [Math.ceil(Math.log10(Math.min(...works))), Math.floor(Math.log10(Math.max(...works)))];
  const levels = works.length ? Array.from({ length: last - first + 1 }, (_, index) => 10 ** (first + index)) : [];
  return [
    { name: "gross slip above", kind: "bound", points: slips.map(([x, y]) => [x, y > 0 && y <= widest ? y : null]) },
    ...levels.map((level) => ({
      name: formatQuantity(level, "J", 2),
      kind: "past",
      label: true,
      legend: false,
      points: columns.map((column) => [column[0].normal_force, amplitudeFor(level, column)]),
    })),
  ];
}

/** What a card of a study needs; `mark` moves the mark to the present load and amplitude. */
export function frettingMap(model) {
  const chart = new Chart({
    name: "map",
    title: "Fretting map",
    mode: "nearest",
    height: 340,
    x: { label: "Load F_N", unit: "N", log: true },
    y: { label: "Amplitude U_0", unit: "m", log: true },
    note: ABOUT,
  });
  chart.more = (_, series) => [series.name];
  let data = null;
  const mark = () => {
    if (!data) return;
    const [x, y] = [model.state.normal_force, amplitudeOf(model.state)];
    // A logarithmic axis has no zero.
    const isThere = x > 0 && y > 0;
    const note = `${ABOUT} ${isThere ? "The mark is the contact now." : "At a displacement of zero it has no mark."}`;
    chart.draw({ ...data, note, marks: isThere ? [{ x, y, class: model.state.regime }] : [] });
  };
  const load = () => model.state.normal_force || model.figures.normal_force;
  const compute = async () => {
    if (!(load() > 0)) throw new Error("Without a load there is no map: press the bodies together.");
    const { cycles } = await map(3 * load()).catch((error) => {
      // The shape may end beyond the present load.
      if (error.status !== 422) throw error;
      return map(load());
    });
    const table = () =>
      columnsOf(cycles, {
        normal_force_n: "normal_force",
        displacement_amplitude_m: "displacement_amplitude",
        regime: "regime",
        friction_work_j: "dissipated_energy",
      });
    data = { empty: "Without friction there is no map.", series: lines(cycles), table };
    mark();
  };
  const map = (most) => call("POST", "/cycle", request(model, most), model.signal);
  const calls = () => [{ method: "POST", path: "/cycle", body: request(model, 3 * load()) }];
  return { chart, compute, calls, mark };
}
