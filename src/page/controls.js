// What moves a contact: sliders with boxes for numbers.
import { el, words } from "./dom.js";
import { scaled, written } from "./units.js";

/** A slider with a box. `limits` gives its ends for a state, `send` a new value in SI. */
export function knob({ name, label, unit, limits, value, send }) {
  const slider = el("input", {
    type: "range",
    id: `slide-${name}`,
    min: -1000,
    max: 1000,
    step: 1,
    "aria-label": `${label}, slider`,
  });
  const box = el("input", {
    type: "text",
    inputmode: "decimal",
    id: `box-${name}`,
    autocomplete: "off",
    "aria-describedby": `fault-${name}`,
  });
  const sign = el("span", { class: "unit" });
  const fault = el("p", { class: "fault", id: `fault-${name}`, role: "alert" });
  const form = el(
    "form",
    { class: "knob", onsubmit: (event) => event.preventDefault() },
    el("label", { for: `box-${name}` }, words(label)),
    el("div", { class: "value" }, box, sign),
    slider,
    fault,
  );
  let ends = [-1, 1];
  let scale = { factor: 1, unit };
  let held = false;

  const tell = (text) => {
    fault.textContent = text ?? "";
    if (text) box.setAttribute("aria-invalid", "true");
    else box.removeAttribute("aria-invalid");
  };
  const give = async (amount) => {
    try {
      await send(amount);
      tell();
    } catch (error) {
      tell(error.errors?.[0]?.detail ?? error.message);
    }
  };
  const enter = () => {
    const power = Math.round(Math.log10(scale.factor));
    const amount = written(box.value, power);
    if (amount !== undefined) give(amount);
  };
  const slid = () =>
    ends[0] + ((Number(slider.value) - Number(slider.min)) / (slider.max - slider.min)) * (ends[1] - ends[0]);
  slider.addEventListener("pointerdown", () => {
    held = true;
  });
  for (const end of ["pointerup", "pointercancel", "change", "blur"])
    slider.addEventListener(end, () => {
      held = false;
    });
  slider.addEventListener("input", () => {
    const amount = slid();
    box.value = display(amount);
    give(amount);
  });
  box.addEventListener("change", enter);

  const display = (amount) => String(Number((amount / scale.factor).toPrecision(6)));
  /** Shows a state, without taking the slider from under a hand. */
  const show = (state) => {
    if (!held) {
      ends = limits(state);
      scale = scaled(Math.max(Math.abs(ends[0]), Math.abs(ends[1])), unit);
      sign.textContent = scale.unit;
      slider.value = Math.round(((value(state) - ends[0]) / (ends[1] - ends[0])) * 2000 - 1000);
    }
    if (!held && document.activeElement !== box) box.value = display(value(state));
    slider.setAttribute("aria-valuetext", `${display(value(state))} ${scale.unit}`);
  };
  return { element: form, show };
}
