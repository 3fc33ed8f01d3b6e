"""What all results have: fields, a table, a picture and a view in notebooks."""

from __future__ import annotations

import inspect
import sys
import typing
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, TypeAlias, TypeVar

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import pandas
    from matplotlib.axes import Axes

#: An array of numbers.
Floats: TypeAlias = NDArray[np.float64]
T = TypeVar("T", bound="Result")

#: The members of a reply whose items are its rows, in order of preference.
_ROWS = ("rows", "cycles", "steps", "peaks", "items", "points", "failures", "loops")


class Result:
    """A reply. `document` is it as JSON, `to_frame` its table, `plot` its picture.

    The fields are the annotations of its class, and do not change. Classes without generated methods, unlike data
    classes, are made in no time when the package is imported.
    """

    @classmethod
    def fields(cls) -> list[str]:
        """The names of the fields."""
        return [name for kind in reversed(cls.__mro__) for name in inspect.get_annotations(kind)]

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError(f"{type(self).__name__} is a result: {name} cannot be set")

    @property
    def document(self) -> dict[str, Any]:
        """The JSON document that the engine replied with."""
        found: dict[str, Any] = self.__dict__.get("_document", {})
        return found

    @property
    def context(self) -> Mapping[str, Any]:
        """What is known of the contact beside the reply."""
        found: Mapping[str, Any] = self.__dict__.get("_context", {})
        return found

    def to_frame(self) -> pandas.DataFrame:
        """The table of the result, with a row for each item and columns in SI units."""
        import pandas

        columns = self._columns()
        if columns:
            return pandas.DataFrame(columns, copy=False)
        for name in _ROWS:
            rows = getattr(self, name, None)
            if isinstance(rows, list) and (not rows or isinstance(rows[0], Result)):
                return pandas.DataFrame([row.scalars() for row in rows])
        return pandas.DataFrame([self.scalars()])

    def to_arrow(self) -> Any:
        """The same table for Arrow (`pip install pyarrow`): columns of floats are those of the result, not copies."""
        import pyarrow

        columns = self._columns()
        return pyarrow.table(columns) if columns else pyarrow.Table.from_pandas(self.to_frame(), preserve_index=False)

    def __arrow_c_stream__(self, requested_schema: object = None) -> object:
        """The table for any library that takes Arrow, such as `polars.DataFrame(result)` or `duckdb`."""
        return self.to_arrow().__arrow_c_stream__(requested_schema)

    def plot(self, ax: Axes | None = None, **options: Any) -> Axes:
        """The picture of the result, in `ax` or in a new figure."""
        from .plots import draw

        return draw(self, ax, **options)

    def scalars(self) -> dict[str, Any]:
        """The members that are single numbers or words."""
        given = {name: getattr(self, name) for name in self.fields()}
        return {name: value for name, value in given.items() if isinstance(value, int | float | str)}

    def _columns(self) -> dict[str, Any]:
        """The arrays, if they are of equal length."""
        given = {name: getattr(self, name) for name in self.fields()}
        arrays = {name: value for name, value in given.items() if _is_column(value)}
        lengths = {len(value) for value in arrays.values()}
        return arrays if len(lengths) == 1 else {}

    def __repr__(self) -> str:
        parts = []
        for name in self.fields():
            value = getattr(self, name)
            if value is None:
                continue
            if isinstance(value, np.ndarray | list):
                parts.append(f"{name}=[{len(value)}]")
            elif isinstance(value, Result):
                parts.append(f"{name}=…")
            else:
                parts.append(f"{name}={value!r}")
        return f"{type(self).__name__}({', '.join(parts)})"

    def _repr_html_(self) -> str:
        html: str = self.to_frame().to_html(max_rows=20)
        return f"<b>{type(self).__name__}</b>{html}"


def _is_column(value: Any) -> bool:
    return isinstance(value, np.ndarray) or (
        isinstance(value, list) and bool(value) and isinstance(value[0], int | float)
    )


_HINTS: dict[type, dict[str, Any]] = {}


def _hints(kind: type[Result]) -> dict[str, Any]:
    """The types of the fields, which are texts until they are asked for."""
    if kind not in _HINTS:
        _HINTS[kind] = typing.get_type_hints(kind, vars(sys.modules[kind.__module__]))
    return _HINTS[kind]


def _parse(value: Any, hint: Any) -> Any:
    if value is None:
        return None
    if hint == Floats:
        return np.array(value, dtype=np.float64)
    if isinstance(hint, type) and issubclass(hint, Result):
        return parse(hint, value)
    arguments = typing.get_args(hint)
    origin = typing.get_origin(hint)
    if origin is list:
        return [_parse(item, arguments[0]) for item in value]
    if origin is dict:
        return {key: _parse(item, arguments[1]) for key, item in value.items()}
    if type(None) in arguments:
        return _parse(value, next(one for one in arguments if one is not type(None)))
    return value


def parse(kind: type[T], document: dict[str, Any], **context: Any) -> T:
    """The result of a JSON document. Members that this version does not know stay in `document`."""
    result = kind.__new__(kind)
    for name, hint in _hints(kind).items():
        result.__dict__[name] = _parse(document.get(name.rstrip("_")), hint)
    result.__dict__["_document"] = document
    result.__dict__["_context"] = context
    return result
