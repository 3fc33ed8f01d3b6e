"""Scans in formats of instruments, written by others' code or by hand after their standards."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import stickslip as ss

topography = pytest.importorskip("SurfaceTopography")
RADIUS = 5e-3
STEP = 2e-6


def ball(nx: int, ny: int) -> np.ndarray:
    """Heights, m, of a ball with its tip off the middle, the first index along x."""
    x, y = (STEP * (np.arange(nx) - 0.4 * nx))[:, None], (STEP * (np.arange(ny) - 0.55 * ny))[None, :]
    return RADIUS - np.sqrt(RADIUS**2 - x**2 - y**2)


def test_a_map_of_netcdf_leads_to_the_radius_of_its_ball(tmp_path: Path) -> None:
    nx, ny = 90, 70
    topography.Topography(ball(nx, ny), (nx * STEP, ny * STEP), unit="m").to_netcdf(str(tmp_path / "ball.nc"))
    scan = ss.read_scan(tmp_path / "ball.nc")
    grid = scan.scan["map"]
    assert (len(grid["z"]), len(grid["z"][0])) == (ny, nx)
    assert grid["dx"] == pytest.approx(2.0, rel=1e-6)
    assert any("SurfaceTopography" in line for line in scan.reading)
    # The file has single precision.
    assert ss.fit_profile(scan).radius_of_curvature.value == pytest.approx(RADIUS, rel=1e-3)


def test_a_map_of_iso_25178_71_keeps_rows_units_and_missing_heights(tmp_path: Path) -> None:
    rows = [[10.0 * row + column for column in range(6)] for row in range(5)]
    head = {"NumPoints": 6, "NumProfiles": 5, "Xscale": 1e-6, "Yscale": 2e-6, "Zscale": 1e-9, "Zresolution": 1e-10}
    head |= {"Compression": 0, "DataType": 7, "CheckType": 0}
    lines = ["aISO-1.0", "ManufacID = stickslip", "CreateDate = 241120261200", "ModDate = 241120261200"]
    lines += [f"{name} = {value}" for name, value in head.items()]
    lines += ["*", *(" ".join(map(str, row)) for row in rows), "*", ""]
    (tmp_path / "map.sdf").write_text("\n".join(lines))
    scan = ss.read_scan(tmp_path / "map.sdf")
    grid = scan.scan["map"]
    assert (grid["dx"], grid["dy"]) == (pytest.approx(1.0), pytest.approx(2.0))
    # The importer of the service reads this format itself, in the unit that fits the heights.
    assert np.allclose(np.array(grid["z"]) * {"nm": 1.0, "um": 1e3}[scan.units["height"]], rows)
    assert scan.units["lateral"] == "um"


def test_a_large_map_is_thinned_and_says_so(tmp_path: Path) -> None:
    nx, ny = 900, 700
    topography.Topography(ball(nx, ny), (nx * STEP, ny * STEP), unit="m").to_netcdf(str(tmp_path / "ball.nc"))
    scan = ss.read_scan(tmp_path / "ball.nc")
    grid = scan.scan["map"]
    assert grid["dx"] == pytest.approx(4.0, rel=1e-6)
    assert len(grid["z"]) * len(grid["z"][0]) <= 300_000
    assert "one in 2" in scan.reading[1]
    heights = np.array(grid["z"]) * 1e-6
    assert np.allclose(heights, ball(nx, ny).T[::2, ::2], rtol=1e-6, atol=1e-12)


def test_a_file_of_nothing_is_refused(tmp_path: Path) -> None:
    (tmp_path / "noise.bin").write_bytes(bytes(range(256)))
    with pytest.raises(ValueError, match="nor is it a file of an instrument"):
        ss.read_scan(tmp_path / "noise.bin")
