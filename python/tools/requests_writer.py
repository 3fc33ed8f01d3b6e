"""Writes what requests are made of: `profiles.py`, `request_types.py` and `members.py`."""

from __future__ import annotations

import json

from openapi_schemas import (
    Schema,
    attribute,
    class_of,
    closure,
    fields,
    kinds,
    name_of,
    operations,
    references,
    request_of,
    unit,
)
from results_writer import result_classes, shown, summary, wrapped

#: Requests whose members are places that have classes too, by the names of these.
PLACES = {"Line": "SubsurfaceLine", "Plane": "SubsurfacePlane", "Surface": "SubsurfaceSurface"}
#: Shapes that may be given by their diameter.
ROUND = ('"sphere"', '"exact_sphere"', '"cylinder"')
#: The method of a computation where it is not the last part of its path.
METHODS = {"/profiles/fit": "fit_profile"}
#: Earlier names of methods, which stay.
ALIASES = {"fit_loop": "fit"}
#: Members whose one number may stand for the whole object, in the order in which they are looked for.
SHORT_MEMBERS = ("reversals", "stiffness", "points", "amplitude")
#: The spelling of units in the table of the engine.
SPELLED = {"degrees": "deg", "J/m²": "J/m^2", "m^(1−n)": ""}


def computations(api: Schema) -> list[tuple[str, Schema]]:
    """The paths of all computations that are given a document and reply with one."""
    schemas, classes = api["components"]["schemas"], result_classes(api)
    posts = [(path, one) for path, method, one in operations(api) if method == "post" and "{" not in path]
    return [(path, one) for path, one in posts if request_of(one) and class_of(one, schemas) in classes]


def alternatives(schema: Schema, schemas: Schema) -> dict[str, Schema]:
    """The members of an object of one key, or of an object."""
    found: dict[str, Schema] = {}
    for choice in schema.get("oneOf", []):
        found |= choice.get("properties", {})
    return found or fields(schema, schemas)[0]


# Units


def members_file(api: Schema) -> str:
    """What is known of the members of requests: their units, and the numbers that stand for objects."""
    schemas = api["components"]["schemas"]
    stated: dict[str, dict[str, str]] = {}

    def visit(schema: Schema, parent: str, seen: tuple[str, ...]) -> None:
        name = name_of(schema)
        if name in seen:
            return
        schema = schemas[name] if name else schema
        seen += (name,) if name else ()
        for choice in schema.get("oneOf", []):
            visit(choice, parent, seen)
        for member, inner in schema.get("properties", {}).items():
            if {"number", "array"} & set(kinds(inner)) and (found := unit(inner.get("description", ""))):
                stated.setdefault(member, {})[parent] = SPELLED.get(found, found)
            for part in (inner, inner.get("items", {})):
                visit(part, member, seen)

    for *_, operation in operations(api):
        if request_of(operation):
            visit({"$ref": f"/{request_of(operation)}"}, "", ())
    members = {name: next(iter(found.values())) for name, found in stated.items() if len(set(found.values())) == 1}
    within = {
        (parent, name): one for name, found in stated.items() if name not in members for parent, one in found.items()
    }
    places = schemas["StressRequest"]["properties"]["radii"]["maxItems"]
    return (
        '"""The members of requests: their units, and what stands for them. Written by `tools/generate.py`."""\n\n'
        "from __future__ import annotations\n\n"
        "#: The SI unit of each number by the name of its member.\n"
        f"MEMBERS: dict[str, str] = {shown(dict(sorted(members.items())))}\n\n"
        "#: Where the same name has several units: that within the member around it.\n"
        f"WITHIN: dict[tuple[str, str], str] = {shown(dict(sorted(within.items())))}\n\n"
        "#: The members for which one number may stand, and which of theirs it is.\n"
        f"SHORT: dict[str, str] = {shown(dict(sorted(shorthands(schemas).items())))}\n\n"
        "#: The members whose object may be empty, so that True asks for them.\n"
        f"EMPTY: frozenset[str] = frozenset(\n    {shown(sorted(may_be_empty(schemas)), '    ')}\n)\n\n"
        "#: The most radii, or places along a line, at which stresses are asked for.\n"
        f"MOST_PLACES = {places}\n\n"
        "#: The method of each computation by its path.\n"
        f"METHODS: dict[str, str] = {shown({path: method_name(path) for path, _ in computations(api)})}\n"
    )


def shorthands(schemas: Schema) -> dict[str, str]:
    """The one number that stands for an object, by the name of the member that has the object."""
    found = {}
    for name, schema in schemas.items():
        if not (name.endswith("Request") or "oneOf" in schema or name == "CyclicPath"):
            continue
        for member, what in alternatives(schema, schemas).items():
            members = fields(schemas.get(name_of(what), {}), schemas)[0]
            short = next((one for one in SHORT_MEMBERS if one in members), None)
            if short and "number" in kinds(members[short]) + ["number"] * ("integer" in kinds(members[short])):
                found[member] = short
    return found


