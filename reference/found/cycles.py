"""Friction work and harmonics of steady cycles."""

from mpmath import cos, ellipe, ellipk, mp, mpf, pi, quad, sin, sqrt

from found.common import near, out, problem, root
from found.normal import shapes
from found.tangential import BALL, BALL_TEXT, Ball


def loops():
    ball = Ball(10.0)
    a, limit, full = sqrt(ball.d * ball.r), 10 * ball.mu, ball.m * ball.d
    inputs = {"profile": {"type": "sphere", "radius": 0.01}, **{k: BALL[k] for k in ("e_star", "g_star", "friction")}}
    cases = []
    for name, forces in (("ball", [0.3, 1.5, 2.7]), ("ball, a millionth of the limit", [3e-6])):
        amplitudes, works = [], []
        for force in forces:
            y = (1 - mpf(force) / limit) ** (mpf(1) / 3)
            works.append(3 * limit**2 / (5 * a * ball.g) * (1 - y) ** 3 * (1 + 3 * y + y * y))
            amplitudes.append(full * (1 - y * y))
            s = amplitudes[-1] / full
            # Masing's rule: a branch is twice the first loading over half the way.
            branch = quad(lambda t: limit * (1 - (1 - t) ** (mpf(3) / 2)), [0, s]) * full
            near(works[-1], 8 * (branch - mpf(force) * amplitudes[-1] / 2), 15, "loop")
        given = {**inputs, "normal_force": 10.0, "force_amplitudes": forces}
        outputs = {"dissipated_energy": out("J", *works), "displacement_amplitude": out("m", *amplitudes)}
        cases.append({"name": name, "inputs": given, "outputs": outputs})
    for name, profile, shape in shapes():
        if name not in ("cone", "power law", "truncated sphere", "rounded punch"):
            continue
        modulus, shear, mu = (mpf(BALL[k]) for k in ("e_star", "g_star", "friction"))
        radius = root(
            lambda x, s=shape: s.load(x) - 10 / modulus, max(shape.core, mpf(10) ** -7) * (1 + mpf(10) ** -9), 1e-3
        )
        d, m = shape.g(radius), mu * modulus / shear
        drive = [float(f"{float(m * d * part):.6e}") for part in (0.1, 0.4, 0.9)]
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
            "1e-8": "also at a millionth of mu F_N, where cancellation ruins a sum",
        },
    )


def harmonics():
    ball = Ball(10.0)
    limit, full = 10 * ball.mu, ball.m * ball.d
    shares = [mpf(1) / 20, mpf(1) / 2, mpf(19) / 20]
    drive = [float(f"{float(full * part):.6e}") for part in shares]
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
