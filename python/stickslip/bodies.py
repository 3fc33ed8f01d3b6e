"""The two bodies of a contact, and the parts of definitions."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from typing import Any, ClassVar, Final, TypeAlias, Union

from .documents import Document, HasDocument, Quantity, to_document


class Part:
    """A part of a request. Two parts are equal if they are the same in SI units."""

    TYPE: ClassVar[str] = ""

    def document(self) -> Document:
        """The JSON document, with units as they were given."""
        given = {field.name.removesuffix("_"): getattr(self, field.name) for field in fields(self)}  # type: ignore[arg-type]
        kind = {"type": self.TYPE} if self.TYPE else {}
        return kind | {name: value for name, value in given.items() if value is not None}

    def _key(self) -> str:
        return json.dumps(to_document(self), sort_keys=True)

    def __eq__(self, other: object) -> bool:
        return self._key() == other._key() if type(self) is type(other) and isinstance(other, Part) else NotImplemented

    def __hash__(self) -> int:
        return hash(self._key())


@dataclass(frozen=True, eq=False)
class Body(Part):
    """An elastic body: Young's modulus, Pa, and Poisson's ratio, a pure number."""

    youngs_modulus: Quantity
    poisson_ratio: Quantity


#: A rigid body.
RIGID: Final = "rigid"


@dataclass(frozen=True, eq=False)
class Moduli(Part):
    """Reduced moduli E* and G*, Pa, in place of the two bodies."""

    e_star: Quantity
    g_star: Quantity


#: Two bodies, or their moduli.
Material: TypeAlias = Union["Sequence[Body | str]", Moduli, Mapping[str, Any]]
#: A shape, or its document.
Shape: TypeAlias = HasDocument | Mapping[str, Any]
#: A contact, a definition, or its document.
ContactLike: TypeAlias = Union["HasDefinition", HasDocument, Mapping[str, Any]]


class HasDefinition:
    """An object that has the definition of a contact."""

    def definition(self) -> Document:
        """The JSON document of its definition, at its preload."""
        raise NotImplementedError


class ContactPart(Part):
    """The definition of a contact: its load is an object of one key."""

    #: The names of the numbers that a preload may be.
    PRELOADS: ClassVar[tuple[str, ...]] = ("normal_force", "indentation", "contact_radius")

    def document(self) -> Document:
        """The JSON document, with units as they were given."""
        given = super().document()
        material = given.pop("bodies")
        if isinstance(material, Moduli):
            material = {"effective": material}
        elif not isinstance(material, Mapping):
            material = {"bodies": list(material)}
        preload = {name: given.pop(name) for name in self.PRELOADS if name in given}
        return {"profile": given.pop("profile"), "material": material, "preload": preload} | given


def elastic_body(definition: Document) -> str:
    """The first body that is not rigid, by its name in requests."""
    bodies = definition.get("material", {}).get("bodies", [])
    return "second" if bodies and bodies[0] == RIGID else "first"
