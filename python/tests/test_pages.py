"""The Python of the pages runs as printed, with the results that they show. `UPDATE=1` writes these anew."""

from __future__ import annotations

import contextlib
import io
import os
import re
import shutil
from pathlib import Path
from typing import Any

import pytest

from conftest import ROOT

#: A block of Python, and the output below it.
BLOCK = re.compile(r"^```python\n(.*?)^```\n(?:\n+^```output\n(.*?)^```\n)?", re.MULTILINE | re.DOTALL)
NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?")
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]


def alike(shown: str, printed: str) -> bool:
    """Whether two texts differ by the rounding of numbers at most."""
    numbers = [[float(number) for number in NUMBER.findall(text)] for text in (shown, printed)]
    return NUMBER.sub("#", shown) == NUMBER.sub("#", printed) and numbers[1] == pytest.approx(numbers[0], rel=1e-6)


@pytest.mark.filterwarnings("ignore::stickslip.StickslipWarning")
@pytest.mark.parametrize("page", [page for page in PAGES if BLOCK.search(page.read_text())], ids=lambda page: page.stem)
def test_page_prints_and_draws_what_it_shows(page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    monkeypatch.chdir(tmp_path)
    text, names = page.read_text(), dict[str, Any]()
    for match in BLOCK.finditer(page.read_text()):
        program, output = match.groups()
        # A remark in the first line names another package, whose files are not here.
        if program.startswith("#"):
            continue
        with contextlib.redirect_stdout(io.StringIO()) as printed:
            exec(program, names)
        if output is None:
            continue
        if "UPDATE" in os.environ:
            text = text.replace(match[0], match[0].replace(f"```output\n{output}", f"```output\n{printed.getvalue()}"))
        else:
            assert alike(output, printed.getvalue()), f"{page.name} shows\n{output}\nfor\n{printed.getvalue()}"
    if "UPDATE" in os.environ:
        page.write_text(text)
    for drawn in tmp_path.glob("*.png"):
        shown = re.search(rf"\]\(([\w/.]*\b{re.escape(drawn.name)})\)", text)
        assert shown is not None, f"{page.name} does not show {drawn.name}"
        if "UPDATE" in os.environ:
            shutil.copy(drawn, page.parent / shown[1])
        # The letters and lines of a picture depend on the version of Matplotlib.
        assert (page.parent / shown[1]).stat().st_size > 1000
