"""A mass on a contact: amplitude and phase over the frequency, by harmonic balance with a table of steady cycles.

    python cycle_dynamics.py [URL] > response.csv

Needs `requests`, `pandas` and `scipy`. The table is one call of POST /cycle, which any dynamics code can use likewise. The
service's own `frequency_response` gives the same curve for this one mass.
"""

import io
import sys

import numpy
import pandas
import requests
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq

CONTACT = {
    "profile": {"type": "sphere", "radius": 0.01},
    "material": {"bodies": [{"youngs_modulus": 2.1e11, "poisson_ratio": 0.3}, "rigid"]},
    "friction": 0.3,
    "preload": {"normal_force": 10.0},
}
MASS = 0.1  # kg
DRIVE_FORCE = 0.5  # N, amplitude
AMPLITUDES = numpy.geomspace(1e-10, 1e-6, 400)  # m; solutions beyond the table are not found


def cycles(service):
    """The table of steady cycles, a row for each amplitude."""
    body = {"contact": CONTACT, "drive": {"displacement": list(AMPLITUDES)}, "harmonics": 1}
    reply = requests.post(f"{service}/cycle?format=csv", json=body, timeout=30)
    reply.raise_for_status()
    return pandas.read_csv(io.StringIO(reply.text))


def response(table, count=100):
    """All steady oscillations at each frequency: M U'' + F(U) = P cos(w t)."""
    amplitude = table["displacement_amplitude"].to_numpy()
    # The complex stiffness k + i w c of the equivalent spring and damper.
    harmonic = table["in_phase_1"] - 1j * table["quadrature_1"]
    stiffness = CubicSpline(numpy.log(amplitude), harmonic.to_numpy() / amplitude)
    natural = numpy.sqrt(table["tangent_stiffness"][0] / MASS) / (2 * numpy.pi)
    rows = []
    for frequency in natural * numpy.linspace(0.3, 1.5, count):

        def dynamic_stiffness(size, inertia=MASS * (2 * numpy.pi * frequency) ** 2):
            return stiffness(numpy.log(size)) - inertia

        def surplus(size):
            return abs(dynamic_stiffness(size)) * size - DRIVE_FORCE

        signs = numpy.sign(surplus(amplitude))
        for index in numpy.flatnonzero(signs[1:] != signs[:-1]):
            size = brentq(surplus, amplitude[index], amplitude[index + 1], rtol=1e-12, xtol=1e-20)
            rows.append((frequency, size, numpy.degrees(numpy.angle(dynamic_stiffness(size)))))
    return pandas.DataFrame(rows, columns=["frequency", "amplitude", "phase"])


if __name__ == "__main__":
    service = sys.argv[1] if len(sys.argv) > 1 else "http://localhost:8080"
    print(response(cycles(service)).to_csv(index=False), end="")
