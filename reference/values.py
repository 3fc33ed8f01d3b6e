"""The values of the reference problems, by closed forms and quadratures in 40 digits.

    pip install mpmath numpy
    python values.py            # writes the documents beside this file
    python values.py --check    # computes everything anew and compares; writes nothing

It shares nothing with stickslip, neither code nor results. Every output is computed in a second way that uses other
formulas, `second` of each document, and nothing is written unless the two agree to the stated digits. Inputs are
doubles at their exact values.
"""

import json
import sys
from pathlib import Path

import numpy as np
from mpmath import acos, acosh, asin, atan, atanh, cos, ellipe, ellipk, gamma, inf, log, mp, mpf, pi, quad, sin, sqrt

mp.dps = 40
VERSION = "1.0.0"
FOLDER = Path(__file__).parent


def near(first, second, digits, what):
    """Both ways agree, relative to the larger."""
    error = abs(mpf(first) - mpf(second)) / max(abs(mpf(first)), abs(mpf(second)), mpf(10) ** -300)
    assert error < mpf(10) ** -digits, f"{what}: {first} and {second} differ by {mp.nstr(error, 3)}"


def root(f, low, high):
    """The root of a function that grows, by halving."""
    low, high = mpf(low), mpf(high)
    assert f(low) < 0 < f(high), "no root"
    for _ in range(150):
        middle = (low + high) / 2
        low, high = (middle, high) if f(middle) < 0 else (low, middle)
    return middle


def out(unit, *values, scale=None):
    """An output as it stands in a document: 17 digits, and what errors are relative to."""
    values = [float(value) for value in values]
    return {"unit": unit, "values": values, "scale": float(scale) if scale else max(abs(value) for value in values)}


def problem(name, title, statement, found, second, sources, cases, meaning=None):
    """A document."""
    meaning = meaning or {
        "1e-2": "as good as the finite elements and grids of everyday use",
        "1e-4": "no measurement distinguishes the answer from the exact one",
        "1e-8": "the code solves the equations themselves, or a discretisation that converges fast",
    }
    return {
        "suite": "stickslip reference",
        "version": VERSION,
        "id": name,
        "title": title,
        "statement": statement,
        "errors": "An error is the largest difference from `values`, divided by `scale`.",
        "meaning": meaning,
        "found": found,
        "second": second,
        "sources": sources,
        "cases": cases,
    }


# --------------------------------------------------------------------------------------------------- normal contact


class Shape:
    """g, g' and F_N/E* over the contact radius, of a body of revolution f(r) with slope f'(r)."""

    def __init__(self, slope, g, load, core=0, rise=None):
        self.slope, self.g, self.load, self.core = slope, g, load, mpf(core)
        self.rise = rise or (lambda x: mp.diff(self.g, x, h=mpf(10) ** -14))


def shapes():
    """The families, with numbers: the name, the document of the profile, and its functions."""
    big, tip, slope = mpf(0.01), mpf(2e-5), mpf(0.05)

    def sphere(x):
        return x * x / big

    n, c = mpf(3), mpf(1000.0)
    kappa = sqrt(pi) * gamma(n / 2 + 1) / gamma((n + 1) / 2)

    def arc(x):
        return acos(tip / x) if x > tip else mpf(0)

    def cut(x):
        return sqrt(x * x - tip * tip) if x > tip else mpf(0)

    def rounded(a):
        phi = arc(a)
        return a**3 / (3 * big) * (sin(phi) * (4 - cos(phi) ** 2) - 3 * phi * cos(phi))

    def blunt_g(x):
        return slope * x * (x / tip if x <= tip else (x - cut(x)) / tip + arc(x))

    def blunt(a):
        phi = arc(a)
        less = (1 - sin(phi)) / cos(phi)
        return a * a * slope * (phi + mpf(4) / 3 * less + sin(phi) * cos(phi) / 3)

    def arc_load(a):
        return (big**2 + a * a) * atanh(a / big) - a * big

    yield "sphere", {"type": "sphere", "radius": 0.01}, Shape(lambda r: r / big, sphere, lambda a: 4 * a**3 / (3 * big))
    yield (
        "power law",
        {"type": "power_law", "exponent": 3, "coefficient": 1000.0},
        Shape(
            lambda r: n * c * r ** (n - 1),
            lambda x: kappa * c * x**n,
            lambda a: 2 * n / (n + 1) * kappa * c * a ** (n + 1),
        ),
    )
    yield (
        "cone",
        {"type": "cone", "slope": 0.05},
        Shape(lambda r: slope, lambda x: pi * slope * x / 2, lambda a: pi * slope * a * a / 2),
    )
    yield (
        "exact sphere",
        {"type": "exact_sphere", "radius": 0.01},
        Shape(lambda r: r / sqrt(big * big - r * r), lambda x: x * atanh(x / big), arc_load),
    )
    yield (
        "truncated cone",
        {"type": "truncated_cone", "slope": 0.05, "flat_radius": 2e-5},
        Shape(
            lambda r: slope if r > tip else mpf(0),
            lambda x: slope * x * arc(x),
            lambda a: slope * a * a * (arc(a) + sin(arc(a)) * cos(arc(a))),
            tip,
            lambda x: slope * (arc(x) + tip / cut(x)) if x > tip else mpf(0),
        ),
    )
    yield (
        "truncated sphere",
        {"type": "truncated_sphere", "radius": 0.01, "flat_radius": 2e-5},
        Shape(
            lambda r: r / big if r > tip else mpf(0),
            lambda x: x / big * cut(x),
            lambda a: 2 / (3 * big) * (2 * a * a + tip * tip) * cut(a),
            tip,
            lambda x: (2 * x * x - tip * tip) / (big * cut(x)) if x > tip else mpf(0),
        ),
    )
    yield (
        "rounded punch",
        {"type": "rounded_punch", "flat_radius": 2e-5, "edge_radius": 0.01},
        Shape(
            lambda r: (r - tip) / big if r > tip else mpf(0), lambda x: x / big * (cut(x) - tip * arc(x)), rounded, tip
        ),
    )
    yield (
        "rounded cone",
        {"type": "rounded_cone", "slope": 0.05, "tip_radius": 2e-5},
        Shape(lambda r: slope * min(r / tip, 1), blunt_g, blunt, tip),
    )


