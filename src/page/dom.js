// Helpers that make elements, show notices, and limit how often work runs.
import { MEANINGS } from "./meanings.js";

/** An element: attributes, handlers (`onclick`), properties (`value`), then children.
 * @template {keyof HTMLElementTagNameMap} Name
 * @param {Name} name
 * @param {Record<string, any>} [attributes]
 * @param {...any} children
 * @returns {HTMLElementTagNameMap[Name]} */
export function el(name, attributes = {}, ...children) {
  const element = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (value === undefined || value === null || value === false) continue;
    if (key.startsWith("on")) element.addEventListener(key.slice(2), value);
    else if (key === "value" || key === "checked") element[key] = value;
    else element.setAttribute(key, value === true ? "" : value);
  }
  element.append(...children.flat().filter((child) => child !== null && child !== undefined));
  return element;
}

/** An element of a drawing.
 * @template {keyof SVGElementTagNameMap} Name
 * @param {Name} name
 * @param {Record<string, any>} [attributes]
 * @param {...(Node | string)} children
 * @returns {SVGElementTagNameMap[Name]} */
export function svg(name, attributes = {}, ...children) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  element.append(...children);
  return element;
}

/** A text whose `_x` are indices, as children of an element. */
export const withSubscripts = (text) =>
  text.split(/(_\w+)/).map((part) => (part.startsWith("_") ? el("sub", {}, part.slice(1)) : part));

/** A row in a list of figures, with what it means. */
export const figure = (name, value) =>
  el("div", { title: MEANINGS[name] }, el("dt", {}, withSubscripts(name)), el("dd", {}, value));

/** The same as children of a text in a drawing. */
export function svgWithSubscripts(text) {
  return text
    .split(/_(\w+)/)
    .map((part, index) =>
      index % 2 ? svg("tspan", { class: "index", dy: 4 }, part) : svg("tspan", index ? { dy: -4 } : {}, part),
    );
}

/** The members of an object, each made into another by `make`, which gets it and its name.
 * @template Old, New
 * @param {Record<string, Old>} object
 * @param {(member: Old, name: string) => New} make
 * @returns {Record<string, New>} */
export const mapped = (object, make) =>
  Object.fromEntries(Object.entries(object).map(([name, member]) => [name, make(member, name)]));

let noticeTimer;

/** Shows a message for a while. */
export function notice(text, fault = false) {
  const box = document.getElementById("notice");
  box.textContent = text;
  box.classList.toggle("fault", fault);
  box.hidden = false;
  clearTimeout(noticeTimer);
  noticeTimer = setTimeout(() => {
    box.hidden = true;
  }, 6000);
}

/** What is wrong, in words: the first fault that the service names, or the message. */
export const reason = (error) => error.errors?.[0]?.detail ?? error.message;

/** A handler that does `work`, and shows what went wrong unless `signal` has ended the view. */
export const noticing =
  (work, signal) =>
  async (...args) => {
    try {
      await work(...args);
    } catch (error) {
      if (!signal?.aborted) notice(reason(error), true);
    }
  };

/** Shows a dialog of the page; gives the value of the button that closed it, which is empty unless it has one. */
export function answerOf(id) {
  const dialog = /** @type {HTMLDialogElement} */ (document.getElementById(id));
  dialog.returnValue = "";
  dialog.showModal();
  return new Promise((resolve) => {
    dialog.addEventListener("close", () => resolve(dialog.returnValue), { once: true });
  });
}

/** Hides the message, once what it said is no longer so. */
export function withdrawNotice() {
  document.getElementById("notice").hidden = true;
}

/** Runs `work` on each call, one run at a time; of the calls during a run only the last is kept. The run that is under
 *  way throws what the last of them threw. */
export function latestOnly(work) {
  let busy = false;
  let next = null;
  return async function ask(...args) {
    next = args;
    if (busy) return;
    busy = true;
    let failure = null;
    for (let now = next; now; now = next) {
      next = null;
      failure = await work(...now).then(
        () => null,
        (error) => ({ error }),
      );
    }
    busy = false;
    if (failure) throw failure.error;
  };
}

/** Calls `work` once there was no call for `time` ms. */
export function debounce(work, time) {
  let timer;
  return (...args) => {
    clearTimeout(timer);
    timer = setTimeout(work, time, ...args);
  };
}

/** Waits for so many ms, or until `signal`.
 * @param {number} time
 * @param {AbortSignal} [signal]
 * @returns {Promise<void>} */
export const pause = (time, signal) =>
  new Promise((resolve) => {
    const timer = setTimeout(resolve, time);
    const leave = () => (clearTimeout(timer), resolve());
    signal?.addEventListener("abort", leave, { once: true });
  });

/** Saves a text as a file. */
export function save(name, type, text) {
  const url = URL.createObjectURL(new Blob([text], { type }));
  el("a", { href: url, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(url), 10000);
}
