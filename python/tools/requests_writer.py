"""Writes what requests are made of: `profiles.py`, `request_types.py`, `members.py`, and methods, `computations.py`."""

from __future__ import annotations

import json
import textwrap
from typing import Any

from openapi_schemas import (
    Schema,
    attribute,
    closure,
    fields,
    kinds,
    name_of,
    operations,
    references,
    reply_of,
    request_of,
    unit,
)
from results_writer import result_classes, shown, summary, wrapped

#: Requests whose members are places that have classes too, by the names of these.
PLACES = {"Line": "SubsurfaceLine", "Plane": "SubsurfacePlane", "Surface": "SubsurfaceSurface"}
#: The method of a computation where it is not the last part of its path.
METHODS = {"/fit": "fit_loop", "/profiles/fit": "fit_profile"}
#: What a contact is asked for.
OF_CONTACT = [f"/contacts/{{id}}/{name}" for name in ("move", "path", "relax", "subsurface")]
#: Computations that a contact answers too, at its present load.
AT_PRESENT = ("/cycle", "/fretting")
#: Members that are objects of one key, or of named parts, whose own members are keywords of the methods.
FLATTENED = {"path", "drive", "criteria"}
#: Of these, those that are no keyword themselves.
HIDDEN = {"drive"}
#: The spelling of units in the table of the engine.
SPELLED = {"degrees": "deg", "J/m²": "J/m^2", "m^(1−n)": ""}


def computations(api: Schema) -> list[tuple[str, Schema]]:
    """The paths of all computations that are given a document and reply with one."""
    return [
        (path, operation)
        for path, method, operation in operations(api)
        if method == "post" and "{" not in path and request_of(operation) and reply_of(operation) in result_classes(api)
    ]


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
        "#: The method of each computation by its path.\n"
        f"METHODS: dict[str, str] = {shown({path: method_name(path) for path, _ in computations(api)})}\n"
    )


def functions_file(api: Schema) -> str:
    """The computations as functions of the module."""
    names = ["compute", "compute_bytes", *sorted(method_name(path) for path, _ in computations(api))]
    return "\n".join(
        [
            '"""The computations of this process as functions. Written by `tools/generate.py`."""\n',
            "from .engine import Local\n",
            "_local = Local()",
            *(f"{name} = _local.{name}" for name in names),
            f"\n__all__ = {shown(names)}",
            "",
        ]
    )


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
        "from collections.abc import Sequence",
        "from dataclasses import dataclass",
        "from typing import ClassVar\n",
        "from . import request_types as types",
        "from .bodies import ContactPart, Material, Part, Shape",
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
    """A shape or a place; of more than one parameter each is given by its name."""
    members, required = fields(schema, schemas)
    members = {member: what for member, what in members.items() if member != "type"}
    keywords = ", kw_only=True" if len(members) > 1 else ""
    text = [f"\n@dataclass(frozen=True, eq=False{keywords})", f"class {name}({base}):", summary(schema["description"])]
    if kind:
        text.append(f"\n    TYPE: ClassVar[str] = {kind}")
    text.append("")
    for member in sorted(members, key=lambda one: (one not in required, list(members).index(one))):
        what = members[member]
        shape = "Sequence[Shape]" if name_of(what.get("items", {})) == "Profile" else type_of(what, schemas, "types.")
        text.append(f"    {attribute(member)}: {shape}" + ("" if member in required else " | None = None"))
        if "description" in what:
            text.append(wrapped(what["description"], "    "))
    text.append("")
    return text


# Methods


