"""The documents of requests by short forms: `stress=200`, `falling_amplitude=20`, `bulk="50 MPa"`, arrays for loops."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeAlias, Union

import numpy as np

from . import quantities
from .bodies import elastic_body
from .documents import Document, HasDocument, HasReply, Quantities, to_document
from .members import EMPTY, SHORT
from .paths import path_of_moves
from .tables import as_csv, is_table
from .uncertain import inputs

if TYPE_CHECKING:
    from .instruments import Loop, Scan
    from .tables import NamedTable

#: A measured loop: a file or its path, a document, a table, an array of two rows, or displacements and forces.
LoopLike: TypeAlias = Union[
    "Loop", str, "os.PathLike[str]", Mapping[str, Any], "NamedTable", "Sequence[Quantities]", Quantities
]
#: A scan: a file or its path, a document, a table, or arrays of x and z or x, y and z.
ScanLike: TypeAlias = Union[
    "Scan", str, "os.PathLike[str]", Mapping[str, Any], "NamedTable", "Sequence[Quantities]", Quantities
]


def assemble(name: str, given: Document, parts: dict[str, Document]) -> Document:
    """The document of a request of its members, each of which may have a short form; those of `parts` are within one.

    `name` is the path of a computation, or the name of a call of a contact.
    """
    given = {member: _object(member, value) for member, value in given.items() if value is not None}
    for part, values in parts.items():
        chosen = {member: _object(member, value) for member, value in values.items() if value is not None}
        whole = given.get(part, {})
        given[part] = (path_of_moves(whole) if part == "path" else dict(whole)) | chosen
    if "contact" in given:
        given["contact"] = definition(given["contact"])
    special = _SPECIAL.get(name.rpartition("/")[2] if name != "/profiles/fit" else name)
    return special(given) if special else given


def _object(member: str, value: Any) -> Any:
    """The object that a number alone, or True, stands for."""
    if value is True and member in EMPTY:
        return {}
    if member == "known" and isinstance(value, Mapping):
        return {name: {"value": one} if quantities.is_number(one) else one for name, one in value.items()}
    if member == "critical_distance" and quantities.is_number(value):
        # The point method of Taylor, the commoner one.
        return {"length": value, "method": "point"}
    short = SHORT.get(member)
    return {short: value} if short is not None and quantities.is_number(value) else value


def definition(contact: Any) -> Document:
    """The definition of a contact or of a document, with units as they were given."""
    if isinstance(contact, type):
        detail = f"{contact.__name__} is a class: make a contact, such as {contact.__name__}(...)"
        raise quantities.refused("/contact", detail)
    if isinstance(contact, HasReply):
        contact = contact.reply_document()
    elif callable(getattr(contact, "definition", None)):
        contact = contact.definition()
    elif isinstance(contact, HasDocument):
        contact = contact.document()
    if not isinstance(contact, Mapping):
        detail = f"{contact!r} is no contact: give a Contact, a Definition or its document"
        raise quantities.refused("/contact", detail)
    return dict(contact)


def _path(given: Document) -> Document:
    """A path: of a table, a reply or a document too, and one number for one move."""
    way = given.get("path", {})
    displacement = way.get("displacement")
    if is_table(displacement) or isinstance(displacement, HasReply | Mapping):
        del way["displacement"]
        way |= path_of_moves(displacement)
    for member in ("displacement", "force", "twist", "torque"):
        if quantities.is_number(way.get(member)):
            way[member] = [way[member]]
    return given


def _stress(given: Document) -> Document:
    """Stresses at 200 places unless they are given."""
    return given if {"points", "radii", "x"} & given.keys() else {"points": 200} | given


def _fretting(given: Document) -> Document:
    """Criteria over the cycle of an amplitude, or over a path; of the first elastic body unless it is named."""
    amplitude = given["path"].get("displacement")
    if quantities.is_number(amplitude):
        given["path"] = {"cycles": {"displacement": amplitude, "count": 1}}
    if isinstance(given.get("bulk"), list | tuple):
        detail = "a bulk stress is its amplitude, or dict(mean=, amplitude=, phase=)"
        raise quantities.refused("/bulk", detail)
    return _path({"body": elastic_body(given.get("contact", {}))} | given)


def _loop_fit(given: Document) -> Document:
    measured, units = loops(given.get("loops", []), given.pop("units", None))
    start = given.pop("start", None)
    given["loops"] = [loop if start is None else loop | {"start": start} for loop in measured]
    return given | ({} if units is None else {"units": units})


def _profile_fit(given: Document) -> Document:
    heights, units = scan(given.get("scan"), given.pop("units", None))
    return given | {"scan": heights} | ({} if units is None else {"units": units})


def _sweep(given: Document) -> Document:
    base = {member: _object(member, value) for member, value in given["base"].items()}
    way = base.get("path")
    if is_table(way) or isinstance(way, HasReply):
        base["path"] = path_of_moves(way)
    elif isinstance(way, list | tuple | str | np.ndarray):
        # Displacements, as for `path`.
        base["path"] = {"displacement": [way] if isinstance(way, str) else way}
    elif isinstance(way, Mapping):
        base["path"] = {member: _object(member, value) for member, value in base["path"].items()}
    if "contact" in base:
        base["contact"] = definition(base["contact"])
    readers = (("axes", axes), ("inputs", inputs), ("outputs", outputs))
    listed = {name: read(given[name]) for name, read in readers if name in given}
    return given | {"base": base} | listed


_SPECIAL = {
    "accuracy": _path,
    "fit": _loop_fit,
    "fretting": _fretting,
    "path": _path,
    "/profiles/fit": _profile_fit,
    "simulate": _path,
    "stress": _stress,
    "sweep": _sweep,
}


def axes(given: Any) -> list[Any]:
    """The axes of a sweep: documents, or values by their pointers."""
    if isinstance(given, Mapping):
        given = [{"pointer": pointer, "values": values} for pointer, values in given.items()]
    return [_axis(axis, f"/axes/{index}") for index, axis in enumerate(given)]


def _axis(axis: Any, place: str) -> Any:
    """An axis whose values have the unit of the number that its pointer names."""
    if not isinstance(axis, Mapping) or axis.get("values") is None or not isinstance(axis.get("pointer"), str):
        return axis
    names = [name for name in axis["pointer"].split("/") if name and not name.isdigit()]
    name, parent = (names[-1] if names else ""), (names[-2] if len(names) > 1 else "")
    return {**axis, "values": to_document(axis["values"], name, parent, f"{place}/values")}


def outputs(given: Any) -> list[Any]:
    """The outputs of a sweep: pointers, documents, or pointers by the names of their columns."""
    if isinstance(given, Mapping):
        return [{"name": name, "pointer": pointer} for name, pointer in given.items()]
    return [given] if isinstance(given, str) else list(given)


def scan(given: Any, units: Any) -> tuple[Any, Any]:
    """The scan of a request and its units.

    It is a file that was read, a document, a table with its columns by their names, or arrays of x and z, or of x, y
    and z.
    """
    if is_table(given):
        from .instruments import read_scan

        given = read_scan(as_csv(given))
    if isinstance(given, str | bytes | os.PathLike):
        from .instruments import read_scan

        given = read_scan(given)
    if hasattr(given, "scan"):
        return given.scan, units or given.units
    if isinstance(given, Mapping):
        return dict(given), units
    names = {2: ("x", "z"), 3: ("x", "y", "z")}.get(len(given) if hasattr(given, "__len__") else 0)
    if names is None:
        raise quantities.refused("/scan", "arrays of x and z, or of x, y and z, are expected")
    _only_one_unit(given, units)
    kind = "line" if len(names) == 2 else "points"
    places = [quantities.Reading(name, kind, f"/scan/{kind}/{name}", gaps=True) for name in names]
    columns = {one.name: one.column(column) for one, column in zip(places, given, strict=True)}
    return {kind: columns}, units


def loops(given: Any, units: Any) -> tuple[list[Any], Any]:
    """The loops of a request and their units.

    A loop is a file that was read, a document, a table with its columns by their names, an array of two rows, or a pair
    of arrays, displacement and force; several of them are a list.
    """
    if is_table(given):
        from .instruments import read_loop

        given = read_loop(as_csv(given))
    if isinstance(given, str | bytes | os.PathLike):
        from .instruments import read_loop

        given = read_loop(given)
    if hasattr(given, "loop"):
        return [given.loop], units or given.units
    if not isinstance(given, Mapping) and _is_pair(given):
        given = {"displacement": given[0], "force": given[1]}
    if isinstance(given, Mapping):
        _only_one_unit([given.get("displacement"), given.get("force")], units)
        return [dict(given)], units
    if not isinstance(given, list | tuple):
        raise quantities.refused(
            "/loops", "a loop is a file that was read, a table, a document, or two arrays of equal length"
        )
    several = [loops(one, units) for one in given]
    named = [unit or None for _, unit in several]
    if any(unit != named[0] for unit in named):
        # A request has one pair of units for all of its loops.
        return [_in_si(one, unit) for found, unit in several for one in found], None
    return [one for found, _ in several for one in found], named[0] if named else None


def _is_pair(given: Any) -> bool:
    """Whether it is displacements and forces: two columns of numbers."""
    if isinstance(given, list | tuple):
        return len(given) == 2 and all(_is_column(one) for one in given)
    return getattr(given, "ndim", 0) == 2 and len(given) == 2


def _is_column(one: Any) -> bool:
    if isinstance(one, list | tuple):
        return len(one) > 0 and isinstance(one[0], int | float | str | np.number)
    return not is_table(one) and hasattr(one, "__array__") and np.ndim(one) == 1


def _only_one_unit(columns: Any, units: Any) -> None:
    """Refuses columns with units of their own where the request names units too."""
    for column in columns:
        first = column[0] if isinstance(column, list | tuple) and column else None
        if units and (quantities.states_unit(column) or isinstance(first, str) or quantities.states_unit(first)):
            raise quantities.refused("/units", "the columns have units of their own: leave out `units`")


def _in_si(loop: Any, units: Any) -> Any:
    """A loop with its displacements and forces in SI units."""
    named = {name: quantities.from_text(f"1 {unit}", None, f"/units/{name}") for name, unit in (units or {}).items()}
    return {
        name: [value * named[name] for value in column] if name in named else column for name, column in loop.items()
    }
