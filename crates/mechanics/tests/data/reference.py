"""Frictional contact in many digits: an independent reference, put to work by `scenes.py`.

It needs mpmath alone (gmpy2 makes it ten times faster). It shares no code and no shortcut with the crate:

- a profile is its g and g' in closed form, each checked against the definition g = x int_0^x f'(r)/sqrt(x^2 - r^2) dr by
  quadrature, and against a numerical derivative;
- the tangential state w(y) is a list of nodes that every move clamps as a whole, whatever the order of slip; it is checked
  against independent points that are followed one by one from event to event;
- forces, energies and fields are integrals over x by the tanh-sinh rule, broken at every kink, the singular end of a stress
  substituted away by x^2 = r^2 + v^2; friction work is summed point by point over the events;
- paths straight in a force are cut where slip sets in or ends; each arc is checked against itself in more arcs.

Inputs are doubles taken at their exact values, written so that they read back to the bit. Results are given to 22 digits.
Units are scaled as in `mechanics/mod.rs`: y = g(x), w = u_x/m, W = U/m, m = mu E*/G*.
"""

import random
from functools import lru_cache

from mpmath import mp, mpf, inf, pi

mp.dps = 60


# ---------------------------------------------------------------------------------------------------------- quadrature

@lru_cache(maxsize=None)
def rule(level, digits):
    """Nodes and weights on (-1, 1) that level `level` of the tanh-sinh rule adds to the levels before."""
    step = mpf(2) ** -level
    tiny = mpf(10) ** (-digits - 10)
    nodes = []
    index = 0 if level == 0 else 1
    while True:
        t = index * step
        s = pi / 2 * mp.sinh(t)
        weight = pi / 2 * mp.cosh(t) / mp.cosh(s) ** 2
        if weight < tiny:
            return nodes
        x = mp.tanh(s)
        nodes.append((x, weight))
        if index:
            nodes.append((-x, weight))
        index += 1 if level == 0 else 2


def quad(f, a, b, depth=0):
    """int_a^b f, to 22 digits of the integral of |f| and, by the quadratic convergence of the rule, to far more."""
    if not a < b:
        return mpf(0)
    half, middle = (b - a) / 2, (a + b) / 2
    total, size, before = mpf(0), mpf(0), None
    for level in range(9):
        for x, weight in rule(level, mp.dps):
            point = middle + half * x
            if a < point < b:
                term = weight * f(point)
                total += term
                size += abs(term)
        now = total * half * mpf(2) ** -level
        # At the lowest levels two sums may agree by chance.
        if level > 3 and abs(now - before) <= mpf(10) ** -22 * size * half * mpf(2) ** -level:
            return now
        before = now
    assert depth < 12, f"no convergence on ({mp.nstr(a, 8)}, {mp.nstr(b, 8)})"
    return quad(f, a, middle, depth + 1) + quad(f, middle, b, depth + 1)


def pieces(points):
    """Neighbours in a sorted list without its repetitions."""
    points = sorted(set(points))
    return list(zip(points, points[1:]))


def increasing_root(f, low, high):
    """The root of a function that does not fall, to nearly all digits: bisection whenever the secant lags behind."""
    f_low, f_high = f(low), f(high)
    if f_low >= 0:
        return low
    if f_high <= 0:
        return high
    tiny = mpf(10) ** (6 - mp.dps)
    side = 0
    for count in range(2000):
        width = high - low
        if width <= tiny * max(abs(high), abs(low)):
            break
        guess = (low * f_high - high * f_low) / (f_high - f_low)
        if count % 3 == 2 or not low < guess < high:
            guess = (low + high) / 2
            if low > 0 and high > 4 * low:
                guess = mp.sqrt(low * high)
        value = f(guess)
        if value == 0:
            return guess
        if value > 0:
            high, f_high = guess, value
            if side > 0:
                f_low /= 2
            side = 1
        else:
            low, f_low = guess, value
            if side < 0:
                f_high /= 2
            side = -1
    return (low + high) / 2


# ------------------------------------------------------------------------------------------------------------ profiles

