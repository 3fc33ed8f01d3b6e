"""Oblique impact of a ball: tangential rebound over the angle by the exact law and by one spring that is cut.

    python oblique_impact.py

The curve is that of Maw, Barber & Fawcett (1976): angles and speeds are scaled by mu and the stiffnesses.
"""

import numpy as np
import pandas

import stickslip as ss

RADIUS, MASS, FRICTION = 0.01, 0.033, 0.3
STEEL = ss.Body(2.1e11, 0.3)
ANGLES = np.linspace(0.2, 6.0, 30)
STEPS = 2000


def main() -> pandas.DataFrame:
    """Scaled tangential speeds of the surface before and after impacts at one normal speed, by both laws."""
    many = ss.Contacts(len(ANGLES), ss.Sphere(RADIUS), [STEEL, STEEL], FRICTION)
    e_star = 0.5 * 2.1e11 / (1.0 - 0.3**2)
    g_star = e_star * 2.0 * (1.0 - 0.3) / (2.0 - 0.3)
    scale, speed = FRICTION * e_star / g_star, 0.1
    # A solid ball turns: the surface is lighter than the ball by this factor.
    surface_mass = MASS / 3.5
    duration = 2.94 * (15.0 * MASS * speed**2 / (16.0 * e_star * RADIUS**0.5)) ** 0.4 / speed
    step = 1.2 * duration / STEPS
    results = {"angle": ANGLES}
    for law in ("exact", "incremental"):
        depth, sideways = np.zeros_like(ANGLES), np.zeros_like(ANGLES)
        inwards, along = np.full_like(ANGLES, speed), ANGLES * scale * speed
        spring = np.zeros_like(ANGLES)
        for _ in range(STEPS):
            depth, sideways, spring = depth + step * inwards, sideways + step * along, spring + step * along
            normal, tangential = many.step(depth, sideways)
            if law == "incremental":
                stiffness = 2.0 * g_star * np.sqrt(RADIUS * np.maximum(depth, 1e-30))
                spring = np.clip(spring, -FRICTION * normal / stiffness, FRICTION * normal / stiffness)
                tangential = stiffness * spring
            inwards, along = inwards - step * normal / MASS, along - step * tangential / surface_mass
        results[law] = along / (scale * speed)
    return pandas.DataFrame(results)


if __name__ == "__main__":
    print(main().to_string(index=False))
