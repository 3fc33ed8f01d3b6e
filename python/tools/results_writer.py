"""Writes `results.py`, the classes of replies, and `schemas.py`, the fields of all that replies hold."""

from __future__ import annotations

import textwrap

from openapi_schemas import (
    Schema,
    attribute,
    class_of,
    closure,
    fields,
    is_object,
    kinds,
    name_of,
    operations,
    reply_of,
    request_of,
    unit,
    without_null,
)

#: Classes of the package that give a reply more than its fields.
BASES = {"FrettingReply": "Fretting", "SweepReply": "Swept", "UncertainOutput": "Uncertain"}
#: Numbers that every contact has but one that is twisted: whoever twists it knows that it has others in their place.
UNTWISTED = {("State", "displacement"), ("State", "force")}
#: What has a class without being a reply of its own, or the first shape of one.
PARTS = (
    "Accuracy",
    "Figures",
    "PlanarReply",
    "PlanarState",
    "SessionSummary",
    "State",
    "StateEvent",
    "UncertainOutput",
    "UncertaintyReply",
)
#: Replies that no method returns: pages of what is iterated over, files that are read in process, and jobs.
UNSEEN = ("NewSession", "SessionPage", "LoopFileReply", "ScanFileReply", "JobReply", "JobList", "ContactDefinition")
#: The members whose items are the rows of a table, in order of preference.
ROWS = ("rows", "cycles", "steps", "peaks", "items", "curve", "points")


def reply_schemas(api: Schema) -> list[str]:
    """The objects that replies hold, but for those that are requests too."""
    schemas = api["components"]["schemas"]
    requests = closure({request_of(one) for *_, one in operations(api)} - {""}, schemas)
    replies = closure({reply_of(one) for *_, one in operations(api)} - {""} | {"StateEvent"}, schemas)
    return sorted(name for name in replies - requests if is_object(schemas[name]))


def result_classes(api: Schema) -> list[str]:
    """The replies that methods return, and the parts of them that have a class."""
    replies = {class_of(one, api["components"]["schemas"]) for *_, one in operations(api)} - {"", *UNSEEN}
    return sorted(replies & set(reply_schemas(api)) | set(PARTS))


def rows_of(schema: Schema, schemas: Schema, records: set[str]) -> str | None:
    """The member whose items are the rows of a reply."""
    members, _ = fields(schema, schemas)
    lists = [name for name, member in members.items() if name_of(member.get("items", {})) in records]
    return next((name for name in ROWS if name in lists), None)


def kind(schema: Schema, records: set[str]) -> str:
    """How a member is read: `""` as it is, `[]` numbers, `#` whole numbers, `?` flags, or records by their names."""
    schema = without_null(schema)
    if name_of(schema) in records:
        return name_of(schema)
    if "array" in kinds(schema) and "number" not in kinds(schema):
        inner = schema["items"]
        if name_of(inner) in records:
            return f"[{name_of(inner)}]"
        found = kinds(inner)
        return "[]" if "number" in found else "#" if "integer" in found else "?" if "boolean" in found else ""
    if isinstance(schema.get("additionalProperties"), dict):
        inner = kind(schema["additionalProperties"], records)
        return f"{{{inner}}}" if inner else ""
    return ""


def schemas_file(api: Schema) -> str:
    schemas, names = api["components"]["schemas"], reply_schemas(api)
    records = set(names)
    table, rows = {}, {}
    for name in names:
        members, _ = fields(schemas[name], schemas)
        table[name] = {}
        for member, schema in members.items():
            integer = "integer" in kinds(schema) or "integer" in kinds(schema.get("items", {}))
            stated = "1" if integer else unit(schema.get("description", ""))
            table[name][member] = (kind(schema, records), stated)
        found = rows_of(schemas[name], schemas, records)
        if found:
            rows[name] = found
    return (
        '"""The fields of replies: how each is read, and its unit. Written by `tools/generate.py`."""\n\n'
        "from __future__ import annotations\n\n"
        "#: The fields of each object, with how they are read (`result.py`) and their units.\n"
        f"FIELDS: dict[str, dict[str, tuple[str, str | None]]] = {shown(table)}\n\n"
        "#: The member whose items are the rows of a table.\n"
        f"ROWS: dict[str, str] = {shown(rows)}\n"
    )


def shown(value: object, indent: str = "") -> str:
    """A dictionary or list with an item in each line."""
    if isinstance(value, dict) and value:
        items = [f"{indent}    {shown(key)}: {shown(item, indent + '    ')}," for key, item in value.items()]
        return "\n".join(["{", *items, f"{indent}}}"])
    if isinstance(value, list) and value:
        return "\n".join(["[", *(f"{indent}    {shown(item)}," for item in value), f"{indent}]"])
    return repr(value).replace("'", '"')


