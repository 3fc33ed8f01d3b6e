// The stress below the surface of a contact in its present state: a section along the motion, and its largest value in
// words.
import { call } from "./api.js";
import { el } from "./dom.js";
import { Choice, Fields, NumberField } from "./form_fields.js";
import { gridPoints, sectionPlot } from "./section_plot.js";
import { latestAnswer } from "./study.js";
import { formatQuantity } from "./units.js";

/** How long contact and fields rest before the service is asked, ms. */
const REST = 120;
/** Half the width and the depth of the section, in contact radii, and its points. */
const [HALF, DEPTH] = [2, 1.5];
const [COLUMNS, ROWS] = [61, 31];
const NAMES = {
  von_mises: "von Mises stress",
  max_shear: "shear stress on any plane",
  hydrostatic: "hydrostatic stress",
};

/** The bodies of a material, where they are known. */
export const bodiesOf = ({ bodies, effective }) => bodies ?? effective.bodies;

/** The bodies that have a stress: all but a rigid one. */
export function elasticBodies({ material }) {
  const names = { first: "first, with the profile", second: "second" };
  const rigid = (index) => bodiesOf(material)?.[index] === "rigid";
  return Object.fromEntries(Object.entries(names).filter((_, index) => !rigid(index)));
}

function place([x, z]) {
  const depth = z === 0 ? "on the surface" : `${formatQuantity(z, "m", 3)} below the surface`;
  return `${depth} at x = ${x === 0 ? 0 : formatQuantity(x, "m", 3)}`;
}

function sentence(field, { infinite, low, high }) {
  const edge = infinite
    ? `Infinite ${place(infinite)}, where the profile has an edge or a tip. At the other points: `
    : "";
  const at = (name, point) => `largest ${name} ${formatQuantity(Math.abs(point[2]), "Pa", 3)}, ${place(point)}`;
  const parts = field === "hydrostatic" ? [] : [at(NAMES[field], high)];
  if (field === "hydrostatic" && low[2] < 0) parts.push(at("mean compression", low));
  // Where there is no tension, round-off is left.
  if (field === "hydrostatic" && high[2] > 1e-9 * -low[2]) parts.push(at("mean tension", high));
  const text = `${edge}${parts.join("; ")}.`;
  return text[0].toUpperCase() + text.slice(1);
}

/** The card, and a function that shows the stress that belongs to a state. */
export function belowSurfaceCard(model) {
  const form = new Fields();
  const body = new Choice(form, () => "/body", "Body", elasticBodies(model.definition), model.definition.bulk?.body);
  const field = new Choice(form, () => "/fields", "Stress", {
    von_mises: "von Mises",
    max_shear: "largest shear stress",
    hydrostatic: "hydrostatic (mean)",
  });
  const isReduced = bodiesOf(model.definition.material) === undefined;
  const poisson =
    isReduced && new NumberField(form, () => "/poisson_ratio", { label: "Poisson’s ratio of the body", value: "0.3" });
  const fields = [body, field, ...(poisson ? [poisson] : [])];
  const text = el("p", { id: "below-text", "aria-live": "polite" });
  const chart = sectionPlot({
    name: "below",
    title: "Section along the motion",
    note:
      "The plane y = 0, x along the motion of the first body, at 61 × 31 points. Dashed: the edge of the contact. " +
      "The ring marks the largest value.",
  });
  chart.element.hidden = true;
  const path = `/contacts/${model.id}/subsurface`;
  const request = () => {
    const a = model.state.contact_radius;
    const plane = { normal: "y", offset: 0, x: [-HALF * a, HALF * a, COLUMNS], z: [0, DEPTH * a, ROWS] };
    return { body: body.value, poisson_ratio: poisson?.value, plane, fields: [field.value] };
  };
  const say = (words) => {
    text.textContent = words;
    chart.element.hidden = true;
  };
  const follow = latestAnswer(model, REST, {
    ask: (asked) => call("POST", path, asked, model.signal),
    show: (reply, { fields: [name], plane }) => {
      form.clear();
      const shown = { field: name, quantity: NAMES[name], columns: COLUMNS, radius: plane.x[1] / HALF };
      text.textContent = sentence(name, chart.drawPoints(gridPoints(reply, reply[name], ROWS), shown));
    },
    fail: (error) => {
      say("");
      form.place(error);
    },
  });
  const show = (state) => {
    const asked = request();
    follow(`${model.history.at(-1)?.sequence ?? model.first.sequence} ${JSON.stringify(asked)}`, () => {
      if (state.contact_radius > 0) return asked;
      form.clear();
      say("The bodies do not press on each other: there is no stress below the surface.");
    });
  };
  for (const { control } of fields) {
    for (const event of ["input", "change"]) control.addEventListener(event, () => show(model.state));
  }
  const element = el(
    "section",
    { class: "card below", id: "below-card" },
    el("h2", {}, "Stress below the surface, now"),
    el("div", { class: "row choices" }, ...fields.map((one) => one.element)),
    form.rest,
    text,
    chart.element,
  );
  return { element, charts: [chart], show, calls: () => [{ method: "POST", path, body: request() }] };
}
