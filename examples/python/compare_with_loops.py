"""From a ball's fretting loop to the loop of a worn ball, before it is compared with what was measured.

python compare_with_loops.py [BALL WORN]     # two files with columns displacement_um, force_n

The loop of the ball gives friction, stiffness and the compliance of the rig; with them the loop of the truncated ball
is computed, and only then laid over the measured one. Without files, both are synthetic, of the form of a bench.
"""

import io
import sys
from pathlib import Path

import numpy as np
import pandas

import stickslip as ss

LOAD, RADIUS, FLAT, COMPLIANCE = "10 N", "10 mm", "50 um", 3e-8  # of the synthetic bench
STEEL = [ss.Body("210 GPa", 0.3), ss.Body("210 GPa", 0.3)]
BODIES = (ss.Sphere(RADIUS), ss.TruncatedSphere(radius=RADIUS, flat_radius=FLAT))


def synthetic(shape: ss.Sphere | ss.TruncatedSphere, friction: float = 0.42, noise: float = 0.01) -> str:
    """Three steady cycles with noise, as a file of a bench has them."""
    contact = ss.Contact(shape, STEEL, friction=friction, normal_force=LOAD)
    turn = np.linspace(0.0, 6.0 * np.pi, 601)
    path = contact.path(6e-7 * np.sin(turn))
    measured = path.displacement + COMPLIANCE * path.force
    force = path.force + noise * np.random.default_rng(1).standard_normal(len(turn))
    table = pandas.DataFrame({"displacement_um": 1e6 * measured, "force_n": force})
    return table.iloc[200:].to_csv(index=False)


def main(files: tuple[str, str] | None = None) -> pandas.DataFrame:
    """Found parameters, and how far the predicted loop of the worn ball is from the measured one."""
    texts = [Path(file).read_text() for file in files] if files else [synthetic(shape) for shape in BODIES]
    ball, worn = (pandas.read_csv(io.StringIO(text)) for text in texts)
    guess = ss.Definition(BODIES[0], STEEL, friction=0.3, normal_force=LOAD)
    measured = (1e-6 * ball["displacement_um"].to_numpy(), ball["force_n"].to_numpy())
    fit = ss.fit(guess, measured, free=["friction", "g_star", "machine_compliance"], start="steady")
    friction, compliance = (fit.estimates[name].value for name in ("friction", "machine_compliance"))
    e_star = 210e9 / (2 * (1 - 0.3**2))
    moduli = ss.Moduli(e_star, fit.estimates["g_star"].value)
    contact = ss.Contact(BODIES[1], moduli, friction=friction, normal_force=LOAD)
    displacement = 1e-6 * worn["displacement_um"].to_numpy() - compliance * worn["force_n"].to_numpy()
    contact.path(displacement)
    predicted = contact.path(displacement).force
    rest = float(np.std(predicted - worn["force_n"]) / np.ptp(worn["force_n"]))
    return pandas.DataFrame({"friction": [friction], "machine_compliance": [compliance], "relative_rms": [rest]})


if __name__ == "__main__":
    print(main((sys.argv[1], sys.argv[2]) if len(sys.argv) > 2 else None).to_string())