def may_be_empty(schemas: Schema) -> set[str]:
    """The members of requests and criteria whose object needs nothing in it."""
    return {
        member
        for name, schema in schemas.items()
        if name.endswith("Request") or name == "Criteria"
        for member, what in alternatives(schema, schemas).items()
        if stands_for_nothing(schemas.get(name_of(what), {}))
    }


def stands_for_nothing(schema: Schema) -> bool:
    """Whether an object may be empty, and does not stand for a number of its own."""
    members = schema.get("properties", {})
    return bool(members) and not schema.get("required") and "not" not in schema and "amplitude" not in members


def method_name(path: str) -> str:
    return METHODS.get(path, path.rpartition("/")[2])


# Types


def type_of(schema: Schema, schemas: Schema, prefix: str = "") -> str:
    """The type of a member of a request."""
    name = name_of(schema)
    if name == "Profile":
        return "Shape"
    if name in ("ContactDefinition", "CreateRequest"):
        return "ContactLike"
    if name == "Material":
        return "Material"
    if name:
        is_open = "enum" not in schemas[name]
        places = {schema: place for place, schema in PLACES.items()}
        own = f"{places[name]} | " if prefix and name in places else ""
        return own + prefix + name + (" | Mapping[str, Any]" if is_open and "oneOf" not in schemas[name] else "")
    if "array" in kinds(schema):
        inner = schema["items"]
        if "number" in kinds(inner) or "integer" in kinds(inner):
            found = "Quantities" if "number" in kinds(inner) else "Sequence[int]"
            return f"Quantity | {found}" if "number" in kinds(schema) else found
        if "array" in kinds(inner):
            return "Sequence[Quantities] | Quantities"
        return f"Sequence[{type_of(inner, schemas, prefix)}]"
    scalars = {"number": "Quantity", "integer": "int", "string": "str", "boolean": "bool"}
    return next((scalars[one] for one in kinds(schema) if one in scalars), "Any")


def types_file(api: Schema) -> str:
    """Words as literals, objects as typed dictionaries."""
    schemas = api["components"]["schemas"]
    roots = {request_of(operation) for *_, operation in operations(api)} - {""}
    used = closure({name for root in roots for name in references(schemas[root])}, schemas)
    enums = sorted(name for name, schema in schemas.items() if "enum" in schema)
    text = [
        '"""The types of the members of requests: words, and objects as dictionaries.\n\n'
        'Written by `tools/generate.py`.\n"""\n',
        "from __future__ import annotations\n",
        "from collections.abc import Mapping, Sequence",
        "from typing import Any, Literal, TypeAlias, TypedDict, Union\n",
        "from .bodies import Material",
        "from .documents import Quantities, Quantity\n",
    ]
    for name in enums:
        words = ", ".join(json.dumps(word) for word in schemas[name]["enum"])
        text += [f"{name}: TypeAlias = Literal[{words}]"]
        text += [wrapped(schemas[name].get("description", name), "")]
    hidden = {name for name in used if name.endswith("Profile")}
    hidden |= {"Profile", "Material", "Body", "ElasticBody", "Effective", "ContactDefinition", *enums}
    later = []
    for name in sorted(used - hidden):
        schema = schemas[name]
        if "oneOf" in schema:
            choices = []
            for choice in schema["oneOf"]:
                if "enum" in choice:
                    choices.append(f"Literal[{', '.join(json.dumps(word) for word in choice['enum'])}]")
                elif "properties" in choice:
                    text += dictionary(choice["title"], choice, schemas)
                    choices.append(choice["title"])
                else:
                    choices.append(type_of(choice, schemas))
            choices.append("Mapping[str, Any]")
            joined = ",\n    ".join(json.dumps(one) for one in dict.fromkeys(choices))
            later.append(f"{name}: TypeAlias = Union[\n    {joined},\n]")
            later.append(wrapped(schema.get("description", name), ""))
        else:
            text += dictionary(name, schema, schemas)
    text.append("\n\nclass DefinitionMembers(TypedDict, total=False):")
    text.append('    """The preload of a contact, of which one number is given, and what may be left out."""\n')
    for name, what in load_members(schemas).items():
        text += [f"    {name}: {type_of(what, schemas)} | None", wrapped(what.get("description", name), "    ")]
    return "\n".join([*text, "", *later]) + "\n"


