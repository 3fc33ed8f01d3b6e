"""Numbers with units, as text ("20 um", "100 MPa") or as quantities of pint, to SI floats.

The units themselves are those of the engine: files, requests and texts are read by one table.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from contextlib import suppress
from typing import Any

import numpy as np

from . import _native, members
from .errors import Fault, InvalidInput

#: The units that the descriptions of members leave to what is around them.
MEMBERS = members.MEMBERS | {"dx": "m", "dy": "m"} | dict.fromkeys(("xx", "yy", "zz", "xy", "xz", "yz"), "Pa")
WITHIN = members.WITHIN | {
    ("cycles", "mean"): "",
    ("friction_work", "limit"): "J/m^2",
    ("ruiz", "limit"): "N/m",
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
    """The number in SI units that a text states; None for a text that does not begin with a number.

    A unit that is not in the table of the engine is read by pint, if it is installed: so a number never depends on
    whether pint is installed.
    """
    try:
        return _native.quantity(text, unit or None)
    except ValueError as error:
        found = _parsed_by_pint(text)
        with suppress(InvalidInput, TypeError):
            return float(in_si(found, None, unit, place))
        raise _refusal(f'"{text}": {error}', unit, place) from None


def of_text(text: str, unit: str | None, place: str) -> float | str:
    """The number that a text states; the text itself if it states none and no number is expected."""
    found = from_text(text, unit, place)
    if found is None and unit:
        raise _refusal(f'"{text}" is not a number', unit, place)
    return text if found is None else found


#: A number and a unit of which pint makes no more than it says: it would read "1,000" as a thousand.
_WITH_UNIT = re.compile(r"\s*([-+]?[0-9.]+(?:[eE][-+]?[0-9]+)?)\s*([^\W\d_][\w*^/ .()-]*)")


def _parsed_by_pint(text: str) -> Any:
    found = _WITH_UNIT.fullmatch(text)
    try:
        import pint

        return None if found is None else float(found[1]) * pint.application_registry.parse_units(found[2])
    except Exception:  # pint raises errors of many kinds for a text that it cannot read.
        return None


def measured(value: Any) -> tuple[Any, str | None] | None:
    """A value that has its unit with it, and the name of the unit unless it is a quantity of pint.

    They are quantities and arrays of pint, also as the data of a column of pandas or xarray, and columns whose `attrs`
    have `units`: one text, or texts by the names of the columns.
    """
    if hasattr(value, "to_base_units"):
        return value, None
    if hasattr(getattr(value, "dtype", None), "units"):
        return value.pint.quantity, None
    attributes = getattr(value, "attrs", None)
    if not isinstance(attributes, Mapping):
        return None
    if hasattr(getattr(value, "data", None), "to_base_units"):
        return value.data, None
    named = attributes.get("units")
    if isinstance(named, Mapping):
        named = named.get(getattr(value, "name", None))
    return (np.asarray(value), str(named)) if named else None


def in_si(value: Any, named: str | None, unit: str | None, place: str) -> Any:
    """Numbers in SI units: of a quantity of pint, or of an array in the unit that is named."""
    if named is not None:
        return value * from_text(f"1 {named}", unit, place)
    if not hasattr(value, "to_base_units"):
        return value
    if not unit:
        return value.to_base_units().magnitude
    pint_unit = {"1": "dimensionless", "J/m^2": "J/m**2"}.get(unit, unit)
    try:
        return value.to(pint_unit).magnitude
    except Exception as error:
        raise _refusal(f"{value!s} is not a number of {unit}", unit, place) from error
