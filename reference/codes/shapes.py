"""Heights of the shapes of normal-contact, for codes that take a surface on a grid."""

import numpy as np


def heights(profile, r):
    """f(r) of a shape, m; of a flat punch a step that nothing reaches."""
    kind = profile["type"]
    radius, slope = float(profile.get("radius", 0.0)), float(profile.get("slope", 0.0))
    flat, tip = float(profile.get("flat_radius", 0.0)), float(profile.get("tip_radius", 1.0))
    if kind == "exact_sphere":
        return radius - np.sqrt(np.maximum(radius**2 - r**2, 0.0))
    if kind == "power_law":
        return profile["coefficient"] * r ** profile["exponent"]
    if kind == "rounded_cone":
        return slope * np.where(r < tip, r**2 / (2 * tip), r - tip / 2)
    beyond = np.maximum(r - flat, 0.0)
    if kind == "rounded_punch":
        return beyond**2 / (2 * profile["edge_radius"])
    if kind in ("cone", "truncated_cone"):
        return slope * beyond
    if kind in ("sphere", "truncated_sphere"):
        return np.maximum(r**2 - flat**2, 0.0) / (2 * radius)
    if kind == "flat_punch":
        return np.where(r < radius, 0.0, radius)
    raise NotImplementedError(kind)
