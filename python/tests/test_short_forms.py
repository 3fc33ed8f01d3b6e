"""What everybody guesses is taken, help says what is allowed, and messages are in words of the package."""

from __future__ import annotations

import pydoc
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.exchange import whole_url

STEEL = ss.Body("210 GPa", 0.3)


def test_a_sphere_may_be_given_by_its_diameter() -> None:
    assert ss.Sphere(diameter="20 mm") == ss.Sphere("10 mm") == ss.Sphere(diameter=0.02)
    assert ss.Cylinder(diameter="0.1 m", length="10 mm") == ss.Cylinder("50 mm", length="10 mm")
    many = ss.Contacts(profile=ss.Sphere(diameter=[0.02, 0.04]), bodies=[STEEL, ss.RIGID], friction=0.3)
    assert [many.definition(index)["profile"]["radius"] for index in range(2)] == [0.01, 0.02]
    for given in ({}, {"radius": 1.0, "diameter": 2.0}):
        with pytest.raises((ss.InvalidInput, TypeError), match="either a radius or a diameter"):
            ss.Sphere(**given)


def test_materials_have_names_sources_and_ranges() -> None:
    assert ss.Body("steel") == ss.Body(2.1e11, 0.3)
    assert ss.Body("100cr6") == ss.Body("AISI 52100")
    for name in ("100Cr6", "42CrMo4", "Ti-6Al-4V", "Al 7075", "Al2O3", "Si3N4", "WC", "Si", "soda-lime glass", "PMMA"):
        found = ss.materials[name]
        assert found.source
        low, high = found.range["youngs_modulus"]  # type: ignore[index]
        assert low <= found.youngs_modulus <= high
    assert ss.Contact(ss.Sphere(0.01), ["brass", ss.RIGID], 0.3, normal_force=1.0).sequence == 0
    with pytest.raises(ss.InvalidInput, match="did you mean steel"):
        ss.Body("steal")
    ss.materials.add("my alloy", "180 GPa", 0.29, "a data sheet")
    assert ss.Body("My Alloy") == ss.Body("180 GPa", 0.29)
    assert ss.materials.to_frame().loc["my alloy", "youngs_modulus"] == 1.8e11


#: Shear moduli, GPa, of the sources of E and Poisson's ratio: Kaye and Laby, MIL-HDBK-5J, Munro (1997).
SHEAR_MODULI = {"aluminium": 26.1, "copper": 48.3, "brass (70 Cu, 30 Zn)": 37.3, "titanium": 43.8, "tungsten": 160.6}
SHEAR_MODULI |= {"cast iron": 60.0, "fused silica": 31.2, "Ti-6Al-4V": 42.7, "Al 7075": 26.9, "Al 2024": 27.6}
SHEAR_MODULI |= {"Inconel 718": 78.6, "Al2O3 (alumina)": 169.0, "SiC (silicon carbide)": 179.0}


def test_elastic_constants_of_materials_are_those_of_their_sources() -> None:
    for name, found in ss.materials.items():
        if found.range is None:
            continue
        modulus, ratio = found.youngs_modulus, found.poisson_ratio
        (low, high), ratios = found.range["youngs_modulus"], found.range["poisson_ratio"]
        assert low <= modulus <= high < 2.5 * low, name
        assert ratios[0] <= ratio <= ratios[1], name
        # Of rubber to diamond, and of bodies that do not swell when they are stretched.
        assert low > 1e6, name
        assert high < 1.3e12, name
        assert ratios[0] >= 0.0, name
        assert ratios[1] <= 0.5, name
        if name in SHEAR_MODULI:
            assert modulus / (2.0 + 2.0 * ratio) == pytest.approx(1e9 * SHEAR_MODULI[name], rel=0.02), name
    assert set(SHEAR_MODULI) < set(ss.materials)


def test_one_number_is_a_path_of_one_move(ball: ss.Contact) -> None:
    ball.path("10 nm")
    assert ball.path(force="0.5 N").force.tolist() == pytest.approx([0.5])
    assert ss.simulate(ball, 1e-8).displacement.tolist() == [1e-8]
    twisted = ss.Contact(ss.Sphere(0.01), [STEEL, STEEL], 0.3, normal_force=10.0)
    assert ss.simulate(twisted, twist="0.01 deg").steps[0].twist == pytest.approx(np.radians(0.01))
    assert ss.simulate(twisted, torque="10 uN*m").steps[0].torque == pytest.approx(1e-5)
    assert ball.sequence == 2


