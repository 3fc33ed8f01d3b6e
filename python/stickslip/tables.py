"""Tables of pandas, polars and others: columns by their names, with units as files have them."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from . import quantities
from .errors import Fault, InvalidInput

_NAMED = re.compile(r"\s*(\w+)\s*(?:[(\[]\s*(.*?)\s*[)\]])?\s*")


class NamedTable(Protocol):
    """Columns with names."""

    @property
    def columns(self) -> Any:
        """The names."""

    def __getitem__(self, name: Any, /) -> Any:
        """A column."""


def is_table(value: Any) -> bool:
    """Whether a value has columns with names."""
    return hasattr(value, "columns") and hasattr(value, "__getitem__") and not isinstance(value, Mapping)


def _columns(table: Any) -> list[tuple[str, NDArray[Any]]]:
    """The columns of a table, under their names with the units that they, or the `attrs`, have."""
    units = getattr(table, "attrs", {}).get("units", {})
    columns = []
    for name in table.columns:
        column = table[name]
        unit = units.get(name) if isinstance(units, Mapping) else units
        values, own = quantities.measured(column) or (column, None)
        if hasattr(values, "to_base_units"):
            values, own = values.magnitude, f"{values.units:~}"
        unit = own or unit
        columns.append((f"{name} ({unit})" if unit else str(name), np.asarray(values)))
    return columns


def _is_missing(cell: Any) -> bool:
    """Whether there is no value: None, NaN, or what pandas has for one of any kind."""
    return cell is None or type(cell).__name__ in ("NAType", "NaTType") or bool(cell != cell)


def as_csv(table: Any) -> bytes:
    """A table as a file, which the importer reads by its rules."""
    columns = _columns(table)
    rows = [";".join(text.replace(";", " ") for text, _ in columns)]
    cells = zip(*(values.tolist() for _, values in columns), strict=True)
    rows += [";".join("" if _is_missing(cell) else str(cell) for cell in row) for row in cells]
    return "\n".join(rows).encode()


def columns_in_si(table: Any) -> dict[str, list[float]]:
    """The columns of a table by the names of members, in SI units."""
    columns = {}
    for text, values in _columns(table):
        found = _NAMED.fullmatch(text)
        if found is None:
            detail = f'the column "{text}" is not named as a member, such as "displacement (um)"'
            raise InvalidInput("invalid_input", detail, (Fault(f"/{text}", detail),))
        unit = quantities.unit_of(found[1], "")
        columns[found[1]] = quantities.in_si(values.astype(float), found[2], unit, f"/{found[1]}").tolist()
    return columns
