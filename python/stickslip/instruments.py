"""Files of instruments: scans and loops in any encoding, separator and unit and, for scans, format."""

from __future__ import annotations

import json
import math
import os
from dataclasses import dataclass, field
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypedDict

import numpy as np

from . import _native
from .contact import guarded
from .documents import Document
from .errors import InvalidInput
from .result import Floats
from .tables import as_csv, is_table

if TYPE_CHECKING:
    from collections.abc import Mapping

    from typing_extensions import Unpack

#: The most heights that a fit takes.
MOST_HEIGHTS = 300_000


class ScanHints(TypedDict, total=False):
    """Hints about the file of a scan; they take precedence over the header."""

    lateral: str
    """The unit of places, such as "um", "mil" or "10^-6 m"."""
    height: str
    """The unit of heights."""
    spacing: float
    """The distance between neighbours in a matrix, in the unit of places."""
    x: str | int
    """The column of x, by name or number."""
    y: str | int
    """The column of y, by name or number."""
    z: str | int
    """The column of heights, by name or number."""
    sheet: str | int
    """The sheet of a spreadsheet, by name or number."""
    mapping: str | Mapping[str, Any]
    """All of this and more, as the reply has it, or as a dict: {"z": "2:nm", "first_line": 12}."""


class LoopHints(TypedDict, total=False):
    """Hints about the file of a loop; they take precedence over the header."""

    displacement: str | int
    """The column of displacements, by name or number."""
    force: str | int
    """The column of tangential forces, by name or number."""
    time: str | int
    """The column of times, by name or number."""
    load: str | int
    """The column of normal forces, by name or number."""
    displacement_unit: str
    """The unit of displacements, such as "um" or "mil"."""
    force_unit: str
    """The unit of tangential forces, such as "mN" or "lbf"."""
    time_unit: str
    """The unit of times, such as "s" or "min"."""
    load_unit: str
    """The unit of normal forces."""
    sheet: str | int
    """The sheet of a spreadsheet, by name or number."""
    mapping: str | Mapping[str, Any]
    """All of this and more, as the reply has it, or as a dict: {"force": "5:mN", "first_line": 12}."""


@dataclass(frozen=True)
class Scan:
    """Measured heights: the members `scan` and `units` of a request, and how the file was read."""

    scan: Document
    units: dict[str, str]
    reading: tuple[str, ...]
    #: What each column was taken for, with its `name`, `quantity`, `unit`, or why it was `left_out`; empty for a
    #: matrix.
    columns: tuple[Document, ...] = ()
    #: The lines that are not in the scan: their `count`, and the first of their numbers as `lines`.
    rows_left_out: Document = field(default_factory=dict)
    #: What each line of the file is: {kind: {"count": ..., "first": ...}}.
    lines: Document = field(default_factory=dict)
    #: What is in the file and not in the scan, each with its `line` or `column`, its `text` and the `reason`.
    unused: tuple[Document, ...] = ()
    #: What neither the file nor a hint says, in sentences.
    assumed: tuple[str, ...] = ()
    #: The mapping that repeats this reading.
    mapping: str = ""


@dataclass(frozen=True)
class Loop:
    """A measured loop: a member of `loops` and the `units` of a request, and how the file was read."""

    loop: Document
    units: dict[str, str]
    reading: tuple[str, ...]
    #: What each column was taken for, with its `name`, `quantity`, `unit`, or why it was `left_out`.
    columns: tuple[Document, ...] = ()
    #: The lines that are not in the loop: their `count`, and the first of their numbers as `lines`.
    rows_left_out: Document = field(default_factory=dict)
    #: What each line of the file is: {kind: {"count": ..., "first": ...}}.
    lines: Document = field(default_factory=dict)
    #: What is in the file and not in the loop, each with its `line` or `column`, its `text` and the `reason`.
    unused: tuple[Document, ...] = ()
    #: What neither the file nor a hint says, in sentences.
    assumed: tuple[str, ...] = ()
    #: The mapping that repeats this reading.
    mapping: str = ""


def content_of(source: str | os.PathLike[str] | bytes) -> bytes:
    """The bytes of a file, or of a table with named columns as a file."""
    if is_table(source):
        return as_csv(source)
    return source if isinstance(source, bytes) else Path(source).read_bytes()


