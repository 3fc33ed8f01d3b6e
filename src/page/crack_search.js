// Will it crack? Fatigue criteria over a cycle, the worst place that a search finds for each of them, and a section
// through it.
import { call } from "./api.js";
import { bodiesOf, elasticBodies } from "./below_surface.js";
import { amountOf, criteriaFields, criterion, verdict } from "./crack_criteria.js";
import { el } from "./dom.js";
import { Choice, Fields, JsonField, NumberField, valuesOf } from "./form_fields.js";
import { LENGTH, STRESS } from "./form_options.js";
import { virginContact } from "./protocol_run.js";
import { gridPoints, sectionPlot } from "./section_plot.js";
import { study } from "./study.js";
import { inPower, powerOf } from "./units.js";
import { showWarnings, warningList } from "./warning_list.js";

/** Half the width and the depth of the section in contact radii, its points, and the error that its colours may
 *  have. */
const [HALF, DEPTH] = [2, 1.2];
const [COLUMNS, ROWS] = [41, 19];
const SECTION_TOLERANCE = 1e-2;
/** The longest path that the service rates. */
const MOST_MOVES = 200;

/** The choice of the path, and what belongs to it. */
function pathFields(form, model) {
  const slip = model.figures.gross_slip_displacement;
  const usual = Math.abs(model.state.displacement ?? 0) || 0.5 * slip || 1e-7;
  const [unit, power] = LENGTH.findLast(([, one]) => one >= powerOf(usual)) ?? LENGTH.at(-1);
  const canRepeat = model.isComplete && model.history.length > 0 && model.history.length <= MOST_MOVES;
  const kind = new Choice(form, () => "/path", "The cycle", {
    cycles: "back and forth by an amplitude",
    ...(canRepeat ? { moves: "all moves of this contact so far, repeated" } : {}),
    json: "any path, as JSON",
  });
  const amplitude = new NumberField(form, () => "/path/cycles/displacement", {
    label: "Amplitude of the displacement",
    units: LENGTH,
    unit,
    value: inPower(Number(usual.toPrecision(3)), power),
  });
  const text = new JsonField(form, () => "/path", "Path as JSON", '{"displacement": [1e-7, -1e-7]}');
  const fold = () => {
    amplitude.element.hidden = kind.value !== "cycles";
    amplitude.isLeftOut = kind.value !== "cycles";
    text.element.hidden = kind.value !== "json";
    text.isLeftOut = kind.value !== "json";
  };
  kind.control.addEventListener("change", fold);
  fold();
  const value = () => {
    if (kind.value === "cycles") return { cycles: { displacement: amplitude.value, count: 1 } };
    if (kind.value === "moves") return { moves: model.history.map(({ move }) => move) };
    return text.value;
  };
  return {
    element: el("div", {}, kind.element, amplitude.element, text.element),
    value,
    // Moves that were made begin at the load that the contact was made with.
    contact: () => (kind.value === "moves" ? model.definition : virginContact(model)),
  };
}

