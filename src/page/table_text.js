// Columns of text, pasted from a spreadsheet or read from a file of an instrument.

/** The rows of cells in a text; comments, and lines before the first number, are left out. */
export function tableRows(text) {
  const lines = text
    .split("\n")
    .map((line) => line.trim())
    .filter((line) => line && !line.startsWith("#"));
  // Lines before the first number are a header.
  const rows = lines.slice(Math.max(0, lines.findIndex((line) => /^[+−-]?[\d.,]/.test(line))));
  return rows.map(cellsOf);
}

/** The cells of a line. Where something else separates them, a comma between digits is a decimal comma; an empty cell keeps its
 *  place. */
function cellsOf(line) {
  const separator = [";", "\t"].find((one) => line.includes(one));
  if (separator) return line.split(separator).map((cell) => cell.trim());
  const isSpaced = /\s/.test(line.replace(/,\s+/g, ""));
  return (isSpaced ? line.split(/\s+/) : line.split(",")).map((cell) => cell.trim().replace(/,$/, ""));
}

/** How headers name a quantity, beside its own name; and what they may say that makes it another one. */
const NAMES = {
  displacement: [/displacement|position|stroke|deflection|^\s*[ux]\b/i, /error/i],
  force: [/force|friction|^\s*f(_?[xt])?\b/i, /normal/i],
  time: [/time|^\s*t\b/i, /$^/],
  radius: [/lateral|radius|^\s*[xr]\b/i, /$^/],
  height: [/height|topography|^\s*z\b/i, /$^/],
};

/** The cells of the last line before the first number, which name the columns; none where there is no such line. */
export function headerOf(text) {
  const lines = text.split("\n").map((line) => line.trim().replace(/^#\s*/, ""));
  const first = lines.findIndex((line) => /^[+−-]?[\d.,]/.test(line));
  const header = lines.slice(0, Math.max(0, first)).findLast((line) => Object.values(NAMES).some(([is]) => is.test(line)));
  return header ? header.split(/[\t;]/.test(header) ? /[\t;]/ : ",") : [];
}

/** The column whose header names a quantity, counted from 1, and its unit if the header has one. */
export function guessColumn(text, quantity) {
  const cells = headerOf(text);
  const [is, isNot] = NAMES[quantity];
  const column = cells.findIndex((cell) => is.test(cell) && !isNot.test(cell));
  if (column < 0) return null;
  const [unit] = cells[column].replace(/[µμ]/, "u").match(/\b([munk]?N|[mun]?m|s)\b/) ?? [];
  return { column: column + 1, unit };
}

/** The text of a file: UTF-8 or UTF-16 by its byte order mark or its zeros, and Windows’ Latin-1 where it is not UTF-8. */
export async function textOf(file) {
  const bytes = new Uint8Array(await file.arrayBuffer());
  const marked = { "255,254": "utf-16le", "254,255": "utf-16be" }[bytes.slice(0, 2).join()];
  const zeros = bytes.slice(0, 4).map((byte) => (byte === 0 ? 1 : 0)).join("");
  const encoding = marked ?? { "0101": "utf-16le", 1010: "utf-16be" }[zeros];
  if (encoding) return new TextDecoder(encoding).decode(bytes);
  try {
    return new TextDecoder("utf-8", { fatal: true }).decode(bytes);
  } catch {
    return new TextDecoder("windows-1252").decode(bytes);
  }
}

/** A control to choose a file, whose text goes into the field `control`, as does that of a file which is dropped on it. */
export function fileInput(control) {
  const open = async (file) => {
    if (!file) return;
    control.value = await textOf(file);
    control.dispatchEvent(new Event("input", { bubbles: true }));
  };
  control.addEventListener("dragover", (event) => event.preventDefault());
  control.addEventListener("drop", async (event) => {
    if (!event.dataTransfer.files.length) return;
    event.preventDefault();
    await open(event.dataTransfer.files[0]);
  });
  const input = document.createElement("input");
  input.type = "file";
  input.addEventListener("change", (event) => open(event.target.files[0]));
  return input;
}
