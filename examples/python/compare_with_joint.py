"""Stiffness and loss factor of a joint over its amplitude, beside what was measured.

python compare_with_joint.py [FILE]     # columns amplitude_um, stiffness_n_per_um, loss_factor

Nothing is fitted: profile, load and friction of the joint, measured apart, stand below. Without a file the columns are
synthetic, by the closed forms of Mindlin and Deresiewicz.
"""

import sys

import numpy as np
import pandas

import stickslip as ss

STEEL = ss.Body("210 GPa", 0.3)
JOINT = {"profile": ss.Sphere("20 mm"), "bodies": [STEEL, STEEL], "friction": 0.2, "normal_force": "1 kN"}
COLUMNS = ["stiffness_n_per_um", "loss_factor"]


def synthetic(noise: float = 0.01) -> pandas.DataFrame:
    """Partial slip of the ball: F = mu F_N (1 - (1 - u)^(3/2)), and the work of a cycle, with noise over the largest."""
    radius = (3 * 1000 * 0.02 * 1.82 / (4 * 210e9)) ** (1 / 3)
    gross_slip, u = 3 * 0.2 * 1000 * 2.21 / (4 * 210e9 * radius), np.linspace(0.05, 0.95, 60)
    force, loading = 1 - (1 - u) ** 1.5, u - (1 - (1 - u) ** 2.5) / 2.5
    work = 8 * loading - 4 * u * force
    table = pandas.DataFrame({"amplitude_um": 1e6 * gross_slip * u})
    table["stiffness_n_per_um"] = 200 * force / table["amplitude_um"]
    table["loss_factor"] = work / (2 * np.pi * (loading - work / 4))
    for seed, column in enumerate(COLUMNS):
        table[column] += noise * np.ptp(table[column]) * np.random.default_rng(seed).standard_normal(60)
    return table


def main(file: str | None = None) -> pandas.DataFrame:
    """How far each column is from the measured one, over its range."""
    table = pandas.read_csv(file) if file else synthetic()
    found = ss.Contact(**JOINT).cycle(displacement=1e-6 * table["amplitude_um"].to_numpy()).to_frame()
    computed = (1e-6 * found["secant_stiffness"], found["loss_factor"])
    rests = [np.std(one - table[column]) / np.ptp(table[column]) for one, column in zip(computed, COLUMNS, strict=True)]
    return pandas.DataFrame({"column": COLUMNS, "relative_rms": rests})


if __name__ == "__main__":
    print(main(*sys.argv[1:2]).to_string(index=False))
