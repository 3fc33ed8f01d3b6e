"""Sweeps beyond one machine, on Dask or Ray: chunks as pure tasks, the table as a Parquet dataset."""

from __future__ import annotations

import json
import posixpath
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _native, requests
from .contact import encoded, guarded
from .documents import to_document
from .optional import needed

if TYPE_CHECKING:
    import pandas

#: The most points of a task.
MOST_POINTS = 1_000_000
#: Work of a task, s, as far as it can be estimated.
SECONDS = 5

#: The request, the first point, the one after the last, and the folder.
Task = tuple[bytes, int, int, str]


@dataclass(frozen=True)
class SweepDataset:
    """The table of a sweep in a folder: a Parquet file for each chunk, whose names are in the order of the points."""

    url: str
    points: int
    failed: int

    def to_frame(self) -> pandas.DataFrame:
        """The whole table, in the order of the points."""
        fsspec, module = needed("fsspec", "dask"), needed("pandas", "pandas")
        files, folder = fsspec.core.url_to_fs(self.url)
        names = sorted(files.glob(posixpath.join(folder, "points-*.parquet")))
        with_handles = [module.read_parquet(files.open(name)) for name in names]
        frame: pandas.DataFrame = module.concat(with_handles, ignore_index=True)
        return frame


def sweep(
    base: Mapping[str, Any], axes: Any, outputs: Any, *, on: Any, to: str, points_per_task: int | None = None
) -> SweepDataset:
    """Computes a sweep on a cluster into the folder `to`, any URL that fsspec writes to and the workers reach.

    `on` is a client of Dask, or the module `ray`. The rows are those of `stickslip.sweep` to the last bit. A chunk
    whose worker dies is computed by another. Chunks that exist are skipped, so that an interrupted sweep continues when
    the function is called again. A folder of another sweep is refused. An exception or an interrupt cancels the tasks.
    """
    base = dict(base)
    if "contact" in base:
        base["contact"] = requests.definition(base["contact"])
    request = encoded(to_document({"base": base, "axes": requests.axes(axes), "outputs": requests.outputs(outputs)}))
    plan = guarded(_native.Sweep, request)
    size = points_per_task or min(SECONDS * plan.chunk, MOST_POINTS)
    _claim(to, request, size)
    spans = [(first, min(first + size, plan.points)) for first in range(0, plan.points, size)]
    tasks = [(request, first, end, to) for first, end in spans]
    return SweepDataset(to, plan.points, sum(_dask(on, tasks) if hasattr(on, "submit") else _ray(on, tasks)))


def _dask(client: Any, tasks: list[Task]) -> list[int]:
    futures = [client.submit(compute_chunk, *task, pure=True) for task in tasks]
    try:
        failed: list[int] = client.gather(futures)
    except BaseException:
        client.cancel(futures)
        raise
    return failed


def _ray(ray: Any, tasks: list[Task]) -> list[int]:
    remote = ray.remote(compute_chunk)
    futures = [remote.remote(*task) for task in tasks]
    try:
        failed: list[int] = ray.get(futures)
    except BaseException:
        for future in futures:
            ray.cancel(future, force=True)
        raise
    return failed


def compute_chunk(request: bytes, first: int, end: int, to: str) -> int:
    """Computes the points from `first` up to `end` into their file, unless it exists; returns how many failed."""
    fsspec, pyarrow = needed("fsspec", "dask"), needed("pyarrow", "dask")
    needed("pyarrow.parquet", "dask")
    files, folder = fsspec.core.url_to_fs(to)
    path = posixpath.join(folder, f"points-{first:012}-{end:012}.parquet")
    if files.exists(path):
        with files.open(path) as file:
            return int(pyarrow.parquet.read_schema(file).metadata[b"failed"])
    plan = guarded(_native.Sweep, request)
    data, failed, failures = guarded(plan.rows, first, end, 1)
    numbers = np.frombuffer(data, dtype=np.float64).reshape(end - first, -1)
    table = pyarrow.table({name: numbers[:, index] for index, name in enumerate(plan.columns)})
    table = table.replace_schema_metadata({"failed": str(failed), "failures": failures})
    # Under another name until it is whole, so that a worker that dies leaves no half of a file.
    unfinished = f"{path}.{np.random.default_rng().integers(1 << 62)}.part"
    with files.open(unfinished, "wb") as file:
        pyarrow.parquet.write_table(table, file)
    files.mv(unfinished, path)
    return int(failed)


def _claim(to: str, request: bytes, size: int) -> None:
    """Writes the request into the folder, or compares it with the one that is there."""
    files, folder = needed("fsspec", "dask").core.url_to_fs(to)
    files.makedirs(folder, exist_ok=True)
    path = posixpath.join(folder, "sweep.json")
    own = {"request": json.loads(request), "points_per_task": size}
    if not files.exists(path):
        with files.open(path, "w") as file:
            json.dump(own, file)
        return
    with files.open(path) as file:
        if json.load(file) != own:
            raise ValueError(f"{to} has the chunks of another sweep, or of another size: give another folder")
