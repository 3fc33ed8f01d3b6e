"""A ball that strikes a plane obliquely."""

import numpy as np
from mpmath import beta, mpf

from found.common import near, out, problem
from found.tangential import BALL, BALL_TEXT

MASS, SPEED = 0.033, 0.1


def depths(count):
    """The indentation over an impact at even times, m, and their distance, s: Runge and Kutta's rule of order four."""
    r, e = BALL["radius"], BALL["e_star"]
    k = 4 / 3 * e * r**0.5 / MASS
    # d'' = -k d^(3/2): the time is an integral over d that is a beta function.
    deepest = (5 * SPEED**2 / (4 * k)) ** 0.4
    duration = float(mpf(4) / 5 * beta(mpf(2) / 5, mpf(1) / 2)) * deepest / SPEED
    h, found, d, v = duration / count, [0.0], 0.0, SPEED

    def pull(x):
        return -k * max(x, 0.0) ** 1.5

    # Finer than the steps of the path, for its beginning is not smooth.
    finer = max(1, 60_000 // count)
    h /= finer
    for index in range(count // 2 * finer):
        k1, l1 = v, pull(d)
        k2, l2 = v + h / 2 * l1, pull(d + h / 2 * k1)
        k3, l3 = v + h / 2 * l2, pull(d + h / 2 * k2)
        k4, l4 = v + h * l3, pull(d + h * k3)
        d, v = d + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4), v + h / 6 * (l1 + 2 * l2 + 2 * l3 + l4)
        if index % finer == finer - 1:
            found.append(d)
    near(d, deepest, 12, "deepest")
    return found + found[-2::-1], h * finer, duration


def rebound(tangential, path, h):
    """The tangential velocity of the surface after the impact, by the slip history in doubles (see `tangential`)."""
    r, g, mu = BALL["radius"], BALL["g_star"], BALL["friction"]
    m = mu * BALL["e_star"] / g
    # A solid ball turns as well: its surface has the inertia of 2/7 of the mass.
    mass = 2 / 7 * MASS
    # Nodes: level y, w less the displacement, and the integral of that over x up to the node.
    nodes, d0, moved, velocity = [(0.0, 0.0, 0.0)], 0.0, 0.0, tangential

    def push(y, value):
        y0, v0, total = nodes[-1]
        if y > y0:
            slope = (value - v0) / (y - y0)
            x0, x1 = (y0 * r) ** 0.5, (y * r) ** 0.5
            nodes.append((y, value, total + (v0 - slope * y0) * (x1 - x0) + slope * (x1**3 - x0**3) / (3 * r)))

    for d in path[1:]:
        before, moved = moved, moved + h * velocity / m
        if d <= 0:
            break
        step = moved - before
        beyond = (d, -moved)
        while nodes and nodes[-1][0] > d:
            beyond = nodes.pop()
        if d < d0:
            # The contact shrinks: cut at the new edge.
            (y0, v0, _), (y1, v1) = nodes[-1], beyond[:2]
            push(d, v0 + (v1 - v0) * (d - y0) / (y1 - y0))
            edge = nodes[-1][1] + moved
        else:
            edge = step if abs(step) > d - d0 else 0.0
        if edge:
            s = 1.0 if edge > 0 else -1.0
            popped = None
            while nodes and s * (nodes[-1][1] + moved) > d - nodes[-1][0]:
                popped = nodes.pop()
            if popped and nodes:
                (y0, v0, _), (y1, v1, _) = nodes[-1], popped
                over = s * (v1 + moved) - (d - y1)
                room = (d - y0) - s * (v0 + moved)
                part = room / (room + over)
                push(y0 + (y1 - y0) * part, v0 + (v1 - v0) * part)
            elif not nodes:
                nodes.append((0.0, s * d - moved, 0.0))
        push(d, -moved)
        x = (nodes[-1][0] * r) ** 0.5
        velocity -= h * 2 * g * m * (nodes[-1][2] + moved * x) / mass
        d0 = d
    return velocity


def by_springs(tangential, path, h, count=2000):
    """The same by independent springs."""
    r, e, g, mu = (BALL[name] for name in ("radius", "e_star", "g_star", "friction"))
    width = (max(path) * r) ** 0.5 / count
    level = ((np.arange(count) + 0.5) * width) ** 2 / r
    u, velocity, before = np.zeros(count), tangential, 0.0
    for d in path[1:]:
        step = h * velocity
        part = np.clip((d - level) / max(d - before, 1e-300), 0, 1) if d > before else 1.0
        room = mu * e / g * np.maximum(d - level, 0)
        u = np.clip(u + step * part, -room, room)
        velocity -= h * 2 * g * width * float(u.sum()) / (2 / 7 * MASS)
        before = d
    return velocity


def oblique_impact():
    scale = BALL["friction"] * BALL["e_star"] / BALL["g_star"] * SPEED
    velocities = [float(f"{scale * part:.6e}") for part in (0.5, 1.5, 3.0, 5.0)]
    rows = []
    for count in (256_000, 512_000):
        path, h, duration = depths(count)
        rows.append([rebound(velocity, path, h) for velocity in velocities])
    # The error is that of a second order.
    found = [fine + (fine - coarse) / 3 for coarse, fine in zip(*rows)]
    for value, fine in zip(found, rows[1]):
        assert abs(value - fine) < 1e-10 * scale, (value, fine)
    path, h, _ = depths(8000)
    for value, velocity in zip(found, velocities):
        again = by_springs(velocity, path, h)
        assert abs(value - again) < 1e-6 * scale, (value, again)
    inputs = {**BALL, "mass": MASS, "normal_velocity": SPEED, "tangential_velocities": velocities}
    outputs = {"duration": out("s", duration), "rebound_velocity": out("m/s", *found)}
    return problem(
        "oblique-impact",
        "Maw, Barber and Fawcett: a ball that strikes a plane obliquely",
        BALL_TEXT
        + "A free solid ball of `mass` strikes the plane with `normal_velocity`, without spin; its surface moves along"
        " the plane with each of `tangential_velocities` before. The force acts on the surface as on a point of 2/7 of"
        " the mass; there is no loss but by friction. Asked: the duration of the impact, and the tangential velocity"
        " of the surface after it.",
        "The slip history, a line from node to node over x^2/R, stepped in 256 000 and 512 000 even times in doubles"
        " and extrapolated in second order: 10 digits. The duration is a beta function, in 40 digits.",
        "2000 independent springs in 8000 steps (NumPy); agreement to 1e-6 of mu (E*/G*) times the normal velocity.",
        ["Maw, Barber & Fawcett 1976, 10.1016/0043-1648(76)90201-5"],
        [{"name": "solid ball", "inputs": inputs, "outputs": outputs}],
        {
            "1e-2": "the surface turns back as measured; a spring with a friction cap misses it at small angles",
            "1e-4": "some hundred steps with the whole law",
            "1e-8": "ten thousand steps, with an error that is extrapolated",
        },
    )
