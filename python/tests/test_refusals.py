"""Bad input names the field, in process and on a server; units; files of instruments."""

from __future__ import annotations

import copy
import re
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip import members, requests
from stickslip.documents import to_document
from stickslip.engine import NAMES

STEEL = ss.Body(2.1e11, 0.3)
BALL = ss.Definition(ss.Sphere(0.01), [STEEL, ss.RIGID], 0.3, normal_force=10.0)


def defined(**changed: Any) -> ss.Definition:
    given: dict[str, Any] = {"profile": ss.Sphere(0.01), "bodies": [STEEL, ss.RIGID], "friction": 0.3}
    return ss.Definition(**(given | {"normal_force": 10.0} | changed))


BAD: list[tuple[Callable[[Any], Any], str]] = [
    (lambda e: e.cycle(defined(profile=ss.Sphere(-1.0)), 1e-8), "/contact/profile/radius"),
    (lambda e: e.cycle(defined(profile=ss.Sphere("10 mm/s")), 1e-8), "/contact/profile/radius"),
    (lambda e: e.cycle(defined(profile=ss.Sphere("10 N")), 1e-8), "/contact/profile/radius"),
    (lambda e: e.cycle(defined(profile=ss.Sphere(float("nan"))), 1e-8), "/contact/profile/radius"),
    (lambda e: e.cycle(defined(friction=-0.1), 1e-8), "/contact/friction"),
    (lambda e: e.cycle(defined(normal_force="10 um"), 1e-8), "/contact/preload/normal_force"),
    (
        lambda e: e.cycle(defined(bodies=[ss.Body("210 mm", 0.3), ss.RIGID]), 1e-8),
        "/contact/material/bodies/0/youngs_modulus",
    ),
    (
        lambda e: e.cycle(defined(bodies=[ss.Body(2.1e11, 0.6), ss.RIGID]), 1e-8),
        "/contact/material/bodies/0/poisson_ratio",
    ),
    (lambda e: e.cycle(defined(bodies=[STEEL]), 1e-8), "/contact/material/bodies"),
    (lambda e: e.cycle(BALL, np.array([1e-8, -1e-8])), "/drive/displacement/1"),
    (lambda e: e.cycle(BALL, 1e-8, machine={"stifness": 1.0}), "/machine"),
    (lambda e: e.cycle(BALL, 1e-8, machine="3 N"), "/machine/stiffness"),
    (lambda e: e.fretting(BALL, 1e-8, bulk=("1 MPa", "2 MPa"), ruiz=True), "/bulk"),
    (lambda e: e.cycle(BALL), "/drive"),
    (lambda e: e.simulate(BALL, displacement=[1e-8, "3 N"]), "/path/displacement/1"),
    (lambda e: e.simulate(BALL, falling_amplitude=0), "/path/falling_amplitude/reversals"),
    (lambda e: e.simulate(BALL, displacement=[1e-8], stress=1), "/stress/points"),
    (lambda e: e.simulate(BALL, force=[3.5]), "/path/force/0"),
    (lambda e: e.fretting(BALL, 1e-8, crossland={"alpha": -1.0}), "/criteria/crossland/alpha"),
    (lambda e: e.fretting(BALL, 1e-8, crossland={"alpha": 0.3, "limit": "3 N"}), "/criteria/crossland/limit"),
    (lambda e: e.fretting(BALL, 1e-8, bulk={"mean": "1 mm"}, ruiz=True), "/bulk/mean"),
    (
        lambda e: e.fretting(BALL, 1e-8, swt=True, critical_distance={"length": "3 N", "method": "line"}),
        "/critical_distance/length",
    ),
    (lambda e: e.wear(BALL, "3 N"), "/drive/displacement"),
    (lambda e: e.wear(BALL, 1e-8, hold="normal_force"), "/hold"),
    (lambda e: e.protocols(BALL, 0), "/reversals"),
    (lambda e: e.protocols(BALL, 5, kind="best"), "/kind"),
    (
        lambda e: e.sweep(
            {"contact": BALL, "path": {"displacement": [1e-8]}}, {"/contact/frictoin": [0.1]}, "/steps/0"
        ),
        "/axes/0/pointer",
    ),
]


