"""Damping of a joint by partial slip: the loss factor over the amplitude, beside Mindlin's small amplitudes.

python joint_damping.py
"""

import numpy as np
import pandas

import stickslip as ss


def main() -> pandas.DataFrame:
    """Stiffness and loss factor by the amplitude of the force, and the exponent of the friction work."""
    steel = ss.Body("210 GPa", 0.3)
    joint = ss.Contact(
        ss.RoundedPunch(edge_radius="2 mm", flat_radius="50 mm"), [steel, steel], friction=0.2, normal_force="1 kN"
    )
    amplitudes = np.geomspace(1e-3, 0.95, 12) * joint.summary.gross_slip_force
    table = joint.cycle(force=amplitudes).to_frame()
    table["exponent"] = np.gradient(np.log(table["dissipated_energy"]), np.log(table["force_amplitude"]))
    return table[["force_amplitude", "secant_stiffness", "loss_factor", "exponent"]]


if __name__ == "__main__":
    print(main().to_string(index=False))
