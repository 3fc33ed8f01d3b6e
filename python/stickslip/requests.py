"""The documents of requests by short forms: `stress=200`, `falling_amplitude=20`, `bulk="50 MPa"`, arrays for loops."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeAlias, Union

import numpy as np

from . import quantities
from .bodies import elastic_body
from .documents import Document, HasDocument, Quantities
from .errors import Fault, InvalidInput
from .members import EMPTY, SHORT
from .tables import as_csv, columns_in_si, is_table

if TYPE_CHECKING:
    from .instruments import Loop, Scan
    from .tables import NamedTable

#: A measured loop: a file that was read, a document, a table, an array of two rows, or displacements and forces.
LoopLike: TypeAlias = Union["Loop", Mapping[str, Any], "NamedTable", "Sequence[Quantities]", Quantities]
#: A scan: a file that was read, a document, a table, or arrays of x and z or x, y and z.
ScanLike: TypeAlias = Union["Scan", Mapping[str, Any], "NamedTable", "Sequence[Quantities]", Quantities]


def assemble(name: str, given: Document, parts: dict[str, Document]) -> Document:
    """The document of a request of its members, each of which may have a short form; those of `parts` are within one.

    `name` is the path of a computation, or the name of a call of a contact.
    """
    given = {member: _object(member, value) for member, value in given.items() if value is not None}
    for part, values in parts.items():
        chosen = {member: _object(member, value) for member, value in values.items() if value is not None}
        given[part] = dict(given.get(part, {})) | chosen
    if "contact" in given:
        given["contact"] = definition(given["contact"])
    special = _SPECIAL.get(name.rpartition("/")[2] if name != "/profiles/fit" else name)
    return special(given) if special else given


def _object(member: str, value: Any) -> Any:
    """The object that a number alone, or True, stands for."""
    if value is True and member in EMPTY:
        return {}
    short = SHORT.get(member)
    is_plain = isinstance(value, int | float | str) and not isinstance(value, bool)
    is_number = is_plain or hasattr(value, "to_base_units")
    return {short: value} if short is not None and is_number else value


def definition(contact: Any) -> Document:
    """The definition of a contact or of a document, with units as they were given."""
    if callable(getattr(contact, "definition", None)):
        contact = contact.definition()
    elif isinstance(contact, HasDocument):
        contact = contact.document()
    return dict(contact)


def _path(given: Document) -> Document:
    """A path; a table of it is its moves, with a column for each target."""
    way = given.get("path", {})
    if is_table(way.get("displacement")):
        columns = columns_in_si(way.pop("displacement"))
        moves = [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)]
        way["moves"] = [{name: value for name, value in move.items() if value == value} for move in moves]
    return given


def _fretting(given: Document) -> Document:
    """Criteria over the cycle of an amplitude, or over a path; of the first elastic body unless it is named."""
    amplitude = given["path"].get("displacement")
    if amplitude is not None and not is_table(amplitude) and _is_single(amplitude):
        given["path"] = {"cycles": {"displacement": amplitude, "count": 1}}
    if isinstance(given.get("bulk"), list | tuple):
        detail = "a bulk stress is its amplitude, or dict(mean=, amplitude=, phase=)"
        raise _refused("/bulk", detail)
    return _path({"body": elastic_body(given.get("contact", {}))} | given)


def _is_single(value: Any) -> bool:
    return isinstance(value, int | float | str) or np.ndim(getattr(value, "magnitude", value)) == 0


def _loop_fit(given: Document) -> Document:
    measured, units = loops(given.get("loops", []), given.pop("units", None))
    start = given.pop("start", None)
    given["loops"] = [loop if start is None else loop | {"start": start} for loop in measured]
    free = ["friction", "g_star", "force_offset"]
    return {"free": free} | given | ({} if units is None else {"units": units})


def _profile_fit(given: Document) -> Document:
    heights, units = scan(given.get("scan"), given.pop("units", None))
    return given | {"scan": heights} | ({} if units is None else {"units": units})


def _sweep(given: Document) -> Document:
    base = {member: _object(member, value) for member, value in given["base"].items()}
    if isinstance(base.get("path"), Mapping):
        base["path"] = {member: _object(member, value) for member, value in base["path"].items()}
    if "contact" in base:
        base["contact"] = definition(base["contact"])
    return given | {"base": base, "axes": axes(given["axes"]), "outputs": outputs(given["outputs"])}


_SPECIAL = {
    "accuracy": _path,
    "fit": _loop_fit,
    "fretting": _fretting,
    "path": _path,
    "/profiles/fit": _profile_fit,
    "simulate": _path,
    "sweep": _sweep,
}


def axes(given: Any) -> list[Any]:
    """The axes of a sweep: documents, or values by their pointers."""
    if isinstance(given, Mapping):
        return [{"pointer": pointer, "values": values} for pointer, values in given.items()]
    return list(given)


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
    if hasattr(given, "scan"):
        return given.scan, units or given.units
    if isinstance(given, Mapping):
        return dict(given), units
    names = {2: ("x", "z"), 3: ("x", "y", "z")}.get(len(given))
    if names is None:
        raise _refused("/scan", "arrays of x and z, or of x, y and z, are expected")
    _only_one_unit(given, units)
    columns = dict(zip(names, map(_with_gaps, given), strict=True))
    return {"line" if len(names) == 2 else "points": columns}, units


def _with_gaps(column: Any) -> list[float | None]:
    """Numbers, and None where one is missing."""
    found = quantities.measured(column)
    if found is not None:
        column = quantities.in_si(*found, "m", "/scan")
    array = np.asarray(column, dtype=np.float64)
    return [None if value != value else value for value in array.tolist()]


def loops(given: Any, units: Any) -> tuple[list[Any], Any]:
    """The loops of a request and their units.

    A loop is a file that was read, a document, a table with its columns by their names, an array of two rows, or a pair
    of arrays, displacement and force; several of them are a list.
    """
    if is_table(given):
        from .instruments import read_loop

        given = read_loop(as_csv(given))
    if hasattr(given, "loop"):
        return [given.loop], units or given.units
    if not isinstance(given, Mapping) and _is_pair(given):
        given = {"displacement": given[0], "force": given[1]}
    if isinstance(given, Mapping):
        _only_one_unit([given.get("displacement"), given.get("force")], units)
        return [dict(given)], units
    if not isinstance(given, list | tuple):
        raise _refused("/loops", "a loop is a file that was read, a table, a document, or two arrays of equal length")
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
        if units and (quantities.measured(column) or isinstance(first, str) or quantities.measured(first)):
            raise _refused("/units", "the columns have units of their own: leave out `units`")


def _refused(pointer: str, detail: str) -> InvalidInput:
    return InvalidInput("invalid_input", detail, (Fault(pointer, detail),))


def _in_si(loop: Any, units: Any) -> Any:
    """A loop with its displacements and forces in SI units."""
    named = {name: quantities.from_text(f"1 {unit}", None, f"/units/{name}") for name, unit in (units or {}).items()}
    return {
        name: [value * named[name] for value in column] if name in named else column for name, column in loop.items()
    }
