"""The two bodies of a contact, and the definition of one."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final, TypeAlias

from .documents import Document, HasDocument, Quantity


@dataclass(frozen=True)
class Body:
    """An elastic body: Young's modulus, Pa, and Poisson's ratio, a pure number."""

    youngs_modulus: Quantity
    poisson_ratio: float

    def document(self) -> Document:
        """Its document, with units as they were given."""
        return {"youngs_modulus": self.youngs_modulus, "poisson_ratio": self.poisson_ratio}


#: A rigid body.
RIGID: Final = "rigid"


@dataclass(frozen=True)
class Moduli:
    """Reduced moduli E* and G*, Pa, in place of the two bodies."""

    e_star: Quantity
    g_star: Quantity

    def document(self) -> Document:
        """Its document, with units as they were given."""
        return {"e_star": self.e_star, "g_star": self.g_star}


#: Two bodies, or their moduli.
Material: TypeAlias = Sequence["Body | str"] | Moduli | Mapping[str, Any]


@dataclass(frozen=True)
class Definition:
    """A contact by its shape, bodies, friction and load, of which exactly one is given.

    `normal_force` is in N, `indentation` and `contact_radius` are in m.
    """

    profile: HasDocument | Mapping[str, Any]
    bodies: Material
    friction: float
    normal_force: Quantity | None = None
    indentation: Quantity | None = None
    contact_radius: Quantity | None = None

    def document(self) -> Document:
        """Its document, with units as they were given."""
        return {
            "profile": self.profile,
            "material": _material(self.bodies),
            "friction": self.friction,
            "preload": {
                "normal_force": self.normal_force,
                "indentation": self.indentation,
                "contact_radius": self.contact_radius,
            },
        }


def _material(bodies: Material) -> Any:
    if isinstance(bodies, Moduli):
        return {"effective": bodies}
    return bodies if isinstance(bodies, Mapping) else {"bodies": list(bodies)}


def elastic_body(definition: Document) -> str:
    """The first body that is not rigid, by its name in requests."""
    bodies = definition.get("material", {}).get("bodies", [])
    return "second" if bodies and bodies[0] == RIGID else "first"