class Method:
    """A method that makes the document of a request and returns its reply."""

    def __init__(self, path: str, operation: Schema, schemas: Schema, *, request: str = "", of_contact: bool = False):
        self.path, self.operation, self.schemas, self.of_contact = path, operation, schemas, of_contact
        self.name = method_name(path)
        self.reply = reply_of(operation)
        self.members, self.required = fields(schemas[request or request_of(operation)], schemas)
        if of_contact:
            self.members.pop("contact", None)
        #: The keywords, with their types, descriptions and the member that they are a part of.
        self.keywords: dict[str, tuple[str, str, str | None]] = {}
        flattened = [member for member in self.members if member in FLATTENED]
        for member in flattened:
            for name, what in alternatives(schemas[name_of(self.members[member])], schemas).items():
                self.add(name, what, member)
        for member, what in self.members.items():
            if member not in HIDDEN:
                self.add(member, what, None)
        for member, (shape, said) in EXTRA.get(path, {}).items():
            self.keywords[member] = (shape, said, None)

    def add(self, name: str, what: Schema, part: str | None) -> None:
        if name in self.keywords:
            return
        short = self.short(what)
        shape = type_of(what, self.schemas, "types.")
        if name in LOOSE.get(self.path, {}):
            shape = LOOSE[self.path][name]
        elif short:
            shape = f"{short} | {shape}"
        said = " ".join(what.get("description", name).split())
        shorthand = SHORT.get(name) if short else None
        if shorthand:
            said += f" A number alone is its `{shorthand}`."
        self.keywords[name] = (shape, said, part)

    def short(self, what: Schema) -> str:
        """The type of the one number that may stand for an object."""
        schema = self.schemas.get(name_of(what), {})
        members = schema.get("properties", {})
        name = next((one for one in SHORT_MEMBERS if one in members), None)
        found = "int" if name and "integer" in kinds(members[name]) else "Quantity" if name else ""
        return " | ".join(one for one in (found, "bool" if stands_for_nothing(schema) else "") if one)

    def first(self) -> list[str]:
        """The keywords that may be given by their places."""
        return [name for name in POSITIONAL.get(self.path, POSITIONAL[""]) if name in self.keywords]

    def order(self) -> list[str]:
        first = self.first()
        return first + [name for name in self.keywords if name not in first]

    def signature(self, is_async: bool) -> list[str]:
        first, order = self.first(), self.order()
        parts = ["self"]
        for name in order:
            shape = self.keywords[name][0]
            needed = name in self.required and name in first and name not in ("displacement",)
            if name == order[len(first)] and len(order) > len(first):
                parts.append("*")
            parts.append(f"{attribute(name)}: {shape}" + ("" if needed else " | None = None"))
        if len(order) == len(first):
            parts.append("*")
            parts.pop()
        lines = [f"    {'async ' if is_async else ''}def {self.name}("]
        lines += [f"        {part}," for part in parts]
        return [*lines, f"    ) -> results.{self.reply}:"]

    def body(self, is_async: bool) -> list[str]:
        lines = ["        given: Document = {"]
        parts: dict[str, list[str]] = {}
        for name, (_, _, part) in self.keywords.items():
            if part is None:
                lines.append(f'            "{name}": {attribute(name)},')
            elif part is not None:
                parts.setdefault(part, []).append(name)
        lines.append("        }")
        call = "_answer_of_contact" if self.of_contact else "_answer"
        wait = "await " if is_async else ""
        lines.append("        parts: dict[str, Document] = {")
        for part, names in parts.items():
            lines.append(f"            {json.dumps(part)}: {{")
            lines += [f'                "{name}": {attribute(name)},' for name in names]
            lines.append("            },")
        lines.append("        }")
        target = json.dumps(self.name if self.of_contact else self.path)
        lines.append(f"        return {wait}self.{call}(results.{self.reply}, {target}, given, parts)")
        return lines

    def write(self, is_async: bool) -> list[str]:
        docs = self.docstring() if not is_async else [f'        """`{self.name}`, awaited."""']
        return ["", *self.signature(is_async), *docs, *self.body(is_async)]

    def docstring(self) -> list[str]:
        """A docstring in the form of NumPy."""
        said = " ".join(self.operation["description"].split())
        first, _, rest = said.partition(". ")
        if len(first) > 104:
            first, rest = self.operation["summary"], said
        first = first.removesuffix(".") + "."
        lines = [f'        """{first}', ""]
        lines += textwrap.wrap(rest, 112) + ([""] if rest else [])
        note = NOTES.get((self.name, self.of_contact)) or (OF_DEFINITION if "contact" in self.keywords else "")
        if note:
            lines += [*textwrap.wrap(note, 112), ""]
        lines += ["Parameters", "----------"]
        for name in self.order():
            shape, said, _ = self.keywords[name]
            shape = shape.replace("types.", "").replace(" | Mapping[str, Any]", " | dict")
            lines += [f"{attribute(name)} : {shape}", *("    " + line for line in textwrap.wrap(said, 108))]
        said = self.schemas[self.reply].get("description", self.reply)
        lines += ["", "Returns", "-------", f"{self.reply}"]
        lines += ["    " + line for line in textwrap.wrap(" ".join(said.split()), 108)]
        lines += [
            "",
            "Raises",
            "------",
            "InvalidInput",
            "    With the pointer of the member that is wrong, and its range.",
        ]
        lines += ["", "Examples", "--------", *self.example()]
        text = [lines[0], *(f"        {line}".rstrip().replace("\\", "\\\\") for line in lines[1:])]
        return [*text, '        """']

    def example(self) -> list[str]:
        """Lines that run."""
        if self.of_contact:
            return [f">>> {line}" for line in EXAMPLES[self.name]]
        content = self.operation["requestBody"]["content"]["application/json"]
        named = [one["value"] for one in content.get("examples", {}).values()]
        given = dict((named or [self.schemas[request_of(self.operation)]["example"]])[0])
        keywords: dict[str, Any] = {}
        for name, value in given.items():
            if any(part == name for _, _, part in self.keywords.values()) and isinstance(value, dict):
                keywords |= {inner: item for inner, item in value.items() if inner in self.keywords}
            else:
                keywords[name] = value
        lines = [">>> import stickslip as ss", f">>> reply = ss.{self.name}("]
        for name in (name for name in self.order() if name in keywords):
            value = keywords[name]
            shown_value = contact_code(value) if name == "contact" else repr(value)
            line = f"{name}={shown_value},"
            wrapped_lines = textwrap.wrap(line, 100, break_long_words=False, break_on_hyphens=False)
            lines += [f"...     {wrapped_lines[0]}", *(f"...         {rest}" for rest in wrapped_lines[1:])]
        return [*lines, "... )"]


