"""Definitions whose numbers are arrays, one for each of many contacts: those that differ, and which each has."""

from __future__ import annotations

import copy
import json
from collections.abc import Iterator
from dataclasses import dataclass, field, fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import quantities
from .bodies import Part
from .documents import Document, to_document

Place = tuple["str | int", ...]


@dataclass(frozen=True)
class Definitions:
    """Definitions that differ in some numbers: a document, the places of these numbers, and a row of them for each."""

    template: Document
    places: tuple[Place, ...] = ()
    rows: NDArray[np.float64] = field(default_factory=lambda: np.empty((1, 0)))

    def __len__(self) -> int:
        return len(self.rows)

    def document(self, index: int) -> Document:
        """One of the documents: a copy."""
        return _with(copy.deepcopy(self.template), self.places, self.rows[index].tolist())

    def texts(self) -> list[bytes]:
        """The JSON texts of all of them."""
        document = copy.deepcopy(self.template)
        return [json.dumps(_with(document, self.places, row)).encode() for row in self.rows.tolist()]

    def packed(self) -> Document:
        """It as JSON."""
        return {"template": self.template, "places": self.places, "rows": self.rows.tolist()}

    @classmethod
    def unpacked(cls, given: Document) -> Definitions:
        """It of what `packed` wrote."""
        places = tuple(tuple(place) for place in given["places"])
        return cls(given["template"], places, np.array(given["rows"], dtype=np.float64).reshape(-1, len(places)))


def definitions(part: Part, shape: tuple[int, ...] | None) -> tuple[tuple[int, ...], Definitions, NDArray[np.uint32]]:
    """The shape of contacts of a definition, their definitions, and the number of the definition of each contact.

    A number of the definition may be an array, which broadcasts to the shape; without a shape they give it. The numbers
    of definitions are empty if there is one for all.
    """
    arrays = {place: array for place, array in _arrays(part, ()) if array.ndim > 0}
    wanted = np.broadcast_shapes(*(array.shape for array in arrays.values())) if _agree(arrays) else ()
    if shape is None:
        if not arrays:
            raise quantities.refused("/shape", "give the number of contacts, or an array of radii, friction or moduli")
        shape = wanted
    template = to_document(_first(part))
    if not arrays:
        return shape, Definitions(template), np.empty(0, dtype=np.uint32)
    try:
        columns = [np.broadcast_to(array, shape).reshape(-1) for array in arrays.values()]
    except ValueError:
        place = next(place for place, array in arrays.items() if not _broadcasts(array.shape, shape))
        detail = f"an array of shape {arrays[place].shape} does not broadcast to {shape}"
        raise quantities.refused(_pointer(place), detail) from None
    rows, kinds = np.unique(np.stack(columns, axis=1), axis=0, return_inverse=True)
    return shape, Definitions(template, tuple(arrays), rows), kinds.reshape(-1).astype(np.uint32)


def _agree(arrays: dict[Place, NDArray[Any]]) -> bool:
    """Refuses arrays that do not broadcast to one shape."""
    try:
        np.broadcast_shapes(*(array.shape for array in arrays.values()))
    except ValueError:
        shapes = ", ".join(f"{_pointer(place)} {array.shape}" for place, array in arrays.items())
        detail = f"the arrays of the definition do not broadcast to one shape: {shapes}"
        raise quantities.refused(_pointer(next(iter(arrays))), detail) from None
    return True


def _broadcasts(one: tuple[int, ...], to: tuple[int, ...]) -> bool:
    try:
        return np.broadcast_shapes(one, to) == to
    except ValueError:
        return False


def _is_number(annotation: Any) -> bool:
    """Whether a member is one number, which may differ from contact to contact."""
    return str(annotation).split(" | ")[0] == "Quantity"


def _arrays(part: Part, place: Place) -> Iterator[tuple[Place, NDArray[Any]]]:
    """The numbers of a definition with their places in its document, as arrays in SI units."""
    for member in fields(part):  # type: ignore[arg-type]
        value, name = getattr(part, member.name), member.name.removesuffix("_")
        at = _place(place, name)
        if isinstance(value, Part):
            yield from _arrays(value, at)
        elif isinstance(value, list | tuple) and any(isinstance(one, Part) for one in value):
            for index, one in enumerate(value):
                if isinstance(one, Part):
                    yield from _arrays(one, (*at, index))
        elif _is_number(member.type) and value is not None and not isinstance(value, str):
            read = to_document(value, name, "", _pointer(at))
            yield at, np.asarray(read, dtype=np.float64 if isinstance(read, list) else None)


def _place(place: Place, name: str) -> Place:
    """Where a member of a definition is in its document."""
    if place == () and name == "bodies":
        return ("material", "bodies")
    if place == () and name in ("normal_force", "indentation", "contact_radius"):
        return ("preload", name)
    return (*place, name)


def _first(part: Part) -> Part:
    """The same with one number where it has an array."""
    changed: dict[str, Any] = {}
    for member in fields(part):  # type: ignore[arg-type]
        value = getattr(part, member.name)
        if isinstance(value, Part):
            changed[member.name] = _first(value)
        elif isinstance(value, list | tuple) and any(isinstance(one, Part) for one in value):
            changed[member.name] = [_first(one) if isinstance(one, Part) else one for one in value]
        elif _is_number(member.type) and value is not None and not isinstance(value, str):
            read = to_document(value, member.name.removesuffix("_"), "", "")
            changed[member.name] = float(np.asarray(read, dtype=np.float64).reshape(-1)[0])
        else:
            changed[member.name] = value
    return type(part)(**changed)


def _pointer(place: Place) -> str:
    return "".join(f"/{one}" for one in place)


def _with(document: Any, places: tuple[Place, ...], values: list[float]) -> Document:
    """A document with these numbers at these places."""
    for place, value in zip(places, values, strict=True):
        inner = document
        for one in place[:-1]:
            inner = inner[one]
        inner[place[-1]] = value
    whole: Document = document
    return whole
