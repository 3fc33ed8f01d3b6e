"""Other laws of one half-space: twist, adhesion with sliding, and bodies with memory."""

import numpy as np
from mpmath import acos, ellipe, exp, mp, mpf, pi, quad, sqrt

from found.common import near, out, problem, root
from found.tangential import BALL_TEXT


class Twist:
    """First twist of a contact with slip from the radius c on; `fall` is -dw/dt of the limit w of the angle."""

    def __init__(self, fall, pressure, a, g, mu):
        self.fall, self.pressure, self.a, self.g, self.mu = fall, pressure, a, g, mu

    def limit(self, t):
        # Smooth, so that a Gauss rule has all digits with few points.
        return quad(self.fall, [t, self.a], method="gauss-legendre", maxdegree=4)

    def radius(self, angle):
        """Newton's method over log t, in which the limit is nearly straight."""
        c = self.a / 2
        for _ in range(60):
            way = (self.limit(c) - angle) / (self.fall(c) * c)
            c = min(c * exp(way), (c + self.a) / 2)
            if abs(way) < mpf(10) ** -35:
                return c
        raise AssertionError("no stick radius")

    def torque(self, c):
        """16 G int_0^a w t^2 dt, by parts."""
        return mpf(16) / 3 * self.g * quad(lambda t: self.fall(t) * t**3, [c, self.a])

    def hoop(self, r, c):
        """(4 G r/pi) int fall/sqrt(t^2 - r^2) dt, with t^2 = r^2 + v^2."""
        ends = [sqrt(max(c, r) ** 2 - r * r), sqrt(self.a**2 - r * r)]
        return 4 * self.g * r / pi * quad(lambda v: self.fall(sqrt(r * r + v * v)) / sqrt(r * r + v * v), ends)

    def checked(self, c):
        """The torque of the tractions: mu p where it slips, the integral above where it sticks."""
        mp.dps = 20
        # r = c (1 - s^2): the stress rises like a square root before c.
        inner = quad(
            lambda s: self.hoop(c * (1 - s * s), c) * (c * (1 - s * s)) ** 2 * 2 * c * s,
            [0, 1],
            method="gauss-legendre",
            maxdegree=3,
        )
        outer = quad(lambda r: self.mu * self.pressure(r) * r * r, [c, self.a])
        near(self.torque(c), 2 * pi * (inner + outer), 9, "torque")
        mp.dps = 40
        place = (c + self.a) / 2
        near(self.hoop(place, c), self.mu * self.pressure(place), 20, "traction where it slips")


