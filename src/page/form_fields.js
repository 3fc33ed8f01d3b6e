// Fields of a form: a label, a value with its unit, and the fault that the service finds in it.
import { el, withSubscripts } from "./dom.js";
import { parseNumber } from "./units.js";

let count = 0;

/** A field at a JSON pointer, which faults of the service are matched with. */
class Field {
  constructor(form, pointer, label, control, more = []) {
    this.pointer = pointer;
    this.control = control;
    const id = `field-${(count += 1)}`;
    control.id = id;
    control.setAttribute("aria-describedby", `${id}-fault`);
    this.fault = el("p", { class: "fault", id: `${id}-fault` });
    this.element = el(
      "div",
      { class: "field" },
      el("label", { for: id }, withSubscripts(label)),
      el("div", { class: "value" }, control, ...more),
      this.fault,
    );
    form.add(this);
  }

  showFault(text) {
    this.fault.textContent = text ?? "";
    if (text) this.control.setAttribute("aria-invalid", "true");
    else this.control.removeAttribute("aria-invalid");
  }
}

/** A number with its unit. */
export class NumberField extends Field {
  constructor(form, pointer, { label, units, unit, value }) {
    const control = el("input", {
      type: "text",
      inputmode: "decimal",
      autocomplete: "off",
      spellcheck: "false",
      value: value ?? "",
    });
    const choice =
      units &&
      el(
        "select",
        { "aria-label": `Unit of ${label}` },
        units.map(([name, power]) => el("option", { value: power, selected: name === unit }, name)),
      );
    super(form, pointer, label, control, choice ? [choice] : []);
    this.choice = choice;
  }

  /** In SI. */
  get value() {
    return parseNumber(this.control.value, Number(this.choice?.value ?? 0));
  }
}

/** A text. */
export class TextField extends Field {
  constructor(form, pointer, label, control) {
    super(form, pointer, label, control);
  }
  get value() {
    return this.control.value;
  }
}

/** One of several. */
export class Choice extends Field {
  constructor(form, pointer, label, options, value) {
    super(
      form,
      pointer,
      label,
      el(
        "select",
        {},
        Object.entries(options).map(([key, text]) => el("option", { value: key, selected: key === value }, text)),
      ),
    );
  }
  get value() {
    return this.control.value;
  }
}

/** The fields of a form, and the faults that belong to none of them. */
export class Fields {
  constructor() {
    this.all = new Set();
    this.rest = el("p", { class: "fault", role: "alert" });
  }

  add(field) {
    this.all.add(field);
  }

  /** Those that are in the document still. */
  present() {
    for (const field of this.all) if (!field.element.isConnected) this.all.delete(field);
    return [...this.all];
  }

  clear() {
    for (const field of this.present()) field.showFault();
    this.rest.textContent = "";
  }

  /** Places each fault at the field whose pointer it has, or which is nearest above it; `root` is where the form begins. */
  place(refusal, root = "") {
    this.clear();
    const fields = this.present();
    const left = [];
    const detailsOf = new Map();
    for (const { pointer, detail } of refusal.errors ?? []) {
      const own = pointer.startsWith(root) ? pointer.slice(root.length) : pointer;
      const fits = (field) => own === field.pointer() || own.startsWith(`${field.pointer()}/`);
      const [best] = fields.filter(fits).sort((one, two) => two.pointer().length - one.pointer().length);
      if (best)
        detailsOf.set(best, [
          ...(detailsOf.get(best) ?? []),
          own === best.pointer() ? detail : `${own.slice(best.pointer().length + 1)}: ${detail}`,
        ]);
      else left.push(`${own} ${detail}`.trim());
    }
    for (const [field, details] of detailsOf)
      field.showFault(details.slice(0, 3).join("; ") + (details.length > 3 ? `; and ${details.length - 3} more` : ""));
    this.rest.textContent = (left.length || detailsOf.size ? left : [refusal.message]).join("; ");
    return detailsOf.keys().next().value;
  }
}
