// A few words for making elements, and for telling people something.

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

let silence;

/** Shows a message for a while. */
export function notice(text, fault = false) {
  const box = document.getElementById("notice");
  box.textContent = text;
  box.classList.toggle("fault", fault);
  box.hidden = false;
  clearTimeout(silence);
  silence = setTimeout(() => { box.hidden = true; }, 6000);
}

/** Runs `work` again and again when asked, never twice at a time; of requests meanwhile the last counts. */
export function latest(work) {
  let busy = false;
  let next = null;
  return async function ask(...args) {
    if (busy) { next = args; return; }
    busy = true;
    try {
      for (next = args; next;) {
        const now = next;
        next = null;
        await work(...now);
      }
    } finally { busy = false; }
  };
}

/** Calls `work` once nothing has been asked for `time` ms. */
export function settled(work, time) {
  let timer;
  return (...args) => { clearTimeout(timer); timer = setTimeout(work, time, ...args); };
}

/** Hands a text over as a file. */
export function save(name, type, text) {
  const url = URL.createObjectURL(new Blob([text], { type }));
  el("a", { href: url, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(url), 10000);
}
