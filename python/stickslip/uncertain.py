"""Uncertain inputs of a sweep: numbers of `uncertainties` and pint with their standard uncertainty, and estimates."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from . import quantities
from .carried_units import carried_by
from .documents import Document, HasReply, to_document

#: What is taken, for refusals.
TAKEN = "a ufloat, an estimate of a fit, {'normal': {...}} or {'uniform': {...}}"


@dataclass(frozen=True)
class Measured:
    """A number with its standard uncertainty, in SI units, and the independent variables that it depends on."""

    mean: float
    standard_uncertainty: float
    variables: Mapping[Any, float]


def has_uncertainty(value: Any) -> bool:
    """Whether a value is a number of `uncertainties`, with or without a unit of pint."""
    return hasattr(getattr(value, "magnitude", value), "std_dev")


def measured(value: Any, unit: str | None, place: str) -> Measured:
    """A number with its uncertainty in an SI unit."""
    carried = carried_by(value)
    if carried is None:
        number = value
    else:
        try:
            number = carried.in_unit(unit)
        except Exception as error:
            detail = f"{value} is not a number of {unit}: give one in {unit}, or with its unit"
            raise quantities.refused(place, detail, "unknown_unit") from error
    uncertainty = float(number.std_dev)
    if not uncertainty > 0.0:
        raise quantities.refused(place, f"{value} has no standard uncertainty above 0: leave it out of the inputs")
    return Measured(float(number.nominal_value), uncertainty, dict(number.derivatives))


def inputs(given: Any) -> list[Any]:
    """The uncertain inputs of a sweep: documents, or distributions by their pointers, of which a tuple is one number.

    One number in several places is one input, and two that depend on each other are refused: inputs are independent.
    """
    entries = list(_entries(given))
    known: list[tuple[Document, Measured | None]] = []
    for index, (entry, value) in enumerate(entries):
        place = f"/inputs/{index}"
        if not has_uncertainty(value):
            known.append((entry | _distribution(value, entry, place), None))
            continue
        found = measured(value, _unit(entry), place)
        same = next((one for one, other in known if other is not None and _is_same(found, other)), None)
        if same is not None:
            same["pointers"] = _pointers(same) + _pointers(entry)
            same.pop("pointer", None)
            continue
        if any(other is not None and found.variables.keys() & other.variables.keys() for _, other in known):
            detail = f"{value} depends on another input, and inputs are independent: name what both are computed from"
            raise quantities.refused(place, detail)
        normal = {"mean": found.mean, "standard_uncertainty": found.standard_uncertainty}
        known.append((entry | {"normal": normal}, found))
    return [entry for entry, _ in known]


def _entries(given: Any) -> Iterator[tuple[Document, Any]]:
    """The members of each input but its distribution, and the distribution."""
    if isinstance(given, Mapping):
        for pointer, value in given.items():
            yield ({"pointer": pointer} if isinstance(pointer, str) else {"pointers": list(pointer)}), value
        return
    if not isinstance(given, Sequence) or isinstance(given, str):
        raise quantities.refused("/inputs", f"distributions by their pointers are expected, each {TAKEN}")
    for entry in given:
        if not isinstance(entry, Mapping):
            raise quantities.refused("/inputs", f"{entry!r} is no input: give a document, or values by their pointers")
        rest = {name: value for name, value in entry.items() if name not in ("normal", "uniform")}
        normal = entry.get("normal")
        whole = {name: entry[name] for name in ("normal", "uniform") if entry.get(name) is not None}
        yield rest, normal if has_uncertainty(normal) else whole


def _distribution(value: Any, entry: Document, place: str) -> Document:
    """The distribution of a document or of an estimate, in SI units."""
    if isinstance(value, HasReply):
        value = value.reply_document()
        if value.get("standard_error") is None or value.get("value") is None:
            raise quantities.refused(place, "the estimate has no standard error: state the uncertainty")
        value = {"normal": {"mean": value["value"], "standard_uncertainty": value["standard_error"]}}
    if not isinstance(value, Mapping):
        raise quantities.refused(place, f"{value!r} has no uncertainty: give {TAKEN}")
    name, parent = _named(entry)
    return {
        kind: {
            member: to_document(number, name, parent, f"{place}/{kind}/{member}")
            for member, number in members.items()
            if number is not None
        }
        if isinstance(members, Mapping)
        else members
        for kind, members in value.items()
    }


def _pointers(entry: Document) -> list[str]:
    return [entry["pointer"]] if "pointer" in entry else list(entry.get("pointers", ()))


def _named(entry: Document) -> tuple[str, str]:
    """The member that an input sets, and the one around it."""
    names = [name for name in next(iter(_pointers(entry)), "").split("/") if name and not name.isdigit()]
    return (names[-1] if names else ""), (names[-2] if len(names) > 1 else "")


def _unit(entry: Document) -> str | None:
    return quantities.unit_of(*_named(entry))


def _is_same(one: Measured, other: Measured) -> bool:
    return one.variables == other.variables and one.mean == other.mean