def annotation(schema: Schema, records: set[str], classes: set[str], enums: set[str]) -> str:
    """The type of a member."""
    null = " | None" if without_null(schema) is not schema or "null" in kinds(schema) else ""
    schema = without_null(schema)
    name = name_of(schema)
    if name in enums:
        return f"types.{name}{null}"
    found = kind(schema, records)
    if found in ("[]", "#", "?"):
        return {"[]": "Floats", "#": "Counts", "?": "Flags"}[found] + null
    if found == "{[]}":
        return f"dict[str, Floats]{null}"
    inner = found.strip("[]{}")
    if inner:
        inner = inner if inner in classes else "Record"
        pattern = {"[": "Rows[{}]", "{": "Named[{}]"}.get(found[0], "{}")
        return pattern.format(inner) + null
    scalars = {"number": "float", "integer": "int", "string": "str", "boolean": "bool"}
    single = [scalars[one] for one in kinds(schema) if one in scalars]
    if "array" in kinds(schema) and not single:
        return "list[Any]" + null
    if single == ["float"] and "array" in kinds(schema):
        return "float | Floats" + null
    return (single[0] if len(single) == 1 and "array" not in kinds(schema) else "Any") + null


def wrapped(text: str, indent: str) -> str:
    """A docstring of one paragraph."""
    text = " ".join(text.split()).replace("\\", "\\\\")
    if len(indent) + len(text) + 6 <= 120:
        return f'{indent}"""{text}"""'
    lines = textwrap.wrap(text, 116 - len(indent))
    return f'{indent}"""' + f"\n{indent}".join(lines) + f'\n{indent}"""'


def results_file(api: Schema) -> str:
    schemas = api["components"]["schemas"]
    records, classes = set(reply_schemas(api)), result_classes(api)
    enums = {name for name, schema in schemas.items() if "enum" in schema}
    text = [
        '"""The replies as objects. Units are SI. Written by `tools/generate.py`.\n\n'
        "Arrays of numbers are NumPy arrays, in which NaN stands where a number is infinite or missing; a single\n"
        "one is None there. A result whose items are rows has their columns as arrays too. What has no class of its\n"
        'own is a `Record` with its fields as attributes.\n"""\n',
        "from __future__ import annotations\n",
        "from typing import TYPE_CHECKING, Any\n",
        "from . import request_types as types",
        "from .extras import Fretting, Swept, Uncertain",
        "from .result import Counts, Flags, Floats, Named, Record, Result, Rows, Texts\n",
    ]
    for name in classes:
        members, required = fields(schemas[name], schemas)
        text += [f"\nclass {name}({BASES.get(name, 'Result')}):", summary(schemas[name].get("description", name))]
        for member in sorted(members, key=lambda one: (one not in required, list(members).index(one))):
            shape = annotation(members[member], records, set(classes), enums)
            if (name, member) in UNTWISTED:
                shape = shape.removesuffix(" | None")
            elif member not in required and not shape.endswith("| None") and shape != "Any":
                shape += " | None"
            text.append(f"\n    {attribute(member)}: {shape}")
            if "description" in members[member]:
                text.append(wrapped(members[member]["description"], "    "))
        text += columns(schemas[name], schemas, records, enums)
        text.append("")
    text.append(f"\nNAMES = {shown(classes)}")
    return "\n".join(text) + "\n"


def columns(schema: Schema, schemas: Schema, records: set[str], enums: set[str]) -> list[str]:
    """The columns of the rows of a reply, which it has as arrays."""
    found = rows_of(schema, schemas, records)
    if found is None:
        return []
    own, _ = fields(schema, schemas)
    members, _ = fields(schemas[name_of(own[found]["items"])], schemas)
    text = ["\n    if TYPE_CHECKING:"]
    for name, member in members.items():
        array = {"number": "Floats", "integer": "Counts", "string": "Texts"}
        shape = (
            "Texts" if name_of(member) in enums else next((array[one] for one in kinds(member) if one in array), None)
        )
        if name in own or shape is None:
            continue
        text += [f"\n        @property\n        def {attribute(name)}(self) -> {shape}:"]
        text += [wrapped(f"Of each row: {member.get('description', name)}", " " * 12)]
    return text if len(text) > 1 else []


def summary(text: str, indent: str = "    ") -> str:
    """A docstring whose first line is a sentence."""
    first, body = sentences(text)
    if not body:
        return f'{indent}"""{first}"""'
    lines = "".join(f"\n{indent}{line}" for line in textwrap.wrap(body, 116 - len(indent)))
    return f'{indent}"""{first}\n{lines}\n{indent}"""'


def sentences(text: str) -> tuple[str, str]:
    """The first sentence, or the part of it that fits in a line, and what follows."""
    text = " ".join(text.split()).replace("\\", "\\\\")
    if not text.endswith("."):
        text += "."
    first, dot, rest = text.partition(". ")
    if not dot:
        first, rest = text.removesuffix("."), ""
    if len(first) > 108:
        for mark in (": ", "; ", ", "):
            at = first.rfind(mark, 0, 108)
            if at > 0:
                rest = first[at + 2 :][:1].upper() + first[at + 3 :] + "." + (" " + rest if rest else "")
                return first[:at] + ".", rest
    return first + ".", rest
