// The guided run: a to and fro that dies away, one reversal after the other, so that the shear stress goes out of the contact.
import { call, offered } from "./api.js";
import { copying } from "./code.js";
import { el, pause, words } from "./dom.js";
import { plain, shown } from "./units.js";

export const PROTOCOLS = { falling_amplitude: "Falling amplitude (linear)", equal_peaks: "Equal peaks (for this shape)" };
/** The protocol that the service makes for the present state of a contact. */
const RELAX = "relax";
/** What a run lasts, if it has enough reversals, in ms; and what one of them lasts at the most. */
const [LASTS, LONGEST] = [6000, 400];

/** A contact without a past, at the present load of a session. */
export const anew = ({ definition, state }) => ({ ...definition, preload: { indentation: state.indentation } });

/** The card that runs a protocol on a session. */
export function guide(about) {
  const { id, signal } = about;
  const kind = el(
    "select",
    { id: "protocol" },
    Object.entries(PROTOCOLS).map(([key, text]) => el("option", { value: key }, text)),
  );
  const count = el("input", { id: "reversals", type: "number", min: 1, max: 1000, value: "20" });
  const bar = el("progress", { id: "progress", max: 1, value: 0, "aria-label": "Progress of the run" });
  const told = el("p", { class: "told", role: "status", id: "run-told" });
  const start = el("button", { class: "primary", id: "run" }, "Run");
  const stop = el("button", { type: "button", hidden: true, onclick: () => halt?.abort() }, "Stop");
  let halt = null;

  const remaining = async () =>
    (await call("GET", `/contacts/${id}/stress?points=2&residual=true`, undefined, signal)).residual;
  const amount = ({ max }) => {
    const { max_pressure: full } = about.figures;
    if (max === null) return "an infinite shear stress at one radius";
    const share =
      full && about.figures.normal_force === about.state.normal_force
        ? ` (${plain((100 * max) / (about.friction * full), 3)} % of μ p_max)`
        : "";
    return `up to ${shown(max, "Pa", 3)} of shear stress${share}`;
  };
  const relax = `/contacts/${id}/relax`;
  offered("/contacts/{id}/relax").then((is) => {
    if (is) kind.append(el("option", { value: RELAX }, "Least stress, from the present state"));
  });
  const path = () => ({ [kind.value]: { reversals: Number(count.value) } });
  const whole = () =>
    kind.value === RELAX
      ? { method: "POST", path: relax, body: { reversals: Number(count.value) } }
      : { method: "POST", path: `/contacts/${id}/path`, body: { path: path(), steps: "last" } };
  const displacements = async () => {
    if (kind.value === RELAX)
      return (await call("POST", relax, { reversals: Number(count.value), dry_run: true }, signal)).path.displacement;
    const { steps } = await call("POST", "/simulate", { contact: anew(about), path: path() }, signal);
    return steps.map((step) => step.displacement);
  };
  const run = async () => {
    const before = await remaining();
    const turns = await displacements();
    bar.max = turns.length;
    for (const [index, displacement] of turns.entries()) {
      if (halt.signal.aborted || signal.aborted) break;
      await call("POST", `/contacts/${id}/move`, { displacement }, signal);
      bar.value = index + 1;
      told.textContent = `Move ${index + 1} of ${turns.length}: to ${shown(displacement, "m")}`;
      await pause(Math.min(LONGEST, LASTS / turns.length), halt.signal);
    }
    const after = await remaining();
    told.replaceChildren(
      ...words(`${halt.signal.aborted ? "Stopped. " : ""}Before: ${amount(before)}. Now: ${amount(after)}.`),
    );
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
      if (!signal.aborted) told.textContent = error.errors?.[0]?.detail ?? error.message;
    } finally {
      start.disabled = false;
      stop.hidden = true;
    }
  };
  return el(
    "section",
    { class: "card", id: "guide" },
    el(
      "div",
      { class: "head" },
      el("h2", {}, "Take the shear stress out"),
      copying(() => [whole()]),
    ),
    el(
      "p",
      {},
      "Pushed aside and brought back, a loaded contact keeps shear stress. Moved to and fro with an amplitude that dies away from gross slip, it loses most of it: each reversal leaves a ring of the opposite sign, and many small rings are left where there was one large stress.",
    ),
    el(
      "form",
      { class: "row", onsubmit: begin },
      el("label", {}, "Protocol ", kind),
      el("label", {}, words("Reversals N_R "), count),
      start,
      stop,
      bar,
    ),
    told,
  );
}
