"""Steady oscillations of a mass on a contact at constant load, by integration in time from rest.

M U'' + F = P cos(w t) in units of gross slip: displacement over u_max, force over mu F_N, frequency over that of small
oscillations. The first loading curve of each profile is a closed form; every later branch is Masing's, and the turning points
are kept in a list that closed loops leave. The motion is followed by SciPy's DOP853, begun anew at each turning point and
each closed loop, which are located on its dense output, until no period differs from the one before by more than 1e-10 of
the peak; cases that do not come so far in 1500 periods are left out. The solver's method is another: two unknowns of half a
period, and steps of extrapolation.

    python resonance.py [CASES] > resonance.csv

Needs numpy and scipy. Writes family,parameter,frequency,drive_force,amplitude,phase,peak,change: the first harmonic of the
displacement, its lag in rad, half the range of the displacement, and the last change of the peak from period to period.
"""
import math
import random
import sys

import numpy as np
from scipy.integrate import DOP853
from scipy.optimize import brentq

TOLERANCE = 1e-11
PERIODS = 1500


def power(exponent):
    """z = c r^n: F = 1 - (1 - u)^(1 + 1/n)."""
    share = 1 + 1 / exponent
    return lambda u: 1.0 if u >= 1 else -math.expm1(share * math.log1p(-u)), share


def worn(flat):
    """A ball with a flat of radius b = `flat` times the contact radius: g = (x/R) sqrt(x^2 - b^2)."""
    depth = math.sqrt(1 - flat * flat)

    def load(level):
        square = 0.5 * (flat**2 + math.sqrt(flat**4 + 4 * level * level))
        return math.sqrt(square) * level - max(square - flat * flat, 0.0) ** 1.5 / 3

    whole = load(depth)
    return lambda u: 1.0 if u >= 1 else 1 - load(depth * (1 - u)) / whole, depth / whole


def first_loading(family, parameter):
    return worn(parameter) if family == "worn" else power(parameter)


class Loop:
    """Turning points and the direction of the branch."""

    def __init__(self, curve):
        self.curve, self.turns, self.way = curve, [], 1

    def force(self, u):
        if not self.turns:
            return self.way * self.curve(max(self.way * u, 0.0))
        start, force = self.turns[-1]
        return force + 2 * self.way * self.curve(max(self.way * (u - start) / 2, 0.0))

    def end(self):
        """Where the branch closes a loop."""
        if not self.turns:
            return self.way * math.inf
        return -self.turns[0][0] if len(self.turns) == 1 else self.turns[-2][0]

    def sliding(self):
        return self.way if not self.turns else self.turns[-1][0] + 2 * self.way


def period(loop, state, index, curvature, drive):
    """One period from the angle 2 pi index on: the state at its end, its turning points and the harmonic."""

    def rate(angle, y):
        u, v = y[0], y[1]
        return [v, curvature * (drive * math.cos(angle) - loop.force(u)), u * math.cos(angle), u * math.sin(angle)]

    angle, end = 0.0, 2 * math.pi
    y = np.array([state[0], state[1], 0.0, 0.0])
    turns = []
    longest = 0.25 / max(1.0, math.sqrt(1.3 * curvature))
    while angle < end:
        solver = DOP853(rate, angle, y, end, rtol=TOLERANCE, atol=TOLERANCE, max_step=longest)
        if y[1] * loop.way < 0 or (y[1] == 0 and rate(angle, y)[1] * loop.way < 0):
            loop.turns.append((y[0], loop.force(y[0])))
            loop.way = -loop.way
            solver = DOP853(rate, angle, y, end, rtol=TOLERANCE, atol=TOLERANCE, max_step=longest)
        while solver.status == "running":
            solver.step()
            dense = solver.dense_output()
            low, high = solver.t_old, solver.t
            events = []
            if loop.way * solver.y[1] < 0:
                from_ = low + 1e-9 * (high - low)
                if loop.way * dense(from_)[1] > 0:
                    events.append((brentq(lambda t: dense(t)[1], from_, high, xtol=1e-14), "turn"))
            for name, level in (("slide", loop.sliding()), ("close", loop.end())):
                gap = lambda t: loop.way * (dense(t)[0] - level)
                last = events[0][0] if events else high
                if math.isfinite(level) and gap(low) < -1e-13 and gap(last) > 0:
                    events.append((brentq(gap, low, last, xtol=1e-14), name))
            if events:
                angle, name = min(events)
                y = dense(angle)
                if name == "turn":
                    y[1] = 0.0
                    turns.append(y[0])
                    loop.turns.append((y[0], loop.force(y[0])))
                    loop.way = -loop.way
                elif name == "close":
                    y[0] = loop.end()
                    del loop.turns[-2:]
                else:
                    y[0] = loop.sliding()
                break
        else:
            angle, y = end, solver.y
    return y, turns


def steady(family, parameter, frequency, drive):
    curve, stiffness = first_loading(family, parameter)
    curvature = 1 / (stiffness * frequency**2)
    loop, state, before = Loop(curve), (0.0, 0.0), 0.0
    for index in range(PERIODS):
        y, turns = period(loop, state, index, curvature, drive)
        state = (y[0], y[1])
        peak = 0.5 * (max(turns) - min(turns)) if len(turns) > 1 else 0.0
        change = abs(peak - before)
        if index > 10 and change <= 1e-10 * peak and change_before <= 1e-10 * peak:
            cos, sin = y[2] / math.pi, y[3] / math.pi
            return math.hypot(cos, sin), math.atan2(sin, cos), peak, change
        before, change_before = peak, change
    return None


def main():
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 52
    chosen = random.Random(20)
    families = [("power", 1.0), ("power", 2.0), ("power", 3.0), ("power", 1.5), ("power", 8.0), ("worn", 0.6)]
    print("family,parameter,frequency,drive_force,amplitude,phase,peak,change")
    cases = [("power", 2.0, 0.29, 0.7)]
    for index in range(count):
        frequency = math.exp(chosen.uniform(math.log(0.15), math.log(2)))
        cases.append((*families[index % len(families)], frequency, chosen.uniform(0.05, 1.5)))
    for case in cases:
        found = steady(*case)
        if found:
            print(",".join(str(value) for value in (*case, *found)), flush=True)
        else:
            print("not steady:", *case, file=sys.stderr)


if __name__ == "__main__":
    main()
