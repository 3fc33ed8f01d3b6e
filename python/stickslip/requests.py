"""The documents of requests by short forms: `stress=200`, `falling_amplitude=20`, `bulk=("100 MPa", "50 MPa")`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, TypeAlias

import numpy as np

from . import quantities
from .bodies import elastic_body
from .documents import Document, HasDocument
from .errors import Fault, InvalidInput
from .extras import CRITERIA
from .tables import as_csv, columns_in_si, is_table

#: A number of points, or the document of a request for stresses.
Stress: TypeAlias = int | Mapping[str, Any] | None


def _counted(value: Any, name: str) -> Any:
    return {name: value} if isinstance(value, int) and not isinstance(value, bool) else value


def stress(value: Stress) -> Any:
    """Stresses at so many points, or as the document says."""
    return _counted(value, "points")


def path(**given: Any) -> Document:
    """A path by its one member that is given; a table is its moves, with a column for each target."""
    if is_table(given.get("displacement")):
        columns = columns_in_si(given.pop("displacement"))
        moves = [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)]
        given["moves"] = [{name: value for name, value in move.items() if value == value} for move in moves]
    for name in ("falling_amplitude", "equal_peaks"):
        given[name] = _counted(given.get(name), "reversals")
    return {name: value for name, value in given.items() if value is not None}


PATHS = ("displacement", "force", "moves", "falling_amplitude", "equal_peaks", "cycles")


def split_path(given: dict[str, Any]) -> Document:
    """Takes the path out of keyword arguments: `path=`, or one of its members."""
    if "path" in given:
        return dict(given.pop("path"))
    return path(**{name: given.pop(name) for name in PATHS if name in given})


def definition(contact: Any) -> Document:
    """The definition of a contact or of a document, with units as they were given."""
    if callable(getattr(contact, "definition", None)):
        contact = contact.definition()
    elif isinstance(contact, HasDocument):
        contact = contact.document()
    return dict(contact)


def cycle(displacement: Any = None, force: Any = None, **rest: Any) -> Document:
    """The body of a request for steady cycles without its contact."""
    drive = {name: value for name, value in (("displacement", displacement), ("force", force)) if value is not None}
    rest["work_density"] = _counted(rest.get("work_density"), "points")
    rest["best_load"] = {} if rest.get("best_load") is True else rest.get("best_load")
    machine = rest.get("machine")
    if machine is not None and not isinstance(machine, Mapping):
        rest["machine"] = {"stiffness": machine}
    return {"drive": drive} | {name: value for name, value in rest.items() if value is not None}


def fretting(contact: Any, displacement: Any = None, **rest: Any) -> Document:
    """The body of a request for fatigue criteria: the amplitude of a cycle or a path, and a criterion by its name."""
    defined = definition(contact)
    way = split_path(rest)
    if displacement is not None:
        way = {"cycles": {"displacement": displacement, "count": 1}}
    criteria = dict(rest.pop("criteria", {}))
    for name in CRITERIA:
        if name in rest:
            asked = rest.pop(name)
            criteria[name] = {} if asked is True else asked
    bulk = rest.pop("bulk", None)
    if bulk is not None and not isinstance(bulk, Mapping):
        names = ("mean", "amplitude", "phase")
        bulk = (
            dict(zip(names, bulk, strict=False))
            if isinstance(bulk, Sequence) and not isinstance(bulk, str)
            else {"amplitude": bulk}
        )
    body = rest.pop("body", None) or elastic_body(defined)
    whole = {"contact": defined, "path": way, "body": body, "bulk": bulk, "criteria": criteria} | rest
    return {name: value for name, value in whole.items() if value is not None}


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

    It is a file that was read, a document, a table with its columns by their names, or arrays of x and z, or of all.
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
