"""ContactMechanics, a free half-space on a grid that is four contact radii wide: `pip install ContactMechanics`."""

import ContactMechanics
import numpy as np
from ContactMechanics import FreeFFTElasticHalfSpace
from ContactMechanics.Factory import make_system
from grids import code_of, distances, read
from shapes import heights
from SurfaceTopography import Topography

COUNT = 64
VERSION = f"ContactMechanics {ContactMechanics.__version__}, {COUNT} cells across 4 contact radii"


def pressure(profile, e_star, load, radii):
    """The indentation for the load is found by the secant method: the solver takes indentations.

    Shapes with a tip or a rim do not converge, and are left out.
    """
    side = 4 * max(radii) / 0.95
    surface = Topography(-heights(profile, distances(COUNT, side)), (side, side))
    half_space = FreeFFTElasticHalfSpace((COUNT, COUNT), e_star, (side, side))

    def solve(depth):
        system = make_system(interaction="hardwall", substrate=half_space, surface=surface)
        if not system.minimize_proxy(offset=depth, pentol=1e-4 * depth, maxiter=300).success:
            raise ArithmeticError("not converged")
        found = np.abs(system.substrate.force[:COUNT, :COUNT]) / (side / COUNT) ** 2
        return found, found.sum() * (side / COUNT) ** 2

    # A punch of this radius bears the load at half of this depth.
    depth = load / (e_star * max(radii))
    before, last = 0.0, 0.0
    for _ in range(20):
        found, force = solve(depth)
        if abs(force - load) < 1e-5 * load or force == last:
            break
        before, last, depth = depth, force, depth + (load - force) * (depth - before) / (force - last)
    radius, at = read(found, side, radii)
    return radius, float(depth), at


code = code_of(pressure)
