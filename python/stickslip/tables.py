"""Tables of pandas, polars, pyarrow, astropy and others: columns by their names, with units as files have them."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from . import quantities
from .carried_units import carried_by


class NamedTable(Protocol):
    """Columns with names."""

    @property
    def columns(self) -> Any:
        """The names."""

    def __getitem__(self, name: Any, /) -> Any:
        """A column."""


def is_table(value: Any) -> bool:
    """Whether a value has columns with names: a table, or an array of NumPy with named fields."""
    if isinstance(value, type | Mapping):
        return False
    if isinstance(value, np.ndarray):
        return value.dtype.names is not None
    return hasattr(value, "columns") and hasattr(value, "__getitem__")


def _names(table: Any) -> list[Any]:
    if isinstance(table, np.ndarray):
        return list(table.dtype.names or ())
    # Those of pyarrow have arrays as `columns`.
    return list(getattr(table, "column_names", None) or table.columns)


def _unit_beside(table: Any, name: Any, place: str) -> str | None:
    """The unit of a column by the attributes of its table, or of its field in a schema of pyarrow."""
    stated = quantities.unit_in_attributes(getattr(table, "attrs", None), name, place)
    schema: Any = getattr(table, "schema", None)
    if stated is None and hasattr(schema, "field"):
        stated = ((schema.field(name).metadata or {}).get(b"unit") or b"").decode()
    return stated or None


def columns_of(table: Any) -> list[tuple[str, str | None, Any]]:
    """The names of the columns without their units, the units that are stated, and the columns."""
    names = _names(table)
    if len(set(map(str, names))) < len(names):
        raise quantities.refused("", "two columns of the table have the same name")
    columns = []
    for name in names:
        place, column = f"/{name}", table[name]
        plain, named = quantities.unit_in_name(name)
        unit = quantities.one_unit(_unit_beside(table, name, place), str(name) if named else None, None, place)
        columns.append((plain if unit or named else str(name), unit or named, column))
    return columns


def _is_missing(cell: Any) -> bool:
    """Whether there is no value: None, NaN, or what pandas has for one of any kind."""
    return cell is None or type(cell).__name__ in ("NAType", "NaTType") or bool(cell != cell)


def _cells(name: str, unit: str | None, column: Any) -> tuple[str, list[Any]]:
    """The cells of a column as a file has them, under the name with the unit; None for what is masked."""
    carried = carried_by(column)
    if carried is not None:
        written = carried.written()
        if written is None:
            raise quantities.refused(
                f"/{name}", f"the unit {carried.symbol} of the column is not known", "unknown_unit"
            )
        mask = quantities.mask_of(column)
        column, unit = written
        column = column if mask is None else np.ma.array(np.ma.getdata(column), mask=mask)
    mask = quantities.mask_of(column)
    cells: NDArray[Any] = np.asarray(np.ma.getdata(column))
    if mask is not None and mask.any():
        cells = cells.astype(object)
        cells[mask] = None
    return (f"{name} ({unit})" if unit and unit != "1" else name), cells.tolist()


def as_csv(table: Any) -> bytes:
    """A table as a file, which the importer reads by its rules."""
    columns = [_cells(*column) for column in columns_of(table)]
    rows = [";".join(text.replace(";", " ") for text, _ in columns)]
    cells = zip(*(values for _, values in columns), strict=True)
    rows += [";".join("" if _is_missing(cell) else str(cell) for cell in row) for row in cells]
    return "\n".join(rows).encode()


def columns_in_si(table: Any, members: Collection[str], beside: Collection[str]) -> dict[str, list[Any]]:
    """The columns of a table by the names of members, in SI units, with None where a number is missing.

    A table that has one of the columns `beside` may have others too, which are left out; no other table may.
    """
    columns = columns_of(table)
    has_others = any(name in beside for name, *_ in columns)
    found: dict[str, list[Any]] = {}
    for name, unit, column in columns:
        place = f"/{name}"
        if has_others and name in beside:
            found[name] = []
        elif name in found:
            raise quantities.refused(place, f"two columns of the table are the {name}")
        elif name in members:
            found[name] = quantities.Reading(name, "", place, gaps=True, stated=unit).column(column)
        elif not has_others:
            detail = f'the column "{name}" is no member of a move: allowed are {", ".join(members)}'
            raise quantities.refused(place, detail)
    return found
