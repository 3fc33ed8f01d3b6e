"""Reference values for every function of every profile, to about 25 digits.

Each profile is stated by its slope f'(r) and by a formula for g. The formula is first held against the definition
    g(x) = x int_0^{pi/2} f'(x sin q) dq,
by quadrature, and the script stops if they differ; g' is checked by the numerical derivative. All else - the moments of
rings, the kernel, its slope, the lift, the load, the inverse - is quadrature, numerical differentiation or root finding on g,
never a formula for that quantity. Writes profiles.csv: family;parameters;function;arguments;value.
"""
import sys

import mpmath as mp

mp.mp.dps = 34
rows = []


def quad(f, points, method="tanh-sinh"):
    """mp.quad, whose tolerance is absolute, on an integrand and a range brought to the size of one."""
    length = points[-1] - points[0]
    size = max(abs(f(points[0] + length * mp.mpf(k) / 7)) for k in range(1, 7))
    size = max(size, abs(f(points[-1] - length / 10**6)))
    if size == 0:
        return mp.mpf(0)
    total = mp.quad(lambda w: f(w * length) / size, [p / length for p in points], method=method)
    return total * size * length


class Profile:
    """A profile with kinks at `breaks`, flat up to `core`; g and slope are functions of x."""

    def __init__(self, name, params, f1, g, slope, breaks=(), core=0, steep=False):
        self.name, self.params, self.f1, self.g, self.slope = name, params, f1, g, slope
        self.breaks, self.core, self.steep = sorted(breaks), core, steep

    def check(self, x):
        angles = [mp.mpf(0)] + [mp.asin(b / x) for b in self.breaks if 0 < b < x]
        angles += [mp.pi / 2 * k / 40 for k in range(20, 40) if self.steep] + [mp.pi / 2]
        angles.sort()
        wanted = x * quad(lambda q: self.f1(x * mp.sin(q)), angles)
        assert abs(self.g(x) / wanted - 1) < mp.mpf(10) ** -18, (self.name, self.params, self.g(x), wanted)
        h = x * mp.mpf(10) ** -9 * min(1, (x - self.core) / x)
        wanted = (self.g(x + h) - self.g(x - h)) / (2 * h)
        assert abs(self.slope(x) / wanted - 1) < mp.mpf(10) ** -12, (self.name, self.params, self.slope(x), wanted)

    def pieces(self, low, high):
        points = [low] + [b for b in self.breaks if low < b < high] + [high]
        return zip(points, points[1:])

    def cuts(self, length, near):
        """Points of 0..sqrt(length), dense where a singularity lies `near` beyond the start, and at the end."""
        top = mp.sqrt(length)
        cuts = {mp.mpf(0), top, top / 4, top / 2, top * mp.mpf("0.75"), top * mp.mpf("0.9")}
        if self.steep:
            cuts |= {top * (1 - mp.mpf(10) ** -k) for k in (2, 3)}
            cuts |= {top * k / 32 for k in range(16, 32)}
        step = mp.sqrt(near)
        while 0 < step < top / 4:
            cuts |= {step / 2, step}
            step *= 3
        return sorted(cuts)

    def over(self, f, low, high, near=()):
        """int_low^high f(x, x - low) dx with x = start + u^2 from every kink on."""
        total = mp.mpf(0)
        for start, stop in self.pieces(low, high):
            close = [abs(start - n) for n in near if n != start] + [start - b for b in list(self.breaks) + [0] if b < start]
            cuts = self.cuts(stop - start, min(close) if close else 0)
            method = "tanh-sinh" if start == 0 else "gauss-legendre"
            total += quad(lambda u: 2 * u * f(start + u * u, start, u), cuts, method=method)
        return total

    def moments(self, low, high):
        top = self.g(high)
        first = self.over(lambda x, s, u: top - self.g(x), low, high)
        second = self.over(lambda x, s, u: (top - self.g(x)) ** 2, low, high)
        return high - low, first, second

    def kernel(self, r, low, high):
        low = max(r, low)
        return self.over(lambda x, s, u: self.slope(x) / mp.sqrt((s - r + u * u) * (x + r)), low, high, [r])

    def kernel_slope(self, r, low, high):
        square = r * r
        marks = [low * low, high * high, mp.mpf(0)] + [b * b for b in self.breaks]
        h = min(abs(m - square) for m in marks) * mp.mpf(10) ** -5
        k = lambda i: self.kernel(mp.sqrt(square + i * h), low, high)
        with mp.workdps(34 + int(-mp.log10(h / high**2))):
            return (8 * (k(1) - k(-1)) - (k(2) - k(-2))) / (12 * h)

    def lift(self, r, low, high):
        top, end = self.g(high), min(r, high)
        if low >= end:
            return mp.mpf(0)
        total = mp.mpf(0)
        for start, stop in self.pieces(low, end):
            middle = (start + stop) / 2
            total += self.over(lambda x, s, u: (top - self.g(x)) / mp.sqrt((r - x) * (r + x)), start, middle, [r])
            cuts = self.cuts(stop - middle, r - stop)
            total += quad(
                lambda u: 2 * (top - self.g(stop - u * u)) * (u / mp.sqrt(r - stop + u * u)) / mp.sqrt(r + stop - u * u),
                cuts, method="gauss-legendre")
        return total

    def inverse(self, level, high):
        """X(level) between the core and `high`, by bisection in x - core, then Newton's steps."""
        low, top = mp.mpf(0), high - self.core
        for _ in range(90):
            middle = mp.sqrt(low * top) if low > 0 else top / 1000
            if self.g(self.core + middle) > level:
                top = middle
            else:
                low = middle
        guess = self.core + mp.sqrt(low * top)
        if guess <= self.core:
            return self.core
        for _ in range(8):
            guess -= (self.g(guess) - level) / self.slope(guess)
        return guess

    def load(self, x):
        return self.over(lambda t, s, u: t * self.slope(t), self.core, x)

    def put(self, function, arguments, value):
        text = " ".join(repr(float(a)) for a in arguments)
        assert all(float(a) == a for a in arguments)
        rows.append(f"{self.name};{self.params};{function};{text};{mp.nstr(value, 22)}")


