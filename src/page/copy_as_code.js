// The requests behind what is on screen, as commands for curl and as Python.
import { hasKey } from "./api.js";
import { notice } from "./dom.js";
import { menuEntry, popupMenu } from "./popup_menu.js";
import { pythonCode } from "./python_code.js";

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

/** A menu for the requests behind a view, as commands, and for what `more` adds to it. */
export function copyMenu(calls, more = []) {
  const entry = (name, write) => menuEntry(`Copy as ${name}`, () => show(name, write(calls())));
  return popupMenu("Copy or save", { class: "menu copying", id: "copy-menu" }, [
    entry("curl", curl),
    entry("Python", (asked) => pythonCode(asked, base(), hasKey())),
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
