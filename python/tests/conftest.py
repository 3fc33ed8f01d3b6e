"""What the tests share: the document of the API, a contact, a server."""

from __future__ import annotations

import json
import signal
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import matplotlib.pyplot
import pytest

import stickslip as ss

matplotlib.use("Agg")
ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def openapi() -> dict[str, Any]:
    return json.loads((ROOT / "openapi" / "openapi.json").read_text())


@pytest.fixture(autouse=True)
def _close_figures() -> Iterator[None]:
    yield
    matplotlib.pyplot.close("all")


@pytest.fixture
def here() -> ss.Contact:
    """A ball in process."""
    return ss.Contact(ss.Sphere("10 mm"), [ss.Body("210 GPa", 0.3), ss.RIGID], friction=0.3, normal_force="10 N")


@pytest.fixture(params=["process", "server"])
def ball(request: pytest.FixtureRequest) -> Any:
    """A ball in process, and one on a server."""
    here = request.getfixturevalue("here")
    return here if request.param == "process" else request.getfixturevalue("api").Contact.from_definition(here)


@pytest.fixture(params=["process", "server"])
def engine(request: pytest.FixtureRequest) -> Any:
    """The module, and a client of a server: a notebook moves from one to the other by one line."""
    return ss if request.param == "process" else request.getfixturevalue("api")


@pytest.fixture(scope="session")
def api() -> Iterator[ss.Client]:
    with ss.serve() as server, ss.connect(server.url) as client:
        yield client


def heed_interrupts() -> None:
    """In a child: an interrupt reaches it, also where a shell runs the tests in its background and has them ignored."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