def exact(x):
    """The double nearest to x, so that the program gets the same argument."""
    return mp.mpf(float(x))


def sphere(R):
    R = exact(R)
    return Profile("sphere", float(R), lambda r: r / R, lambda x: x * x / R, lambda x: 2 * x / R)


def exact_sphere(R):
    R = exact(R)
    return Profile("exact_sphere", float(R), lambda r: r / mp.sqrt((R - r) * (R + r)), lambda x: x * mp.atanh(x / R),
                   lambda x: mp.atanh(x / R) + x * R / ((R - x) * (R + x)))


def cone(T):
    T = exact(T)
    return Profile("cone", float(T), lambda r: T, lambda x: mp.pi / 2 * T * x, lambda x: mp.pi / 2 * T)


def power_law(n, c):
    n, c = exact(n), exact(c)
    b = mp.sqrt(mp.pi) * mp.gamma(n / 2 + 1) / mp.gamma((n + 1) / 2) * c
    return Profile("power_law", f"{float(n)} {float(c)}", lambda r: n * c * r ** (n - 1), lambda x: b * x**n,
                   lambda x: n * b * x ** (n - 1), steep=n > 30)


def t_of(x, b):
    return mp.sqrt((x - b) * (x + b)) if x > b else mp.mpf(0)


def truncated_cone(T, b):
    T, b = exact(T), exact(b)
    return Profile("truncated_cone", f"{float(T)} {float(b)}", lambda r: T if r > b else mp.mpf(0),
                   lambda x: T * x * mp.atan2(t_of(x, b), b), lambda x: T * (mp.atan2(t_of(x, b), b) + b / t_of(x, b)), [b], b)


def truncated_sphere(R, b):
    R, b = exact(R), exact(b)
    return Profile("truncated_sphere", f"{float(R)} {float(b)}", lambda r: r / R if r > b else mp.mpf(0),
                   lambda x: x / R * t_of(x, b), lambda x: (t_of(x, b) + x * x / t_of(x, b)) / R, [b], b)


def rounded_punch(b, R):
    b, R = exact(b), exact(R)
    return Profile("rounded_punch", f"{float(b)} {float(R)}", lambda r: max(r - b, 0) / R,
                   lambda x: x / R * (t_of(x, b) - b * mp.atan2(t_of(x, b), b)),
                   lambda x: (2 * t_of(x, b) - b * mp.atan2(t_of(x, b), b)) / R, [b], b)


def rounded_cone(T, b):
    T, b = exact(T), exact(b)
    g = lambda x: T * x * ((x - t_of(x, b)) / b + mp.atan2(t_of(x, b), b))
    slope = lambda x: T * (2 * (x - t_of(x, b)) / b + mp.atan2(t_of(x, b), b))
    return Profile("rounded_cone", f"{float(T)} {float(b)}", lambda r: T * min(r / b, 1), g, slope, [b])