def transformed(shape, x):
    """g from its definition, x int_0^x f'(r)/sqrt(x^2 - r^2) dr with r = x sin t."""
    turns = [mpf(0), pi / 2] if not 0 < shape.core < x else [mpf(0), asin(shape.core / x), pi / 2]
    return x * quad(lambda t: shape.slope(x * sin(t)), turns)


def pressure_at(shape, r, a):
    """(E*/pi) int_r^a g'(x)/sqrt(x^2 - r^2) dx over E*, with x^2 = r^2 + v^2."""
    ends = [mpf(0), sqrt(a * a - r * r)]
    if r < shape.core < a:
        ends.insert(1, sqrt(shape.core**2 - r * r))
    return quad(lambda v: shape.rise(sqrt(r * r + v * v)) / sqrt(r * r + v * v), ends) / pi


def by_slopes(shape, r, a):
    """The same pressure by Schubert's other order: the slope of -(1/pi) d/dr int_r^a x (d - g)/sqrt(x^2 - r^2) dx."""

    def inside(r):
        ends = [mpf(0), sqrt(a * a - r * r)]
        if r < shape.core < a:
            ends.insert(1, sqrt(shape.core**2 - r * r))
        return quad(lambda v: shape.g(a) - shape.g(sqrt(r * r + v * v)), ends)

    return -mp.diff(inside, r, h=mpf(10) ** -14) / (pi * r)


def normal_contact():
    modulus, load, cases = 1.15e11, 10.0, []
    for name, profile, shape in shapes():
        low = max(shape.core, mpf(10) ** -7)
        a = root(lambda a, s=shape: s.load(a) - mpf(load) / mpf(modulus), low * (1 + mpf(10) ** -9), mpf(10) ** -3)
        d = shape.g(a)
        near(d, transformed(shape, a), 25, name)
        ends = [0, shape.core, a] if shape.core else [0, a]
        near(mpf(load), 2 * mpf(modulus) * quad(lambda x, s=shape, d=d: d - s.g(x), ends), 20, name)
        radii = [float(a * part) for part in (0.3, 0.6, 0.9)]
        pressures = [mpf(modulus) * pressure_at(shape, mpf(r), a) for r in radii]
        near(pressures[1], mpf(modulus) * by_slopes(shape, mpf(radii[1]), a), 12, name)
        outputs = {
            "contact_radius": out("m", a),
            "indentation": out("m", d),
            "pressure": out("Pa", *pressures),
        }
        inputs = {"profile": profile, "e_star": modulus, "normal_force": load, "radii": radii}
        cases.append({"name": name, "inputs": inputs, "outputs": outputs})
    b = mpf(1e-4)
    radii = [3e-5, 6e-5, 9e-5]
    d = mpf(load) / (2 * mpf(modulus) * b)
    pressures = [mpf(modulus) * d / (pi * sqrt(b * b - mpf(r) ** 2)) for r in radii]
    near(quad(lambda t: 2 * pi * mpf(modulus) * d / pi * b * sin(t), [0, pi / 2]), load, 25, "flat punch")
    outputs = {"contact_radius": out("m", b), "indentation": out("m", d), "pressure": out("Pa", *pressures)}
    inputs = {
        "profile": {"type": "flat_punch", "radius": 1e-4},
        "e_star": modulus,
        "normal_force": load,
        "radii": radii,
    }
    cases.append({"name": "flat punch", "inputs": inputs, "outputs": outputs})
    cases.append(ellipsoid(modulus, load))
    return problem(
        "normal-contact",
        "Normal contact without friction of bodies of revolution, and of an ellipsoid",
        "A rigid indenter of shape z = f(r) is pressed into an elastic half-space of modulus E* (`e_star`) by F_N"
        " (`normal_force`). Shapes, with `radius` R, `slope` T, `flat_radius` or `tip_radius` b: sphere f = r^2/(2R);"
        " power_law f = coefficient r^exponent; cone f = T r; exact_sphere f = R - sqrt(R^2 - r^2); flat_punch f = 0 up"
        " to its radius; truncated_cone f = T (r - b) and truncated_sphere f = (r^2 - b^2)/(2R), both 0 for r < b;"
        " rounded_punch f = (r - b)^2/(2 edge_radius), 0 for r < b; rounded_cone f' = T min(r/b, 1); ellipsoid f ="
        " x^2/(2 R_x) + y^2/(2 R_y). Asked: contact radius a, indentation d, and pressure at `radii`; of the ellipsoid"
        " the indentation.",
        "The closed form of F_N(a) solved for a, d = g(a), and p(r) = (E*/pi) int_r^a g'(x)/sqrt(x^2 - r^2) dx by"
        " quadrature in 40 digits; for the ellipsoid Hertz's elliptic integrals.",
        "g by its definition x int_0^x f'(r)/sqrt(x^2 - r^2) dr; F_N = 2 E* int_0^a (d - g) dx; the pressure as a"
        " numerical derivative (12 digits); for the ellipsoid the potential of its pressure by quadrature.",
        ["Sneddon 1965", "Johnson 1985, Contact Mechanics, 10.1017/CBO9781139171731"],
        cases,
        {
            "1e-2": "a grid of some sixty cells along the radius: the pressure falls like a square root at the edge",
            "1e-4": "a mesh that is fitted to the contact edge",
            "1e-8": "a method that knows the shape of the pressure",
        },
    )


