"""A rough surface under friction: its load curve from ContactMechanics, its hysteresis loop from the service.

    python load_curve.py compute > load_curve.csv
    python load_curve.py load_curve.csv [URL] > loop.csv

The first needs `ContactMechanics` (1.8 made the file beside this script), the second `requests` and `pandas`. A curve of any other
program will do, Tamaas for example: two columns, how far the surfaces have approached since the first touch and the mean pressure.
"""

import sys

import pandas
import requests

SIDE = 1e-4  # m, of the square that the curve was computed for
BODY = {"youngs_modulus": 2.1e11, "poisson_ratio": 0.3}
E_STAR = BODY["youngs_modulus"] / (1 - BODY["poisson_ratio"] ** 2) / 2  # Pa, of two such bodies
FRICTION = 0.3
NORMAL_FORCE = 1.0  # N


def compute():
    """The curve of a random self-affine surface: approach in m, mean pressure over E*."""
    import ContactMechanics  # noqa: F401, which gives surfaces their `contact_mechanics`
    import numpy
    from SurfaceTopography.Generation import fourier_synthesis

    numpy.random.seed(1)
    surface = fourier_synthesis((128, 128), (SIDE, SIDE), 0.8, rms_slope=0.05, short_cutoff=8e-6, long_cutoff=5e-5)
    pressures = numpy.geomspace(1e-5, 1e-2, 25)
    pressure, _, _, gap, converged = surface.contact_mechanics(pressures=list(pressures), maxiter=2000)
    assert all(converged)
    heights = surface.heights()
    approach = heights.max() - heights.mean() - numpy.array(gap)
    return pandas.DataFrame({"approach": approach, "pressure": pressure})


def contact(curve):
    """The contact of the service that has this curve, from the first touch on."""
    force = curve["pressure"] * E_STAR * SIDE**2
    profile = {
        "type": "load_curve",
        "indentation": [0.0, *curve["approach"]],
        "normal_force": [0.0, *force],
    }
    return {
        "profile": profile,
        "material": {"bodies": [BODY, BODY]},
        "friction": FRICTION,
        "preload": {"normal_force": NORMAL_FORCE},
    }


def loop(service, definition):
    """Three quarters of the displacement of gross slip, back and forth."""
    body = {"contact": definition, "path": {"displacement": [0.0]}, "steps": "last"}
    reply = requests.post(f"{service}/simulate", json=body, timeout=30)
    reply.raise_for_status()
    amplitude = 0.75 * reply.json()["contact"]["gross_slip_displacement"]
    rise = [amplitude * index / 50 for index in range(51)]
    fall = [amplitude * index / 50 for index in range(49, -51, -1)]
    body["path"] = {"displacement": rise + fall + [-target for target in fall]}
    reply = requests.post(f"{service}/simulate", json={**body, "steps": "all"}, timeout=30)
    reply.raise_for_status()
    return pandas.DataFrame(reply.json()["steps"])[["displacement", "force"]]


if __name__ == "__main__":
    if sys.argv[1] == "compute":
        compute().to_csv(sys.stdout, index=False)
    else:
        url = sys.argv[2] if len(sys.argv) > 2 else "http://localhost:8080"
        loop(url, contact(pandas.read_csv(sys.argv[1]))).to_csv(sys.stdout, index=False)
