"""Anything like an array is taken, and every quantity is read in one way."""

from __future__ import annotations

from datetime import datetime, timezone
from decimal import Decimal
from typing import Any

import numpy as np
import pandas
import pytest

import stickslip as ss
from stickslip import requests
from stickslip.documents import to_document

STEEL = ss.Body(2.1e11, 0.3)
BALL = ss.Definition(ss.Sphere(0.01), [STEEL, ss.RIGID], 0.3, normal_force=10.0)
TURNS = [1e-8, -2e-8, 3e-8]


class Bare:
    """Nothing but an array."""

    def __array__(self, dtype: Any = None, copy: Any = None) -> np.ndarray:
        return np.array(TURNS)


def columns() -> list[Any]:
    polars, xarray = pytest.importorskip("polars"), pytest.importorskip("xarray")
    pint = pytest.importorskip("pint").UnitRegistry()
    nano = np.array(TURNS) * 1e9
    named = pandas.Series(nano, name="u")
    named.attrs["units"] = "nm"
    return [
        TURNS,
        tuple(TURNS),
        np.array(TURNS),
        pandas.Series(TURNS),
        pandas.Series(TURNS, index=["a", "b", "c"]),
        polars.Series(TURNS),
        xarray.DataArray(TURNS),
        Bare(),
        ["10 nm", "-20 nm", "30 nm"],
        pandas.Series(["10 nm", "-20 nm", "30 nm"]),
        nano * pint.nm,
        [10 * pint.nm, -20 * pint.nm, 3e-8],
        named,
        xarray.DataArray(nano, attrs={"units": "nm"}),
        xarray.DataArray(nano * pint.nm),
        pandas.DataFrame({"displacement [nm]": nano}),
        polars.DataFrame({"displacement (nm)": nano}),
    ]


@pytest.mark.parametrize("index", range(17))
def test_a_path_takes_anything_like_an_array(ball: ss.Contact, index: int) -> None:
    ball.path(columns()[index])
    assert ball.state.displacement == pytest.approx(3e-8, rel=1e-15)
    assert ball.sequence == 3


def test_a_table_of_moves_has_a_column_for_each_target(ball: ss.Contact) -> None:
    table = pandas.DataFrame({"displacement": [10.0, -20.0], "normal_force": [11.0, np.nan]})
    table.attrs["units"] = {"displacement": "nm", "normal_force": "N"}
    ball.path(table)
    assert ball.moves() == [
        {"displacement": pytest.approx(1e-8), "normal_force": 11.0},
        {"displacement": pytest.approx(-2e-8)},
    ]
    with pytest.raises(ss.InvalidInput, match="displacment"):
        ball.path(pandas.DataFrame({"displacment": [1e-8]}))


def loop() -> tuple[np.ndarray, np.ndarray]:
    contact = ss.Contact.from_definition(BALL)
    turn = 1.5 * contact.summary.gross_slip_displacement
    contact.path([turn])
    displacement = turn * np.cos(np.linspace(0.0, 2.0 * np.pi, 81))[1:]
    return displacement, contact.path(displacement).force


def test_a_loop_is_taken_in_every_form() -> None:
    pint = pytest.importorskip("pint").UnitRegistry()
    polars = pytest.importorskip("polars")
    u, f = loop()
    frame = pandas.DataFrame({"displacement (um)": 1e6 * u, "force [mN]": 1e3 * f})
    by_attrs = pandas.DataFrame({"u": 1e6 * u, "F": 1e3 * f})
    by_attrs.attrs["units"] = {"u": "um", "F": "mN"}
    forms: list[tuple[Any, Any]] = [
        ((u, f), None),
        ([u, f], None),
        ([u.tolist(), f.tolist()], None),
        (np.array([u, f]), None),
        ((pandas.Series(u), pandas.Series(f)), None),
        ((1e9 * u * pint.nm, f * pint.N), None),
        ((1e9 * u, f), {"displacement": "nm", "force": "N"}),
        ({"displacement": u, "force": f}, None),
        (frame, None),
        (by_attrs, None),
        (pandas.DataFrame({"displacement": u, "force": f}), None),
        (polars.DataFrame({"displacement (um)": 1e6 * u, "force (mN)": 1e3 * f}), None),
        ([(u, f), frame], None),
    ]
    guess = ss.Definition(ss.Sphere(0.01), [STEEL, ss.RIGID], 0.5, normal_force=10.0)
    for given, units in forms:
        fit = ss.fit(guess, given, free=["friction", "g_star"], units=units)
        assert fit.estimates["friction"].value == pytest.approx(0.3, rel=1e-6), type(given)


def test_columns_of_pint_pandas_keep_their_units(here: ss.Contact) -> None:
    pytest.importorskip("pint_pandas")
    u, f = loop()
    table = pandas.DataFrame(
        {
            "displacement": pandas.Series(1e9 * u, dtype="pint[nm]"),
            "force": pandas.Series(1e3 * f, dtype="pint[mN]"),
        }
    )
    fit = ss.fit(BALL, table, free=["friction", "g_star"])
    assert fit.estimates["friction"].value == pytest.approx(0.3, rel=1e-6)
    turns = pandas.Series([10.0, -20.0], dtype="pint[nm]")
    for given in (turns, pandas.DataFrame({"displacement": turns})):
        here.path(given)
        assert here.state.displacement == pytest.approx(-2e-8, rel=1e-14)


