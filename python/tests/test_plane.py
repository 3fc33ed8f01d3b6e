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


RADIUS, FRICTION, DEPTH = 0.01, 0.3, 1e-6
MODULI = ss.Moduli(1.15e11, 8.5e10)
#: Displacement of gross slip at the depth, and the friction limit there.
SLIP = FRICTION * MODULI.e_star / MODULI.g_star * DEPTH
LIMIT = FRICTION * 4.0 / 3.0 * MODULI.e_star * np.sqrt(RADIUS) * DEPTH**1.5


def planar(count: int, threads: int = 1, rings: int = 20) -> ss.PlanarContacts:
    return ss.PlanarContacts(count, ss.Sphere(RADIUS), MODULI, FRICTION, threads=threads, rings=rings)


def circle(steps: int) -> np.ndarray:
    angle = 2.0 * np.pi * np.arange(1, steps + 1) / steps
    return 0.6 * SLIP * np.stack([np.cos(angle), np.sin(angle)], axis=-1)


def test_steps_round_a_circle_have_the_forces_of_a_simulation() -> None:
    contact = ss.Contact(ss.Sphere(RADIUS), MODULI, FRICTION, indentation=DEPTH)
    known = ss.simulate(contact, ellipse={"radii": [0.6 * SLIP] * 2, "turns": 1, "steps_per_turn": 64})
    many = planar(2)
    many.step(DEPTH, [0.0, 0.0])
    many.step(DEPTH, [[0.6 * SLIP, 0.0], [0.0, 0.6 * SLIP]])
    for place, expected in zip(circle(64), known.force[1:], strict=True):
        normal, force = many.step(DEPTH, [place, [-place[1], place[0]]])
        assert np.allclose(normal, LIMIT / FRICTION, rtol=1e-13)
        # The second goes the same way a quarter of a turn ahead.
        assert np.allclose(force[0], expected, rtol=0.0, atol=5e-3 * LIMIT)
        assert np.allclose(force[1], [-force[0][1], force[0][0]], rtol=0.0, atol=1e-12 * LIMIT)
    state = many.state(0)
    assert known.turn_losses is not None
    lost = state.dissipated_energy - known.steps[0].dissipated_energy
    assert lost == pytest.approx(known.turn_losses[0], abs=4e-3 * LIMIT * SLIP)
    assert state.regime == "partial_slip"


def test_along_a_line_the_forces_are_those_of_contacts_along_a_line() -> None:
    generator = np.random.default_rng(3)
    count = 40
    line, plane = ss.Contacts(count, ss.Sphere(RADIUS), MODULI, FRICTION), planar(count, rings=40)
    angle = generator.uniform(0.0, 2.0 * np.pi, count)
    along = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    depth, place = np.zeros(count), np.zeros(count)
    worst = 0.0
    # Contacts grow, shrink, part and meet again.
    for step in range(300):
        depth = DEPTH * np.sin(np.linspace(1.0, 3.0, count) * step / 40.0)
        place = place + generator.uniform(-0.05, 0.08, count) * SLIP
        normal, force = plane.step(depth, place[:, None] * along)
        exact_normal, exact = line.step(depth, place)
        assert np.allclose(normal, exact_normal, rtol=1e-12)
        assert np.all(np.linalg.norm(force, axis=1) <= FRICTION * normal * (1.0 + 1e-12))
        worst = max(worst, float(np.abs(force - exact[:, None] * along).max()) / LIMIT)
    assert worst < 5e-3


def test_a_trial_in_the_plane_changes_nothing_until_it_is_committed() -> None:
    many = planar(3)
    many.step(DEPTH, [0.3 * SLIP, 0.1 * SLIP])
    before = [many.state(index).document for index in range(3)]
    places = SLIP * np.array([[0.5, 0.5], [0.2, 0.9], [-3.0, 0.0]])
    tried = many.trial([DEPTH, 2.0 * DEPTH, -DEPTH], places)
    assert [many.state(index).document for index in range(3)] == before
    many.revert()
    again = many.trial([DEPTH, 2.0 * DEPTH, -DEPTH], places)
    many.commit()
    for one, other, now in zip(tried, again, many.forces(), strict=True):
        assert np.array_equal(one, other)
        assert np.array_equal(one, now)
    with pytest.raises(RuntimeError):
        many.commit()


def test_threads_change_no_bit_in_the_plane_and_loads_may_be_given() -> None:
    generator = np.random.default_rng(7)
    one, two = planar(64, 1), planar(64, 2)
    for _ in range(20):
        load, places = generator.uniform(0.0, 2.0, 64), generator.uniform(-2.0, 2.0, (64, 2)) * SLIP
        steps = one.step(normal_force=load, displacement=places), two.step(normal_force=load, displacement=places)
        assert np.array_equal(steps[0][0], load)
        assert all(np.array_equal(*pair) for pair in zip(*steps, strict=True))


def test_shapes_units_and_faults_of_steps_in_the_plane() -> None:
    many = ss.PlanarContacts((2, 3), ss.Sphere(RADIUS), MODULI, FRICTION)
    normal, force = many.step("1 um", ["20 nm", "10 nm"])
    assert normal.shape == (2, 3)
    assert force.shape == (2, 3, 2)
    assert len(many) == 6
    assert 0 < many.memory < 6 * 4000
    before = many.forces()
    wrong = [
        ({"indentation": DEPTH, "displacement": 1e-8}, "/displacement"),
        ({"indentation": DEPTH}, "/displacement"),
        ({"displacement": [0.0, 0.0]}, "/indentation"),
        ({"indentation": DEPTH, "normal_force": 1.0, "displacement": [0.0, 0.0]}, "/indentation"),
        ({"indentation": [DEPTH] * 4, "displacement": [0.0, 0.0]}, "/indentation"),
        ({"indentation": DEPTH, "displacement": [[0.0, 0.0]] * 2}, "/displacement"),
        ({"normal_force": np.full((2, 3), -1.0), "displacement": [0.0, 0.0]}, "/normal_force/0"),
        ({"indentation": DEPTH, "displacement": np.full((2, 3, 2), np.nan)}, "/displacement/0/0"),
    ]
    for arguments, pointer in wrong:
        with pytest.raises(ss.InvalidInput) as refused:
            many.step(**arguments)
        assert refused.value.pointer == pointer
        assert np.array_equal(many.forces()[1], before[1])
    for rings in (3, 161, -1):
        with pytest.raises(ss.InvalidInput) as refused:
            planar(1, rings=rings)
        assert refused.value.pointer == "/rings"
    with pytest.raises(ss.InvalidInput) as refused:
        ss.PlanarContacts(1, ss.Cylinder(RADIUS, length=0.01), MODULI, FRICTION)
    assert refused.value.pointer == "/profile"
