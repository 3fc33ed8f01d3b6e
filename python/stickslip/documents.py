"""Python values as the JSON documents of requests: units to SI numbers, arrays to lists, objects to members."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, Protocol, TypeAlias, Union, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from . import quantities

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
class HasReply(Protocol):
    """A part of a reply, which is taken wherever a request has the same part."""

    def reply_document(self) -> Any:
        """The JSON of the reply, in SI units: a copy."""


@runtime_checkable
class HasDocument(Protocol):
    """An object that is a part of a request."""

    def document(self) -> Document:
        """The JSON document, with units as they were given."""


def to_document(value: Any, name: str = "", parent: str = "", place: str = "") -> Any:
    """The JSON value of a Python value, which is the member `name` of `parent` at the JSON pointer `place`."""
    if value is None:
        return None
    if isinstance(value, type):
        raise quantities.refused(place, f"{value.__name__} is a class: make one, such as {value.__name__}(...)")
    if isinstance(value, bool | int):
        return _whole(value, name, parent, place)
    if isinstance(value, float):
        if not math.isfinite(value):
            raise quantities.refused(place, f"{value} is not a finite number")
        return float(value)
    if isinstance(value, Mapping):
        return {
            str(key): to_document(item, str(key), name, f"{place}/{key}")
            for key, item in value.items()
            if item is not None
        }
    if isinstance(value, list | tuple | range):
        return [to_document(item, name, parent, f"{place}/{index}") for index, item in enumerate(value)]
    if isinstance(value, HasReply):
        return value.reply_document()
    if isinstance(value, HasDocument):
        return to_document(value.document(), name, parent, place)
    if hasattr(value, "isoformat") and quantities.unit_of(name, parent) is None:
        return value.isoformat()
    return quantities.read(value, name, parent, place)


def _whole(value: int, name: str, parent: str, place: str) -> int:
    """A whole number, or a flag where no number is expected."""
    if isinstance(value, bool) and quantities.unit_of(name, parent) is not None:
        raise quantities.refused(place, f"{value} is a flag, not a number: give {quantities.TAKEN}")
    return value


def floats(value: Any, name: str) -> NDArray[np.float64]:
    """The array of a member in SI units: of numbers, texts, quantities or anything that NumPy makes an array of."""
    if type(value) is np.ndarray and value.dtype == np.float64:
        return value
    return np.asarray(to_document(value, name, "", f"/{name}"), dtype=np.float64)
