"""A ball that is moved in a circle: the steady turn, seen from axes that turn with it.

In units of the contact radius, G* and the displacement of gross slip. From turning axes the steady turn is at rest: the
ball is at U on the real axis, tractions tau and displacements u of the surface are complex and depend on r alone. Inside
c all sticks, u = U; outside |tau| is mu p, and the slip U - u, times i for its rate, is along tau. With v(t) the
displacement of the method of dimensionality reduction, U inside c,

    tau(r) = -(1/pi) int_max(r, c)^1 v'/sqrt(t^2 - r^2) dt,   u(r) = U + (2/pi) int_c^r v' arccos(t/r) dt.

Beside c the tractions turn as (r - c)^e with e = 0.08, and v' grows like (t - c)^(e - 1/2): panels of polynomials in
log(t - c), each eight times as wide as the one before, from (t - c) of 1e-27 on, follow that.
"""

import numpy as np
from numpy.polynomial.legendre import leggauss, legvander

from found.common import out, problem
from found.tangential import BALL, BALL_TEXT, Ball

GROWTH, ORDER = 8.0, 12
#: How much more the edge counts, which is not to err by what a panel beside c cannot follow.
EDGE = 1e5
#: Gauss's points and weights between 0 and 1.
POINTS = (leggauss(2 * ORDER + 8)[0] + 1) / 2, leggauss(2 * ORDER + 8)[1] / 2


class Annulus:
    """Panels between c and 1, in distances from c, and what v' at their nodes gives there."""

    def __init__(self, c, depth):
        local = (leggauss(ORDER)[0] + 1) / 2
        self.to_nodes = np.linalg.inv(legvander(2 * local - 1, ORDER - 1))
        self.c, self.ends = c, np.concatenate([[0.0], GROWTH ** -np.arange(depth, 0, -1.0), [0.3, 0.6, 1.0]]) * (1 - c)
        first, *pairs = zip(self.ends, self.ends[1:])
        self.x = np.concatenate([first[1] * local, *(low * (high / low) ** local for low, high in pairs)])
        self.tau, self.u = self.stresses(self.x), np.zeros((len(self.x), len(self.x)))
        self.sum = np.zeros(len(self.x))
        points, weights = POINTS
        x = self.x[:, None]
        for part, low, high, values in self.panels():
            self.sum[part] = (high - low) * (weights @ values(low + (high - low) * points))
            # t = r - s^2 takes the root away.
            from_s, to_s = np.sqrt(np.maximum(x - high, 0)), np.sqrt(np.maximum(x - low, 0))
            s = from_s + (to_s - from_s) * points
            kernel = (to_s - from_s) * weights * 4 * s * np.arcsin(np.minimum(s / np.sqrt(2 * (x + c)), 1))
            self.u[:, part] = 2 / np.pi * np.einsum("iq,iqk->ik", kernel, values(x - s * s))
        self.limit = 2 / np.pi * np.sqrt((1 - c - self.x) * (1 + c + self.x))

    def panels(self):
        """The nodes of each panel, its ends, and what the values at its nodes give between them."""
        for panel, (low, high) in enumerate(zip(self.ends, self.ends[1:])):

            def values(t, low=low, high=high):
                share = np.log(np.maximum(t, low) / low) / np.log(high / low) if low else t / high
                basis = legvander(np.clip(2 * share - 1, -1, 1), ORDER - 1)
                return (basis.reshape(-1, ORDER) @ self.to_nodes).reshape(*t.shape, ORDER)

            yield slice(panel * ORDER, (panel + 1) * ORDER), low, high, values

    def stresses(self, at):
        """What v' at the nodes gives of tau at these distances from c, which are negative within."""
        points, weights = POINTS
        found, x = np.zeros((len(at), len(self.x))), at[:, None]
        for part, low, high, values in self.panels():
            # t = r + s^2 takes the root away.
            from_s, to_s = np.sqrt(np.maximum(low - x, 0)), np.sqrt(np.maximum(high - x, 0))
            s = from_s + (to_s - from_s) * points
            kernel = (to_s - from_s) * weights * 2 / np.sqrt(2 * (x + self.c) + s * s)
            found[:, part] = -np.einsum("iq,iqk->ik", kernel, values(x + s * s)) / np.pi
        return found

    def errors(self, rise, move):
        """How far |tau| is from mu p, tau from the direction of slip, and v from 0 at the edge; with the slopes."""
        tau, slip = self.tau @ rise, -(self.u @ rise)
        edge = EDGE * (move + self.sum @ rise)
        scale = 1 / (self.limit * self.x)
        found = np.concatenate(
            [np.abs(tau) ** 2 / self.limit**2 - 1, (slip * tau.conj()).real * scale, [edge.real, edge.imag]]
        )
        rows = [
            [2 * part[:, None] * self.tau / self.limit[:, None] ** 2 for part in (tau.real, tau.imag)],
            [
                (of_slip[:, None] * self.tau - of_tau[:, None] * self.u) * scale[:, None]
                for of_slip, of_tau in ((slip.real, tau.real), (slip.imag, tau.imag))
            ],
            [EDGE * self.sum[None], 0 * self.sum[None]],
            [0 * self.sum[None], EDGE * self.sum[None]],
        ]
        return found, np.block(rows)


