"""The notebooks of the documentation run from their first cells to their last, with the numbers that it prints."""

from __future__ import annotations

import re
from typing import Any

import nbclient
import nbformat
import pytest

import stickslip as ss
from conftest import ROOT

FOLDER = ROOT / "docs" / "notebooks"


def executed(name: str) -> dict[str, Any]:
    """The outputs of the cells of a notebook, which keeps none itself."""
    notebook = nbformat.read(FOLDER / name, as_version=4)
    code = [cell for cell in notebook.cells if cell.cell_type == "code"]
    assert all(cell.outputs == [] and cell.execution_count is None for cell in code)
    run = nbclient.NotebookClient(
        notebook, timeout=600, kernel_name="python3", resources={"metadata": {"path": str(FOLDER)}}
    )
    run.execute()
    return {cell.id: cell.outputs for cell in code}


def text(outputs: Any) -> str:
    return "".join(one.get("text", "") + one.get("data", {}).get("text/plain", "") for one in outputs)


def assert_plotted(shown: dict[str, Any], *cells: str) -> None:
    for cell in cells:
        assert any("image/png" in output.get("data", {}) for output in shown[cell]), cell


@pytest.mark.filterwarnings("ignore")
def test_the_notebook_runs_and_keeps_no_results() -> None:
    shown = executed("first_contact.ipynb")
    assert_plotted(shown, "loop", "profile", "damping")
    steel = ss.Body("210 GPa", 0.3)
    # Hertz (1882).
    radius = (3.0 * 10.0 * 0.01 / (4.0 * 210e9 / (2.0 * (1.0 - 0.3**2)))) ** (1.0 / 3.0)
    ball = ss.Contact(ss.Sphere("10 mm"), [steel, steel], 0.3, normal_force="10 N")
    assert ball.summary.contact_radius == pytest.approx(radius, rel=1e-12)
    assert str(ball.summary.contact_radius) in shown["imports"][-1]["data"]["text/plain"]


@pytest.mark.filterwarnings("ignore")
def test_the_tutorial_leads_to_the_numbers_of_the_page() -> None:
    shown = executed("rig_to_crack.ipynb")
    assert_plotted(shown, "fit", "changes")
    page = (ROOT / "docs" / "python.md").read_text()
    said = re.search(r"\(([\d.]+), from ([\d.]+) to ([\d.]+)\).*?a margin of ([\d.]+)", page)
    assert said is not None
    value, _, low, high = re.search(r"friction +(\S+) +(\S+) +(\S+) +(\S+)", text(shown["friction"])).groups()  # type: ignore[union-attr]
    assert [f"{float(one):.4f}" for one in (value, low, high)] == list(said.groups()[:3])
    # What make_ball_loop.py has made the file of, within twice the interval.
    assert abs(float(value) - 0.42) < 2.0 * (float(high) - float(low))
    assert f"margin {said[4]} " in text(shown["crack"])
    changes = dict(re.findall(r"(\w[\w ]*?) {2,}([\d.]+)", text(shown["change"])))
    assert changes.pop("as it is") == said[4]
    assert len(changes) == 4
    for change, margin in changes.items():
        assert f"{change}: {margin}" in page, change


@pytest.mark.filterwarnings("ignore")
def test_the_strip_chart_follows_a_contact_to_the_end() -> None:
    shown = executed("strip_chart.ipynb")
    assert_plotted(shown, "chart")
    assert "60 states, up to 2.58 N" in text(shown["chart"])
