"""A mass on a contact: amplitude and phase over the frequency, by harmonic balance with a table of steady cycles.

    python cycle_dynamics.py [URL] > response.csv

Needs `requests`, `pandas` and `scipy`. The table is one call of POST /cycle, which any dynamics code can use. The
service's own `frequency_response` gives the same curve for this one mass.
"""

import io
import sys

import numpy
import pandas
import requests
from scipy.interpolate import CubicSpline
from scipy.optimize import root

CONTACT = {
    "profile": {"type": "sphere", "radius": 0.01},
    "material": {
        "bodies": [{"youngs_modulus": 2.1e11, "poisson_ratio": 0.3}, {"youngs_modulus": 2.1e11, "poisson_ratio": 0.3}]
    },
    "friction": 0.3,
    "preload": {"normal_force": 10.0},
}
MASS = 0.1  # kg
DRIVE_FORCE = 0.5  # N, amplitude
AMPLITUDES = numpy.geomspace(1e-10, 1e-6, 400)  # m; no larger oscillation is found
ORDERS = numpy.arange(1, 24, 2)  # harmonics that are balanced; even ones vanish at constant load
INSTANTS = 1024  # of a period


def cycles(service):
    """The table of steady cycles, a row for each amplitude."""
    body = {"contact": CONTACT, "drive": {"displacement": list(AMPLITUDES)}}
    reply = requests.post(f"{service}/cycle?format=csv", json=body, timeout=30)
    reply.raise_for_status()
    return pandas.read_csv(io.StringIO(reply.text))


def masing(displacement, loading):
    """The force over a steady period: branches are the first loading curve at twice its size, and closed loops are left."""
    start = int(numpy.argmax(displacement))
    period = numpy.roll(displacement, -start)
    turns = [(period[0], float(loading(period[0])))]
    way, before = -1.0, period[0]
    origins, base, ways = numpy.empty_like(period), numpy.empty_like(period), numpy.empty_like(period)
    for index, place in enumerate(period):
        if way * (place - before) < 0:
            origin, held = turns[-1]
            turns.append((before, held + 2 * way * float(loading(abs(before - origin) / 2))))
            way = -way
        while len(turns) > 2 and way * (place - turns[-2][0]) > 0:
            del turns[-2:]
        origins[index], base[index], ways[index] = turns[-1][0], turns[-1][1], way
        before = place
    force = base + 2 * ways * loading(numpy.abs(period - origins) / 2)
    return numpy.roll(force, start)


def response(table, count=100):
    """The steady oscillation at each frequency: M U'' + F(U) = P cos(w t)."""
    amplitude = table["displacement_amplitude"].to_numpy()
    curve = CubicSpline(numpy.append(0, amplitude), numpy.append(0, table["force_amplitude"].to_numpy()))

    def loading(displacement):
        return curve(numpy.minimum(displacement, amplitude[-1]))

    stiffness = table["tangent_stiffness"][0]
    angles = 2 * numpy.pi * numpy.arange(INSTANTS) / INSTANTS
    waves = numpy.concatenate([numpy.cos(numpy.outer(ORDERS, angles)), numpy.sin(numpy.outer(ORDERS, angles))])
    squares = numpy.tile(ORDERS**2, 2)
    drive = numpy.zeros(2 * len(ORDERS))
    drive[0] = DRIVE_FORCE
    natural = numpy.sqrt(stiffness / MASS) / (2 * numpy.pi)
    rows = []
    for frequency in natural * numpy.linspace(0.3, 1.5, count):
        inertia = MASS * (2 * numpy.pi * frequency) ** 2

        def lack(unknowns):
            force = masing(unknowns @ waves * unit, loading)
            return (waves @ force * 2 / INSTANTS - inertia * squares * unknowns * unit - drive) / DRIVE_FORCE

        unit = DRIVE_FORCE / stiffness
        start = numpy.zeros_like(drive)
        start[0], start[len(ORDERS)] = 1 / (1 - inertia / stiffness + 0.1), 0.1
        found = root(lack, rows[-1][3] if rows else start, tol=1e-9)
        if not found.success:
            found = root(lack, start, method="lm", tol=1e-9)
        first = unit * (found.x[0] + 1j * found.x[len(ORDERS)])
        rows.append((frequency, abs(first), numpy.degrees(numpy.angle(first)), found.x))
    return pandas.DataFrame([row[:3] for row in rows], columns=["frequency", "amplitude", "phase"])


if __name__ == "__main__":
    service = sys.argv[1] if len(sys.argv) > 1 else "http://localhost:8080"
    print(response(cycles(service)).to_csv(index=False), end="")
