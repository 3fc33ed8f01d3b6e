// Fields of a form: a label, a value with its unit, and the fault that the service finds in it.
import { el, mapped, withSubscripts } from "./dom.js";
import { numberMistake, parseNumber } from "./units.js";

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
    this.form = form;
    /** Whether the form sends nothing of it. */
    this.isLeftOut = false;
    form.add(this);
  }

  /** What is wrong with the text itself, in words. @returns {string | undefined} */
  get mistake() {
    return undefined;
  }

  showFault(text = "") {
    this.fault.textContent = text;
    if (text) this.control.setAttribute("aria-invalid", "true");
    else this.control.removeAttribute("aria-invalid");
  }
}

/** A box for a number. */
export const numberBox = (attributes) =>
  el("input", { type: "text", inputmode: "decimal", autocomplete: "off", spellcheck: "false", ...attributes });

/** The number in a box that is not a field of a form; an error says what is wrong with it. */
export function numberIn(box) {
  const mistake = numberMistake(box.value);
  if (mistake) throw new Error(mistake);
  return parseNumber(box.value);
}

/** A number with its unit. */
export class NumberField extends Field {
  /** @param {Fields} form
   *  @param {() => string} pointer
   *  @param {{ label: string, units?: [string, number][], unit?: string, value?: string, optional?: boolean }} about */
  constructor(form, pointer, { label, units, unit, value, optional = false }) {
    const control = numberBox({ value: value ?? "" });
    const choice =
      units &&
      el(
        "select",
        { "aria-label": `Unit of ${label}` },
        units.map(([name, power]) => el("option", { value: power, selected: name === unit }, name)),
      );
    super(form, pointer, label, control, choice ? [choice] : []);
    this.choice = choice;
    this.initial = value;
    this.isOptional = optional;
  }

  get mistake() {
    const text = this.control.value.trim();
    if (this.isLeftOut) return undefined;
    if (text === "") return this.isOptional ? undefined : "A number is missing here.";
    return numberMistake(text);
  }

  /** In SI. */
  get value() {
    return parseNumber(this.text(), Number(this.choice?.value ?? 0));
  }

  /** What was typed, or what stood there at first while the form asks for the faults of all other fields. */
  text() {
    return this.form.isStandingIn && this.mistake ? (this.initial ?? "") : this.control.value;
  }
}

/** A text. */
export class TextField extends Field {
  get value() {
    return this.control.value;
  }
}

/** A document of JSON. */
export class JsonField extends Field {
  constructor(form, pointer, label, value) {
    super(form, pointer, label, el("textarea", { rows: 4, spellcheck: "false", value }));
  }
  get mistake() {
    return this.value === null && !this.isLeftOut ? "This is not JSON." : undefined;
  }
  /** The document, or nothing where the text is not valid JSON. */
  get value() {
    try {
      return JSON.parse(this.control.value);
    } catch {
      return null;
    }
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

/** The numbers that were given in fields, by name; nothing where a field has no number. */
export function valuesOf(fields) {
  const given = Object.entries(fields).filter(([, field]) => field.value !== undefined);
  return given.length ? mapped(Object.fromEntries(given), (field) => field.value) : undefined;
}

/** The fields of a form, and the faults that belong to none of them. */
export class Fields {
  constructor() {
    this.all = new Set();
    this.readings = [];
    this.rest = el("p", { class: "fault", role: "alert" });
  }

  add(field) {
    this.all.add(field);
  }

  /** Has the form wait for what `settled` promises: the service still reads a table. */
  settle(settled) {
    this.readings.push(settled);
  }

  /** Waits until all tables are read. */
  settled() {
    return Promise.all(this.readings.map((settled) => settled()));
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

  /** Says at each field that has no number what is wrong with it; the first of them, if there is one. */
  check() {
    this.clear();
    const wrong = this.present().filter((field) => field.mistake);
    for (const field of wrong) field.showFault(field.mistake);
    return wrong[0];
  }

  /** What `read` makes of the form with the numbers of the beginning in place of texts that are not numbers, so that
   *  the service finds the faults of the other fields too. */
  standingIn(read) {
    this.isStandingIn = true;
    try {
      return read();
    } finally {
      this.isStandingIn = false;
    }
  }

  /** Places each fault at the field whose pointer it has, or which is nearest above it; `root` is where the form
   *  begins. */
  place(refusal, root = "") {
    const mistaken = this.check();
    const fields = this.present().filter((field) => !field.mistake);
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
    this.rest.textContent = (left.length || detailsOf.size || mistaken ? left : [refusal.message]).join("; ");
    return mistaken ?? detailsOf.keys().next().value;
  }
}
