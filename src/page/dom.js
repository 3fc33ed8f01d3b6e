// Helpers that make elements, show notices, and limit how often work runs.

/** An element: attributes, handlers (`onclick`), properties (`value`), then children. */
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

/** An element of a drawing. */
export function svg(name, attributes, ...children) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  element.append(...children);
  return element;
}

/** A text whose `_x` are indices, as children of an element. */
export const withSubscripts = (text) =>
  text.split(/(_\w+)/).map((part) => (part.startsWith("_") ? el("sub", {}, part.slice(1)) : part));

/** The same as children of a text in a drawing. */
export function svgWithSubscripts(text) {
  return text
    .split(/_(\w+)/)
    .map((part, index) =>
      index % 2 ? svg("tspan", { class: "index", dy: 4 }, part) : svg("tspan", index ? { dy: -4 } : {}, part),
    );
}

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

/** Hides the message, once what it said is no longer so. */
export function withdrawNotice() {
  document.getElementById("notice").hidden = true;
}

/** Runs `work` on each call, one run at a time; of the calls during a run only the last is kept. */
export function latestOnly(work) {
  let busy = false;
  let next = null;
  return async function ask(...args) {
    next = args;
    if (busy) return;
    busy = true;
    try {
      let failure = null;
      while (next) {
        const now = next;
        next = null;
        failure = null;
        try {
          await work(...now);
        } catch (error) {
          failure = error;
        }
      }
      if (failure) throw failure;
    } finally {
      busy = false;
    }
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

/** Waits for so many ms, or until `signal`. */
export const pause = (time, signal) =>
  new Promise((resolve) => {
    const timer = setTimeout(resolve, time);
    signal?.addEventListener(
      "abort",
      () => {
        clearTimeout(timer);
        resolve();
      },
      { once: true },
    );
  });

/** Saves a text as a file. */
export function save(name, type, text) {
  const url = URL.createObjectURL(new Blob([text], { type }));
  el("a", { href: url, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(url), 10000);
}
