"""Figure 5 of Kraft & Pohrt (2016): peaks of the remaining shear stress against the number of reversals.

    python figure5.py [URL] > figure5.csv

Needs `requests` and `pandas`. Each row is one call of POST /simulate; nothing is kept on the server.
"""

import sys

import pandas
import requests

CONTACT = {
    "profile": {"type": "sphere", "radius": 0.01},
    "material": {
        "bodies": [{"youngs_modulus": 2.1e11, "poisson_ratio": 0.3}, {"youngs_modulus": 2.1e11, "poisson_ratio": 0.3}]
    },
    "friction": 0.3,
    "preload": {"normal_force": 10.0},
}


def remaining(service, reversals):
    """Largest, mean and smallest peak of the remaining stress after so many reversals, over mu p_max."""
    reply = requests.post(
        f"{service}/simulate",
        json={
            "contact": CONTACT,
            "path": {"falling_amplitude": {"reversals": reversals}},
            "steps": "last",
            "residual": True,
        },
        timeout=30,
    )
    reply.raise_for_status()
    found = reply.json()
    unit = CONTACT["friction"] * found["contact"]["max_pressure"]
    return {"reversals": reversals} | {name: found["residual"][name] / unit for name in ("max", "mean", "min")}


def figure5(service, last=40):
    """The figure as a table."""
    return pandas.DataFrame([remaining(service, reversals) for reversals in range(1, last + 1)])


if __name__ == "__main__":
    print(figure5(sys.argv[1] if len(sys.argv) > 1 else "http://localhost:8080").to_csv(index=False), end="")
