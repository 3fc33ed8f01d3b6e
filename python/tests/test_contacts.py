"""Many contacts over arrays: closed forms, trial and commit, tangent stiffness, threads."""

from __future__ import annotations

import numpy as np
import pytest

import stickslip as ss

RADIUS, FRICTION = 0.01, 0.3
MODULI = ss.Moduli(1.15e11, 8.5e10)
DEPTH = 1e-6
#: Scale of tangential against normal displacement, mu E*/G*.
SCALE = FRICTION * MODULI.e_star / MODULI.g_star


def contacts(count: int, threads: int = 1) -> ss.Contacts:
    return ss.Contacts(count, ss.Sphere(RADIUS), MODULI, FRICTION, threads=threads)


def hertz(depth: np.ndarray) -> np.ndarray:
    return 4.0 / 3.0 * MODULI.e_star * np.sqrt(RADIUS) * np.maximum(depth, 0.0) ** 1.5


def test_forces_are_those_of_hertz_and_of_cattaneo_and_mindlin() -> None:
    many = contacts(1000)
    depth = np.linspace(0.1, 2.0, 1000) * DEPTH
    normal, force = many.step(depth, np.zeros(1000))
    assert np.allclose(normal, hertz(depth), rtol=1e-13)
    assert np.all(force == 0.0)
    share = np.linspace(-1.5, 1.5, 1000)
    force = many.step(depth, share * SCALE * depth)[1]
    exact = np.sign(share) * FRICTION * hertz(depth) * (1.0 - np.maximum(1.0 - np.abs(share), 0.0) ** 1.5)
    assert np.allclose(force, exact, rtol=0.0, atol=1e-13 * FRICTION * hertz(depth).max())


def test_unloading_is_that_of_mindlin_and_deresiewicz() -> None:
    many = contacts(50)
    many.step(DEPTH, 0.0)
    limit, slip = FRICTION * hertz(np.array(DEPTH)), SCALE * DEPTH
    top = 0.8
    first = many.step(DEPTH, top * slip)[1]
    back = np.linspace(top, -top, 50)
    force = many.step(DEPTH, back * slip)[1]
    exact = first - 2.0 * limit * (1.0 - (1.0 - (top - back) / 2.0) ** 1.5)
    assert np.allclose(force, exact, rtol=0.0, atol=1e-13 * limit)


def test_a_trial_changes_nothing_until_it_is_committed() -> None:
    many = contacts(20)
    many.step(DEPTH, np.linspace(0.0, 1e-7, 20))
    before = [many.state(index).document for index in range(20)]
    tried = many.trial(DEPTH, np.linspace(1e-7, -1e-7, 20))
    assert [many.state(index).document for index in range(20)] == before
    many.revert()
    assert np.array_equal(many.forces()[1], [state["force"] for state in before])
    again = many.trial(DEPTH, np.linspace(1e-7, -1e-7, 20))
    many.commit()
    assert np.array_equal(tried, again)
    assert np.array_equal(many.forces(), again)
    with pytest.raises(RuntimeError):
        many.commit()


def test_stiffness_is_the_derivative_of_the_force() -> None:
    many = contacts(30)
    many.step(DEPTH, 0.0)
    share = np.linspace(0.05, 0.9, 30)
    many.step(DEPTH, share * SCALE * DEPTH)
    radius = np.sqrt(RADIUS * DEPTH)
    normal, onwards = many.stiffness(1)
    assert np.allclose(normal, 2.0 * MODULI.e_star * radius, rtol=1e-13)
    # Of a punch as large as the part that sticks; after a turn that is all of the contact.
    assert np.allclose(onwards, 2.0 * MODULI.g_star * radius * np.sqrt(1.0 - share), rtol=1e-9)
    assert np.allclose(many.stiffness(-1)[1], 2.0 * MODULI.g_star * radius, rtol=1e-9)
    step = 1e-6 * SCALE * DEPTH
    force = many.forces()[1]
    ahead = many.trial(DEPTH, share * SCALE * DEPTH + step)[1]
    assert np.allclose((ahead - force) / step, onwards, rtol=1e-4)


def test_a_contact_that_has_parted_has_lost_its_history() -> None:
    many, fresh = contacts(10), contacts(10)
    many.step(DEPTH, 5e-8)
    assert np.all(np.array(many.step(-1e-9, 5e-8)) == 0.0)
    fresh.step(-1e-9, 5e-8)
    assert np.array_equal(many.step(DEPTH, 6e-8), fresh.step(DEPTH, 6e-8))


def test_threads_change_no_bit_and_paths_are_those_of_one_contact() -> None:
    generator = np.random.default_rng(7)
    one, four = contacts(20_000, 1), contacts(20_000, 4)
    single = ss.Contact(ss.Sphere(RADIUS), MODULI, FRICTION, indentation=0.0)
    for _ in range(12):
        depth, displacement = generator.uniform(0.0, DEPTH, 20_000), generator.uniform(-4e-7, 4e-7, 20_000)
        steps = one.step(depth, displacement), four.step(depth, displacement)
        assert np.array_equal(*steps)
        single.move(displacement=float(displacement[5]), indentation=float(depth[5]))
    assert single.state.document == one.state(5).document


def test_wrong_arrays_name_the_element_and_move_no_contact() -> None:
    many = contacts(3)
    many.step(DEPTH, 0.0)
    before = many.forces()
    wrong = [
        (([DEPTH, float("nan"), DEPTH], 0.0), "/indentation/1"),
        ((DEPTH, [0.0, 0.0, 2e9]), "/displacement/2"),
        (([DEPTH, DEPTH], 0.0), "/indentation"),
    ]
    for arguments, pointer in wrong:
        with pytest.raises(ss.InvalidInput) as refused:
            many.step(*arguments)
        assert refused.value.pointer == pointer
        assert np.array_equal(many.forces(), before)
