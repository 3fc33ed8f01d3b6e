"""Python values as the JSON documents of requests: units to SI numbers, arrays to lists, objects to members."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, Protocol, TypeAlias, Union, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from . import quantities
from .errors import Fault, InvalidInput

#: A number in SI units, or one with its unit: "20 um", a quantity of pint.
Quantity: TypeAlias = Union[float, int, str, "np.floating[Any]", "HasUnit"]
#: Several of them.
Quantities: TypeAlias = Union["list[Quantity]", "tuple[Quantity, ...]", "NDArray[Any]", "HasUnit", "list[float]"]
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


@runtime_checkable
class HasDocument(Protocol):
    """What is a part of a request."""

    def document(self) -> Document:
        """Its document, with units as they were given."""


def to_document(value: Any, name: str = "", parent: str = "", place: str = "") -> Any:
    """The JSON value of a Python value, which is the member `name` of `parent` at the JSON pointer `place`."""
    if value is None or isinstance(value, bool | int):
        return value
    if isinstance(value, float):
        return _finite(value, place)
    if isinstance(value, str):
        if name in quantities.TEXTS:
            return value
        found = quantities.from_text(value, quantities.unit_of(name, parent), place)
        return value if found is None else found
    if isinstance(value, np.ndarray | np.generic):
        if not np.issubdtype(value.dtype, np.number):
            return to_document(value.tolist(), name, parent, place)
        if not np.isfinite(value).all():
            _finite(float("nan"), place)
        return value.tolist()
    if isinstance(value, Mapping):
        return {key: to_document(item, key, name, f"{place}/{key}") for key, item in value.items() if item is not None}
    if isinstance(value, list | tuple | range):
        return [to_document(item, name, parent, f"{place}/{index}") for index, item in enumerate(value)]
    if isinstance(value, HasDocument):
        return to_document(value.document(), name, parent, place)
    if isinstance(value, HasUnit):
        return to_document(quantities.from_pint(value, quantities.unit_of(name, parent), place))
    return value


def _finite(number: float, place: str) -> float:
    if not math.isfinite(number):
        detail = f"{number} is not a finite number"
        raise InvalidInput("invalid_input", detail, (Fault(place, detail),))
    return number


def members(**given: Any) -> Document:
    """The document with the members that are not None."""
    document = to_document(given)
    assert isinstance(document, dict)
    return document
