"""Motion in the plane in process."""

from __future__ import annotations

import numpy as np
import pytest

import stickslip as ss


def ball() -> ss.Contact:
    return ss.Contact(ss.Sphere("10 mm"), [ss.Body("210 GPa", 0.3), ss.RIGID], friction=0.3, normal_force="10 N")


def test_turns_of_a_circle_have_pairs_a_table_and_the_known_loss() -> None:
    contact = ball()
    full, limit = contact.summary.gross_slip_displacement, contact.summary.gross_slip_force
    reply = ss.simulate(contact, ellipse={"radii": [0.6 * full, 0.6 * full], "turns": 2, "steps_per_turn": 32})
    assert isinstance(reply, ss.results.PlanarReply)
    assert reply.turn_losses is not None
    assert reply.turn_losses / (limit * full) == pytest.approx([0.4337, 0.5556], abs=1e-3)
    frame = reply.to_frame()
    assert len(frame) == 65
    assert np.hypot(frame["force_x"], frame["force_y"]).max() <= limit * (1 + 1e-12)
    assert frame["displacement_x"].iloc[0] == pytest.approx(0.6 * full)


def test_pairs_are_refused_by_a_living_contact() -> None:
    with pytest.raises(ss.InvalidInput) as refused:
        ball().path(moves=[{"displacement": [1e-8, 1e-8]}])
    assert "plane" in str(refused.value)