def profile_code(profile: dict[str, Any]) -> str:
    """The shape of a document as it is written with the package."""
    members = {name: value for name, value in profile.items() if name != "type"}
    if "parts" in members:
        return f"ss.Sum([{', '.join(profile_code(part) for part in members['parts'])}])"
    given = ", ".join(f"{name}={value!r}" for name, value in members.items())
    return f"ss.{class_name(profile['type'])}({given})"


def contact_code(contact: dict[str, Any]) -> str:
    """The definition of a document as it is written with the package."""
    material = contact["material"]
    if "bodies" in material:
        bodies = ", ".join(
            "ss.RIGID" if body == "rigid" else f"ss.Body({body['youngs_modulus']:g}, {body['poisson_ratio']!r})"
            for body in material["bodies"]
        )
        bodies = f"[{bodies}]"
    else:
        effective = material["effective"]
        bodies = f"ss.Moduli({effective['e_star']:g}, {effective['g_star']:g})"
    rest = {
        name: value for name, value in contact.items() if name not in ("profile", "material", "friction", "preload")
    }
    load = ", ".join(f"{name}={value!r}" for name, value in (contact["preload"] | rest).items())
    return f"ss.Definition({profile_code(contact['profile'])}, {bodies}, {contact['friction']!r}, {load})"


