"""The common parts of all results: fields, a table, a picture and a view in notebooks."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from copy import deepcopy
from typing import TYPE_CHECKING, Any, Generic, Protocol, TypeAlias, TypeVar, overload

import numpy as np
from numpy.typing import NDArray

from . import members, schemas, shown
from .optional import needed

if TYPE_CHECKING:
    import pandas
    from matplotlib.axes import Axes

#: Arrays of numbers, whole numbers, flags and words.
Floats: TypeAlias = NDArray[np.float64]
Counts: TypeAlias = NDArray[np.int64]
Flags: TypeAlias = NDArray[np.bool_]
Texts: TypeAlias = NDArray[np.str_]
#: The columns of a table, and their units.
Table: TypeAlias = tuple[dict[str, NDArray[Any]], dict[str, str]]
T = TypeVar("T", bound="Record")
#: Fields of a record that is shown within another one, at most.
MOST_SHOWN = 5


class Curve(Protocol):
    """Moves between states, which are followed when they are drawn."""

    def points(self) -> tuple[Floats, Floats]:
        """Displacements, m, and tangential forces, N."""


class FixedCurve:
    """A curve that has been followed."""

    def __init__(self, displacement: Floats, force: Floats):
        self._points = displacement, force

    def points(self) -> tuple[Floats, Floats]:
        """Displacements, m, and tangential forces, N."""
        return self._points


class Record:
    """An object of a reply: its fields are attributes, and do not change. `document` is the JSON.

    A field that was not asked for is None.
    """

    _document: dict[str, Any]

    def __init__(self, schema: str, document: dict[str, Any], context: Mapping[str, Any] | None = None):
        self.__dict__.update(_schema=schema, _document=document, _context=context or {})

    @property
    def document(self) -> dict[str, Any]:
        """The JSON document that the engine replied with: a copy."""
        return deepcopy(self._document)

    def reply_document(self) -> dict[str, Any]:
        """As `document`: a request takes the record where it takes its document."""
        return self.document

    @property
    def context(self) -> Mapping[str, Any]:
        """What is known of the contact besides the reply."""
        found: Mapping[str, Any] = self.__dict__["_context"]
        return found

    @property
    def schema(self) -> str:
        """The name of its schema in the OpenAPI document."""
        found: str = self.__dict__["_schema"]
        return found

    def fields(self) -> list[str]:
        """The names of its fields."""
        known = list(schemas.FIELDS[self.schema])
        return known + [name for name in self._document if name not in schemas.FIELDS[self.schema]]

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        member = name.removesuffix("_")
        fields = schemas.FIELDS[self.schema]
        if member not in fields and member not in self._document:
            raise AttributeError(f"{self.schema} has no {name}: it has {', '.join(self.fields())}")
        kind = fields.get(member, ("", None))[0]
        value = self.__dict__[name] = _read(self._document.get(member), kind, self.context)
        if isinstance(value, np.ndarray):
            # It is kept, for the table and the picture too.
            value.flags.writeable = False
        return value

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError(f"{self.schema} is a result: {name} cannot be set")

    def __dir__(self) -> list[str]:
        return [*object.__dir__(self), *self.fields()]

    def __reduce__(self) -> tuple[Any, ...]:
        curve = self.context.get("curve")
        kept = {} if curve is None else {"curve": FixedCurve(*curve.points())}
        return record, (self.schema, self._document, {**self.context, **kept})

    def scalars(self) -> dict[str, Any]:
        """The members that are single numbers or words."""
        given = {name: self._document.get(name) for name in self.fields()}
        return {name: value for name, value in given.items() if isinstance(value, int | float | str)}

    def table(self) -> Table:
        """The columns of its table with their units: those that the engine writes in other formats."""
        from .tables_of_results import table

        return table(self)

    def to_frame(self) -> pandas.DataFrame:
        """The table of the result in SI units, which `attrs["units"]` of the frame has by column."""
        columns, units = self.table()
        frame: pandas.DataFrame = needed("pandas", "pandas").DataFrame(columns)
        frame.attrs["units"] = units
        return frame

    def to_arrow(self) -> Any:
        """The same table for Arrow; columns without a missing number are those of the result, not copies."""
        pyarrow = needed("pyarrow", "arrow")
        columns, units = self.table()
        arrays = [pyarrow.array(column, from_pandas=True) for column in columns.values()]
        units_of = [{"unit": units[name]} if name in units else None for name in columns]
        described = zip(columns, arrays, units_of, strict=True)
        named = [pyarrow.field(name, array.type, metadata=unit) for name, array, unit in described]
        return pyarrow.Table.from_arrays(arrays, schema=pyarrow.schema(named))

    def __arrow_c_stream__(self, requested_schema: object = None) -> object:
        """The table for any library that takes Arrow, such as `polars.DataFrame(result)` or `duckdb`."""
        return self.to_arrow().__arrow_c_stream__(requested_schema)

    def plot(self, ax: Axes | None = None, **options: Any) -> Axes:
        """The picture of the result, in `ax` or in a new figure."""
        from .plots import draw

        return draw(self, ax, **options)

    def __repr__(self) -> str:
        parts = []
        for name in self.fields():
            text = self._shown(name)
            if text is not None:
                parts.append(f"{name}={text}")
        return f"{self.schema}({', '.join(parts)})"

    def _shown(self, name: str) -> str | None:
        """A field in a line: numbers with their units, estimates with their errors."""
        value, (kind, unit) = self._document.get(name), schemas.FIELDS[self.schema].get(name, ("", None))
        if value is None:
            return None
        if isinstance(value, list):
            return f"[{len(value)}]"
        if isinstance(value, dict):
            several = _estimates(value) if kind.startswith("{") else None
            return _estimate(value, unit) or several or self._short(name, kind) or "…"
        if isinstance(value, float) and not kind:
            return shown.quantity(value, unit)
        return repr(value)

    def _short(self, name: str, kind: str) -> str | None:
        """A record of few numbers."""
        value = self._document[name]
        return repr(getattr(self, name)) if kind in schemas.FIELDS and len(value) <= MOST_SHOWN else None

    def _repr_html_(self) -> str:
        return f"<b>{self.schema}</b>{shown.table(*self.table())}"


def _estimate(value: dict[str, Any], unit: str | None) -> str | None:
    """A value with its standard error."""
    number, error = value.get("value"), value.get("standard_error")
    if not isinstance(number, int | float):
        return None
    scale, symbol = shown.scaled(unit, abs(number))
    wide = f" ± {error / scale:.2g}" if isinstance(error, int | float) else ""
    return f"{number / scale:.6g}{wide} {symbol}".rstrip()


def _estimates(values: dict[str, Any]) -> str | None:
    """Estimates by their names."""
    found = {
        name: _estimate(value, members.MEMBERS.get(name)) for name, value in values.items() if isinstance(value, dict)
    }
    known = {name: text for name, text in found.items() if text is not None}
    return f"{{{', '.join(f'{name}: {text}' for name, text in known.items())}}}" if known else None


class Result(Record):
    """A reply. `len` and iteration are those of the rows of its table."""

    def __getattr__(self, name: str) -> Any:
        rows = schemas.ROWS.get(self.__dict__.get("_schema", ""))
        if rows is not None and name not in (rows, "_schema") and name not in schemas.FIELDS[self.schema]:
            found = getattr(self, rows)
            if isinstance(found, Rows) and name.removesuffix("_") in schemas.FIELDS[found.schema]:
                return getattr(found, name)
        return super().__getattr__(name)

    def __len__(self) -> int:
        columns, _ = self.table()
        return max((len(column) for column in columns.values()), default=0)

    def __bool__(self) -> bool:
        return True

    def __iter__(self) -> Iterator[Any]:
        """The rows: objects where the reply has them, otherwise tuples with the names of the columns."""
        rows = schemas.ROWS.get(self.schema)
        if rows is not None and isinstance(found := getattr(self, rows), Rows) and len(found) == len(self):
            return iter(found)
        from collections import namedtuple

        columns, _ = self.table()
        row = namedtuple("Row", columns, rename=True)  # type: ignore[misc]
        return map(row._make, zip(*columns.values(), strict=True))


class Rows(Sequence[T], Generic[T]):
    """Objects of one kind, which have each of their fields as an array too: `rows.force`."""

    def __init__(self, schema: str, documents: list[dict[str, Any]], context: Mapping[str, Any] | None = None):
        self.schema = schema
        self._documents = documents
        self._context = context or {}

    @property
    def documents(self) -> list[dict[str, Any]]:
        """The JSON documents of the rows: a copy."""
        return deepcopy(self._documents)

    def reply_document(self) -> list[dict[str, Any]]:
        """As `documents`: a request takes the rows where it takes their documents."""
        return self.documents

    @overload
    def __getitem__(self, index: int) -> T: ...
    @overload
    def __getitem__(self, index: slice) -> Rows[T]: ...
    def __getitem__(self, index: int | slice) -> T | Rows[T]:
        if isinstance(index, slice):
            return Rows(self.schema, self._documents[index], self._context)
        found: T = record(self.schema, self._documents[index], self._context)
        return found

    def __len__(self) -> int:
        return len(self._documents)

    def __getattr__(self, name: str) -> Any:
        member = name.removesuffix("_")
        if name.startswith("_") or member not in schemas.FIELDS[self.schema]:
            raise AttributeError(f"{self.schema} has no {name}")
        return self.column(member)

    def __reduce__(self) -> tuple[Any, ...]:
        return Rows, (self.schema, self._documents, self._context)

    def column(self, name: str) -> NDArray[Any]:
        """A field of each row as an array, with NaN where a number is missing."""
        return as_column([row.get(name) for row in self._documents])

    def table(self) -> Table:
        """The columns of the rows with their units."""
        from .tables_of_results import rows_table

        return rows_table(self)

    def to_frame(self) -> pandas.DataFrame:
        """The rows as a table in SI units, which `attrs["units"]` of the frame has by column."""
        return Record.to_frame(self)  # type: ignore[arg-type]

    def to_arrow(self) -> Any:
        """The same for Arrow."""
        return Record.to_arrow(self)  # type: ignore[arg-type]

    def __repr__(self) -> str:
        return f"[{len(self)} × {self.schema}]"


class Named(dict[str, T], Generic[T]):
    """Objects of one kind by their names."""

    def to_frame(self) -> pandas.DataFrame:
        """A row for each, with its name as the index."""
        module = needed("pandas", "pandas")
        rows = Rows[T](
            next(iter(self.values())).schema if self else "Estimate", [one._document for one in self.values()]
        )
        frame: pandas.DataFrame = module.DataFrame(rows.table()[0], index=module.Index(list(self), name="name"))
        return frame


def as_column(values: list[Any]) -> NDArray[Any]:
    """Values as an array: of numbers with NaN, of whole numbers, flags or words, or else of objects."""
    known = [value for value in values if value is not None]
    if all(isinstance(value, bool) for value in known) and len(known) == len(values) and known:
        return np.array(values, dtype=np.bool_)
    if all(isinstance(value, int) for value in known) and len(known) == len(values) and known:
        return np.array(values, dtype=np.int64)
    if all(isinstance(value, int | float) for value in known):
        return np.array(values, dtype=np.float64)
    if all(isinstance(value, str) for value in known):
        return np.array(values, dtype=np.str_ if len(known) == len(values) else object)
    if all(isinstance(value, list) for value in values) and len({len(value) for value in values}) == 1:
        return np.array(values, dtype=np.float64)
    column = np.empty(len(values), dtype=object)
    column[:] = values
    return column


def _context_of_part(context: Mapping[str, Any]) -> Mapping[str, Any]:
    """The context of a part of a reply, which is not the whole curve."""
    return {name: value for name, value in context.items() if name != "curve"}


def _read(value: Any, kind: str, context: Mapping[str, Any]) -> Any:
    """The attribute of a JSON value: `kind` as `schemas.FIELDS` has it."""
    if value is None:
        return None
    context = _context_of_part(context)
    if not kind:
        # A pair where others of its kind are one number, such as a force in the plane.
        is_pair = isinstance(value, list) and bool(value) and all(isinstance(one, int | float) for one in value)
        return np.array(value, dtype=np.float64) if is_pair else deepcopy(value)
    if kind == "[]":
        return np.array(value, dtype=np.float64)
    if kind in ("#", "?"):
        return np.array(value, dtype=np.int64 if kind == "#" else np.bool_)
    if kind[0] == "[":
        return Rows(kind[1:-1], value, context)
    if kind[0] == "{":
        read = {name: _read(item, kind[1:-1], context) for name, item in value.items()}
        return read if kind == "{[]}" else Named(read)
    return record(kind, value, context)


def record(schema: str, document: dict[str, Any], context: Mapping[str, Any] | None = None) -> Any:
    """The object of a JSON document."""
    from . import results

    return getattr(results, schema, Record)(schema, document, context)


def parse(kind: type[T], document: dict[str, Any], **context: Any) -> T:
    """The result of a JSON document. Members that this version does not know are attributes too."""
    return kind(kind.__name__, document, context)
