"""The package as it is installed: with NumPy alone, and in a user's project with the type checkers."""

from __future__ import annotations

import importlib.util
import re
import subprocess
import sys
import textwrap
from pathlib import Path

import pytest

from conftest import ROOT

PROJECT = textwrap.dedent("""
    from typing import assert_type

    import numpy as np
    from numpy.typing import NDArray

    import stickslip as ss
    from stickslip import results
    from stickslip.aio import AsyncClient

    steel = ss.Body("210 GPa", 0.3)
    ball = ss.Contact(ss.Sphere("10 mm"), [steel, ss.RIGID], friction=0.3, normal_force="10 N", label="first")
    path = ball.path(np.linspace(0.0, 1e-7, 5))
    assert_type(path.force, NDArray[np.float64])
    assert_type(path.steps[0], results.State)
    force: float = path.steps[0].force
    largest: float | None = ss.cycle(ball, ["10 nm"]).contact.max_pressure
    fit = ss.fit(ball, (path.displacement, path.force), free=["friction"], start="virgin")
    rated = ball.fretting(1e-8, bulk={"mean": 1e6}, crossland={"alpha": 0.3, "limit": "300 MPa"})
    punch = ss.RoundedPunch(flat_radius=1e-3, edge_radius="5 mm")
    plane = ss.Plane(normal="y", offset=0.0, x=[-1e-4, 1e-4, 5], z=[0.0, 1e-4, 4])
    table = ball.subsurface(plane=plane, fields=["von_mises"]).to_frame()
    many = ss.Contacts((2, 3), punch, ss.Moduli(1e11, 8e10), 0.3)
    normal, tangential = many.step(1e-6, np.zeros(3))
    sweep = ss.sweep({"contact": ball}, {"/contact/friction": [0.1, 0.2]}, "/residual/max")
    {wrong}

    async def work() -> float:
        async with AsyncClient("http://localhost:8080") as api:
            contact = await api.Contact(ss.Sphere(0.01), [steel, ss.RIGID], 0.3, normal_force=10.0)
            reply = await contact.path([1e-8])
            assert_type(reply, results.PathReply)
            async for event in contact.follow(after=0):
                return event.state.force
            return (await contact.state()).force
""")
WRONG = [
    'ball.relax(8, kind="best")',
    "ball.cycle(1e-8, harmonic=3)",
    'ss.Plane(normal="w", offset=0.0)',
    'ss.RoundedPunch("1 mm", "5 mm")',
    "ss.Contact(ss.Sphere(0.01), [steel, ss.RIGID], 0.3, normal_load=10.0)",
    'ball.subsurface(fields=["mises"])',
    'ss.read_loop("loop.csv", colour=3)',
    'ss.compute_bytes("cycle", {}, "pdf")',
]


def checked(command: list[str], folder: Path, wrong: str) -> subprocess.CompletedProcess[str]:
    (folder / "analysis.py").write_text(PROJECT.replace("{wrong}", wrong))
    return subprocess.run(command, cwd=folder, capture_output=True, text=True)


@pytest.mark.parametrize("checker", ["mypy", "pyright"])
def test_a_users_project_passes_strict_type_checks(checker: str, tmp_path: Path) -> None:
    if importlib.util.find_spec(checker) is None or sys.version_info < (3, 11):
        pytest.skip(f"{checker} and Python 3.11 are needed")
    command = [sys.executable, "-m", checker, "analysis.py"]
    if checker == "mypy":
        command += ["--strict", "--cache-dir", str(tmp_path / "cache")]
    else:
        command += ["--pythonpath", sys.executable]
        (tmp_path / "pyrightconfig.json").write_text('{"typeCheckingMode": "strict"}')
    done = checked(command, tmp_path, "")
    assert done.returncode == 0, done.stdout
    done = checked(command, tmp_path, "\n".join(WRONG))
    first = 1 + PROJECT[: PROJECT.index("{wrong}")].count("\n")
    lines = {int(number) for number in re.findall(r"analysis\.py:(\d+)(?::\d+)?(?: -)?:? error", done.stdout)}
    assert lines == set(range(first, first + len(WRONG))), done.stdout


#: What needs an extra, and which.
EXTRAS = [
    ("pandas", "pandas", "contact.stress(3).to_frame()"),
    ("pyarrow", "arrow", "contact.stress(3).to_arrow()"),
    ("matplotlib", "plot", "contact.stress(3).plot()"),
    ("httpx", "client", "ss.connect('http://localhost:1')"),
    ("httpx", "client", "ss.serve()"),
    ("httpx", "client", "import stickslip.aio"),
    (
        "fsspec",
        "dask",
        "stickslip.distributed.sweep(base, {'/contact/friction': [0.1]}, '/steps/0/force', on=1, to='x')",
    ),
    ("SurfaceTopography", "scans", "ss.read_scan('noise.bin')"),
]


def test_numpy_alone_is_enough_and_what_is_missing_names_its_extra(tmp_path: Path) -> None:
    (tmp_path / "noise.bin").write_bytes(bytes(range(256)))
    program = textwrap.dedent("""
        import sys
        for name in ("pandas", "matplotlib", "httpx", "pint", "pyarrow", "SurfaceTopography", "fsspec", "dask", "ray"):
            sys.modules[name] = None
        import warnings
        warnings.simplefilter("ignore")
        import numpy as np
        import stickslip as ss
        import stickslip.distributed
        steel = ss.Body("210 GPa", 0.3)
        contact = ss.Contact(ss.Sphere("10 mm"), [steel, ss.RIGID], 0.3, normal_force="10 N")
        base = {"contact": contact, "path": {"displacement": [1e-8]}}
        print(contact.path([5e-8, -5e-8]).force.shape, contact.fretting(1e-8, crossland={"alpha": 0.3}).worst)
        assert "<table>" in contact.state._repr_html_()
        print(len(contact.cycle(np.geomspace(1e-9, 1e-7, 3))), contact.residual())
        for line in LINES:
            try:
                exec(line)
                print("nothing was missing")
            except (ImportError, ss.InvalidInput) as error:
                print(str(error).splitlines()[-1])
    """).replace("LINES", repr([line for *_, line in EXTRAS]))
    command = [sys.executable, "-c", program]
    done = subprocess.run(command, capture_output=True, text=True, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    first, second, *missing = done.stdout.splitlines()
    assert first == "(2,) crossland"
    assert second.startswith("3 Residual(")
    for (_, extra, line), text in zip(EXTRAS, missing, strict=True):
        assert f'pip install "stickslip[{extra}]"' in text, (line, text)


def test_metadata_name_extras_authors_and_links() -> None:
    tomllib = pytest.importorskip("tomllib")
    project = tomllib.loads((ROOT / "python" / "pyproject.toml").read_text())["project"]
    assert [re.split(r"[<>=]", one)[0] for one in project["dependencies"]] == ["numpy"]
    extras = project["optional-dependencies"]
    wanted = {"pandas", "plot", "client", "units", "arrow", "scans", "dask", "ray"}
    assert wanted | {"all"} <= set(extras)
    assert set(re.findall(r"\w+", extras["all"][0])) - {"stickslip"} == wanted
    assert {extra for _, extra, _ in EXTRAS} <= wanted
    assert project["urls"]
    assert project["authors"]
    assert any(one.startswith("Programming Language :: Python :: 3.1") for one in project["classifiers"])
