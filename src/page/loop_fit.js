// Loops that a bench has measured, as files or pasted: the service fits friction and stiffness to them.
import { call } from "./api.js";
import { Chart } from "./chart.js";
import { el, figure, noticing, withdrawNotice } from "./dom.js";
import { Fields, NumberField, valuesOf } from "./form_fields.js";
import { FORCE, LENGTH } from "./form_options.js";
import { loopRecord } from "./loop_record.js";
import { study } from "./study.js";
import { formatInterval, formatQuantity, prefixed } from "./units.js";
import { showWarnings, warningList } from "./warning_list.js";

/** What may be free: its name on the page, its unit, whether it is so at first, and whether only a sphere has it. */
const PARAMETERS = {
  friction: ["friction μ", "", true],
  g_star: ["modulus G*", "Pa", true],
  machine_compliance: ["compliance of the machine", "m/N", false],
  displacement_offset: ["zero of the displacement", "m", false],
  force_offset: ["zero of the force", "N", true],
  drift: ["drift of the displacement", "m/s", false],
  delay: ["delay of the force", "s", false],
  gain_drift: ["drift of the gain", "1/s", false],
  shear_strength: ["shear strength τ₀", "Pa", false],
  e_star: ["modulus E*", "Pa", false, true],
  radius: ["radius", "m", false, true],
};
/** The symbols of what a combination is made of. */
const SYMBOLS = {
  g_star: "G*",
  e_star: "E*",
  radius: "R",
  contact_radius: "a",
  friction: "μ",
  normal_force: "F",
  shear_strength: "τ₀",
  pi: "π",
};

/** The name of a parameter, or of a combination such as `g_star * (radius/e_star)^(1/3)`, as children. */
function inWords(name) {
  if (name in PARAMETERS) return [PARAMETERS[name][0]];
  const symbols = name
    .replace(/[a-z_]+/g, (part) => SYMBOLS[part] ?? part)
    .replaceAll(" * ", " · ")
    .replaceAll("^2", "²");
  const end = symbols.indexOf("^(");
  return end < 0 ? [symbols] : [symbols.slice(0, end), el("sup", {}, symbols.slice(end + 2, -1))];
}

/** The units in which a known value may be given. */
const SCALES = {
  Pa: prefixed("Pa", "G", "M", ""),
  "m/N": prefixed("m/N", "n", "µ", ""),
  m: prefixed("m", "µ", "n", "m", ""),
  N: prefixed("N", "", "m"),
  "m/s": prefixed("m/s", "n", "µ", ""),
  s: prefixed("s", "", "m", "µ"),
  "1/s": prefixed("1/s", ""),
};
const MOST_RECORDS = 16;
/** Up to how many points of a record are drawn one by one. */
const MOST_DOTS = 4000;

/** A row for each quantity that was estimated. */
function estimateRows(estimates) {
  return Object.entries(estimates).map(([name, { value, interval, at_bound: bound }]) => {
    const [text, unit] = PARAMETERS[name] ?? [name, ""];
    const between = `95 %: ${formatInterval(interval, unit)}${bound ? ", at its bound" : ""}`;
    return figure(text, `${formatQuantity(value, unit)} (${between})`);
  });
}

/** The fields of what is known of each parameter: its value and its standard error. */
function knownFields(form, offered) {
  return offered.map(([name, [label, unit]]) => {
    const field = (member, text) =>
      new NumberField(form, () => `/known/${name}/${member}`, {
        label: text,
        units: SCALES[unit],
        unit: SCALES[unit]?.[0][0],
        optional: true,
      });
    const value = field("value", label[0].toUpperCase() + label.slice(1));
    const error = field("standard_error", "Its standard error");
    return { name, value, error, element: el("div", { class: "pair" }, value.element, error.element) };
  });
}

