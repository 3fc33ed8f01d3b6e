"""Stress below a ball."""

import numpy as np
from mpmath import atan, mp, mpf, pi, sqrt

from found.common import near, out, problem
from found.tangential import BALL_TEXT


def point_forces(x, y, z, nu):
    """The stresses (xx yy zz xy yz xz) of unit forces along z (Boussinesq) and along x (Cerruti) at the origin."""
    rho = np.sqrt(x * x + y * y + z * z)
    s, k = rho + z, 1 - 2 * nu
    r3, r5 = rho**3, rho**5
    normal = [
        -3 * x * x * z / r5 + k * (z / r3 - 1 / (rho * s) + x * x * (2 * rho + z) / (r3 * s * s)),
        -3 * y * y * z / r5 + k * (z / r3 - 1 / (rho * s) + y * y * (2 * rho + z) / (r3 * s * s)),
        -3 * z**3 / r5,
        -3 * x * y * z / r5 + k * x * y * (2 * rho + z) / (r3 * s * s),
        -3 * y * z * z / r5,
        -3 * x * z * z / r5,
    ]
    along = [
        -3 * x**3 / r5 + k * (x / r3 - 3 * x / (rho * s * s) + x**3 / (r3 * s * s) + 2 * x**3 / (rho**2 * s**3)),
        -3 * x * y * y / r5
        + k * (x / r3 - x / (rho * s * s) + x * y * y / (r3 * s * s) + 2 * x * y * y / (rho**2 * s**3)),
        -3 * x * z * z / r5,
        -3 * x * x * y / r5 + k * (-y / (rho * s * s) + x * x * y / (r3 * s * s) + 2 * x * x * y / (rho**2 * s**3)),
        -3 * x * y * z / r5,
        -3 * x * x * z / r5,
    ]
    return np.array(normal) / (2 * np.pi), np.array(along) / (2 * np.pi)


def ellipsoids(point, nu, normal, tangential, count):
    """The stress at a point under sums of h sqrt(1 - r^2/c^2), Gauss in the angle of r = c sin t, even steps around."""
    nodes, weights = np.polynomial.legendre.leggauss(count)
    t, weights = (nodes + 1) * np.pi / 4, weights * np.pi / 4
    around = 2 * np.pi * np.arange(2 * count) / (2 * count)
    total = np.zeros(6)
    for index, layers in enumerate((normal, tangential)):
        for height, width in layers:
            r = width * np.sin(t)[:, None]
            x, y = r * np.cos(around), r * np.sin(around)
            force = height * np.cos(t)[:, None] * r * width * np.cos(t)[:, None] * weights[:, None] * np.pi / count
            kernel = point_forces(point[0] - x, point[1] - y, point[2], nu)[index]
            total += (kernel * force).sum(axis=(1, 2))
    return total


def stress_in_depth():
    nu, mu = 0.3, 0.5
    moves, full = [0.4, -0.25, 0.05], mpf(mu)
    points = [[0.5, 0.3, 0.4], [-0.9, 0.0, 0.15], [0.0, 0.0, 0.5], [1.2, -0.4, 0.3]]
    # a = d = R = p_max = 1, E* = G* = pi/2, m = mu: first loading to 0.4, then two strokes by half their way.
    w = [mpf(u) / full for u in moves]
    strokes = [(1, w[0]), (-2, (w[0] - w[1]) / 2), (2, (w[2] - w[1]) / 2)]
    layers = []
    for factor, part in strokes:
        c = sqrt(1 - part)
        layers += [(factor * mu, 1.0), (float(-factor * mu * c), float(c))]
    fields = np.array([ellipsoids(point, nu, [(1.0, 1.0)], layers, 160) for point in points])
    again = np.array([ellipsoids(point, nu, [(1.0, 1.0)], layers, 230) for point in points])
    assert np.abs(fields - again).max() < 1e-13, np.abs(fields - again).max()

    def on_axis(z):
        turn = 1 - z * atan(1 / z)
        return -(1 + mpf(nu)) * turn + 1 / (2 * (1 + z * z)), -1 / (1 + z * z)

    radial, axial = on_axis(mpf("0.5"))
    hertz = ellipsoids([0.0, 0.0, 0.5], nu, [(1.0, 1.0)], [], 160)
    assert abs(hertz[0] - float(radial)) < 1e-13
    assert abs(hertz[2] - float(axial)) < 1e-13
    depth = mp.findroot(lambda z: mp.diff(lambda t: on_axis(t)[0] - on_axis(t)[1], z), mpf("0.48"))
    radial, axial = on_axis(depth)
    near(depth, mpf("0.480864485292895"), 14, "depth of the worst place")
    names = ("xx", "yy", "zz", "xy", "yz", "xz")
    outputs = {name: out("Pa", *fields[:, index], scale=1.0) for index, name in enumerate(names)}
    shared = {
        "radius": 1.0,
        "e_star": float(pi / 2),
        "g_star": float(pi / 2),
        "friction": mu,
        "indentation": 1.0,
        "poisson_ratio": nu,
    }
    worst = {**shared, "displacements": [0.0], "points": [[0.0, 0.0, float(depth)]]}
    return problem(
        "stress-in-depth",
        "Stress below a ball after three strokes, and its worst place under normal load",
        BALL_TEXT
        + "From the indentation `indentation` the ball, as the first body, is moved to each of `displacements`."
        " Asked at `points` (x, y, z; z into the half-space, the second body, whose Poisson's ratio is"
        " `poisson_ratio`, and on"
        " which the shear traction of a positive displacement acts along x): the stress, tension positive. In"
        " the second case, von Mises's stress"
        " at the point where it is largest.",
        "Boussinesq's and Cerruti's point forces summed over the tractions, which are ellipsoids, by 160"
        " Gauss points and"
        " 320 angles in doubles (agreement with 230 and 460: 1e-13 of the largest pressure).",
        "On the axis, closed forms of Hertz's pressure, whose difference is largest at 0.480864485293 of the radius.",
        ["Hamilton & Goodman 1966", "Johnson 1985, 10.1017/CBO9781139171731"],
        [
            {
                "name": "three strokes",
                "inputs": {**shared, "displacements": moves, "points": points},
                "outputs": outputs,
            },
            {"name": "worst place", "inputs": worst, "outputs": {"von_mises": out("Pa", radial - axial)}},
        ],
    )
