"""The members of requests: their units, and what stands for them. Written by `tools/generate.py`."""

from __future__ import annotations

#: The SI unit of each number by the name of its member.
MEMBERS: dict[str, str] = {
    "alpha": "1",
    "amplitude_error": "1",
    "coefficient": "",
    "conductivity": "W/(m·K)",
    "contact_radius": "m",
    "creep": "1",
    "cutoff_radius": "m",
    "cycles": "1",
    "displacement": "m",
    "drive_force": "N",
    "ductility": "1",
    "ductility_exponent": "1",
    "duration": "s",
    "e_star": "Pa",
    "edge_radius": "m",
    "exponent": "1",
    "flat_half_width": "m",
    "flat_radius": "m",
    "force": "N",
    "force_error": "1",
    "frequencies": "Hz",
    "frequency": "Hz",
    "friction": "1",
    "friction_error": "1",
    "g_star": "Pa",
    "gaps": "m",
    "indentation": "m",
    "indentation_error": "m",
    "k": "1",
    "length": "m",
    "mass": "kg",
    "noise": "m",
    "normal_force": "N",
    "offset": "m",
    "phase": "deg",
    "points": "m",
    "poisson_ratio": "1",
    "pressure_error": "1",
    "r": "m",
    "radii": "m",
    "radius": "m",
    "ratio": "1",
    "reference_length": "m",
    "resistivity": "Ω·m",
    "shear_modulus": "Pa",
    "shear_strength": "Pa",
    "slope": "1",
    "smallest_amplitude": "m",
    "stiffness": "N/m",
    "strength": "Pa",
    "strength_exponent": "1",
    "stress_per_force": "Pa/N",
    "target": "1",
    "time": "s",
    "tip_radius": "m",
    "tolerance": "1",
    "torque": "N·m",
    "twist": "rad",
    "weight": "1",
    "work": "J/m^2",
    "work_error": "1",
    "x": "m",
    "y": "m",
    "yield": "Pa",
    "youngs_modulus": "Pa",
    "z": "m",
}

#: Where the same name has several units: that within the member around it.
WITHIN: dict[tuple[str, str], str] = {
    ("bulk", "amplitude"): "Pa",
    ("bulk", "mean"): "Pa",
    ("crossland", "limit"): "Pa",
    ("cycles", "mean"): "m",
    ("dang_van", "limit"): "Pa",
    ("falling_amplitude", "amplitude"): "m",
    ("fatemi_socie", "limit"): "1",
    ("findley", "limit"): "Pa",
    ("line", "from"): "m",
    ("line", "to"): "m",
    ("normal_force", "from"): "N",
    ("normal_force", "to"): "N",
    ("swt", "limit"): "Pa",
}

#: The members for which one number may stand, and which of theirs it is.
SHORT: dict[str, str] = {
    "best_load": "points",
    "bulk": "amplitude",
    "equal_peaks": "reversals",
    "falling_amplitude": "reversals",
    "machine": "stiffness",
    "stress": "points",
    "work_density": "points",
}

#: The members whose object may be empty, so that True asks for them.
EMPTY: frozenset[str] = frozenset(
    [
        "best_load",
        "bulk",
        "criteria",
        "friction_work",
        "known",
        "noise",
        "robustness",
        "ruiz",
        "swt",
        "units",
    ]
)

#: The most radii, or places along a line, at which stresses are asked for.
MOST_PLACES = 10000

#: The method of each computation by its path.
METHODS: dict[str, str] = {
    "/accuracy": "accuracy",
    "/cycle": "cycle",
    "/fit": "fit",
    "/fretting": "fretting",
    "/profiles/fit": "fit_profile",
    "/protocols": "protocols",
    "/rolling": "rolling",
    "/simulate": "simulate",
    "/sliders": "sliders",
    "/sweep": "sweep",
    "/wear": "wear",
}