class Profile:
    """g and g' for x >= 0, f' for the definition. `breaks`: radii at which g is not analytic; `rim`: a vertical edge."""

    core = mpf(0)
    rim = None
    ceiling = None

    def __init__(self, breaks=()):
        self.breaks = sorted(set(breaks))

    def radius(self, level):
        """X(y)."""
        if self.rim is not None and level >= self.g(self.rim):
            return self.rim
        if level <= 0:
            return self.core
        low, high = self.core, None
        guess = self.ceiling or self.core or mpf(1)
        if self.ceiling is not None:
            high = self.ceiling
        else:
            while self.g(guess) < level:
                low, guess = guess, guess * 2
            while self.core == 0 and low == 0 and self.g(guess / 2) > level:
                guess /= 2
            high = guess
            if self.core == 0 and low == 0:
                low = guess / 2
        if self.rim is not None:
            high = min(high, self.rim)
        # Above a core g may start like (x^2 - b^2)^(3/2): solved for in the excess over the core.
        if self.core > 0:
            low = max(low, self.core)
            excess = increasing_root(lambda e: self.g(self.core + e) - level, low - self.core, high - self.core)
            return self.core + excess
        if high == self.ceiling:
            # g is infinite there.
            high *= 1 - mpf(10) ** (10 - mp.dps)
        return increasing_root(lambda x: self.g(x) - level, low, high)

    def spans(self, low, high):
        """(low, high) broken where g is not analytic, and by decades above a small core."""
        points = [low, high] + [x for x in self.breaks if low < x < high]
        for x in self.breaks:
            near = x * 30
            while near < high:
                if near > low:
                    points.append(near)
                near *= 1000
        return pieces(points)

    def check(self, radii):
        """g against its definition, g' against a difference."""
        for x in radii:
            x = mpf(x)
            # r = x sin(t) takes the root away.
            turns = [mp.asin(b / x) for b in self.breaks if b < x]
            direct = sum(
                quad(lambda t: x * self.f_slope(x * mp.sin(t)), low, high) for low, high in pieces([mpf(0), *turns, pi / 2])
            )
            assert abs(direct - self.g(x)) <= mpf(10) ** -20 * abs(direct), (type(self), x)
            step = x * mpf(10) ** -20
            numeric = (self.g(x + step) - self.g(x - step)) / (2 * step)
            assert abs(numeric - self.dg(x)) <= mpf(10) ** -15 * (abs(numeric) + self.g(x) / x), (type(self), x)


class Sphere(Profile):
    def __init__(self, radius):
        super().__init__()
        self.r = radius

    def f_slope(self, r):
        return r / self.r

    def g(self, x):
        return x * x / self.r

    def dg(self, x):
        return 2 * x / self.r


class ExactSphere(Profile):
    def __init__(self, radius):
        super().__init__()
        self.r = radius
        self.ceiling = radius

    def f_slope(self, r):
        return r / mp.sqrt((self.r - r) * (self.r + r))

    def g(self, x):
        return x / 2 * mp.log((self.r + x) / (self.r - x))

    def dg(self, x):
        return self.g(x) / x + x * self.r / ((self.r - x) * (self.r + x)) if x else mpf(0)


class Cone(Profile):
    def __init__(self, slope):
        super().__init__()
        self.t = slope

    def f_slope(self, _):
        return self.t

    def g(self, x):
        return pi * self.t * x / 2

    def dg(self, _):
        return pi * self.t / 2


class PowerLaw(Profile):
    def __init__(self, exponent, coefficient):
        super().__init__()
        self.n, self.c = exponent, coefficient
        self.k = coefficient * mp.sqrt(pi) * mp.gamma(exponent / 2 + 1) / mp.gamma((exponent + 1) / 2)

    def f_slope(self, r):
        return self.c * self.n * r ** (self.n - 1)

    def g(self, x):
        return self.k * x ** self.n

    def dg(self, x):
        return self.k * self.n * x ** (self.n - 1)


class FlatPunch(Profile):
    def __init__(self, radius):
        super().__init__()
        self.core = self.rim = radius

    def f_slope(self, _):
        return mpf(0)

    def g(self, _):
        return mpf(0)

    def dg(self, _):
        return mpf(0)


class TruncatedCone(Profile):
    def __init__(self, slope, flat):
        super().__init__([flat])
        self.t, self.core = slope, flat

    def f_slope(self, r):
        return self.t if r > self.core else mpf(0)

    def g(self, x):
        return self.t * x * mp.acos(self.core / x) if x > self.core else mpf(0)

    def dg(self, x):
        if x <= self.core:
            return mpf(0)
        return self.t * (mp.acos(self.core / x) + self.core / mp.sqrt((x - self.core) * (x + self.core)))


class TruncatedSphere(Profile):
    def __init__(self, radius, flat):
        super().__init__([flat])
        self.r, self.core = radius, flat

    def f_slope(self, r):
        return r / self.r if r > self.core else mpf(0)

    def g(self, x):
        return x / self.r * mp.sqrt((x - self.core) * (x + self.core)) if x > self.core else mpf(0)

    def dg(self, x):
        if x <= self.core:
            return mpf(0)
        return (2 * x * x - self.core ** 2) / (self.r * mp.sqrt((x - self.core) * (x + self.core)))


class RoundedPunch(Profile):
    def __init__(self, flat, edge):
        super().__init__([flat])
        self.core, self.r = flat, edge

    def f_slope(self, r):
        return max(r - self.core, mpf(0)) / self.r

    def g(self, x):
        if x <= self.core:
            return mpf(0)
        return x / self.r * (mp.sqrt((x - self.core) * (x + self.core)) - self.core * mp.acos(self.core / x))

    def dg(self, x):
        if x <= self.core:
            return mpf(0)
        return (2 * mp.sqrt((x - self.core) * (x + self.core)) - self.core * mp.acos(self.core / x)) / self.r


class RoundedCone(Profile):
    def __init__(self, slope, tip):
        super().__init__([tip])
        self.t, self.b = slope, tip

    def f_slope(self, r):
        return self.t * min(r / self.b, mpf(1))

    def g(self, x):
        if x <= self.b:
            return self.t * x * x / self.b
        root = mp.sqrt((x - self.b) * (x + self.b))
        return self.t * x * (self.b / (x + root) + mp.acos(self.b / x))

    def dg(self, x):
        if x <= self.b:
            return 2 * self.t * x / self.b
        root = mp.sqrt((x - self.b) * (x + self.b))
        return self.t * (2 * self.b / (x + root) + mp.acos(self.b / x))


