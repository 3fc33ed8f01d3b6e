"""What follows from the same mechanics: wear, shear strength, conductance, sliders, rolling."""

import numpy as np
from mpmath import acos, asin, mp, mpf, pi, quad, sin, sqrt

from found.common import near, out, problem, root
from found.tangential import BALL, BALL_TEXT, Ball


def wear_limit():
    d = r = mpf(1)
    u0 = mpf(0.36)
    c = sqrt(d - u0)
    load = 2 * quad(lambda x: d - x * x / r, [0, c])
    near(load, 2 * (d * c - c**3 / 3), 25, "load after wear")

    def shape(s):
        # (2/pi) [int_0^c g/sqrt(s^2 - x^2) dx + d acos(c/s)]
        turn = asin(c / s)
        return 2 / pi * (s * s / r * (turn / 2 - sin(2 * turn) / 4) + d * acos(c / s))

    edge = root(lambda s: s * s / (2 * r) - shape(s), mpf("1.05"), mpf("1.2"))
    volume = quad(lambda s: 2 * pi * s * (shape(s) - s * s / (2 * r)), [c, edge])
    again = 2 / pi * (quad(lambda x: x * x / r / sqrt(1 - x * x), [0, c]) + d * acos(c))
    near(shape(mpf(1)), again, 15, "worn shape")

    # By layers: what is left at a height, between two radii.
    def layer(v):
        # s = c + v^2: the slope begins like a square root.
        s = c + v * v
        return mp.diff(lambda t: shape(t) - t * t / 2, s, h=mpf(10) ** -14 * v * v) * pi * (edge**2 - s * s) * 2 * v

    slope = quad(layer, [mpf(10) ** -12, sqrt(edge - c)])
    near(volume, slope, 8, "worn volume")
    modulus = 1e11
    inputs = {
        "radius": 1.0,
        "e_star": modulus,
        "g_star": modulus,
        "friction": 1.0,
        "indentation": 1.0,
        "displacement_amplitude": 0.36,
    }
    outputs = {
        "stick_radius": out("m", c),
        "worn_radius": out("m", edge),
        "normal_force": out("N", modulus * load),
        "force_amplitude": out("N", 2 * modulus * c * u0),
        "removed_volume": out("m^3", volume),
    }
    return problem(
        "wear-limit",
        "What fretting wear leaves of a ball",
        BALL_TEXT
        + "At the constant indentation `indentation` the ball swings by `displacement_amplitude` for ever, and"
        " wears wherever it slips under pressure. Asked, in the limit: stick radius c, outer radius of what was worn,"
        " normal force, tangential force amplitude and the volume that is gone.",
        "Inside c, mu (E*/G*) (d - g(c)) = U0, the transformed profile g stays; outside it becomes d; its inverse"
        " transform is the shape.",
        "The shape by quadrature, the volume by parts.",
        ["Popov 2014, 10.1038/srep03749"],
        [{"name": "ball", "inputs": inputs, "outputs": outputs}],
    )


def shear_strength():
    modulus, shear, mu, tau, r, a = mpf(1.15e11), mpf(8.5e10), mpf(0.3), mpf(2e8), mpf(0.01), mpf(7e-5)
    load = float(f"{float(4 * modulus * a**3 / (3 * r)):.9e}")
    a = (3 * mpf(load) * r / (4 * modulus)) ** (mpf(1) / 3)
    m = mu * modulus / shear
    drive, forces = [], []

    def bound(x):
        return m * (a * a - x * x) / r + 2 * tau / shear * sqrt(a * a - x * x)

    for part in (0.9, 0.5, 0.2):
        drive.append(float(f"{float(bound(a * mpf(part))):.9e}"))
    for u in drive:
        c = root(lambda x, u=u: mpf(u) - bound(x), 0, a)
        force = mu * mpf(load) * (1 - (c / a) ** 3) + 2 * tau * (a * a * acos(c / a) + c * sqrt(a * a - c * c))
        forces.append(force)
        near(force, 2 * shear * (mpf(u) * c + quad(bound, [c, a])), 18, "shear strength")
    limit = mu * mpf(load) + pi * a * a * tau
    inputs = {**BALL, "normal_force": load, "shear_strength": float(tau), "displacements": drive}
    return problem(
        "shear-strength",
        "A shear strength beside friction",
        BALL_TEXT.replace("|tau| <= mu p", "|tau| <= tau_0 + mu p with tau_0 = `shear_strength`")
        + "Under constant F_N the ball is moved to each of `displacements`, which grow. Asked: the tangential force.",
        "F = mu F_N (1 - (c/a)^3) + 2 tau_0 (a^2 acos(c/a) + c sqrt(a^2 - c^2)), c from the displacement.",
        "The integral over the clamped displacement of the surface.",
        ["Bowden & Tabor 1950", "Savkoor & Briggs 1977"],
        [{"name": "ball", "inputs": inputs, "outputs": {"force": out("N", *forces, scale=limit)}}],
    )