#: Members whose one number may stand for the whole object, in the order in which they are looked for.
SHORT_MEMBERS = ("reversals", "stiffness", "points", "amplitude")
SHORT: dict[str, str] = {}
#: Keywords that take more than the document says.
LOOSE = {
    "/fit": {"loops": "LoopLike | Sequence[LoopLike]", "free": "Sequence[types.FitParameter]"},
    "/profiles/fit": {"scan": "ScanLike"},
    "/sweep": {
        "base": "Mapping[str, Any]",
        "axes": "Mapping[str, Quantities] | Sequence[types.Axis]",
        "outputs": "str | Mapping[str, str] | Sequence[types.Output]",
    },
    "/fretting": {"displacement": "Quantity | Quantities"},
}
#: Keywords that no member of the document has.
EXTRA = {
    "/contacts/{id}/stress": {"residual": ("bool", "Ask for the extrema of the shear stress too.")},
    "/fit": {"start": ("types.LoopStart", "How all loops begin.")},
}
#: The keywords that may be given without their names.
POSITIONAL = {
    "": ["contact", "displacement"],
    "/fit": ["contact", "loops"],
    "/profiles/fit": ["scan"],
    "/protocols": ["contact", "reversals"],
    "/sweep": ["base", "axes", "outputs"],
    "/contacts/{id}/relax": ["reversals"],
    "/contacts/{id}/stress": ["points"],
}
OF_DEFINITION = (
    "The contact is taken at the preload of its definition, never moved: of a `Contact` that has been moved, its "
    "history and present load play no part."
)
NOTES = {
    ("cycle", True): (
        "The load is the present one, and the history plays no part. `stickslip.cycle(contact)` is at the preload of "
        "the definition instead."
    ),
    ("fretting", True): (
        "The load is the present one, and the history plays no part: the path begins with a contact that was never "
        "moved. `stickslip.fretting(contact)` is at the preload of the definition instead. One displacement is the "
        "amplitude of a cycle, several are a path."
    ),
    ("fretting", False): OF_DEFINITION + " One displacement is the amplitude of a cycle, several are a path.",
    ("sweep", False): "`axes` may be values by their pointers, `outputs` pointers by the names of their columns.",
    ("fit_profile", False): "The scan may be a file that was read, a table with named columns, or arrays of x and z.",
    ("fit_loop", False): (
        OF_DEFINITION
        + " A loop may be a file that was read, a table with named columns, or arrays of displacement and "
        "force. `start` says how all of them begin."
    ),
}
_BALL = [
    "import stickslip as ss",
    'steel = ss.Body("210 GPa", 0.3)',
    'ball = ss.Contact(ss.Sphere("10 mm"), [steel, ss.RIGID], 0.3, normal_force="10 N")',
]
EXAMPLES = {
    "move": [*_BALL, 'state = ball.move(force="1 N").state'],
    "path": [*_BALL, "force = ball.path([5e-8, -5e-8]).force"],
    "relax": [*_BALL, "left = ball.relax(8).residual.max"],
    "stress": [*_BALL, "shear = ball.stress(200).shear"],
    "subsurface": [
        *_BALL,
        'plane = ss.Plane(normal="y", offset=0, x=[-1e-4, 1e-4, 5], z=[0, 1e-4, 4])',
        'stress = ball.subsurface(plane=plane, fields=["von_mises"]).von_mises',
    ],
    "cycle": [*_BALL, 'work = ball.cycle(["10 nm", "30 nm"]).dissipated_energy'],
    "fretting": [*_BALL, 'margin = ball.fretting("50 nm", crossland={"alpha": 0.3, "limit": "300 MPa"}).margin'],
}


def methods_file(api: Schema) -> str:
    schemas = api["components"]["schemas"]
    SHORT.update(shorthands(schemas))
    every = [Method(path, operation, schemas) for path, operation in computations(api)]
    of_contact = [
        Method(path, operation, schemas, of_contact=True)
        for path, method, operation in operations(api)
        if method == "post" and (path in AT_PRESENT or path in OF_CONTACT)
    ]
    stress = api["paths"]["/contacts/{id}/stress"]["get"]
    of_contact.append(Method("/contacts/{id}/stress", stress, schemas, request="StressRequest", of_contact=True))
    text = [
        '"""The computations as methods with their keywords. Written by `tools/generate.py`."""\n',
        "from __future__ import annotations\n",
        "from abc import ABC, abstractmethod",
        "from collections.abc import Mapping, Sequence",
        "from typing import Any\n",
        "from . import request_types as types",
        "from . import results",
        "from .bodies import ContactLike",
        "from .documents import Document, Quantities, Quantity",
        "from .profiles import Line, Plane, Surface",
        "from .requests import LoopLike, ScanLike",
        "from .result import T\n",
    ]
    for name, methods, call, says in (
        ("Computations", every, "_answer", "The computations, which take a contact at the preload of its definition."),
        ("OfContact", of_contact, "_answer_of_contact", "What a contact does and is asked for in its present state."),
    ):
        for is_async in (False, True):
            word = "async def" if is_async else "def"
            text += [
                f"\nclass {'Async' if is_async else ''}{name}(ABC):",
                f'    """{says}"""\n',
                "    @abstractmethod",
                f"    {word} {call}(self, kind: type[T], name: str, given: Document, parts: dict[str, Document]) -> T:",
                '        """The reply to the members of a request, some of which are parts of one member."""',
            ]
            for method in methods:
                text += method.write(is_async)
            text.append("")
    return "\n".join(text)


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
