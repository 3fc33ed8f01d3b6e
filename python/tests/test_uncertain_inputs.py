"""Uncertain inputs of a sweep as numbers of `uncertainties` and pint and as estimates, and the outputs as such."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip import requests

uncertainties = pytest.importorskip("uncertainties")
pint = pytest.importorskip("pint").UnitRegistry()
ufloat = uncertainties.ufloat
BALL = ss.Definition(ss.Sphere("10 mm"), [ss.Body("210 GPa", 0.3), ss.RIGID], 0.3, normal_force="10 N")
BASE = {"contact": BALL, "path": {"displacement": [0.0]}}
RADIUS, LOAD = "/contact/profile/radius", "/contact/preload/normal_force"
MODULUS = "/contact/material/bodies/0/youngs_modulus"


def test_a_ball_has_the_uncertainty_of_a_product_of_powers(engine: Any) -> None:
    # The contact radius goes as the cube root of load times radius over modulus, and the stiffness 2 G* a.
    inputs = {
        LOAD: ufloat(10.0, 0.1),
        RADIUS: ufloat(10.0, 0.2) * pint.mm,
        MODULUS: (210.0 * pint.GPa).plus_minus(6.3),
    }
    found = engine.sweep(BASE, inputs=inputs, outputs={"radius": "/steps/0/contact_radius"}, samples=4096)
    assert isinstance(found, ss.results.UncertaintyReply)
    radius = found.outputs[0]
    error = np.sqrt(0.01**2 + 0.02**2 + 0.03**2) / 3.0
    # To first order, and the second order is below a part in a thousand.
    assert radius.std_dev / radius.nominal_value == pytest.approx(error, rel=0.03)
    assert radius.nominal_value == pytest.approx(ss.Contact.from_definition(BALL).state.contact_radius, rel=2e-3)
    shares = np.array([0.01, 0.02, 0.03]) ** 2 / (0.01**2 + 0.02**2 + 0.03**2)
    for pointer, share in zip(inputs, shares, strict=True):
        one = radius.shares[pointer]
        assert abs(one.value - share) < 4.0 * one.standard_error
    answer = radius.ufloat()
    assert (answer.nominal_value, answer.std_dev) == (radius.nominal_value, radius.std_dev)
    # It goes on in a calculation of its own.
    assert (2.0 * answer).std_dev == pytest.approx(2.0 * radius.std_dev)
    assert repr(radius).startswith("radius: ")
    frame = found.to_frame()
    assert frame["mean"].tolist() == [radius.nominal_value]
    assert frame[f"share of {LOAD}"].tolist() == [radius.shares[LOAD].value]
    assert {"standard_uncertainty", "low", "high"} <= set(frame.columns)


def test_every_way_to_say_an_input_is_the_same_document() -> None:
    normal = {"mean": 0.01, "standard_uncertainty": 1e-4}
    wanted = {"pointer": RADIUS, "normal": pytest.approx(normal)}
    for given in (
        {RADIUS: ufloat(0.01, 1e-4)},
        {RADIUS: ufloat(10.0, 0.1) * pint.mm},
        {RADIUS: (1.0 * pint.cm).plus_minus(0.01)},
        {RADIUS: {"normal": normal}},
        {RADIUS: {"normal": {"mean": "10 mm", "standard_uncertainty": "0.1 mm"}}},
        [{"pointer": RADIUS, "normal": ufloat(0.01, 1e-4)}],
        [{"pointer": RADIUS, "normal": {"mean": "10 mm", "standard_uncertainty": 1e-4}}],
    ):
        assert requests.inputs(given) == [wanted], given
    assert requests.inputs({RADIUS: {"uniform": {"from": "9 mm", "to": "11 mm"}}}) == [
        {"pointer": RADIUS, "uniform": pytest.approx({"from": 0.009, "to": 0.011})}
    ]


def test_an_estimate_of_a_fit_is_an_input() -> None:
    contact = ss.Contact.from_definition(BALL)
    turn = 1.5 * contact.summary.gross_slip_displacement
    contact.path([turn])
    u = turn * np.cos(np.linspace(0.0, 2.0 * np.pi, 81))[1:]
    noise = np.random.default_rng(2).normal(0.0, 0.01, 80)
    fit = ss.fit(BALL, (u, contact.path(u).force + noise), free=["friction", "g_star"])
    friction = fit.estimates["friction"]
    (entry,) = requests.inputs({"/contact/friction": friction})
    assert entry["normal"] == {"mean": friction.value, "standard_uncertainty": friction.standard_error}


def test_one_number_in_two_places_is_one_input_and_dependent_numbers_are_refused() -> None:
    steel = ufloat(2.1e11, 6e9)
    other = MODULUS.replace("0", "1")
    one = {"pointers": [MODULUS, other], "normal": {"mean": 2.1e11, "standard_uncertainty": 6e9}}
    assert requests.inputs({MODULUS: steel, other: steel}) == [one]
    assert requests.inputs({(MODULUS, other): steel}) == [one]
    assert len(requests.inputs({MODULUS: steel, other: ufloat(2.1e11, 6e9)})) == 2
    with pytest.raises(ss.InvalidInput, match="depends on another input") as refused:
        requests.inputs({MODULUS: steel, other: 1.1 * steel})
    assert refused.value.pointer == "/inputs/1"


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({RADIUS: 0.01}, "has no uncertainty"),
        ({RADIUS: "10 mm"}, "has no uncertainty"),
        ({RADIUS: ufloat(0.01, 1e-4) * 0.0}, "no standard uncertainty above 0"),
        ({RADIUS: ufloat(10.0, 0.1) * pint.N}, "not a number of m"),
        ({RADIUS: {"normal": {"mean": "10 N", "standard_uncertainty": 1e-4}}}, "10 N"),
        ({"/contact/radius": ufloat(0.01, 1e-4)}, "`radius` is not known here"),
        ([ufloat(0.01, 1e-4)], "is no input"),
        ("radius", "by their pointers are expected"),
    ],
)
def test_what_is_no_uncertain_input_is_refused_in_words_of_the_package(given: Any, words: str) -> None:
    with pytest.raises(ss.InvalidInput) as refused:
        ss.sweep(BASE, inputs=given, outputs="/steps/0/contact_radius", samples=64)
    assert words in str(refused.value)
    assert str(refused.value.pointer).startswith("/inputs")


def test_an_uncertainty_outside_the_inputs_is_refused() -> None:
    uncertain = ss.Definition(ss.Sphere(ufloat(0.01, 1e-4)), [ss.Body("210 GPa", 0.3), ss.RIGID], 0.3, normal_force=1.0)
    with pytest.raises(ss.InvalidInput, match="name it in `inputs`") as refused:
        ss.sweep({"contact": uncertain, "path": 3}, axes={LOAD: [1.0]}, outputs="/steps/0/force")
    assert str(refused.value.pointer).endswith("/profile/radius")
