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
LOOPS = [entry for entry in TRUTH["files"] if entry["kind"] == "loop"]


def is_right(found: ss.Loop) -> bool:
    """Whether a loop is the one that all files hold."""
    measured = [
        (found.loop["displacement"], found.units["displacement"], TRUTH["loop"]["displacement_m"], 2e-10),
        (found.loop["force"], found.units["force"], TRUTH["loop"]["force_N"], 6e-3),
    ]
    return all(
        len(values) == len(truth) and np.allclose(np.multiply(values, FACTORS[unit]), truth, rtol=0, atol=near)
        for values, unit, truth, near in measured
    )


@pytest.mark.parametrize("entry", LOOPS, ids=lambda entry: str(entry["file"]))
def test_every_loop_is_read_right_or_refused_with_a_mapping(entry: dict[str, Any]) -> None:
    """Whatever is read is right, and repeats itself by its mapping."""
    path = FOLDER / entry["file"]
    try:
        found = ss.read_loop(path)
    except ss.InvalidInput as refusal:
        assert entry["expect"] in {"ask", "ask_load", "said", "said_block", "read_or_refuse"}, refusal  # noqa: PT017
        return
    assert is_right(found) or entry["expect"] == "fit_refuses"
    assert ss.read_loop(path, mapping=found.mapping).loop == found.loop
    assert found.lines["data"]["count"] >= len(found.loop["force"])


def test_a_mapping_is_a_dict() -> None:
    """A pair is a column and its unit."""
    path = FOLDER / "loop_two_load_cells.csv"
    mapping = {"displacement": (2, "um"), "force": (3, "N"), "load": "10 N", "time": "1:s"}
    found = ss.read_loop(path, mapping=mapping)
    assert is_right(found)
    assert found.loop["normal_force"] == pytest.approx(10)
