// The form that creates a contact, and shows its derived values while you type.
import { call } from "./api.js";
import { Chart } from "./chart.js";
import { copyMenu } from "./copy_as_code.js";
import { debounce, el, figure, latestOnly, notice } from "./dom.js";
import { Fields, NumberField, TextField } from "./form_fields.js";
import { WITHOUT_STRESS } from "./form_options.js";
import { isLine, meanPressure, placesOf } from "./line_contact.js";
import { bulkFields, materialFields, preloadFields } from "./material_fields.js";
import { profileFields } from "./profile_fields.js";
import { hasMemory, pronyFields } from "./relaxation.js";
import { conductanceFigures } from "./state_text.js";
import { formatNumber, formatQuantity } from "./units.js";
import { showWarnings, warningList } from "./warning_list.js";

/** Shows the form in `main`. */
export function createForm(main, signal) {
  const form = new Fields();
  const ready = {};
  const ask = debounce(() => derive(), 200);
  const changed = () => {
    if (!ready.now) return;
    bulk.offer(profile.type() === "cylinder");
    ask();
  };

  const label = new TextField(
    form,
    () => "/label",
    "Label (may be left out)",
    el("input", { type: "text", maxlength: 200, autocomplete: "off" }),
  );
  const profile = profileFields(form, () => "/profile", changed);
  const material = materialFields(form, changed);
  const friction = new NumberField(form, () => "/friction", { label: "Coefficient of friction μ", value: "0.3" });
  const memory = pronyFields(form, changed);
  const bulk = bulkFields(form);
  const preload = preloadFields(form, changed);
  const definition = () => ({
    profile: profile.value(),
    material: material.value(),
    friction: friction.value,
    preload: preload.value(),
    bulk: bulk.value(),
    prony: memory.value(),
  });
  const body = () => ({ ...(label.value ? { label: label.value } : {}), ...definition() });

  const figures = el("dl", { class: "figures", "aria-live": "polite" });
  const chart = new Chart({
    name: "preload",
    title: "Pressure at the preload",
    height: 220,
    x: { label: "Radius r", unit: "m" },
    y: { label: "Stress", unit: "Pa" },
  });
  const warnings = warningList();
  const derived = el(
    "section",
    { class: "card derived", "aria-label": "What follows" },
    el("h2", {}, "What follows"),
    figures,
    chart.element,
    warnings,
  );
  const derive = latestOnly(async () => {
    try {
      await form.settled();
      const contact = form.standingIn(definition);
      const drawn = !WITHOUT_STRESS.includes(contact.profile.type) && !hasMemory(contact);
      const stress = drawn ? { stress: { points: 200, fields: ["pressure"] } } : {};
      const reply = await call(
        "POST",
        "/simulate",
        { contact, path: { displacement: [0] }, steps: "last", ...stress },
        signal,
      );
      // What follows is not that of numbers which stand in for others.
      const isMistaken = form.check() !== undefined;
      derived.classList.toggle("stale", isMistaken);
      if (isMistaken) return;
      figures.replaceChildren(...figureList(reply.contact, contact));
      chart.element.hidden = true;
      chart.x.label = isLine(contact) ? "x" : "Radius r";
      if (drawn) chart.draw(pressureData(reply, contact));
      showWarnings(warnings, reply.warnings);
    } catch (error) {
      if (signal.aborted) return;
      derived.classList.add("stale");
      form.place(error, "/contact");
    }
  });
  const submit = async (event) => {
    event.preventDefault();
    await form.settled();
    const mistaken = form.check();
    if (mistaken) {
      mistaken.control.focus();
      return derive();
    }
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
      copyMenu(() => [{ method: "POST", path: "/contacts", body: body() }]),
    ),
    el(
      "form",
      { class: "create", onsubmit: submit, oninput: changed, onchange: changed },
      el("section", { class: "card" }, el("h2", {}, "Shape"), profile.element),
      el(
        "section",
        { class: "card" },
        el("h2", {}, "Bodies"),
        material.element,
        friction.element,
        memory.element,
        bulk.element,
      ),
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

/** The figures of a contact, by name; one that is known by its load curve alone has no pressure. */
export function figureList(figures, definition) {
  const hasStress = !WITHOUT_STRESS.includes(definition.profile.type);
  return [
    figure("Normal force F_N", formatQuantity(figures.normal_force, "N")),
    figure("Indentation d", formatQuantity(figures.indentation, "m")),
    figure(isLine(definition) ? "Half-width a" : "Contact radius a", formatQuantity(figures.contact_radius, "m")),
    ...(hasStress ? [figure("Largest pressure p_max", formatQuantity(figures.max_pressure, "Pa"))] : []),
    figure("Gross slip from u_max", formatQuantity(figures.gross_slip_displacement, "m")),
    figure("Gross slip at μ F_N", formatQuantity(figures.gross_slip_force, "N")),
    figure("Reduced modulus E*", formatQuantity(figures.e_star, "Pa")),
    figure("Stiffness ratio E*/G*", formatNumber(figures.e_star / figures.g_star)),
    ...conductanceFigures(figures),
  ];
}

/** The pressure, and the friction bound. */
function pressureData({ contact: figures, stress }, definition) {
  const { pressure } = stress;
  const points = (factor) =>
    placesOf(stress).map((x, index) => [x, pressure[index] === null ? null : factor * pressure[index]]);
  return {
    series: [
      { name: "pressure p", kind: "pressure", points: points(1) },
      { name: "bound μ p", kind: "bound", points: points(definition.friction) },
    ],
    least: { y: [0] },
    cap: figures.max_pressure === null ? 4 * meanPressure(definition, figures) : undefined,
    empty: "There is no area of contact.",
  };
}
