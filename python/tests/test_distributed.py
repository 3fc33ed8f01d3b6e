"""Sweeps on a cluster of two processes: the same rows as in one, whatever happens to a worker."""

from __future__ import annotations

import os
import signal
import threading
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import stickslip as ss

dask = pytest.importorskip("distributed")
from stickslip import distributed  # noqa: E402

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

pytestmark = pytest.mark.filterwarnings("ignore")


def test_rows_are_those_of_one_process_after_a_worker_was_killed(tmp_path: Path) -> None:
    whole = ss.sweep(BASE, AXES, OUTPUTS).to_frame()
    with (
        dask.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None, protocol="tcp") as cluster,
        dask.Client(cluster) as client,
    ):
        victim = next(iter(client.run(os.getpid).values()))
        files = lambda: list(tmp_path.glob("points-*.parquet"))  # noqa: E731

        def kill() -> None:
            while not files():
                time.sleep(0.01)
            os.kill(victim, signal.SIGKILL)

        killer = threading.Thread(target=kill)
        killer.start()
        found = distributed.sweep(BASE, AXES, OUTPUTS, on=client, to=str(tmp_path), points_per_task=25)
        killer.join()
        assert (found.points, found.failed) == (700, 0)
        frame = found.to_frame()
        assert list(frame.columns) == list(whole.columns)
        assert np.array_equal(frame.to_numpy(), whole.to_numpy())
        # What exists is not computed again, and what was lost is.
        kept = sorted(files())[1:]
        times = [one.stat().st_mtime_ns for one in kept]
        sorted(files())[0].unlink()
        again = distributed.sweep(BASE, AXES, OUTPUTS, on=client, to=str(tmp_path), points_per_task=25)
        assert np.array_equal(again.to_frame().to_numpy(), whole.to_numpy())
        assert [one.stat().st_mtime_ns for one in kept] == times
        with pytest.raises(ValueError):
            distributed.sweep(BASE, AXES[:1], OUTPUTS, on=client, to=str(tmp_path), points_per_task=25)
