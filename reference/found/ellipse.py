"""Motion round an ellipse: a punch, which slides as a whole, and a ball that slides in each ring its own way.

A ball that slides everywhere at all times has the traction mu p exp(i phi) along its slip. In units of the contact
radius, G* and the displacement of gross slip mu p is (2/pi) sqrt(1 - r^2), and phi(r, t) is smooth: with the kernel K of
mu p and the rate U' of the ball,

    int K(r, s) cos(phi(s) - phi(r)) phi'(s) ds = Im[U' exp(-i phi(r))].
"""

import numpy as np
from mpmath import cos, mp, mpf, pi, sin
from numpy.polynomial.legendre import Legendre, leggauss, legvander

from found.common import out, problem
from found.plane import halves, mean
from found.tangential import BALL, BALL_TEXT, Ball


def radii_of(count):
    """Radii of Gauss's rule in sqrt(1 - r^2), and what they weigh under that root."""
    z, weights = (part[count:] for part in leggauss(2 * count))
    return np.sqrt(1 - z * z), 3 * weights * z * z


def by_rings(count):
    """Displacements at the radii over exp(i phi) there: elliptic integrals, by the double exponential rule."""
    radii = radii_of(count)[0]
    to_radii = np.linalg.inv(legvander(2 * radii**2 - 1, count - 1))
    kernel = np.zeros((count, count))
    for row, r in zip(kernel, radii):
        for end, off, weight in halves([0.0, r, 1.0]):
            s, apart = end + off, np.abs(off) if end == r else np.abs(end + off - r)
            limit = 2 / np.pi * np.sqrt((-off if end == 1 else 1 - s) * (1 + s))
            row += (weight * limit * 2 * s / mean(r + s, apart)) @ legvander(2 * s * s - 1, count - 1) @ to_radii
    return kernel


def by_transforms(count):
    """The same by displacements (1 - t^2) P(t^2) of the method of dimensionality reduction."""
    r2 = radii_of(count)[0][:, None] ** 2
    q, weights = (leggauss(2 * count + 2)[0] + 1) / 2, leggauss(2 * count + 2)[1]
    turn = np.sin((np.arange(8 * count) + 0.5) * np.pi / (16 * count))
    tau, u = np.zeros((count, count)), np.zeros((count, count))
    for order in range(count):
        shape = Legendre.basis(order, domain=[0, 1])
        # tau = -(1/pi) int v'/sqrt(t^2 - r^2) dt over mu p, u = (2/pi) int v/sqrt(r^2 - t^2) dt.
        y = r2 + (1 - r2) * q**2
        tau[:, order] = ((shape(y) - (1 - y) * shape.deriv()(y)) * weights).sum(1) / 2
        u[:, order] = ((1 - r2 * turn**2) * shape(r2 * turn**2)).mean(1)
    return u @ np.linalg.inv(tau)


def rates(kernel, phi, rate, move):
    """How far the slip is from the direction of the traction, with the slopes over `phi` and `rate`; and the slip."""
    apart = phi - phi[:, None]
    ahead, across = kernel * np.cos(apart), kernel * np.sin(apart) * rate
    slip = move * np.exp(-1j * phi)
    return ahead @ rate - slip.imag, np.diag(across.sum(1) + slip.real) - across, ahead, slip.real + across.sum(1)