class Tabulated(Profile):
    """Points joined by parabolas, f' without jumps. The rule, as documented: f' at a point is that of the parabola through it
    and its neighbours, zero at the centre, at a peak and beside a flat, and drawn to the chords where these change little; between two points
    one parabola if it fits, else two (Schumaker 1983)."""

    def __init__(self, *numbers):
        radii, heights = numbers[::2], numbers[1::2]
        chords = [(z1 - z0) / (r1 - r0) for r0, z0, r1, z1 in zip(radii, heights, radii[1:], heights[1:])]
        slopes = [mpf(0)]
        for (r0, r1, r2), before, after in zip(zip(radii, radii[1:], radii[2:]), chords, chords[1:]):
            slopes.append(before + (after - before) * (r1 - r0) / (r2 - r0))
        slopes.append(chords[-1] + (chords[-1] - chords[-2]) * (radii[-1] - radii[-2]) / (radii[-1] - radii[-3]))
        for i in range(1, len(chords)):
            if chords[i - 1] * chords[i] <= 0:
                slopes[i] = mpf(0)

        def within(i, chord, most):
            slopes[i] = chord + max(-most, min(most, slopes[i] - chord))

        for i, chord in enumerate(chords):
            if (slopes[i] - chord) * chord > 0 and (slopes[i + 1] - chord) * chord > 0:
                within(i, chord, abs(chord))
                within(i + 1, chord, abs(chord))
        for i in range(len(chords) - 1, 0, -1):
            within(i, chords[i], 7 * abs(slopes[i + 1] - chords[i]))
        for i, chord in enumerate(chords):
            within(i + 1, chord, 7 * abs(slopes[i] - chord))
        self.knots = [(radii[0], slopes[0])]
        for r0, r1, s0, s1, chord in zip(radii, radii[1:], slopes, slopes[1:], chords):
            left, right = s0 - chord, s1 - chord
            size = abs(left) + abs(right)
            if abs(left + right) > mpf(10) ** -12 * (size + abs(chord)):
                share = min(max(abs(right) / size, mpf(1) / 8), mpf(7) / 8)
                self.knots.append((r0 + share * (r1 - r0), 2 * chord - s0 * share - s1 * (1 - share)))
            self.knots.append((r1, s1))
        bends = [(s1 - s0) / (r1 - r0) for (r0, s0), (r1, s1) in zip(self.knots, self.knots[1:])]
        self.changes = [(r, after - before) for (r, _), before, after in zip(self.knots, [mpf(0), *bends], bends) if after != before]
        super().__init__([r for r, _ in self.changes if r > 0])
        self.core = self.changes[0][0]

    def f_slope(self, r):
        return sum(change * (r - b) for b, change in self.changes if r > b)

    def g(self, x):
        total = mpf(0)
        for b, change in self.changes:
            if x > b:
                total += change * x * (mp.sqrt((x - b) * (x + b)) - (b * mp.acos(b / x) if b else 0))
        return total

    def dg(self, x):
        total = mpf(0)
        for b, change in self.changes:
            if x > b:
                total += change * (2 * mp.sqrt((x - b) * (x + b)) - (b * mp.acos(b / x) if b else 0))
        return total


class Sum(Profile):
    def __init__(self, parts):
        super().__init__([b for part in parts for b in [*part.breaks, part.rim] if b is not None and b > 0])
        self.parts = parts
        self.core = min(part.core for part in parts)
        rims = [part.rim for part in parts if part.rim is not None]
        self.rim = min(rims) if rims else None
        ceilings = [part.ceiling for part in parts if part.ceiling is not None]
        self.ceiling = min(ceilings) if ceilings else None

    def f_slope(self, r):
        return sum(part.f_slope(r) for part in self.parts)

    def g(self, x):
        return sum(part.g(x) for part in self.parts)

    def dg(self, x):
        return sum(part.dg(x) for part in self.parts)


FAMILIES = {
    "sphere": Sphere,
    "exact_sphere": ExactSphere,
    "cone": Cone,
    "power_law": PowerLaw,
    "flat_punch": FlatPunch,
    "truncated_cone": TruncatedCone,
    "truncated_sphere": TruncatedSphere,
    "rounded_punch": RoundedPunch,
    "rounded_cone": RoundedCone,
    "tabulated": Tabulated,
}


def exact(number):
    """The exact value of a double."""
    assert isinstance(number, (float, int))
    return mpf(number)


def profile_of(words):
    """From ("sphere", 1.0), or ("sum", (...), (...))."""
    if words[0] == "sum":
        return Sum([profile_of(part) for part in words[1:]])
    return FAMILIES[words[0]](*map(exact, words[1:]))


def written(words):
    if words[0] == "sum":
        return "sum " + " + ".join(written(part) for part in words[1:])
    return " ".join([words[0], *(repr(float(number)) for number in words[1:])])


# ------------------------------------------------------------------------------------------------------------- contact

