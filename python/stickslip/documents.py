"""Python values as the JSON documents of requests: units to SI numbers, arrays to lists, objects to members."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, Protocol, TypeAlias, Union, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from . import quantities
from .errors import Fault, InvalidInput

#: A number in SI units, or one with its unit: "20 um", a quantity of pint.
Quantity: TypeAlias = Union[float, int, str, "np.floating[Any]", "np.integer[Any]", "HasUnit"]
#: Several of them: a sequence, or anything that NumPy makes an array of, such as a column of pandas, polars or xarray.
Quantities: TypeAlias = Union["Sequence[Quantity]", "NDArray[Any]", "HasUnit", "HasArray"]
#: A JSON document.
Document: TypeAlias = dict[str, Any]


@runtime_checkable
class HasUnit(Protocol):
    """A quantity of pint."""

    @property
    def magnitude(self) -> Any:
        """The number without its unit."""

    def to_base_units(self) -> Any:
        """The same in base units."""


class HasArray(Protocol):
    """An object that NumPy makes an array of."""

    def __array__(self, dtype: Any = None, copy: Any = None, /) -> NDArray[Any]:
        """Its numbers."""


@runtime_checkable
class HasDocument(Protocol):
    """An object that is a part of a request."""

    def document(self) -> Document:
        """The JSON document, with units as they were given."""


def to_document(value: Any, name: str = "", parent: str = "", place: str = "") -> Any:
    """The JSON value of a Python value, which is the member `name` of `parent` at the JSON pointer `place`."""
    if value is None or isinstance(value, bool | int):
        return value
    if isinstance(value, float):
        return _finite(value, place)
    if isinstance(value, str):
        if name in quantities.TEXTS or parent == "units":
            return value
        return quantities.of_text(value, quantities.unit_of(name, parent), place)
    if isinstance(value, Mapping):
        return {key: to_document(item, key, name, f"{place}/{key}") for key, item in value.items() if item is not None}
    if isinstance(value, list | tuple | range):
        return [to_document(item, name, parent, f"{place}/{index}") for index, item in enumerate(value)]
    if isinstance(value, HasDocument):
        return to_document(value.document(), name, parent, place)
    measured = quantities.measured(value)
    if measured is not None:
        number = quantities.in_si(*measured, quantities.unit_of(name, parent), place)
        return to_document(number, "", "", place)
    if hasattr(value, "__array__"):
        array = np.asarray(value)
        if array.dtype.kind not in "biuf":
            return to_document(array.tolist(), name, parent, place)
        if array.dtype.kind == "f":
            _all_finite(array, place)
        return array.tolist()
    if hasattr(value, "isoformat"):
        return value.isoformat()
    if hasattr(value, "__float__"):
        return _finite(float(value), place)
    detail = f"{value!r} is neither a number nor a text, an array or a part of a request"
    raise InvalidInput("invalid_input", detail, (Fault(place, detail),))


def floats(value: Any, name: str) -> NDArray[np.float64]:
    """The array of a member in SI units: of numbers, texts, quantities or anything that NumPy makes an array of."""
    if isinstance(value, np.ndarray) and value.dtype == np.float64:
        return value
    return np.asarray(to_document(value, name, "", f"/{name}"), dtype=np.float64)


def _all_finite(array: NDArray[Any], place: str) -> None:
    """Refuses the first number that is not finite at its place."""
    if not np.isfinite(array).all():
        index = np.argwhere(~np.isfinite(array))[0]
        _finite(float(array[tuple(index)]), place + "".join(f"/{one}" for one in index))


def _finite(number: float, place: str) -> float:
    if not math.isfinite(number):
        detail = f"{number} is not a finite number"
        raise InvalidInput("invalid_input", detail, (Fault(place, detail),))
    return number