def slid_by_angles(a, b, count, times):
    """Forces after a quarter and half a turn and the work of a turn over that of sliding 1: all of a half turn at once.

    Angles less that of the turn are periodic: by Fourier's polynomials through an odd number of times.
    """
    kernel, weights, t = by_rings(count), radii_of(count)[1], np.pi * np.arange(times) / times
    span = np.arange(times)[:, None] - np.arange(times)
    slopes = np.where(span == 0, 0, (-1.0) ** span / np.sin(np.pi * np.where(span == 0, 0.5, span) / times))
    moves = b * 1j * np.cos(t) - a * np.sin(t)
    phi = np.tile(np.unwrap(np.angle(moves)), (count, 1))
    for _ in range(30):
        rate = 1 + (phi - t) @ slopes.T
        rows = [rates(kernel, *row) for row in zip(phi.T, rate.T, moves)]
        jacobian = np.einsum("kij,kl->kilj", [row[2] for row in rows], slopes)
        jacobian[np.arange(times), :, np.arange(times)] += [row[1] for row in rows]
        found = np.concatenate([row[0] for row in rows])
        step = np.linalg.solve(jacobian.reshape(count * times, -1), -found).reshape(times, count).T
        phi = phi + step * min(1, 0.3 / np.abs(step).max())
        if np.abs(step).max() < 1e-12:
            break
    # It slides everywhere, forward.
    assert min(row[3].min() for row in rows) > 0
    force = weights @ np.exp(1j * phi)
    parts, orders = np.fft.fft(force * np.exp(-1j * t)) / times, 2 * np.fft.fftfreq(times, 1 / times)
    half = -force[0]
    quarter = 1j * (parts * np.exp(0.5j * np.pi * orders)).sum()
    return np.array([quarter, half, 2 * np.pi * (force * moves.conj()).real.mean()])


