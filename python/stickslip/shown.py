"""Numbers as people read them: with a unit whose prefix fits, and few digits."""

from __future__ import annotations

import math
from collections.abc import Iterable
from html import escape
from typing import Any

#: Prefixes of units by their powers of a thousand.
PREFIXES = {-5: "f", -4: "p", -3: "n", -2: "µ", -1: "m", 0: "", 1: "k", 2: "M", 3: "G", 4: "T"}
#: Rows of a table in a notebook, half of them from each end.
MOST_ROWS = 20


def scaled(unit: str | None, largest: float) -> tuple[float, str]:
    """A unit with the prefix that fits numbers up to this one, over the SI unit, and its name."""
    if unit in (None, "", "1", "UTC"):
        return 1.0, ""
    if "²" in unit or "^" in unit or "³" in unit or unit in ("deg", "degrees") or not 0.0 < largest < math.inf:
        return 1.0, unit
    power = min(max(math.floor(math.log10(largest) / 3.0 + 1e-9), min(PREFIXES)), max(PREFIXES))
    return 1000.0**power, PREFIXES[power] + unit


def quantity(value: float, unit: str | None) -> str:
    """One number with its unit."""
    scale, symbol = scaled(unit, abs(value))
    return f"{value / scale:.6g} {symbol}".rstrip()


def cell(value: Any, scale: float) -> str:
    """A cell of a table in a unit."""
    if isinstance(value, float) or (hasattr(value, "dtype") and value.dtype.kind == "f"):
        return "" if math.isnan(value) else f"{value / scale:.6g}"
    return "" if value is None else escape(str(value))


def _largest(values: Iterable[Any]) -> float:
    numbers = [abs(float(value)) for value in values if isinstance(value, int | float) and math.isfinite(value)]
    return max(numbers, default=0.0)


def table(columns: dict[str, Any], units: dict[str, str]) -> str:
    """A table as HTML, in one unit for each column; a single row has a line for each column."""
    length = max((len(column) for column in columns.values()), default=0)
    known = {name: scaled(units.get(name), _largest(column.tolist())) for name, column in columns.items()}
    titles = {name: f"{name} ({symbol})" if symbol else name for name, (_, symbol) in known.items()}
    if length == 1:
        rows = [(escape(titles[name]), cell(column[0], known[name][0])) for name, column in columns.items()]
        return "<table>" + "".join(f"<tr><th>{title}</th><td>{text}</td></tr>" for title, text in rows) + "</table>"
    head = "".join(f"<th>{escape(titles[name])}</th>" for name in columns)
    half = MOST_ROWS // 2
    shown = list(range(length)) if length <= MOST_ROWS else [*range(half), -1, *range(length - half, length)]
    body = []
    for row in shown:
        cells = ("…" if row < 0 else cell(column[row], known[name][0]) for name, column in columns.items())
        body.append("<tr>" + "".join(f"<td>{text}</td>" for text in cells) + "</tr>")
    return f"<table><tr>{head}</tr>{''.join(body)}</table>" + (f"<p>{length} rows</p>" if length > MOST_ROWS else "")
