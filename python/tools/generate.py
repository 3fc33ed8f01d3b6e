"""Writes the classes of replies and of profiles from the OpenAPI document: `python tools/generate.py`.

A test compares what this prints with the files, so that no name or field of the API is missing here.
"""

from __future__ import annotations

import json
import keyword
import sys
import textwrap
from collections.abc import Iterator
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent.parent
#: Classes of the package that give a reply more than its fields.
BASES = {"FrettingReply": "Fretting", "PlanarReply": "Plane", "SweepReply": "Swept"}
METHODS = ("get", "post", "put", "patch", "delete")
Schema = dict[str, Any]


def document() -> Schema:
    path = HERE.parent / "openapi" / "openapi.json"
    found: Schema = json.loads(path.read_text())
    return found


def references(part: Any) -> Iterator[str]:
    if isinstance(part, dict):
        if "$ref" in part:
            yield part["$ref"].rpartition("/")[2]
        for item in part.values():
            yield from references(item)
    elif isinstance(part, list):
        for item in part:
            yield from references(item)


def operations(api: Schema) -> Iterator[Schema]:
    for methods in api["paths"].values():
        for name, operation in methods.items():
            if name in METHODS:
                yield operation


def reply_schemas(api: Schema) -> list[str]:
    """Every object that a successful reply holds, but for those that are requests too."""
    schemas, requests, found = api["components"]["schemas"], set[str](), set[str]()

    def follow(name: str, into: set[str]) -> None:
        if name not in into:
            into.add(name)
            for other in references(schemas[name]):
                follow(other, into)

    for operation in operations(api):
        for name in references(operation.get("requestBody", {})):
            follow(name, requests)
        for status, response in operation["responses"].items():
            if status.startswith("2"):
                for name in references(response.get("content", {})):
                    follow(name, found)
    return sorted(name for name in found - requests if is_object(schemas[name]))


def is_object(schema: Schema) -> bool:
    return "properties" in schema or "allOf" in schema


def fields(schema: Schema, schemas: Schema) -> tuple[dict[str, Schema], set[str]]:
    """The members of an object, and those that are always there."""
    properties, required = dict(schema.get("properties", {})), set(schema.get("required", []))
    for part in schema.get("allOf", []):
        if "$ref" in part:
            part = schemas[part["$ref"].rpartition("/")[2]]
        more, needed = fields(part, schemas)
        properties |= more
        required |= needed
    return properties, required


def scalar(kind: str) -> str:
    return {"number": "float", "integer": "int", "string": "str", "boolean": "bool"}[kind]


def annotation(schema: Schema, classes: set[str]) -> str:
    """The type of a member."""
    if "$ref" in schema:
        name = schema["$ref"].rpartition("/")[2]
        return name if name in classes else "Any"
    kinds = schema.get("type", [])
    kinds = [kinds] if isinstance(kinds, str) else kinds
    null = " | None" if "null" in kinds else ""
    kind = next((kind for kind in kinds if kind != "null"), None)
    if kind == "array":
        inner = schema["items"]
        if isinstance(inner.get("type"), list | str) and "number" in inner["type"]:
            return "Floats" + null
        return f"list[{annotation(inner, classes)}]{null}"
    if kind == "object" and "additionalProperties" in schema:
        return f"dict[str, {annotation(schema['additionalProperties'], classes)}]{null}"
    if kind in ("number", "integer", "string", "boolean"):
        return scalar(kind) + null
    return "Any"


def wrapped(text: str, indent: str) -> str:
    """A docstring of one paragraph."""
    text = " ".join(text.split()).replace("\\", "\\\\")
    if len(indent) + len(text) + 6 <= 120:
        return f'{indent}"""{text}"""'
    lines = textwrap.wrap(text, 116 - len(indent))
    return f'{indent}"""' + f"\n{indent}".join(lines) + f'\n{indent}"""'


def attribute(name: str) -> str:
    return f"{name}_" if keyword.iskeyword(name) else name


