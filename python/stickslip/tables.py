"""Tables of pandas, polars and others: columns by their names, with units as files have them."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any, Protocol

import numpy as np

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


def _names(table: Any) -> list[tuple[Any, str]]:
    """The columns of a table, and their names with the units that its `attrs` or the columns say."""
    units = getattr(table, "attrs", {}).get("units", {})
    named = []
    for name in table.columns:
        unit = units.get(name) if isinstance(units, Mapping) else units
        unit = unit or getattr(table[name], "attrs", {}).get("units", {})
        named.append((name, f"{name} ({unit})" if isinstance(unit, str) and unit else str(name)))
    return named


def as_csv(table: Any) -> bytes:
    """A table as a file, which the importer reads by its rules."""
    named = _names(table)
    rows = [";".join(text.replace(";", " ") for _, text in named)]
    columns = [np.asarray(table[name]).tolist() for name, _ in named]
    cells = zip(*columns, strict=True)
    rows += [";".join("" if cell is None or cell != cell else str(cell) for cell in row) for row in cells]
    return "\n".join(rows).encode()


def columns_in_si(table: Any) -> dict[str, list[float]]:
    """The columns of a table by the names of members, in SI units."""
    columns = {}
    for name, text in _names(table):
        found = _NAMED.fullmatch(text)
        if found is None:
            detail = f'the column "{text}" is not named as a member, such as "displacement (um)"'
            raise InvalidInput("invalid_input", detail, (Fault(f"/{name}", detail),))
        values, unit = np.asarray(table[name], dtype=np.float64), quantities.unit_of(found[1], "")
        columns[found[1]] = quantities.in_si(values, found[2], unit, f"/{found[1]}").tolist()
    return columns
