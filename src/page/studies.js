// Studies of a virgin contact of this kind: a fretting map, remaining stress against the number of reversals, and speed
// against error of the solvers.
import { call } from "./api.js";
import { Chart } from "./chart.js";
import { columnsOf } from "./chart_menu.js";
import { frettingMap } from "./fretting_map.js";
import { virginContact, PROTOCOLS } from "./protocol_run.js";
import { study } from "./study.js";

/** Up to how many reversals the best protocol is searched for. */
const MOST_SEARCHED = 10;
const REVERSALS = [1, 2, 3, 4, 5, 7, 10, 14, 20, 30, 50, 70, 100, 140, 200];
// Smaller errors are drawn as this one, which is that of a rounded number: a logarithmic axis has no zero.
const SMALLEST_ERROR = 1e-16;

/** The card of the fretting map; `show` moves its mark. */
export function mapCard(model) {
  const map = frettingMap(model);
  const made = study({
    name: "map",
    signal: model.signal,
    title: "Fretting map",
    text:
      "For this shape and friction: which loads and amplitudes slide, and how much friction work a steady cycle " +
      "does.",
    charts: [map.chart],
    isQuick: model.state.normal_force > 0,
    ...map,
  });
  return { ...made, show: map.mark };
}

/** The card of what remains after so many reversals. */
export function residualCard(model) {
  const full = model.figures.max_pressure && model.friction * model.figures.max_pressure;
  const chart = new Chart({
    name: "residual",
    title: "Shear stress after N_R reversals",
    x: { label: "Reversals N_R", log: true },
    y: full ? { label: "Residual |τ| / (μ p_max)", log: true } : { label: "Residual |τ| (Pa)", log: true },
    note: full
      ? "μ p_max is that of the preload."
      : "The stress is infinite at one radius; the largest finite one is shown.",
  });
  const request = (kind, reversals) => ({
    contact: model.definition,
    path: { [kind]: { reversals } },
    steps: "last",
    residual: true,
  });
  const compute = async (report) => {
    const found = { falling_amplitude: [], equal_peaks: [], minimax: [] };
    const kinds = Object.keys(PROTOCOLS);
    let done = 0;
    for (const reversals of REVERSALS) {
      for (const kind of kinds) {
        const { residual: left } = await call("POST", "/simulate", request(kind, reversals), model.signal);
        const peaks = left.peaks.map((peak) => Math.abs(peak.shear ?? NaN)).filter(Number.isFinite);
        const most = left.max ?? (peaks.length ? Math.max(...peaks) : null);
        // A logarithmic axis has no zero.
        found[kind].push([reversals, most / (full || 1) || null]);
        report((done += 1) / REVERSALS.length / kinds.length);
      }
      if (reversals <= MOST_SEARCHED) {
        const { largest } = await call("POST", "/protocols", { contact: model.definition, reversals }, model.signal);
        found.minimax.push([reversals, (largest ?? 0) / (full || 1) || null]);
      }
      const line = (name, kind) => ({ name, kind: `${kind} c1`, dots: true, points: [...found[kind]] });
      chart.draw({
        empty: "Nothing remains on this shape.",
        series: [
          line("linear: largest", kinds[0]),
          line("equal peaks: largest", kinds[1]),
          line("minimax: largest", "minimax"),
        ],
      });
    }
  };
  return study({
    name: "residual",
    signal: model.signal,
    title: "Residual stress against reversals",
    charts: [chart],
    compute,
    text:
      "For this shape, friction and preload, from a virgin contact: how much shear stress remains after that many " +
      "reversals.",
    calls: () => [{ method: "POST", path: "/simulate", body: request("falling_amplitude", 20) }],
  });
}

/** The card that compares the solvers. */
export function accuracyCard(model) {
  const chart = new Chart({
    name: "accuracy",
    title: "Speed against error",
    mode: "nearest",
    height: 340,
    x: { label: "Time to compute (s)", log: true },
    y: { label: "Error of the stress / (μ p_max)", log: true },
  });
  chart.more = (_, series) => [series.name];
  const request = () => ({ contact: virginContact(model), path: { falling_amplitude: { reversals: 20 } } });
  const named = (solver) =>
    typeof solver === "string"
      ? solver
      : Object.entries(solver)
          .map(([name, options]) => `${options?.count ?? ""} ${name}`.trim())
          .join();
  const show = ({ rows }) => {
    const error = (row) => (row.stress_error === null ? null : Math.max(row.stress_error, SMALLEST_ERROR));
    const series = rows.map((row, index) => ({
      name: named(row.solver),
      kind: `solver s${index}`,
      dots: true,
      line: false,
      legend: false,
      label: true,
      points: [[row.compute_time, error(row)]],
    }));
    const table = () => ({
      solver: rows.map((row) => named(row.solver)),
      ...columnsOf(rows, { compute_time_s: "compute_time", force_error: "force_error", stress_error: "stress_error" }),
    });
    chart.draw({ empty: "No solver answered.", series, table });
  };
  return study({
    name: "accuracy",
    signal: model.signal,
    title: "Speed against error",
    charts: [chart],
    path: "/accuracy",
    request,
    show,
    text:
      "The scene of 20 reversals on this contact by each solver: its time on this server, and its error, of which " +
      "10⁻¹⁶ is rounding.",
  });
}