def ellipsoid(modulus, load):
    r_x, r_y = mpf(0.01), mpf(0.004)
    small, large = sorted([1 / (2 * r_x), 1 / (2 * r_y)])

    def sums(m):
        k, e = ellipk(m), ellipe(m)
        return (k - e), e / (1 - m) - k

    # The ratio of the semi-axes, then their size: A, B = p0 b/(E* a^2 m) ((K - E), (a/b)^2 E - K).
    m = root(lambda m: sums(m)[1] / sums(m)[0] - large / small, mpf("0.01"), mpf("0.99"))
    strength = 3 * mpf(load) / (2 * pi * mpf(modulus))
    a = (strength * sums(m)[0] / (m * small)) ** (mpf(1) / 3)
    b = a * sqrt(1 - m)
    d = strength / a * ellipk(m)

    def potential(power_a, power_b):
        # s = b^2 u^2 takes the root at 0 away.
        f = lambda u: (
            2
            * b
            / (
                sqrt(a * a + (b * u) ** 2)
                * sqrt(b * b + (b * u) ** 2)  # noqa: E731
                * (a * a + (b * u) ** 2) ** power_a
                * (b * b + (b * u) ** 2) ** power_b
            )
        )
        return strength / 2 * quad(f, [0, 1, 10, inf])

    for first, second in ((d, potential(0, 0)), (small, potential(1, 0)), (large, potential(0, 1))):
        near(first, second, 15, "ellipsoid")
    inputs = {"profile": {"type": "ellipsoid", "radii": [0.01, 0.004]}, "e_star": modulus, "normal_force": load}
    return {"name": "ellipsoid", "inputs": inputs, "outputs": {"indentation": out("m", d)}}


# ----------------------------------------------------------------------------------------------- tangential contact

BALL = {"radius": 0.01, "e_star": 1.15e11, "g_star": 8.5e10, "friction": 0.3}
BALL_TEXT = (
    "A ball of radius R (`radius`) touches a half-space; the moduli of the pair are 1/E* = sum (1 -"
    " nu_i^2)/E_i and 1/G* ="
    " sum (2 - nu_i)/(4 G_i), and normal and tangential contact are uncoupled. Coulomb friction |tau| <= mu p holds at"
    " every place, slip is along x. "
)


class Ball:
    """Exact inputs of BALL, and the state of partial slip as w over y = x^2/R: nodes with lines between."""

    def __init__(self, normal_force=None, indentation=None):
        self.r, self.e, self.g, self.mu = (mpf(BALL[name]) for name in ("radius", "e_star", "g_star", "friction"))
        self.m = self.mu * self.e / self.g
        if indentation is None:
            indentation = (3 * mpf(normal_force) / (4 * self.e * sqrt(self.r))) ** (mpf(2) / 3)
        self.d, self.u = mpf(indentation), mpf(0)
        self.nodes = [(mpf(0), mpf(0)), (self.d, mpf(0))]

    def load(self):
        return mpf(4) / 3 * self.e * sqrt(self.r) * self.d ** (mpf(3) / 2)

    def move(self, displacement, indentation=None):
        """Every place moves along and is then clamped to what friction bears."""
        d0, d1 = self.d, self.d if indentation is None else mpf(indentation)
        step = (mpf(displacement) - self.u) / self.m
        nodes = [(y, w + step) for y, w in self.nodes]
        if d1 > d0:
            # A place that is met on the way moves with the rest from then on.
            nodes.append((d1, mpf(0)))
        elif d1 < d0:
            kept = [node for node in nodes if node[0] < d1]
            (y0, w0), (y1, w1) = kept[-1], nodes[len(kept)]
            nodes = [*kept, (d1, w0 + (w1 - w0) * (d1 - y0) / (y1 - y0))]
        for sign in (1, -1):
            nodes = clamped(nodes, d1, sign)
        self.nodes, self.d, self.u = nodes, d1, mpf(displacement)

    def force(self):
        """2 G* int u dx, with u = m w and dx along y = x^2/R."""
        total = mpf(0)
        for (y0, w0), (y1, w1) in zip(self.nodes, self.nodes[1:]):
            if y1 > y0:
                slope = (w1 - w0) / (y1 - y0)
                x0, x1 = sqrt(y0 * self.r), sqrt(y1 * self.r)
                total += (w0 - slope * y0) * (x1 - x0) + slope * (x1**3 - x0**3) / (3 * self.r)
        return 2 * self.g * self.m * total

    def shear(self, r):
        """-(G* m/pi) int w'(x)/sqrt(x^2 - r^2) dx, where w' is a constant times 2 x/R along each line."""
        total = mpf(0)
        for (y0, w0), (y1, w1) in zip(self.nodes, self.nodes[1:]):
            if y1 > y0:
                slope = (w1 - w0) / (y1 - y0)
                reach = [sqrt(max(y * self.r - mpf(r) ** 2, 0)) for y in (y0, y1)]
                total += slope * 2 / self.r * (reach[1] - reach[0])
        return -self.g * self.m / pi * total


def clamped(nodes, d, sign):
    """sign w <= d - y: nodes beyond are cut where the lines cross the bound."""
    room = [d - y - sign * w for y, w in nodes]
    kept = []
    for index, (y, w) in enumerate(nodes):
        if index and room[index - 1] * room[index] < 0:
            y0, w0 = nodes[index - 1]
            part = room[index - 1] / (room[index - 1] - room[index])
            kept.append((y0 + (y - y0) * part, w0 + (w - w0) * part))
        kept.append((y, w if room[index] >= 0 else sign * (d - y)))
    return kept