def twist():
    mu, load, modulus = mpf(0.3), mpf(10.0), mpf(1.15e11)
    g = mpf(4e10)
    r, slope = mpf(0.01), mpf(0.05)
    ball_a = (3 * load * r / (4 * modulus)) ** (mpf(1) / 3)
    peak = 3 * load / (2 * pi * ball_a**2)
    cone_a = sqrt(2 * load / (pi * modulus * slope))
    contacts = (
        (
            "ball",
            {"type": "sphere", "radius": 0.01},
            Twist(
                lambda t: mu * peak / (2 * g) * ellipe(1 - (t / ball_a) ** 2) / t,
                lambda x: peak * sqrt(1 - (x / ball_a) ** 2),
                ball_a,
                g,
                mu,
            ),
            3 * pi / 16,
        ),
        (
            "cone",
            {"type": "cone", "slope": 0.05},
            Twist(
                lambda t: mu * modulus * slope / (4 * g) * pi / (2 * mp.agm(1, t / cone_a)) / t,
                lambda x: modulus * slope / 2 * mp.acosh(cone_a / x),
                cone_a,
                g,
                mu,
            ),
            pi / 6,
        ),
    )
    cases = []
    for name, profile, law, share in contacts:
        a = law.a
        near(law.torque(a * mpf(10) ** -30), share * mu * load * a, 25, "limit torque")
        law.checked(a / 2)
        angles = [float(f"{float(law.limit(a * mpf(part))):.9e}") for part in (0.3, 0.5, 0.8)]
        moves = [angles[0], -angles[1], angles[2]]
        ways = [(1, mpf(moves[0]))] + [(2, (mpf(then) - mpf(now)) / 2) for now, then in zip(moves, moves[1:])]
        zones = [(mp.sign(way) * factor, law.radius(abs(way))) for factor, way in ways]
        torques = [mp.fsum(f * law.torque(c) for f, c in zones[: count + 1]) for count in range(3)]
        radii = [float(f"{float(a * part):.6e}") for part in (0.2, 0.45, 0.7, 0.95)]
        hoop = [mp.fsum(f * law.hoop(mpf(x), c) for f, c in zones) for x in radii]
        # The steady cycle of the first angle: ring by ring, and by Masing's rule.
        c, top = zones[0][1], mpf(moves[0])
        mp.dps = 22
        work = 64 * g * quad(lambda t, w=law, top=top: w.limit(t) * (top - w.limit(t)) * t * t, [c, a])
        branch = mpf(16) / 3 * g * quad(lambda t, w=law, top=top: w.fall(t) * t**3 * (top - w.limit(t)), [c, a])
        mp.dps = 40
        near(work, 8 * branch - 4 * torques[0] * top, 16, "work of a cycle")
        outputs = {
            "torque": out("N m", *torques, scale=share * mu * load * a),
            "gross_slip_torque": out("N m", share * mu * load * a),
            "hoop": out("Pa", *hoop, scale=mu * peak),
            "cycle_work": out("J", work),
        }
        inputs = {"profile": profile, "e_star": float(modulus), "shear_modulus": float(g), "friction": float(mu)}
        inputs |= {"normal_force": float(load), "twists": moves, "radii": radii}
        cases.append({"name": name, "inputs": inputs, "outputs": outputs})
    return problem(
        "twist",
        "Lubkin, Deresiewicz, Jaeger: a contact that is twisted about its normal",
        "An indenter of `profile` (sphere z = r^2/(2 `radius`), cone z = `slope` r) is pressed on a half-space by the"
        " constant F_N (`normal_force`) and twisted about the normal to each of `twists` (rad) in turn, with"
        " |tau| <= mu p everywhere. E* (`e_star`) is the modulus of the load; `shear_modulus` is 1/(1/G_1 + 1/G_2)."
        " Asked: torque after each, the torque of gross slip, the shear stress around the axis at `radii` after the"
        " last, and the friction work of a cycle between plus and minus the first of `twists`.",
        "First twist to the stick radius c: angle int_c^a f dt, torque (16 G/3) int_c^a f t^3 dt, stress (4 G r/pi)"
        " int f/sqrt(t^2 - r^2) dt, f t = mu p_max E(1 - t^2/a^2)/(2 G) of the ball and mu E* T K(1 - t^2/a^2)/(4 G)"
        " of the cone (complete elliptic integrals of the parameter); then Masing's rule. 40 digits.",
        "The stress is mu p where it slips (20 digits), its moment is the torque (9 digits); the limits of the torque"
        " in closed form (25 digits); the work ring by ring and by Masing's rule (16 digits).",
        ["Lubkin 1951, Journal of Applied Mechanics 18, 183", "Deresiewicz 1954, Journal of Applied Mechanics 21, 52", "Jaeger 1995"],
        cases,
        {
            "1e-2": "partial slip is there: a spring with a cap misses the work altogether",
            "1e-4": "a mesh that is fitted to the edge of the stick zone",
            "1e-8": "the limit of the angle, which is infinite in the centre, is known in closed form",
        },
    )