@pytest.mark.parametrize("case", range(len(BAD)))
def test_bad_input_names_the_field(case: int, api: ss.Client) -> None:
    call, pointer = BAD[case]
    for engine in (ss, api):
        with pytest.raises(ss.InvalidInput) as refused:
            call(engine)
        assert refused.value.pointer is not None
        assert refused.value.pointer.startswith(pointer), refused.value


def places(document: Any, path: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    """The places of all members and items of a document."""
    if not isinstance(document, dict | list):
        return []
    inner = document.items() if isinstance(document, dict) else enumerate(document)
    return [place for name, item in inner for place in [(*path, name), *places(item, (*path, name))]]


def test_no_refusal_has_words_of_the_reader_of_json(openapi: dict[str, Any]) -> None:
    generator = np.random.default_rng(11)
    wrong: list[Any] = ["text", 7, -1, 2.5, True, [], [3], {}, {"other": 1}, None, [[]], [None], ""]
    refused, details = 0, set()
    for path, methods in openapi["paths"].items():
        if path not in members.METHODS or path == "/sweep":
            continue
        content = methods["post"]["requestBody"]["content"]["application/json"]
        whole = next((one["value"] for one in content.get("examples", {}).values()), content.get("example"))
        if whole is None:
            whole = openapi["components"]["schemas"][content["schema"]["$ref"].rpartition("/")[2]]["example"]
        for _ in range(60):
            document = copy.deepcopy(whole)
            every = places(document)
            place = every[generator.integers(len(every))]
            inner = document
            for name in place[:-1]:
                inner = inner[name]
            kind = generator.integers(8)
            if kind == 0 and isinstance(inner, dict):
                del inner[place[-1]]
            elif kind == 1 and isinstance(inner, dict):
                inner["unheard_of"] = wrong[generator.integers(len(wrong))]
            else:
                inner[place[-1]] = wrong[generator.integers(len(wrong))]
            try:
                ss.compute(NAMES[path], document)
            except ss.StickslipError as error:
                refused += 1
                # Names of members are no words of a reader.
                details |= {re.sub("`[^`]*`", "``", fault.detail) for fault in error.errors}
    assert refused > 300
    words = ("invalid type", "invalid value", "invalid length", "unknown variant", "unknown field", "missing field")
    words += ("f64", "usize", "struct ", "sequence", "floating point", "an object with one key", "null", "map")
    assert sorted(detail for detail in details if any(word in detail for word in words)) == []


def test_range_and_kind_of_a_refusal() -> None:
    with pytest.raises(ss.InvalidInput) as refused:
        ss.cycle(defined(profile=ss.Sphere(-1.0)), 1e-8)
    assert refused.value.range == (1e-15, 1e9)
    assert refused.value.code == "invalid_input"
    with pytest.raises(ss.NotFound):
        ss.compute("friction", {})
    with pytest.raises(TypeError):
        ss.Sphere()  # type: ignore[call-arg]


@pytest.mark.parametrize(
    ("text", "name", "value"),
    [
        ("20 um", "radius", 2e-5),
        ("20 µm", "radius", 2e-5),
        ("0.1nm", "displacement", 1e-10),
        ("100 MPa", "e_star", 1e8),
        ("4 N", "force", 4.0),
        ("-2.5e-1 mN", "normal_force", -2.5e-4),
        ("20 N/um", "stiffness", 2e7),
        ("30 deg", "phase", 30.0),
        ("500 g", "mass", 0.5),
        ("30 %", "friction", 0.3),
        ("12", "radius", 12.0),
        ("2 kHz", "frequencies", 2000.0),
    ],
)
def test_units_are_scaled_to_the_last_bit(text: str, name: str, value: float) -> None:
    assert to_document({name: text}) == {name: value}


def test_quantities_of_pint() -> None:
    pint = pytest.importorskip("pint")
    unit = pint.UnitRegistry()
    moduli = ss.Moduli(115 * unit.GPa, 85 * unit.GPa)
    document = to_document(ss.Definition(ss.Sphere(10 * unit.mm), moduli, 0.3, 4 * unit.N))
    assert document["profile"]["radius"] == pytest.approx(0.01)
    assert document["material"]["effective"]["e_star"] == pytest.approx(1.15e11)
    assert to_document({"displacement": [1, 2] * unit.um})["displacement"] == pytest.approx([1e-6, 2e-6])
    with pytest.raises(ss.InvalidInput):
        to_document({"radius": 3 * unit.N})


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("3 micrometers", 3e-6),
        ("2 mil", 5.08e-5),
        ("0.5 in", 0.0127),
        ("7 10^-6 m", 7e-6),
        ("4 \u338d", None),
        ("5 \u339b", 5e-6),
        ("6 Âµm", 6e-6),
        ("8 angstrom", 8e-10),
        ("1 ?m", None),
        ("1 V", None),
        ("1,000 um", None),
        ("1 um?", None),
        ("1 xyz", None),
    ],
)
def test_texts_are_read_by_the_units_of_the_engine_or_refused_by_name(text: str, value: float | None) -> None:
    if value is not None:
        assert to_document({"radius": text}) == {"radius": pytest.approx(value, rel=1e-15)}
        return
    for name in ("radius", "no_such_member"):
        if text == "1 V" and name == "no_such_member":
            continue
        with pytest.raises(ss.InvalidInput) as refused:
            to_document({name: text})
        assert refused.value.code == "unknown_unit"
        assert refused.value.pointer == f"/{name}"
        assert text.split(" ", 1)[1].split(" ")[0] in str(refused.value)


