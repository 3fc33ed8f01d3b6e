// The requests behind what is on screen, in Python with the package `stickslip`.

/** Methods of a client whose names are not the paths of their computations. */
const METHODS = { "/profiles/fit": "fit_profile" };
/** Members whose own members are keywords of the methods. */
const FLATTENED = ["path", "drive", "criteria"];
/** What a contact is asked for by a body. */
const OF_CONTACT = ["move", "path", "relax", "subsurface", "cycle", "fretting"];

/** A value as Python writes it. */
function literal(value) {
  if (value === null || value === undefined) return "None";
  if (typeof value === "boolean") return value ? "True" : "False";
  if (Array.isArray(value)) return `[${value.map(literal).join(", ")}]`;
  if (typeof value !== "object") return JSON.stringify(value);
  const members = Object.entries(value).filter(([, member]) => member !== undefined);
  return `{${members.map(([name, member]) => `${JSON.stringify(name)}: ${literal(member)}`).join(", ")}}`;
}

/** Members as keywords of a method, those of `path` and its like among them. */
function keywords(members) {
  const flat = Object.entries(members).flatMap(([name, value]) =>
    FLATTENED.includes(name) && value && typeof value === "object" ? Object.entries(value) : [[name, value]],
  );
  return flat.filter(([, value]) => value !== undefined).map(([name, value]) => `${name}=${literal(value)}`);
}

/** A parameter of a query as a value. */
function parameter([name, text]) {
  const isList = ["fields", "displacement", "force", "radii"].includes(name);
  const one = (word) =>
    word === "true" ? true : word === "false" ? false : Number.isNaN(Number(word)) ? word : Number(word);
  return [name, isList ? text.split(",").map(one) : one(text)];
}

/** The lines for `{ method, path, body }`.
 *  @param {{ path: string; body?: Record<string, any> }} call */
function lines({ path, body = {} }) {
  const [place, query = ""] = path.split("?");
  const [, first, id, name = ""] = place.split("/");
  const asked = Object.fromEntries([...new URLSearchParams(query)].map(parameter));
  const { contact, ...members } = body;
  if (first !== "contacts") {
    const given = [...(contact ? [literal(contact)] : []), ...keywords(members)];
    return [`print(api.${METHODS[place] ?? first}(${given.join(", ")}))`];
  }
  if (!id) {
    if (Object.keys(body).length)
      return [`contact = api.Contact.from_definition(${literal(body)})`, "print(contact.summary)"];
    return ["for contact in api.contacts(newest_first=True):", "    print(contact.id, contact.label)"];
  }
  const open = `contact = api.open(${JSON.stringify(id)})`;
  if (!name) return [open, "print(contact.state)"];
  const given = keywords(OF_CONTACT.includes(name) ? { ...asked, ...body } : asked);
  // The pages of a history are read as they are needed.
  const method = name === "history" ? "history()" : `${name}(${given.join(", ")})`;
  return [open, `print(contact.${method})`];
}

/** A program for the calls, for a service at an address, with a key or without one. */
export function pythonCode(calls, base, hasKey) {
  const key = hasKey ? ', key=os.environ["STICKSLIP_KEY"]' : "";
  const imports = [...(hasKey ? ["import os", ""] : []), "import stickslip as ss"];
  const head = [...imports, "", `api = ss.connect(${JSON.stringify(base)}${key})`];
  const written = [];
  for (const line of calls.flatMap(lines)) {
    // Calls of one contact open it once.
    if (line.startsWith("contact = api.open") && written.includes(line)) continue;
    written.push(line);
  }
  return [...head, ...written].join("\n");
}