def adhesion():
    modulus, shear, r, w, tau = mpf(1e6), mpf(6.67e5), mpf(0.01), mpf(0.05), mpf(1e5)

    def depth(a):
        return a * a / r - sqrt(2 * pi * a * w / modulus)

    def load(a):
        return 2 * modulus * (depth(a) * a - a**3 / (3 * r))

    def energy(d, a):
        return modulus * quad(lambda x: (d - x * x / r) ** 2, [0, a])

    pull_off = -mpf(3) / 2 * pi * r * w
    neck = (9 * pi * w * r * r / (8 * modulus)) ** (mpf(1) / 3)
    near(load(neck), pull_off, 25, "pull-off")
    loads = [0.01, 0.0, -0.001, -0.0023]
    radii = [root(lambda a, f=f: load(a) - f, neck * (1 + mpf(10) ** -12), mpf(0.01)) for f in loads]
    for f, a in zip(loads, radii):
        d = depth(a)
        step = mpf(10) ** -15
        near(mp.diff(lambda x, d=d: energy(d, x), a, h=step), 2 * pi * a * w, 9, "energy release rate")
        near(mp.diff(lambda x, a=a: energy(x, a), d, h=step) + 1, mpf(f) + 1, 9, "load")
    a = radii[2]
    drive = [float(f"{float(2 * tau / shear * a * mpf(part)):.9e}") for part in (0.3, 0.6, 0.9)]
    forces = []
    for u in drive:
        c = sqrt(a * a - (mpf(u) * shear / (2 * tau)) ** 2)
        forces.append(2 * tau * (a * a * acos(c / a) + c * sqrt(a * a - c * c)))

        def inside(x, c=c):
            # (2 tau/pi) int_c^a t/(sqrt(a^2 - t^2) sqrt(t^2 - x^2)) dt.
            return 2 * tau / pi * mp.atan2(sqrt(a * a - c * c), sqrt(c * c - x * x))

        again = 2 * pi * quad(lambda x, s=inside: s(x) * x, [0, c]) + pi * (a * a - c * c) * tau
        near(forces[-1], again, 15, "sliding")
    shared = {"radius": 0.01, "e_star": 1e6, "g_star": 6.67e5, "work": 0.05, "shear_strength": 1e5}
    normal = {
        "contact_radius": out("m", *radii),
        "indentation": out("m", *(depth(a) for a in radii)),
        "pull_off_force": out("N", pull_off),
    }
    cases = [
        {"name": "loads", "inputs": {**shared, "normal_forces": loads}, "outputs": normal},
        {
            "name": "sliding under tension",
            "inputs": {**shared, "normal_force": loads[2], "displacements": drive},
            "outputs": {"force": out("N", *forces, scale=pi * a * a * tau)},
        },
    ]
    return problem(
        "adhesion",
        "Johnson, Kendall and Roberts: an adhesive ball, and sliding on it",
        "A ball of radius R (`radius`) touches a half-space; E* (`e_star`) and G* (`g_star`) are the moduli of the"
        " pair, surfaces that touch have given the energy w (`work`, J/m^2) per area. Under each of `normal_forces`"
        " (negative: tension), on the stable branch under a load: contact radius and indentation; and the load of"
        " pull-off. Under the constant `normal_force` the ball is moved along the surface to each of `displacements`,"
        " which grow; slip begins where the shear stress is tau_0 (`shear_strength`), whatever the pressure, and"
        " shear does not peel. Asked: the tangential force.",
        "d = a^2/R - sqrt(2 pi a w/E*), F_N = 2 E* (d a - a^3/(3 R)), solved for a. Sliding: c from U = (2 tau_0/G*)"
        " sqrt(a^2 - c^2), F = 2 tau_0 (a^2 acos(c/a) + c sqrt(a^2 - c^2)).",
        "The elastic energy E* int (d - g)^2 dx: its slope over a is 2 pi a w, its slope over d the load (9 digits)."
        " The tractions of sliding add up to the force (15 digits).",
        ["Johnson, Kendall & Roberts 1971, 10.1098/rspa.1971.0141", "Savkoor & Briggs 1977", "Hess 2011"],
        cases,
        {
            "1e-2": "everyday use: the work of adhesion is known to ten percent at best",
            "1e-4": "no measurement distinguishes the answer from the exact one",
            "1e-8": "the code solves the equations themselves, also beside the pull-off",
        },
    )


def relaxed(terms, t):
    return 1 - sum(mpf(term["ratio"]) * (1 - exp(-t / mpf(term["time"]))) for term in terms)


