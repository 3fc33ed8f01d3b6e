"""Every number that comes in: of any kind of value, with its unit, its mask and its name, to floats in SI units.

`read` is the one way. What it does not know it refuses, at the place of the value and with what it takes. The units of
texts are those of the engine: files, requests and texts are read by one table.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from contextlib import suppress
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _native, members
from .carried_units import Carried, carried_by
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
#: Members that are the tangent of an angle: the angle of a flank, and that of friction.
TANGENTS = frozenset({"slope", "friction"})
#: Members of a scan, where a height may be missing.
GAPS = frozenset({("line", "z"), ("map", "z"), ("points", "z")})
#: What is taken, for refusals.
TAKEN = "a number, a text with its unit, a quantity of pint, astropy, unyt or quantities, or an array of them"
_ANGLES = re.compile(
    r"[mµμu]?rad(ian)?s?|deg(ree)?s?|°|º|arc ?min(ute)?s?|arc ?sec(ond)?s?|[′″'\"]|grad(ian)?s?|gons?|turns?"
    r"|rev(olution)?s?|cycles?",
    re.IGNORECASE,
)
#: A number and its unit.
_WITH_UNIT = re.compile(r"\s*([-+]?[0-9.]+(?:[eE][-+]?[0-9]+)?)\s*([^\W\d_][\w*^/ .()-]*|[°º′″'\"])\s*")
#: A name with its unit: "x (um)", "x [um]".
_NAMED = re.compile(r"(.*?)\s*[(\[]\s*([^()\[\]]*?)\s*[)\]]\s*", re.DOTALL)


def unit_of(name: str, parent: str) -> str | None:
    """The SI unit of a member, "" for any, or None for one without."""
    if name in ("value", "standard_error"):
        return MEMBERS.get(parent)
    return WITHIN.get((parent, name), MEMBERS.get(name))


def refused(place: str, detail: str, code: str = "invalid_input") -> InvalidInput:
    """The refusal of a value at its place."""
    return InvalidInput(code, detail, (Fault(place, detail),))


def _wrong_unit(detail: str, unit: str | None, place: str) -> InvalidInput:
    """The refusal of a unit that is not known, or measures something else."""
    known = "a pure number" if unit == "1" else f"a number in {unit}, or one with its unit"
    return refused(place, f"{detail}: give {known}" if unit else detail, "unknown_unit")


def read(value: Any, name: str, parent: str, place: str) -> Any:
    """The JSON value of a number or an array of numbers, of texts or of flags, in SI units.

    `name` is the member of `parent` that it is, `place` its JSON pointer.

    Raises
    ------
    InvalidInput
        For a unit of another dimension, two units that differ, a masked, missing, infinite or complex number, a flag
        where a number is expected, a measurement with an uncertainty, and whatever is none of these.
    """
    return Reading(name, parent, place).read(value)


class Reading:
    """The reading of one member."""

    def __init__(self, name: str, parent: str, place: str, *, gaps: bool | None = None, stated: str | None = None):
        #: A value that is known beforehand is one of the member around it.
        self.name = parent if name == "value" and parent in MEMBERS else name
        self.place = place
        self.unit = unit_of(name, parent)
        #: The unit that stands beside the value.
        self.stated = stated
        self.is_text = name in TEXTS or parent == "units"
        #: Whether missing numbers are None.
        self.gaps = (parent, name) in GAPS if gaps is None else gaps

    def read(self, value: Any) -> Any:
        """The JSON value."""
        if isinstance(value, str):
            return value if self.is_text else self.of_text(value, self.place)
        return self.listed(value, self.place)

    def of_text(self, text: str, place: str) -> float | str:
        """The number that a text states; the text itself if it states none and no number is expected."""
        found = self._stated(text, place)
        if found is None and self.unit:
            raise _wrong_unit(f'"{text}" is not a number', self.unit, place)
        return text if found is None else found

    def column(self, value: Any) -> list[Any]:
        """The numbers of one column."""
        if isinstance(value, list | tuple):
            found: Any = [self._one(item, self.stated, f"{self.place}/{index}") for index, item in enumerate(value)]
        else:
            found = None if isinstance(value, str) else self.listed(value, self.place)
        if not isinstance(found, list) or any(isinstance(item, list | str) for item in found):
            raise refused(self.place, f"a column of numbers is expected, not {_shown(value)}")
        return found

    def _stated(self, text: str, place: str) -> float | None:
        parts = _WITH_UNIT.fullmatch(text)
        if self.unit != "1" or parts is None:
            return from_text(text, self.unit, place)
        if not _ANGLES.fullmatch(parts[2]):
            # An angle may also be known to pint alone.
            carried = carried_by(_parsed_by_pint(text))
            if carried is None or not carried.is_angle:
                return from_text(text, self.unit, place)
            return float(self._pure(float(carried.radians()), text, place))
        degrees = from_text(text, "deg", place)
        return None if degrees is None else float(self._pure(math.radians(degrees), text, place))

    def _pure(self, radians: Any, shown: object, place: str) -> Any:
        """The pure number of an angle: its tangent where that is what the member is."""
        if self.name not in TANGENTS:
            raise _wrong_unit(f'"{shown}" is an angle', self.unit, place)
        return np.tan(radians) if isinstance(radians, np.ndarray) else math.tan(radians)

    def listed(self, value: Any, place: str) -> Any:
        """The JSON value of what is no text."""
        if _is_missing(value):
            return self._missing(place)
        from .tables import columns_of, is_table

        if is_table(value):
            return self._of_table(columns_of(value), place)
        plain, mask, units = self._plain(value, place)
        if plain.dtype.kind in "OUT":
            if mask is not None and mask.any():
                plain = plain.astype(object)
                plain[mask] = None
            return self._each(plain, units, place)
        numbers = self._numbers(plain, mask, place)
        if units is not None:
            numbers = self._converted(numbers, units, place)
        return self._checked(numbers, mask, place)

    def _of_table(self, columns: Sequence[tuple[str, str | None, Any]], place: str) -> list[list[Any]]:
        """The rows of a table of x, y and z; of another one a column has to be chosen, or its units would be lost."""
        named = {name: (unit, column) for name, unit, column in columns}
        axes = [name for name in "xyz" if name in named]
        if set(axes) != set(named) or len(axes) < 2:
            raise refused(place, f"a table of {', '.join(named)} is given: give one of its columns")
        read = [
            Reading(self.name, "", f"{place}/{name}", stated=named[name][0]).column(named[name][1]) for name in axes
        ]
        return [list(row) for row in zip(*read, strict=True)]

    def _plain(self, value: Any, place: str) -> tuple[NDArray[Any], NDArray[np.bool_] | None, str | None]:
        """The array of a value, its mask, and the unit that its name or its attributes state."""
        stated = self.stated or _unit_beside(value, place, self.unit)
        inner = getattr(value, "data", None) if hasattr(value, "attrs") else None
        if inner is not None and carried_by(inner) is not None:
            value = inner
        mask = mask_of(value)
        carried = carried_by(value)
        if carried is not None:
            if stated is not None and not carried.is_in(stated):
                raise refused(
                    place, f"its name has the unit {stated}, its values have {carried.symbol}", "unknown_unit"
                )
            return *self._magnitudes(carried, mask, place), None
        _refuse_unknown(value, place)
        try:
            is_array = hasattr(value, "__array__") or isinstance(value, list)
            # Other objects that state a number are decimals and fractions.
            array = np.asarray(np.ma.getdata(value) if is_array else float(value))
        except Exception as error:
            raise refused(place, f"{_shown(value)} is no array: {error}") from error
        return array, mask, stated

    def _magnitudes(
        self, carried: Carried, mask: NDArray[np.bool_] | None, place: str
    ) -> tuple[NDArray[Any], NDArray[np.bool_] | None]:
        """The numbers of a quantity in SI units."""
        if self.unit == "1" and carried.is_angle:
            numbers = np.asarray(np.ma.getdata(carried.radians()))
            numbers = np.asarray(self._pure(numbers, carried.symbol, place))
        else:
            try:
                numbers = carried.in_unit(self.unit)
            except Exception as error:
                raise _wrong_unit(
                    f"{_shown(carried.value)} is not a number of {self.unit}", self.unit, place
                ) from error
        own = mask_of(numbers)
        return np.asarray(np.ma.getdata(numbers)), own if mask is None else mask

    def _each(self, plain: NDArray[Any], units: str | None, place: str) -> Any:
        """The JSON value of objects or texts, each with a unit of its own or none."""
        if plain.ndim == 0:
            item = plain.item()
            if isinstance(item, str):
                return self.read(item) if units is None else self._with(item, units, place)
            return self._one(item, units, place)
        return [self._each(item, units, f"{place}/{index}") for index, item in enumerate(_rows(plain))]

    def _one(self, item: Any, units: str | None, place: str) -> Any:
        from .documents import to_document

        if _is_missing(item) or item is None:
            return self._missing(place)
        found = to_document(item, self.name, "", place)
        return found if units is None or isinstance(found, list | dict) else self._with(found, units, place)

    def _with(self, item: Any, units: str, place: str) -> Any:
        if isinstance(item, str):
            try:
                item = float(item)
            except ValueError:
                raise refused(place, f'"{item}" is not a number, in a column in {units}') from None
        return self._checked(self._converted(np.asarray(item, dtype=np.float64), units, place), None, place)

    def _numbers(self, array: NDArray[Any], mask: NDArray[np.bool_] | None, place: str) -> NDArray[Any]:
        kind = array.dtype.kind
        if kind == "b" and self.unit is not None:
            raise refused(place, f"{_shown(array.tolist())} is a flag, not a number: give {TAKEN}")
        if kind == "m":
            if self.unit != "s":
                raise _wrong_unit("a duration is not what is expected", self.unit, place)
            return array / np.timedelta64(1, "s")
        if kind not in "biuf":
            raise refused(place, f"{_shown(array)} is not a real number: give {TAKEN}")
        return array.astype(np.float64) if kind == "f" else array

    def _converted(self, numbers: NDArray[Any], units: str, place: str) -> NDArray[Any]:
        """Numbers in a unit that is named beside them, in SI units."""
        if self.unit == "1" and _ANGLES.fullmatch(units):
            factor = math.radians(from_text(f"1 {units}", "deg", place) or 0.0)
            return np.asarray(self._pure(factor * numbers, units, place))
        factor = from_text(f"1 {units}", self.unit, place) or 1.0
        return numbers if factor == 1.0 else np.asarray(numbers * factor)

    def _checked(self, numbers: NDArray[Any], mask: NDArray[np.bool_] | None, place: str) -> Any:
        """The JSON value of numbers; a number that is masked or not finite is refused at its place, or is None."""
        lacking = np.zeros(numbers.shape, dtype=bool) if mask is None else np.broadcast_to(mask, numbers.shape)
        if numbers.dtype.kind == "f":
            wrong = lacking | (np.isnan(numbers) if self.gaps else ~np.isfinite(numbers))
        else:
            wrong = lacking
        if not wrong.any():
            return numbers.tolist()
        first = np.argwhere(wrong)[0]
        if not self.gaps:
            at = place + "".join(f"/{index}" for index in first)
            if lacking[tuple(first)]:
                raise refused(at, "the number is masked: fill or leave out what is missing")
            raise refused(at, f"{numbers[tuple(first)]} is not a finite number")
        filled = numbers.astype(object)
        filled[wrong] = None
        return filled.tolist()

    def _missing(self, place: str) -> None:
        if not self.gaps:
            raise refused(place, "the number is missing: fill or leave out what is missing")


def _rows(array: NDArray[Any]) -> list[NDArray[Any]]:
    """The rows of an array, each still an array."""
    return [array[index, ...] for index in range(len(array))]


def _is_missing(value: Any) -> bool:
    """Whether there is no value: what pandas has for one of any kind, or the masked constant."""
    return value is np.ma.masked or type(value).__name__ in ("NAType", "NaTType")


def mask_of(value: Any) -> NDArray[np.bool_] | None:
    """The mask of an array, of NumPy or of astropy."""
    mask = np.ma.getmaskarray(value) if np.ma.isMaskedArray(value) else getattr(value, "mask", None)
    return np.asarray(mask) if isinstance(mask, np.ndarray | np.bool_ | bool) else None


def _refuse_unknown(value: Any, place: str) -> None:
    """Refuses a value with a unit or an uncertainty that is not known here."""
    module = type(value).__module__.partition(".")[0]
    if module == "uncertainties" or hasattr(value, "nominal_value"):
        raise refused(place, f"{value} has an uncertainty: give its nominal_value, or name it in `inputs` of sweep()")
    if isinstance(value, np.ndarray) and type(value) in (np.ndarray, np.ma.MaskedArray):
        return
    has_unit = any(getattr(value, name, None) is not None for name in ("unit", "units", "dimensionality"))
    if module not in ("numpy", "pandas", "polars", "xarray", "pyarrow", "builtins", "decimal") and has_unit:
        detail = f"{_shown(value)} has a unit of the package {module}, which is not known here: give {TAKEN}"
        raise refused(place, detail, "unknown_unit")
    is_array = hasattr(value, "__array__") or isinstance(value, list)
    if not is_array and not hasattr(value, "__float__"):
        raise refused(place, f"{_shown(value)} is neither {TAKEN}, nor a part of a request")


def _shown(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."


def unit_in_name(name: object) -> tuple[str, str | None]:
    """The name of a column without its unit, and the text of the unit in brackets."""
    found = _NAMED.fullmatch(str(name))
    return (str(name).strip(), None) if found is None else (found[1].strip(), found[2] or None)


def unit_in_attributes(attributes: Any, name: object, place: str) -> str | None:
    """The unit that `attrs["units"]` states: one text, or texts by the names of columns in any case."""
    stated = attributes.get("units", attributes.get("unit")) if isinstance(attributes, Mapping) else None
    if not isinstance(stated, Mapping):
        return str(stated) if stated else None
    if name in stated:
        return str(stated[name]) if stated[name] else None

    def plain(one: object) -> str:
        return unit_in_name(one)[0].casefold()

    found = {str(unit) for key, unit in stated.items() if plain(key) == plain(name) and unit}
    if len(found) > 1:
        raise refused(place, f"attrs have several units for {name}: {', '.join(sorted(found))}", "unknown_unit")
    return found.pop() if found else None


def _unit_beside(value: Any, place: str, unit: str | None) -> str | None:
    """The unit that the attributes or the name of a column state; two that differ are refused."""
    name = getattr(value, "name", None)
    name = name if isinstance(name, str) else None
    return one_unit(unit_in_attributes(getattr(value, "attrs", None), name, place), name, unit, place)


def one_unit(stated: str | None, name: str | None, unit: str | None, place: str) -> str | None:
    """The unit of a column by its attributes and by its name, which must not differ."""
    named = unit_in_name(name)[1] if name else None
    if stated is None or named is None or stated == named:
        return stated or named
    if from_text(f"1 {stated}", unit, place) != from_text(f"1 {named}", unit, place):
        raise refused(place, f'attrs have the unit {stated} for "{name}"', "unknown_unit")
    return stated


def states_unit(value: Any) -> bool:
    """Whether a value has its unit with it."""
    return value is not None and (carried_by(value) is not None or _unit_beside(value, "", None) is not None)


def is_number(value: Any) -> bool:
    """Whether a value is one number, as a number, a text or a quantity."""
    if isinstance(value, int | float | str | np.number) and not isinstance(value, bool):
        return True
    carried = carried_by(value)
    return carried is not None and np.ndim(carried.in_unit(None)) == 0


def from_text(text: str, unit: str | None, place: str) -> float | None:
    """The number in SI units that a text states; None for a text that does not begin with a number.

    A unit that is not in the table of the engine is read by pint, if it is installed: so a number never depends on
    whether pint is installed.
    """
    try:
        return _native.quantity(text, unit or None)
    except ValueError as error:
        carried = carried_by(_parsed_by_pint(text))
        with suppress(Exception):
            if carried is not None:
                return float(carried.in_unit(unit))
        raise _wrong_unit(f'"{text}": {error}', unit, place) from None


def _parsed_by_pint(text: str) -> Any:
    """The quantity of a text of which pint makes no more than it says: it would read "1,000" as a thousand."""
    found = _WITH_UNIT.fullmatch(text)
    try:
        import pint

        return None if found is None else float(found[1]) * pint.application_registry.parse_units(found[2])
    except Exception:  # pint raises errors of many kinds for a text that it cannot read.
        return None
