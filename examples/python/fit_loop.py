"""From the CSV of a bench to the coefficient of friction, the stiffness and the compliance of the machine.

    python fit_loop.py [URL] > estimates.csv

Needs `requests` and `pandas`. Writes the picture of the fit to loop.svg if asked: `python fit_loop.py URL loop.svg`.
"""

import sys
from pathlib import Path

import pandas
import requests

FILE = Path(__file__).parent.parent / "data" / "ball_loop.csv"
CONTACT = {
    "profile": {"type": "sphere", "radius": 0.01},
    "material": {"bodies": [{"youngs_modulus": 2.1e11, "poisson_ratio": 0.3}, "rigid"]},
    "friction": 0.3,  # where the search begins
    "preload": {"normal_force": 10.0},
}
FREE = ["friction", "g_star", "machine_compliance", "force_offset"]


def read(file=FILE):
    """The columns of the bench: time in s, displacement in um, force in N."""
    table = pandas.read_csv(file, sep=";", decimal=",", comment="#")
    return table.set_axis(["time", "displacement", "force"], axis="columns")


def request(loop, free=FREE, known=None):
    """The body of POST /fit for one steady loop."""
    return {
        "contact": CONTACT,
        "loops": [
            {"displacement": loop["displacement"].tolist(), "force": loop["force"].tolist(), "start": "steady"}
        ],
        "units": {"displacement": "um", "force": "N"},
        "free": free,
        "known": known or {},
    }


def fit(service, body, **params):
    """The reply of POST /fit; with `format="svg"` the picture."""
    reply = requests.post(f"{service}/fit", json=body, params=params, timeout=60)
    reply.raise_for_status()
    return reply.text if params else reply.json()


def estimates(found):
    """What was found, with the intervals at 95 %."""
    rows = [
        {"name": name, "value": one["value"], "low": one["interval"][0], "high": one["interval"][1]}
        for name, one in found["estimates"].items()
    ]
    return pandas.DataFrame(rows)


if __name__ == "__main__":
    url = sys.argv[1] if len(sys.argv) > 1 else "http://localhost:8080"
    asked = request(read())
    answer = fit(url, asked)
    for warning in answer["warnings"]:
        print(f"{warning['code']}: {warning['message']}", file=sys.stderr)
    print(estimates(answer).to_csv(index=False), end="")
    if len(sys.argv) > 2:
        Path(sys.argv[2]).write_text(fit(url, asked, format="svg"))
