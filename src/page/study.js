// What cards that ask the service have in common: a form whose faults stand at its fields, and a result that follows
// the state of a contact.
import { call } from "./api.js";
import { debounce, el, noticing, withSubscripts } from "./dom.js";
import { Fields } from "./form_fields.js";
import { showWarnings, warningList } from "./warning_list.js";

/** A card with a form. By default it sends the document that `request` gives to `path`, and shows the figures that
 *  `rows` makes of the reply, its warnings, and what else `show` does, which gets the list of figures too. `compute`
 *  does all of that in their place; it gets a function that shows how much is done. `parts` stand before the button,
 *  and the charts, which appear when they are drawn, after the results. What takes little time `isQuick`: it is
 *  computed when its tab is opened for the first time. */
export function study({ name, button: label = "Compute", title, text, signal, form = new Fields(), ...more }) {
  const { parts = [], charts = [], path, request, rows, show, isQuick = false } = more;
  const figures = el("dl", { class: "figures", id: `${name}-figures`, "aria-live": "polite" });
  const warnings = warningList(`${name}-warnings`);
  const bar = el("progress", { max: 1, value: 0, hidden: true, "aria-label": `Progress: ${title}` });
  const report = (part) => {
    bar.hidden = false;
    bar.value = part;
  };
  const ask = async () => {
    const asked = request();
    const reply = await call("POST", path, asked, signal);
    if (rows) figures.replaceChildren(...rows(reply, asked));
    showWarnings(warnings, reply.warnings);
    await show?.(reply, asked, figures);
  };
  const { compute = ask, calls = () => [{ method: "POST", path, body: request() }] } = more;
  const button = el("button", { class: "primary", id: `compute-${name}` }, label);
  const run = noticing(async () => {
    const mistaken = form.check();
    if (mistaken) return mistaken.control.focus();
    button.disabled = true;
    try {
      await compute(report);
    } catch (error) {
      const first = signal.aborted ? undefined : form.place(error);
      if (!first) throw error;
      first.control.focus();
    } finally {
      button.disabled = false;
      bar.hidden = true;
    }
  }, signal);
  const submit = (event) => {
    event.preventDefault();
    run();
  };
  for (const chart of charts) chart.element.hidden = true;
  const element = el(
    "section",
    { class: "card", id: `${name}-card` },
    el("h2", {}, withSubscripts(title)),
    el("p", {}, withSubscripts(text)),
    el("form", { onsubmit: submit }, ...parts, form.rest, el("p", { class: "row" }, button, bar)),
    ...(rows ? [figures, warnings] : []),
    ...charts.map((chart) => chart.element),
  );
  return { element, charts, calls, first: isQuick ? run : null };
}

/** A function that asks the service what belongs to a state once it has rested for so many ms; a reply counts only for
 *  the question that was asked last. `ask` gets what is to be asked, `show` the reply, and `fail` the error. */
export function latestAnswer(model, rest, { ask, show, fail }) {
  let wanted = null;
  const later = debounce(async (question, asked) => {
    const isStale = () => question !== wanted || model.signal.aborted || model.isGone;
    if (isStale()) return;
    try {
      const reply = await ask(asked);
      if (!isStale()) show(reply, asked);
    } catch (error) {
      if (!isStale()) fail(error);
    }
  }, rest);
  /** Asks if the question is another one; `prepare` gives what is to be asked, or nothing where nothing can be. */
  return (question, prepare) => {
    if (question === wanted) return;
    wanted = question;
    const asked = prepare();
    if (asked !== undefined) later(question, asked);
  };
}
