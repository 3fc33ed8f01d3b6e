"""Pictures of results, by Matplotlib, which is imported with the first of them."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def draw(result: Any, ax: Axes | None, **options: Any) -> Axes:
    """Draws a `Result` in `ax`, or in a new figure."""
    painter = _PAINTERS.get(type(result).__name__)
    if painter is None:
        raise TypeError(f"{type(result).__name__} has no picture: use to_frame()")
    if ax is None:
        from matplotlib import pyplot

        ax = pyplot.figure().add_subplot()
    painter(ax, result, **options)
    return ax


def _stress(ax: Axes, result: Any, **options: Any) -> None:
    friction = result.context.get("friction")
    if result.pressure is not None and friction is not None:
        bound = friction * result.pressure
        ax.plot(result.radius, bound, color="0.6", label="friction bound ±μp")
        ax.plot(result.radius, -bound, color="0.6")
    for name, label in (("shear", "shear stress τ"), ("slip", "slip"), ("displacement", "displacement")):
        values = getattr(result, name)
        if values is not None:
            ax.plot(result.radius, values, label=label, **options)
            break
    ax.set(xlabel="radius r, m", ylabel="stress, Pa" if result.shear is not None else "m")
    ax.legend()


def _residual(ax: Axes, result: Any, **options: Any) -> None:
    ax.stem([peak.radius for peak in result.peaks], [peak.shear for peak in result.peaks], **options)
    ax.set(xlabel="radius r, m", ylabel="peak of the shear stress, Pa")


def _loop(ax: Axes, result: Any, **options: Any) -> None:
    ax.plot([one.displacement for one in result.steps], [one.force for one in result.steps], ".-", **options)
    ax.set(xlabel="displacement U, m", ylabel="tangential force F, N")


def _recorded(ax: Axes, result: Any, **options: Any) -> None:
    ax.plot(result.displacement, result.force, **options)
    ax.set(xlabel="displacement U, m", ylabel="tangential force F, N")


def _cycle(ax: Axes, result: Any, **options: Any) -> None:
    frame = result.to_frame()
    if "normal_force" in frame:
        table = frame.pivot_table(index="displacement_amplitude", columns="normal_force", values="dissipated_energy")
        mesh = ax.pcolormesh(table.columns, table.index, table.to_numpy(), **options)
        ax.figure.colorbar(mesh, ax=ax, label="friction work of a cycle, J")
        ax.set(xlabel="normal force, N", ylabel="displacement amplitude, m", xscale="log", yscale="log")
        return
    ax.plot(frame["displacement_amplitude"], frame["dissipated_energy"], ".-", **options)
    ax.set(xlabel="displacement amplitude, m", ylabel="friction work of a cycle, J", xscale="log", yscale="log")


def _over_places(ax: Axes, places: tuple[Any, Any, Any], values: Any, label: str, **options: Any) -> None:
    varying = [(name, axis) for name, axis in zip("xyz", places, strict=True) if np.ptp(axis) > 0]
    if len(varying) == 1:
        ax.plot(varying[0][1], values, **options)
        ax.set(xlabel=f"{varying[0][0]}, m", ylabel=label)
        return
    (across, first), (along, second) = varying[:2] if len(varying) > 1 else (("x", places[0]), ("z", places[2]))
    known = np.isfinite(values)
    colours = ax.scatter(first[known], second[known], c=values[known], marker="s", **options)
    ax.figure.colorbar(colours, ax=ax, label=label)
    ax.set(xlabel=f"{across}, m", ylabel=f"{along}, m")
    if along == "z":
        ax.invert_yaxis()


def _below(ax: Axes, result: Any, field: str | None = None, **options: Any) -> None:
    names = ("von_mises", "max_shear", "hydrostatic", "principal_1", "xx")
    field = field or next(name for name in names if getattr(result, name) is not None)
    _over_places(ax, (result.x, result.y, result.z), getattr(result, field), f"{field}, Pa", **options)


def _fretting(ax: Axes, result: Any, criterion: str | None = None, **options: Any) -> None:
    criterion = criterion or result.worst
    if len(result.x) == 0:
        frame = result.to_frame()
        ax.bar(frame["criterion"], frame["margin"].fillna(0.0), **options)
        ax.set(ylabel="limit over largest value")
        return
    _over_places(ax, (result.x, result.y, result.z), result.ratings[criterion].values, criterion, **options)


def _force_in_plane(ax: Axes, result: Any, **options: Any) -> None:
    columns = result._columns()
    ax.plot(columns["force_x"], columns["force_y"], **options)
    ax.set(xlabel="tangential force along x, N", ylabel="tangential force along y, N", aspect="equal")


def _sweep(ax: Axes, result: Any, x: str | None = None, y: str | None = None, **options: Any) -> None:
    names = list(result.columns)
    x, y = x or names[0], y or names[-1]
    ax.plot(result.columns[x], result.columns[y], ".", **options)
    ax.set(xlabel=x, ylabel=y)


def _fit(ax: Axes, result: Any, **options: Any) -> None:
    for loop in result.curve:
        ax.plot(loop.displacement, loop.measured, ".", color="0.6", label="measured")
        ax.plot(loop.displacement, loop.force, label="fitted", **options)
    ax.set(xlabel="displacement U, m", ylabel="tangential force F, N")
    ax.legend()


_PAINTERS: dict[str, Callable[..., None]] = {
    "CycleReply": _cycle,
    "FitReply": _fit,
    "FrettingReply": _fretting,
    "LoopPage": _recorded,
    "PathReply": _loop,
    "PlanarReply": _force_in_plane,
    "Residual": _residual,
    "SimulateReply": _loop,
    "Stress": _stress,
    "StressReply": _stress,
    "SubsurfaceReply": _below,
    "Subsurface": _below,
    "SweepReply": _sweep,
}