def held(terms, t):
    """int_0^t of the relaxation."""
    ratios = sum(mpf(term["ratio"]) for term in terms)
    return (1 - ratios) * t + sum(
        mpf(term["ratio"]) * mpf(term["time"]) * (1 - exp(-t / mpf(term["time"]))) for term in terms
    )


def prony_springs(terms, e_star, radius, path, shear=None, count=10_000, parts=1000):
    """The forces by independent springs of Maxwell elements; `path` has (duration, indentation, displacement)."""
    depth = max(d for _, d, _ in path)
    width = (depth * radius) ** 0.5 / count
    level = ((np.arange(count) + 0.5) * width) ** 2 / radius
    free = 1 - sum(term["ratio"] for term in terms)
    w, u = np.zeros(count), np.zeros(count)
    inner, across = [np.zeros(count) for _ in terms], [np.zeros(count) for _ in terms]
    d, place, found = 0.0, 0.0, []
    for duration, target, moved in path:
        steps = parts if duration else 1
        for step in range(1, steps + 1):
            now, at = d + (target - d) * step / steps, place + (moved - place) * step / steps
            span = duration / steps
            new = np.maximum(now - level, 0)
            fade = [np.exp(-span / term["time"]) for term in terms]
            # Exact for a straight move: the mean of exp over the step.
            mean = [(1 - f) * term["time"] / span if span else 1.0 for f, term in zip(fade, terms)]
            rise = new - w
            inner = [q * f + term["ratio"] * rise * m for q, f, m, term in zip(inner, fade, mean, terms)]
            w = new
            load = free * w + sum(inner)
            if shear is not None:
                g_star, mu = shear
                move = (at - (place + (moved - place) * (step - 1) / steps)) * (level < now)
                trial = [q * f + term["ratio"] * move * m for q, f, m, term in zip(across, fade, mean, terms)]
                stiff = free + sum(term["ratio"] * m for m, term in zip(mean, terms))
                force = free * (u + move) + sum(trial)
                room = mu * e_star / g_star * load
                back = (np.clip(force, -room, room) - force) / stiff
                u = u + move + back
                across = [q + term["ratio"] * back * m for q, m, term in zip(trial, mean, terms)]
        d, place = target, moved
        tangential = 2 * shear[0] * width * float((free * u + sum(across)).sum()) if shear is not None else 0.0
        found.append((2 * e_star * width * float(load.sum()), tangential))
    return found


