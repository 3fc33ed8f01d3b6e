"""Normal contact of bodies of revolution and of an ellipsoid."""

from mpmath import acos, asin, atanh, cos, ellipe, ellipk, gamma, inf, mp, mpf, pi, quad, sin, sqrt

from found.common import near, out, problem, root


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
