"""From a load curve to normal and tangential stiffness, beside what was measured.

python compare_with_stiffness.py [FILE]     # columns load_n, indentation_um, normal_n_per_um, tangential_n_per_um

Nothing is fitted: the curve gives the contact radius, the moduli both stiffnesses. Without a file the columns are
synthetic, of a ball by Hertz and Mindlin.
"""

import sys

import numpy as np
import pandas

import stickslip as ss

BODIES = [ss.Body("210 GPa", 0.3), ss.Body("210 GPa", 0.3)]
COLUMNS = ["normal_n_per_um", "tangential_n_per_um"]


def synthetic(noise: float = 0.01) -> pandas.DataFrame:
    """A ball of 10 mm of steel, with noise over the largest stiffness."""
    e_star, g_star, d = 210e9 / 1.82, 210e9 / 2.21, 2e-6 * np.linspace(0.02, 1.0, 60)
    table = pandas.DataFrame({"load_n": 4 / 3 * e_star * 0.1 * d**1.5, "indentation_um": 1e6 * d})
    for seed, (column, modulus) in enumerate(zip(COLUMNS, (e_star, g_star), strict=True)):
        table[column] = 2e-6 * modulus * np.sqrt(0.01 * d)
        table[column] += noise * table[column].max() * np.random.default_rng(seed).standard_normal(60)
    return table


def main(file: str | None = None) -> pandas.DataFrame:
    """How far each stiffness is from the measured one, and the measured ratio of the two beside G*/E*."""
    table = pandas.read_csv(file) if file else synthetic()
    depths, loads = (np.append(0.0, table[name]) for name in ("indentation_um", "load_n"))
    curve = ss.LoadCurve(indentation=1e-6 * depths, normal_force=loads)
    contacts = [ss.Contact(curve, BODIES, friction=0.3, normal_force=load) for load in table["load_n"]]
    radii = np.array([contact.state.contact_radius for contact in contacts])
    moduli = (contacts[0].summary.e_star, contacts[0].summary.g_star)
    found = {"ratio": [float(np.median(table[COLUMNS[1]] / table[COLUMNS[0]]))], "expected": [moduli[1] / moduli[0]]}
    for column, modulus in zip(COLUMNS, moduli, strict=True):
        found[f"rms of {column}"] = [float(np.std(2e-6 * modulus * radii - table[column]) / np.ptp(table[column]))]
    return pandas.DataFrame(found)


if __name__ == "__main__":
    print(main(*sys.argv[1:2]).to_string(index=False))
