"""Files of which every line is accounted for: read as what they hold, or refused with a mapping that settles it."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import stickslip as ss

FOLDER = Path(__file__).parents[2] / "tests" / "table_files"
TRUTH = json.loads((FOLDER / "truth.json").read_text())
FACTORS = {"nm": 1e-9, "um": 1e-6, "mm": 1e-3, "m": 1.0, "uN": 1e-6, "mN": 1e-3, "N": 1.0, "kN": 1e3}
ASKING = {"ask", "ask_load", "said", "said_block", "read_or_refuse", "map_or_ask"}


def read(entry: dict[str, Any], mapping: str | None = None) -> ss.Loop | ss.Scan:
    """The loop or scan of a file, with what its entry says of it."""
    hints: dict[str, Any] = dict(part.split("=") for part in entry["query"].removeprefix("?").split("&") if part)
    if mapping is not None:
        hints["mapping"] = mapping
    path = FOLDER / entry["file"]
    return ss.read_loop(path, **hints) if entry["kind"] == "loop" else ss.read_scan(path, **hints)


def is_right(found: ss.Loop | ss.Scan, entry: dict[str, Any]) -> bool:
    """Whether a loop or scan is the one that all files hold."""
    if isinstance(found, ss.Scan):
        return is_right_scan(found, entry["truth"])
    truth, more = TRUTH["loop"], entry["truth"]
    measured = [
        (found.loop["displacement"], found.units["displacement"], truth["displacement_m"], 2e-10),
        (found.loop["force"], found.units["force"], truth["force_N"], 6e-3),
    ]
    for values, unit, expected, near in measured:
        values = np.multiply(values, FACTORS[unit])
        if len(values) != len(expected) or not np.allclose(values, expected, rtol=0, atol=near):
            return False
    load, times = found.loop.get("normal_force"), found.loop.get("time")
    is_load = load is None or "load" not in more or load == pytest.approx(more["load"], rel=1e-3)
    is_time = times is None or "dt" not in more or np.mean(np.diff(times)) == pytest.approx(more["dt"], rel=0.05)
    return bool(is_load and is_time)


def is_right_scan(found: ss.Scan, more: dict[str, Any]) -> bool:
    """Whether a line has the places and heights of the truth, or a map the curvature of a ball of 8 mm."""
    lateral, height = FACTORS[found.units["lateral"]], FACTORS[found.units["height"]]
    if "line" in found.scan:
        x, z = (np.asarray(found.scan["line"][axis], dtype=float) for axis in "xz")
        truth = np.asarray(TRUTH["scan"]["x_m"])
        is_place = np.allclose((x - x[0]) * lateral, truth - truth[0], rtol=0, atol=1e-9)
        return is_place and np.allclose(z * height, TRUTH["scan"]["z_m"], rtol=0, atol=1e-11)
    grid = found.scan["map"]
    distance = more["d"] * (1 if "si" in more else 1e-6)
    row = np.asarray(grid["z"][more["n"] // 2], dtype=float) * height
    middle = more["n"] // 2
    curvature = (row[2] - 2 * row[middle] + row[more["n"] - 2]) / ((middle - 2) * distance) ** 2
    steps = [grid["dx"] * lateral, grid["dy"] * lateral]
    return bool(np.allclose(steps, distance, rtol=1e-3) and -curvature * 8e-3 == pytest.approx(1, rel=0.02))


@pytest.mark.parametrize("entry", TRUTH["files"], ids=lambda entry: str(entry["file"]))
def test_every_file_is_read_right_or_refused_with_a_mapping_that_settles_it(entry: dict[str, Any]) -> None:
    """Whatever is read is right and repeats itself by its mapping; of a refusal each way out is followed."""
    refused: ss.InvalidInput | None = None
    try:
        found = read(entry)
    except ss.InvalidInput as refusal:
        refused = refusal
    if refused is not None:
        assert entry["expect"] in ASKING, refused
        candidates = refused.document.get("candidates", [])
        assert candidates or entry["expect"] == "read_or_refuse", refused
        ways = [read(entry, candidate["mapping"]) for candidate in candidates]
        assert any(is_right(way, entry) for way in ways) or not ways, refused
        return
    assert is_right(found, entry) or entry["expect"] == "fit_refuses"
    assert not entry["expect"].startswith("ask")
    again = read(entry, found.mapping)
    assert (again.units, again.mapping) == (found.units, found.mapping)
    if isinstance(found, ss.Loop) and isinstance(again, ss.Loop):
        assert again.loop == found.loop
    if isinstance(found, ss.Scan) and isinstance(again, ss.Scan):
        assert again.scan == found.scan
    assert found.lines


def test_a_mapping_is_a_dict() -> None:
    """A pair is a column and its unit."""
    path = FOLDER / "loop_two_load_cells.csv"
    mapping = {"displacement": (2, "um"), "force": (3, "N"), "load": "10 N", "time": "1:s"}
    found = ss.read_loop(path, mapping=mapping)
    assert is_right(found, {"truth": {"load": 10.0, "dt": 0.01}})
    assert found.loop["normal_force"] == pytest.approx(10)
