"""A ball that is moved in a circle: the steady turn, seen from axes that turn with it.

In units of the contact radius, G* and the displacement of gross slip. From turning axes the steady turn is at rest: the
ball is at U on the real axis, tractions tau and displacements u of the surface are complex and depend on r alone. Inside
c all sticks, u = U; outside |tau| is mu p, and the slip U - u, times i for its rate, is along tau. With v(t) the
displacement of the method of dimensionality reduction, U inside c,

    tau(r) = -(1/pi) int_max(r, c)^1 v'/sqrt(t^2 - r^2) dt,   u(r) = U + (2/pi) int_c^r v' arccos(t/r) dt.

Beside c the tractions turn as (r - c)^e with e = 0.08, and v' grows like (t - c)^(e - 1/2): panels of polynomials each a
few times as wide as the one before, from (t - c) of 1e-24 on, follow that.
"""

import numpy as np
from numpy.polynomial.legendre import leggauss, legvander

from found.common import out, problem
from found.tangential import BALL, BALL_TEXT, Ball

GROWTH, ORDER = 8.0, 14


class Annulus:
    """Panels between c and 1, in distances from c, and what v' at their nodes gives there."""

    def __init__(self, c, depth):
        points, weights = (leggauss(2 * ORDER + 8)[0] + 1) / 2, leggauss(2 * ORDER + 8)[1] / 2
        local = (leggauss(ORDER)[0] + 1) / 2
        to_nodes = np.linalg.inv(legvander(2 * local - 1, ORDER - 1))
        ends = np.concatenate([[0.0], GROWTH ** -np.arange(depth, 0, -1.0), [0.3, 0.6, 1.0]]) * (1 - c)
        self.c, self.x = c, np.concatenate([low + (high - low) * local for low, high in zip(ends, ends[1:])])
        count, x = len(self.x), self.x[:, None]
        self.tau, self.u, self.sum = np.zeros((count, count)), np.zeros((count, count)), np.zeros(count)
        for panel, (low, high) in enumerate(zip(ends, ends[1:])):
            part = slice(panel * ORDER, (panel + 1) * ORDER)

            def values(t, low=low, high=high):
                basis = legvander(np.clip(2 * (t - low) / (high - low) - 1, -1, 1), ORDER - 1)
                return (basis.reshape(-1, ORDER) @ to_nodes).reshape(*t.shape, ORDER)

            self.sum[part] = (high - low) * (weights @ values(low + (high - low) * points))
            # t = r + s^2 and t = r - s^2 take the roots away.
            from_s, to_s = np.sqrt(np.maximum(low - x, 0)), np.sqrt(np.maximum(high - x, 0))
            s = from_s + (to_s - from_s) * points
            kernel = (to_s - from_s) * weights * 2 / np.sqrt(2 * (x + c) + s * s)
            self.tau[:, part] = -np.einsum("iq,iqk->ik", kernel, values(x + s * s)) / np.pi
            from_s, to_s = np.sqrt(np.maximum(x - high, 0)), np.sqrt(np.maximum(x - low, 0))
            s = from_s + (to_s - from_s) * points
            kernel = (to_s - from_s) * weights * 4 * s * np.arcsin(np.minimum(s / np.sqrt(2 * (x + c)), 1))
            self.u[:, part] = 2 / np.pi * np.einsum("iq,iqk->ik", kernel, values(x - s * s))
        self.limit = 2 / np.pi * np.sqrt((1 - c - self.x) * (1 + c + self.x))

    def errors(self, rise, move):
        """How far |tau| is from mu p, tau from the direction of slip, and v from 0 at the edge; with the slopes."""
        tau, slip = self.tau @ rise, -(self.u @ rise)
        edge = move + self.sum @ rise
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
            [self.sum[None], 0 * self.sum[None]],
            [0 * self.sum[None], self.sum[None]],
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
    """Stick radius, and the force over mu F_N, whose imaginary part is the work: extrapolated over the depth."""

    def begin(c, x):
        return -2 * (c + x) * move / (1 - c * c) * np.exp(-0.6j * np.minimum(1, 2 * x / (1 - c)))

    rows, c = [], np.sqrt(1 - move) * 0.97
    for depth in (3, 8, 14, 20, 26):
        ring, rise = steady(move, depth, begin, c)
        c, x = ring.c, ring.x

        def begin(c, new, x=x, rise=rise):
            near = rise[6] * (new / x[6]) ** -0.42
            at = np.log(new)
            far = np.interp(at, np.log(x), rise.real) + 1j * np.interp(at, np.log(x), rise.imag)
            return np.where(new < x[6], near, far)

        force = 1.5 * (move + ((1 - c - x) * ring.sum) @ rise)
        rows.append([c, force.real, force.imag])
    first, second, third = np.array(rows[-3:])
    found = third + (third - second) ** 2 / ((second - first) - (third - second))
    return found, np.abs(found - third).max(), (c + ring.x, np.angle(ring.tau @ rise))