def mapping_of(mapping: str | Mapping[str, Any]) -> str:
    """A mapping as text: of a dict its entries, of which a pair is a column and its unit."""
    if isinstance(mapping, str):
        return mapping
    text = {
        name: ":".join(map(str, value)) if isinstance(value, tuple | list) else value for name, value in mapping.items()
    }
    return ";".join(f"{name}:{value}" for name, value in text.items())


def hints_of(hints: ScanHints | LoopHints) -> dict[str, Any]:
    """Hints as the importer takes them: a column may be given by its number, and a mapping as a dict."""
    plain: dict[str, Any] = {
        name: str(hint) if isinstance(hint, int) and name != "spacing" else hint for name, hint in hints.items()
    }
    return {name: mapping_of(hint) if name == "mapping" else hint for name, hint in plain.items()}


def _read(read: Any, source: str | os.PathLike[str] | bytes, hints: ScanHints | LoopHints) -> Document:
    """The scan or loop that the importer of the service finds in a file."""
    said = [(name, str(hint)) for name, hint in hints_of(hints).items() if hint is not None]
    found: Document = json.loads(guarded(lambda: read(content_of(source), said)))
    return found


def _seen(found: Document) -> tuple[Any, ...]:
    preview = found["preview"]
    accounts = found.get("lines", {}), tuple(found.get("unused", ())), tuple(found.get("assumed", ()))
    seen = tuple(preview["reading"]), tuple(preview["columns"]), preview["rows_left_out"]
    return (*seen, *accounts, found.get("mapping", ""))


def scan_of(found: Document) -> Scan:
    """The scan of what an importer found."""
    return Scan(found["scan"], found["units"], *_seen(found))


def loop_of(found: Document) -> Loop:
    """The loop of what an importer found."""
    return Loop(found["loop"], found["units"], *_seen(found))


def read_scan(source: str | os.PathLike[str] | bytes, **hints: Unpack[ScanHints]) -> Scan:
    """Reads a scan from a file or from its bytes.

    Hints take precedence over the header: `lateral` and `height` are units ("um", "mil", "10^-6 m"), `x`, `y` and `z`
    columns by name or number, `sheet` that of a spreadsheet, `spacing` the distance of neighbours in a matrix, in the
    unit of places. Files other than columns of text and spreadsheets are read by SurfaceTopography, with the units that
    the file has (`pip install "stickslip[scans]"`).

    Raises
    ------
    InvalidInput
        With the line, the column and the word that is not understood; `unknown_unit` for a unit.
    """
    try:
        found = _read(_native.read_scan, source, hints)
    except InvalidInput as refusal:
        # A fault in a line of columns is one in any program.
        if isinstance(source, bytes) or refusal.pointer != "" or refusal.code != "invalid_input":
            raise
        if find_spec("SurfaceTopography") is None:
            hint = 'other formats of instruments need SurfaceTopography: pip install "stickslip[scans]"'
            raise InvalidInput(refusal.code, f"{refusal.detail}; {hint}") from None
        return _by_surface_topography(Path(source), refusal)
    return scan_of(found)


def _by_surface_topography(path: Path, refusal: InvalidInput) -> Scan:
    """The first channel of a file, in micrometres; of a map too large for a fit every second, third and so on."""
    from SurfaceTopography import open_topography
    from SurfaceTopography.Exceptions import CannotDetectFileFormat

    try:
        reader = open_topography(str(path))
    except CannotDetectFileFormat:
        detail = f"{refusal.detail}; nor is it a file of an instrument that SurfaceTopography knows"
        raise InvalidInput(refusal.code, detail) from None
    read = reader.topography()
    if read.unit is None or read.physical_sizes is None:
        detail = f"{path.name} has no {'unit' if read.unit is None else 'size'}: export it with its scales"
        raise InvalidInput("invalid_input", detail)
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


def read_loop(source: str | os.PathLike[str] | bytes, **hints: Unpack[LoopHints]) -> Loop:
    """Reads a loop from a file or from its bytes.

    Hints take precedence over the header: `displacement`, `force`, `time` and `load` are columns by name or number,
    `displacement_unit`, `force_unit`, `time_unit` and `load_unit` units ("um", "lbf", "min"), `sheet` is that of a
    spreadsheet.

    Raises
    ------
    InvalidInput
        With the line, the column and the word that is not understood; `unknown_unit` for a unit.
    """
    found = _read(_native.read_loop, source, hints)
    return loop_of(found)
