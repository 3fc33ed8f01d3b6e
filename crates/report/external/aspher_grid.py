"""ASPHER (https://pypi.org/project/aspher), a boundary-element package, on the scenes of a parabola at constant load.

The contact is meshed with N x N squares over 2.4 contact radii, pressed with the force of Hertz, and moved sideways by the
displacements of the scene. Lengths are in contact radii and stresses in E*. It reads and replies as numpy_springs.py does.
"""

import json
import sys
import time

import numpy as np

# The most moves that it can take in a reasonable time.
MOVES = 21
SIDE = 2.4


def solve(aspher, scene, count):
    e_star, g_star, mu = scene["e_star"], scene["g_star"], scene["friction"]
    depth = scene["indentation"]
    edge = np.sqrt(scene["radius"] * depth)
    # E*/G* = (2 - nu)/(2 (1 - nu)) for one elastic body.
    ratio = e_star / g_star
    nu = (2 * ratio - 2) / (2 * ratio - 1)
    h = SIDE / count
    at = (np.arange(count) + 0.5) * h - SIDE / 2
    x, y = np.meshgrid(at, at, indexing="ij")
    solver = aspher.FrictionSolver(grid_size=count, domain_size=SIDE, E_star=1.0, nu=nu,
                                   model=aspher.CoulombFriction(mu))
    solver.set_gap(((x * x + y * y) / (2 * scene["radius"] / edge)).ravel())
    normal = 4 / 3 * (depth / edge)
    solver.step(p_bar=normal / SIDE**2)
    forces = []
    for _, displacement in scene["moves"]:
        step = solver.step(delta_t=(displacement / edge, 0.0))
        if not step.converged:
            raise RuntimeError(f"no convergence on {count} x {count}: {step.status_reason}")
        forces.append(float(step.q_mean[0]) * SIDE**2 * e_star * edge**2)
    # Along the row of squares next to the x axis.
    row = np.asarray(step.qx).reshape(count, count)[count // 2:, count // 2]
    r = np.hypot(at[count // 2:], at[count // 2])
    shears = e_star * np.interp(np.asarray(scene["radii"]) / edge, r, row)
    return forces, [float(shear) for shear in shears]


def main():
    scene = json.load(sys.stdin)
    if scene["profile"] != "parabola":
        sys.exit("the script supports the parabola alone")
    if any(d != scene["indentation"] for d, _ in scene["moves"]):
        sys.exit("the script supports a constant load alone")
    if len(scene["moves"]) > MOVES:
        sys.exit(f"more than {MOVES} moves would take hours")
    # Where it is not installed, the message says so.
    import aspher

    begin = time.process_time()
    forces, shears = solve(aspher, scene, scene["count"])
    seconds = time.process_time() - begin
    json.dump({"seconds": seconds, "forces": forces, "shears": shears}, sys.stdout)


main()
