"""Files of instruments: scans and loops in columns of text, in whatever encoding, separator and unit."""

from __future__ import annotations

import json
import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from . import _native
from .contact import guarded
from .documents import Document


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
    matrix, in the unit of places.
    """
    found = json.loads(guarded(lambda: _native.read_scan(_content(source), **hints)))
    return Scan(found["scan"], found["units"], tuple(found["preview"]["reading"]))


def read_loop(source: str | os.PathLike[str] | bytes, **hints: Any) -> Loop:
    """Reads a loop from a file or from its bytes.

    Hints precede the header: `displacement`, `force`, `time` and `load` are columns by name or number,
    `displacement_unit` and `force_unit` are units ("um", "mN").
    """
    found = json.loads(guarded(lambda: _native.read_loop(_content(source), **hints)))
    return Loop(found["loop"], found["units"], tuple(found["preview"]["reading"]))