def steady(move, depth, rise, c):
    """v' at the nodes and c, by the method of Gauss and Newton; `rise` gives v' to begin with."""
    ring = Annulus(c, depth)
    rise = rise(c, ring.x)
    for _ in range(40):
        found, slopes = ring.errors(rise, move)
        h = 1e-6
        over_c = (Annulus(c + h, depth).errors(rise, move)[0] - found) / h
        # Unknowns of the size that v' has.
        scale = np.concatenate([ring.x**-0.42, ring.x**-0.42, [1.0]])
        step = np.linalg.lstsq(np.column_stack([slopes, over_c]) * scale, -found, rcond=1e-17)[0] * scale
        part = min(1.0, 0.02 / abs(step[-1]))
        while True:
            moved = rise + part * (step[: len(rise)] + 1j * step[len(rise) : -1])
            ring = Annulus(c + part * step[-1], depth)
            if np.linalg.norm(ring.errors(moved, move)[0]) < 1.0001 * np.linalg.norm(found) or part < 1e-3:
                break
            part /= 2
        rise, c = moved, ring.c
        if part == 1 and abs(step[-1]) < 1e-10:
            break
    return ring, rise


def turn(move):
    """The force over mu F_N, whose imaginary part is the work, with panels ever nearer to c."""

    def begin(c, x):
        return -2 * (c + x) * move / (1 - c * c) * np.exp(-0.6j * np.minimum(1, 2 * x / (1 - c)))

    force, c = 0.0, np.sqrt(1 - move) * 0.97
    for depth in (3, 8, 14, 20, 26, 30):
        before, (ring, rise) = force, steady(move, depth, begin, c)
        c, x = ring.c, ring.x

        def begin(c, new, x=x, rise=rise):
            near = rise[6] * (new / x[6]) ** -0.42
            at = np.log(new)
            far = np.interp(at, np.log(x), rise.real) + 1j * np.interp(at, np.log(x), rise.imag)
            return np.where(new < x[6], near, far)

        force = 1.5 * (move + ((1 - c - x) * ring.sum) @ rise)
    worst, rings = as_rings(ring, rise, move)
    assert abs(force - before) < 1e-10, (force, before)
    assert worst < 1e-9, worst
    assert abs(rings - force) < 1e-10, (rings, force)
    return force


def mean(one, other):
    """The arithmetic-geometric mean of Gauss."""
    for _ in range(60):
        one, other = (one + other) / 2, np.sqrt(one * other)
    return one


def halves(ends):
    """Places between singular points, as an end and the distance from it, with weights: the double exponential rule."""
    t = np.arange(-4.59, 0.0, 0.02)
    share = 1 / (1 + np.exp(-np.pi * np.sinh(t)))
    weight = 0.02 * np.pi * np.cosh(t) * share * (1 - share)
    for low, high in zip(ends, ends[1:]):
        for end, sign in ((low, 1), (high, -1)):
            yield end, sign * (high - low) * share, (high - low) * weight


