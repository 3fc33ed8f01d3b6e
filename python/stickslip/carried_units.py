"""Quantities of pint, astropy, unyt and quantities: their numbers in a unit, by the conversions of each package."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

#: How the SI units of members are spelled where a package spells them otherwise.
_SPELLED: dict[str, dict[str, str]] = {
    "astropy": {"1": ""},
    "pint": {"1": "dimensionless"},
    "quantities": {"1": "dimensionless"},
    "unyt": {"1": "dimensionless", "deg": "degree"},
}
#: The units in which a column is written whose quantity is not known.
_WRITTEN = ("m", "N", "s", "Pa", "deg", "1")
_ANGLE = re.compile(r"radian|degree|grad|gon\b|turn|revolution|arc(minute|second)", re.IGNORECASE)


@dataclass(frozen=True)
class Carried:
    """A quantity of a package: a number or an array with its unit."""

    package: str
    value: Any
    symbol: str
    to: Callable[[Any], Any]
    base: Callable[[], Any]
    #: The text of the unit in the base units of the package.
    roots: Callable[[], str]

    def in_unit(self, unit: str | None) -> Any:
        """The numbers in an SI unit; in the base units of their own for "" and None."""
        return self.to(_spelled(unit, self.package)) if unit else self.base()

    @property
    def is_angle(self) -> bool:
        """Whether it is an angle, which some packages also take for a pure number."""
        return self.roots().strip("() ") in ("radian", "rad", "angle")

    def radians(self) -> Any:
        """An angle in radians."""
        return self.to("rad" if self.package in ("astropy", "quantities") else "radian")

    def is_in(self, symbol: str) -> bool:
        """Whether a text names its unit."""
        try:
            one, other = self.to(symbol), self.value
            magnitude = getattr(other, "magnitude", getattr(other, "value", other))
            return bool((one == magnitude).all() if hasattr(one == magnitude, "all") else one == magnitude)
        except Exception:  # Each package has errors of its own for a text that it cannot read.
            return False

    def written(self) -> tuple[Any, str] | None:
        """The numbers and an SI unit by the name that files have it; None if there is none."""
        for unit in _WRITTEN:
            try:
                return self.in_unit(unit), unit
            except Exception:  # As above.
                continue
        return None


def _spelled(unit: str, package: str) -> str:
    """An SI unit as a package spells it."""
    power = "^" if package == "astropy" else "**"
    plain = unit.replace("·", "*").replace("Ω", "ohm").replace("^", power)
    return _SPELLED[package].get(unit, plain)


def carried_by(value: Any) -> Carried | None:
    """The quantity that a value is, or has in a column; None for one without a unit of a package."""
    if hasattr(getattr(value, "dtype", None), "units") and hasattr(value, "pint"):
        value = value.pint.quantity
    if hasattr(value, "to_base_units") and hasattr(value, "magnitude"):
        return Carried(
            "pint",
            value,
            str(value.units),
            lambda unit: value.to(unit).magnitude,
            lambda: value.to_base_units().magnitude,
            lambda: str(value.to_root_units().units),
        )
    package = next((found for kind in type(value).__mro__ if (found := kind.__module__.partition(".")[0]) in _OF), None)
    return None if package is None else _OF[package](value)


def _of_astropy(value: Any) -> Carried | None:
    if hasattr(value, "quantity"):
        # A column of a table.
        return None if value.unit is None else _of_astropy(value.quantity)
    if not hasattr(value, "to_value"):
        return None
    plain = getattr(value, "unmasked", value)
    return Carried(
        "astropy",
        plain,
        str(plain.unit),
        lambda unit: plain.to_value(unit),
        lambda: plain.si.value,
        lambda: str(plain.unit.decompose().bases[0]) if len(plain.unit.decompose().bases) == 1 else "",
    )


def _of_unyt(value: Any) -> Carried | None:
    if not hasattr(value, "in_mks"):
        return None
    return Carried(
        "unyt",
        value,
        str(value.units),
        lambda unit: value.to(unit).value,
        lambda: value.in_mks().value,
        lambda: str(value.units.dimensions),
    )


def _of_quantities(value: Any) -> Carried | None:
    if not hasattr(value, "rescale"):
        return None
    return Carried(
        "quantities",
        value,
        str(value.dimensionality),
        lambda unit: value.rescale(unit).magnitude,
        lambda: value.simplified.magnitude,
        # It takes a radian for the number one: the name of the unit alone says that it is an angle.
        lambda: "radian" if _ANGLE.search(" ".join(unit.name for unit in value.dimensionality)) else "",
    )


_OF: dict[str, Callable[[Any], Carried | None]] = {
    "astropy": _of_astropy,
    "quantities": _of_quantities,
    "unyt": _of_unyt,
}
