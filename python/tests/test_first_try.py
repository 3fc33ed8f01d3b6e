"""Six jobs as a new user does them, from `help()` and docs/python.md alone."""

from __future__ import annotations

import pickle
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pandas
import pytest

import stickslip as ss


def ball() -> ss.Contact:
    return ss.Contact(ss.Sphere("10 mm"), ["100Cr6", "100Cr6"], friction=0.3, normal_force="10 N")


def test_residual_stress_with_three_protocols_is_a_picture(tmp_path: Path) -> None:
    _, axes = plt.subplots()
    left = {}
    for kind in ("linear", "equal_peaks", "minimax"):
        contact = ball()
        contact.path(ss.protocols(contact, 10, kind=kind))
        contact.stress().plot(ax=axes, label=kind)
        left[kind] = contact.residual().max
    assert left["minimax"] < left["linear"]
    labels = [text.get_text() for text in axes.get_legend().get_texts()]
    assert labels == ["friction bound ±μp", "linear", "equal_peaks", "minimax"]
    axes.figure.savefig(tmp_path / "residual.png")


def test_a_csv_by_pandas_gives_its_friction(tmp_path: Path) -> None:
    u = 0.3 * np.cos(np.linspace(0.0, 2.0 * np.pi, 200))
    force = ball().path(1e-6 * u).force
    table = {"displacement (um)": u[1:], "force (mN)": 1e3 * force[1:]}
    pandas.DataFrame(table).to_csv(tmp_path / "loop.csv", index=False)
    fit = ss.fit(ball(), pandas.read_csv(tmp_path / "loop.csv"))
    assert fit.estimates["friction"].value == pytest.approx(0.3, rel=1e-6)


def test_a_thousand_contacts_with_their_own_radii_are_pickled_and_resumed(tmp_path: Path) -> None:
    radii = np.linspace(0.005, 0.02, 1000)
    many = ss.Contacts(profile=ss.Sphere(radii), bodies=["100Cr6", "100Cr6"], friction=0.3)
    many.step("1 um", "50 nm")
    (tmp_path / "run").write_bytes(pickle.dumps(many))
    resumed = pickle.loads((tmp_path / "run").read_bytes())
    for displacement in ("-20 nm", "70 nm"):
        assert np.array_equal(many.step("1 um", displacement), resumed.step("1 um", displacement))
    assert len(np.unique(many.forces()[1])) == 1000


def test_a_cylinder_with_bulk_stress_has_a_life() -> None:
    pad = ss.Contact(ss.Cylinder("50 mm", length="8 mm"), ["Al 7075", "Al 7075"], friction=0.6, normal_force="2 kN")
    strain_life = {"strength": "1.23 GPa", "strength_exponent": -0.12, "ductility": 0.2, "ductility_exponent": -0.6}
    half = 0.5 * pad.summary.gross_slip_force
    lives = [
        pad.fretting(force=[half, -half], bulk=bulk, swt={"life": {"strain_life": strain_life}}).life
        for bulk in ("0 MPa", "50 MPa", "100 MPa")
    ]
    assert None not in lives
    assert lives[0] > lives[1] > lives[2] > 1e3  # type: ignore[operator]
    assert ball().fretting("50 nm", crossland={"alpha": 0.3}).life is None


def test_an_ellipse_is_a_frame() -> None:
    frame = ss.simulate(ball(), ellipse={"radii": ["60 nm", "30 nm"], "turns": 2}).to_frame()
    assert {"displacement_x", "displacement_y", "force_x", "force_y"} < set(frame.columns)
    assert frame.attrs["units"]["force_y"] == "N"
    assert len(frame) == 129


def test_a_contact_is_followed_live(api: ss.Client) -> None:
    contact = api.Contact(ss.Sphere("10 mm"), ["100Cr6", "100Cr6"], friction=0.3, normal_force="10 N")
    followed = contact.follow()
    assert next(followed).sequence == 0
    for displacement in ("50 nm", "-50 nm"):
        moved = contact.move(displacement)
        assert next(followed).state.force == moved.state.force