class Node:
    """A point of w(y)."""

    __slots__ = ("y", "w")

    def __init__(self, y, w):
        self.y, self.w = y, w


def clamp(value, bound):
    return max(-bound, min(bound, value))


class Contact:
    """The state w(y) as nodes, the whole of which each straight move clamps; the history, to follow single points."""

    def __init__(self, profile, e_star, g_star, friction, indentation):
        self.profile, self.e, self.g, self.mu = profile, e_star, g_star, friction
        self.m = friction * e_star / g_star
        self.d, self.w = indentation, mpf(0)
        self.nodes = [Node(mpf(0), mpf(0)), Node(self.d, mpf(0))] if self.d > 0 else []
        self.history = [(self.d, self.w)]
        self.levels = {self.d}
        self.stuck = None
        self.keep_levels = True

    def move(self, d1, w1):
        """Straight to indentation d1 and scaled displacement w1."""
        d0, w0 = self.d, self.w
        self.history.append((d1, w1))
        self.stuck = None
        if d0 <= 0:
            if d1 <= 0:
                self.d, self.w = d1, w1
                return
            w0 += (w1 - w0) * (-d0) / (d1 - d0)
            d0 = mpf(0)
            self.nodes = [Node(mpf(0), mpf(0))]
        if d1 <= 0:
            if self.keep_levels:
                self.note_lift(d0, w0, d1, w1)
            self.nodes = []
            self.d, self.w = d1, w1
            return
        if self.keep_levels and d1 < d0:
            self.note_lift(d0, w0, d1, w1)
        advance = w1 - w0
        moved = [Node(node.y, node.w + advance) for node in self.nodes]
        if d1 > d0:
            moved.append(Node(d1, mpf(0)))
        else:
            while len(moved) > 1 and moved[-2].y >= d1:
                moved.pop()
            if moved[-1].y > d1:
                before, last = moved[-2], moved[-1]
                share = (d1 - before.y) / (last.y - before.y)
                moved[-1] = Node(d1, before.w + (last.w - before.w) * share)
        out = [Node(moved[0].y, clamp(moved[0].w, d1 - moved[0].y))]
        slips = abs(moved[0].w) > d1 - moved[0].y
        first_slip = moved[0].y if slips else None
        for before, after in zip(moved, moved[1:]):
            span = after.y - before.y
            if span <= 0:
                continue
            cuts = []
            for sign in (1, -1):
                # Excess of sign w over the bound d1 - y at both ends.
                low, high = sign * before.w - (d1 - before.y), sign * after.w - (d1 - after.y)
                if low < 0 < high or high < 0 < low:
                    y = before.y + span * low / (low - high)
                    cuts.append(Node(y, sign * (d1 - y)))
            ends = [*sorted(cuts, key=lambda node: node.y), Node(after.y, clamp(after.w, d1 - after.y))]
            if first_slip is None:
                if cuts:
                    first_slip = ends[0].y
                elif abs(after.w) > d1 - after.y:
                    # The node before lay on the bound.
                    first_slip = before.y
            out.extend(ends)
        self.stuck = first_slip
        self.nodes = straightened(out)
        self.d, self.w = d1, w1
        if self.keep_levels:
            self.levels.update(node.y for node in self.nodes)

    def note_lift(self, d0, w0, d1, w1):
        """Levels at which a point is carried to neither side when it lifts off: the work changes its form there."""
        slope = (w1 - w0) / (d0 - d1)
        lowest = max(d1, mpf(0))
        self.levels.add(lowest)
        for before, after in zip(self.nodes, self.nodes[1:]):
            low, high = (node.w + slope * (d0 - node.y) for node in (before, after))
            if low * high < 0:
                y = before.y + (after.y - before.y) * low / (low - high)
                if y > lowest:
                    self.levels.add(y)

    def segments(self):
        """(y0, w0, y1, w1) from the centre outward."""
        return [(n0.y, n0.w, n1.y, n1.w) for n0, n1 in zip(self.nodes, self.nodes[1:])]

    def at(self, y):
        for y0, w0, y1, w1 in self.segments():
            if y <= y1:
                return w0 + (w1 - w0) * (y - y0) / (y1 - y0)
        return mpf(0)

    def follow(self, y):
        """w of the one point at level y, and the work on it over 2 G* m^2, from event to event."""
        w, work = mpf(0), mpf(0)
        for (d0, w0), (d1, w1) in zip(self.history, self.history[1:]):
            dd, dw = d1 - d0, w1 - w0
            start, end = mpf(0), mpf(1)
            if d0 <= y:
                w = mpf(0)
                if d1 <= y:
                    continue
                start = (y - d0) / dd
            elif d1 <= y:
                end = (y - d0) / dd
            bound = d0 + dd * start - y
            sooner = None
            for sign in (1, -1):
                closing = sign * dw - dd
                if closing > 0:
                    instant = start + max((bound - sign * w) / closing, mpf(0))
                    if instant < end and (sooner is None or instant < sooner[0]):
                        sooner = (instant, sign, closing)
            if sooner is None:
                w += dw * (end - start)
            else:
                instant, sign, rate = sooner
                first, last = d0 + dd * instant - y, d0 + dd * end - y
                work += rate * (end - instant) * (first + last) / 2
                w = sign * last
        return w, work

    def check(self, seed=1):
        """The nodes against single points."""
        chance = random.Random(seed)
        for y0, w0, y1, w1 in self.segments():
            if y1 - y0 < mpf(10) ** -40 * self.d:
                continue
            share = mpf(chance.random())
            found, _ = self.follow(y0 + (y1 - y0) * share)
            expected = w0 + (w1 - w0) * share
            assert abs(found - expected) <= mpf(10) ** (20 - mp.dps) * (self.d + abs(self.w)), (found, expected)

    # What is asked for.

    def radius(self):
        return self.profile.radius(self.d) if self.d >= 0 else mpf(0)

    def stick_radius(self):
        if self.d <= 0:
            return mpf(0)
        return self.radius() if self.stuck is None else self.profile.radius(self.stuck) if self.stuck > 0 else mpf(0)

    def integral(self, segments, value):
        """sum int value(y0, w0, slope, g) dx over segments of w, the flat core included."""
        total = mpf(0)
        radii = [self.profile.radius(y) for y in [segments[0][0], *(segment[2] for segment in segments)]]
        if segments[0][0] == 0 and self.profile.core > 0:
            y0, w0, _, _ = segments[0]
            total += self.profile.core * value(y0, w0, mpf(0), y0)
        for (y0, w0, y1, w1), low, high in zip(segments, radii, radii[1:]):
            slope = (w1 - w0) / (y1 - y0)
            for a, b in self.profile.spans(low, high):
                total += quad(lambda x: value(y0, w0, slope, self.profile.g(x)), a, b)
        return total

    def force(self):
        if self.d <= 0:
            return mpf(0)
        carried = self.integral(self.segments(), lambda y0, w0, slope, y: w0 + slope * (y - y0))
        return 2 * self.g * self.m * carried

    def normal_force(self):
        return load(self.profile, self.e, self.d)

    def elastic(self):
        if self.d <= 0:
            return mpf(0)
        squares = self.integral(self.segments(), lambda y0, w0, slope, y: (w0 + slope * (y - y0)) ** 2)
        return self.g * self.m ** 2 * squares

    def dissipated(self):
        """Per point the work is a parabola in y between the levels at which anything ever changed."""
        top = max(d for d, _ in self.history)
        if top <= 0:
            return mpf(0)
        levels = sorted(level for level in {*self.levels, mpf(0), top} if 0 <= level <= top)
        # Crossings are computed anew by every move: what is closer than this is the same.
        distinct = [levels[0]]
        for level in levels[1:]:
            if level - distinct[-1] > mpf(10) ** (15 - mp.dps) * top:
                distinct.append(level)
        total = mpf(0)
        if self.profile.core > 0:
            total += self.profile.core * self.follow(mpf(0))[1]
        for low, high in zip(distinct, distinct[1:]):
            span = high - low
            first, middle, last, proof = (self.follow(low + span * mpf(k) / 8)[1] for k in (1, 4, 7, 3))
            # Newton's form on the nodes 1/8, 1/2, 7/8.
            rise = (middle - first) / mpf("0.375")
            bend = ((last - middle) / mpf("0.375") - rise) / mpf("0.75")
            form = lambda t: first + (t - mpf("0.125")) * (rise + (t - mpf("0.5")) * bend)
            size = abs(first) + abs(middle) + abs(last)
            assert abs(form(mpf("0.375")) - proof) <= mpf(10) ** -25 * size, "a level is missing"
            if size == 0:
                continue
            x0, x1 = self.profile.radius(low), self.profile.radius(high)
            for a, b in self.profile.spans(x0, x1):
                total += quad(lambda x: form((self.profile.g(x) - low) / span), a, b)
        return 2 * self.g * self.m ** 2 * total

    def stress(self, r, segments, edge):
        """-(1/pi) int u'(x)/sqrt(x^2 - r^2) dx for u = w(g(x)), and what a vertical edge adds."""
        total, a = mpf(0), self.radius()
        if r >= a:
            return mpf(0)
        for y0, w0, y1, w1 in segments:
            slope = (w1 - w0) / (y1 - y0)
            low, high = self.profile.radius(y0), self.profile.radius(y1)
            if abs(slope) <= mpf(10) ** (20 - mp.dps) or high <= r or low >= high:
                continue
            for x0, x1 in self.profile.spans(low, high):
                if x1 <= r:
                    continue
                x0 = max(x0, r)
                v0, v1 = (mp.sqrt((x - r) * (x + r)) for x in (x0, x1))

                def integrand(v):
                    x = mp.sqrt(r * r + v * v)
                    return self.profile.dg(x) / x

                total -= slope * quad(integrand, v0, v1)
        if self.profile.rim is not None and self.d > self.profile.g(self.profile.rim):
            total += edge / mp.sqrt((a - r) * (a + r))
        return total / pi

    def shear(self, r):
        if self.d <= 0:
            return mpf(0)
        edge = self.at(self.profile.g(self.profile.rim)) if self.profile.rim is not None else mpf(0)
        return self.g * self.m * self.stress(r, self.segments(), edge)

    def pressure(self, r):
        if self.d <= 0:
            return mpf(0)
        edge = self.d - self.profile.g(self.profile.rim) if self.profile.rim is not None else mpf(0)
        return self.e * self.stress(r, [(mpf(0), self.d, self.d, mpf(0))], edge)

    def lifted(self, r, segments):
        """(2/pi) int_0^min(r, a) w(g(x))/sqrt(r^2 - x^2) dx with x = r sin(t)."""
        if r == 0:
            return segments[0][1]
        total = mpf(0)
        end = min(r, self.radius())
        angle = lambda x: mp.atan2(x, mp.sqrt((r - x) * (r + x)))
        if self.profile.core > 0:
            total += segments[0][1] * angle(min(self.profile.core, end))
        for y0, w0, y1, w1 in segments:
            low, high = self.profile.radius(y0), min(self.profile.radius(y1), end)
            slope = (w1 - w0) / (y1 - y0)
            if low >= high:
                continue
            for a, b in self.profile.spans(low, high):
                total += quad(lambda t: w0 + slope * (self.profile.g(r * mp.sin(t)) - y0), angle(a), angle(b))
        return total * 2 / pi

    def surface(self, r):
        return self.m * self.lifted(r, self.segments()) if self.d > 0 else mpf(0)

    def slip(self, r):
        """U - u(r)."""
        return self.m * self.lifted(r, [(y0, self.w - w0, y1, self.w - w1) for y0, w0, y1, w1 in self.segments()])


