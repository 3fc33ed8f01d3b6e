"""Writes the computations as methods with their keywords, `computations.py`, and as functions, `functions.py`."""

from __future__ import annotations

import json
import textwrap
from typing import Any

from openapi_schemas import (
    Schema,
    attribute,
    class_of,
    fields,
    inner_members,
    kinds,
    members_of,
    name_of,
    operations,
    reply_of,
    request_of,
    words_of,
)
from requests_writer import (
    ALIASES,
    SHORT_MEMBERS,
    alternatives,
    class_name,
    computations,
    method_name,
    shorthands,
    stands_for_nothing,
    type_of,
)
from results_writer import shown

#: What a contact is asked for.
OF_CONTACT = [f"/contacts/{{id}}/{name}" for name in ("move", "path", "relax", "subsurface")]
#: Computations that a contact answers too, at its present load.
AT_PRESENT = ("/cycle", "/fretting")
#: Members that are objects of one key, or of named parts, whose own members are keywords of the methods.
FLATTENED = {"path", "drive", "criteria"}
#: Of these, those that are no keyword themselves.
HIDDEN = {"drive"}


class Method:
    """A method that makes the document of a request and returns its reply."""

    def __init__(self, path: str, operation: Schema, schemas: Schema, *, request: str = "", of_contact: bool = False):
        self.path, self.operation, self.schemas, self.of_contact = path, operation, schemas, of_contact
        self.name = method_name(path)
        self.reply = class_of(operation, schemas)
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
        elif name in MORE:
            said += MORE[name]
        self.keywords[name] = (shape, said + self.allowed(what), part)

    def allowed(self, what: Schema) -> str:
        """The words, the members and the default of a keyword, for its description."""
        words = words_of(what, self.schemas)
        needed, others = members_of(what, self.schemas)
        text = f" One of {', '.join(map(repr, words))}." if words and len(words) <= 24 else ""
        if name_of(what) in ("ContactDefinition", "CreateRequest", "Profile"):
            return ""
        if needed:
            text += f" Needs `{'`, `'.join(needed)}`" + (f"; may have `{'`, `'.join(others)}`." if others else ".")
        elif others and name_of(what):
            text += f" May have `{'`, `'.join(others)}`."
        text += inner_members(what, self.schemas)
        default = what.get("default", self.schemas.get(name_of(what), {}).get("default"))
        described = what.get("description", "")
        if default is not None and "Default:" not in described and "default" not in described:
            text += f" Default: {json.dumps(default)}."
        return text

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

    def signature(self, is_async: bool, given: tuple[str, ...] = (), absent: tuple[str, ...] = ()) -> list[str]:
        """The signature, or that of an overload in which some keywords are given and others absent."""
        first, order = self.first(), self.order()
        parts = ["self"]
        for name in order:
            shape = self.keywords[name][0]
            needed = name in given or (name in self.required and name in first and name not in AFTER_OPTIONAL)
            if name == order[len(first)] and len(order) > len(first):
                parts.append("*")
            optional = "None = None" if name in absent else f"{shape} | None = None"
            parts.append(f"{attribute(name)}: {shape if needed else optional}")
        if len(order) == len(first):
            parts.append("*")
            parts.pop()
        lines = [f"    {'async ' if is_async else ''}def {self.name}("]
        return [*lines, *(f"        {part}," for part in parts)]

    def replies(self) -> str:
        """The class of the reply, or those that it may have."""
        kinds_of_reply = dict.fromkeys(kind for kind, _, _ in OVERLOADS.get(self.path, [(self.reply, (), ())]))
        return " | ".join(kinds_of_reply)

    def overloads(self, is_async: bool) -> list[str]:
        """What is known of the reply by the keywords that are given."""
        lines = []
        every = [*OVERLOADS[self.path], (self.replies(), (), ())] if self.path in OVERLOADS else []
        for kind, given, absent in every:
            lines += ["    @overload", *self.signature(is_async, given, absent), f"    ) -> {annotated(kind)}: ...", ""]
        return lines

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
        signature = [*self.signature(is_async), f"    ) -> {annotated(self.replies())}:"]
        return ["", *self.overloads(is_async), *signature, *docs, *self.body(is_async)]

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
        said = self.schemas[reply_of(self.operation) if self.path in OVERLOADS else self.reply].get(
            "description", self.reply
        )
        lines += ["", "Returns", "-------", self.replies()]
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


def annotated(kinds_of_reply: str) -> str:
    """The annotation of a reply of these classes."""
    return " | ".join(f"results.{kind}" for kind in kinds_of_reply.split(" | "))


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