def by_rings(move, c, angles, count):
    """The same by rings of constant traction, by Newton's method from these angles on."""
    r = np.sqrt(np.arange(count + 1) / count)
    points, weights = leggauss(12)
    points = (points + 1) / 2
    matrix = np.zeros((count, count))
    for low, high in zip(r, r[1:]):
        # The integrand has roots at both ends.
        t = low + (high - low) * np.sin(np.pi / 2 * points) ** 2
        roots = np.sqrt(np.maximum(r[:, None] ** 2 - t**2, 0))
        phi = 2 * np.diff(roots, axis=0)
        matrix += 2 * (phi * ((high - low) * np.pi / 2 * np.sin(np.pi * points) * weights / 2)) @ phi.T
    matrix /= (np.pi * np.diff(r**2))[:, None]
    carried = -4 / 3 * np.diff((1 - r**2) ** 1.5)
    limit = carried / (np.pi * np.diff(r**2))
    sticks = r[1:] < c
    angle = np.interp(np.sqrt((r[1:] ** 2 + r[:-1] ** 2) / 2), *angles)
    tau = limit * np.exp(1j * angle)
    for _ in range(60):
        slip = move - matrix @ tau
        # Unknown: both parts of tau where it sticks, its angle where it slips.
        turned = 1j * tau
        one, other = np.flatnonzero(sticks), np.flatnonzero(~sticks)
        inner = matrix[np.ix_(one, one)]
        cross = turned[other]
        rows = [
            [inner, 0 * inner, matrix[np.ix_(one, other)] * cross.real],
            [0 * inner, inner, matrix[np.ix_(one, other)] * cross.imag],
        ]
        back = tau.conj()[other, None]
        fixed = matrix[np.ix_(other, one)]
        moving = matrix[np.ix_(other, other)] * cross
        rows.append(
            [
                -(back * fixed).real,
                -(back * 1j * fixed).real,
                -(back * moving).real + np.diag((slip[other] * cross.conj()).real),
            ]
        )
        wanted = np.concatenate([slip[one].real, slip[one].imag, -(slip * tau.conj())[other].real])
        step = np.linalg.solve(np.block(rows), wanted)
        tau[one] += step[: len(one)] + 1j * step[len(one) : 2 * len(one)]
        tau[other] *= np.exp(1j * np.clip(step[2 * len(one) :], -0.3, 0.3))
        if np.abs(step).max() < 1e-11:
            break
    force = (tau * np.pi * np.diff(r**2)).sum() / (4 / 3)
    return force


def circular_motion():
    """The document."""
    ball = Ball(10.0)
    unit, limit = float(ball.m * ball.d), float(10 * ball.mu)
    moves = [float(f"{unit * share:.9e}") for share in (0.6, 0.3)]
    along, across, work = [], [], []
    for move in moves:
        found, last, angles = turn(move / unit)
        assert last < 1e-10, last
        force = by_rings(move / unit, found[0], angles, 200)
        assert abs(force - complex(found[1], found[2])) < 2e-4, (force, found)
        # The axes turn the other way round.
        along.append(found[1] * limit)
        across.append(-found[2] * limit)
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
        " r, complex, by polynomials on panels that are graded to the stick radius from 1e-24 on, the equations solved"
        " by the method of Gauss and Newton in doubles: 10 digits (other orders and depths differ by 1e-10).",
        "200 rings of constant stress, in the same axes: 2e-4 of mu F_N.",
        ["Jaeger 1998", "Ciavarella 2013, Journal of Strain Analysis 49, 27"],
        [{"name": "ball", "inputs": {**BALL, "normal_force": 10.0, "radii": moves}, "outputs": outputs}],
        {
            "1e-2": "each ring slips in a direction of its own; springs that slip each for itself lose 24 % less",
            "1e-4": "some tens of rings, and steps that are extrapolated",
            "1e-8": "the edge of the stick zone is resolved, beside which the stress turns as (r - c)^0.08",
        },
    )
