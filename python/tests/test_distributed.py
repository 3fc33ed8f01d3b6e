"""Sweeps on clusters of two processes: the same rows as in one, whatever happens to a worker."""

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


@pytest.mark.parametrize("start", [dask_cluster, ray_cluster])
def test_rows_are_those_of_one_process_after_a_worker_was_killed(start: Any, tmp_path: Path) -> None:
    whole = ss.sweep(BASE, AXES, OUTPUTS).to_frame()
    to = tmp_path.as_uri()
    with start() as (cluster, worker):
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
        # What exists is not computed again, and what was lost is.
        kept = sorted(files())[1:]
        times = [one.stat().st_mtime_ns for one in kept]
        sorted(files())[0].unlink()
        again = distributed.sweep(BASE, AXES, OUTPUTS, on=cluster, to=to, points_per_task=25)
        assert np.array_equal(again.to_frame().to_numpy(), whole.to_numpy())
        assert [one.stat().st_mtime_ns for one in kept] == times
        with pytest.raises(ValueError):
            distributed.sweep(BASE, AXES[:1], OUTPUTS, on=cluster, to=to, points_per_task=25)
