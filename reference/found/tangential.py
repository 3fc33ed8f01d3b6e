"""A ball on paths along a line."""

import numpy as np
from mpmath import mp, mpf, pi, sqrt

from found.common import near, out, problem

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
    """The forces by independent springs at midpoints, moved in 40 small steps a move."""
    r, g, e, mu = (BALL[name] for name in ("radius", "g_star", "e_star", "friction"))
    m, widest = mu * e / g, np.sqrt(max([start, *(d for d, _ in path)]) * r)
    x = (np.arange(count) + 0.5) * widest / count
    y, w, d, u, forces = x * x / r, np.zeros(count), start, 0.0, []
    for target, displacement in path:
        for step in range(1, 41):
            before, now = d + (target - d) * ((step - 1) / 40), d + (target - d) * (step / 40)
            # What is met within the step moves from then on.
            part = np.ones(count)
            fresh = (y > before) & (y <= now)
            part[fresh] = (now - y[fresh]) / (now - before)
            bound = np.maximum(now - y, 0)
            w = np.clip(w + (displacement - u) / 40 / m * part, -bound, bound)
        d, u = target, displacement
        forces.append(2 * g * m * w.sum() * widest / count)
    return forces


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


def path_case(name, start, moves):
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
    turns = [float(f"{float(full * value):.6e}") for value in generator.uniform(-0.95, 0.95, 60)]
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
        radii = [float(f"{float(a * part):.6e}") for part in (0.05, 0.25, 0.5, 0.75, 0.95)]
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


def paper_figures():
    """The path of Kraft and Pohrt with 20 reversals, at the places of their figures 2 to 4."""
    ball, count = Ball(10.0), 20
    a, limit, start = sqrt(ball.d * ball.r), 10 * ball.mu, float(ball.d)
    path = [float(ball.m * ball.d * (-1) ** k * (1 - mpf(k) / count)) for k in range(count)] + [0.0]
    peak = ball.mu * 30 / (2 * pi * a * a)
    radii = [float(f"{float(a * part):.6e}") for part in np.arange(1, 20) / 20]
    cases = []
    for name, moves in (
        ("figures 2 and 4: 20 reversals and back", path),
        ("figure 3, A: after 6 reversals", path[:6]),
        ("figure 3, B: from there to the start", [*path[:6], 0.0]),
    ):
        ball, forces = Ball(10.0), []
        for u in moves:
            ball.move(u)
            forces.append(ball.force())
        compared(forces, springs(start, [(start, u) for u in moves], 200_000), limit, name, 5e-7)
        # Masing's rule: each stroke is twice the first loading over half its way, and none wipes out another here.
        masing, before = mpf(0), mpf(0)
        for index, u in enumerate(moves):
            way, factor = (abs(mpf(u) - before) / (2 if index else 1), 2 if index else 1)
            share = min(way / (ball.m * ball.d), mpf(1))
            masing += factor * mp.sign(mpf(u) - before) * limit * (1 - (1 - share) ** (mpf(3) / 2))
            before = mpf(u)
            near(1 + forces[index], 1 + masing, 14, name)
        shear = [ball.shear(r) for r in radii]
        outputs = {"force": out("N", *forces, scale=limit), "shear": out("Pa", *shear, scale=peak)}
        inputs = {**BALL, "normal_force": 10.0, "displacements": moves, "radii": radii}
        cases.append({"name": name, "inputs": inputs, "outputs": outputs})
    return problem(
        "paper-figures",
        "Figures 2 to 4 of Kraft and Pohrt (2016)",
        BALL_TEXT
        + "Under constant F_N the ball is moved to each of `displacements`, their equation (20) with 20 reversals."
        " Asked: the tangential force at each (figure 2), and the shear stress at `radii` after the last (figures 3"
        " and 4, over mu p_max there). Figure 5 is `largest_shear` of falling-amplitude.",
        "As in oblique-paths.",
        "Masing's rule, to 14 digits; " + SPRINGS.replace("400 000", "200 000").replace("2e-7", "5e-7"),
        ["Kraft & Pohrt 2016, Facta Universitatis, Mechanical Engineering"],
        cases,
        {
            "1e-2": "the figures of the paper cannot be distinguished",
            "1e-4": "a million springs, or a stress in closed form",
            "1e-8": "the slip history is exact",
        },
    )
