"""From a measured scan to the shear stress that remains after a motion.

    python scan_to_residual_stress.py [SCAN]

Prints the radius of curvature, the contact with its errors, and what each number of reversals leaves.
"""

import sys
from pathlib import Path

import pandas

import stickslip as ss

FILE = Path(__file__).parents[1] / "data" / "ball_scan.txt"
BODIES = [ss.Body("210 GPa", 0.3), ss.Body("210 GPa", 0.3)]


def main(file: str | Path = FILE) -> pandas.DataFrame:
    """The table of what remains, over mu p_max."""
    fit = ss.fit_profile(ss.read_scan(file, lateral="um", height="nm"))
    print(f"radius of curvature on the axis: {fit.document['radius_of_curvature']}")
    worn = ss.Contact(fit.profile, BODIES, friction=0.3, normal_force="10 N")
    print(f"contact radius: {1e6 * worn.summary.contact_radius:.1f} um")
    rows = []
    for reversals in (1, 2, 5, 10, 20):
        contact = worn.copy()
        contact.path(falling_amplitude=reversals)
        rows.append({"reversals": reversals, "remaining": contact.residual().relative})
    return pandas.DataFrame(rows)


if __name__ == "__main__":
    print(main(*sys.argv[1:]).to_string(index=False))