def springs(start, path, count=400_000):
    """The forces by independent springs at midpoints, moved in 40 small steps a move; Richardson in their number."""

    def run(count):
        r, g, e, mu = (BALL[name] for name in ("radius", "g_star", "e_star", "friction"))
        m, widest = mu * e / g, np.sqrt(max([start, *(d for d, _ in path)]) * r)
        x = (np.arange(count) + 0.5) * widest / count
        y, w, d, u, forces = x * x / r, np.zeros(count), start, 0.0, []
        for target, displacement in path:
            for step in np.linspace(0, 1, 41)[1:]:
                d_now, u_now = d + (target - d) * step, u + (displacement - u) * step
                if step == 1:
                    d_now, u_now = target, displacement
                before = d + (target - d) * (step - 1 / 40)
                # What is met within the step moves from then on.
                part = np.ones(count)
                fresh = (y > before) & (y <= d_now)
                part[fresh] = (d_now - y[fresh]) / (d_now - before)
                bound = np.maximum(d_now - y, 0)
                w = np.clip(w + (displacement - u) / 40 / m * part, -bound, bound)
            d, u = target, displacement
            forces.append(2 * g * m * w.sum() * widest / count)
        return np.array(forces)

    return run(count)


SPRINGS = "400 000 independent springs, moved in 40 steps a move (NumPy); agreement to 2e-7 of mu F_N."


def compared(forces, others, limit, what, tolerance=2e-7):
    for first, second in zip(forces, others):
        assert abs(float(first) - second) < tolerance * float(limit), f"{what}: {first} {second}"


def first_loading():
    load, radii = 10.0, [float(f"{part}e-5") for part in (1, 3, 4, 5, 6, 6.5, 6.8)]
    ball = Ball(load)
    a, limit = sqrt(ball.d * ball.r), ball.mu * load
    forces = [0.75, 1.5, 2.25, 2.7, 2.99]
    shares = [mpf(force) / limit for force in forces]
    stick = [a * (1 - q) ** (mpf(1) / 3) for q in shares]
    moved = [ball.m * ball.d * (1 - (1 - q) ** (mpf(2) / 3)) for q in shares]
    for force, u in zip(forces, moved):
        ball.move(u)
        near(ball.force(), force, 25, "first loading")
    peak = 3 * load / (2 * pi * a * a)

    def ellipse(r, c):
        return sqrt(max(1 - (mpf(r) / c) ** 2, 0))

    shear = [ball.mu * peak * (ellipse(r, a) - stick[-1] / a * ellipse(r, stick[-1])) for r in radii]
    for r, tau in zip(radii, shear):
        near(tau, ball.shear(r), 20, "shear of first loading")
    outputs = {
        "displacement": out("m", *moved),
        "stick_radius": out("m", *stick),
        "shear": out("Pa", *shear, scale=ball.mu * peak),
    }
    return problem(
        "first-loading",
        "Cattaneo and Mindlin: a ball under a growing tangential force",
        BALL_TEXT + "Under constant F_N the tangential force grows from 0 through `forces`. Asked: displacement of the"
        " ball, radius of the stick zone after each, and shear stress at `radii` after the last.",
        "Closed forms: c = a (1 - Q/(mu F_N))^(1/3), U = mu (E*/G*) d (1 - (c/a)^2), tau the difference of"
        " two ellipses.",
        "The clamped displacement of the surface, integrated: force to 25 digits, stress to 20.",
        ["Cattaneo 1938", "Mindlin 1949, 10.1115/1.4009973"],
        [
            {
                "name": "ball",
                "inputs": {**BALL, "normal_force": load, "forces": forces, "radii": radii},
                "outputs": outputs,
            }
        ],
    )


def path_case(name, start, moves, limit_at=None):
    """A path straight in indentation and displacement, by nodes and by springs."""
    ball, loads, forces, limits = Ball(indentation=start), [], [], []
    for d, u in moves:
        ball.move(u, d)
        loads.append(ball.load())
        forces.append(ball.force())
        limits.append(ball.mu * ball.load())
    scale = max(limits)
    compared(forces, springs(start, moves), scale, name)
    inputs = {**BALL, "indentation": start, "moves": moves}
    outputs = {"normal_force": out("N", *loads), "force": out("N", *forces, scale=scale)}
    return {"name": name, "inputs": inputs, "outputs": outputs}


def oblique_paths():
    cases = []
    for sign, load in ((0, "constant"), (1, "growing"), (-1, "falling")):
        for turn, tangential in (
            ([2e-7, 3e-7], "loading"),
            ([2e-7, 5e-8], "unloading"),
            ([2e-7, -1e-7, 1.2e-7], "reloading"),
        ):
            levels = [5e-7, 5e-7 * (1 + 0.3 * sign), 5e-7 * (1 + 0.45 * sign)]
            moves = [[level, u] for level, u in zip(levels, turn)]
            cases.append(path_case(f"{load} load, {tangential}", 5e-7, moves))
    cases.append(path_case("growing load, no slip", 5e-7, [[6e-7, 3e-8], [7e-7, 0.0], [6.5e-7, 0.0]]))
    return problem(
        "oblique-paths",
        "Mindlin and Deresiewicz: load and tangential motion that change together",
        BALL_TEXT
        + "From the indentation `indentation` without tangential motion, each of `moves` is straight to a pair"
        " of indentation and tangential displacement. Nine cases: constant, growing and falling load, with loading,"
        " unloading and reloading; and a load that grows so fast that nothing slips. Asked: F_N and the"
        " tangential force"
        " after each move.",
        "The displacement of the surface of the method of dimensionality reduction, a line from node to node"
        " over x^2/R,"
        " clamped as a whole in each move, and integrated in closed form; 40 digits.",
        SPRINGS,
        ["Mindlin & Deresiewicz 1953, 10.1115/1.4010702"],
        cases,
        {
            "1e-2": "partial slip is there; a spring with a friction cap misses it by tens of percent",
            "1e-4": "some hundred springs or more",
            "1e-8": "the slip history is exact",
        },
    )


