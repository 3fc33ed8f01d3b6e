"""Files as laboratories have them: what is right for each is in the list that the tests of the service read too."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

import stickslip as ss
from conftest import ROOT

FOLDER = ROOT / "tests" / "lab_files"
#: Requests are tested where they are sent.
ENTRIES = [entry for entry in json.loads((FOLDER / "list.json").read_text()) if not entry["kind"].endswith("_request")]
#: How far a result may be from the truth, as a part of it: the noise of the files.
NEAR = 0.02


@pytest.mark.parametrize("entry", ENTRIES, ids=lambda entry: entry["file"] + "".join(entry.get("hints", {})))
def test_a_file_is_read_for_what_it_is_or_refused_at_its_place(entry: dict[str, Any]) -> None:
    read: Any = ss.read_loop if entry["kind"] == "loop" else ss.read_scan
    path, hints = FOLDER / entry["file"], entry.get("hints", {})
    if "refused" in entry:
        expected = entry["refused"]
        with pytest.raises(ss.InvalidInput) as refused:
            read(path.read_bytes(), **hints)
        place = "".join(f"/{name}/{expected[name]}" for name in ("line", "column") if name in expected)
        assert (refused.value.code, refused.value.pointer) == (expected["code"], place)
        assert expected["text"] in str(refused.value)
        return
    found = read(path, **hints)
    if "columns" in entry:
        assert [column["quantity"] for column in found.columns] == entry["columns"]
    for column in found.columns:
        assert (column["quantity"] is None) == ("left_out" in column)
    for text in entry.get("said", []):
        assert text in " ".join(found.reading)
    for name, value in entry["expected"].items():
        assert measured(found, name) == pytest.approx(value, rel=NEAR), name


def measured(found: Any, name: str) -> float:
    """A number that is expected of a file: of a fit, or of what was read."""
    if name == "radius":
        return float(ss.fit_profile(found).radius_of_curvature.value)
    if name == "dx":
        return float(found.scan["map"]["dx"]) * {"um": 1e-6, "m": 1.0}[found.units["lateral"]]
    if name == "friction":
        contact = ss.Definition(ss.Sphere("10 mm"), [ss.Body("210 GPa", 0.3), ss.RIGID], 0.25, "10 N")
        known = {"machine_compliance": {"value": 0.0}}
        fit = ss.fit(contact, found, free=["friction", "g_star"], start="steady", known=known)
        return float(fit.estimates["friction"].value)
    return float(found.loop["time"][-1] if name == "last_time" else found.loop[name])


def test_another_kind_of_file_is_named(tmp_path: Path) -> None:
    for name, content in (("scan.gwy", b"GWYP" + bytes(200)), ("loop.tdms", b"TDSm" + bytes(200))):
        (tmp_path / name).write_bytes(content)
        with pytest.raises(ss.InvalidInput, match=r"this is a (Gwyddion|LabVIEW) file"):
            ss.read_loop(tmp_path / name)
        with pytest.raises(ss.InvalidInput, match=r"this is a (Gwyddion|LabVIEW) file"):
            ss.read_scan(content)