def straightened(nodes):
    """Without repeated nodes and without those that are no kinks."""
    top = nodes[-1].y
    out = [nodes[0]]
    for node in nodes[1:]:
        if node.y - out[-1].y <= mpf(10) ** (8 - mp.dps) * top:
            if node.y == top:
                out[-1] = Node(top, mpf(0)) if len(out) > 1 else out[-1]
            continue
        if len(out) > 1:
            before = (out[-1].w - out[-2].w) / (out[-1].y - out[-2].y)
            after = (node.w - out[-1].w) / (node.y - out[-1].y)
            if abs(after - before) <= mpf(10) ** (30 - mp.dps):
                out.pop()
        out.append(node)
    return out


def load(profile, e_star, d):
    """2 E* int_0^a (d - g) dx."""
    if d <= 0:
        return mpf(0)
    low = profile.core
    total = low * d
    for a, b in profile.spans(low, profile.radius(d)):
        total += quad(lambda x: d - profile.g(x), a, b)
    return 2 * e_star * total


def depth_for(profile, e_star, force):
    """d of a normal force."""
    if force == 0:
        return mpf(0)
    if isinstance(profile, FlatPunch):
        return force / (2 * e_star * profile.core)
    if profile.rim is None:
        # F_N = 2 E* int_0^a x g'(x) dx grows with a.
        grown = lambda x: 2 * e_star * sum(quad(lambda t: t * profile.dg(t), a, b) for a, b in profile.spans(profile.core, x))
        if profile.ceiling is not None:
            low, high = mpf(0), profile.ceiling * (1 - mpf(10) ** -25)
        else:
            low, high = profile.core, profile.core * 2 or mpf(1)
            while grown(high) < force:
                high *= 2
            while profile.core == 0 and grown(high / 2) > force:
                high /= 2
        excess = increasing_root(lambda e: grown(low + e) - force, mpf(0), high - low)
        return profile.g(low + excess)
    high = mpf(1)
    while load(profile, e_star, high) < force:
        high *= 2
    return increasing_root(lambda d: load(profile, e_star, d) - force, mpf(0), high)