def random_turns():
    ball = Ball(10.0)
    full, generator = float(ball.m * ball.d), np.random.default_rng(7)
    turns = [float(f"{full * value:.6e}") for value in generator.uniform(-0.95, 0.95, 60)]
    start, forces = ball.d, []
    for u in turns:
        ball.move(u)
        forces.append(ball.force())
    limit = 10 * ball.mu
    compared(forces, springs(float(start), [(float(start), u) for u in turns], 200_000), limit, "turns", 5e-7)
    outputs = {"force": out("N", *forces, scale=limit)}
    inputs = {**BALL, "normal_force": 10.0, "displacements": turns}
    return problem(
        "random-turns",
        "Memory: sixty turning points",
        BALL_TEXT + "Under constant F_N the ball is moved to each of `displacements` in turn. Asked: the tangential"
        " force at each.",
        "As in oblique-paths.",
        SPRINGS.replace("400 000", "200 000").replace("2e-7", "5e-7"),
        ["Masing 1926", "Jaeger 1998"],
        [{"name": "ball", "inputs": inputs, "outputs": outputs}],
        {
            "1e-2": "the turning points are remembered and wiped out",
            "1e-4": "some hundred springs or more",
            "1e-8": "the slip history is exact",
        },
    )


def falling_amplitude():
    cases = []
    for count in (1, 2, 5, 20):
        ball = Ball(10.0)
        full = ball.m * ball.d
        path = [float(full * (-1) ** k * (1 - mpf(k) / count)) for k in range(count)] + [0.0]
        start = float(ball.d)
        for u in path:
            ball.move(u)
        a = sqrt(ball.d * ball.r)
        peak = ball.mu * 30 / (2 * pi * a * a)
        radii = [float(f"{a * part:.6e}") for part in (0.05, 0.25, 0.5, 0.75, 0.95)]
        shear = [ball.shear(r) for r in radii]
        largest = max(abs(ball.shear(sqrt(y * ball.r))) for y, _ in ball.nodes)
        closed = (2 - sqrt(mpf(3) / 2)) / sqrt(count) if count > 1 else 1 / sqrt(mpf(2))
        near(largest, closed * peak, 12, "largest residual stress")
        compared([ball.force()], springs(start, [(start, u) for u in path])[-1:], 3, "falling")
        outputs = {
            "force": out("N", ball.force(), scale=10 * ball.mu),
            "shear": out("Pa", *shear, scale=peak),
            "largest_shear": out("Pa", largest, scale=peak),
        }
        inputs = {**BALL, "normal_force": 10.0, "displacements": path, "radii": radii}
        cases.append({"name": f"{count} reversals", "inputs": inputs, "outputs": outputs})
    return problem(
        "falling-amplitude",
        "Residual shear stress after reversals of falling amplitude (Kraft and Pohrt 2016)",
        BALL_TEXT
        + "Under constant F_N the ball is moved to `displacements`: with N reversals to (-1)^k (1 - k/N) times"
        " the displacement of gross slip, and back to 0. Asked, at the end: tangential force, shear stress at `radii`,"
        " and its largest magnitude.",
        "As in oblique-paths; the stress is a sum of square roots, largest at a node.",
        "Largest stress (2 - sqrt(3/2)) mu p_max/sqrt(N), for N = 1 mu p_max/sqrt(2), to 12 digits; " + SPRINGS,
        ["Kraft & Pohrt 2016, Facta Universitatis, Mechanical Engineering"],
        cases,
        {
            "1e-2": "figures of the paper cannot be distinguished",
            "1e-4": "a million springs, or a stress in closed form",
            "1e-8": "the slip history is exact",
        },
    )


# -------------------------------------------------------------------------------------------------- cycles and loops


