// The form that makes a contact, and shows what follows from it as one types.
import { call } from "./api.js";
import { copying } from "./code.js";
import { el, latest, notice, settled, words } from "./dom.js";
import { Choice, Fields, NumberField, TextField } from "./field.js";
import { MATERIALS, MODULUS, PRELOADS } from "./profiles.js";
import { shape } from "./shape.js";
import { plain, shown } from "./units.js";

/** Shows the form in `main`. */
export function create(main, signal) {
  const form = new Fields();
  const ready = {};
  const ask = settled(() => derive(), 200);
  const changed = () => {
    if (ready.now) ask();
  };

  const label = new TextField(
    form,
    () => "/label",
    "Label (may be left out)",
    el("input", { type: "text", maxlength: 200, autocomplete: "off" }),
  );
  const profile = shape(form, () => "/profile", changed);
  const material = materials(form, changed);
  const friction = new NumberField(form, () => "/friction", { label: "Coefficient of friction μ", value: "0.3" });
  const preload = preloads(form, changed);
  const definition = () => ({
    profile: profile.value(),
    material: material.value(),
    friction: friction.value,
    preload: preload.value(),
  });
  const body = () => ({ ...(label.value ? { label: label.value } : {}), ...definition() });

  const figures = el("dl", { class: "figures" });
  const warnings = el("ul", { class: "warnings" });
  const derived = el(
    "section",
    { class: "card derived", "aria-live": "polite", "aria-label": "What follows" },
    el("h2", {}, "What follows"),
    figures,
    warnings,
  );
  const derive = latest(async () => {
    try {
      const reply = await call(
        "POST",
        "/simulate",
        { contact: definition(), path: { displacement: [0] }, steps: "last" },
        signal,
      );
      form.clear();
      derived.classList.remove("stale");
      figures.replaceChildren(...listed(reply.contact));
      warnings.replaceChildren(...reply.warnings.map((warning) => el("li", {}, warning.message)));
    } catch (error) {
      if (signal.aborted) return;
      derived.classList.add("stale");
      form.place(error, "/contact");
    }
  });
  const submit = async (event) => {
    event.preventDefault();
    try {
      const made = await call("POST", "/contacts", body());
      location.hash = `#/contacts/${made.id}`;
    } catch (error) {
      const first = form.place(error);
      (first?.control ?? form.rest).focus?.();
      notice(error.message, true);
    }
  };
  main.replaceChildren(
    el(
      "div",
      { class: "head" },
      el("h1", {}, "New contact"),
      copying(() => [{ method: "POST", path: "/contacts", body: body() }]),
    ),
    el(
      "form",
      { class: "create", onsubmit: submit, oninput: changed, onchange: changed },
      el("section", { class: "card" }, el("h2", {}, "Shape"), profile.element),
      el("section", { class: "card" }, el("h2", {}, "Bodies"), material.element, friction.element),
      el(
        "section",
        { class: "card" },
        el("h2", {}, "Load"),
        preload.element,
        label.element,
        form.rest,
        el("button", { class: "primary", id: "create" }, "Create"),
      ),
      derived,
    ),
  );
  ready.now = true;
  derive();
}

/** The figures of a contact, by name. */
export function listed(figures) {
  const entry = (text, value) => el("div", {}, el("dt", {}, words(text)), el("dd", {}, value));
  return [
    entry("Normal force F_N", shown(figures.normal_force, "N")),
    entry("Indentation d", shown(figures.indentation, "m")),
    entry("Contact radius a", shown(figures.contact_radius, "m")),
    entry("Largest pressure p_max", shown(figures.max_pressure, "Pa")),
    entry("Gross slip from u_max", shown(figures.gross_slip_displacement, "m")),
    entry("Gross slip at μ F_N", shown(figures.gross_slip_force, "N")),
    entry("Reduced modulus E*", shown(figures.e_star, "Pa")),
    entry("Stiffness ratio E*/G*", plain(figures.e_star / figures.g_star)),
  ];
}

function body(form, at, title) {
  const modulus = new NumberField(form, () => `${at}/youngs_modulus`, {
    label: "Young’s modulus E",
    units: MODULUS,
    unit: "GPa",
    value: "210",
  });
  const ratio = new NumberField(form, () => `${at}/poisson_ratio`, { label: "Poisson’s ratio ν", value: "0.3" });
  const known = el(
    "select",
    {
      "aria-label": `${title}: a known material`,
      onchange: ({ target }) => {
        if (!target.value) return;
        [modulus.control.value, ratio.control.value] = MATERIALS[target.value];
        modulus.choice.value = "9";
      },
    },
    el("option", { value: "" }, "Known material …"),
    Object.keys(MATERIALS).map((name) => el("option", { value: name }, name)),
  );
  const element = el("fieldset", {}, el("legend", {}, title), known, modulus.element, ratio.element);
  return { element, value: () => ({ youngs_modulus: modulus.value, poisson_ratio: ratio.value }) };
}

function materials(form, changed) {
  const kinds = { rigid: "One elastic body on a rigid one", two: "Two elastic bodies", effective: "Reduced moduli" };
  const choice = new Choice(form, () => "/material", "Elasticity", kinds, "rigid");
  const fields = el("div", { class: "fields" });
  let read;
  const fill = () => {
    if (choice.value === "effective") {
      const star = ["e_star", "g_star"].map((name, index) => [
        name,
        new NumberField(form, () => `/material/effective/${name}`, {
          label: ["Reduced modulus E*", "Reduced shear modulus G*"][index],
          units: MODULUS,
          unit: "GPa",
          value: ["231", "190"][index],
        }),
      ]);
      fields.replaceChildren(...star.map(([, field]) => field.element));
      read = () => ({ effective: Object.fromEntries(star.map(([name, field]) => [name, field.value])) });
    } else {
      const first = body(form, "/material/bodies/0", "First body");
      const second = choice.value === "two" ? body(form, "/material/bodies/1", "Second body") : null;
      fields.replaceChildren(first.element, ...(second ? [second.element] : []));
      read = () => ({ bodies: [first.value(), second ? second.value() : "rigid"] });
    }
    changed();
  };
  choice.control.addEventListener("change", fill);
  fill();
  return { element: el("div", {}, choice.element, fields), value: () => read() };
}

function preloads(form, changed) {
  const choice = new Choice(
    form,
    () => "/preload",
    "Preload by",
    { normal_force: "normal force", indentation: "indentation", contact_radius: "contact radius" },
    "normal_force",
  );
  const place = el("div", {});
  let field;
  const fill = () => {
    field = new NumberField(form, () => `/preload/${choice.value}`, PRELOADS[choice.value]);
    place.replaceChildren(field.element);
    changed();
  };
  choice.control.addEventListener("change", fill);
  fill();
  return { element: el("div", {}, choice.element, place), value: () => ({ [choice.value]: field.value }) };
}
