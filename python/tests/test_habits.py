"""Objects behave as those of NumPy and pandas do, signatures and docstrings say everything, warnings come once."""

from __future__ import annotations

import doctest
import inspect
import typing
import warnings
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip import aio, client, computations, members, request_types

STEEL = ss.Body("210 GPa", 0.3)
BALL = ss.Definition(ss.Sphere("10 mm"), [STEEL, ss.RIGID], 0.3, normal_force="10 N")
CLASSES = (
    computations.Computations,
    computations.OfContact,
    computations.AsyncComputations,
    computations.AsyncOfContact,
)


def test_parts_of_requests_are_equal_if_they_are_the_same_in_si_units() -> None:
    pint = pytest.importorskip("pint").UnitRegistry()
    assert ss.Sphere("10 mm") == ss.Sphere(0.01) == ss.Sphere(1 * pint.cm) != ss.Sphere(0.02)
    assert hash(ss.Sphere("10 mm")) == hash(ss.Sphere(0.01))
    assert ss.Sphere(0.01) != ss.ExactSphere(0.01)
    assert ss.Sphere(1) == ss.Sphere("1 m") == ss.Sphere(1.0)
    steel = ss.Definition(ss.Sphere(1), ["steel", "rigid"], 0, normal_force=10)
    assert steel == ss.Definition(ss.Sphere("1 m"), [ss.Body("210 GPa", 0.3), ss.RIGID], "0 %", normal_force="10 N")
    assert len({STEEL, ss.Body(2.1e11, 0.3), ss.Body(2.1e11, 0.25)}) == 2
    assert ss.Body(2.1e11, 0.3, prony=[(0.5, 1.0)]) != STEEL != ss.Body(2.1e11, 0.3, resistivity=1e-7)
    assert ss.Body(2.1e11, 0.3, prony=[(0.5, "1 s")]) == ss.Body("210 GPa", 0.3, prony=[{"ratio": 0.5, "time": 1.0}])
    assert ss.Definition(ss.Sphere(0.01), [ss.Body(2.1e11, 0.3), ss.RIGID], 0.3, normal_force=10.0) == BALL
    table = ss.Tabulated(r=[0.0, 1e-3], z=np.array([0.0, 1e-5]))
    assert table == ss.Tabulated(r=np.array([0.0, 1e-3]), z=["0 m", "10 um"])
    assert len({BALL, table, ss.Moduli(1e11, 8e10), ss.Sum([table])}) == 4


def test_shapes_of_more_than_one_parameter_are_given_by_their_names() -> None:
    punch = ss.RoundedPunch(flat_radius="1 mm", edge_radius="5 mm")
    assert punch.document() == {"type": "rounded_punch", "flat_radius": "1 mm", "edge_radius": "5 mm"}
    with pytest.raises(TypeError):
        ss.RoundedPunch("1 mm", "5 mm")  # type: ignore[misc]


def test_version_is_that_of_the_engine() -> None:
    assert ss.__version__.count(".") == 2
    assert "__version__" in ss.__all__


def test_planes_lines_and_surfaces_are_objects(ball: ss.Contact) -> None:
    plane = ss.Plane(normal="y", offset=0, x=["-100 um", "100 um", 5], z=[0, 1e-4, 4])
    assert ball.subsurface(plane=plane, fields=["von_mises"]).von_mises.shape == (20,)
    line = ss.Line(from_=[0, 0, 0], to=[0, 0, "0.1 mm"], count=7)
    assert ball.subsurface(line=line).zz.shape == (7,)
    surface = ss.Surface(x=[-1e-4, 1e-4, 3], y=[0, 1e-4, 2])
    assert ball.subsurface(surface=surface).xx.shape == (6,)


def test_bulk_is_an_amplitude_or_named(ball: ss.Contact) -> None:
    alone = ball.fretting("50 nm", bulk="50 MPa", crossland={"alpha": 0.3}, tolerance=1e-2)
    named = ball.fretting("50 nm", bulk={"mean": 0.0, "amplitude": 5e7}, crossland={"alpha": 0.3}, tolerance=1e-2)
    assert alone.crossland.largest.value == named.crossland.largest.value
    with pytest.raises(ss.InvalidInput, match="mean="):
        ball.fretting("50 nm", bulk=("150 MPa", "50 MPa"), crossland={"alpha": 0.3})  # type: ignore[arg-type]


