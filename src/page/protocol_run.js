// Runs a protocol on a contact, move by move: reversals of falling amplitude that reduce its shear stress.
import { call } from "./api.js";
import { el, pause, reason, withSubscripts } from "./dom.js";
import { numberBox, numberIn } from "./form_fields.js";
import { formatNumber, formatQuantity, parseNumber } from "./units.js";

export const PROTOCOLS = {
  falling_amplitude: "Linear (falling amplitude)",
  equal_peaks: "Equal peaks",
};
/** The protocol that the service computes from the present state of a contact. */
const RELAX = "relax";
/** Duration of a run with many moves, and longest pause between two moves, ms. */
const [RUN_TIME, MAX_PAUSE] = [6000, 400];

/** A virgin contact, at the present load of a contact: its definition, where the load is that of the preload. */
export const virginContact = ({ definition, figures, state }) =>
  state.indentation === figures.indentation
    ? definition
    : { ...definition, preload: { normal_force: state.normal_force } };

/** The card that runs a protocol on a contact. */
export function protocolCard(model) {
  const { id, signal } = model;
  const { falling_amplitude } = PROTOCOLS;
  const searched = { ...PROTOCOLS, [RELAX]: "Minimax, from the present state" };
  // The others are searched for zones about the middle, which a bulk stress moves.
  const options = model.hasBulk ? { falling_amplitude } : searched;
  const kind = el(
    "select",
    { id: "protocol" },
    Object.entries(options).map(([key, text]) => el("option", { value: key }, text)),
  );
  const count = numberBox({ id: "reversals", size: 6, value: "20" });
  const bar = el("progress", { id: "progress", max: 1, value: 0, "aria-label": "Progress of the run" });
  const status = el("p", { class: "status", role: "status", id: "run-status" });
  const start = el("button", { class: "primary", id: "run" }, "Run");
  const stop = el("button", { type: "button", hidden: true, onclick: () => halt?.abort() }, "Stop");
  let halt = null;

  const remaining = () => call("GET", `/contacts/${id}/residual`, undefined, signal);
  const amount = ({ max, relative }) => {
    if (max === null) return "an infinite shear stress at one radius";
    // Where the pressure is infinite, the reply compares with its mean.
    const hasShare = model.figures.max_pressure !== null && relative !== null;
    const share = hasShare ? ` (${formatNumber(100 * relative, 3)} % of μ p_max)` : "";
    return `up to ${formatQuantity(max, "Pa", 3)} of shear stress${share}`;
  };
  const reversals = () => parseNumber(count.value);
  const path = () => ({ [kind.value]: { reversals: reversals() } });
  /** The same as a question, which moves nothing. */
  const question = () =>
    kind.value === RELAX
      ? { method: "POST", path: `/contacts/${id}/relax`, body: { reversals: reversals(), dry_run: true } }
      : {
          method: "POST",
          path: "/simulate",
          body: { contact: virginContact(model), path: path(), steps: "last", residual: true },
        };
  const displacements = async () => {
    if (kind.value === RELAX) {
      const { method, path: of, body } = question();
      const { path: best } = await call(method, of, body, signal);
      return best.displacement;
    }
    const { steps } = await call("POST", "/simulate", { contact: virginContact(model), path: path() }, signal);
    return steps.map((step) => step.displacement);
  };
  const run = async () => {
    numberIn(count);
    const before = await remaining();
    const turns = await displacements();
    bar.max = turns.length;
    for (const [index, displacement] of turns.entries()) {
      if (halt.signal.aborted || signal.aborted) break;
      await call("POST", `/contacts/${id}/move`, { displacement }, signal);
      bar.value = index + 1;
      status.textContent = `Move ${index + 1} of ${turns.length}: to ${formatQuantity(displacement, "m")}`;
      await pause(Math.min(MAX_PAUSE, RUN_TIME / turns.length), halt.signal);
    }
    const after = await remaining();
    const stopped = halt.signal.aborted ? "Stopped. " : "";
    const nothing = before.max === 0 ? " There was nothing to reduce: the moves caused this stress." : "";
    status.replaceChildren(...withSubscripts(`${stopped}Before: ${amount(before)}. Now: ${amount(after)}.${nothing}`));
  };
  const begin = async (event) => {
    event.preventDefault();
    halt = new AbortController();
    start.disabled = true;
    stop.hidden = false;
    bar.value = 0;
    try {
      await run();
    } catch (error) {
      if (!signal.aborted) status.textContent = reason(error);
    } finally {
      start.disabled = false;
      stop.hidden = true;
    }
  };
  const element = el(
    "section",
    { class: "card", id: "protocol-card" },
    el("h2", {}, "Reduce the shear stress"),
    el(
      "p",
      {},
      "Pushed aside and brought back, a loaded contact keeps shear stress. Moved back and forth with an " +
        "amplitude that falls from gross slip to zero, it loses most of it: each reversal leaves a ring of the " +
        "opposite sign, and many small rings are left where there was one large stress.",
    ),
    el(
      "form",
      { class: "row", onsubmit: begin },
      el("label", {}, "Protocol ", kind),
      el("label", {}, withSubscripts("Reversals N_R "), count),
      start,
      stop,
      bar,
    ),
    status,
  );
  return { element, calls: () => [{ method: "GET", path: `/contacts/${id}/residual` }, question()] };
}