def loops():
    ball = Ball(10.0)
    a, limit, full = sqrt(ball.d * ball.r), 10 * ball.mu, ball.m * ball.d
    forces = [3e-6, 0.3, 1.5, 2.7]
    amplitudes, works = [], []
    for force in forces:
        y = (1 - mpf(force) / limit) ** (mpf(1) / 3)
        works.append(3 * limit**2 / (5 * a * ball.g) * (1 - y) ** 3 * (1 + 3 * y + y * y))
        amplitudes.append(full * (1 - y * y))
        s = amplitudes[-1] / full
        # The loop is 4 int of the branch 2 F(U/2) less its chord: Masing.
        branch = quad(lambda t: limit * (1 - (1 - t) ** (mpf(3) / 2)), [0, s]) * full
        near(works[-1], 8 * (branch - mpf(force) * amplitudes[-1] / 2), 15, "loop")
    inputs = {"profile": {"type": "sphere", "radius": 0.01}, **{k: BALL[k] for k in ("e_star", "g_star", "friction")}}
    outputs = {"dissipated_energy": out("J", *works), "displacement_amplitude": out("m", *amplitudes)}
    ball_case = {
        "name": "ball",
        "inputs": {**inputs, "normal_force": 10.0, "force_amplitudes": forces},
        "outputs": outputs,
    }
    cases = [ball_case]
    for name, profile, shape in shapes():
        if name not in ("cone", "power law", "truncated sphere", "rounded punch"):
            continue
        modulus, shear, mu = (mpf(BALL[k]) for k in ("e_star", "g_star", "friction"))
        radius = root(
            lambda x, s=shape: s.load(x) - 10 / modulus, max(shape.core, mpf(10) ** -7) * (1 + mpf(10) ** -9), 1e-3
        )
        d, m = shape.g(radius), mu * modulus / shear
        drive = [float(f"{m * d * part:.6e}") for part in (0.1, 0.4, 0.9)]
        works, peaks = [], []
        for u in drive:
            level = d - mpf(u) / m
            low = shape.core * (1 + mpf(10) ** -30) if shape.core else mpf(10) ** -12
            c = root(lambda x, s=shape, level=level: s.g(x) - level, low, radius)
            # D = 8 mu m [(d - d*) (F + F*)/2 - int F dy], dy = g' dx: by parts, without g'.
            area = (
                d * shape.load(radius)
                - level * shape.load(c)
                - quad(lambda x, s=shape: s.g(x) * 2 * x * s.rise(x), [c, radius])
            )
            chord = (d - level) * (shape.load(radius) + shape.load(c)) / 2
            works.append(8 * mu * m * modulus * (chord - area))
            peaks.append(mu * modulus * (shape.load(radius) - shape.load(c)))
            # Ring by ring, 4 times traction limit times slip: mu (d - g) and u - m (d - g), both over x.
            again = quad(lambda x, s=shape, d=d, u=u: (d - s.g(x)) * (mpf(u) - m * (d - s.g(x))), [c, radius])
            near(works[-1], 8 * mu * modulus * again, 10, name)
        given = {**inputs, "profile": profile, "normal_force": 10.0, "displacement_amplitudes": drive}
        outputs = {"dissipated_energy": out("J", *works), "force_amplitude": out("N", *peaks)}
        cases.append({"name": name, "inputs": given, "outputs": outputs})
    return problem(
        "loops",
        "Friction work of steady cycles",
        BALL_TEXT.replace("A ball of radius R (`radius`)", "A body of `profile` (shapes as in normal-contact)")
        + "Under constant F_N the tangential force (`force_amplitudes`) or displacement (`displacement_amplitudes`)"
        " swings steadily. Asked: friction work of a cycle, and the amplitude of the other quantity.",
        "Ball: closed form (3 mu^2 F_N^2/(5 a G*)) (1 - y)^3 (1 + 3 y + y^2), y^3 = 1 - F/(mu F_N). Others: 8"
        " mu m times"
        " the area between the load curve and its chord.",
        "Ball: Masing's rule and a quadrature of the first loading. Others: the integral over x of slip times"
        " traction.",
        ["Mindlin & Deresiewicz 1953, 10.1115/1.4010702", "Jaeger 1998"],
        cases,
        {
            "1e-2": "as good as a measured loop",
            "1e-4": "friction work by many springs",
            "1e-8": "also at a millionth of mu F_N, where the work is 1e-13 of the elastic energy's square root and"
            " cancellation ruins a sum",
        },
    )


def harmonics():
    ball = Ball(10.0)
    limit, full = 10 * ball.mu, ball.m * ball.d
    shares = [mpf(1) / 20, mpf(1) / 2, mpf(19) / 20]
    drive = [float(f"{full * part:.6e}") for part in shares]
    in_phase, quadrature, third_in, third_out = [], [], [], []
    for u in drive:
        s = mpf(u) / full
        k, e = ellipk(s), ellipe(s)
        j3 = (2 * (2 - s) * e - (1 - s) * k) / 3
        j5 = (4 * (2 - s) * j3 - 3 * (1 - s) * e) / 5
        in_phase.append(limit * 8 / pi * (j3 - 2 * (j3 - j5) / s))
        y = (1 - s) ** (mpf(1) / 2)
        force = limit * (1 - y**3)
        a = sqrt(ball.d * ball.r)
        work = 3 * limit**2 / (5 * a * ball.g) * (1 - y) ** 3 * (1 + 3 * y + y * y)
        quadrature.append(-work / (pi * mpf(u)))

        def branch(t, s=s, force=force):
            # Down from the top: F = F0 - 2 F(first loading of half the way).
            return force - 2 * limit * (1 - (1 - s * (1 - cos(t)) / 2) ** (mpf(3) / 2))

        for order, cosines, sines in ((1, in_phase, quadrature), (3, third_in, third_out)):
            found = [2 / pi * quad(lambda t, f=f, n=order: branch(t) * f(n * t), [0, pi]) for f in (cos, sin)]
            if order == 1:
                near(cosines[-1], found[0], 15, "in phase")
                near(sines[-1], found[1], 15, "quadrature")
            else:
                simple = [
                    mp.fsum(
                        branch(pi * (j + mpf(1) / 2) / 2000) * cos(3 * pi * (j + mpf(1) / 2) / 2000)
                        for j in range(2000)
                    )
                    / 1000
                ]
                near(simple[0], found[0], 10, "third")
                cosines.append(found[0])
                sines.append(found[1])
    outputs = {
        "in_phase_1": out("N", *in_phase),
        "quadrature_1": out("N", *quadrature),
        "in_phase_3": out("N", *third_in),
        "quadrature_3": out("N", *third_out),
    }
    inputs = {**BALL, "normal_force": 10.0, "displacement_amplitudes": drive}
    return problem(
        "harmonics",
        "Harmonics of the force of a ball that swings",
        BALL_TEXT + "Under constant F_N the displacement is U0 cos(w t) with each of `displacement_amplitudes`, in the"
        " steady state. Asked: a_n and b_n of F = sum a_n cos(n w t) + b_n sin(n w t), n = 1 and 3; without"
        " friction all"
        " b_n are 0, and b_1 is negative as friction takes energy.",
        "n = 1: complete elliptic integrals, and -D/(pi U0) from the work D. n = 3: quadrature in 40 digits.",
        "n = 1: quadrature; n = 3: the midpoint rule (in phase).",
        ["Caughey 1960, for the method", "Mindlin & Deresiewicz 1953, 10.1115/1.4010702"],
        [{"name": "ball", "inputs": inputs, "outputs": outputs}],
    )


