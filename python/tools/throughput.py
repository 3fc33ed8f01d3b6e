"""Points a second of one sweep by engine: `python tools/throughput.py [POINTS]` prints a table of docs/python.md.

All compute the same points, in turn in each round, so that a busy machine slows them alike; ratios are medians of the
rounds. Workers have one thread each. The time has everything but the start of the cluster: planning, tasks, files.
"""

from __future__ import annotations

import statistics
import sys
import tempfile
import time
from collections.abc import Callable
from functools import partial
from typing import Any

import ray
from distributed import Client, LocalCluster

import stickslip as ss
from stickslip import distributed

ROUNDS = 3
BASE: dict[str, Any] = {
    "contact": ss.Definition(ss.Sphere("10 mm"), ss.Moduli(1.15e11, 8.5e10), 0.3, normal_force="10 N"),
    "path": {"falling_amplitude": {"reversals": 20}},
    "residual": True,
}
OUTPUTS = {"remaining": "/residual/relative", "peak": "/residual/max"}


def axes(points: int) -> list[dict[str, Any]]:
    """Friction by normal force, with so many points together."""
    return [
        {"pointer": "/contact/friction", "linear": {"from": 0.1, "to": 1.0, "count": 10}},
        {"pointer": "/contact/preload/normal_force", "logarithmic": {"from": 1, "to": 1000, "count": points // 10}},
    ]


def spread(points: int, on: Any, workers: int) -> None:
    """A sweep in four tasks a worker."""
    with tempfile.TemporaryDirectory() as folder:
        size = -(-points // (4 * workers))
        distributed.sweep(BASE, axes(points), OUTPUTS, on=on, to=folder, points_per_task=size)


def main() -> int:
    points = int(sys.argv[1]) if len(sys.argv) > 1 else 40_000
    rates: dict[str, list[float]] = {}

    def measure(name: str, run: Callable[[], object]) -> None:
        begin = time.perf_counter()
        run()
        rates.setdefault(name, []).append(points / (time.perf_counter() - begin))

    for _ in range(ROUNDS):
        with ss.serve() as api:
            measure("`/sweep`, one machine", partial(api.sweep, BASE, axes(points), OUTPUTS))
        measure("`ss.sweep`, in process", partial(ss.sweep, BASE, axes(points), OUTPUTS))
        for workers in (1, 2):
            with (
                LocalCluster(n_workers=workers, threads_per_worker=1, dashboard_address=None) as cluster,
                Client(cluster) as client,
            ):
                measure(f"Dask, workers: {workers}", partial(spread, points, client, workers))
            ray.init(num_cpus=workers, include_dashboard=False, log_to_driver=False)
            ray.get(ray.remote(lambda: None).remote())
            measure(f"Ray, workers: {workers}", partial(spread, points, ray, workers))
            ray.shutdown()
    print(f"| {points} points | points a second | ratio to `/sweep` |\n|---|---|---|")
    first = next(iter(rates.values()))
    for name, own in rates.items():
        ratio = statistics.median(one / other for one, other in zip(own, first, strict=True))
        print(f"| {name} | {statistics.median(own):.0f} | {ratio:.2f} |")
    return 0


if __name__ == "__main__":
    sys.exit(main())
