"""Normal contact on a grid, by a function from heights to pressures."""

import numpy as np


def code_of(pressure):
    """`pressure(profile, e_star, load, radii)` gives contact radius, indentation or None, and pressure at the radii.

    The shear stress of first loading is mu times the difference of two pressures (Ciavarella 1998).
    """

    def code(problem, inputs):
        if problem == "normal-contact":
            if inputs["profile"]["type"] == "ellipsoid":
                return {}
            asked = (inputs[name] for name in ("profile", "e_star", "normal_force", "radii"))
            try:
                radius, depth, found = pressure(*asked)
            except ArithmeticError:
                return {}
            depths = {} if depth is None else {"indentation": [depth]}
            return {"contact_radius": [radius], "pressure": found.tolist(), **depths}
        if problem == "first-loading":
            ball, radii, load = {"type": "sphere", "radius": inputs["radius"]}, inputs["radii"], inputs["normal_force"]
            stuck = load - inputs["forces"][-1] / inputs["friction"]
            try:
                whole, inner = (pressure(ball, inputs["e_star"], force, radii)[2] for force in (load, stuck))
            except ArithmeticError:
                return {}
            return {"shear": (inputs["friction"] * (whole - inner)).tolist()}
        raise NotImplementedError(problem)

    return code


def distances(count, side):
    """Distances of the middles of the cells from the axis, m."""
    x = (np.arange(count) + 0.5) * side / count - side / 2
    return np.hypot(*np.meshgrid(x, x, indexing="ij"))


def read(found, side, radii):
    """Contact radius by the number of cells in contact, and the pressure along the row beside the axis."""
    count = len(found)
    r, row = distances(count, side)[count // 2], found[count // 2]
    half = count // 2
    return float(np.sqrt((found > 0).sum() / np.pi) * side / count), np.interp(radii, r[half:], row[half:])