# -------------------------------------------------------------------------------------------------------- line contact


def line_contact():
    e_body, nu, r, mu, length = 7.4e10, 0.33, 0.05, 0.6, 0.01
    load, kappa = 968.466409034, 198251.58437
    k = (1 - mpf(nu) ** 2) / mpf(e_body)
    modulus = 1 / (2 * k)
    per_length = mpf(load) / mpf(length)
    a = sqrt(4 * per_length * mpf(r) / (pi * modulus))
    peak = 2 * per_length / (pi * a)
    limit = mpf(mu) * mpf(load)
    shares = [0.5, -0.5, 0.5, -0.2, 0.1]
    forces = [float(f"{limit * mpf(share):.9e}") for share in shares]
    # Strokes after wiping out: the virgin one to 0.5 N, then those from a turn to a turn.
    turns = [
        (mpf(forces[0]), mpf(0), 1),
        (mpf(forces[1]), mpf(forces[0]), 2),
        (mpf(forces[2]), mpf(forces[1]), 2),
        (mpf(forces[3]), mpf(forces[2]), 2),
        (mpf(forces[4]), mpf(forces[3]), 2),
    ]
    # The loop 0.5, -0.5, 0.5 closes: its last turn is the first one again.
    strokes = [turns[0], turns[3], turns[4]]
    ellipses = []
    for to, since, factor in strokes:
        sign = 1 if to > since else -1
        c = a * sqrt(1 - abs(to - since) / (factor * limit))
        shift = mpf(r) / mpf(mu) * k * mpf(kappa) * abs(to - since) / factor
        ellipses += [(factor * sign * mpf(mu) * peak, a, mpf(0)), (-factor * sign * mpf(mu) * peak * c / a, c, shift)]
    total = mp.fsum(pi / 2 * height * width for height, width, _ in ellipses) * mpf(length)
    near(total, forces[-1], 20, "force of a line contact")

    def shear(x):
        return mp.fsum(h * sqrt(max(1 - ((mpf(x) - e) / c) ** 2, 0)) for h, c, e in ellipses)

    places = [float(f"{a * mpf(part):.9e}") for part in (-0.97, -0.5, 0.1, 0.7, 0.99)]
    points = [[float(f"{a * mpf(x):.9e}"), 0.0, float(f"{a * mpf(z):.9e}")] for x, z in ((0.95, 0.02), (-0.8, 0.1))]
    tensors = {name: [] for name in ("xx", "yy", "zz", "xz")}
    for x, _, z in points:
        x, z = mpf(x), mpf(z)

        def line(height, width, middle, x=x, z=z):
            u = mp.mpc(x - middle, z)
            s = sqrt(u - width) * sqrt(u + width)
            return pi * height / width * (u - s), pi * height / width * (1 - u / s)

        c, slope = line(peak, a, mpf(0))
        q, q_slope = [mp.fsum(part) for part in zip(*(line(*ellipse) for ellipse in ellipses))]
        both = 2 / pi * c.imag - 2 / pi * q.real
        apart = -2 / pi * z * slope.real + 2 / pi * (q.real - z * q_slope.imag)
        xz = -z * slope.imag / pi + (q.imag + z * q_slope.real) / pi
        xx, zz = (both - apart) / 2, (both + apart) / 2
        # Flamant's lines of force, summed.
        sums = []
        for kind in range(3):

            def flamant(t, width, middle, kind=kind, x=x, z=z):
                rho = (x - middle - width * sin(t)) ** 2 + z * z
                off = x - middle - width * sin(t)
                return [off * off * z, z**3, off * z * z][kind] / rho**2 * cos(t) ** 2 * width

            def flamant_along(t, width, middle, kind=kind, x=x, z=z):
                rho = (x - middle - width * sin(t)) ** 2 + z * z
                off = x - middle - width * sin(t)
                return [off**3, off * z * z, off * off * z][kind] / rho**2 * cos(t) ** 2 * width

            cuts = [-pi / 2, asin(max(min(x / a, 1), -1)), pi / 2]
            value = -2 / pi * peak * quad(lambda t: flamant(t, a, mpf(0)), cuts, maxdegree=9)
            for height, width, middle in ellipses:
                at = asin(max(min((x - middle) / width, 1), -1))
                ends = [-pi / 2, at, pi / 2] if abs(at) < 1.57 else [-pi / 2, pi / 2]
                value -= 2 / pi * height * quad(lambda t, w=width, m=middle: flamant_along(t, w, m), ends, maxdegree=9)
            sums.append(value)
        for first, second in zip((xx, zz, xz), sums):
            near(first, second, 8, "stress below a line contact")
        yy = mpf(nu) * (xx + zz)
        for name, value in (("xx", xx + mpf(kappa) * mpf(forces[-1])), ("yy", yy), ("zz", zz), ("xz", xz)):
            tensors[name].append(value)
    inputs = {
        "radius": r,
        "length": length,
        "youngs_modulus": e_body,
        "poisson_ratio": nu,
        "friction": mu,
        "normal_force": load,
        "stress_per_force": kappa,
        "forces": forces,
        "x": places,
        "points": points,
    }
    outputs = {
        "contact_half_width": out("m", a),
        "shear": out("Pa", *(shear(x) for x in places), scale=mpf(mu) * peak),
        **{name: out("Pa", *values, scale=peak) for name, values in tensors.items()},
    }
    return problem(
        "line-contact",
        "A cylinder on a flat whose bulk stress follows the tangential force",
        "A cylinder of `radius` R and `length` L touches a half-space of the same material (`youngs_modulus`,"
        " `poisson_ratio`) in plane strain, under F_N = `normal_force` and friction mu. The tangential force"
        " on the first"
        " body (the cylinder) goes to each of `forces` along x; the second one carries a bulk stress sigma_xx ="
        " `stress_per_force` times this force. Asked after the last: half-width a, shear stress at `x`, and below"
        " `points` (x, y, z; z into the second body) the components of its stress, tension positive, xx with the bulk"
        " stress, yy without its share. Shear stress is positive along x on the second body.",
        "Each stroke adds two ellipses of traction, the inner one shifted by e = (R/mu) k sigma (k = (1 - nu^2)/E); the"
        " stress is in complex functions of x + i z. 40 digits.",
        "The ellipses add up to the force; the stress by quadrature of Flamant's line forces, to 8 digits.",
        ["Nowell & Hills 1987", "Johnson 1985, 10.1017/CBO9781139171731"],
        [{"name": "cylinder", "inputs": inputs, "outputs": outputs}],
        {
            "1e-2": "finite elements of some hundredth of the half-width",
            "1e-4": "converged singular integral equations",
            "1e-8": "the closed form",
        },
    )


