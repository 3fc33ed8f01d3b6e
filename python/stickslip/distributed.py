"""Sweeps beyond one machine, on Dask or Ray: chunks as pure tasks, the table as a Parquet dataset."""

from __future__ import annotations

import json
import posixpath
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _native, results
from .contact import encoded, guarded
from .engine import answer, request_of
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
        """A row for each point, in their order: the numbers that change, then the outputs."""
        frame: pandas.DataFrame = needed("pyarrow", "dask").concat_tables(self._tables()).to_pandas()
        return frame

    def answer(self) -> results.SweepReply | results.UncertaintyReply:
        """What `stickslip.sweep` returns for the request, to the last bit: of `inputs`, how sure the outputs are."""
        files, folder = _folder(self.url)
        with files.open(posixpath.join(folder, "sweep.json")) as file:
            request = json.load(file)["request"]
        plan, tables = guarded(_native.Sweep, encoded(request)), self._tables()
        columns = plan.columns[-len(request["outputs"]) :]
        rows = [np.column_stack([table[name].to_numpy() for name in columns]) for table in tables]
        lost = [failure for table in tables for failure in json.loads(table.schema.metadata[b"failures"])]
        data = guarded(plan.answer, np.concatenate(rows).tobytes(), self.failed, json.dumps(lost), "columns")
        return answer(results.SweepReply, json.loads(data), None, request)

    def _tables(self) -> list[Any]:
        """The tables of the chunks, in the order of their points."""
        needed("pyarrow.parquet", "dask")
        files, folder = _folder(self.url)
        tables = []
        for name in sorted(files.glob(posixpath.join(folder, "points-*.parquet"))):
            with files.open(name) as file:
                tables.append(needed("pyarrow", "dask").parquet.read_table(file))
        return tables


def sweep(
    base: Mapping[str, Any],
    axes: Any = None,
    outputs: Any = None,
    *,
    inputs: Any = None,
    samples: int | None = None,
    seed: int | None = None,
    on: Any,
    to: str,
    points_per_task: int | None = None,
) -> SweepDataset:
    """Computes a sweep on a cluster into the folder `to`, any URL that fsspec writes to and the workers reach.

    `on` is a client of Dask, or the module `ray`. What describes the sweep is as in `stickslip.sweep`, and so are the
    rows and the answer, to the last bit. A chunk whose worker dies is computed by another. Chunks that exist are
    skipped, so that an interrupted sweep continues when the function is called again. A folder of another sweep is
    refused. An exception or an interrupt cancels the tasks.
    """
    members = {"base": base, "axes": axes, "inputs": inputs, "outputs": outputs, "samples": samples, "seed": seed}
    request = encoded(request_of("/sweep", members, {}))
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
    pyarrow = needed("pyarrow", "dask")
    needed("pyarrow.parquet", "dask")
    files, folder = _folder(to)
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


def _folder(url: str) -> tuple[Any, str]:
    """The file system of a URL, and the path in it."""
    found: tuple[Any, str] = needed("fsspec", "dask").core.url_to_fs(url)
    return found


def _claim(to: str, request: bytes, size: int) -> None:
    """Writes the request into the folder, or compares it with the one that is there."""
    files, folder = _folder(to)
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
