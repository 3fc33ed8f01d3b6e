// The parts of the form for the material of the bodies, for a bulk stress, and for the preload.
import { call } from "./api.js";
import { el, mapped } from "./dom.js";
import { Choice, NumberField } from "./form_fields.js";
import { MODULUS, PRELOADS, STRESS_PER_FORCE } from "./form_options.js";

/** The known materials, asked for once. */
let materials;
const knownMaterials = () => (materials ??= call("GET", "/materials").catch(() => []));

const option = ({ name, source }) => el("option", { value: name, title: source }, name);

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
      onchange: async ({ target }) => {
        const found = (await knownMaterials()).find(({ name }) => name === target.value);
        if (!found) return;
        modulus.control.value = String(found.youngs_modulus / 1e9);
        ratio.control.value = String(found.poisson_ratio);
        modulus.choice.value = "9";
      },
    },
    el("option", { value: "" }, "Known material …"),
  );
  knownMaterials().then((all) => known.append(...all.map(option)));
  const element = el("fieldset", {}, el("legend", {}, title), known, modulus.element, ratio.element);
  return { element, value: () => ({ youngs_modulus: modulus.value, poisson_ratio: ratio.value }) };
}

/** The fields of the material. */
export function materialFields(form, changed) {
  const kinds = { two: "Two elastic bodies", rigid: "Elastic on rigid", effective: "Reduced moduli" };
  const choice = new Choice(form, () => "/material", "Elasticity", kinds, "two");
  const fields = el("div", { class: "fields" });
  let read;
  const fill = () => {
    if (choice.value === "effective") {
      const field = (name, label, value) =>
        new NumberField(form, () => `/material/effective/${name}`, { label, units: MODULUS, unit: "GPa", value });
      const star = {
        e_star: field("e_star", "Reduced modulus E*", "115"),
        g_star: field("g_star", "Reduced shear modulus G*", "95"),
      };
      fields.replaceChildren(...Object.values(star).map((one) => one.element));
      read = () => ({ effective: mapped(star, (one) => one.value) });
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

/** The fields of a bulk stress that comes with the tangential force; `offer` says whether the shape may have one. */
export function bulkFields(form) {
  const element = el("div", {});
  let read = () => undefined;
  let isOffered = false;
  const fill = () => {
    const kinds = { none: "None", second: "In the second body", first: "In the first body" };
    const side = new Choice(form, () => "/bulk", "Bulk stress along x that comes with the force", kinds, "none");
    const stress = new NumberField(form, () => "/bulk/stress_per_force", {
      label: "Bulk stress over the tangential force",
      units: STRESS_PER_FORCE,
      unit: "MPa/kN",
      value: "100",
    });
    const note =
      "In phase with the force, at a constant load: it shifts the stick zone off the middle. The constants of both " +
      "bodies must be given.";
    const given = el("div", {}, stress.element, el("p", { class: "note" }, note));
    const fold = () => (given.hidden = stress.isLeftOut = side.value === "none");
    side.control.addEventListener("change", fold);
    fold();
    element.replaceChildren(side.element, given);
    read = () => (given.hidden ? undefined : { body: side.value, stress_per_force: stress.value });
  };
  const offer = (is) => {
    if (is === isOffered) return;
    isOffered = is;
    if (is) return fill();
    element.replaceChildren();
    read = () => undefined;
  };
  return { element, offer, value: () => read() };
}

/** The fields of the preload. */
export function preloadFields(form, changed) {
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
