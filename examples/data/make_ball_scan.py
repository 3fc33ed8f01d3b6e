"""Writes ball_scan.txt: a line over a worn ball as an optical profiler exports it, with a fixed seed.

The ball has a radius of 10 mm and a worn flat of 30 um with a rounded rim. The stage is tilted by 0.4 mrad, the axis is 7 um off
the middle, heights have 4 nm of noise correlated over some points, one point in a hundred is a spike, one in fifty is missing.
"""

import random
from pathlib import Path

RADIUS, FLAT, RIM = 10e-3, 30e-6, 8e-6
POINTS, HALF, AXIS, TILT, NOISE = 601, 210e-6, 7e-6, 4e-4, 4e-9


def height(r: float) -> float:
    """The height of the gap at the distance r from the axis, m: the slope rises over the rim."""
    inner, outer = FLAT - RIM, FLAT + RIM
    over_rim = lambda r: max(r - inner, 0.0) ** 2 / (2 * RADIUS) * outer / (outer - inner)
    return over_rim(r) if r < outer else over_rim(outer) + (r * r - outer * outer) / (2 * RADIUS)


draw = random.Random(5)
white = [draw.gauss(0, 1) for _ in range(POINTS + 4)]
lines = ["# Line profile, worn ball", "Lateral (um);Height (nm)"]
for index in range(POINTS):
    x = HALF * (2 * index / (POINTS - 1) - 1)
    noise = NOISE * sum(white[index : index + 5]) / 5**0.5
    z = -height(abs(x - AXIS)) + TILT * x + noise + (draw.choice([-1, 1]) * 4e-7 if draw.random() < 0.01 else 0.0)
    text = "" if draw.random() < 0.02 else f"{z * 1e9:.2f}".replace(".", ",")
    lines.append(f"{x * 1e6:.3f};{text}".replace(".", ","))
Path(__file__).with_name("ball_scan.txt").write_text("\n".join(lines) + "\n")
