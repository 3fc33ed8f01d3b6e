"""Cost and error of contact laws over arrays: `python tools/cost.py [CONTACTS [FIGURE]]`.

It prints the table of docs/python.md, and draws its figure as SVG if there is a path for it.

The same path for each of the contacts: back and forth at a constant and then at a changing load. The exact law in steps
a seventh as long is the reference, because a straight step leaves the same state however it is divided; springs are
those of the method of dimensionality reduction in NumPy; the incremental law is "mindlin" as LAMMPS documents it, an
elastic force 2 G* a xi, whose elongation xi is cut where the force exceeds friction.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

import stickslip as ss

RADIUS, FRICTION, DEPTH = 0.01, 0.3, 1e-6
MODULI = ss.Moduli(1.15e11, 8.5e10)
E_STAR, G_STAR = 1.15e11, 8.5e10
SCALE = FRICTION * E_STAR / G_STAR
#: Steps of a cycle.
STEPS = 20
Array = NDArray[np.float64]
Law = Callable[[float, float], float]


def divided(way: list[tuple[float, float]], parts: int) -> list[tuple[float, float]]:
    """The same path, each of its steps in so many."""
    ends = [np.array((DEPTH, 0.0)), *map(np.array, way)]
    shares = np.arange(1, parts + 1) / parts
    return [tuple(begin + share * (end - begin)) for begin, end in pairwise(ends) for share in shares]


def draw(rows: list[tuple[str, float, float]], count: int, target: str) -> None:
    """Errors over the times of a step, ms."""
    import matplotlib

    matplotlib.use("svg")
    matplotlib.rcParams["svg.hashsalt"] = "stickslip"
    from matplotlib import pyplot

    figure, ax = pyplot.subplots(figsize=(6.4, 3.6), layout="constrained")
    for name, milliseconds, error in rows:
        (mark,) = ax.loglog(milliseconds, error, "o")
        left = milliseconds > 30.0
        ax.annotate(
            name,
            (milliseconds, error),
            xytext=(-8 if left else 8, 12 if name.endswith("1 thread") else 0),
            textcoords="offset points",
            ha="right" if left else "left",
            va="center",
            color=mark.get_color(),
        )
    ax.set(xlabel=f"a step of {count} contacts, ms", ylabel="largest error of F$_x$ over µ F$_N$", ylim=(1e-17, 10.0))
    ax.grid(which="major", alpha=0.3)
    figure.savefig(target, metadata={"Date": None})


def path(steps: int) -> list[tuple[float, float]]:
    """Indentations and displacements, m: a cycle at a constant load, and one in which it changes."""
    phase = np.linspace(0.0, 4.0 * np.pi, 2 * steps + 1)[1:]
    depth = DEPTH * np.where(phase > 2.0 * np.pi, 1.0 + 0.3 * np.sin(2.0 * phase), 1.0)
    return list(zip(depth.tolist(), (0.7 * SCALE * DEPTH * np.sin(phase)).tolist(), strict=True))


class Exact:
    def __init__(self, count: int, threads: int):
        self.contacts = ss.Contacts(count, ss.Sphere(RADIUS), MODULI, FRICTION, threads=threads)

    def __call__(self, depth: float, displacement: float) -> float:
        return float(self.contacts.step(depth, displacement)[1][0])


class Springs:
    """Springs at the middles of equal intervals of x, whose deflections are cut where they slip."""

    def __init__(self, count: int, springs: int):
        reach = np.sqrt(1.4 * DEPTH * RADIUS)
        self.x = (np.arange(springs) + 0.5) * reach / springs
        self.width = reach / springs
        self.deflection = np.zeros((count, springs))
        self.before = 0.0

    def __call__(self, depth: float, displacement: float) -> float:
        bound = np.maximum(depth - self.x**2 / RADIUS, 0.0)
        self.deflection += (displacement - self.before) / SCALE
        np.clip(self.deflection, -bound, bound, out=self.deflection)
        self.before = displacement
        return float((2.0 * G_STAR * SCALE * self.width * self.deflection.sum(axis=1))[0])


class Incremental:
    """The elongation of one spring as stiff as the contact that sticks."""

    def __init__(self, count: int):
        self.elongation = np.zeros(count)
        self.before = 0.0

    def __call__(self, depth: float, displacement: float) -> float:
        radius = np.sqrt(RADIUS * depth)
        bound = FRICTION * 4.0 / 3.0 * E_STAR * radius * depth
        stiffness = 2.0 * G_STAR * radius
        self.elongation += displacement - self.before
        np.clip(self.elongation, -bound / stiffness, bound / stiffness, out=self.elongation)
        self.before = displacement
        return float((stiffness * self.elongation)[0])


def measure(law: Law, way: list[tuple[float, float]]) -> tuple[Array, float]:
    """Forces along a path, N, and the median time of a step, s."""
    law(DEPTH, 0.0)
    forces, times = [], []
    for depth, displacement in way:
        begin = time.perf_counter()
        forces.append(law(depth, displacement))
        times.append(time.perf_counter() - begin)
    return np.array(forces), float(np.median(times))


def main() -> int:
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 100_000
    way = path(STEPS)
    laws: list[tuple[str, Law]] = [
        ("exact, 1 thread", Exact(count, 1)),
        ("exact, 2 threads", Exact(count, 2)),
        ("20 springs, NumPy", Springs(count, 20)),
        ("100 springs, NumPy", Springs(count, 100)),
        ("incremental Mindlin, NumPy", Incremental(count)),
    ]
    limit = FRICTION * 4.0 / 3.0 * E_STAR * np.sqrt(RADIUS) * DEPTH**1.5
    exact = measure(Exact(1, 1), divided(way, 7))[0][6::7]
    rows = []
    print(f"| law | {count} contacts, ms a step | error at a constant load | at a changing load |")
    print("|---|---|---|---|")
    for name, law in laws:
        forces, seconds = measure(law, way)
        error = np.abs(forces - exact) / limit
        constant, changing = error[: len(way) // 2].max(), error[len(way) // 2 :].max()
        rows.append((name, 1e3 * seconds, float(max(constant, changing))))
        print(f"| {name} | {1e3 * seconds:.1f} | {constant:.2g} | {changing:.2g} |")
    if len(sys.argv) > 2:
        draw(rows, count, sys.argv[2])
    one = Exact(1, 1)
    seconds = measure(one, way * 50)[1]
    print(f"\nA step of one contact takes {1e6 * seconds:.1f} us.")
    return 0


if __name__ == "__main__":
    sys.exit(main())
