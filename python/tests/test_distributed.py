"""Sweeps on clusters of two processes: the same rows and answers as in one, whatever happens to a worker."""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip import distributed

BASE: dict[str, Any] = {
    "contact": ss.Definition(ss.Sphere("10 mm"), ss.Moduli(1.15e11, 8.5e10), 0.3, normal_force="10 N"),
    "path": {"falling_amplitude": {"reversals": 60}},
    "residual": True,
}
AXES = [
    {"pointer": "/contact/friction", "linear": {"from": 0.1, "to": 1.0, "count": 7}},
    {"pointer": "/contact/preload/normal_force", "logarithmic": {"from": 1.0, "to": 1000.0, "count": 100}},
]
OUTPUTS = {"remaining": "/residual/relative", "peak": "/residual/max"}

#: A cluster, and the process of one of its workers.
Cluster = tuple[Any, Callable[[], int | None]]

pytestmark = pytest.mark.filterwarnings("ignore")


@contextmanager
def dask_cluster() -> Iterator[Cluster]:
    dask = pytest.importorskip("distributed")
    with (
        dask.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None, protocol="tcp") as cluster,
        dask.Client(cluster) as client,
    ):
        victim = next(iter(client.run(os.getpid).values()))
        yield client, lambda: victim


@contextmanager
def ray_cluster() -> Iterator[Cluster]:
    ray = pytest.importorskip("ray")

    def at_work() -> int | None:
        for title in Path("/proc").glob("[0-9]*/cmdline"):
            # A process may end between one look and the next.
            with suppress(OSError):
                if title.read_bytes().startswith(b"ray::compute_chunk"):
                    return int(title.parent.name)
        return None

    ray.init(num_cpus=2, include_dashboard=False, log_to_driver=False)
    try:
        yield ray, at_work
    finally:
        ray.shutdown()


@pytest.fixture(scope="module", params=[dask_cluster, ray_cluster])
def started(request: pytest.FixtureRequest) -> Iterator[Cluster]:
    with request.param() as cluster:
        yield cluster


def test_rows_are_those_of_one_process_after_a_worker_was_killed(started: Cluster, tmp_path: Path) -> None:
    cluster, worker = started
    whole = ss.sweep(BASE, AXES, OUTPUTS).to_frame()
    to = tmp_path.as_uri()
    files = lambda: list(tmp_path.glob("points-*.parquet"))  # noqa: E731
    over = threading.Event()
    killed = []

    def kill() -> None:
        while not over.is_set() and not killed:
            if files() and (victim := worker()):
                os.kill(victim, signal.SIGKILL)
                killed.append(victim)
            over.wait(0.005)

    killer = threading.Thread(target=kill)
    killer.start()
    found = distributed.sweep(BASE, AXES, OUTPUTS, on=cluster, to=to, points_per_task=25)
    over.set()
    killer.join()
    assert killed
    assert (found.points, found.failed) == (700, 0)
    frame = found.to_frame()
    assert list(frame.columns) == list(whole.columns)
    assert np.array_equal(frame.to_numpy(), whole.to_numpy())
    assert found.answer().reply_document() == ss.sweep(BASE, AXES, OUTPUTS).reply_document()
    # What exists is not computed again, and what was lost is.
    kept = sorted(files())[1:]
    times = [one.stat().st_mtime_ns for one in kept]
    sorted(files())[0].unlink()
    again = distributed.sweep(BASE, AXES, OUTPUTS, on=cluster, to=to, points_per_task=25)
    assert np.array_equal(again.to_frame().to_numpy(), whole.to_numpy())
    assert [one.stat().st_mtime_ns for one in kept] == times
    with pytest.raises(ValueError):
        distributed.sweep(BASE, AXES[:1], OUTPUTS, on=cluster, to=to, points_per_task=25)


def test_uncertain_inputs_have_the_answer_of_one_process_and_of_a_server(
    started: Cluster, tmp_path: Path, api: ss.Client
) -> None:
    # Far below zero the coefficient of friction is out of its range: some points fail, in several chunks.
    inputs = {
        "/contact/friction": {"normal": {"mean": 0.3, "standard_uncertainty": 0.15}},
        "/contact/preload/normal_force": {"uniform": {"from": 9.0, "to": 11.0}},
    }
    described: Any = {"inputs": inputs, "outputs": OUTPUTS, "samples": 300, "seed": 7}
    here, there = ss.sweep(BASE, **described), api.sweep(BASE, **described)
    # Short forms of a path, an axis and an output.
    short: Any = {"axes": {"/contact/friction": [0.1, 0.2]}, "outputs": "/steps/1/force"}
    moved = {"contact": BASE["contact"], "path": ["0.1 um", "-0.1 um"]}
    assert here.failed > 5
    assert here.outputs[0].shares["/contact/friction"].value is not None
    cluster, _ = started
    found = distributed.sweep(BASE, **described, on=cluster, to=tmp_path.as_uri(), points_per_task=170)
    table = distributed.sweep(moved, **short, on=cluster, to=(tmp_path / "short").as_uri())
    assert table.answer().reply_document() == ss.sweep(moved, **short).reply_document()
    answer = found.answer()
    assert isinstance(answer, ss.results.UncertaintyReply)
    assert (found.points, found.failed) == (here.points, here.failed)
    assert repr(answer.reply_document()) == repr(here.reply_document()) == repr(there.reply_document())
    assert len(found.to_frame()) == here.points
    next(tmp_path.glob("points-*.parquet")).unlink()
    with pytest.raises(ValueError, match="of 1200 points"):
        found.answer()
