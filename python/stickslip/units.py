"""Numbers with units, as text ("20 um", "100 MPa") or as quantities of pint, to SI floats."""

from __future__ import annotations

import re
from decimal import Decimal
from typing import Any

from .errors import Fault, InvalidInput

PREFIXES = {"": 0, "p": -12, "n": -9, "u": -6, "µ": -6, "μ": -6, "m": -3, "c": -2, "k": 3, "M": 6, "G": 9, "T": 12}
#: Units with prefixes, and those that are taken as they are, by the SI unit that they belong to.
PREFIXED = {"m": "m", "N": "N", "Pa": "Pa", "J": "J", "s": "s", "Hz": "Hz", "g": "kg"}
PLAIN = {"deg": "deg", "°": "deg", "1": "1", "%": "1"}
KINDS = {
    "m": "a length",
    "N": "a force",
    "Pa": "a pressure",
    "J": "an energy",
    "s": "a time",
    "Hz": "a frequency",
    "kg": "a mass",
    "deg": "an angle",
    "N/m": "a stiffness",
    "J/m^2": "an energy by area",
    "1": "a pure number",
}
#: The SI unit of each number of a request by the name of its member.
MEMBERS = {
    "a": "m",
    "coefficient": "",
    "contact_radius": "m",
    "cutoff_radius": "m",
    "displacement": "m",
    "drive_force": "N",
    "dx": "m",
    "dy": "m",
    "e_star": "Pa",
    "edge_radius": "m",
    "exponent": "1",
    "flat_radius": "m",
    "force": "N",
    "frequencies": "Hz",
    "friction": "1",
    "g_star": "Pa",
    "gaps": "m",
    "indentation": "m",
    "indentation_error": "m",
    "mass": "kg",
    "normal_force": "N",
    "offset": "m",
    "phase": "deg",
    "points": "m",
    "poisson_ratio": "1",
    "r": "m",
    "radii": "m",
    "radius": "m",
    "slope": "1",
    "stiffness": "N/m",
    "target": "1",
    "time": "s",
    "tip_radius": "m",
    "tolerance": "1",
    "x": "m",
    "xx": "Pa",
    "xy": "Pa",
    "xz": "Pa",
    "y": "m",
    "yield": "Pa",
    "youngs_modulus": "Pa",
    "yy": "Pa",
    "yz": "Pa",
    "z": "m",
    "zz": "Pa",
}
#: Where the same name has another unit, by the member around it.
WITHIN = {
    ("bulk", "amplitude"): "Pa",
    ("bulk", "mean"): "Pa",
    ("crossland", "limit"): "Pa",
    ("cycles", "mean"): "",
    ("dang_van", "limit"): "Pa",
    ("falling_amplitude", "amplitude"): "m",
    ("fatemi_socie", "limit"): "1",
    ("findley", "limit"): "Pa",
    ("friction_work", "limit"): "J/m^2",
    ("line", "from"): "m",
    ("line", "to"): "m",
    ("normal_force", "from"): "N",
    ("normal_force", "to"): "N",
    ("ruiz", "limit"): "N/m",
    ("swt", "limit"): "Pa",
}
#: Members that are texts, whatever they look like.
TEXTS = frozenset({"label", "name", "pointer", "type", "id", "contact_id", "column", "lateral", "height"})

_NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?"
_QUANTITY = re.compile(rf"\s*({_NUMBER})\s*([^\s\d.+-][^\s]*|1)?\s*")


def unit_of(name: str, parent: str) -> str | None:
    """The SI unit of a member, "" for any, or None for one without."""
    return WITHIN.get((parent, name), MEMBERS.get(name))


def _power(symbol: str) -> tuple[int, str] | None:
    """The power of ten of a unit without a fraction, and the SI unit that it belongs to."""
    if symbol in PLAIN:
        return (-2 if symbol == "%" else 0), PLAIN[symbol]
    for base, unit in PREFIXED.items():
        prefix = symbol[: -len(base)]
        if symbol.endswith(base) and prefix in PREFIXES:
            return PREFIXES[prefix] - (3 if unit == "kg" else 0), unit
    return None


def _scale(symbol: str) -> tuple[int, str] | None:
    over, _, under = symbol.replace("²", "^2").partition("/")
    if not under:
        return _power(over)
    base, _, exponent = under.partition("^")
    above, below = _power(over), _power(base)
    if above is None or below is None or exponent not in ("", "2"):
        return None
    times = 2 if exponent else 1
    unit = f"{above[1]}/{below[1]}" + ("^2" if exponent else "")
    power = above[0] - times * below[0]
    return (power, "Pa") if unit == "N/m^2" else (power, unit)


def refuse(written: object, unit: str, place: str) -> InvalidInput:
    """The refusal of a quantity in another unit."""
    detail = f"{written!s} is not {KINDS.get(unit, unit)}: give a number in {unit}, or one with its unit"
    return InvalidInput("invalid_input", detail, (Fault(place, detail),))


def from_text(text: str, unit: str | None, place: str) -> float | None:
    """The number in SI units that a text says; None if it is not a number with a unit."""
    found = _QUANTITY.fullmatch(text)
    if found is None:
        return None
    number, symbol = found.groups()
    if symbol is None:
        return float(number)
    scale = _scale(symbol)
    if scale is None:
        return None
    if unit and scale[1] != unit:
        raise refuse(f'"{text}"', unit, place)
    # Scaled as a decimal number, so that "20 um" is 2e-5 to the last bit.
    return float(Decimal(number).scaleb(scale[0]))


def from_pint(quantity: Any, unit: str | None, place: str) -> Any:
    """The magnitude in SI units of a quantity of pint."""
    if not unit:
        return quantity.to_base_units().magnitude
    pint_unit = {"1": "dimensionless", "J/m^2": "J/m**2"}.get(unit, unit)
    try:
        return quantity.to(pint_unit).magnitude
    except Exception as error:
        raise refuse(quantity, unit, place) from error
