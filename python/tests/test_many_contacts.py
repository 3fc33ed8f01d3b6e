"""Arrays of contacts with their own radii, friction and bodies: each is the contact of its own definition."""

from __future__ import annotations

import copy
import os
import pickle
import signal
import threading
import time
from typing import Any

import numpy as np
import pytest

import stickslip as ss

STEEL = ss.Body("210 GPa", 0.3)
RADII = np.array([0.005, 0.01, 0.02])
FRICTION = np.array([0.1, 0.3, 0.5])


def varied() -> ss.Contacts:
    return ss.Contacts(profile=ss.Sphere(RADII), bodies=[STEEL, ss.RIGID], friction=FRICTION)


def test_each_contact_has_its_own_radius_friction_and_bodies() -> None:
    moduli = np.array([1e11, 2e11])[:, None]
    many = ss.Contacts(profile=ss.Sphere(RADII), bodies=[ss.Body(moduli, 0.3), ss.RIGID], friction=FRICTION)
    assert many.shape == (2, 3)
    path = [(1e-6, 0.0), (1e-6, 8e-8), (8e-7, -3e-8)]
    for depth, displacement in path:
        normal, force = many.step(depth, displacement)
    for row in range(2):
        for column in range(3):
            one = ss.Contact(
                ss.Sphere(RADII[column]),
                [ss.Body(moduli[row, 0], 0.3), ss.RIGID],
                friction=FRICTION[column],
                indentation=0.0,
            )
            for depth, displacement in path:
                state = one.move(indentation=depth, displacement=displacement).state
            assert (normal[row, column], force[row, column]) == (state.normal_force, state.force)
            assert many.state((row, column)).document == one.state.document
            assert many.definition((row, column)) == one.definition()


@pytest.mark.parametrize("radii", [["5 mm", "10 mm", "20 mm"], RADII.tolist(), "of pint", "of astropy"], ids=str)
def test_arrays_of_a_definition_are_read_as_every_number(radii: Any) -> None:
    if radii == "of pint":
        radii = 1e3 * RADII * pytest.importorskip("pint").UnitRegistry().mm
    elif radii == "of astropy":
        radii = 1e3 * RADII * pytest.importorskip("astropy.units").mm
    many = ss.Contacts(profile=ss.Sphere(radii), bodies=[STEEL, ss.RIGID], friction=0.3)
    assert many.shape == (3,)
    assert [many.definition(index)["profile"]["radius"] for index in range(3)] == pytest.approx(RADII, rel=1e-15)


def test_arrays_that_do_not_fit_and_wrong_shapes_are_refused_at_their_place() -> None:
    moduli = ss.Moduli(1e11, 8e10)
    wrong: list[tuple[Any, str]] = [
        (lambda: ss.Contacts(profile=ss.Sphere([0.01, 0.02]), bodies=moduli, friction=FRICTION), "/profile/radius"),
        (lambda: ss.Contacts(2, ss.Sphere(RADII), moduli, 0.3), "/profile/radius"),
        (lambda: ss.Contacts(profile=ss.Sphere(0.01), bodies=moduli, friction=0.3), "/shape"),
        (lambda: ss.Contacts(3, ss.Sphere([0.01, -0.02, 0.03]), moduli, 0.3), "/profile/radius"),
        (lambda: ss.Contacts(ss.Sphere(0.01), moduli, 0.3), "/shape"),  # type: ignore[arg-type]
        (lambda: ss.Contacts(-1, ss.Sphere(0.01), moduli, 0.3), "/shape"),
        (lambda: ss.Contacts(1.5, ss.Sphere(0.01), moduli, 0.3), "/shape"),  # type: ignore[arg-type]
        (lambda: ss.Contacts(10**12, ss.Sphere(0.01), moduli, 0.3), "/shape"),
        (lambda: ss.Contacts(900_000_000, ss.Sphere(0.01), moduli, 0.3), "/shape"),
        (lambda: ss.Contacts((10**6, 10**6), ss.Sphere(0.01), moduli, 0.3), "/shape"),
        (lambda: ss.PlanarContacts(900_000_000, ss.Sphere(0.01), moduli, 0.3), "/shape"),
        (lambda: ss.Contacts(3, bodies=moduli, friction=0.3), "/profile"),
    ]
    for make, pointer in wrong:
        with pytest.raises(ss.InvalidInput) as refused:
            make()
        assert refused.value.pointer == pointer, refused.value


def test_a_step_to_a_normal_force_ends_under_it() -> None:
    many, other = varied(), varied()
    forces = np.array([5.0, 0.0, 20.0])
    normal, force = many.step(normal_force=forces, displacement=2e-8)
    assert normal == pytest.approx(forces, rel=1e-13)
    depth = [many.state(index).indentation for index in range(3)]
    assert np.array_equal(force, other.step(depth, 2e-8)[1])
    for wrong in ({"indentation": 1e-6, "normal_force": 1.0}, {}):
        with pytest.raises(ss.InvalidInput, match="either indentation or normal_force"):
            many.step(displacement=0.0, **wrong)
    with pytest.raises(ss.InvalidInput) as refused:
        many.step(normal_force=[1.0, -1.0, 1.0], displacement=0.0)
    assert refused.value.pointer == "/normal_force/1"