# --------------------------------------------------------------------------------------------------------------- moves

class Target:
    """Displacement U, force F, indentation d, normal force N; None stays."""

    def __init__(self, tangential=None, normal=None, relative=False):
        self.tangential, self.normal, self.relative = tangential, normal, relative

    def written(self):
        parts = ["move"]
        for target in (self.tangential, self.normal):
            parts += ["-", "0"] if target is None else [target[0], repr(float(target[1]))]
        parts.append("rel" if self.relative else "abs")
        return ",".join(parts)


def slide(u):
    return Target(tangential=("U", u))


def oblique(u, d):
    return Target(tangential=("U", u), normal=("d", d))


def press(d):
    return Target(normal=("d", d))


def push(force):
    return Target(tangential=("F", force))


class Scene:
    """A contact, its moves, and what is asked."""

    def __init__(self, name, profile, material, preload, moves, ask, digits=60):
        self.name, self.profile, self.material, self.preload = name, profile, material, preload
        self.moves, self.ask, self.digits = list(moves), ask, digits

    def contact(self):
        profile = profile_of(self.profile)
        e_star, g_star, friction = map(exact, self.material)
        kind, value = self.preload
        value = exact(value)
        if kind == "normal_force":
            d = depth_for(profile, e_star, value)
        elif kind == "contact_radius":
            d = profile.g(value)
        else:
            d = value
        return Contact(profile, e_star, g_star, friction, d)

    def head(self):
        numbers = ",".join(repr(float(number)) for number in self.material)
        kind, value = self.preload
        return f"scene,{self.name},{numbers},{kind},{float(value)!r},{written(self.profile)}"


