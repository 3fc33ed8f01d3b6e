// The controls that move a contact: a number in a unit, and a slider. Both say what they will send; Enter sends it, or
// the mouse or finger that releases the slider.
import { el, reason, withSubscripts } from "./dom.js";
import { numberBox } from "./form_fields.js";
import { formatQuantity, inPower, numberMistake, parseNumber, powerOf, unitScale } from "./units.js";

const POSITIONS = 2000;

/** The powers of ten of the units that can be chosen. */
const POWERS = { m: [0, -3, -6, -9, -12], N: [3, 0, -3, -6, -9] };

/** A slider with a box and its unit. `limits` gives the ends for a state, `send` a new value in SI. */
export function moveControl({ name, label, unit, limits, value, send }) {
  const described = { "aria-describedby": `to-send-${name} fault-${name}` };
  const slider = el("input", {
    type: "range",
    id: `slide-${name}`,
    min: 0,
    max: POSITIONS,
    "aria-label": `${label}, slider`,
    ...described,
  });
  const box = numberBox({ id: `box-${name}`, ...described });
  const automatic = el("option", { value: "" });
  const choice = el(
    "select",
    { id: `unit-${name}`, "aria-label": `Unit of ${label}` },
    automatic,
    POWERS[unit].map((power) => el("option", { value: power }, unitScale(10 ** power, unit).unit)),
  );
  const toSend = el("p", { class: "note", id: `to-send-${name}`, "aria-live": "polite" });
  const fault = el("p", { class: "fault", id: `fault-${name}`, role: "alert" });
  let shown = null;
  let ends = [-1, 1];
  let fitting = 0;
  let isPressed = false;
  let isDragged = false;
  let isEdited = false;

  /** The power of ten of the unit: the one that is chosen, or the one that fits the ends of the slider. */
  const power = () => (choice.value === "" ? fitting : Number(choice.value));
  const display = (amount) => inPower(amount, power());
  const showFault = (text) => {
    fault.textContent = text ?? "";
    if (text) box.setAttribute("aria-invalid", "true");
    else box.removeAttribute("aria-invalid");
  };
  const settle = () => {
    isDragged = isEdited = false;
    toSend.textContent = "";
  };
  const commit = async (amount) => {
    const typed = box.value;
    settle();
    try {
      await send(amount);
      showFault();
    } catch (error) {
      showFault(reason(error));
      isEdited = document.activeElement === box;
      // A state that came meanwhile has written over it.
      if (isEdited) box.value = typed;
      show(shown);
    }
  };
  const revert = () => {
    settle();
    show(shown);
  };
  const sliderValue = () => ends[0] + (Number(slider.value) / POSITIONS) * (ends[1] - ends[0]);

  slider.addEventListener("input", () => {
    isDragged = true;
    box.value = display(sliderValue());
    const amount = formatQuantity(sliderValue(), unit);
    slider.setAttribute("aria-valuetext", formatQuantity(sliderValue(), unit, 6));
    toSend.textContent = isPressed ? `Release to send ${amount}.` : `Enter sends ${amount}.`;
  });
  // Each arrow key is a change as well, but the contact must not stop at every step.
  slider.addEventListener("change", () => isPressed && commit(sliderValue()));
  slider.addEventListener("pointerdown", () => {
    isPressed = true;
  });
  const released = () => {
    isPressed = false;
    // Let go where it was taken, it has nothing to send.
    if (isDragged) revert();
  };
  slider.addEventListener("pointerup", () => setTimeout(released));
  slider.addEventListener("pointercancel", released);
  slider.addEventListener("blur", () => isDragged && revert());
  box.addEventListener("input", () => {
    // What is typed stays in the unit that it was typed in.
    choice.value = String(power());
    isEdited = true;
    showFault();
    const amount = parseNumber(box.value, power());
    if (amount === undefined) toSend.textContent = "";
    else if (typeof amount === "string") toSend.textContent = numberMistake(box.value);
    else {
      const typed = `${box.value.trim()} ${choice.selectedOptions[0].textContent}`;
      toSend.textContent = `Enter sends ${typed} = ${amount} ${unit}.`;
    }
  });
  const enter = () => {
    if (isDragged) return commit(sliderValue());
    const amount = parseNumber(box.value, power());
    if (!isEdited || amount === undefined) return;
    if (typeof amount === "number") commit(amount);
    else {
      toSend.textContent = "";
      showFault(numberMistake(box.value));
    }
  };
  for (const control of [slider, box])
    control.addEventListener("keydown", (event) => {
      if (event.key === "Enter") {
        // The key is not one for a dialog that it opens.
        event.preventDefault();
        if (!event.repeat) enter();
      } else if (event.key === "Escape") {
        showFault();
        revert();
      }
    });
  choice.addEventListener("change", revert);

  /** Shows a state, but changes neither a slider that is being dragged nor a number that is being typed. */
  function show(state) {
    // A fault belongs to the state in which it was met.
    if (fault.textContent && state !== shown) {
      showFault();
      settle();
    }
    shown = state;
    if (!isDragged) {
      ends = limits(state);
      const fits = powerOf(Math.max(Math.abs(ends[0]), Math.abs(ends[1])));
      fitting = Math.max(Math.min(fits, POWERS[unit][0]), POWERS[unit].at(-1));
      automatic.textContent = `${unitScale(10 ** fitting, unit).unit} (auto)`;
      slider.value = String(Math.round(((value(state) - ends[0]) / (ends[1] - ends[0])) * POSITIONS));
      if (!isEdited) box.value = display(value(state));
    }
    slider.setAttribute("aria-valuetext", formatQuantity(isDragged ? sliderValue() : value(state), unit, 6));
  }
  const element = el(
    "form",
    { class: "move-control", onsubmit: (event) => event.preventDefault() },
    el("label", { for: `box-${name}` }, withSubscripts(label)),
    el("div", { class: "value" }, box, choice),
    slider,
    toSend,
    fault,
  );
  return { element, show, unit: choice };
}
