"""Files of instruments: scans and loops in whatever encoding, separator, unit and, for scans, format."""

from __future__ import annotations

import json
import math
import os
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np

from . import _native
from .contact import guarded
from .documents import Document
from .result import Floats

#: The most heights that a fit takes.
MOST_HEIGHTS = 300_000


@dataclass(frozen=True)
class Scan:
    """Measured heights: the members `scan` and `units` of a request, and what was taken for what."""

    scan: Document
    units: dict[str, str]
    reading: tuple[str, ...]


@dataclass(frozen=True)
class Loop:
    """A measured loop: a member of `loops` and the `units` of a request, and what was taken for what."""

    loop: Document
    units: dict[str, str]
    reading: tuple[str, ...]


def _content(source: str | os.PathLike[str] | bytes) -> bytes:
    return source if isinstance(source, bytes) else Path(source).read_bytes()


def read_scan(source: str | os.PathLike[str] | bytes, **hints: Any) -> Scan:
    """Reads a scan from a file or from its bytes.

    Hints precede the header: `lateral` and `height` are units ("um"), `spacing` is the distance of neighbours in a
    matrix, in the unit of places. What is no text in columns is read by SurfaceTopography, with the units that the
    file has (`pip install "stickslip[scans]"`).
    """
    try:
        found = json.loads(guarded(lambda: _native.read_scan(_content(source), **hints)))
    except ValueError as refusal:
        if isinstance(source, bytes):
            raise
        if find_spec("SurfaceTopography") is None:
            raise ValueError(f'{refusal} (pip install "stickslip[scans]" reads other formats of instruments)') from None
        return _by_surface_topography(Path(source), refusal)
    return Scan(found["scan"], found["units"], tuple(found["preview"]["reading"]))


def _by_surface_topography(path: Path, refusal: ValueError) -> Scan:
    """The first channel of a file, in micrometres; of a map too large for a fit every second, third and so on."""
    from SurfaceTopography import open_topography
    from SurfaceTopography.Exceptions import CannotDetectFileFormat

    try:
        reader = open_topography(str(path))
    except CannotDetectFileFormat:
        raise ValueError(f"{refusal}; nor is it a file of an instrument that SurfaceTopography knows") from None
    read = reader.topography()
    if read.unit is None or read.physical_sizes is None:
        raise ValueError(f"{path.name} has no {'unit' if read.unit is None else 'size'}: export it with its scales")
    topography = read.to_unit("um")
    heights: Floats = np.ma.filled(np.ma.asarray(topography.heights(), dtype=float), np.nan)
    if topography.dim == 1:
        places = np.asarray(topography.positions(), dtype=float)
        scan: Document = {"line": {"x": places.tolist(), "z": _with_gaps(heights)}}
        shape = f"{len(places)} places"
    else:
        every = max(1, math.ceil(math.sqrt(heights.size / MOST_HEIGHTS)))
        dx, dy = (
            every * float(size) / count for size, count in zip(topography.physical_sizes, heights.shape, strict=True)
        )
        # Its first index runs along x; rows are along x here.
        scan = {"map": {"dx": dx, "dy": dy, "z": [_with_gaps(row) for row in heights.T[::every, ::every]]}}
        shape = f"{heights.shape[0]} x {heights.shape[1]} heights, dx = {dx / every:.6g} um, dy = {dy / every:.6g} um"
        if every > 1:
            shape += f", of which one in {every} along each axis is taken"
    reading = (f"{reader.format()}, by SurfaceTopography", f"{shape}, heights in {read.unit}")
    return Scan(scan, {"lateral": "um", "height": "um"}, reading)


def _with_gaps(row: Any) -> list[float | None]:
    return [None if math.isnan(height) else float(height) for height in row]


def read_loop(source: str | os.PathLike[str] | bytes, **hints: Any) -> Loop:
    """Reads a loop from a file or from its bytes.

    Hints precede the header: `displacement`, `force`, `time` and `load` are columns by name or number,
    `displacement_unit` and `force_unit` are units ("um", "mN").
    """
    found = json.loads(guarded(lambda: _native.read_loop(_content(source), **hints)))
    return Loop(found["loop"], found["units"], tuple(found["preview"]["reading"]))
