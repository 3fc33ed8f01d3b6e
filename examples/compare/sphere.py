"""A ball on a plane by boundary elements and by stickslip: pressure, and shear stress on first loading.

    pip install ContactMechanics tamaas
    python sphere.py [PROGRAM]        # the program stickslip, if it is not on the path

Boundary elements give the pressure on a grid. The shear stress of partial slip is mu times the difference of two
pressures of the same bodies (Ciavarella 1998, Jäger 1998), that at the load and that at the load of the stick zone, so
that a normal solver gives it, too. Errors are the largest over the grid, relative to the largest pressure and to mu
times that; times are processor times of one call of a solver, without imports, and of the whole process of stickslip.
"""

import json
import resource
import subprocess
import sys
import time

import numpy as np

RADIUS, E_STAR, FRICTION, LOAD, SHARE = 0.01, 1.15e11, 0.3, 10.0, 0.5  # m, Pa, –, N, force over mu F_N
EDGE = (3 * LOAD * RADIUS / (4 * E_STAR)) ** (1 / 3)
PEAK = 1.5 * LOAD / (np.pi * EDGE**2)
STICK_LOAD = (1 - SHARE) * LOAD  # the load whose contact is the stick zone


def grid(count, side):
    """Distances of the middles of the cells from the axis, m."""
    x = (np.arange(count) + 0.5) * side / count - side / 2
    return np.hypot(*np.meshgrid(x, x, indexing="ij"))


def contact_mechanics(count, load):
    """A free half-space: the grid is four contact radii wide."""
    from ContactMechanics import FreeFFTElasticHalfSpace
    from ContactMechanics.Factory import make_system
    from SurfaceTopography import make_sphere

    side = 4 * EDGE
    ball = make_sphere(RADIUS, (count, count), (side, side), kind="paraboloid", centre=(side / 2, side / 2))
    system = make_system(
        interaction="hardwall", substrate=FreeFFTElasticHalfSpace((count, count), E_STAR, (side, side)), surface=ball
    )
    depth = (load / LOAD) ** (2 / 3) * EDGE**2 / RADIUS
    system.minimize_proxy(offset=depth, pentol=1e-12)
    x = np.arange(count) * side / count - side / 2
    r = np.hypot(*np.meshgrid(x, x, indexing="ij"))
    return r, np.abs(system.substrate.force[:count, :count]) / (side / count) ** 2


def tamaas(count, load):
    """A periodic half-space, whose images must be far away: the grid is sixteen contact radii wide."""
    import tamaas as tm

    side = 16 * EDGE
    tm.set_log_level(tm.LogLevel.warning)
    r = grid(count, side)
    model = tm.ModelFactory.createModel(tm.model_type.basic_2d, [side, side], [count, count])
    model.E, model.nu = E_STAR, 0.0
    heights = -(r**2) / (2 * RADIUS)
    tm.PolonskyKeerRey(model, heights - heights.mean(), 1e-12).solve(load / side**2)
    return r, np.array(model.traction)


def exact(r, load):
    """Hertz's pressure, Pa."""
    edge = EDGE * (load / LOAD) ** (1 / 3)
    return 1.5 * load / (np.pi * edge**2) * np.sqrt(np.maximum(0.0, 1 - (r / edge) ** 2))


def stickslip(program, radii):
    """Pressure and shear stress, Pa, and the processor time of the process, s."""
    request = {
        "contact": {
            "profile": {"type": "sphere", "radius": RADIUS},
            "material": {"effective": {"e_star": E_STAR, "g_star": 0.8 * E_STAR}},
            "friction": FRICTION,
            "preload": {"normal_force": LOAD},
        },
        "path": {"force": [SHARE * FRICTION * LOAD]},
        "stress": {"radii": list(radii)},
    }
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    reply = subprocess.run([program, "simulate", "-", "--json"], input=json.dumps(request), capture_output=True, text=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if reply.returncode:
        sys.exit(reply.stderr)
    document = json.loads(reply.stdout)
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    stress = document["stress"]
    return np.array(stress["pressure"]), np.array(stress["shear"]), seconds, document["accuracy"]["compute_time"]


def main():
    program = sys.argv[1] if len(sys.argv) > 1 else "stickslip"
    print(f"contact radius {EDGE:.6g} m, largest pressure {PEAK:.6g} Pa, force {SHARE} mu F_N")
    print("program, cells along the side, cells along the radius, error of pressure, error of shear stress, time (s)")
    for solve, counts in ((contact_mechanics, (64, 128, 256)), (tamaas, (128, 256, 512))):
        for count in counts:
            begin = time.process_time()
            (r, pressure), (_, inner) = solve(count, LOAD), solve(count, STICK_LOAD)
            seconds = (time.process_time() - begin) / 2
            hertz, stick = exact(r, LOAD), exact(r, STICK_LOAD)
            errors = np.abs(pressure - hertz).max() / PEAK, np.abs((pressure - inner) - (hertz - stick)).max() / PEAK
            along = count / (4 if solve is contact_mechanics else 16)
            print(f"{solve.__name__}, {count}, {along:.0f}, {errors[0]:.1e}, {errors[1]:.1e}, {seconds:.2g}")
    radii = EDGE * np.linspace(0, 1, 201)
    pressure, shear, process, compute = stickslip(program, radii)
    hertz, stick = exact(radii, LOAD), exact(radii, STICK_LOAD)
    errors = np.abs(pressure - hertz).max() / PEAK, np.abs(shear / FRICTION - (hertz - stick)).max() / PEAK
    print(f"stickslip, 201 radii, {errors[0]:.1e}, {errors[1]:.1e}, {process:.2g} ({compute:.1e} of the solver)")


if __name__ == "__main__":
    main()