def results(api: Schema) -> str:
    schemas = api["components"]["schemas"]
    names = reply_schemas(api)
    classes = set(names)
    text = [
        '"""The replies of the service as objects, one for each schema of the OpenAPI document.\n\n'
        "Units are SI. Arrays of numbers are NumPy arrays, in which NaN stands where a number is infinite or missing.\n"
        'Written by `tools/generate.py`.\n"""\n',
        "from __future__ import annotations\n",
        "from typing import Any\n",
        "from .extras import Fretting, Plane, Swept",
        "from .result import Floats, Result\n",
    ]
    for name in names:
        schema = schemas[name]
        members, required = fields(schema, schemas)
        text.append(f"\nclass {name}({BASES.get(name, 'Result')}):")
        text.append(summary(schema.get("description", name)))
        order = sorted(members, key=lambda member: (member not in required, list(members).index(member)))
        for member in order:
            kind = annotation(members[member], classes)
            optional = member not in required
            if optional and not kind.endswith("| None") and kind != "Any":
                kind += " | None"
            text.append(f"\n    {attribute(member)}: {kind}{' = None' if optional else ''}")
            if "description" in members[member]:
                text.append(wrapped(members[member]["description"], "    "))
        text.append("")
    text.append(f"\nNAMES = {json.dumps(names, indent=4)}".replace("\n]", ",\n]"))
    return "\n".join(text) + "\n"


def summary(text: str) -> str:
    """A docstring whose first line is a sentence."""
    text = " ".join(text.split())
    first, _, rest = text.partition(". ")
    if len(text) <= 108:
        return f'    """{text}"""'
    head = first if first.endswith(".") else first + "."
    lines = textwrap.wrap(head, 112)
    if len(lines) > 1:
        cut = head.replace(": ", ".\n\n    ", 1) if ": " in head[:110] else "\n    ".join(lines)
        return f'    """{cut}' + (" " + rest if rest else "") + '\n    """'
    body = "".join(f"\n    {line}" for line in textwrap.wrap(rest, 112))
    return f'    """{head}\n{body}\n    """' if rest else f'    """{head}"""'


def profiles(api: Schema) -> str:
    schemas = api["components"]["schemas"]
    mapping = schemas["Profile"]["discriminator"]["mapping"]
    text = [
        '"""Shapes of the indenter, one class for each profile of the API. Written by `tools/generate.py`."""\n',
        "from __future__ import annotations\n",
        "from collections.abc import Sequence",
        "from dataclasses import dataclass, fields",
        "from typing import ClassVar\n",
        "from .documents import Document, Quantities, Quantity\n\n",
        "@dataclass(frozen=True, eq=False)",
        "class Profile:",
        '    """A shape of the indenter before it is loaded."""\n',
        '    TYPE: ClassVar[str] = ""\n',
        "    def document(self) -> Document:",
        '        """Its document, with units as they were given."""',
        "        given = {field.name: getattr(self, field.name) for field in fields(self)}",
        '        return {"type": self.TYPE} | {name: value for name, value in given.items() if value is not None}\n',
    ]
    names = []
    for kind, reference in sorted(mapping.items()):
        schema = schemas[reference.rpartition("/")[2]]
        name = "".join(word.capitalize() for word in kind.split("_"))
        names.append(name)
        members, required = fields(schema, schemas)
        text.append("\n@dataclass(frozen=True, eq=False)")
        text.append(f"class {name}(Profile):")
        text.append(summary(schema["description"]))
        text.append(f'\n    TYPE: ClassVar[str] = "{kind}"\n')
        for member in sorted(members, key=lambda one: (one not in required, list(members).index(one))):
            if member == "type":
                continue
            what = members[member]
            if what.get("type") == "number":
                shape = "Quantity"
            elif what.get("type") == "array":
                shape = "Sequence[Profile]" if "$ref" in what["items"] else "Quantities"
            else:
                shape = "str"
            text.append(f"    {member}: {shape}" + ("" if member in required else " | None = None"))
            if "description" in what:
                text.append(wrapped(what["description"], "    "))
        text.append("")
    text.append(f"\n__all__ = {json.dumps(['Profile', *names], indent=4)}".replace("\n]", ",\n]"))
    return "\n".join(text) + "\n"


FILES = {"results.py": results, "profiles.py": profiles}


def main() -> int:
    api = document()
    for name, write in FILES.items():
        (HERE / "stickslip" / name).write_text(write(api))
    return 0


if __name__ == "__main__":
    sys.exit(main())
