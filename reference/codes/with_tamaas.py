"""Tamaas, a periodic half-space on a grid that is sixteen contact radii wide: `pip install tamaas`."""

import numpy as np
import tamaas as tm
from grids import code_of, distances, read
from shapes import heights

VERSION = f"Tamaas {tm.__version__}, 256 cells across 16 contact radii"
COUNT = 256
tm.set_log_level(tm.LogLevel.warning)


def pressure(profile, e_star, load, radii):
    """The largest radius that is asked for is near the edge."""
    side = 16 * max(radii) / 0.95
    surface = -heights(profile, distances(COUNT, side))
    model = tm.ModelFactory.createModel(tm.model_type.basic_2d, [side, side], [COUNT, COUNT])
    model.E, model.nu = e_star, 0.0
    tm.PolonskyKeerRey(model, surface - surface.mean(), 1e-10).solve(load / side**2)
    radius, at = read(np.array(model.traction), side, radii)
    return radius, None, at


code = code_of(pressure)
