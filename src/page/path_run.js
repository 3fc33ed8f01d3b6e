// Runs a whole path on a contact: cycles, or any other path of the API as JSON.
import { call } from "./api.js";
import { el } from "./dom.js";
import { formatQuantity } from "./units.js";

/** Five cycles to half of gross slip. */
function halfSlip({ figures }) {
  const displacement = 0.5 * figures.gross_slip_displacement || 1e-7;
  return { cycles: { displacement: Number(displacement.toPrecision(3)), count: 5 } };
}

/** The card that runs a path on a contact. */
export function pathCard(model) {
  const path = `/contacts/${model.id}/path`;
  const text = el("textarea", {
    id: "path",
    rows: 6,
    spellcheck: "false",
    "aria-label": "Path as JSON",
    value: JSON.stringify(halfSlip(model), null, 2),
  });
  const status = el("p", { class: "status", role: "status", id: "path-status" });
  const run = el("button", { class: "primary", id: "run-path" }, "Run");
  const parsed = () => {
    try {
      return JSON.parse(text.value);
    } catch {
      return null;
    }
  };
  const request = () => ({ method: "POST", path, body: { path: parsed(), steps: "last" } });
  const begin = async (event) => {
    event.preventDefault();
    if (parsed() === null) {
      status.textContent = "This is not JSON.";
      return;
    }
    run.disabled = true;
    const before = model.state.dissipated_energy;
    try {
      const { steps, warnings } = await call("POST", path, request().body, model.signal);
      const work = steps[0].dissipated_energy - before;
      const warned = (warnings ?? []).map(({ message }) => ` Note: ${message}`).join("");
      status.textContent = `Done. Friction work of the path: ${formatQuantity(work, "J", 4)}.${warned}`;
    } catch (error) {
      const fault = error.errors?.[0];
      if (!model.signal.aborted) status.textContent = fault ? `${fault.pointer}: ${fault.detail}` : error.message;
    } finally {
      run.disabled = false;
    }
  };
  const element = el(
    "section",
    { class: "card", id: "path-card" },
    el("h2", {}, "Run a path"),
    el("p", {}, "Cycles between two turns, or any other path that the API takes, as JSON. It is run whole or not at all."),
    el("form", { onsubmit: begin }, text, el("p", { class: "row" }, run)),
    status,
  );
  return { element, calls: () => (parsed() === null ? [] : [request()]) };
}