SHORT: dict[str, str] = {}
#: Replies of more than one class: by the keywords that are given, and those that are absent.
OVERLOADS: dict[str, list[tuple[str, tuple[str, ...], tuple[str, ...]]]] = {
    "/simulate": [
        ("SimulateReply", (), ("moves", "ellipse", "path", "solver")),
        ("PlanarReply", ("ellipse",), ()),
    ],
    "/sweep": [
        ("SweepReply", ("axes", "outputs"), ("inputs",)),
        ("UncertaintyReply", ("inputs",), ("axes",)),
    ],
}
#: Keywords that take more than the document says.
LOOSE = {
    "/fit": {"loops": "LoopLike | Sequence[LoopLike]", "free": "Sequence[types.FitParameter]"},
    "/profiles/fit": {"scan": "ScanLike"},
    "/sweep": {
        "base": "Mapping[str, Any]",
        "axes": "Mapping[str, Quantities] | Sequence[types.Axis]",
        "inputs": "Mapping[Any, Any] | Sequence[types.Input | Mapping[str, Any]]",
        "outputs": "str | Mapping[str, str] | Sequence[types.Output]",
    },
    "/fretting": {"displacement": "Quantity | Quantities"},
}
#: What a keyword takes beside what the document says.
MORE = {
    "critical_distance": " A length alone is used by the point method.",
    "known": " A number alone is a value that is held fixed.",
    "bulk": " A number alone is its amplitude.",
    "free": " If left out: friction, g_star and force_offset.",
    "body": " If left out, the first body that is not rigid.",
    "inputs": " Distributions by their pointers are taken too: each a number with its standard uncertainty (`ufloat` "
    "of `uncertainties`, `plus_minus` of pint), an estimate of a fit, {'normal': ...} or {'uniform': ...}.",
    "loops": " A loop is a file or its path, a table, a document, or arrays of displacement and force.",
    "scan": " A file or its path, a table, a document, or arrays of x and z, or of x, y and z.",
}
#: Keywords that no member of the document has.
EXTRA = {
    "/contacts/{id}/stress": {"residual": ("bool", "Also ask for the extrema of the shear stress.")},
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
#: Of these, those that are required only beside others, or after one that is not.
AFTER_OPTIONAL = ("displacement", "outputs")
OF_DEFINITION = (
    "The contact is taken at the preload of its definition, as if it was never moved: the history and the present "
    "load of a `Contact` that has been moved do not matter."
)
NOTES = {
    ("cycle", True): (
        "The load is the present one, and the history does not matter. `stickslip.cycle(contact)` is at the preload of "
        "the definition instead."
    ),
    ("fretting", True): (
        "The load is the present one, and the history does not matter: the path begins with a contact that was never "
        "moved. `stickslip.fretting(contact)` is at the preload of the definition instead. One displacement is the "
        "amplitude of a cycle, several are a path."
    ),
    ("fretting", False): OF_DEFINITION + " One displacement is the amplitude of a cycle, several are a path.",
    ("sweep", False): (
        "`axes` may be values by their pointers, `outputs` pointers by the names of their columns. With `inputs` in "
        "place of `axes` the reply says how sure the outputs are."
    ),
    ("fit_profile", False): "The scan may be a file that was read, a table with named columns, or arrays of x and z.",
    ("fit", False): (
        OF_DEFINITION
        + " A loop may be a file that was read, a table with named columns, or arrays of displacement and "
        "force. `start` states how all of them begin."
    ),
}
_BALL = [
    "import stickslip as ss",
    'steel = ss.Body("210 GPa", 0.3)',
    'ball = ss.Contact(ss.Sphere("10 mm"), [steel, steel], 0.3, normal_force="10 N")',
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
        "from typing import Any, overload\n",
        "from . import request_types as types",
        "from . import results",
        "from .bodies import ContactLike",
        "from .documents import Document, Quantities, Quantity",
        "from .keywords import explained",
        "from .profiles import Line, Plane, Surface",
        "from .requests import LoopLike, ScanLike",
        "from .result import T\n",
    ]
    for name, methods, call, says in (
        ("Computations", every, "_answer", "The computations, which take a contact at the preload of its definition."),
        ("OfContact", of_contact, "_answer_of_contact", "The calls that move a contact or read its present state."),
    ):
        for is_async in (False, True):
            word = "async def" if is_async else "def"
            text += [
                "\n@explained",
                f"class {'Async' if is_async else ''}{name}(ABC):",
                f'    """{says}"""\n',
                "    @abstractmethod",
                f"    {word} {call}(self, kind: type[T], name: str, given: Document, parts: dict[str, Document]) -> T:",
                '        """The reply to the members of a request, some of which are parts of one member."""',
            ]
            for method in methods:
                text += method.write(is_async)
            here = {method.name for method in methods}
            text += [f"\n    {alias} = {own}" for alias, own in ALIASES.items() if own in here]
            text.append("")
    return "\n".join(text)


def functions_file(api: Schema) -> str:
    """The computations as functions of the module."""
    names = ["compute", "compute_bytes", *sorted([*(method_name(path) for path, _ in computations(api)), *ALIASES])]
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