/** The form and its results as cards, the plots, and the request. */
export function fittedLoop(model) {
  const form = new Fields();
  const records = [];
  const list = el("div", {});
  const add = () => {
    const record = loopRecord(form, records.length);
    records.push(record);
    list.append(record.element);
    more.disabled = records.length === MOST_RECORDS;
    fewer.disabled = records.length === 1;
  };
  const drop = () => {
    records.pop().element.remove();
    more.disabled = false;
    fewer.disabled = records.length === 1;
  };
  const more = el("button", { type: "button", class: "quiet", onclick: add }, "Add a record");
  const fewer = el("button", { type: "button", class: "quiet", onclick: drop }, "Remove the last record");
  add();
  // The stiffness of a line contact follows from E* and its reference length.
  const offered = Object.entries(PARAMETERS).filter(
    ([name, [, , , ofSphere]]) =>
      (!ofSphere || model.definition.profile.type === "sphere") && !(model.isLine && name === "g_star"),
  );
  const decide = el("input", { type: "checkbox", name: "decide", checked: true });
  // Whoever chooses has decided.
  const choose = () => {
    decide.checked = false;
  };
  const boxes = offered.map(([name, [, , checked]]) =>
    el("input", { type: "checkbox", name, checked, onchange: choose }),
  );
  const known = knownFields(form, offered);
  const noiseField = (name, units, unit) =>
    new NumberField(form, () => `/noise/${name}`, { label: `Noise of the ${name}`, units, unit, optional: true });
  const noise = { force: noiseField("force", FORCE, "mN"), displacement: noiseField("displacement", LENGTH, "nm") };
  const request = () => {
    const given = known.filter(({ value }) => value.value !== undefined);
    const held = given.map(({ name, value, error }) => [name, { value: value.value, standard_error: error.value }]);
    // All records are in the units of the first.
    const units = records[0].units();
    return {
      contact: model.definition,
      loops: records.map((record) => record.value(units)),
      units,
      free: decide.checked ? undefined : boxes.filter((box) => box.checked).map((box) => box.name),
      known: held.length ? Object.fromEntries(held) : undefined,
      noise: valuesOf(noise),
    };
  };

  const chart = new Chart({
    name: "fit",
    title: "Measured and fitted",
    mode: "nearest",
    x: { label: "Displacement", unit: "m" },
    y: { label: "Tangential force F", unit: "N" },
  });
  const left = new Chart({
    name: "left",
    title: "Residual of the fit",
    mode: "nearest",
    height: 200,
    x: { label: "Displacement", unit: "m" },
    y: { label: "Measured less fitted", unit: "N" },
  });
  for (const plot of [chart, left]) {
    plot.more = (_, series) => [series.name];
  }
  const estimates = el("dl", { class: "figures", id: "loop-estimates", "aria-live": "polite" });
  const said = el("p", { class: "note", id: "loop-said" }, "Choose a file or paste columns, and fit.");
  const warnings = warningList("loop-warnings");
  let fitted = null;
  const create = noticing(async () => {
    location.hash = `#/contacts/${(await call("POST", "/contacts", fitted)).id}`;
  });
  const make = el(
    "button",
    { type: "button", id: "create-fitted", hidden: true, onclick: create },
    "Create this contact",
  );
  const show = (reply) => {
    fitted = reply.contact;
    make.hidden = false;
    estimates.replaceChildren(...estimateRows(reply.estimates));
    const { rms, runs } = reply.residual;
    const like = runs.random ? "like noise" : "not like noise";
    const determined = reply.identifiable.flatMap((name, index) => [index ? ", " : "", ...inWords(name)]);
    said.replaceChildren("Determined: ", ...determined, `. Residual ${formatQuantity(rms, "N", 3)} rms, ${like}.`);
    showWarnings(warnings, reply.warnings);
    const line = (name, kind, of, look) => ({
      name,
      kind,
      // Loops are not joined with each other.
      points: reply.curve.flatMap((one) => [...one.displacement.map((x, index) => [x, of(one)[index]]), [0, null]]),
      ...look,
    });
    const dots = reply.curve.every((one) => one.displacement.length <= MOST_DOTS);
    chart.draw({
      series: [
        line("fitted", "now", (one) => one.force),
        line("measured", "points", (one) => one.measured, { dots, size: 1.7 }),
      ],
    });
    const rest = (one) => one.measured.map((force, index) => force - one.force[index]);
    left.draw({
      series: [line("residual", "points", rest, { dots: true, line: false, size: 1.7 })],
      least: { y: [0] },
    });
  };
  const compute = async () => {
    await Promise.all(records.map((record) => record.settled()));
    const question = records.map((record) => record.question()).find((asked) => asked !== undefined);
    form.rest.textContent = question ?? "";
    if (question) return;
    show(await call("POST", "/fit", request(), model.signal));
    withdrawNotice();
  };
  const made = study({
    name: "loop",
    button: "Fit",
    title: "Fit a measured loop",
    text: "Force over displacement of a bench, for this contact: its friction and stiffness, with their intervals.",
    form,
    parts: [
      list,
      el("p", { class: "row" }, more, fewer),
      el(
        "fieldset",
        {},
        el("legend", {}, "Quantities to fit"),
        el("p", {}, el("label", {}, decide, " What the loops determine, or of these:")),
        el("div", { class: "row" }, ...boxes.map((box) => el("label", {}, box, ` ${PARAMETERS[box.name][0]}`))),
      ),
      el(
        "details",
        {},
        el("summary", {}, "Known values, and the noise"),
        el(
          "p",
          { class: "note" },
          "With a standard error a known value takes part in the fit; without one it is held fixed.",
        ),
        ...known.map((one) => one.element),
        ...Object.values(noise).map((one) => one.element),
      ),
    ],
    charts: [chart, left],
    signal: model.signal,
    compute,
    calls: () => [{ method: "POST", path: "/fit", body: request() }],
  });
  const results = el(
    "section",
    { class: "card", "aria-label": "Results of the fit" },
    el("h2", {}, "Results of the fit"),
    estimates,
    said,
    warnings,
    make,
    chart.element,
    left.element,
  );
  return { form: made, results: { element: results } };
}
