"""The notebook of the documentation runs from its first cell to its last, with what the service says of the same."""

from __future__ import annotations

from pathlib import Path

import nbclient
import nbformat
import pytest

import stickslip as ss

NOTEBOOK = Path(__file__).resolve().parents[2] / "docs" / "notebooks" / "first_contact.ipynb"


@pytest.mark.filterwarnings("ignore")
def test_the_notebook_runs_and_keeps_no_results() -> None:
    notebook = nbformat.read(NOTEBOOK, as_version=4)
    code = [cell for cell in notebook.cells if cell.cell_type == "code"]
    assert all(cell.outputs == [] and cell.execution_count is None for cell in code)
    nbclient.NotebookClient(notebook, timeout=600, kernel_name="python3").execute()
    shown = {cell.id: cell.outputs for cell in code}
    for plotted in ("loop", "profile", "damping"):
        assert any("image/png" in output.get("data", {}) for output in shown[plotted]), plotted
    steel = ss.Body("210 GPa", 0.3)
    # Hertz (1882).
    radius = (3.0 * 10.0 * 0.01 / (4.0 * 210e9 / (2.0 * (1.0 - 0.3**2)))) ** (1.0 / 3.0)
    ball = ss.Contact(ss.Sphere("10 mm"), [steel, steel], 0.3, normal_force="10 N")
    assert ball.summary.contact_radius == pytest.approx(radius, rel=1e-12)
    assert str(ball.summary.contact_radius) in shown["imports"][-1]["data"]["text/plain"]
