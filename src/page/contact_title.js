// The name of a contact, which can be changed in place.
import { call } from "./api.js";
import { el, reason } from "./dom.js";

/** The heading, a field in its place, and the button that shows the field. */
export function contactTitle(id, label) {
  const heading = el("h1", {}, label ?? "Unnamed contact");
  const box = el("input", {
    type: "text",
    maxlength: 200,
    autocomplete: "off",
    "aria-label": "Label",
    value: label ?? "",
  });
  const fault = el("p", { class: "fault", role: "alert" });
  const button = el("button", { type: "button", class: "quiet", id: "rename" }, "Rename");
  const edit = (is) => {
    form.hidden = !is;
    heading.hidden = button.hidden = is;
    fault.textContent = "";
    (is ? box : button).focus();
  };
  const save = async (event) => {
    event.preventDefault();
    try {
      const renamed = await call("PATCH", `/contacts/${id}`, { label: box.value.trim() || null });
      heading.textContent = renamed.label ?? "Unnamed contact";
      edit(false);
    } catch (error) {
      fault.textContent = reason(error);
    }
  };
  const form = el(
    "form",
    { class: "row rename", hidden: true, onsubmit: save, onkeydown: (event) => event.key === "Escape" && edit(false) },
    box,
    el("button", { class: "quiet primary" }, "Save"),
    el("button", { type: "button", class: "quiet", onclick: () => edit(false) }, "Cancel"),
    fault,
  );
  button.addEventListener("click", () => edit(true));
  return { heading, form, button };
}