def conductance():
    body = {"youngs_modulus": 1.2e11, "poisson_ratio": 0.34, "resistivity": 1e-7, "conductivity": 390.0}
    modulus = mpf(body["youngs_modulus"]) / (2 * (1 - mpf(body["poisson_ratio"]) ** 2))
    loads, r = [0.1, 10.0, 1000.0], mpf(0.01)
    radii = [(3 * mpf(load) * r / (4 * modulus)) ** (mpf(1) / 3) for load in loads]
    electrical = [4 * a / (2 * mpf(1e-7)) for a in radii]
    thermal = [4 * a / (2 / mpf(390.0)) for a in radii]
    for load, a, value in zip(loads, radii, electrical):
        # Barber: 2 F_N'(d)/(E* (rho_1 + rho_2)), F_N' by a difference.
        stiffness = mp.diff(lambda d: mpf(4) / 3 * modulus * sqrt(r) * d ** (mpf(3) / 2), a * a / r)
        near(value, 2 * stiffness / (modulus * 2 * mpf(1e-7)), 15, f"conductance at {load}")
    outputs = {"electrical_conductance": out("S", *electrical), "thermal_conductance": out("W/K", *thermal)}
    inputs = {"radius": 0.01, "body": body, "normal_forces": loads}
    return problem(
        "conductance",
        "Electrical and thermal conductance of a ball on a flat",
        "A ball of `radius` on a half-space of the same material (`body`), pressed by each of"
        " `normal_forces`. No films,"
        " no roughness: the constriction alone. Asked: conductance at each.",
        "4 a over the sum of the resistivities, with Hertz's contact radius a.",
        "From the normal stiffness, 2 F_N'(d)/(E* (rho_1 + rho_2)).",
        ["Holm 1967", "Barber 2003"],
        [{"name": "ball", "inputs": inputs, "outputs": outputs}],
    )


def sliders():
    ball = Ball(10.0)
    limit, full, count = 10 * ball.mu, ball.m * ball.d, 10

    def beyond(t, error):
        """Over t = 1 - u/u_max the force is 1 - t^(3/2): where the chord from t on has this error."""

        def excess(end):
            slope = (end**1.5 - t**1.5) / (end - t)
            middle = (2 * slope / 3) ** 2
            return t**1.5 + slope * (middle - t) - middle**1.5 - error

        return root(excess, t * (1 + mpf(10) ** -12) + mpf(10) ** -15, 2)

    def ends(error):
        """The knots from the last one, u_max, with the same error everywhere."""
        t = [mpf(0)]
        for _ in range(count):
            t.append(beyond(t[-1], error))
        return t

    low, high = mpf(1) / (8 * count**2), mpf(1) / (5 * count**2)
    for _ in range(90):
        error = (low + high) / 2
        low, high = (error, high) if ends(error)[-1] < 1 else (low, error)
    t = ends(error)
    knots = [full * (1 - part) for part in reversed(t[:-1])]

    def force(u):
        return limit * (1 - max(1 - u / full, mpf(0)) ** (mpf(3) / 2))

    curve = [(mpf(0), mpf(0)), *((u, force(u)) for u in knots)]
    slopes = [(f1 - f0) / (u1 - u0) for (u0, f0), (u1, f1) in zip(curve, curve[1:])] + [mpf(0)]
    slip = [(slopes[i] - slopes[i + 1]) * knots[i] for i in range(count)]
    near(mp.fsum(slip), limit, 25, "sliders")
    near(mpf(4) / 27 * t[1] ** 1.5, error, 20, "last chord")
    places = np.linspace(0, 1, 2_000_001)
    chords = np.interp(places, [float(u / full) for u, _ in curve], [float(f / limit) for _, f in curve])
    near(mpf(float((1 - (1 - places) ** 1.5 - chords).max())), error, 8, "error of sliders")
    outputs = {"displacement": out("m", *knots), "slip_force": out("N", *slip), "force_error": out("1", error)}
    inputs = {**BALL, "normal_force": 10.0, "count": count}
    return problem(
        "sliders",
        "Ten springs with friction caps that move like a ball",
        BALL_TEXT
        + "Its first loading is replaced by a polygon with its knots on the curve, the last at gross slip, and"
        " with N = `count` sides that all err by as much: N springs with caps in parallel (Jenkins, Iwan). Asked:"
        " displacements at which they slip, their slip forces, and the largest error of the force on first"
        " loading over mu F_N.",
        "The error by halving, each side by halving, 40 digits.",
        "The slip forces add up to mu F_N; the error on two million places, to 8 digits.",
        ["Iwan 1966, 10.1115/1.3625199"],
        [{"name": "ball", "inputs": inputs, "outputs": outputs}],
    )


def rolling():
    load, length, mu, modulus, r = 1000.0, 0.01, 0.3, mpf(1.15e11), mpf(0.025)
    a = sqrt(4 * mpf(load) / length * r / (pi * modulus))
    ratios = [0.2, 0.5, 0.9]
    creep = [mu * a / r * (1 - sqrt(1 - mpf(q))) for q in ratios]
    sticks = [2 * a * sqrt(1 - mpf(q)) for q in ratios]
    for q, width in zip(ratios, sticks):
        # What the inner ellipse takes away is what is missing to full sliding.
        near((width / 2 / a) ** 2, 1 - mpf(q), 25, "rolling")
    outputs = {"creep": out("1", *creep), "stick_width": out("m", *sticks)}
    inputs = {
        "radius": 0.025,
        "length": length,
        "e_star": float(modulus),
        "friction": mu,
        "normal_force": load,
        "ratios": ratios,
    }
    return problem(
        "rolling",
        "Carter: a cylinder that rolls",
        "A cylinder of `radius` R and `length` L rolls steadily on a half-space (like bodies) under F_N, and"
        " drives with"
        " each of `ratios` times mu F_N. Asked: creep, and width of the stick zone at the leading edge.",
        "creep = (mu a/R) (1 - sqrt(1 - Q/(mu F_N))), width 2 a sqrt(1 - Q/(mu F_N)).",
        "The force of the two ellipses.",
        ["Carter 1926, 10.1098/rspa.1926.0100"],
        [{"name": "cylinder", "inputs": inputs, "outputs": outputs}],
    )
