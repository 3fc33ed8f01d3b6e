"""What the generator reads of the OpenAPI document: schemas, their fields, units and names."""

from __future__ import annotations

import json
import keyword
import re
from collections.abc import Iterator
from itertools import chain
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
Schema = dict[str, Any]
#: Units of fields, longer ones before those that they begin with, as in `docs/reference.md`.
UNITS = [
    *("N²/m³", "W/(m·K)", "W/K", "Ω·m", "N·m", "rad", "N/m²", "S", "J/m²", "Pa/N", "N/m", "m/N", "m/s", "m^(1−n)"),
    *("Pa", "Hz", "kg", "N", "J", "m³", "m", "s", "degrees"),
]
_STATED = re.compile(", (?:(pure numbers?|a pure number)|(" + "|".join(map(re.escape, UNITS)) + r"))(?![\w/²^'′])")
METHODS = ("get", "post", "put", "patch", "delete")


def document() -> Schema:
    found: Schema = json.loads((ROOT / "openapi" / "openapi.json").read_text())
    return found


def name_of(schema: Schema) -> str:
    """The name of the schema that is referred to."""
    return str(schema.get("$ref", "")).rpartition("/")[2]


def references(part: Any) -> Iterator[str]:
    if isinstance(part, dict):
        if "$ref" in part:
            yield name_of(part)
        for item in part.values():
            yield from references(item)
    elif isinstance(part, list):
        for item in part:
            yield from references(item)


def closure(names: set[str], schemas: Schema) -> set[str]:
    """These schemas and all that they refer to."""
    found, left = set[str](), list(names)
    while left:
        name = left.pop()
        if name not in found:
            found.add(name)
            left += references(schemas[name])
    return found


def operations(api: Schema) -> Iterator[tuple[str, str, Schema]]:
    for path, methods in api["paths"].items():
        for method, operation in methods.items():
            if method in METHODS:
                yield path, method, operation


def request_of(operation: Schema) -> str:
    """The schema of the JSON body."""
    content = operation.get("requestBody", {}).get("content", {})
    return name_of(content.get("application/json", {}).get("schema", {}))


def reply_of(operation: Schema) -> str:
    """The schema of a successful JSON reply."""
    for status, response in operation["responses"].items():
        schema = response.get("content", {}).get("application/json", {}).get("schema", {})
        if status.startswith("2") and schema:
            return name_of(schema)
    return ""


def class_of(operation: Schema, schemas: Schema) -> str:
    """The schema that is the class of the reply: of replies of several shapes, the first."""
    name = reply_of(operation)
    schema = schemas.get(name, {})
    shapes = schema.get("anyOf", []) or schema.get("oneOf", [])
    return name_of(shapes[0]) if shapes else name


def is_object(schema: Schema) -> bool:
    return "properties" in schema or "allOf" in schema


def fields(schema: Schema, schemas: Schema) -> tuple[dict[str, Schema], set[str]]:
    """The members of an object, and those that are always there."""
    properties, required = dict(schema.get("properties", {})), set(schema.get("required", []))
    for part in schema.get("allOf", []):
        more, needed = fields(schemas[name_of(part)] if "$ref" in part else part, schemas)
        properties |= more
        required |= needed
    return properties, required


def kinds(schema: Schema) -> list[str]:
    """The JSON types of a schema."""
    found = schema.get("type", [])
    return [found] if isinstance(found, str) else list(found)


def without_null(schema: Schema) -> Schema:
    """A reference that may be null, without that."""
    choices = [one for one in schema.get("oneOf", schema.get("anyOf", [])) if one.get("type") != "null"]
    return choices[0] if len(choices) == 1 else schema


def words_of(schema: Schema, schemas: Schema) -> list[str]:
    """The words that a value may be, or each item of a list; empty if it may be others too."""
    schema = without_null(schema)
    if "items" in schema:
        return words_of(schema["items"], schemas)
    name = name_of(schema)
    if name:
        return words_of(schemas[name], schemas)
    if "enum" in schema:
        return [word for word in schema["enum"] if isinstance(word, str)]
    choices = schema.get("oneOf", [])
    found = [words_of(choice, schemas) for choice in choices] if all("enum" in one for one in choices) else []
    return [word for words in found for word in words]


def members_of(schema: Schema, schemas: Schema) -> tuple[list[str], list[str]]:
    """The members that an object needs, and those that it may have."""
    name = name_of(without_null(schema))
    members, required = fields(schemas.get(name, {}), schemas) if name else ({}, set())
    return [one for one in members if one in required], [one for one in members if one not in required]


def inner_members(schema: Schema, schemas: Schema) -> str:
    """What the members of an object that are objects themselves have, in a sentence."""
    name = name_of(without_null(schema))
    if not name:
        return ""
    parts = []
    for member, what in fields(schemas[name], schemas)[0].items():
        inner = schemas.get(name_of(without_null(what)), {})
        choices = inner.get("oneOf", [inner] if len(inner.get("properties", {})) == 1 else [])
        given = [(one, part) for choice in choices for one, part in choice.get("properties", {}).items()]
        if given:
            named = [(one, [*chain(*members_of(part, schemas))]) for one, part in given if name_of(part)]
            texts = [f"`{one}` (`{'`, `'.join(names)}`)" for one, names in named]
            parts += [f" `{member}` has {' or '.join(texts)}."] if texts else []
    return "".join(parts)


def unit(description: str) -> str | None:
    """The unit that a description states."""
    found = _STATED.search(" ".join(description.split()))
    if found is None:
        return None
    return "1" if found[1] else found[2]


def attribute(name: str) -> str:
    return f"{name}_" if keyword.iskeyword(name) else name
