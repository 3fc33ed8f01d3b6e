// The requests behind what is on screen, as commands for curl and as Python with requests.
import { hasKey } from "./api.js";
import { notice } from "./dom.js";
import { menuEntry, popupMenu } from "./popup_menu.js";

const base = () => new URL(".", location.href).href.replace(/[?#].*$/, "").replace(/\/$/, "");

const shellQuoted = (text) => `'${text.replaceAll("'", "'\\''")}'`;

/** Calls `{ method, path, body }` for a shell. */
export function curl(calls) {
  const key = hasKey() ? ' -H "authorization: Bearer $STICKSLIP_KEY"' : "";
  return calls
    .map(({ method, path, body }) => {
      const verb = method === "GET" || (body !== undefined && method === "POST") ? "" : ` -X ${method}`;
      const data =
        body === undefined ? "" : ` \\\n  -H 'content-type: application/json' -d ${shellQuoted(JSON.stringify(body))}`;
      return `curl -s${verb}${key} ${shellQuoted(base() + path)}${data}`;
    })
    .join("\n\n");
}

/** The same for Python. */
export function python(calls) {
  const head = ["import os", "import requests", "", `base = ${JSON.stringify(base())}`, "session = requests.Session()"];
  if (hasKey()) head.push('session.headers["authorization"] = "Bearer " + os.environ["STICKSLIP_KEY"]');
  else head.splice(0, 1);
  const blocks = calls.map(({ method, path, body }) => {
    const data = body === undefined ? "" : `, json=${pythonLiteral(body)}`;
    const request = `reply = session.${method.toLowerCase()}(base + ${JSON.stringify(path)}${data})`;
    return `\n${request}\nreply.raise_for_status()\nprint(reply.json())`;
  });
  return [...head, ...blocks].join("\n");
}

function pythonLiteral(value) {
  if (value === null || value === undefined) return "None";
  if (typeof value === "boolean") return value ? "True" : "False";
  if (Array.isArray(value)) return `[${value.map(pythonLiteral).join(", ")}]`;
  if (typeof value === "object") {
    const members = Object.entries(value).filter(([, member]) => member !== undefined);
    return `{${members.map(([name, member]) => `${JSON.stringify(name)}: ${pythonLiteral(member)}`).join(", ")}}`;
  }
  return JSON.stringify(value);
}

/** A menu for the requests behind a view, as commands, and for what `more` adds to it. */
export function copyMenu(calls, more = []) {
  const entry = (name, write) => menuEntry(`Copy as ${name}`, () => show(name, write(calls())));
  return popupMenu("Copy or save", { class: "menu copying", id: "copy-menu" }, [
    entry("curl", curl),
    entry("Python", python),
    ...more,
  ]);
}

async function show(name, text) {
  const dialog = /** @type {HTMLDialogElement} */ (document.getElementById("code"));
  dialog.querySelector("h2").textContent = `The requests for ${name}`;
  const area = dialog.querySelector("textarea");
  area.value = text;
  area.rows = Math.min(16, text.split("\n").length + 2);
  dialog.showModal();
  area.select();
  // Without HTTPS there is no clipboard: the text is selected for Ctrl+C.
  try {
    await navigator.clipboard.writeText(text);
    notice(`Copied for ${name}.`);
  } catch {
    notice("Press Ctrl+C to copy.");
  }
}