def test_a_scan_is_taken_in_every_form() -> None:
    x = np.linspace(-7e-5, 7e-5, 41)
    z = -(x**2) / (2.0 * 0.01)
    for given in (
        (x, z),
        np.array([x, z]),
        (pandas.Series(x), pandas.Series(z)),
        pandas.DataFrame({"x (um)": 1e6 * x, "z (nm)": 1e9 * z}),
        pandas.DataFrame({"x [m]": x, "z [m]": z}),
    ):
        found = ss.fit_profile(given, smoothing={"noise": "0.1 nm"})
        assert found.radius_of_curvature.value == pytest.approx(0.01, rel=1e-3)


def test_what_is_no_loop_is_refused_and_units_are_not_named_twice() -> None:
    pint = pytest.importorskip("pint").UnitRegistry()
    u, f = loop()
    for wrong in (np.zeros((5, 3, 2)), 3.0, object(), [object()]):
        with pytest.raises(ss.InvalidInput) as refused:
            requests.loops(wrong, None)
        assert refused.value.pointer == "/loops"
    with pytest.raises(ss.InvalidInput) as refused:
        ss.fit(BALL, (1e9 * u * pint.nm, f * pint.N), units={"displacement": "nm", "force": "N"})
    assert refused.value.pointer == "/units"


def test_steps_of_many_contacts_take_units() -> None:
    pint = pytest.importorskip("pint").UnitRegistry()
    many = [ss.Contacts(3, ss.Sphere("10 mm"), ss.Moduli(1.15e11, 8.5e10), 0.3) for _ in range(6)]
    plain = many[0].step(1e-6, [1e-9, 2e-9, 3e-9])
    nano = np.array([1.0, 2.0, 3.0])
    for contacts, indentation, displacement in (
        (many[1], 1 * pint.um, nano * pint.nm),
        (many[2], "1 um", ["1 nm", "2 nm", "3 nm"]),
        (many[3], "1 um", [1 * pint.nm, 2 * pint.nm, "3 nm"]),
        (many[4], np.array([1e-6]), pandas.Series([1e-9, 2e-9, 3e-9])),
        (many[5], np.full((3,), 1e-6)[::1], np.array([3e-9, 2e-9, 1e-9])[::-1]),
    ):
        assert np.allclose(contacts.step(indentation, displacement), plain, rtol=1e-12, atol=0.0)
    for wrong in ("1 N", 1 * pint.N, "1 xyz", "deep"):
        with pytest.raises(ss.InvalidInput) as refused:
            many[0].step(wrong, 0.0)
        assert refused.value.pointer == "/indentation"
    assert np.array_equal(many[0].forces(), plain)


def test_a_unit_of_pint_alone_is_known_if_it_is_installed() -> None:
    pytest.importorskip("pint")
    # The table of the engine has no furlong.
    assert to_document({"radius": "1 furlong"})["radius"] == pytest.approx(201.168, rel=1e-4)
    with pytest.raises(ss.InvalidInput):
        to_document({"radius": "1 acre"})


@pytest.mark.parametrize("text", ["um", "wide", "", "1 2 um", "um 20"])
def test_a_text_that_says_no_number_is_refused_where_a_number_is_expected(text: str) -> None:
    with pytest.raises(ss.InvalidInput) as refused:
        to_document({"profile": {"radius": text}})
    assert refused.value.pointer == "/profile/radius"


def test_what_is_no_part_of_a_request_is_refused_at_its_place(here: ss.Contact) -> None:
    for wrong in (object(), {1e-8}, [1e-8, object()], pandas.Series([1e-8, None], dtype="Float64")):
        with pytest.raises(ss.InvalidInput) as refused:
            here.path(wrong)  # type: ignore[arg-type]
        assert str(refused.value.pointer).startswith("/path/displacement")
    assert to_document({"radius": Decimal("0.01"), "at": datetime(2026, 11, 26, tzinfo=timezone.utc)}) == {
        "radius": 0.01,
        "at": "2026-11-26T00:00:00+00:00",
    }


def test_missing_cells_of_a_table_are_left_out() -> None:
    u, f = loop()
    table = pandas.DataFrame({"displacement (um)": 1e6 * u, "force (N)": f}).astype("Float64")
    table.loc[3, "force (N)"] = pandas.NA
    found, _ = requests.loops(table, None)
    assert len(found[0]["force"]) == len(f) - 1


def test_a_number_that_is_missing_is_refused_at_its_place(ball: ss.Contact) -> None:
    with pytest.raises(ss.InvalidInput) as refused:
        ball.path(pandas.Series([1e-8, np.nan]))
    assert refused.value.pointer == "/path/displacement/1"
