"""The two bodies of a contact, and the parts of definitions."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import KW_ONLY, dataclass, fields
from typing import Any, ClassVar, Final, TypeAlias, Union

import numpy as np

from . import quantities
from .documents import Document, HasDocument, HasReply, Quantity, to_document


def _as_floats(value: Any) -> Any:
    """A document in which whole numbers are as those with a point."""
    if isinstance(value, dict):
        return {name: _as_floats(item) for name, item in value.items()}
    if isinstance(value, list):
        return [_as_floats(item) for item in value]
    return float(value) if isinstance(value, int) and not isinstance(value, bool) else value


class Part:
    """A part of a request. Two parts are equal if they are the same in SI units."""

    TYPE: ClassVar[str] = ""

    def document(self) -> Document:
        """The JSON document, with units as they were given."""
        given = {field.name.removesuffix("_"): getattr(self, field.name) for field in fields(self)}  # type: ignore[arg-type]
        kind = {"type": self.TYPE} if self.TYPE else {}
        return kind | {name: value for name, value in given.items() if value is not None}

    def _key(self) -> str:
        return json.dumps(_as_floats(to_document(self)), sort_keys=True)

    def __eq__(self, other: object) -> bool:
        return self._key() == other._key() if type(self) is type(other) and isinstance(other, Part) else NotImplemented

    def __hash__(self) -> int:
        return hash(self._key())


@dataclass(frozen=True, eq=False)
class Body(Part):
    """An elastic body: Young's modulus, Pa, and Poisson's ratio, a pure number; or the name of a known material.

    With `prony` it has memory: the moduli are those of the instant, and each term is `(ratio, time)`, the part of them
    that relaxes and its time, s. Moves of such a contact have a `duration`.

    With a `resistivity`, Ω·m, or a `conductivity`, W/(m·K), of both bodies the contact has a conductance.
    """

    youngs_modulus: Quantity
    poisson_ratio: Quantity | None = None
    prony: Sequence[tuple[Quantity, Quantity] | Mapping[str, Any]] | None = None
    _: KW_ONLY
    resistivity: Quantity | None = None
    conductivity: Quantity | None = None

    def __post_init__(self) -> None:
        if self.poisson_ratio is None:
            from .known_materials import constants_of

            if not isinstance(self.youngs_modulus, str):
                detail = (
                    "Poisson's ratio is missing: give Body(youngs_modulus, poisson_ratio), or the name of a material"
                )
                raise quantities.refused("/poisson_ratio", detail)
            for name, value in zip(("youngs_modulus", "poisson_ratio"), constants_of(self.youngs_modulus), strict=True):
                object.__setattr__(self, name, value)

    def document(self) -> Document:
        """The JSON document of its elastic constants; a contact has the memory of its bodies."""
        return {name: value for name, value in super().document().items() if name != "prony"}

    def memory(self) -> list[Document] | None:
        """The terms of its Prony series."""
        return None if self.prony is None else terms(self.prony)

    def _key(self) -> str:
        return super()._key() + json.dumps(_as_floats(to_document({"prony": self.memory()})))


def terms(prony: Sequence[Any]) -> list[Document]:
    """The terms of a Prony series, of objects or of pairs."""
    return [dict(one) if isinstance(one, Mapping) else dict(zip(("ratio", "time"), one, strict=True)) for one in prony]


#: A rigid body.
RIGID: Final = "rigid"


@dataclass(frozen=True, eq=False)
class Moduli(Part):
    """Reduced moduli E* and G*, Pa, in place of the two bodies, and 1/G = 1/G₁ + 1/G₂ for twist."""

    e_star: Quantity
    g_star: Quantity
    shear_modulus: Quantity | None = None


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
        preload = {name: given.pop(name) for name in self.PRELOADS if name in given}
        if len(preload) != 1:
            stated = " and ".join(preload) or "none"
            detail = f"a contact has one load, and {stated} is given: give one of {', '.join(self.PRELOADS)}"
            raise quantities.refused("/preload", detail)
        given |= memory_of(material, given.get("prony"))
        return {"profile": given.pop("profile"), "material": material_of(material), "preload": preload} | given


def memory_of(material: Any, prony: Any) -> Document:
    """The memory of the bodies of a contact, which is given with them or beside them; both relax alike."""
    bodies = [material] if isinstance(material, Body) else material if isinstance(material, Sequence) else []
    given = [one.memory() for one in bodies if isinstance(one, Body)]
    if all(one is None for one in given):
        return {} if prony is None else {"prony": terms(prony)}
    if prony is not None or any(to_document(one) != to_document(given[0]) for one in given):
        detail = "both bodies relax alike: give each elastic body the same `prony`, or the contact alone"
        raise quantities.refused("/prony", detail)
    return {"prony": given[0]}


def material_of(given: Any) -> Any:
    """The document of two bodies, each a body, the name of a material or `RIGID`, or of reduced moduli."""
    if isinstance(given, Moduli):
        return {"effective": given}
    if isinstance(given, HasReply):
        return given.reply_document()
    if isinstance(given, Mapping):
        return given
    if isinstance(given, Body | str) or not isinstance(given, Sequence):
        detail = f"two bodies are expected, such as [{given!r}, ss.RIGID], or ss.Moduli(e_star, g_star)"
        raise quantities.refused("/material/bodies", detail)
    return {"bodies": [Body(one) if isinstance(one, str) and one != RIGID else one for one in given]}


def half(diameter: Any) -> Any:
    """The radius of a diameter, m."""
    read = to_document(diameter, "radius", "", "/diameter")
    return (np.asarray(read, dtype=np.float64) / 2.0).tolist()


def radius_of(part: Any, radius: Any, diameter: Any) -> None:
    """Sets the radius of a shape that is given by one of both."""
    if radius is None and diameter is None:
        raise TypeError(f"{type(part).__name__} has either a radius or a diameter, and none is given")
    if radius is not None and diameter is not None:
        raise quantities.refused("/radius", f"{type(part).__name__} has either a radius or a diameter")
    if diameter is not None:
        object.__setattr__(part, "radius", half(diameter))


def elastic_body(definition: Document) -> str:
    """The first body that is not rigid, by its name in requests."""
    bodies = definition.get("material", {}).get("bodies", [])
    return "second" if bodies and bodies[0] == RIGID else "first"