def test_short_forms_are_their_documents(here: ss.Contact, tmp_path: Any) -> None:
    assert len(here.stress().radius) == 200
    near = {"alpha": 0.3, "limit": "300 MPa"}
    long = here.fretting("50 nm", crossland=near, critical_distance={"length": 2e-5, "method": "point"})
    short = here.fretting("50 nm", crossland=near, critical_distance="20 um")
    assert short.document["crossland"] == long.document["crossland"]
    u = 3e-7 * np.cos(np.linspace(0.0, 2.0 * np.pi, 81))
    force = here.copy().path(u).force
    path = tmp_path / "loop.csv"
    rows = [f"{1e6 * one};{other}" for one, other in zip(u[1:], force[1:], strict=True)]
    path.write_text("displacement (um);force (N)\n" + "\n".join(rows))
    for given in (path, str(path), path.read_bytes()):
        fit = ss.fit(here, given, free=["friction"], known={"machine_compliance": 0.0})
        assert fit.estimates["friction"].value == pytest.approx(0.3, rel=1e-4)


def test_a_url_needs_no_scheme() -> None:
    assert whole_url("localhost:8080") == "http://localhost:8080"
    assert whole_url("https://lab.example") == "https://lab.example"


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda ball: ss.Contact(ss.Sphere(0.01), [STEEL, ss.RIGID], 0.3, load=1.0), "did you mean normal_force"),
        (lambda ball: ss.Contact(ss.Sphere(0.01), STEEL, 0.3, normal_force=1.0), "two bodies are expected"),
        (lambda ball: ss.Contact(ss.Sphere(0.01), [STEEL, ss.RIGID], 0.3), "one load, and none is given"),
        (lambda ball: ss.Body("210 GPa", None), "material '210 GPa' is not known"),
        (lambda ball: ball.stress(radii=1e-5), "0.00001 is one number, and a list is expected: give [0.00001]"),
        (lambda ball: ss.cycle("ball", 1e-8), "is no contact"),
        (lambda ball: ss.cycle(ball), "it is empty: give one of `displacement`, `force`"),
        (lambda ball: ball.path(), "/path: it is empty: give one of `moves`"),
        (lambda ball: ball.path([1e-8], force=[1.0]), "conflicts with `displacement`: give one of `moves`"),
        (lambda ball: ball.subsurface(points=[1, 2, 3]), "/points/0: 1 is given, and a list of length 3 is expected"),
        (lambda ball: ss.wear(ball, 1e-8), "/hold: `hold` is missing"),
        (lambda ball: ss.Contact(ss.Sphere(0.01), [STEEL, ss.RIGID], 0.3, effective=1.0), "did you mean bodies=ss.Mod"),
        (lambda ball: ss.Contact(ss.Sphere(0.01), [STEEL, ss.RIGID], 0.3, normal_forces=1.0), "mean normal_force?"),
        (lambda ball: ball.path(ellipse={}), "contact.path has no keyword 'ellipse': ss.accuracy and ss.simulate have"),
        (lambda ball: ball.path(forces=[1.0]), "did you mean force? known are cycles, displacement"),
        (lambda ball: ss.cycle(ball, amplitude=1e-8), "ss.cycle has no keyword 'amplitude': known are"),
        (
            lambda ball: ss.fit(ball, [0.0, 1.0], [0.0, 1.0]),
            "ss.fit takes contact and loops without their na",
        ),
        (lambda ball: ball.subsurface({}), "contact.subsurface takes no argument without its name"),
        (lambda ball: ss.sliders(ball), "expected one of `count`, `force_error`, `work_error`"),
    ],
    ids=range(19),
)
def test_messages_are_in_words_of_the_package(here: ss.Contact, call: Any, words: str) -> None:
    with pytest.raises((ss.InvalidInput, TypeError)) as refused:
        call(here)
    text = str(refused.value)
    assert words in text
    assert not any(inner in text for inner in ("__init__", "invalid type", "invalid length", "is not iterable"))
    assert "  : " not in text


def test_help_names_allowed_values_members_and_defaults() -> None:
    for function, texts in (
        (ss.fit, ["'friction', 'g_star'", "If left out: friction, g_star", "machine_compliance"]),
        (
            ss.fretting,
            ["'first', 'second'", "Needs `alpha`", "`length`, `method`", "body that is not rigid"],
        ),
        (ss.protocols, ["'displacement_zero', 'force_zero'", "One of"]),
    ):
        text = " ".join(pydoc.plain(pydoc.render_doc(function)).split())
        for one in texts:
            assert one in text, (function.__name__, one)


def test_the_module_lists_its_own_names_alone() -> None:
    assert set(dir(ss)) == set(ss.__all__)
    assert ss.types.FitParameter
    assert not {"quantities", "documents", "result", "tables"} & set(dir(ss))


def test_results_are_printed_with_units(here: ss.Contact) -> None:
    here.move("50 nm")
    assert "displacement=50 nm" in repr(here.state)
    u = 3e-7 * np.cos(np.linspace(0.0, 2.0 * np.pi, 81))
    fit = ss.fit(here, (u[1:], here.copy().path(u).force[1:]))
    assert "friction: 0.3" in str(fit)
    assert "±" in str(fit)
    html = here._repr_html_()
    assert "indentation (nm)" in html
    assert "0.000000" not in html
    assert "force (N)" in here.path([1e-8, 2e-8])._repr_html_()
