"""From the file of a bench to the coefficient of friction, the stiffness and the compliance of the machine.

python loop_to_friction.py [LOOP]
"""

import sys
from pathlib import Path

import pandas

import stickslip as ss

FILE = Path(__file__).parents[1] / "data" / "ball_loop.csv"


def main(file: str | Path = FILE) -> pandas.DataFrame:
    """What was found, with the intervals at 95 %."""
    steel = ss.Body("210 GPa", 0.3)
    guess = ss.Definition(ss.Sphere("10 mm"), [steel, steel], friction=0.3, normal_force="10 N")
    loop = ss.read_loop(file)
    free = ["friction", "g_star", "machine_compliance", "force_offset"]
    fit = ss.fit(guess, loop, free=free, start="steady")
    return fit.estimates.to_frame()


if __name__ == "__main__":
    print(main(*sys.argv[1:]).to_string(float_format="{:.6g}".format))
