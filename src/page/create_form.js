// The form that creates a contact, and shows its figures while the user types.
import { call } from "./api.js";
import { Chart } from "./chart.js";
import { copyMenu } from "./copy_as_code.js";
import { debounce, el, figure, latestOnly, notice } from "./dom.js";
import { Fields, NumberField, TextField } from "./form_fields.js";
import { WITHOUT_STRESS } from "./form_options.js";
import { materialFields, preloadFields } from "./material_fields.js";
import { profileFields } from "./profile_fields.js";
import { formatNumber, formatQuantity } from "./units.js";
import { showWarnings, warningList } from "./warning_list.js";

/** Shows the form in `main`. */
export function createForm(main, signal) {
  const form = new Fields();
  const ready = {};
  const ask = debounce(() => derive(), 200);
  const changed = () => {
    if (ready.now) ask();
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
  const preload = preloadFields(form, changed);
  const definition = () => ({
    profile: profile.value(),
    material: material.value(),
    friction: friction.value,
    preload: preload.value(),
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
      const drawn = !WITHOUT_STRESS.includes(contact.profile.type);
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
      figures.replaceChildren(...figureList(reply.contact, drawn));
      chart.element.hidden = true;
      if (drawn) chart.draw(pressureData(reply, Number(friction.value)));
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

/** The figures of a contact, by name; one that is known by its load curve alone has no pressure. */
export function figureList(figures, hasStress = true) {
  return [
    figure("Normal force F_N", formatQuantity(figures.normal_force, "N")),
    figure("Indentation d", formatQuantity(figures.indentation, "m")),
    figure("Contact radius a", formatQuantity(figures.contact_radius, "m")),
    ...(hasStress ? [figure("Largest pressure p_max", formatQuantity(figures.max_pressure, "Pa"))] : []),
    figure("Gross slip from u_max", formatQuantity(figures.gross_slip_displacement, "m")),
    figure("Gross slip at μ F_N", formatQuantity(figures.gross_slip_force, "N")),
    figure("Reduced modulus E*", formatQuantity(figures.e_star, "Pa")),
    figure("Stiffness ratio E*/G*", formatNumber(figures.e_star / figures.g_star)),
  ];
}

/** The pressure, and the friction bound. */
function pressureData({ contact: figures, stress: { radius, pressure } }, coefficient) {
  const mean = figures.normal_force / (Math.PI * figures.contact_radius ** 2);
  const points = (factor) => radius.map((r, index) => [r, pressure[index] === null ? null : factor * pressure[index]]);
  return {
    series: [
      { name: "pressure p", kind: "pressure", points: points(1) },
      { name: "bound μ p", kind: "bound", points: points(coefficient) },
    ],
    least: { y: [0] },
    cap: figures.max_pressure === null ? 4 * mean : undefined,
    empty: "There is no area of contact.",
  };
}
