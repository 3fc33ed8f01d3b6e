"""The spring foundation of Kraft & Pohrt (2016) in plain NumPy.

A row of springs over the contact, clamped to mu times the normal load of each after every move; the shear stress by
differences between neighbours. It reads a scene with its number of springs as JSON, and writes forces, stresses, and the
seconds of processor time that they took. `stickslip-report speed --external PYTHON` runs it.
"""

import json
import sys
import time

import numpy as np


def plane_profile(scene):
    """The one-dimensional profile g(x) and its inverse: the contact radius of an indentation."""
    kind, radius = scene["profile"], scene["radius"]
    if kind == "parabola":
        return lambda x: x**2 / radius, lambda d: np.sqrt(radius * d)
    if kind == "cone":
        slope = np.pi / 2 * scene["slope"]
        return lambda x: slope * x, lambda d: d / slope
    if kind == "power_4":
        factor = 8 / 3 * scene["coefficient"]
        return lambda x: factor * x**4, lambda d: (d / factor) ** 0.25
    if kind == "exact_sphere":
        return lambda x: x * np.arctanh(x / radius), None
    return None, None


def contact_radius(g, inverse, d):
    if inverse:
        return inverse(d)
    low, high = 0.0, 0.9 * 0.01
    for _ in range(200):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if g(middle) < d else (low, middle)
    return 0.5 * (low + high)


def solve(scene, g, inverse, count):
    e_star, g_star, mu = scene["e_star"], scene["g_star"], scene["friction"]
    moves = scene["moves"]
    reach = contact_radius(g, inverse, max([scene["indentation"]] + [d for d, _ in moves]))
    dx = 2 * reach / count
    x = (np.arange(count) + 0.5) * dx - reach
    level = g(np.abs(x))
    u = np.zeros(count)
    before, forces = 0.0, []
    for d, displacement in moves:
        bound = mu * e_star / g_star * np.maximum(d - level, 0.0)
        u = np.clip(u + (displacement - before), -bound, bound)
        before = displacement
        forces.append(g_star * dx * u.sum())
    # tau(r) = -(G*/pi) int_r^a u'(x) / sqrt(x^2 - r^2) dx, over the half with x > 0.
    half = x > 0
    x, u = x[half], np.append(u[half], 0.0)
    change, middle = np.diff(u), x + dx / 2
    shears = []
    for r in scene["radii"]:
        first = np.searchsorted(x, r)
        shears.append(-g_star / np.pi * np.sum(change[first:] / np.sqrt(middle[first:] ** 2 - r**2)))
    return [float(force) for force in forces], [float(shear) for shear in shears]


def main():
    scene = json.load(sys.stdin)
    g, inverse = plane_profile(scene)
    if g is None:
        sys.exit("the script does not support tables")
    # The first run finds cold caches.
    for _ in range(2):
        begin = time.process_time()
        forces, shears = solve(scene, g, inverse, scene["count"])
        seconds = time.process_time() - begin
    json.dump({"seconds": seconds, "forces": forces, "shears": shears}, sys.stdout)


main()