def test_the_deepest_contact_of_each_profile_must_be_within_it() -> None:
    many = ss.Contacts(profile=ss.ExactSphere(RADII), bodies=ss.Moduli(1e11, 8e10), friction=0.3)
    with pytest.raises(ss.InvalidInput) as refused:
        many.step([7e-3, 7e-3, 8e-3], 0.0)
    assert refused.value.pointer == "/indentation/0"
    assert np.all(many.forces()[0] == 0.0)


def test_copies_are_independent_and_pickled_contacts_go_on_as_they_would_have() -> None:
    many = varied()
    many.step(1e-6, [1e-7, 5e-8, -2e-7])
    many.step(9e-7, [-1e-8, 5e-8, 2e-7])
    copies = [many.copy(), copy.copy(many), copy.deepcopy(many), pickle.loads(pickle.dumps(many)), many[...]]
    before = [many.state(index).document for index in range(3)]
    expected = many.step(8e-7, 3e-8)
    for one in copies:
        assert [one.state(index).document for index in range(3)] == before
        assert one.shape == many.shape
        assert np.array_equal(one.step(8e-7, 3e-8), expected)
    with pytest.raises(ss.InvalidInput, match="not those of contacts"):
        ss.Contacts.from_bytes(b"nothing")
    with pytest.raises(ss.InvalidInput):
        ss.Contacts.from_bytes(many.to_bytes()[:-3])


def test_contacts_are_indexed_as_arrays_are() -> None:
    many = ss.Contacts((2, 3), ss.Sphere(0.01), ss.Moduli(1e11, 8e10), 0.3)
    many.step(1e-6, np.arange(6.0).reshape(2, 3) * 1e-8)
    forces = many.forces()[1]
    index: Any
    for index in (0, (1, 2), slice(0, 1), (slice(None), 1), ..., np.array([[True, False, True], [False] * 3]), [1, 0]):
        part = many[index]
        assert part.shape == forces[index].shape
        assert np.array_equal(part.forces()[1], forces[index])
    assert many[1, 2].state(0).force == many.state((1, 2)).force == forces[1, 2]
    part = many[0]
    part.step(1e-6, 9e-8)
    assert np.array_equal(many.forces()[1], forces)
    for wrong in ((5, 0), 6, (0, 0, 0)):
        with pytest.raises(IndexError):
            many.state(wrong)


def test_an_interrupt_ends_a_long_step_soon_and_moves_no_contact() -> None:
    many = ss.Contacts(400_000, ss.Sphere(0.01), ss.Moduli(1e11, 8e10), 0.3, threads=1)
    many.step(1e-6, 1e-9)
    before = many.forces()
    generator = np.random.default_rng(3)
    displacement = generator.uniform(-1e-8, 1e-8, 400_000)
    begun = threading.Event()

    def interrupt() -> None:
        begun.wait()
        time.sleep(0.05)
        os.kill(os.getpid(), signal.SIGINT)

    handler = signal.signal(signal.SIGINT, signal.default_int_handler)
    thread = threading.Thread(target=interrupt)
    thread.start()
    done = [before]

    def step_on() -> None:
        begun.set()
        while True:
            done.append(many.step(1e-6, displacement if len(done) % 2 else -displacement))

    try:
        with pytest.raises(KeyboardInterrupt):
            step_on()
    finally:
        thread.join()
        signal.signal(signal.SIGINT, handler)
    # The one that was interrupted has moved no contact.
    assert np.array_equal(many.forces(), done[-1])


def test_an_interrupted_step_leaves_most_of_its_work_undone() -> None:
    many = ss.Contacts(300_000, ss.Cylinder(0.01, length=0.01), ss.Moduli(1e11, 8e10), 0.3, threads=1)
    begin = time.process_time()
    many.step(normal_force=500.0, displacement=1e-8)
    whole = time.process_time() - begin
    handler = signal.signal(signal.SIGINT, signal.default_int_handler)
    begin = time.process_time()
    try:
        threading.Timer(0.1 * whole, os.kill, (os.getpid(), signal.SIGINT)).start()
        with pytest.raises(KeyboardInterrupt):
            many.step(normal_force=600.0, displacement=-1e-8)
    finally:
        signal.signal(signal.SIGINT, handler)
    # Work over work of the same kind, on whatever machine: a step that went on to its end would take all of it.
    assert time.process_time() - begin < 0.5 * whole


def test_a_contact_that_another_thread_uses_is_refused_by_an_error_of_the_package(here: ss.Contact) -> None:
    many = ss.Contacts(300_000, ss.Sphere(0.01), ss.Moduli(1e11, 8e10), 0.3, threads=1)
    seen: list[Exception] = []
    for one, call, look in (
        (here, lambda: here.path(falling_amplitude=20_000), lambda: here.state),
        (many, lambda: many.step(1e-6, 1e-8), lambda: many.forces()),
    ):
        thread = threading.Thread(target=call)
        thread.start()
        while thread.is_alive():
            try:
                look()
            except ss.Conflict as error:
                seen.append(error)
        thread.join()
        assert seen, type(one)
        assert all(error.code == "in_use" for error in seen)  # type: ignore[attr-defined]
        look()
        seen.clear()
