// Columns of text, pasted from a spreadsheet or read from a file of an instrument.

/** The rows of cells in a text; comments, and lines before the first number, are left out. */
export function tableRows(text) {
  const lines = text
    .split("\n")
    .map((line) => line.trim())
    .filter((line) => line && !line.startsWith("#"));
  // Lines before the first number are a header.
  const rows = lines.slice(Math.max(0, lines.findIndex((line) => /^[+−-]?[\d.,]/.test(line))));
  // Where something else separates the cells, a comma between digits is a decimal comma.
  return rows.map((line) =>
    (/[\t;]|\s/.test(line.replace(/,\s+/, "")) ? line.split(/[\t;]+|\s+/) : line.split(","))
      .map((cell) => cell.replace(/,$/, ""))
      .filter(Boolean),
  );
}

/** The column whose header names a quantity, counted from 1, and its unit if the header has one. */
export function guessColumn(text, quantity) {
  const lines = text.split("\n").map((line) => line.trim().replace(/^#\s*/, ""));
  const first = lines.findIndex((line) => /^[+−-]?[\d.,]/.test(line));
  const header = lines.slice(0, Math.max(0, first)).findLast((line) => line.toLowerCase().includes(quantity));
  if (!header) return null;
  const cells = header.split(/[\t;]/.test(header) ? /[\t;]/ : ",");
  const column = cells.findIndex((cell) => cell.toLowerCase().includes(quantity));
  const [unit] = cells[column].replace("µ", "u").match(/\b([munk]?N|[mun]?m)\b/) ?? [];
  return { column: column + 1, unit };
}

/** A control to choose a file, whose text goes into the field `control`, as does that of a file which is dropped on it. */
export function fileInput(control) {
  const open = async (file) => {
    if (file) control.value = await file.text();
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
