"""The examples run, and their numbers are those of their subjects."""

from __future__ import annotations

import importlib.util

import numpy as np
import pandas
import pytest
from streamlit.testing.v1 import AppTest

from conftest import ROOT

EXAMPLES = ROOT / "examples" / "python"


def run(name: str) -> pandas.DataFrame:
    spec = importlib.util.spec_from_file_location(name, EXAMPLES / f"{name}.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    assert len((EXAMPLES / f"{name}.py").read_text().splitlines()) < 60
    table: pandas.DataFrame = module.main()
    return table


def test_a_scan_leads_to_its_residual_stress() -> None:
    table = run("scan_to_residual_stress")
    assert table["remaining"].is_monotonic_decreasing
    assert table["remaining"].between(0.0, 1.0).all()


def test_a_loop_leads_to_the_friction_that_it_was_made_with() -> None:
    table = run("loop_to_friction")
    assert table.loc["friction", "value"] == pytest.approx(0.42, rel=2e-3)
    # What make_ball_loop.py has made the file of.
    for name, truth in (("friction", 0.42), ("machine_compliance", 5e-8), ("force_offset", 0.15)):
        reach = table.loc[name, "high"] - table.loc[name, "low"]
        assert table.loc[name, "low"] - reach < truth < table.loc[name, "high"] + reach


def test_the_loop_of_a_worn_ball_is_predicted_from_that_of_a_ball() -> None:
    table = run("compare_with_loops")
    assert table["friction"].iloc[0] == pytest.approx(0.42, rel=2e-3)
    assert table["machine_compliance"].iloc[0] == pytest.approx(3e-8, rel=0.05)
    # What is left is the noise, 0.01 N of some 7 N between the extremes.
    assert table["relative_rms"].iloc[0] == pytest.approx(0.01 / 7.0, rel=0.2)


def test_curves_of_closed_forms_are_met_up_to_their_noise() -> None:
    # One percent of the largest value or of the range, of forty or sixty points.
    sheared, stiff, joint = (run(f"compare_with_{name}") for name in ("area", "stiffness", "joint"))
    assert sheared["strength"].iloc[0] == pytest.approx(3e5, rel=0.02)
    assert stiff["ratio"].iloc[0] == pytest.approx(1.4 / 1.7, rel=5e-3)
    assert stiff["expected"].iloc[0] == pytest.approx(1.4 / 1.7, rel=1e-12)
    rests = [sheared["relative_rms"], stiff.filter(like="rms").loc[0], joint["relative_rms"]]
    assert pandas.concat(rests).between(0.007, 0.013).all()


def test_a_larger_motion_is_nearer_to_a_crack() -> None:
    table = run("will_it_crack")
    assert table["margin"].is_monotonic_decreasing
    assert (table["margin"] > 0.0).all()


def test_a_joint_damps_by_a_power_of_its_amplitude() -> None:
    table = run("joint_damping")
    # Mindlin & Deresiewicz (1953): the friction work of small cycles grows with the third power of the force.
    assert table["exponent"].iloc[1] == pytest.approx(3.0, abs=0.05)


def test_an_oblique_impact_is_that_of_maw_barber_and_fawcett() -> None:
    table = run("oblique_impact").set_index("angle")
    # With chi = (1 - nu)(1 + 1/K^2)/(2 - nu) it slides all the way from an angle of 4 chi - 1 on, and loses 4 chi.
    chi = 0.7 * 3.5 / 1.7
    sliding = table[table.index > 4.0 * chi - 1.0 + 0.1]
    assert len(sliding) > 4
    for law in ("exact", "incremental"):
        assert np.allclose(sliding[law], sliding.index - 4.0 * chi, atol=1e-2)
    # Below, the surface comes back; one spring without partial slip gives another curve.
    assert (table["exact"].loc[1.0:4.5] < 0.0).all()
    assert np.abs(table["exact"] - table["incremental"]).max() > 0.3


def test_a_ball_that_orbits_loses_its_energy_by_partial_slip() -> None:
    table = run("orbiting_ball")
    assert np.allclose(table["spring"], 1.0, rtol=1e-2)
    assert (table["rings"].diff()[1:] < -0.05).all()
    # What is left and what friction has taken is what there was, but for the time step.
    assert np.allclose(table["rings"] + table["friction_work"], 1.0, rtol=1e-2)


@pytest.mark.filterwarnings("ignore")
def test_a_plan_of_bluesky_reads_the_first_loading_of_a_ball() -> None:
    table = run("bluesky_device")
    # Cattaneo (1938), Mindlin (1949).
    share = np.array([0.1, 0.3, 0.5, 0.7, 0.9])
    assert np.allclose(table["ball_force"], 3.0 * (1.0 - (1.0 - share) ** 1.5), rtol=1e-12, atol=0.0)
    most = table["ball_displacement"].iloc[-1] / 0.9
    radius = table["ball_stick_radius"].iloc[0] / np.sqrt(0.9)
    assert np.allclose(table["ball_displacement"], share * most, rtol=1e-12)
    assert np.allclose(table["ball_stick_radius"], radius * np.sqrt(1.0 - share), rtol=1e-12)


def test_an_app_of_streamlit_shows_the_stick_radius_of_its_sliders() -> None:
    app = AppTest.from_file(str(EXAMPLES / "streamlit_app.py"), default_timeout=60).run()
    assert not app.exception
    before = app.metric[0].value
    app.slider[1].set_value(50.0).run()
    # Mindlin (1949): a smaller displacement leaves a larger part stuck.
    assert float(app.metric[0].value.split()[0]) > float(before.split()[0])


def test_a_soft_ball_loses_most_where_the_impact_takes_some_relaxation_times() -> None:
    table = run("soft_impact")
    least = table["restitution"].argmin()
    assert 0.3 < table["time"].iloc[least] < 10.0
    assert 0.5 < table["restitution"].iloc[least] < 0.9
    # The time of contact goes with the speed to the power of -1/5: fast impacts are nearer to elastic.
    assert table["time"].is_monotonic_decreasing
    assert table["restitution"].iloc[-1] > table["restitution"].iloc[least] + 0.1


def test_a_seal_loses_most_near_the_relaxation_time_and_by_friction_where_it_slips() -> None:
    table = run("seal_loss")
    # One term of the ratio g: tan(delta) = g w T/(1 - g + w^2 T^2) is largest at w T = sqrt(1 - g).
    assert table["frequency"].iloc[0] == pytest.approx(np.sqrt(0.4) / 0.01 / (2.0 * np.pi), rel=0.2)
    assert table["friction"].is_monotonic_increasing
    assert table["friction"].iloc[0] < 0.05
    assert table["friction"].iloc[-1] > 0.5


def test_a_soft_finger_lets_go_when_its_force_has_relaxed_to_what_the_weight_needs() -> None:
    table = run("soft_finger")
    last = table.iloc[-1]
    # At a held indentation the load is that of the instant times R(t), and slips at weight = friction x load.
    assert 0.8 * last["normal_force"] == pytest.approx(1.0, rel=1e-4)
    relaxed = 1.0 - 0.2 * (1.0 - np.exp(-last["time"] / 0.1)) - 0.3 * (1.0 - np.exp(-last["time"] / 10.0))
    assert last["normal_force"] == pytest.approx(2.0 * relaxed, rel=1e-4)
    assert table["stick_radius"].iloc[-1] < 0.1 * table["contact_radius"].iloc[-1]