def as_rings(ring, rise, move):
    """How far tractions are from the law, by the displacements of the rings that they are, and their force.

    A ring of the radius s and the width ds has the displacement 2 tau s ds/M(r + s, |r - s|), M the mean of Gauss: an
    elliptic integral, without the method of dimensionality reduction.
    """
    c, worst = ring.c, 0.0

    def tau(end, off):
        return ring.stresses(off if end == 0.0 else end + off) @ rise

    force = sum(
        (weight * (c + end + off) * tau(end, off)).sum() for end, off, weight in halves([-c, 0.0, 1 - c])
    )
    places = np.array([-1.0, -0.7, -0.3, -0.1, -1e-2, -1e-4]) * c
    places = [*places, *np.array([1e-5, 1e-3, 0.02, 0.1, 0.3, 0.5, 0.7, 0.9, 0.99]) * (1 - c)]
    for x in places:
        displacement = 0.0
        for end, off, weight in halves(sorted({-c, 0.0, x, 1 - c})):
            s, apart = c + end + off, np.abs(off) if end == x else np.abs(end + off - x)
            displacement += (weight * 2 * tau(end, off) * s / mean(c + x + s, apart)).sum()
        slip, limit = move - displacement, 2 / np.pi * np.sqrt((1 - c - x) * (1 + c + x))
        shear = complex(tau(x, np.zeros(1))[0]) if x else 0
        if x < 0:
            worst = max(worst, abs(slip))
            assert abs(shear) < limit
        else:
            worst = max(worst, abs(abs(shear) / limit - 1), abs((slip * shear.conjugate()).real) / limit)
            # The axes turn with the clock: the rate of the slip, -i times it, is along the shear stress.
            assert (1j * slip * shear.conjugate()).real < 0
    return worst, 2 * np.pi * force / (4 / 3)


def circular_motion():
    """The document."""
    ball = Ball(10.0)
    unit, limit = float(ball.m * ball.d), float(10 * ball.mu)
    moves = [float(f"{unit * share:.9e}") for share in (0.6, 0.3)]
    along, across, work = [], [], []
    for move in moves:
        force = turn(move / unit)
        # The axes turn the other way round.
        along.append(force.real * limit)
        across.append(-force.imag * limit)
        work.append(2 * np.pi * move * across[-1])
    outputs = {
        "force_x": out("N", *along, scale=limit),
        "force_y": out("N", *across, scale=limit),
        "turn_work": out("J", *work, scale=limit * unit),
    }
    return problem(
        "circular-motion",
        "A ball that is moved in a circle",
        BALL_TEXT.replace("slip is along x", "the shear stress of a place that slips is along its slip")
        + "Displacements along x act along x alone (Poisson's ratios as if zero). Under constant F_N the ball is moved"
        " in x to each of `radii` and then round circles x = U cos t, y = U sin t, until turns no longer differ. Asked:"
        " the force at the end of a turn, along x and y, and the friction work of a turn.",
        "Seen from axes that turn with the ball the steady turn is at rest: stress and displacement of the surface over"
        " r, complex, by polynomials on panels that are graded to the stick radius from 1e-27 on, the equations solved"
        " by the method of Gauss and Newton in doubles: 10 digits.",
        "The displacements of the surface under these stresses by the kernel of a ring, an elliptic integral, at 15"
        " places: inside c they are U, outside the rate of the slip is along the stress, to 1e-9 of gross slip; the"
        " integral of the stress is the force to 1e-10 of mu F_N.",
        ["Jaeger 1998", "Ciavarella 2013, Journal of Strain Analysis 49, 27"],
        [{"name": "ball", "inputs": {**BALL, "normal_force": 10.0, "radii": moves}, "outputs": outputs}],
        {
            "1e-2": "each ring slips in a direction of its own; springs that slip each for itself lose 24 % less",
            "1e-4": "some tens of rings, and steps that are extrapolated",
            "1e-8": "the edge of the stick zone is resolved, beside which the stress turns as (r - c)^0.08",
        },
    )
