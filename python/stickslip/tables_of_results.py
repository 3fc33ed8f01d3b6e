"""The tables of results: the columns and units that the engine writes as Arrow and CSV for the same reply."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from . import schemas
from .result import Record, Rows, Table, as_column


def table(result: Record) -> Table:
    """The table of a reply: its rows, its columns of equal length, those of a part of it, or its numbers as a row."""
    special = _REPLIES.get(result.schema)
    if special is not None:
        return special(result)
    found = _own_columns(result)
    if found[0]:
        return found
    name = schemas.ROWS.get(result.schema)
    rows = None if name is None else getattr(result, name)
    if isinstance(rows, Rows):
        return rows_table(rows)
    for name in result.fields():
        part = getattr(result, name)
        if isinstance(part, Record) and (found := _own_columns(part))[0]:
            return found
    return _flat([result._document], result.schema)


def rows_table(rows: Rows[Any]) -> Table:
    """The table of rows."""
    special = _ROWS.get(rows.schema)
    return special(rows) if special else _flat(rows._documents, rows.schema)


def _own_columns(result: Record) -> Table:
    """The arrays of a record, if they are of equal length."""
    kinds = schemas.FIELDS[result.schema]
    arrays = {name: getattr(result, name) for name in kinds if kinds[name][0] in ("[]", "#", "?")}
    arrays = {name: array for name, array in arrays.items() if array is not None and array.ndim == 1}
    if len({len(array) for array in arrays.values()}) != 1:
        return {}, {}
    ordered = {name: arrays[name] for name in result._document if name in arrays}
    return ordered, _units(ordered, result.schema)


def _units(columns: Any, schema: str) -> dict[str, str]:
    stated = {name: unit for name, (_, unit) in schemas.FIELDS[schema].items()}
    return {name: unit for name in columns if (unit := stated.get(name)) is not None}


def _flat(documents: list[dict[str, Any]], schema: str, pairs: tuple[str, ...] = ("interval",)) -> Table:
    """The scalars of each row, and these pairs of numbers as two columns each."""
    kinds = schemas.FIELDS[schema]
    present = {name: None for document in documents for name in document}
    names = [name for name in present or kinds if name in pairs or kinds.get(name, ("", None))[0] == ""]
    columns: dict[str, Any] = {}
    units: dict[str, str] = {}
    for name in names:
        column = as_column([document.get(name) for document in documents])
        unit = kinds.get(name, ("", None))[1]
        if name == "interval" and column.ndim == 2:
            parts = dict(zip(("low", "high"), column.T, strict=True))
        elif column.ndim == 2 and column.shape[1] in (2, 3):
            parts = {f"{name}_{axis}": part for axis, part in zip("xyz", column.T, strict=False)}
        elif column.dtype == object and any(isinstance(value, dict | list) for value in column):
            continue
        else:
            parts = {name: column}
        columns |= parts
        units |= {part: unit for part in parts if unit is not None}
    return columns, units


def _optional(documents: list[dict[str, Any]], name: str) -> list[dict[str, Any]]:
    return [document.get(name) or {} for document in documents]


def _history(rows: Rows[Any]) -> Table:
    """Moves: the state after each, the cycle that it closed, and what was measured there."""
    columns = {"sequence": rows.sequence, "at": rows.at}
    units = {"sequence": "1", "at": "UTC"}
    state, state_units = _flat(_optional(rows._documents, "state"), "State")
    shifts, shift_units = _shifts_and_twists(state, len(rows))
    columns |= state | shifts
    units |= state_units | shift_units
    for part, schema, names in (
        ("cycle", "Cycle", {name: f"cycle_{name}" for name in schemas.FIELDS["Cycle"] if name != "to"}),
        (
            "observation",
            "ObservedForce",
            {"force": "observed_force", "predicted": "predicted_force", "innovation": "innovation"},
        ),
    ):
        found = _optional(rows._documents, part)
        for name, shown in names.items():
            columns[shown] = as_column([one.get(name) for one in found])
            units[shown] = schemas.FIELDS[schema][name][1] or ""
    return columns, units


def _shifts_and_twists(columns: Mapping[str, Any], count: int) -> Table:
    """The four columns that a table of moves always has, NaN where they do not apply."""
    names = ("displacement", "force", "twist", "torque")
    found = {name: columns.get(name, np.full(count, np.nan)) for name in names}
    return found, {name: schemas.FIELDS["State"][name][1] or "" for name in names}


def _loop(result: Record) -> Table:
    """The points of a loop, with what was measured beside what was predicted there."""
    columns, units = _own_columns(result)
    shifts, shift_units = _shifts_and_twists(columns, len(result.force))
    columns |= shifts
    units |= shift_units
    measured = columns.get("observed_force", np.full(len(result.force), np.nan))
    columns["observed_force"] = measured
    columns["predicted_force"] = np.where(np.isnan(measured), np.nan, columns["force"])
    columns["innovation"] = measured - columns["force"]
    return columns, units | dict.fromkeys(("observed_force", "predicted_force", "innovation"), "N")


def _cycles(rows: Rows[Any]) -> Table:
    """Steady cycles with their harmonics."""
    columns, units = _flat(rows._documents, rows.schema)
    count = max((len(row.get("harmonics") or ()) for row in rows._documents), default=0)
    for index in range(count):
        for name in ("in_phase", "quadrature"):
            found = [row["harmonics"][index][name] for row in rows._documents]
            columns[f"{name}_{index + 1}"] = as_column(found)
    return columns, units


def _cycle_reply(result: Record) -> Table:
    columns, units = rows_table(result.cycles)
    # Harmonics are of what is not driven.
    unit = "m" if "force" in result.context.get("drive", {}) else "N"
    return columns, units | {name: unit for name in columns if name.startswith(("in_phase_", "quadrature_"))}


def _solvers(rows: Rows[Any]) -> Table:
    """Solvers by their names, with the number of their elements."""
    kinds: list[str] = []
    counts: list[Any] = []
    for row in rows._documents:
        solver = row["solver"]
        name = solver if isinstance(solver, str) else next(iter(solver))
        kinds.append(name)
        counts.append(None if isinstance(solver, str) else solver[name].get("count"))
    columns, units = _flat(rows._documents, rows.schema)
    columns.pop("solver", None)
    refused = [None if row.get("refused") is None else row["refused"]["detail"] for row in rows._documents]
    first = {"solver": np.array(kinds), "count": np.array(counts, dtype=np.float64)}
    last = {"refused": as_column(refused)} if any(refused) else {}
    return first | columns | last, units | {"count": "1"}


def _fitted(rows: Rows[Any]) -> Table:
    """The points of fitted loops."""

    def joined(name: str) -> Any:
        return np.concatenate([np.array(row[name], dtype=np.float64) for row in rows._documents] or [np.empty(0)])

    index = np.repeat(np.arange(len(rows)), [len(row["force"]) for row in rows._documents])
    measured, fitted = joined("measured"), joined("force")
    columns = {"loop": index, "displacement": joined("displacement"), "measured": measured, "fitted": fitted}
    columns |= {"residual": measured - fitted, "used": joined("used").astype(np.int64)}
    return columns, {"loop": "1", "displacement": "m", "measured": "N", "fitted": "N", "residual": "N", "used": "1"}


def _scan(result: Record) -> Table:
    """The points of a scan and of the profile that was fitted to it."""
    parts = {"fitted": result.raw, "left_out": result.left_out, "profile": result.used}
    columns = {"part": np.repeat(list(parts), [len(part.radius) for part in parts.values()])}
    for name in ("radius", "height"):
        columns[name] = np.concatenate([getattr(part, name) for part in parts.values()])
    return columns, {"part": "", "radius": "m", "height": "m"}


def _peaks(result: Record) -> Table:
    """Extrema of the shear stress, each by the next one outwards, the one inside it, the centre, or its sign."""
    columns, units = rows_table(result.peaks)
    shears = [peak.get("shear") for peak in result.peaks._documents]
    words = []
    for index, own in enumerate(shears):
        outside = shears[index + 1] if index + 1 < len(shears) else None
        inside = shears[index - 1] if index else result.centre
        neighbour = inside if outside is None else outside
        if own is None:
            is_maximum = neighbour is None or neighbour <= 0.0
        else:
            is_maximum = own > (0.0 if neighbour is None else neighbour)
        words.append("maximum" if is_maximum else "minimum")
    if not words:
        columns = {"radius": np.empty(0), "shear": np.empty(0)}
    return columns | {"kind": np.array(words, dtype=np.str_)}, units | {"kind": ""}


def _simulation(result: Record) -> Table:
    """The extrema if they were asked for, else the stresses, else the states."""
    part = getattr(result, "residual", None) or result.stress
    return rows_table(result.steps) if part is None else table(part)


def _states_in_plane(rows: Rows[Any]) -> Table:
    return _flat(rows._documents, rows.schema, ("displacement", "force"))


def _rating(result: Record) -> Table:
    """Criteria at each place; without places each criterion with its largest value."""
    ratings = result.ratings
    if len(result.x) > 0:
        columns = {name: getattr(result, name) for name in "xyz"}
        for name, rating in ratings.items():
            columns[name] = rating.values
            if rating.cycles is not None:
                columns[f"{name}_cycles"] = rating.cycles
        lives = {name: "1" for name in columns if name.endswith("_cycles")}
        return columns, _units(columns, result.schema) | lives
    largest = [rating.largest for rating in ratings.values()]
    points = np.array([[np.nan] * 3 if one is None else one.point for one in largest], dtype=np.float64)
    columns = {
        "criterion": np.array(list(ratings), dtype=np.str_),
        "largest": as_column([None if one is None else one.value for one in largest]),
        "margin": as_column([rating.margin for rating in ratings.values()]),
    }
    columns |= dict(zip("xyz", points.T, strict=True))
    return columns, _units("xyz", result.schema) | {"margin": "1"}


def _wear(result: Record) -> Table:
    shape, pressure = result.shape, result.pressure
    columns = {"radius": shape.radius, "height_before": shape.before, "height_after": shape.after}
    columns |= {"pressure_before": pressure.before, "pressure_after": pressure.after}
    return columns, dict(zip(columns, ("m", "m", "m", "Pa", "Pa"), strict=True))


def _sweep(result: Record) -> Table:
    columns: dict[str, Any] = result.columns
    return columns, {}


def _uncertain(result: Any) -> Table:
    """A row for each output, with a column for the share of each input."""
    columns, units = _flat(result.outputs._documents, "UncertainOutput")
    for name in dict.fromkeys(name for output in result.outputs._documents for name in output["shares"]):
        found = [output["shares"].get(name, {}).get("value") for output in result.outputs._documents]
        columns[f"share of {name}"] = as_column(found)
        units[f"share of {name}"] = "1"
    return columns, units


def _tractions(result: Any) -> Table:
    """Tractions along x; the ends of the stick zone are no column."""
    columns = {name: getattr(result, name) for name in ("x", "pressure", "shear")}
    return columns, _units(columns, result.schema)


_REPLIES: dict[str, Callable[[Any], Table]] = {
    "CycleReply": _cycle_reply,
    "FrettingReply": _rating,
    "LoopPage": _loop,
    "PlanarReply": _simulation,
    "ProfileFitReply": _scan,
    "RollingReply": _tractions,
    "Residual": _peaks,
    "SimulateReply": _simulation,
    "SweepReply": _sweep,
    "UncertaintyReply": _uncertain,
    "WearReply": _wear,
}
_ROWS: dict[str, Callable[[Rows[Any]], Table]] = {
    "AccuracyRow": _solvers,
    "FittedLoop": _fitted,
    "HistoryItem": _history,
    "PlanarState": _states_in_plane,
    "SteadyCycle": _cycles,
}
