// Runs a whole path on a contact: cycles, or any other path of the API as JSON.
import { call } from "./api.js";
import { el } from "./dom.js";
import { Fields, JsonField } from "./form_fields.js";
import { study } from "./study.js";
import { formatQuantity } from "./units.js";

/** Five cycles to half of gross slip; of bodies with memory one, whose moves take their time. */
function halfSlip({ figures, hasMemory }) {
  const displacement = Number((0.5 * figures.gross_slip_displacement || 1e-7).toPrecision(3));
  return hasMemory
    ? { displacement: [displacement, -displacement, displacement], duration: 0.01 }
    : { cycles: { displacement, count: 5 } };
}

/** The card that runs a path on a contact. */
export function pathCard(model) {
  const at = `/contacts/${model.id}/path`;
  const form = new Fields();
  const path = new JsonField(form, () => "/path", "Path as JSON", JSON.stringify(halfSlip(model), null, 2));
  const status = el("p", { class: "status", role: "status", id: "path-status" });
  const request = () => ({ path: path.value, steps: "last" });
  const compute = async () => {
    const before = model.state.dissipated_energy;
    const { steps, warnings } = await call("POST", at, request(), model.signal);
    const work = formatQuantity(steps[0].dissipated_energy - before, "J", 4);
    const warned = (warnings ?? []).map(({ message }) => ` Note: ${message}`).join("");
    status.textContent = `Done. Friction work of the path: ${work}.${warned}`;
  };
  return study({
    name: "path",
    button: "Run",
    title: "Run a path",
    text: "Cycles between two turns, or any other path that the API takes, as JSON. It is run whole or not at all.",
    form,
    parts: [path.element, status],
    signal: model.signal,
    compute,
    calls: () => (path.value === null ? [] : [{ method: "POST", path: at, body: request() }]),
  });
}