def test_labels_are_texts() -> None:
    texts = {"label": "10 N", "type": "sphere", "at": "2026-11-26T08:00:00Z"}
    assert to_document(texts) == texts


def test_loops_in_different_units_are_fitted_together_in_si_units() -> None:
    rows = [(0.1 * k, 0.5 * k) for k in range(20)]
    micro = ss.read_loop(("d (um);f (N)\n" + "\n".join(f"{d};{f}" for d, f in rows)).encode())
    milli = ss.read_loop(("d (mm);f (mN)\n" + "\n".join(f"{d / 1e3};{f * 1e3}" for d, f in rows)).encode())
    found, units = requests.loops([micro, milli], None)
    assert units is None
    for name in ("displacement", "force"):
        assert found[0][name] == pytest.approx(found[1][name], rel=1e-12)
    assert found[0]["displacement"][1] == pytest.approx(1e-7)


def test_loops_and_scans_are_read_in_any_encoding() -> None:
    rows = "\n".join(f"{0.1 * k:.1f};{0.5 * k:.1f}".replace(".", ",") for k in range(20))
    for encoding in ("utf-8", "utf-8-sig", "utf-16"):
        loop = ss.read_loop(f"displacement (um);force (mN)\n{rows}\n".encode(encoding))
        assert loop.units == {"displacement": "um", "force": "mN"}
        assert loop.loop["force"][3] == 1.5
        scan = ss.read_scan(f"x (mm);z (um)\n{rows}\n".encode(encoding))
        assert scan.units == {"lateral": "mm", "height": "um"}
        assert len(scan.scan["line"]["z"]) == 20
    with pytest.raises(ValueError):
        ss.read_loop(b"")


def test_loop_of_arrays_gives_its_friction() -> None:
    contact = ss.Contact.from_definition(BALL)
    turn = 1.5 * contact.summary.gross_slip_displacement
    contact.path([turn])
    displacement = turn * np.cos(np.linspace(0.0, 2.0 * np.pi, 81))[1:]
    found = contact.path(displacement)
    force = found.force
    fit = ss.fit(defined(friction=0.5), (displacement, force), free=["friction", "g_star"])
    assert fit.estimates["friction"].value == pytest.approx(0.3, rel=1e-6)
