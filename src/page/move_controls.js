// The controls that move a contact: sliders with number fields.
import { el, withSubscripts } from "./dom.js";
import { unitScale, parseNumber } from "./units.js";

/** A slider with a box. `limits` gives its ends for a state, `send` a new value in SI. */
export function moveControl({ name, label, unit, limits, value, send }) {
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
    { class: "move-control", onsubmit: (event) => event.preventDefault() },
    el("label", { for: `box-${name}` }, withSubscripts(label)),
    el("div", { class: "value" }, box, sign),
    slider,
    fault,
  );
  let ends = [-1, 1];
  let scale = { factor: 1, unit };
  let isDragged = false;

  const showFault = (text) => {
    fault.textContent = text ?? "";
    if (text) box.setAttribute("aria-invalid", "true");
    else box.removeAttribute("aria-invalid");
  };
  const sendValue = async (amount) => {
    try {
      await send(amount);
      showFault();
    } catch (error) {
      showFault(error.errors?.[0]?.detail ?? error.message);
    }
  };
  const enter = () => {
    const power = Math.round(Math.log10(scale.factor));
    const amount = parseNumber(box.value, power);
    if (amount !== undefined) sendValue(amount);
  };
  const sliderValue = () =>
    ends[0] + ((Number(slider.value) - Number(slider.min)) / (slider.max - slider.min)) * (ends[1] - ends[0]);
  slider.addEventListener("pointerdown", () => {
    isDragged = true;
  });
  for (const end of ["pointerup", "pointercancel", "change", "blur"])
    slider.addEventListener(end, () => {
      isDragged = false;
    });
  slider.addEventListener("input", () => {
    const amount = sliderValue();
    box.value = display(amount);
    sendValue(amount);
  });
  box.addEventListener("change", enter);

  const display = (amount) => String(Number((amount / scale.factor).toPrecision(6)));
  /** Shows a state, but does not move a slider that is being dragged. */
  const show = (state) => {
    if (!isDragged) {
      ends = limits(state);
      scale = unitScale(Math.max(Math.abs(ends[0]), Math.abs(ends[1])), unit);
      sign.textContent = scale.unit;
      slider.value = Math.round(((value(state) - ends[0]) / (ends[1] - ends[0])) * 2000 - 1000);
    }
    if (!isDragged && document.activeElement !== box) box.value = display(value(state));
    slider.setAttribute("aria-valuetext", `${display(value(state))} ${scale.unit}`);
  };
  return { element: form, show };
}