/** The form and its results as cards, the plot, and a function that shows a state. */
export function crackCard(model) {
  const form = new Fields();
  const path = pathFields(form, model);
  const { material } = model.definition;
  const body = new Choice(form, () => "/body", "Body", elasticBodies(model.definition), model.definition.bulk?.body);
  const poisson =
    bodiesOf(material) === undefined &&
    new NumberField(form, () => "/poisson_ratio", { label: "Poisson’s ratio of the body", value: "0.3" });
  const criteria = criteriaFields(form, bodiesOf(material) !== undefined);
  const optional = (pointer, label, more) => new NumberField(form, () => pointer, { label, optional: true, ...more });
  const stress = { units: STRESS, unit: "MPa" };
  const bulk = {
    mean: optional("/bulk/mean", "Mean along x", stress),
    amplitude: optional("/bulk/amplitude", "Amplitude", stress),
    phase: optional("/bulk/phase", "Phase in degrees"),
  };
  const distance = optional("/critical_distance/length", "Critical distance of the material", {
    units: LENGTH,
    unit: "µm",
  });
  const method = new Choice(form, () => "/critical_distance/method", "Rated below the worst place", {
    point: "at half of it",
    line: "as a mean over twice of it",
  });
  const tolerance = optional("/tolerance", "Accepted error, relative to the largest value");
  const request = () => {
    return {
      contact: path.contact(),
      path: path.value(),
      body: body.value,
      poisson_ratio: poisson ? poisson.value : undefined,
      criteria: criteria.value(),
      bulk: valuesOf(bulk),
      critical_distance: distance.value === undefined ? undefined : { length: distance.value, method: method.value },
      tolerance: tolerance.value,
    };
  };

  const verdicts = el("div", { id: "crack-verdicts", "aria-live": "polite" });
  const warnings = warningList("crack-warnings");
  const drawn = el("select", { id: "crack-drawn" });
  const drawnRow = el("p", { class: "row", hidden: true }, el("label", {}, "Section by ", drawn));
  const status = el("p", { class: "status", role: "status", id: "crack-status" });
  const chart = sectionPlot({
    name: "crack",
    title: "Section through the worst place",
    note:
      "The plane of the motion through the worst place. Dashed: the edge of the contact. The ring is the worst " +
      "place.",
  });
  chart.element.hidden = true;
  let found = null;
  let wanted = 0;
  const drawSection = async (asked, reply, question) => {
    const key = drawn.value;
    const a = reply.contact.contact_radius;
    const [x, y] = reply[key].largest.point;
    const half = Math.max(HALF * a, 1.2 * Math.abs(x));
    const plane = { normal: "y", offset: y, x: [-half, half, COLUMNS], z: [0, DEPTH * a, ROWS] };
    const { [key]: member } = asked.criteria;
    const section = {
      ...asked,
      critical_distance: undefined,
      criteria: { [key]: member },
      plane,
      tolerance: SECTION_TOLERANCE,
    };
    const rated = await call("POST", "/fretting", section, model.signal);
    if (question !== wanted) return;
    const unit = criterion(key).unit;
    chart.drawPoints(gridPoints(rated, rated[key].values, ROWS), {
      field: key,
      quantity: criterion(key).name,
      columns: COLUMNS,
      radius: a,
      unit,
      worst: {
        point: reply[key].largest.point,
        value: reply[key].largest.value,
        text: amountOf(key, reply[key].largest.value, 3),
      },
    });
  };
  const draw = async () => {
    const question = (wanted += 1);
    status.textContent = "Drawing a section …";
    try {
      await drawSection(found.asked, found.reply, question);
      if (question === wanted) status.textContent = "";
    } catch (error) {
      if (question === wanted && !model.signal.aborted) status.textContent = error.message;
    }
  };
  drawn.addEventListener("change", draw);
  const compute = async () => {
    const asked = request();
    const question = (wanted += 1);
    status.textContent = "Searching the body for the worst place …";
    const reply = await call("POST", "/fretting", asked, model.signal).finally(() => (status.textContent = ""));
    if (question !== wanted) return;
    found = { asked, reply };
    const keys = Object.keys(reply).filter((key) => criterion(key));
    const hasLimit = (key) => asked.criteria[key]?.limit !== undefined;
    verdicts.replaceChildren(...keys.map((key) => verdict(key, reply[key], hasLimit(key))));
    showWarnings(warnings, reply.warnings);
    const sections = keys.filter((key) => !criterion(key).isOfSurface && reply[key].largest);
    drawn.replaceChildren(...sections.map((key) => el("option", { value: key }, criterion(key).name)));
    drawnRow.hidden = sections.length === 0;
    chart.element.hidden = true;
    if (sections.length) await draw();
  };
  const made = study({
    name: "crack",
    button: "Search for the worst place",
    title: "Will it crack?",
    text:
      "A cycle at the present load is repeated until it is steady, and the body is searched for the largest value of " +
      "each criterion. Limits of the material come from tests; the criteria are empirical.",
    form,
    parts: [
      path.element,
      body.element,
      ...(poisson ? [poisson.element] : []),
      ...criteria.elements,
      el("details", { class: "distance" }, el("summary", {}, "Critical distance"), distance.element, method.element),
      el(
        "details",
        { class: "bulk" },
        el("summary", {}, "Bulk stress of the body, and accuracy"),
        model.hasBulk
          ? el("p", { class: "note" }, "The bulk stress of the contact is included already; enter only what is added.")
          : null,
        ...Object.values(bulk).map((field) => field.element),
        tolerance.element,
      ),
    ],
    signal: model.signal,
    compute,
    calls: () => [{ method: "POST", path: "/fretting", body: request() }],
  });
  const results = el(
    "section",
    { class: "card", "aria-label": "Results of the criteria" },
    el("h2", {}, "Results of the criteria"),
    el("p", { class: "note" }, "A margin above one does not prove that a part is safe."),
    status,
    verdicts,
    warnings,
    drawnRow,
    chart.element,
  );
  return { form: made, results: { element: results, charts: [chart] } };
}