def relaxation():
    modulus, shear, mu, r = 1e6, 6.67e5, 0.5, 0.01
    two = [{"ratio": 0.5, "time": 1.0}, {"ratio": 0.2, "time": 0.1}]
    one = [{"ratio": 0.6, "time": 2.0}]
    shared = {"radius": r, "e_star": modulus, "g_star": shear, "friction": mu}

    def elastic(d):
        return mpf(4) / 3 * mpf(modulus) * sqrt(mpf(r)) * d ** (mpf(3) / 2)

    # Pressed at once, then evenly for a second, then held.
    start, end, times = mpf(1e-5), mpf(4e-5), [0.25, 1.0, 1.5, 3.0]
    pace = end - start

    def pressed(t):
        until = min(mpf(t), mpf(1))
        slope = 2 * mpf(modulus) * sqrt(mpf(r))
        grown = quad(lambda s: relaxed(two, t - s) * slope * sqrt(start + pace * s) * pace, [0, until])
        return relaxed(two, mpf(t)) * elastic(start) + grown

    loads = [pressed(mpf(t)) for t in times]
    path = [(0.0, 1e-5, 0.0)]
    for before, t in zip([0.0, *times], times):
        path.append((t - before, float(start + pace * min(mpf(t), mpf(1))), 0.0))
    for load, (again, _) in zip(loads, prony_springs(two, modulus, r, path)[1:]):
        near(load, again, 6, "pressed")
    cases = [
        {
            "name": "pressed and held",
            "inputs": {**shared, "prony": two, "indentation": 1e-5, "to": 4e-5, "in": 1.0, "times": times},
            "outputs": {"normal_force": out("N", *loads)},
        }
    ]
    # A load that is held.
    held_load, ratio, time = mpf(0.01), mpf(0.6), mpf(2.0)
    creep = [0.5, 2.0, 8.0]
    depths = []
    for t in creep:
        compliance = (1 - ratio * exp(-(1 - ratio) * mpf(t) / time)) / (1 - ratio)
        level = 3 * held_load / (4 * mpf(modulus) * sqrt(mpf(r))) * compliance
        depths.append(level ** (mpf(2) / 3))

        def rate(s):
            # The rate of d^(3/2), whose memory must give the load back.
            scale = 3 * held_load / (4 * mpf(modulus) * sqrt(mpf(r)))
            return scale * ratio / time * exp(-(1 - ratio) * s / time)

        begun = 3 * held_load / (4 * mpf(modulus) * sqrt(mpf(r)))
        again = relaxed(one, mpf(t)) * begun + quad(lambda s, t=t: relaxed(one, mpf(t) - s) * rate(s), [0, mpf(t)])
        near(mpf(4) / 3 * mpf(modulus) * sqrt(mpf(r)) * again, held_load, 25, "creep")
    cases.append(
        {
            "name": "creep",
            "inputs": {**shared, "prony": one, "normal_force": 0.01, "times": creep},
            "outputs": {"indentation": out("m", *depths)},
        }
    )
    # Moved evenly after all has relaxed.
    depth, speed, moments = mpf(4e-5), mpf(1e-5), [0.2, 0.6, 1.2]
    lasting = 1 - sum(mpf(term["ratio"]) for term in two)
    limit = mpf(mu) * lasting * elastic(depth)
    forces = []
    for t in moments:
        reached = mpf(shear) * speed * held(two, mpf(t)) / (mpf(mu) * mpf(modulus) * lasting)
        forces.append(limit * (1 - (1 - reached / depth) ** (mpf(3) / 2)) if reached < depth else limit)
    path = [(0.0, 4e-5, 0.0), (1e3, 4e-5, 0.0)]
    for before, t in zip([0.0, *moments], moments):
        path.append((t - before, 4e-5, float(speed) * t))
    for force, (_, again) in zip(forces, prony_springs(two, modulus, r, path, (shear, mu))[2:]):
        near(force, again, 5, "moved")
    cases.append(
        {
            "name": "moved after it has relaxed",
            "inputs": {**shared, "prony": two, "indentation": 4e-5, "speed": 1e-5, "times": moments},
            "outputs": {"force": out("N", *forces, scale=limit)},
        }
    )
    return problem(
        "relaxation",
        "Lee and Radok: bodies with memory that are pressed, held and moved",
        BALL_TEXT
        + "Both moduli relax by R(t) = 1 - sum g_i (1 - exp(-t/T_i)), `prony` with `ratio` g_i and `time` T_i (s)."
        " First case: pressed at once to `indentation` at the time 0, then evenly to `to` in the time `in`, then held;"
        " asked is F_N at `times`. Second: pressed at once by `normal_force`, which is held; asked is the indentation."
        " Third: pressed at once to `indentation`, held until all has relaxed, then moved along x with `speed`; asked"
        " is the tangential force at `times` from the beginning of this motion.",
        "A contact that only grows: F_N = int R(t - s) dF_elastic. Creep: d^(3/2) by the creep compliance. Motion: a"
        " place sticks until G* V int_0^t R = mu E* R_inf (d - g), F = mu F_N (1 - (1 - s)^(3/2)). 40 digits.",
        "10 000 springs of Maxwell elements in time steps (NumPy): 6 and 5 digits; the creep put back into the memory"
        " integral: 25 digits.",
        ["Lee & Radok 1960, Journal of Applied Mechanics 27, 438", "Ting 1966, Journal of Applied Mechanics 33, 845", "Argatov & Popov 2016"],
        cases,
        {
            "1e-2": "better than a measured Prony series",
            "1e-4": "the memory is integrated, not the end states alone",
            "1e-8": "closed forms, or very many springs",
        },
    )