def carry_out(contact, target):
    """A move straight in (d, U), or in the force alone at constant indentation."""
    d, u = contact.d, contact.w * contact.m
    if target.normal is not None:
        kind, value = target.normal
        value = exact(value)
        if kind == "N":
            assert target.tangential is None
            base = contact.normal_force() if target.relative else mpf(0)
            d = depth_for(contact.profile, contact.e, base + value)
        else:
            d = value + (contact.d if target.relative else 0)
    if target.tangential is not None:
        kind, value = target.tangential
        value = exact(value)
        if kind == "F":
            assert target.normal is None
            contact.move(d, displacement_for(contact, value + (contact.force() if target.relative else 0)))
            return
        u = value + (u if target.relative else 0)
    contact.move(d, u / contact.m if contact.m else mpf(0))


def displacement_for(contact, target):
    """W at which the force is `target`, the indentation held."""

    def force_at(w):
        tried = Contact(contact.profile, contact.e, contact.g, contact.mu, contact.d)
        tried.keep_levels = False
        tried.nodes, tried.w = contact.nodes, contact.w
        tried.move(contact.d, w)
        return tried.force()

    # Beyond +-2 d from here all of it slips. Near that limit the force is flat, so the distance from it is solved for.
    low, high = contact.w - 2 * contact.d, contact.w + 2 * contact.d
    limit = contact.mu * contact.normal_force()
    assert abs(target) < limit
    reach = contact.d
    ahead = contact.nodes[0].w
    if target > 0.9 * limit:
        # W = (W of gross slip) - e.
        end = contact.w + reach - ahead
        return end - increasing_root(lambda e: target - force_at(end - e), mpf(0), 2 * reach)
    if target < -0.9 * limit:
        end = contact.w - reach - ahead
        return end + increasing_root(lambda e: force_at(end + e) - target, mpf(0), 2 * reach)
    start = contact.force()
    if target >= start:
        return contact.w + increasing_root(lambda e: force_at(contact.w + e) - target, mpf(0), high - contact.w)
    return contact.w - increasing_root(lambda e: target - force_at(contact.w - e), mpf(0), contact.w - low)


def number(value):
    return "inf" if value == inf else mp.nstr(value, 22, min_fixed=0, max_fixed=0)


def kink_row(contact, r):
    """Shear stress at r, and its range over eight units in the last place to either side."""
    here, reach = exact(r), exact(r) * mpf(2) ** -49
    near = [here - reach, here + reach]
    near += [x for x in (contact.profile.radius(node.y) for node in contact.nodes) if near[0] < x < near[1]]
    values = [contact.shear(x) for x in (here, *near)]
    return f"kink,{r!r},{number(values[0])},{number(min(values))},{number(max(values))}"


def answers(contact, ask):
    """The rows of everything that is asked for. `ask` is a list of names, with radii as (name, [radii])."""
    rows = []
    if contact.d > 0:
        a = contact.radius()
        normal = contact.normal_force()
        if isinstance(contact.profile, (Sphere, ExactSphere)):
            peak = contact.pressure(mpf(0))
        else:
            peak = normal / (pi * a * a)
        units = [contact.mu * normal, contact.mu * peak, contact.m * contact.d]
        rows.append("units," + ",".join(map(number, units)))
    for entry in ask:
        if isinstance(entry, tuple):
            name, radii = entry
            radii = radii(contact) if callable(radii) else radii
            for r in radii:
                if name == "kink":
                    rows.append(kink_row(contact, r))
                    continue
                rows.append(f"{name.rstrip('!')},{float(r)!r},{number(getattr(contact, name.rstrip('!'))(exact(r)))}" + (",own" if name.endswith("!") else ""))
        else:
            plain = entry.rstrip("!")
            value = {
                "displacement": lambda: contact.w * contact.m,
                "force": contact.force,
                "normal_force": contact.normal_force,
                "indentation": lambda: contact.d,
                "contact_radius": contact.radius,
                "stick_radius": contact.stick_radius,
                "elastic": contact.elastic,
                "dissipated": contact.dissipated,
            }[plain]()
            rows.append(f"{plain},{number(value)}" + (",own" if entry.endswith("!") else ""))
    return rows


# --------------------------------------------------------------------------------------------- paths straight in a force