def test_arrays_of_contacts_broadcast_as_arrays_do() -> None:
    many = ss.Contacts((4, 3), ss.Sphere("10 mm"), ss.Moduli(1.15e11, 8.5e10), 0.3)
    assert (len(many), many.shape) == (12, (4, 3))
    depth, displacement = np.linspace(1e-6, 2e-6, 4)[:, None], np.array([0.0, 1e-8, 2e-8])
    normal, force = many.step(depth, displacement)
    assert normal.shape == force.shape == many.stiffness()[0].shape == (4, 3)
    flat = ss.Contacts(12, ss.Sphere("10 mm"), ss.Moduli(1.15e11, 8.5e10), 0.3)
    same = flat.step(np.repeat(depth[:, 0], 3), np.tile(displacement, 4))
    assert np.array_equal(normal.ravel(), same[0])
    assert np.array_equal(force.ravel(), same[1])
    # The arrays own their numbers, and may be written to.
    force[:] = 0.0
    assert many.forces()[1].max() > 0.0
    for wrong in (np.zeros(4), np.zeros((3, 4)), []):
        with pytest.raises(ss.InvalidInput) as refused:
            many.step(1e-6, wrong)
        assert refused.value.pointer == "/displacement"
    # Neither strides nor the kind of the numbers matter.
    fresh = ss.Contacts(12, ss.Sphere("10 mm"), ss.Moduli(1.15e11, 8.5e10), 0.3)
    whole = fresh.trial(np.repeat(np.linspace(1e-6, 2e-6, 12), 2)[::2], np.ones(12, dtype=np.int8) * 0)
    assert np.array_equal(whole[0], fresh.step(np.linspace(1e-6, 2e-6, 12), 0.0)[0])


def test_every_keyword_has_its_type_and_its_description() -> None:
    words = {name for name, value in vars(request_types).items() if typing.get_origin(value) is typing.Literal}
    assert len(words) >= 22
    seen = 0
    for owner in CLASSES:
        for name, method in vars(owner).items():
            if name.startswith("_"):
                continue
            signature = inspect.signature(method)
            kinds = {one.kind for one in signature.parameters.values()}
            assert inspect.Parameter.VAR_KEYWORD not in kinds, name
            annotations = [one.annotation for one in signature.parameters.values()][1:]
            assert not {"Any", inspect.Parameter.empty} & set(annotations), name
            if "Async" in owner.__name__:
                continue
            text = inspect.getdoc(method)
            assert text is not None
            for part in ("Parameters\n----------", "Returns\n-------", "Raises\n------", "Examples\n--------"):
                assert part in text, name
            for parameter in list(signature.parameters)[1:]:
                assert f"\n{parameter} : " in text, (name, parameter)
            seen += 1
    # Beside the computations the calls of a contact, and the earlier name of one of them.
    assert seen == len(members.METHODS) + 7 + 1


def test_examples_of_docstrings_run() -> None:
    finder, runner = doctest.DocTestFinder(), doctest.DocTestRunner(verbose=False)
    for owner in CLASSES[:2]:
        for example in finder.find(owner, owner.__name__, globs={}):
            runner.run(example)
    assert runner.tries > 30
    assert runner.failures == 0


def test_the_same_names_in_process_on_a_server_and_for_asyncio(api: ss.Client) -> None:
    for owner in (ss.Contact, client.RemoteContact, aio.AsyncContact):
        for name in ("move", "path", "relax", "stress", "residual", "subsurface", "cycle", "fretting", "undo", "copy"):
            assert callable(getattr(owner, name)), (owner, name)
    for name in [*members.METHODS.values(), "compute", "compute_bytes", "read_loop", "read_scan"]:
        here, there = (inspect.signature(getattr(one, name)) for one in (ss, api))
        assert list(here.parameters) == list(there.parameters), name
        assert list(inspect.signature(getattr(aio.AsyncClient, name)).parameters)[1:] == list(here.parameters), name


def issued(call: Any) -> list[str]:
    """The codes of the warnings of a call."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        call()
    return sorted(warning.message.code for warning in caught if isinstance(warning.message, ss.StickslipWarning))


def test_warnings_come_once_for_a_contact_and_a_code(api: ss.Client) -> None:
    own = ["dundurs_beta", "slip_direction"]
    made: list[Any] = []
    for maker in (ss.Contact, api.Contact):
        assert issued(lambda maker=maker: made.append(maker.from_definition(BALL))) == own
        contact = made[-1]
        for call in (
            lambda contact=contact: contact.path([1e-8]),
            lambda contact=contact: contact.cycle([1e-8]),
            lambda contact=contact: contact.copy().cycle([1e-8]),
        ):
            assert issued(call) == []
        assert issued(lambda contact=contact: contact.move("2 mm")) == ["far_beyond_slip"]
        assert issued(lambda contact=contact: contact.move("2.1 mm")) == []
    assert issued(lambda: ss.cycle(made[0], [1e-8])) == []
    assert issued(lambda: ss.Contacts(2, ss.Sphere(0.01), [STEEL, ss.RIGID], 0.3, normal_force=10.0)) == own
    other = ss.Definition(ss.Sphere(0.011), [STEEL, ss.RIGID], 0.3, normal_force=10.0)
    assert issued(lambda: ss.cycle(other, [1e-8])) == own
    assert issued(lambda: ss.cycle(other, [2e-8])) == []


def test_preload_and_present_load_are_told_apart() -> None:
    contact = ss.Contact.from_definition(BALL)
    contact.move(normal_force="20 N")
    assert ss.cycle(contact, 1e-8).contact.normal_force == pytest.approx(10.0)
    assert contact.cycle(1e-8).contact.normal_force == pytest.approx(20.0)
    for method, words in ((ss.cycle, "preload of its definition"), (contact.cycle, "The load is the present one")):
        assert words in " ".join(str(method.__doc__).split())
