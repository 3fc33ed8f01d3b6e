"""Numbers with units, as text ("20 um", "100 MPa") or as quantities of pint, to SI floats.

The units themselves are those of the engine: files, requests and texts are read by one table.
"""

from __future__ import annotations

from typing import Any

from . import _native
from .errors import Fault, InvalidInput

#: The SI unit of each number of a request by the name of its member.
MEMBERS = {
    "a": "m",
    "coefficient": "",
    "contact_radius": "m",
    "cutoff_radius": "m",
    "displacement": "m",
    "drive_force": "N",
    "ductility": "1",
    "ductility_exponent": "1",
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
    "length": "m",
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
    "strength": "Pa",
    "strength_exponent": "1",
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
    ("s_n", "reference"): "",
    ("swt", "limit"): "Pa",
}
#: Members that are texts, whatever they look like.
TEXTS = frozenset({"at", "label", "name", "pointer", "type", "id", "contact_id", "column", "lateral", "height"})


def unit_of(name: str, parent: str) -> str | None:
    """The SI unit of a member, "" for any, or None for one without."""
    return WITHIN.get((parent, name), MEMBERS.get(name))


def _refusal(detail: str, unit: str | None, place: str) -> InvalidInput:
    """The refusal of a unit that is not known, or measures something else."""
    whole = f"{detail}: give a number in {unit}, or one with its unit" if unit else detail
    return InvalidInput("unknown_unit", whole, (Fault(place, whole),))


def from_text(text: str, unit: str | None, place: str) -> float | None:
    """The number in SI units that a text says; None for a text that does not begin with a number."""
    try:
        return _native.quantity(text, unit or None)
    except ValueError as error:
        raise _refusal(f'"{text}": {error}', unit, place) from None


def from_pint(quantity: Any, unit: str | None, place: str) -> Any:
    """The magnitude in SI units of a quantity of pint."""
    if not unit:
        return quantity.to_base_units().magnitude
    pint_unit = {"1": "dimensionless", "J/m^2": "J/m**2"}.get(unit, unit)
    try:
        return quantity.to(pint_unit).magnitude
    except Exception as error:
        raise _refusal(f"{quantity!s} is not a number of {unit}", unit, place) from error
