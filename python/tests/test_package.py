"""The lines that the package promises, its names and fields beside those of the API."""

from __future__ import annotations

import importlib.util
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

import stickslip as ss
from conftest import ROOT
from stickslip import _native, computations, engine, members, plots, profiles, quantities, schemas

HERE = Path(__file__).resolve().parents[1]
GENERATOR = HERE / "tools" / "generate.py"


def generator() -> Any:
    spec = importlib.util.spec_from_file_location("generate", GENERATOR)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def blocks(path: Path) -> str:
    """The Python of a page, as one program."""
    return "\n".join(re.findall(r"^```python\n(.*?)^```", path.read_text(), re.MULTILINE | re.DOTALL))


def test_lines_of_the_readme_run() -> None:
    program = blocks(HERE / "README.md")
    assert 'crossland=dict(alpha=0.3, limit="300 MPa"))' in program
    names: dict[str, Any] = {}
    exec(program, names)
    assert len(names["frame"]) > 5
    assert next(iter(names["y"]["displacement_amplitude"])) == pytest.approx(1e-9)
    assert len(names["y"]) == 200
    assert 0.1 < names["r"].margin < 10.0
    assert len(names["r"].place) == 3


def test_page_of_the_docs_runs() -> None:
    names: dict[str, Any] = {}
    exec(blocks(ROOT / "docs" / "python.md"), names)
    frame = names["figure5"]
    assert list(frame["reversals"]) == list(range(1, 41))
    # Kraft & Pohrt (2016): the first reversal leaves most, and each pair of more leaves less.
    assert frame["max"].is_monotonic_decreasing
    assert frame["max"].iloc[0] == pytest.approx(0.71, abs=0.01)
    assert frame["max"].iloc[19] == pytest.approx(0.17, abs=0.01)


def test_page_of_the_docs_has_every_function_its_result_and_its_picture() -> None:
    table = {}
    section = (ROOT / "docs" / "python.md").read_text().partition("## Functions\n")[2].partition("\n## ")[0]
    for row in re.findall(r"^\| (`\w+\.\w+`.*?) \|(.*)\|$", section, re.MULTILINE):
        _, result, picture = (*(cell.strip() for cell in row[1].split(" | ")), "")[:3]
        table |= {name: (result, picture.strip()) for name in re.findall(r"`(\w+\.\w+)`", row[0])}
    contact = [name for name, method in vars(computations.OfContact).items() if not name.startswith("_")]
    wanted = {f"ss.{name}" for name in members.METHODS.values()} | {f"contact.{name}" for name in contact}
    assert wanted <= set(table)
    for name, (result, picture) in table.items():
        owner = {"ss": ss, "contact": ss.Contact, "remote": ss.RemoteContact}[name.partition(".")[0]]
        method = getattr(owner, name.partition(".")[2])
        returned = re.search(r"results\.(\w+)", str(getattr(method, "__annotations__", {}).get("return", "")))
        if returned is not None:
            assert f"`{returned[1]}`" in result, name
            assert bool(picture) == (returned[1] in plots._PAINTERS), name


@pytest.mark.parametrize("name", sorted(generator().FILES))
def test_classes_are_those_of_the_document_of_the_api(name: str, openapi: dict[str, Any]) -> None:
    assert generator().FILES[name](openapi) == (HERE / "stickslip" / name).read_text()


def test_native_document_is_that_of_the_repository(openapi: dict[str, Any]) -> None:
    import json

    assert json.loads(_native.openapi()) == openapi


def test_every_schema_of_a_reply_has_its_class_and_fields(openapi: dict[str, Any]) -> None:
    module, stated = generator(), openapi["components"]["schemas"]
    for name in module.reply_schemas(openapi):
        assert set(schemas.FIELDS[name]) == set(module.fields(stated[name], stated)[0]), name


def test_every_profile_has_its_class(openapi: dict[str, Any]) -> None:
    mapping = openapi["components"]["schemas"]["Profile"]["discriminator"]["mapping"]
    kinds = {getattr(profiles, name).TYPE for name in profiles.__all__} - {""}
    assert kinds == set(mapping)
    assert set(profiles.__all__) <= set(ss.__all__)


def test_an_earlier_name_stays() -> None:
    ball = ss.Definition(ss.Sphere("10 mm"), ["100Cr6", "100Cr6"], 0.3, normal_force="10 N")
    path = ss.Contact.from_definition(ball).path(["0.2 um", "50 nm", "-0.2 um", "-50 nm"] * 4)
    fits = [
        fit(ball, (path.displacement, path.force), free=["friction"], start="virgin") for fit in (ss.fit, ss.fit_loop)
    ]
    assert fits[0].estimates["friction"].value == fits[1].estimates["friction"].value
    assert "fit_loop" in ss.__all__


def test_every_computation_has_its_path_and_method(openapi: dict[str, Any]) -> None:
    served = {name: path for name, path in _native.names() if path is not None}
    assert served == engine.PATHS
    assert set(members.METHODS) == {*served.values(), "/sweep"}
    assert set(members.METHODS) < set(openapi["paths"])
    for method in members.METHODS.values():
        assert callable(getattr(ss, method))
        assert callable(getattr(ss.Client, method))


def test_units_are_read_of_the_descriptions_and_known_to_the_engine() -> None:
    found = quantities.MEMBERS
    for name, unit in (
        ("youngs_modulus", "Pa"),
        ("stiffness", "N/m"),
        ("phase", "deg"),
        ("radii", "m"),
        ("slope", "1"),
    ):
        assert found[name] == unit
    assert quantities.unit_of("limit", "crossland") == "Pa"
    assert quantities.unit_of("mean", "bulk") == "Pa"
    assert quantities.unit_of("amplitude", "falling_amplitude") == "m"
    for unit in {*found.values(), *quantities.WITHIN.values()} - {""}:
        assert _native.quantity(f"1 {unit}" if unit != "1" else "1", unit) == 1.0, unit


def test_import_is_quick_and_light() -> None:
    program = "import sys, stickslip; print([n for n in ('pandas', 'matplotlib', 'httpx', 'pint') if n in sys.modules])"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_command_is_that_of_the_service(tmp_path: Path) -> None:
    def run(*arguments: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run([sys.executable, "-m", "stickslip", *arguments], capture_output=True, text=True)

    assert run("--version").stdout.startswith("stickslip ")
    assert run("openapi").stdout.strip() == (ROOT / "openapi" / "openapi.json").read_text().strip()
    assert run("no-such-command").returncode == 2