def dictionary(name: str, schema: Schema, schemas: Schema) -> list[str]:
    members, required = fields(schema, schemas)
    if any(attribute(member) != member for member in members):
        parts = ", ".join(f'"{member}": "{type_of(what, schemas)}"' for member, what in members.items())
        return [f"\n{name} = TypedDict({json.dumps(name)}, {{{parts}}}, total={required == set(members)})"]
    base = ""
    text = []
    if required and required != set(members):
        base = f"_{name}Needed"
        text += [f"\n\nclass {base}(TypedDict):"]
        text += [f"    {member}: {type_of(members[member], schemas)}" for member in members if member in required]
    text.append(f"\n\nclass {name}({base or 'TypedDict'}{'' if required == set(members) else ', total=False'}):")
    text.append(summary(schema.get("description", name)) + "\n")
    for member, what in members.items():
        if not (base and member in required):
            text.append(f"    {member}: {type_of(what, schemas)}")
            if "description" in what:
                text.append(wrapped(what["description"], "    "))
    return text


# Shapes


def profiles_file(api: Schema) -> str:
    schemas = api["components"]["schemas"]
    mapping = schemas["Profile"]["discriminator"]["mapping"]
    text = [
        '"""Shapes of the indenter, one class for each profile of the API, and places in a body.\n\n'
        'Written by `tools/generate.py`.\n"""\n',
        "from __future__ import annotations\n",
        "from collections.abc import Mapping, Sequence",
        "from dataclasses import KW_ONLY, InitVar, dataclass",
        "from typing import Any, ClassVar\n",
        "from . import request_types as types",
        "from .bodies import ContactPart, Material, Part, Shape, radius_of",
        "from .documents import Quantities, Quantity\n",
        "\n@dataclass(frozen=True, eq=False)",
        "class Profile(Part):",
        '    """A shape of the indenter before it is loaded."""\n',
        '    TYPE: ClassVar[str] = ""\n',
    ]
    names = []
    for kind, reference in sorted(mapping.items()):
        name = class_name(kind)
        names.append(name)
        text += dataclass(name, "Profile", schemas[reference.rpartition("/")[2]], schemas, f'"{kind}"')
    for name, schema in PLACES.items():
        names.append(name)
        text += dataclass(name, "Part", schemas[schema], schemas)
    names.append("Definition")
    text += definition(schemas)
    text.append(f"\n__all__ = {shown(['Profile', *names])}")
    return "\n".join(text) + "\n"


def load_members(schemas: Schema) -> dict[str, Schema]:
    """The members of a definition beside its shape, bodies and friction: one of a preload, and what may be left out."""
    members, required = fields(schemas["ContactDefinition"], schemas)
    return alternatives(schemas["Preload"], schemas) | {
        name: what for name, what in members.items() if name not in required
    }


def definition(schemas: Schema) -> list[str]:
    """The class of a definition."""
    text = [
        "\n@dataclass(frozen=True, eq=False)",
        "class Definition(ContactPart):",
        '    """A contact by its shape, bodies, friction and preload, of which one number is given."""\n',
        "    profile: Shape",
        '    """The shape of the indenter."""',
        "    bodies: Material",
        '    """The two bodies, or their reduced moduli."""',
        "    friction: Quantity",
        wrapped(fields(schemas["ContactDefinition"], schemas)[0]["friction"]["description"], "    "),
    ]
    for name, what in load_members(schemas).items():
        text += [f"    {name}: {type_of(what, schemas, 'types.')} | None = None"]
        text += [wrapped(what.get("description", name), "    ")]
    return [*text, ""]


def class_name(kind: str) -> str:
    return "".join(word.capitalize() for word in kind.split("_"))


def dataclass(name: str, base: str, schema: Schema, schemas: Schema, kind: str = "") -> list[str]:
    """A shape or a place; of more than one parameter each is given by its name, but for the radius of a cylinder."""
    members, required = fields(schema, schemas)
    members = {member: what for member, what in members.items() if member != "type"}
    # A cylinder is called by its radius, as a sphere is.
    first = "radius" if kind == '"cylinder"' else ""
    keywords = ", kw_only=True" if len(members) > 1 and not first else ""
    text = [f"\n@dataclass(frozen=True, eq=False{keywords})", f"class {name}({base}):", summary(schema["description"])]
    if kind:
        text.append(f"\n    TYPE: ClassVar[str] = {kind}")
    text.append("")
    round_ = kind in ROUND
    for member in sorted(members, key=lambda one: (one != first, one not in required, list(members).index(one))):
        what = members[member]
        shape = "Sequence[Shape]" if name_of(what.get("items", {})) == "Profile" else type_of(what, schemas, "types.")
        optional = member not in required or (round_ and member == "radius")
        text.append(f"    {attribute(member)}: {shape}" + (" | None = None" if optional else ""))
        if "description" in what:
            text.append(wrapped(what["description"], "    "))
        if member == first:
            text.append("    _: KW_ONLY")
    if round_:
        text += [*(["    _: KW_ONLY"] if not first else []), "    diameter: InitVar[Quantity | None] = None"]
        text += ['    """The diameter 2 R, m, in place of the radius."""', ""]
        text += ["    def __post_init__(self, diameter: Quantity | None) -> None:"]
        text += ["        radius_of(self, self.radius, diameter)"]
    text.append("")
    return text