def total(*parts):
    return Profile("sum", " + ".join(f"{p.name} {p.params}" for p in parts), lambda r: sum(p.f1(r) for p in parts),
                   lambda x: sum(p.g(x) for p in parts), lambda x: sum(p.slope(x) for p in parts if x > p.core),
                   [b for p in parts for b in p.breaks], min(p.core for p in parts), any(p.steep for p in parts))


def tabulate(profile, unit):
    """All functions of one profile for a contact that reaches about `unit` beyond its core."""
    core, unit = profile.core, exact(unit)
    a = exact(core + unit)
    profile.check(a)
    profile.check(core + unit * mp.mpf("0.37"))
    profile.put("level", [a], profile.g(a))
    profile.put("slope", [a], profile.slope(a))
    # A ring is stated by two doubles, the outer level and the depth.
    outer = exact(profile.g(a))
    x_outer = profile.inverse(outer, 2 * a - core if profile.name != "exact_sphere" else mp.mpf(profile.params))
    profile.put("radius", [outer], x_outer)
    profile.put("indentation", [exact(profile.load(a))], profile.g(a) + (exact(profile.load(a)) - profile.load(a)) / a)
    for share in ("1", "0.5", "1e-3", "1e-8", "1e-14"):
        depth = outer if share == "1" else exact(outer * mp.mpf(share))
        x_inner = core if share == "1" else profile.inverse(outer - depth, x_outer)
        ring = [outer, depth]
        for name, value in zip(("width", "first", "second"), profile.moments(x_inner, x_outer)):
            profile.put(name, ring, value)
        width = x_outer - x_inner
        if share in ("1", "0.5"):
            radii = [x_inner * mp.mpf("0.3"), x_inner * mp.mpf("0.999999999"), x_inner + width * mp.mpf("1e-9"), x_inner + width / 7,
                     x_inner + width * mp.mpf("0.8"), x_outer * (1 - mp.mpf("1e-12"))]
        else:
            radii = [x_inner * mp.mpf("0.9"), x_inner * mp.mpf("0.99999")]
        for r in radii + [x_outer * mp.mpf("1.5")]:
            r = exact(r)
            if r <= 0 and profile.core == 0:
                continue
            clear = min(abs(r - m) / r for m in [x_inner, x_outer] + profile.breaks)
            if r < x_outer:
                profile.put("kernel", ring + [r], profile.kernel(r, x_inner, x_outer))
                if clear > mp.mpf("1e-7") and share != "1e-14":
                    profile.put("kernel_slope", ring + [r], profile.kernel_slope(r, x_inner, x_outer))
            if share != "1e-14" and r > x_inner:
                profile.put("lift", ring + [r], profile.lift(r, x_inner, x_outer))


def cases():
    yield sphere(0.01), 1e-4
    for R, unit in ((0.01, 8.9e-3), (0.01, 3e-3), (0.01, 1e-17), (1e-9, 1e-10)):
        yield exact_sphere(R), unit
    yield cone(0.3), 1e-3
    for n in (0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 17.0, 33.3):
        yield power_law(n, 0.7), 0.5
    yield power_law(1000.0, 0.7), 1.0
    for b, unit in ((1e-3, 1e-3), (1e-3, 1e-6), (1e-9, 1e-3), (1e3, 1e3)):
        yield truncated_cone(0.2, b), unit
        yield truncated_sphere(0.01, b), unit
        yield rounded_punch(b, 0.01), unit
    for b, unit in ((1e-3, 9.99e-4), (1e-3, 1.001e-3), (1e-9, 1e-3), (1e3, 5e3)):
        yield rounded_cone(0.2, b), unit
    yield total(sphere(0.01), cone(0.01), rounded_punch(3e-4, 0.01)), 1e-3
    yield total(power_law(1.5, 0.7), truncated_cone(0.02, 3e-4), exact_sphere(0.002)), 1e-3
    yield total(truncated_sphere(0.01, 1e-3), rounded_punch(1.5e-3, 0.02)), 1e-3
    yield total(power_law(40.0, 1e100), rounded_cone(0.1, 1e-3)), 3e-3


def main():
    for profile, unit in cases():
        tabulate(profile, unit)
        print(profile.name, profile.params, len(rows), file=sys.stderr, flush=True)
    with open("profiles.csv", "w") as out:
        out.write("family;parameters;function;arguments;value\n")
        out.write("\n".join(rows) + "\n")


if __name__ == "__main__":
    main()
