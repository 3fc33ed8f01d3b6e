"""A contact that is twisted: moves, paths, cycles, its history as a table, and its pictures."""

from __future__ import annotations

import numpy as np
import pytest

import stickslip as ss


def test_a_contact_is_twisted_by_moves_and_paths() -> None:
    ball = ss.Contact(ss.Sphere("10 mm"), [ss.Body("210 GPa", 0.3)] * 2, 0.3, normal_force="10 N")
    state = ball.move(twist="0.02 deg").state
    assert state.twist == pytest.approx(np.radians(0.02))
    assert state.torque is not None
    assert state.torque > 0.0
    assert state.displacement is None
    assert state.force is None
    torques = ball.path(torque=[-1e-5, "10 uN m"]).steps
    assert torques.torque == pytest.approx([-1e-5, 1e-5])
    assert np.isnan(torques.force).all()
    with pytest.raises(ss.InvalidInput) as refused:
        ball.move(1e-7)
    assert refused.value.code == "twist_with_shift"
    # Under a load that changes springs step it, with a stated error.
    reply = ball.move(twist=1e-4, normal_force="12 N")
    assert reply.accuracy.solver == "springs"
    assert reply.accuracy.count is not None
    assert 0.0 < reply.accuracy.force_error < 1e-5
    items = ball.history().items
    assert len(items) == 4
    loop = ball.loop(points_per_move=4)
    assert np.isfinite(loop.twist).sum() == 16
    assert np.isnan(loop.force).sum() == 16
    for one in (ball, ball.history(), loop):
        axes = one.plot()
        assert axes.get_xlabel().startswith("angle of twist")


def test_cycles_of_twist_have_angles_and_torques() -> None:
    ball = ss.Definition(ss.Sphere("10 mm"), [ss.Body("210 GPa", 0.3)] * 2, 0.3, normal_force="10 N")
    cycles = ss.cycle(ball, twist=["0.01 deg", "0.02 deg"]).cycles
    assert cycles.twist_amplitude == pytest.approx(np.radians([0.01, 0.02]))
    assert (cycles.secant_stiffness * cycles.twist_amplitude) == pytest.approx(cycles.torque_amplitude)
    assert cycles.dissipated_energy[1] > 4.0 * cycles.dissipated_energy[0] > 0.0
