"""A ball of rubber that falls on a hard floor: its coefficient of restitution over the speed.

    python soft_impact.py

The ball loses most where the impact takes some relaxation times of the rubber, and the less the shorter it is.
"""

import numpy as np
import pandas

import stickslip as ss

RADIUS, DENSITY, TIME = 0.01, 1100.0, 2e-3
RUBBER = ss.Body("3 MPa", 0.5, prony=[(0.4, TIME)])
SPEEDS = np.geomspace(1e-4, 10.0, 6)
STEPS = 250


def rebound(speed: float) -> tuple[float, float]:
    """The speed after the impact over that before, and the time of contact, s."""
    mass, e_star = DENSITY * 4.0 / 3.0 * np.pi * RADIUS**3, 3e6 / (1.0 - 0.5**2)
    step = 2.94 * (15.0 * mass * speed**2 / (16.0 * e_star * RADIUS**0.5)) ** 0.4 / speed / STEPS
    ball = ss.Contact(ss.Sphere(RADIUS), [RUBBER, ss.RIGID], 0.5, indentation=0.0)
    depth, inwards, time, force = 0.0, speed, 0.0, 0.0
    while time == 0.0 or force > 0.0:
        # Half the kick, the move, and the other half.
        inwards -= 0.5 * step * force / mass
        depth, time = depth + step * inwards, time + step
        force = ball.move(indentation=depth, duration=step, tolerance=1e-3).state.normal_force
        inwards -= 0.5 * step * force / mass
    return -inwards / speed, time


def main() -> pandas.DataFrame:
    """Speed, restitution, and the time of contact over the relaxation time."""
    found = [rebound(speed) for speed in SPEEDS]
    restitution, times = np.transpose(found)
    return pandas.DataFrame({"speed": SPEEDS, "restitution": restitution, "time": times / TIME})


if __name__ == "__main__":
    print(main().to_string(index=False))
