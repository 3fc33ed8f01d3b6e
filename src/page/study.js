// What a contact like this one would do: the stress that remains against the number of reversals, and what solvers cost.
import { call } from "./api.js";
import { Chart } from "./chart.js";
import { copying } from "./code.js";
import { el, notice, words } from "./dom.js";
import { anew, PROTOCOLS } from "./run.js";

const REVERSALS = [1, 2, 3, 4, 5, 7, 10, 14, 20, 30, 50, 70, 100, 140, 200];
const SPRINGS = [100, 300, 1000, 3000, 10000];
let paths = null;

/** The cards below a contact. */
export function studies(about) {
  const element = el("div", { class: "studies" }, residual(about));
  offered("/accuracy").then((is) => { if (is) element.append(accuracy(about)); });
  return element;
}

/** Whether the service has an endpoint. */
async function offered(path) {
  paths ??= call("GET", "/openapi.json").then((document) => document.paths, () => ({}));
  return path in await paths;
}

/** A card with a button that computes a plot. */
function card({ title, text, chart, calls, compute, id }) {
  const bar = el("progress", { max: 1, value: 0, hidden: true, "aria-label": `Progress: ${title}` });
  const button = el("button", { type: "button", class: "primary", id, onclick: async () => {
    button.disabled = true;
    bar.hidden = false;
    chart.element.hidden = false;
    try { await compute((part) => { bar.value = part; }); } catch (error) { notice(error.message, true); }
    button.disabled = false;
    bar.hidden = true;
  } }, "Compute");
  chart.element.hidden = true;
  return el("section", { class: "card" }, el("div", { class: "head" }, el("h2", {}, words(title)), copying(calls)), el("p", {}, words(text)), el("p", { class: "row" }, button, bar), chart.element);
}

function residual(about) {
  const full = about.figures.max_pressure && about.friction * about.figures.max_pressure;
  const chart = new Chart({
    name: "residual", title: "What remains after N_R reversals", x: { label: "Reversals N_R", log: true },
    y: full ? { label: "Residual |τ| / (μ p_max)", log: true } : { label: "Residual |τ| (Pa)", log: true },
    note: full ? "μ p_max is that of the preload." : "",
  });
  const request = (kind, reversals) => ({ contact: about.definition, path: { [kind]: { reversals } }, steps: "last", residual: true });
  const compute = async (report) => {
    const found = { falling_amplitude: [], equal_peaks: [] };
    const kinds = Object.keys(PROTOCOLS);
    let done = 0;
    for (const reversals of REVERSALS) {
      for (const kind of kinds) {
        const { residual: left } = await call("POST", "/simulate", request(kind, reversals), about.signal);
        const peaks = left.peaks.map((peak) => Math.abs(peak.shear ?? NaN)).filter(Number.isFinite);
        const most = left.max ?? (peaks.length ? Math.max(...peaks) : null);
        found[kind].push([reversals, ...[most, left.mean, left.min].map((value) => (value === null ? null : value / (full || 1)))]);
        report((done += 1) / REVERSALS.length / kinds.length);
      }
      const line = (name, kind, column) => ({ name, kind: `${kind} c${column}`, dots: true, points: found[kind].map((row) => [row[0], row[column]]) });
      chart.draw({ series: [line("linear: largest", kinds[0], 1), line("linear: mean peak", kinds[0], 2), line("linear: smallest peak", kinds[0], 3), line("equal peaks: largest", kinds[1], 1)] });
    }
  };
  return card({
    id: "compute-residual", title: "Residual stress against reversals", chart, compute,
    text: "For this shape, friction and preload, from a virgin contact: how much shear stress is left after a run with so many reversals.",
    calls: () => [{ method: "POST", path: "/simulate", body: request("falling_amplitude", 20) }],
  });
}

function accuracy(about) {
  const chart = new Chart({ name: "accuracy", title: "Speed against error", mode: "nearest", x: { label: "Time to compute (s)", log: true }, y: { label: "Error of the stress / (μ p_max)", log: true } });
  const solvers = () => ["exact", ...SPRINGS.map((count) => ({ springs: { count } }))];
  const body = () => ({ contact: anew(about), path: { falling_amplitude: { reversals: 20 } }, stress: { points: 200 }, solvers: solvers() });
  const named = (solver) => (typeof solver === "string" ? solver : Object.entries(solver).map(([name, about]) => `${about?.count ?? ""} ${name}`.trim()).join());
  const compute = async () => {
    const { rows } = await call("POST", "/accuracy", body(), about.signal);
    // On a logarithmic axis there is no error of nought.
    chart.draw({ series: rows.map((row, index) => ({ name: named(row.solver), kind: `solver s${index % 6}`, dots: true, line: false, points: [[row.compute_time, Math.max(row.stress_error ?? NaN, 1e-17)]] })) });
  };
  return card({
    id: "compute-accuracy", title: "Speed against error", chart, compute,
    text: "The scene of 20 reversals on this contact by each solver: what it costs on this server, and how wrong it is.",
    calls: () => [{ method: "POST", path: "/accuracy", body: body() }],
  });
}
