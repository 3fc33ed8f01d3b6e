"""Balls that orbit on a plate: what partial slip takes of their energy in three turns, and what one spring takes.

Each ball is pressed on and let go on a circle, at a part of gross slip. The direction of slip turns all the time, and
differs from ring to ring. One spring that is cut where friction ends it takes nothing below gross slip.
"""

import numpy as np
import pandas

import stickslip as ss

STEPS, TURNS = 64, 3
MASS, FRICTION, LOAD = 0.1, 0.3, 10.0
BODIES = ss.Moduli("115 GPa", "85 GPa")
SHARE = np.array([0.05, 0.1, 0.2, 0.4, 0.6])


def main() -> pandas.DataFrame:
    """The energy that is left, and the friction work, over the energy at the start."""
    summary = ss.Contact(ss.Sphere("10 mm"), BODIES, FRICTION, normal_force=LOAD).summary
    balls = ss.PlanarContacts(len(SHARE), ss.Sphere("10 mm"), BODIES, FRICTION, normal_force=LOAD)
    stiffness = 2.0 * 85e9 * summary.contact_radius
    amplitude = SHARE * summary.gross_slip_displacement

    def rings(place: np.ndarray) -> np.ndarray:
        return balls.step(normal_force=LOAD, displacement=place)[1]

    def spring(place: np.ndarray) -> np.ndarray:
        force = stiffness * place
        return force * np.minimum(1.0, FRICTION * LOAD / np.linalg.norm(force, axis=1, keepdims=True))

    def energies() -> np.ndarray:
        states = [balls.state(index) for index in range(len(SHARE))]
        return np.array([[state.elastic_energy, state.dissipated_energy] for state in states]).T

    rate = np.sqrt(stiffness / MASS)
    step, kinetic = 2.0 * np.pi / rate / STEPS, {}
    rings(np.stack([amplitude, 0.0 * amplitude], axis=1))
    begin = 0.5 * stiffness * amplitude**2 + energies().sum(axis=0)
    for force_at in (rings, spring):
        place = np.stack([amplitude, 0.0 * amplitude], axis=1)
        speed = np.stack([0.0 * amplitude, rate * amplitude], axis=1)
        for _ in range(TURNS * STEPS):
            speed = speed - 0.5 * step / MASS * force_at(place)
            place = place + step * speed
            speed = speed - 0.5 * step / MASS * force_at(place)
        kinetic[force_at] = 0.5 * MASS * np.sum(speed**2, axis=1)
    stored, lost = energies()
    left, of_spring = kinetic[rings] + stored, kinetic[spring] + 0.5 * stiffness * np.sum(place**2, axis=1)
    columns = {"rings": left / begin, "friction_work": lost / begin, "spring": of_spring / (stiffness * amplitude**2)}
    return pandas.DataFrame({"amplitude": SHARE, **columns})


if __name__ == "__main__":
    print(main().to_string(index=False))
