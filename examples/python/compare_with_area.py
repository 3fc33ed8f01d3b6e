"""A soft ball that is sheared at constant load, from its contact area to its force, beside what was measured.

python compare_with_area.py [FILE]     # columns displacement_um, force_n, area_mm2

Hertz gives the modulus from the area at rest, the peak of the force over the area there is the strength; nothing else
is taken from the file, and the area stays. Without a file the columns are synthetic, by the closed form of a strength.
"""

import sys

import numpy as np
import pandas

import stickslip as ss

LOAD, RADIUS, NU = 1.0, 9.42e-3, 0.5  # of the bench, N, m


def synthetic(area: float = 8.0, strength: float = 3e5, noise: float = 0.01) -> pandas.DataFrame:
    """The force of a slip that begins at the edge, with noise over its largest."""
    a = np.sqrt(area * 1e-6 / np.pi)
    g_star = 3 * LOAD * RADIUS / (4 * a**3) * 2 * (1 - NU) / (2 - NU)
    turn = np.pi / 2 * np.linspace(0.02, 1.0, 40)
    force = 2 * strength * a**2 * (turn + np.sin(2 * turn) / 2)
    force += noise * force[-1] * np.random.default_rng(1).standard_normal(40)
    u = 2 * strength * a / g_star * np.sin(turn)
    return pandas.DataFrame({"displacement_um": 1e6 * u, "force_n": force, "area_mm2": area})


def main(file: str | None = None) -> pandas.DataFrame:
    """Strength, Pa, and how far the computed force is from the measured one up to the peak."""
    table = pandas.read_csv(file) if file else synthetic()
    table = table.loc[: table["force_n"].idxmax()]
    e_star = 3 * LOAD * RADIUS / (4 * (table["area_mm2"].iloc[0] * 1e-6 / np.pi) ** 1.5)
    strength = table["force_n"].iloc[-1] / (table["area_mm2"].iloc[-1] * 1e-6)
    moduli = ss.Moduli(e_star, e_star * 2 * (1 - NU) / (2 - NU))
    ball = ss.Contact(ss.Sphere(RADIUS), moduli, friction=0.0, normal_force=LOAD, shear_strength=strength)
    force = ball.path(1e-6 * table["displacement_um"].to_numpy()).force
    rest = float(np.std(force - table["force_n"]) / np.ptp(table["force_n"]))
    return pandas.DataFrame({"strength": [strength], "relative_rms": [rest]})


if __name__ == "__main__":
    print(main(*sys.argv[1:2]).to_string(index=False))
