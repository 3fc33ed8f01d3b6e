"""The documents of requests by short forms: `stress=200`, `falling_amplitude=20`, `bulk=("100 MPa", "50 MPa")`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, TypeAlias

from .bodies import elastic_body
from .documents import Document, HasDocument
from .extras import CRITERIA
from .quantities import from_text

#: A number of points, or the document of a request for stresses.
Stress: TypeAlias = int | Mapping[str, Any] | None


def _counted(value: Any, name: str) -> Any:
    return {name: value} if isinstance(value, int) and not isinstance(value, bool) else value


def stress(value: Stress) -> Any:
    """Stresses at so many points, or as the document says."""
    return _counted(value, "points")


def path(**given: Any) -> Document:
    """A path by its one member that is given."""
    for name in ("falling_amplitude", "equal_peaks"):
        given[name] = _counted(given.get(name), "reversals")
    return {name: value for name, value in given.items() if value is not None}


PATHS = ("displacement", "force", "moves", "falling_amplitude", "equal_peaks", "cycles", "ellipse")


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
    """The scan of a request and its units: of a file that was read, a document, or arrays x and z or x, y and z."""
    if hasattr(given, "scan"):
        return given.scan, units or given.units
    if isinstance(given, Mapping):
        return dict(given), units
    columns = [_with_gaps(column) for column in given]
    names = ("x", "z") if len(columns) == 2 else ("x", "y", "z")
    return {"line" if len(columns) == 2 else "points": dict(zip(names, columns, strict=True))}, units


def _with_gaps(column: Any) -> list[float | None]:
    """Numbers, and None where one is missing."""
    return [None if value is None or value != value else float(value) for value in column]


def loops(given: Any, units: Any) -> tuple[list[Any], Any]:
    """The loops of a request and their units: of a file, documents, or arrays of displacement and force."""
    if hasattr(given, "loop"):
        return [given.loop], units or given.units
    if isinstance(given, Mapping):
        return [dict(given)], units
    if (
        isinstance(given, tuple)
        and len(given) == 2
        and not isinstance(given[0], Mapping)
        and not hasattr(given[0], "loop")
    ):
        return [{"displacement": given[0], "force": given[1]}], units
    several = [loops(one, units) for one in given]
    named = [unit for _, unit in several if unit]
    if any(unit != named[0] for unit in named):
        # A request has one pair of units for all of its loops.
        return [_in_si(one, unit) for found, unit in several for one in found], None
    return [one for found, _ in several for one in found], named[0] if named else units


def _in_si(loop: Any, units: Any) -> Any:
    """A loop with its displacements and forces in SI units."""
    factors = {name: from_text(f"1 {unit}", None, f"/units/{name}") for name, unit in (units or {}).items()}
    return {
        name: [value * factors[name] for value in column] if name in factors else column
        for name, column in loop.items()
    }
