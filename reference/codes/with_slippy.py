"""slippy, a free half-space on a grid that is four contact radii wide: `pip install slippy "numpy<1.24"`."""

import numpy as np
import slippy
from grids import code_of, distances, read
from shapes import heights

slippy.CUDA = False

import slippy.contact as contact  # noqa: E402
import slippy.surface as surface  # noqa: E402

COUNT = 64
VERSION = f"slippy {slippy.__version__} with NumPy {np.__version__}, {COUNT} cells across 4 contact radii"


def pressure(profile, e_star, load, radii):
    """A static step under a load."""
    side = 4 * max(radii) / 0.95
    cell = side / COUNT
    ball = surface.Surface(profile=-heights(profile, distances(COUNT, side)), grid_spacing=cell)
    ball.material = contact.Elastic("body", {"E": e_star, "v": 0.0})
    flat = surface.FlatSurface(shift=(0, 0))
    flat.material = contact.Rigid("plane")
    model = contact.ContactModel("contact", ball, flat)
    model.add_step(contact.StaticStep("press", normal_load=load))
    found = model.solve()
    radius, at = read(np.array(found["loads"].z), side, radii)
    return radius, float(found["interference"]), at


code = code_of(pressure)
