"""A rubber seal that vibrates: the peak of its loss factor over the frequency, by rubber and by friction.

    python seal_loss.py

At small amplitudes the rubber alone dissipates, at large ones friction does.
"""

import numpy as np
import pandas

import stickslip as ss

RATIO, TIME = 0.6, 0.01
RUBBER = ss.Body("5 MPa", 0.49, prony=[(RATIO, TIME)])
SEAL = ss.Contact(ss.Sphere("5 mm"), [RUBBER, ss.RIGID], 0.6, normal_force="2 N")
FREQUENCIES = np.geomspace(0.1, 1e4, 51)


def main() -> pandas.DataFrame:
    """For each amplitude over that of gross slip: frequency, Hz, and height of the peak, and the friction in it."""
    slip = ss.cycle(SEAL, "1 nm", frequency=1.0).cycles[0].gross_slip_displacement
    rows = []
    for share in (0.01, 0.1, 0.5, 1.0):
        table = ss.cycle(SEAL, share * slip, frequency=FREQUENCIES).to_frame()
        peak = table.iloc[table["loss_factor"].argmax()]
        friction = peak["dissipated_energy"] / (peak["dissipated_energy"] + peak["viscous_work"])
        rows.append((share, peak["frequency"], peak["loss_factor"], friction))
    return pandas.DataFrame(rows, columns=["amplitude", "frequency", "loss_factor", "friction"])


if __name__ == "__main__":
    print(main().to_string(index=False))
