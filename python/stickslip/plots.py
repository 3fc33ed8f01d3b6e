"""Pictures of results, by Matplotlib, which is imported with the first of them.

Numbers are drawn in SI units; an axis shows them in one unit, with the prefix that fits what is drawn.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from .optional import needed
from .shown import scaled
from .tables_of_results import rows_table

if TYPE_CHECKING:
    from matplotlib.axes import Axes

#: What is on an axis, and its unit.
Said = tuple[str, str]
DISPLACEMENT: Said = ("displacement U", "m")
FORCE: Said = ("tangential force F", "N")
#: What is drawn over the radius: the first that was asked for.
STRESSES = (
    ("shear", "shear stress τ"),
    ("hoop", "hoop stress τ"),
    ("slip", "slip"),
    ("displacement", "displacement"),
)
#: The axes of a loop.
LOOP = (DISPLACEMENT, FORCE)
TWIST: tuple[Said, Said] = ("angle of twist ω", "rad"), ("torque M", "N·m")
BOUND = "friction bound ±μp"


def draw(result: Any, ax: Axes | None, **options: Any) -> Axes:
    """Draws a `Record` in `ax`, or in a new figure."""
    painter: Callable[..., None] = _PAINTERS.get(result.schema, _columns)
    if ax is None:
        needed("matplotlib", "plot")
        from matplotlib import pyplot

        ax = pyplot.figure(layout="constrained").add_subplot()
    painter(ax, result, **options)
    return ax


def _axis(axis: Any, said: Said, limits: tuple[float, float]) -> None:
    """Names an axis with one unit, in which its numbers are shown."""
    name, unit = said
    if unit in ("", "1"):
        axis.set_label_text(name)
        return
    ticker = needed("matplotlib.ticker", "plot")
    scale, symbol = scaled(unit, max(map(abs, limits)))
    axis.set_label_text(f"{name} ({symbol})")
    axis.set_major_formatter(ticker.FuncFormatter(lambda value, _: f"{value / scale:.6g}"))
    axis.set_minor_formatter(ticker.NullFormatter())


def _axes(ax: Axes, x: Said, y: Said, **options: Any) -> None:
    """Names the axes."""
    ax.set(**options)
    _axis(ax.xaxis, x, ax.get_xlim())
    _axis(ax.yaxis, y, ax.get_ylim())


def _bar(ax: Axes, mapped: Any, said: Said) -> None:
    """The scale of colours."""
    bar = ax.figure.colorbar(mapped, ax=ax)
    _axis(bar.ax.yaxis, said, mapped.get_clim())


def _columns(ax: Axes, result: Any, **options: Any) -> None:
    """The columns of one unit over the first."""
    columns, units = result.table()
    numbers = [name for name, column in columns.items() if column.dtype.kind in "if" and column.ndim == 1]
    if len(numbers) < 2 or len(result) < 2:
        raise TypeError(f"{result.schema} has no picture: use to_frame()")
    x, first = numbers[:2]
    alike = [name for name in numbers[1:] if units.get(name) == units.get(first)]
    for name in alike:
        ax.plot(columns[x], columns[name], **({"label": name} | options))
    _axes(ax, (x, units.get(x, "")), (first if len(alike) == 1 else "", units.get(first, "")))
    ax.legend()


def _stress(ax: Axes, result: Any, **options: Any) -> None:
    friction = result.context.get("friction")
    place = "radius" if "radius" in result._document else "x"
    places = getattr(result, place)
    if result.pressure is not None and friction is not None:
        bound = friction * result.pressure
        # Of several states in one picture the bound is named once.
        is_named = any(line.get_label() == BOUND for line in ax.lines)
        ax.plot(places, bound, color="0.6", label="_" if is_named else BOUND)
        ax.plot(places, -bound, color="0.6")
    for name, label in STRESSES:
        values = getattr(result, name)
        if values is not None:
            ax.plot(places, values, **({"label": label} | options))
            break
    is_length = result.shear is None and result.hoop is None and (result.slip, result.displacement) != (None, None)
    said = ("", "m") if is_length else ("stress", "Pa")
    _axes(ax, ("radius r" if place == "radius" else "x", "m"), said)
    ax.legend()


def _residual(ax: Axes, result: Any, **options: Any) -> None:
    columns, _ = result.table()
    place = "radius" if "radius" in columns else "x"
    ax.stem(columns[place], columns["shear"], **options)
    _axes(ax, (place, "m"), ("peak of the shear stress", "Pa"))


def _path(ax: Axes, result: Any, ends: tuple[Any, Any], said: tuple[Said, Said], **options: Any) -> None:
    """The curve of a path through points on the way, and the ends of its moves.

    Without the curve only the ends are drawn: a straight line between them is not what the contact does.
    """
    curve = result.context.get("curve")
    if curve is not None:
        (line,) = ax.plot(*curve.points(), **options)
        options = {name: value for name, value in options.items() if name == "zorder"} | {"color": line.get_color()}
    ax.plot(*ends, **({"linestyle": "none", "marker": ".", "label": "_ends of moves"} | options))
    _axes(ax, *said)


def _simulation(ax: Axes, result: Any, **options: Any) -> None:
    steps = result.steps
    if any("twist" in row for row in steps._documents):
        _path(ax, result, (steps.twist, steps.torque), TWIST, **options)
        return
    _path(ax, result, (steps.displacement, steps.force), LOOP, **options)


def _recorded(ax: Axes, result: Any, **options: Any) -> None:
    columns, _ = result.table()
    is_end = columns.get("part", np.ones(len(columns["force"]))) == 1.0
    is_twisted = np.isfinite(columns["twist"]).any()
    x, y, said = ("twist", "torque", TWIST) if is_twisted else ("displacement", "force", LOOP)
    _path(ax, result, (columns[x][is_end], columns[y][is_end]), said, **options)


def _closed(ax: Axes, result: Any, **options: Any) -> None:
    ax.plot(result.to, result.dissipated_energy, ".-", **options)
    _axes(ax, ("move that closed the cycle", ""), ("friction work of a cycle", "J"))


def _cycle(ax: Axes, result: Any, **options: Any) -> None:
    columns, _ = result.table()
    is_twist = "twist_amplitude" in columns
    x: Said = ("angle amplitude", "rad") if is_twist else ("displacement amplitude", "m")
    amplitude = columns["twist_amplitude" if is_twist else "displacement_amplitude"]
    work = columns["dissipated_energy"]
    said: Said = ("friction work of a cycle", "J")
    if "frequency" in columns:
        for one in np.unique(amplitude):
            chosen = np.flatnonzero(amplitude == one)
            chosen = chosen[np.argsort(columns["frequency"][chosen])]
            label = f"amplitude {one:.3g} m"
            ax.plot(columns["frequency"][chosen], columns["loss_factor"][chosen], **({"label": label} | options))
        _axes(ax, ("frequency", "Hz"), ("loss factor", ""), xscale="log")
        ax.legend()
        return
    if "normal_force" in columns:
        loads = np.unique(columns["normal_force"])
        order = np.lexsort((amplitude, columns["normal_force"]))
        grid = work[order].reshape(len(loads), -1)
        mesh = ax.pcolormesh(loads, amplitude[order].reshape(len(loads), -1)[0], grid.T, **options)
        _bar(ax, mesh, said)
        _axes(ax, ("normal force", "N"), ("displacement amplitude", "m"), xscale="log", yscale="log")
        return
    ax.plot(amplitude, work, **({"linestyle": "none", "marker": "o"} | options))
    _axes(ax, x, said, xscale="log", yscale="log")


def _over_places(ax: Axes, places: tuple[Any, Any, Any], values: Any, said: Said, **options: Any) -> None:
    varying = [(name, axis) for name, axis in zip("xyz", places, strict=True) if np.ptp(axis) > 0]
    if len(varying) == 1:
        ax.plot(varying[0][1], values, **options)
        _axes(ax, (varying[0][0], "m"), said)
        return
    (across, first), (along, second) = varying[:2] if len(varying) > 1 else (("x", places[0]), ("z", places[2]))
    columns, rows = np.unique(first), np.unique(second)
    if len(columns) * len(rows) == len(values) and len(varying) == 2:
        grid = np.full((len(rows), len(columns)), np.nan)
        grid[np.searchsorted(rows, second), np.searchsorted(columns, first)] = values
        # Filled between levels, as the service draws sections: squares of measured points leave stripes.
        colours: Any = ax.contourf(columns, rows, np.ma.masked_invalid(grid), **({"levels": 20} | options))
    else:
        known = np.isfinite(values)
        colours = ax.scatter(first[known], second[known], c=values[known], **options)
    _bar(ax, colours, said)
    _axes(ax, (across, "m"), (along, "m"))
    if along == "z":
        ax.invert_yaxis()


def _below(ax: Axes, result: Any, field: str | None = None, **options: Any) -> None:
    names = ("von_mises", "max_shear", "hydrostatic", "principal_1", "xx")
    field = field or next(name for name in names if getattr(result, name, None) is not None)
    said = (field.replace("_", " ") + (" stress" if field in ("von_mises", "hydrostatic", "xx") else ""), "Pa")
    _over_places(ax, (result.x, result.y, result.z), getattr(result, field), said, **options)


def _fretting(ax: Axes, result: Any, criterion: str | None = None, **options: Any) -> None:
    criterion = criterion or result.worst
    _, units = result.table()
    if len(result.x) == 0 or max(map(np.ptp, (result.x, result.y, result.z))) == 0.0:
        # A search has one place: its picture is how far each criterion is from its limit there.
        _margins(ax, result, **options)
        return
    said = (str(criterion).replace("_", " "), units.get(str(criterion), ""))
    _over_places(ax, (result.x, result.y, result.z), result.ratings[criterion].values, said, **options)


def _margins(ax: Axes, result: Any, **options: Any) -> None:
    margins = {name: rating.margin for name, rating in result.ratings.items() if rating.margin is not None}
    if not margins:
        raise TypeError("no criterion has a limit: there is no margin to draw, use to_frame()")
    ax.bar([name.replace("_", " ") for name in margins], list(margins.values()), **options)
    ax.axhline(1.0, color="0.6", linestyle="--")
    ax.set(ylabel="limit over largest value")


def _wear(ax: Axes, result: Any, **options: Any) -> None:
    shape = result.shape
    ax.fill_between(shape.radius, shape.before, shape.after, alpha=0.3, label="removed")
    ax.plot(shape.radius, shape.before, color="0.6", label="before")
    ax.plot(shape.radius, shape.after, **({"label": "after"} | options))
    _axes(ax, ("radius r", "m"), ("height z", "m"))
    ax.legend()


def _force_in_plane(ax: Axes, result: Any, **options: Any) -> None:
    columns, _ = rows_table(result.steps)
    said: tuple[Said, Said] = ("tangential force along x", "N"), ("tangential force along y", "N")
    _path(ax, result, (columns["force_x"], columns["force_y"]), said, **options)
    ax.set_aspect("equal")


def _sweep(ax: Axes, result: Any, x: str | None = None, y: str | None = None, **options: Any) -> None:
    names = list(result.columns)
    x, y = x or names[0], y or names[-1]
    ax.plot(result.columns[x], result.columns[y], ".", **options)
    ax.set(xlabel=x, ylabel=y)


def _fit(ax: Axes, result: Any, **options: Any) -> None:
    for loop in result.curve:
        ax.plot(loop.displacement, loop.measured, ".", color="0.6", label="measured")
        ax.plot(loop.displacement, loop.force, **({"label": "fitted"} | options))
    _axes(ax, DISPLACEMENT, FORCE)
    ax.legend()


def _scan(ax: Axes, result: Any, **options: Any) -> None:
    ax.plot(result.raw.radius, result.raw.height, ".", color="0.6", label="measured")
    ax.plot(result.used.radius, result.used.height, **({"label": "fitted"} | options))
    _axes(ax, ("radius r", "m"), ("height", "m"))
    ax.legend()


def _protocol(ax: Axes, result: Any, **options: Any) -> None:
    ax.plot(np.arange(1, len(result.path.displacement) + 1), result.path.displacement, ".-", **options)
    _axes(ax, ("move", ""), DISPLACEMENT)


def _accuracy(ax: Axes, result: Any, **options: Any) -> None:
    columns, _ = result.table()
    ax.plot(columns["compute_time"], columns["force_error"], "o", **options)
    _axes(ax, ("time", "s"), ("largest error of the force over μ F_N", ""), xscale="log", yscale="log")


_PAINTERS: dict[str, Callable[..., None]] = {
    "AccuracyReply": _accuracy,
    "CyclePage": _closed,
    "CycleReply": _cycle,
    "FitReply": _fit,
    "FrettingReply": _fretting,
    "HistoryPage": _recorded,
    "LoopPage": _recorded,
    "PathReply": _simulation,
    "PlanarReply": _force_in_plane,
    "ProfileFitReply": _scan,
    "ProtocolReply": _protocol,
    "RelaxReply": _protocol,
    "Residual": _residual,
    "SimulateReply": _simulation,
    "Stress": _stress,
    "StressReply": _stress,
    "SubsurfaceReply": _below,
    "Subsurface": _below,
    "SweepReply": _sweep,
    "WearReply": _wear,
}