def pad():
    b, r, length, modulus, load = mpf(5e-4), mpf(0.05), mpf(0.01), mpf(4e10), 1000.0

    def weight(a):
        return (a * a / 2 * acos(b / a) - b / 2 * sqrt(a * a - b * b)) / r

    a = root(lambda a: weight(a) - load / length / modulus, b * mpf("1.000001"), mpf(0.01))
    places = [0.0, 2e-4, 4.5e-4, 5.5e-4, float(f"{a * mpf(0.97):.6e}")]

    def pressure(x):
        # (1/pi) int_x^a G'(t)/sqrt(t^2 - x^2) dt over t > b, with t^2 = x^2 + v^2.
        low = max(b, mpf(x))
        start = sqrt(low * low - mpf(x) ** 2)
        return (
            modulus
            / pi
            * quad(lambda v: acos(min(b / sqrt(mpf(x) ** 2 + v * v), 1)) / r, [start, sqrt(a * a - mpf(x) ** 2)])
        )

    def closed(x):
        # Ciavarella, Hills and Monno: sin phi = x/a, sin phi0 = b/a.
        phi, phi0 = asin(mpf(x) / a), asin(b / a)
        part = (pi - 2 * phi0) * cos(phi) + sin(phi) * log(abs(sin(phi + phi0) / sin(phi - phi0)))
        part += sin(phi0) * log(abs(mp.tan((phi + phi0) / 2) * mp.tan((phi - phi0) / 2)))
        return 2 * load / length / (pi * a) / (pi - 2 * phi0 - sin(2 * phi0)) * part

    pressures = [pressure(x) for x in places]
    for first, second in zip(pressures, map(closed, places)):
        near(first, second, 15, "pressure of a pad")
    inputs = {
        "flat_half_width": 5e-4,
        "edge_radius": 0.05,
        "length": 0.01,
        "e_star": 4e10,
        "normal_force": load,
        "x": places,
    }
    return problem(
        "pad",
        "A flat pad with rounded edges",
        "A rigid pad, flat for |x| < b = `flat_half_width` and then a parabola of radius `edge_radius`, of"
        " `length` L, is"
        " pressed into a half-space of modulus E* in plane strain. Asked: half-width of the contact, and"
        " pressure at `x`.",
        "P/E* = (a^2/2 acos(b/a) - b/2 sqrt(a^2 - b^2))/R solved for a; pressure as a superposition of flat punches.",
        "The closed form of the pressure in logarithms.",
        ["Ciavarella, Hills & Monno 1998", "Shtaerman 1949"],
        [
            {
                "name": "pad",
                "inputs": inputs,
                "outputs": {"contact_half_width": out("m", a), "pressure": out("Pa", *pressures)},
            }
        ],
    )


# ----------------------------------------------------------------------------------------------------- stress in depth


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


# -------------------------------------------------------------------------------------------------------------- others


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
    load = float(f"{4 * modulus * a**3 / (3 * r):.9e}")
    a = (3 * mpf(load) * r / (4 * modulus)) ** (mpf(1) / 3)
    m = mu * modulus / shear
    drive, forces = [], []

    def bound(x):
        return m * (a * a - x * x) / r + 2 * tau / shear * sqrt(a * a - x * x)

    for part in (0.9, 0.5, 0.2):
        drive.append(float(f"{bound(a * mpf(part)):.9e}"))
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


PROBLEMS = (
    normal_contact,
    first_loading,
    oblique_paths,
    random_turns,
    falling_amplitude,
    loops,
    harmonics,
    line_contact,
    pad,
    stress_in_depth,
    wear_limit,
    shear_strength,
    conductance,
    sliders,
    rolling,
)


def same(found, stored):
    """Equal but for the last bits of outputs, by which libraries of other machines differ."""
    if isinstance(found, dict) and "scale" in found and found["unit"] == stored["unit"]:
        pairs = zip([*found["values"], found["scale"]], [*stored["values"], stored["scale"]], strict=True)
        return all(abs(one - other) <= 1e-13 * stored["scale"] for one, other in pairs)
    if isinstance(found, dict):
        return found.keys() == stored.keys() and all(same(found[name], stored[name]) for name in found)
    if isinstance(found, list):
        return len(found) == len(stored) and all(same(*pair) for pair in zip(found, stored))
    return found == stored


def main():
    for make in PROBLEMS:
        document = make()
        path = FOLDER / f"{document['id']}.json"
        if "--check" in sys.argv[1:]:
            assert same(document, json.loads(path.read_text())), f"{path.name} is not what this program computes"
        else:
            path.write_text(json.dumps(document, indent=1, ensure_ascii=False) + "\n")
        print(document["id"])


if __name__ == "__main__":
    main()
