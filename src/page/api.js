// Calls of the public API: the key, problem documents, and the stream of events.

import { answerOf, pause } from "./dom.js";

const KEY = "stickslip-key";
let asking = null;

/** The service did not answer at all, and what was asked may or may not have been done. */
export class Away extends Error {
  constructor() {
    super("The service does not answer. The page will show what was done when it is back.");
  }
}

/** A refusal, with its problem document. */
export class Refusal extends Error {
  constructor(status, problem) {
    super(problem.detail || problem.title || `The service answered ${status}`);
    this.status = status;
    this.code = problem.code;
    this.errors = problem.errors || [];
    /** What a file may mean, if that is the fault. */
    this.candidates = problem.candidates || [];
  }
}

export const hasKey = () => sessionStorage.getItem(KEY) !== null;

/** Asks for a key; concurrent callers get the same answer. */
function askForKey() {
  asking ??= answerOf("key").then((answer) => {
    const form = /** @type {HTMLFormElement} */ (document.querySelector("#key form"));
    const given = answer === "use" ? form.key.value.trim() : "";
    if (given) sessionStorage.setItem(KEY, given);
    form.reset();
    asking = null;
    return given !== "";
  });
  return asking;
}

/** The reply to one request, unless it is a refusal.
 * @param {string} method
 * @param {string} path
 * @param {{ body?: any, headers?: Record<string, string>, signal?: AbortSignal }} [options] */
async function send(method, path, { body, headers = {}, signal } = {}) {
  for (;;) {
    const key = sessionStorage.getItem(KEY);
    /** @type {Record<string, string>} */
    const all = { ...headers };
    if (key) all.authorization = `Bearer ${key}`;
    const isFile = body instanceof Blob;
    if (body !== undefined) all["content-type"] = isFile ? "application/octet-stream" : "application/json";
    const text = body === undefined || isFile ? body : JSON.stringify(body);
    const response = await fetch(path.slice(1), { method, headers: all, body: text, signal, cache: "no-store" }).catch(
      (error) => {
        throw signal?.aborted ? error : new Away();
      },
    );
    if (response.ok) return response;
    // A proxy in front of the service answers for it.
    if (response.status === 502 || response.status === 504) throw new Away();
    if (response.status === 401 && (await askForKey())) continue;
    const problem = await response.json().catch(() => ({}));
    throw new Refusal(response.status, problem);
  }
}

let returning = null;

/** Waits until the service answers again, and says so meanwhile. */
function serviceReturns() {
  returning ??= (async () => {
    const banner = document.getElementById("away");
    banner.hidden = false;
    for (let wait = 500; ; wait = Math.min(2 * wait, 5000)) {
      await pause(wait);
      const answer = await fetch("healthz", { cache: "no-store" }).catch(() => null);
      if (answer?.ok) break;
    }
    banner.hidden = true;
    returning = null;
  })();
  return returning;
}

/** Whether a call changes something, so that it must not be repeated unasked. */
const changes = (method, path) =>
  method !== "GET" && (method !== "POST" || /^\/(contacts|sweep)(?!.*\/subsurface$)/.test(path));

/** One call; the JSON of its reply. A call that is refused because of overload is tried again a few times; one that
 *  changes nothing waits for a service that is away. */
export async function call(method, path, body, signal) {
  for (let attempt = 0; ; attempt += 1) {
    try {
      const response = await send(method, path, { body, signal });
      return response.status === 204 ? null : await response.json();
    } catch (error) {
      if (error instanceof Away) {
        const back = serviceReturns();
        if (changes(method, path)) throw error;
        await back;
        if (signal?.aborted) throw error;
        continue;
      }
      const full = error.status === 503 || error.status === 429;
      if (!full || attempt === 3) throw error;
      await pause(1000 * (attempt + 1), signal);
    }
  }
}

/** All pages of a list, or as many items as `most`. */
export async function pages(path, most, after) {
  const items = [];
  const join = path.includes("?") ? "&" : "?";
  do {
    const page = await call("GET", `${path}${join}limit=1000${after ? `&after=${after}` : ""}`);
    items.push(...page.items);
    after = page.next;
  } while (after !== null && items.length < most);
  return items;
}

/** Follows a contact until `signal` or the end: `take` gets each state, `report` the state of the connection. */
export async function follow(id, last, take, report, signal) {
  for (let wait = 500; !signal.aborted; wait = Math.min(2 * wait, 15000)) {
    try {
      const headers = { accept: "text/event-stream", "last-event-id": String(last) };
      const response = await send("GET", `/contacts/${id}/events`, { headers, signal });
      report("live");
      for await (const { event, data } of events(response.body)) {
        wait = 500;
        if (event === "end" && data.reason !== "stopping") return report(data.reason);
        if (event === "state") {
          last = data.sequence;
          take(data);
        }
      }
    } catch (error) {
      if (signal.aborted) return;
      if (error.status === 404) return report("deleted");
      if (error.status === 401 || error.status === 403) return report("refused");
      if (error instanceof Away) {
        report("waiting");
        await serviceReturns();
        continue;
      }
    }
    report("waiting");
    await pause(wait, signal);
  }
}

/** The events of a stream; comments, and events without data, are skipped. */
async function* events(body) {
  const reader = body.pipeThrough(new TextDecoderStream()).getReader();
  let buffer = "";
  for (;;) {
    const { value, done } = await reader.read();
    if (done) return;
    buffer += value;
    const blocks = buffer.split(/\r?\n\r?\n/);
    buffer = blocks.pop();
    for (const block of blocks) {
      const fields = block
        .split(/\r?\n/)
        .map((line) => line.match(/^(\w+): ?(.*)$/))
        .filter(Boolean);
      const named = (name) =>
        fields
          .filter((field) => field[1] === name)
          .map((field) => field[2])
          .join("\n");
      if (named("data")) yield { event: named("event"), data: JSON.parse(named("data")) };
    }
  }
}