class Bent:
    """A contact whose w(y) may be curved: segments (y0, y1, w, dw/dy). For the sphere and the cone alone.

    On an arc on which slip neither sets in nor ends, either nothing slips and what is touched keeps W1 - W(touch), or the
    slip ring grows all along and only the arc's end counts. Slip sets in or ends where |dW/dd| = 1.
    """

    def __init__(self, contact):
        self.c = contact
        self.d, self.w = contact.d, contact.w
        line = lambda y0, w0, k: (lambda y: w0 + k * (y - y0), lambda y: k)
        self.segments = [
            (y0, y1, *line(y0, w0, (w1 - w0) / (y1 - y0))) for y0, w0, y1, w1 in contact.segments()
        ]

    def stuck(self, d1, w1, touch, slope):
        """Rises to d1; `touch` is W over the level touched, `slope` its derivative."""
        ride = w1 - self.w
        lift = lambda f: lambda y: f(y) + ride
        self.segments = [(y0, y1, lift(f), df) for y0, y1, f, df in self.segments]
        self.segments.append((self.d, d1, lambda y: w1 - touch(y), lambda y: -slope(y)))
        self.d, self.w = d1, w1

    def slipped(self, d1, w1):
        """The state after an arc on which the slip ring grows all along."""
        ride = w1 - self.w
        lift = lambda f: lambda y: f(y) + ride
        moved = [(y0, min(y1, d1), lift(f), df) for y0, y1, f, df in self.segments if y0 < d1]
        trial = mp.sign(ride) if d1 >= self.d else mp.sign(moved[-1][2](d1) if moved else 0)
        out = Bent.__new__(Bent)
        out.c, out.d, out.w = self.c, d1, w1
        if trial == 0:
            out.segments = moved
            return out
        excess = lambda f, y: trial * f(y) + y - d1
        kept, start = [], mpf(0)
        for y0, y1, f, df in moved:
            if excess(f, y0) >= 0:
                break
            start = y1 if excess(f, y1) < 0 else increasing_root(lambda y: excess(f, y), y0, y1)
            kept.append((y0, start, f, df))
            if start < y1:
                break
        if start < d1:
            kept.append((start, d1, lambda y: trial * (d1 - y), lambda y: -trial))
        out.segments = kept
        return out

    def become(self, other):
        self.d, self.w, self.segments = other.d, other.w, other.segments

    def force(self):
        total = mpf(0)
        for y0, y1, f, _ in self.segments:
            x0, x1 = self.c.profile.radius(y0), self.c.profile.radius(y1)
            total += quad(lambda x: f(self.c.profile.g(x)), x0, x1)
        return 2 * self.c.g * self.c.m * total

    def shear(self, r):
        total, profile = mpf(0), self.c.profile
        for y0, y1, _, df in self.segments:
            x0, x1 = max(profile.radius(y0), r), profile.radius(y1)
            if x1 <= r:
                continue

            def integrand(v):
                x = mp.sqrt(r * r + v * v)
                return df(profile.g(x)) * profile.dg(x) / x

            total -= quad(integrand, mp.sqrt((x0 - r) * (x0 + r)), mp.sqrt((x1 - r) * (x1 + r)))
        return self.c.g * self.c.m / pi * total

    def reach(self, d1, target):
        """The state at d1 with the force `target`, the slip ring growing all along."""
        span = 2 * max(self.d, d1) + abs(d1 - self.d)
        f = lambda w: self.slipped(d1, w).force() - target
        low, high = self.w - span, self.w + span
        return self.slipped(d1, low + increasing_root(lambda e: f(low + e), mpf(0), high - low))

    def follow(self, target, parts):
        """One move straight in a force, each arc in `parts` parts."""
        profile, c = self.c.profile, self.c
        tangential, normal = target.tangential, target.normal
        d0, w0, load0, force0 = self.d, self.w, load(profile, c.e, self.d), self.force()
        by_force, by_load = tangential[0] == "F", normal[0] == "N"
        value, level = exact(tangential[1]), exact(normal[1])
        d_end = depth_for(profile, c.e, level) if by_load else level
        load_end = level if by_load else load(profile, c.e, level)
        rise = (value - force0) if by_force else (value / c.m - w0)

        def part_of(d):
            """How far along the move the indentation is d."""
            return (load(profile, c.e, d) - load0) / (load_end - load0) if by_load else (d - d0) / (d_end - d0)

        # dW/dd while nothing slips, over the contact radius.
        if by_force and by_load:
            pace = lambda a: rise / (load_end - load0) / c.mu
            turn = None
        elif by_force:
            pace = lambda a: rise / (d_end - d0) / (2 * c.g * c.m * a)
            turn = abs(rise / (d_end - d0)) / (2 * c.g * c.m)
        else:
            pace = lambda a: rise / (load_end - load0) * 2 * c.e * a
            turn = abs((load_end - load0) / rise) / (2 * c.e) if rise else None
        stops = [d0]
        if turn is not None and min(d0, d_end) < profile.g(turn) < max(d0, d_end):
            stops.append(profile.g(turn))
        stops.append(d_end)
        for start, end in zip(stops, stops[1:]):
            middle = profile.radius((start + end) / 2)
            sticks = end > start and abs(pace(middle)) < 1
            for k in range(1, parts + 1):
                d1 = start + (end - start) * k / parts if k < parts else end
                if sticks:
                    here, at = self.w, self.d
                    if by_force and by_load:
                        touch = lambda y, here=here, at=at: here + pace(0) * (y - at)
                    elif by_force and isinstance(profile, Sphere):
                        x0 = profile.radius(at)
                        touch = lambda y, here=here, x0=x0: here + pace(1) * 2 * (mp.sqrt(y * profile.r) - x0) / profile.r
                    elif by_force:
                        assert isinstance(profile, Cone)
                        touch = lambda y, here=here, at=at: here + pace(1) * pi * profile.t / 2 * mp.log(y / at)
                    else:
                        touch = lambda y: w0 + rise * part_of(y)
                    self.stuck(d1, touch(d1), touch, lambda y: pace(profile.radius(y)))
                elif by_force:
                    self.become(self.reach(d1, force0 + rise * part_of(d1)))
                else:
                    self.become(self.slipped(d1, w0 + rise * part_of(d1)))