def slid_by_steps(a, b, count, steps):
    """The same by implicit midpoints of steps of time, three turns from rest on, which err by even powers."""
    kernel, weights, h = by_transforms(count), radii_of(count)[1], 2 * np.pi / steps
    phi, rate, forces = np.full(count, 0.8), np.zeros(count), []
    for index in range(3 * steps):
        t = h * (index + 0.5)
        move = b * 1j * np.cos(t) - a * np.sin(t)
        for _ in range(12):
            found, over_phi, over_rate, _ = rates(kernel, phi + rate * h / 2, rate, move)
            step = np.linalg.solve(over_rate + over_phi * h / 2, -found)
            rate = rate + step
            if np.abs(step).max() < 1e-12:
                break
        work = (weights @ np.exp(1j * (phi + rate * h / 2)) * move.conjugate()).real * h
        phi = phi + rate * h
        forces.append([weights @ np.exp(1j * phi), work])
    last = np.array(forces[-steps:])
    return np.array([last[steps // 4 - 1, 0], last[steps // 2 - 1, 0], last[:, 1].sum()])


def dragged(a, b, count):
    """Directions of the force after a quarter and half a steady turn, and how far the punch slides: `count` chords.

    On a chord the tangent of half the angle between force and motion falls by exp(-length): a tractrix.
    """
    places = np.exp(2j * np.pi * np.arange(count + 1) / count)
    places = a * places.real + 1j * b * places.imag
    angle = 0.0
    for _ in range(4):
        found, slid = [], 0.0
        for chord in np.diff(places):
            half = np.tan((angle - np.angle(chord)) / 2)
            before, after = 2 * np.arctan(half), 2 * np.arctan(half * np.exp(-abs(chord)))
            slid += np.log(np.sin(before) / np.sin(after))
            angle = np.angle(chord) + after
            found.append(np.exp(1j * angle))
    return np.array([found[count // 4 - 1], found[count // 2 - 1], slid])


def extrapolated(table):
    """The limit of values of ever twice as many steps that err by even powers of a step."""
    for order in range(1, len(table)):
        table = [fine + (fine - coarse) / (4**order - 1) for coarse, fine in zip(table, table[1:])]
    return table[0]


def punch():
    """A whole ellipse under a punch: a body on a spring, dragged by a constant force."""
    inputs = {name: BALL[name] for name in ("e_star", "g_star", "friction")} | {"normal_force": 10.0}
    inputs |= {"profile": {"type": "flat_punch", "radius": 1e-4}, "radii": [4e-7, 2.5e-7]}
    limit = mpf(inputs["friction"]) * mpf(inputs["normal_force"])
    unit = limit / (2 * mpf(inputs["g_star"]) * mpf(inputs["profile"]["radius"]))
    a, b = (mpf(radius) / unit for radius in inputs["radii"])
    chords = extrapolated([dragged(float(a), float(b), 256 * 2**power) for power in range(5)])
    with mp.workdps(25):
        # Over half a turn, from the opposite of where it ends: what the motion has across the force turns it.
        angle = mp.odefun(
            lambda t, y: [a * sin(t) * sin(y[0]) + b * cos(t) * cos(y[0])], 0, [mpf(float(np.angle(-chords[1])))]
        )
        rates = []
        for step in range(64):
            t = pi * step / 64
            rates.append(b * cos(t) * sin(angle(t)[0]) - a * sin(t) * cos(angle(t)[0]))
        # It slides all the way, and the trapezoidal rule has all digits of what is periodic.
        assert min(rates) > 0
        found = [*(mp.expj(angle(t)[0]) for t in (pi / 2, pi)), 2 * pi * mp.fsum(rates) / 64]
    return case("punch", inputs, limit, unit, found, chords, 1e-12)


def ball():
    """An ellipse on which a ball slides everywhere."""
    at_rest = Ball(10.0)
    unit, limit = at_rest.m * at_rest.d, 10 * at_rest.mu
    radii = [float(f"{float(unit * share):.9e}") for share in (3, 2)]
    a, b = (float(mpf(radius) / unit) for radius in radii)
    found = slid_by_angles(a, b, 8, 41)
    stepped = extrapolated([slid_by_steps(a, b, 7, 128 * 2**power) for power in range(3)])
    return case("ball", {**BALL, "normal_force": 10.0, "radii": radii}, limit, unit, found, stepped, 2e-11)


def case(name, inputs, limit, unit, found, again, room):
    """Forces and the work of a turn over mu F_N and the unit of length, as outputs."""
    for one, other in zip(found, again):
        assert abs(complex(one) - complex(other)) < room, (name, one, other)
    quarter, half, slid = found
    outputs = {
        "force_x": out("N", limit * quarter.real, limit * half.real, scale=limit),
        "force_y": out("N", limit * quarter.imag, limit * half.imag, scale=limit),
        "turn_work": out("J", limit * unit * slid.real),
    }
    return {"name": name, "inputs": inputs, "outputs": outputs}


def elliptic_motion():
    """The document."""
    return problem(
        "elliptic-motion",
        "A punch and a ball that slide round an ellipse",
        BALL_TEXT.replace("A ball of radius R (`radius`)", "A ball of radius R (`radius`) or a flat punch (`profile`)")
        .replace("slip is along x", "the shear stress of a place that slips is along its slip")
        + "Displacements along x act along x alone (Poisson's ratios as if zero). Under constant F_N the body is moved"
        " round the ellipse x = U_x cos t, y = U_y sin t with U_x and U_y of `radii`, so large that no place sticks,"
        " until turns no longer differ. Asked: the force a quarter and half a turn after x = U_x, along x and y, and"
        " the friction work of a turn.",
        "Pressure and shear stress of a punch have one form: all of it slips along one direction, as a body on a spring"
        " of the stiffness 2 G* times its radius that a force mu F_N drags (a tractrix). Its differential equation by"
        " Taylor's series in 25 digits, from a value of 13 digits on. Under a ball the directions differ by up to 17"
        " degrees: the angles at 8 radii and 41 times of half a turn by Newton's method, displacements by the kernel"
        " of a ring (an elliptic integral); more radii and times change 1e-14.",
        "Punch: the closed tractrix of straight chords, 256 to 4096 of them, extrapolated, to 1e-12. Ball: Abel"
        " transforms in place of the kernel, 7 radii, and steps of time from rest, 128 to 512 a turn, extrapolated, to"
        " 2e-11.",
        ["Johnson 1985, 10.1017/CBO9781139171731", "Jaeger 1998"],
        [punch(), ball()],
        {
            "1e-2": "a spring with a friction cap, drawn back along its force, in some hundred steps for each turn",
            "1e-4": "each ring slips its own way, and steps are of second order",
            "1e-8": "steps that are extrapolated, or of high order",
        },
    )
