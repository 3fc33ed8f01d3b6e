"""Writes ball_loop.csv: three cycles of a steel ball on a steel plane as a fretting rig records them, with a fixed seed.

The ball has a radius of 10 mm, the load is 10 N, the coefficient of friction 0.42. The rig drives the far end of a load cell and its
holder: together they give 50 nm/N. The zero of the force is 0.15 N off; force and displacement have noise. The loop is steady
(Mindlin & Deresiewicz 1953: a branch is the first loading, doubled), so no solver is needed.
"""

import math
import random
from pathlib import Path

RADIUS, LOAD, FRICTION = 10e-3, 10.0, 0.42
YOUNGS_MODULUS, POISSON_RATIO = 2.1e11, 0.3
COMPLIANCE, AMPLITUDE, FORCE_OFFSET = 5e-8, 0.8e-6, 0.15
POINTS, CYCLES, FORCE_NOISE, DISPLACEMENT_NOISE = 250, 3, 0.03, 0.5e-9

E_STAR = YOUNGS_MODULUS / (1 - POISSON_RATIO**2) / 2
G_STAR = YOUNGS_MODULUS / (1 + POISSON_RATIO) / (2 - POISSON_RATIO)
INDENTATION = (3 * LOAD / (4 * E_STAR * RADIUS**0.5)) ** (2 / 3)
GROSS_SLIP = FRICTION * E_STAR / G_STAR * INDENTATION


def first_loading(displacement: float) -> float:
    """The force of a contact that was never moved (Cattaneo 1938), N."""
    return FRICTION * LOAD * (1 - max(0.0, 1 - displacement / GROSS_SLIP) ** 1.5)


def through_machine(displacement: float) -> float:
    """The same over the displacement of the rig, by bisection."""
    low, high = 0.0, displacement
    for _ in range(100):
        middle = 0.5 * (low + high)
        if middle + COMPLIANCE * first_loading(middle) < displacement:
            low = middle
        else:
            high = middle
    return first_loading(low)


draw = random.Random(8)
lines = ["# Fretting rig, steel ball on steel, 10 N", "Time (s);Displacement (um);Force (N)"]
for index in range(CYCLES * POINTS + 1):
    angle = 2 * math.pi * index / POINTS
    place = AMPLITUDE * math.cos(angle)
    # A branch begins at the last turn, and is twice the first loading of half the way since.
    falls = math.sin(angle) > 0
    since = (AMPLITUDE - place) / 2 if falls else (AMPLITUDE + place) / 2
    turned = through_machine(AMPLITUDE)
    force = turned - 2 * through_machine(since) if falls else -turned + 2 * through_machine(since)
    place += DISPLACEMENT_NOISE * draw.gauss(0, 1)
    force += FORCE_OFFSET + FORCE_NOISE * draw.gauss(0, 1)
    lines.append(f"{index / POINTS:.3f};{place * 1e6:.4f};{force:.3f}".replace(".", ","))
Path(__file__).with_name("ball_loop.csv").write_text("\n".join(lines) + "\n")
