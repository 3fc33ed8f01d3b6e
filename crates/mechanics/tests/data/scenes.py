"""The scenes of `hard_cases.csv`, `curved.csv` and `accuracy.csv`, solved by `reference.py`.

    python3 tests/data/scenes.py [hard] [curved] [accuracy]

takes some minutes a file and writes the same at every run.

Rows of the files: `scene,name,E*,G*,mu,preload kind,preload,profile`, then its moves (`move`, or a run of many: `nested`,
`swing`), then `units,mu F_N,stress unit,u_max` and one row a result. The stress unit is mu p(0) for spheres and mu times the
mean pressure for the rest. A result that ends in `own` is to be compared relative to itself. A `kink` is the shear stress next to
a kink, where tau has a root's cusp: r, tau, and the least and the largest tau within eight units in the last place of r.
"""

import math
import multiprocessing
import os
import random
import sys
import time

from mpmath import mp, mpf, pi

from reference import (
    Bent,
    Scene,
    Target,
    answers,
    carry_out,
    exact,
    load,
    number,
    oblique,
    press,
    profile_of,
    push,
    slide,
)

HERE = os.path.dirname(os.path.abspath(__file__))

UNIT = (1.0, 1.0, 1.0)
PLAIN = (1.13e11, 8.9e10, 0.31)
STATE = ["force", "normal_force", "indentation", "contact_radius", "stick_radius", "displacement", "elastic", "dissipated"]


def up(x, steps=1):
    for _ in range(steps):
        x = math.nextafter(x, math.inf)
    return x


def down(x, steps=1):
    for _ in range(steps):
        x = math.nextafter(x, -math.inf)
    return x


def parts_of_radius(*fractions):
    """Radii as fractions of the contact radius, rounded to doubles."""
    return lambda contact: [float(contact.radius() * mpf(fraction)) for fraction in fractions]


def at_kinks(contact):
    """The doubles nearest to every kink of w, and their neighbours."""
    radii = []
    for y in [node.y for node in contact.nodes][:-1]:
        near = float(contact.profile.radius(y))
        if near > 0:
            radii += [down(near), near, up(near)]
    return [r for r in radii if exact(r) < contact.radius()][:18]


EVERYWHERE = [
    *STATE,
    ("shear", parts_of_radius(0, 0.1, 0.35, 0.7, 0.95, 1 - 1e-6)),
    ("pressure", parts_of_radius(0, 0.4, 0.999)),
    ("surface", parts_of_radius(0.5, 1, 1.7)),
    ("slip", parts_of_radius(0.3, 0.8, 0.99)),
]
# For profiles whose stresses are infinite at the centre.
OFF_CENTRE = [
    *STATE,
    ("shear", parts_of_radius(1e-6, 0.1, 0.35, 0.7, 0.95, 1 - 1e-6)),
    ("pressure", parts_of_radius(0.001, 0.4, 0.999)),
    ("surface", parts_of_radius(0.5, 1, 1.7)),
    ("slip", parts_of_radius(0.3, 0.8, 0.99)),
]


def double_indentation(words, radius):
    """A double next to g(radius)."""
    return float(profile_of(words).g(exact(radius)))


def tour(d, u):
    """Slides, oblique loading and unloading, a partial return: d and u in the units given."""
    return [
        slide(0.6 * u),
        slide(-0.35 * u),
        oblique(0.1 * u, 1.3 * d),
        oblique(0.4 * u, 1.1 * d),
        slide(0.05 * u),
        oblique(-0.2 * u, 1.15 * d),
        oblique(0.3 * u, 0.9 * d),
        slide(0.2 * u),
    ]


def of_family(name, words, a, material=UNIT, ask=EVERYWHERE):
    """The tour on a profile with the contact radius a at the start."""
    d = double_indentation(words, a)
    m = material[2] * material[0] / material[1]
    return Scene(name, words, material, ("indentation", d), tour(d, m * d), ask)


def hard_scenes():
    ball = ("sphere", 1.0)
    whole = ("indentation", 1.0)
    # Tiny displacements: F and tau lose their digits, and the stick radius meets the edge.
    for power in (1e-3, 1e-8, 1e-12, 1e-14, 1e-90):
        own = ["force!", "elastic!", "dissipated!", "stick_radius", ("shear!", parts_of_radius(0, 0.5, 0.99))]
        digits = 260 if power < 1e-50 else 60
        yield Scene(f"tiny displacement {power}", ball, UNIT, whole, [slide(power)], own, digits)
        if power > 1e-50:
            there_and_back = [slide(power * 1e-3), slide(-0.5e-3 * power), slide(0.2e-3 * power)]
            yield Scene(f"tiny reversals {power}", ball, UNIT, whole, there_and_back, own[:1] + own[3:])
        plain = ("sphere", 0.0127)
        yield Scene(
            f"tiny displacement {power} of a plain ball", plain, PLAIN, ("contact_radius", 1.7e-4), [slide(power * 1e-6)], own, digits
        )
    # c -> a with radii inside and outside of c, and right at it.
    for rest in (1e-5, 1e-10, 1e-15):
        ask = [*EVERYWHERE, ("shear", parts_of_radius(1 - rest / 4, 1 - rest / 3, 1 - rest / 1.5)), ("kink", at_kinks)]
        yield Scene(f"stick radius next to the edge {rest}", ball, UNIT, whole, [slide(rest)], ask)
    # c -> 0.
    for rest in (1e-6, 1e-12, 2.0**-50):
        ask = [*EVERYWHERE, ("shear", [1e-12, 1e-8, 1e-6, 1e-4]), ("kink", at_kinks)]
        yield Scene(f"stick radius next to the centre {rest}", ball, UNIT, whole, [slide(1.0 - rest)], ask)
        yield Scene(f"back from next to the centre {rest}", ball, UNIT, whole, [slide(1.0 - rest), slide(-(1.0 - 3 * rest))], ask)
    # Within an ulp of gross slip is gross slip.
    yield Scene("an ulp short of gross slip", ball, UNIT, whole, [slide(down(1.0))], ["force", "elastic", "dissipated", ("shear", [0.5, 0.9])])
    yield Scene("gross slip and back", ball, UNIT, whole, [slide(1.0), slide(0.25)], EVERYWHERE)
    yield Scene("a million u_max and back", ball, UNIT, whole, [slide(1e6), slide(1e6 - 0.5)], EVERYWHERE)
    yield Scene(
        "far away on a plain ball", ("sphere", 0.0127), PLAIN, ("contact_radius", 1.7e-4),
        [slide(0.5), Target(("U", -3e-7), None, True), Target(("U", 2e-7), None, True)], EVERYWHERE,
    )
    # Work of tiny cycles.
    for amplitude in (1e-3, 1e-6, 1e-9, 1e-13):
        moves = [slide(amplitude), slide(-amplitude), slide(amplitude)]
        yield Scene(f"tiny cycle {amplitude}", ball, UNIT, whole, moves, ["dissipated!", "elastic!", "force!"])
    yield Scene(
        "tiny cycles on a long slide", ball, UNIT, whole,
        [slide(0.5), slide(0.5 - 1e-6), slide(0.5), slide(0.5 - 1e-6), slide(0.25)], EVERYWHERE,
    )
    # Force control: mu F_N = 1 exactly, u_max = 1.
    even = (0.75, 0.75, 1.0)
    for rest in (1e-3, 1e-6, 1e-9, 1e-12, 1e-15, 2.0**-53):
        for sign in (1, -1):
            ask = [*STATE, ("shear", parts_of_radius(0, 0.5, 0.9))]
            yield Scene(f"force {sign} short of the limit by {rest}", ball, even, whole, [push(sign * (1.0 - rest))], ask)
        yield Scene(
            f"force from one limit to the other short by {rest}", ball, even, whole, [push(1.0 - rest), push(-(1.0 - rest))],
            [*STATE, ("shear", parts_of_radius(0, 0.5, 0.9))],
        )
        yield Scene(f"force of {rest}", ball, even, whole, [push(rest)], ["force!", "displacement!", "dissipated!", "elastic!"])
    yield Scene(
        "force close to the limit of a plain ball", ("sphere", 0.0127), PLAIN, ("normal_force", 10.0),
        [push(3.1 * (1.0 - 1e-15))], [*STATE[:2], *STATE[2:], ("shear", parts_of_radius(0, 0.5, 0.9))],
    )
    yield Scene(
        "force after a history", ball, even, whole, [slide(0.7), slide(-0.4), oblique(0.1, 1.5), push(-0.9), push(0.3), push(0.299999999)],
        EVERYWHERE,
    )
    # Rising load in steps.
    steps = [oblique(0.05 * k, 0.2 + 0.1 * k) for k in range(1, 9)]
    yield Scene("rising load in steps", ball, UNIT, ("indentation", 0.2), steps, EVERYWHERE)
    steps = [oblique(0.05 * k + (0.03 if k % 2 else 0.0), 0.2 + 0.1 * k) for k in range(1, 9)]
    yield Scene("rising load in zigzag", ball, UNIT, ("indentation", 0.2), [*steps, slide(0.3), oblique(0.31, 0.7)], EVERYWHERE)
    yield Scene(
        "rising load from zero", ball, UNIT, ("normal_force", 0.0), [oblique(0.25, 0.5), slide(0.0), oblique(0.25, 1.0)], EVERYWHERE
    )
    yield Scene("normal force up and down", ball, UNIT, ("normal_force", 1.0), [
        slide(0.2), Target(None, ("N", 2.0)), slide(-0.1), Target(None, ("N", -1.2), True), slide(0.1)], EVERYWHERE)
    # Scales.
    for radius, a, e in [(1e-9, 2e-10, 1e3), (1e-9, 3e-11, 1e12), (1e3, 10.0, 1e3), (1e5, 1e3, 1e12), (1e-15, 1e-16, 1e-2), (1e9, 3e7, 1e10)]:
        d = a * a / radius
        material = (e, 0.8 * e, 0.4)
        yield Scene(f"sphere of {radius} m and {e} Pa", ("sphere", radius), material, ("contact_radius", a), tour(d, 0.5 * d), EVERYWHERE)
    # Turning points closer than round-off, moves of an ulp.
    half = 0.5
    creep = [slide(half)] + [slide(up(half, k)) for k in (1, 2, 1, 0, 1, 3, 2)]
    yield Scene("moves of an ulp", ball, UNIT, whole, creep, [*EVERYWHERE, ("kink", at_kinks)])
    yield Scene("moves of an ulp and then a long one", ball, UNIT, whole, [*creep, slide(-0.2), slide(up(-0.2)), slide(0.1)], [*EVERYWHERE, ("kink", at_kinks)])
    oblique_creep = [oblique(half, 1.0)] + [oblique(up(half, k), up(1.0, j)) for k, j in ((1, 0), (1, 1), (3, 2), (2, 2), (2, 1))]
    yield Scene("oblique moves of an ulp", ball, UNIT, whole, [*oblique_creep, slide(0.2)], [*EVERYWHERE, ("kink", at_kinks)])
    nearly = [slide(0.5), slide(-0.3), slide(down(0.5)), slide(up(-0.3)), slide(down(0.5)), slide(0.1)]
    yield Scene("turning points an ulp apart", ball, UNIT, whole, nearly, [*EVERYWHERE, ("kink", at_kinks)])
    exactly = [slide(0.5), slide(-0.3), slide(0.5), slide(-0.3), slide(0.1)]
    yield Scene("turning points met again", ball, UNIT, whole, exactly, [*EVERYWHERE, ("kink", at_kinks)])
    small = [slide(0.5), Target(("U", -1e-17), None, True), Target(("U", 1e-18), None, True), Target(("U", -1e-3), None, True)]
    yield Scene("increments below an ulp", ball, UNIT, whole, small, [*EVERYWHERE, ("kink", at_kinks)])
    # Next to lift-off.
    for left in (2.0**-52, 2.0**-80, 1e-30):
        yield Scene(
            f"nearly lifted off with {left} left", ball, UNIT, whole, [slide(0.5), slide(0.1), press(left)], STATE[:6] + [("shear", parts_of_radius(0, 0.5, 0.9))]
        )
        yield Scene(
            f"nearly lifted off with {left} left and pressed again", ball, UNIT, whole,
            [slide(0.5), oblique(0.1, left), press(1.0), slide(0.3)], EVERYWHERE,
        )
    yield Scene("an ulp less", ball, UNIT, whole, [slide(0.5), press(down(1.0)), press(1.0), slide(0.2)], [*EVERYWHERE, ("kink", at_kinks)])
    yield Scene("lifted off and back", ball, UNIT, whole, [slide(0.5), oblique(0.2, -0.3), oblique(0.1, 0.7), slide(0.3)], EVERYWHERE)
    yield Scene("touching", ball, UNIT, whole, [slide(0.5), press(0.0), oblique(0.2, 0.4)], EVERYWHERE)
    # Kinks on a ball of round numbers and on one whose m is no double.
    yield Scene("stresses at the kinks", ball, UNIT, whole, tour(1.0, 1.0), [*EVERYWHERE, ("kink", at_kinks)])
    d = 1.7e-4**2 / 0.0127
    plain_tour = tour(d, 0.39 * d)
    for preload in (("contact_radius", 1.7e-4), ("normal_force", 10.0), ("indentation", d)):
        yield Scene(f"stresses at the kinks of a plain ball by {preload[0]}", ("sphere", 0.0127), PLAIN, preload,
                    [slide(3e-7), slide(-2e-7), slide(1e-7)], [*EVERYWHERE, ("kink", at_kinks)])
    yield Scene("a tour of a plain ball", ("sphere", 0.0127), PLAIN, ("contact_radius", 1.7e-4), plain_tour, [*EVERYWHERE, ("kink", at_kinks)])
    # Paper: falling amplitude.
    falling = [slide((1 if k % 2 == 0 else -1) * (20 - k) / 20) for k in range(21)]
    yield Scene("falling amplitude", ball, UNIT, whole, falling, [*EVERYWHERE, ("kink", at_kinks)])
    yield Scene("without friction", ball, (1.0, 1.0, 0.0), whole, [slide(0.5), oblique(0.1, 1.5)], STATE[:4] + [("pressure", [0.0, 0.5])])

    # The families.
    for a in (3e-8, 1e-6, 1e-3, 0.3):
        yield of_family(f"exact sphere with a = {a} R", ("exact_sphere", 1.0), a)
    for depth in (1e-15, 0.9):
        yield Scene(f"exact sphere pressed in by {depth} R", ("exact_sphere", 1.0), UNIT, ("indentation", depth), tour(depth * 0.7, depth * 0.7), EVERYWHERE)
    yield Scene("exact sphere by force", ("exact_sphere", 0.05), PLAIN, ("normal_force", 1e5), [push(2e4), push(-1e4)], STATE + [("shear", parts_of_radius(0, 0.5, 0.9)), ("kink", at_kinks)])
    yield of_family("cone", ("cone", 0.2), 1.0, ask=OFF_CENTRE)
    yield of_family("steep cone of atoms", ("cone", 3.0), 1e-12, (1e12, 7e11, 0.1), OFF_CENTRE)
    for n in (0.5, 1.0, 1.5, 2.0, 3.0, 7.3, 50.0, 999.5, 1000.0):
        ask = OFF_CENTRE if n <= 1.0 else EVERYWHERE
        yield of_family(f"power law {n}", ("power_law", n, 1.0), 1.1 if n < 100 else 0.999, ask=[*ask, ("kink", at_kinks)])
    for n, c, a in ((1000.0, 1e200, 0.63), (1000.0, 1e-200, 1.5849), (0.5, 1e6, 1e-6), (0.5, 1e-6, 1e6)):
        yield of_family(f"power law {n} with {c}", ("power_law", n, c), a, ask=OFF_CENTRE)
    flat_moves = [slide(0.6), slide(0.2), oblique(0.4, 1.5), slide(1e3), Target(("U", -0.75), None, True), oblique(999.5, 0.3)]
    flat_ask = [*STATE, ("shear", parts_of_radius(0, 0.5, 0.999, 1 - 1e-12)), ("pressure", parts_of_radius(0, 0.9)),
                ("surface", parts_of_radius(0.5, 1, 1.0001, 3)), ("slip", parts_of_radius(0.5, 0.99))]
    for count in (1, 2, 3, 4, 5, 6):
        yield Scene(f"flat punch after {count} moves", ("flat_punch", 0.5), UNIT, whole, flat_moves[:count], flat_ask)
    yield Scene("flat punch by force", ("flat_punch", 0.5), PLAIN, ("normal_force", 1e3), [push(309.0), push(-200.0)], flat_ask)
    for name, make, wide in [
        ("truncated cone", lambda b: ("truncated_cone", 0.2, b), lambda b: ("truncated_cone", 0.2, b)),
        ("truncated sphere", lambda b: ("truncated_sphere", 1.0, b), lambda b: ("truncated_sphere", 1e6, b)),
        ("rounded punch", lambda b: ("rounded_punch", b, 1.0), lambda b: ("rounded_punch", b, 1e6)),
        ("rounded cone", lambda b: ("rounded_cone", 0.2, b), lambda b: ("rounded_cone", 0.2, b)),
    ]:
        # b/a from zero to one: the flat vanishes, or all but a sliver is flat.
        for b in (1e-15, 1e-8, 1e-3, 0.3, 0.9, 0.9999, 1.0 - 1e-8, 1.0 - 1e-12):
            ask = OFF_CENTRE if b < 1e-6 else EVERYWHERE
            ask = [*ask, ("shear", parts_of_radius(mpf(b) / 2, (1 + mpf(b)) / 2))]
            yield of_family(f"{name} with b = {b}", make(b), 1.0, ask=ask)
        yield of_family(f"{name} with stresses at the kinks", make(0.3), 1.0, ask=[("kink", at_kinks)])
        yield of_family(f"{name} over twenty decades", wide(1e-14), 1e6, ask=OFF_CENTRE)
        yield of_family(f"{name} of nanometres", make(1e-9), 1.7e-9, (1e12, 9e11, 0.2))
    yield of_family("rounded cone within its tip", ("rounded_cone", 0.2, 1.0), 0.4)
    yield of_family("rounded cone at its tip", ("rounded_cone", 0.2, 1.0), 1.0)
    yield of_family("rounded cone just beyond its tip", ("rounded_cone", 0.2, 1.0), 1.0 + 1e-12)
    # Sums.
    yield of_family("sum of two spheres", ("sum", ("sphere", 1.0), ("sphere", 3.0)), 0.7)
    yield of_family("sphere and cone", ("sum", ("sphere", 1.0), ("cone", 0.01)), 0.7, ask=OFF_CENTRE)
    yield of_family("sphere and its fourth power", ("sum", ("sphere", 1.0), ("power_law", 4.0, 0.7)), 0.7)
    yield of_family("two worn shapes", ("sum", ("truncated_cone", 0.1, 0.2), ("rounded_punch", 0.4, 2.0), ("sphere", 50.0)), 0.9)
    yield of_family("power laws over twenty decades", ("sum", ("power_law", 0.5, 1e-8), ("sphere", 1.0), ("power_law", 6.0, 1e-20)), 0.01, ask=OFF_CENTRE)
    blunt = ("sum", ("sphere", 1.0), ("flat_punch", 0.5))
    for depth in (0.2, 0.25, 0.2500001, 0.4):
        yield Scene(f"sphere with a sharp rim pressed in by {depth}", blunt, UNIT, ("indentation", depth),
                    [slide(0.15), slide(-0.05), oblique(0.05, 0.3), oblique(0.1, 0.35), slide(0.3), slide(0.1)], EVERYWHERE)
    # Tables.
    few = ["force", "normal_force", "contact_radius", "stick_radius", "elastic", "dissipated", ("shear", parts_of_radius(0, 0.3, 0.8)),
           ("pressure", parts_of_radius(0.5)), ("surface", parts_of_radius(0.7, 1.2)), ("slip", parts_of_radius(0.9))]
    for name, points in {
        "of a convex body": [(0.0, 0.0), (0.1, 0.004), (0.25, 0.03), (0.4, 0.1), (0.5, 0.16), (0.8, 0.5), (1.0, 0.8), (1.3, 1.5)],
        "with a blunt end": [(0.0, 0.0), (0.2, 1e-4), (0.4, 0.004), (0.6, 0.05), (0.8, 0.17), (1.0, 0.4), (1.4, 1.1)],
        "with a bump": [(0.0, 0.0), (0.2, 0.03), (0.4, 0.1), (0.5, 0.147), (0.6, 0.187), (0.8, 0.33), (1.0, 0.53), (1.3, 0.9)],
        "with a worn flat": [(0.0, 0.0), (0.2, 0.0), (0.4, 0.0), (0.6, 0.05), (0.8, 0.17), (1.0, 0.4), (1.4, 1.1)],
        "with a straight flank": [(0.0, 0.0), (0.2, 0.03), (0.4, 0.1), (0.5, 0.145), (0.6, 0.19), (0.8, 0.33), (1.0, 0.53), (1.3, 0.9)],
        "of a worn cone": [(0.0, 0.0), (0.2, 0.0), (0.4, 0.0), (0.5, 0.1), (0.6, 0.2), (0.8, 0.4), (1.0, 0.6), (1.3, 0.9)],
        "over twenty decades": [(0.0, 0.0), *((10.0**k, 10.0 ** (1.25 * k)) for k in (-14, -10, -6, -2, 1, 3, 5)), (1e6, 4e7)],
    }.items():
        flat = [number for point in points for number in point]
        yield of_family(f"table {name}", ("tabulated", *flat), 0.73 * points[-1][0], ask=few)


# -------------------------------------------------------------------------------------------------------- long histories

def first_force(u):
    return 1 - (1 - u) * mp.sqrt(1 - u)


def first_stress(u, square):
    return mp.sqrt(1 - square) - (mp.sqrt(1 - u - square) if square < 1 - u else 0)


def strokes(path):
    """Masing's strokes of a path whose turning points shrink, at constant load: (factor, size), sizes within one."""
    signs = [1 if b > a else -1 for a, b in zip([mpf(0), *path], path)]
    return [(s * (1 if k == 0 else 2), abs(b - a) / (1 if k == 0 else 2)) for k, (s, a, b) in enumerate(zip(signs, [mpf(0), *path], path))]


def nested_rows(count, step, radii):
    """A ball of ones; displacements +-(count - k) step for k = 0, 1, ..."""
    path = [(1 if k % 2 == 0 else -1) * (count - k) * mpf(step) for k in range(count)]
    terms = strokes(path)
    limit = mpf(4) / 3
    unit = 2 / pi
    rows = [f"units,{number(limit)},{number(unit)},{number(mpf(1))}"]
    rows.append(f"force,{number(limit * sum(f * first_force(u) for f, u in terms))}")
    for r in radii:
        square = exact(r) ** 2
        rows.append(f"shear,{r!r},{number(unit * sum(f * first_stress(u, square) for f, u in terms))}")
    return rows


def check_nested():
    """The sum of strokes against the nodes."""
    contact = Scene("", ("sphere", 1.0), UNIT, ("indentation", 1.0), [], []).contact()
    for k in range(30):
        carry_out(contact, slide((1 if k % 2 == 0 else -1) * (30 - k) / 32))
    contact.check()
    plain = answers(contact, ["force", ("shear", [0.1, 0.75])])
    fast = nested_rows(30, 1 / 32, [0.1, 0.75])
    for a, b in zip(plain, fast):
        assert abs(mpf(a.split(",")[-1]) - mpf(b.split(",")[-1])) < mpf(10) ** -19, (a, b)


def long_scenes():
    check_nested()
    head = Scene("1e5 nested reversals", ("sphere", 1.0), UNIT, ("indentation", 1.0), [], []).head()
    count, step = 100_000, 2.0**-17
    kink = float(mp.sqrt(1 - mpf(step) * (2 * 5000 + 1) / 2))
    radii = [0.0, 1e-9, 0.1, 0.5, 0.7, 0.9, 0.99, 0.99999, 1 - 1e-9, kink, up(kink), down(kink)]
    yield [head, f"nested,{count},{step!r}", *nested_rows(count, step, radii)]
    # A cycle a million times over, by increments.
    scene = Scene("a million reversals by increments", ("sphere", 1.0), UNIT, ("indentation", 1.0), [slide(0.3), slide(-0.3), slide(0.3)], [])
    contact = scene.contact()
    for target in scene.moves:
        carry_out(contact, target)
    ask = ["force", "displacement", "elastic", ("shear", [0.0, 0.5, 0.9]), ("kink", at_kinks)]
    yield [scene.head(), "swing,1000000,0.3", *answers(contact, ask)]


# --------------------------------------------------------------------------------------------------------- random scenes

def short(value, digits=4):
    """Rounded to a few digits, so that it takes little room; then taken as exact."""
    return float(f"{float(value):.{digits - 1}e}")


def random_profile(chance, size, parts=True):
    """Any family, of contact radii about `size`."""
    flat = short(size * chance.choice([chance.uniform(0.05, 0.98), 10 ** chance.uniform(-6, -1)]))
    blunt = short(size * 10 ** chance.uniform(0.5, 3))
    slope = short(10 ** chance.uniform(-3, 0))
    power = chance.choice([0.5, 0.7, 1.0, 1.5, 2.0, 3.0, 4.0, 2.6, 12.0, 60.0, 400.0, 1000.0])
    words = chance.choice([
        ("sphere", blunt),
        ("sphere", blunt),
        ("exact_sphere", short(size * chance.choice([1.25, 1.4, 5.0, 100.0, 1e4, 1e7]))),
        ("cone", slope),
        # Of height 0.1 size at r = size.
        ("power_law", power, short(0.1 * size * size**-power if power < 20 else 0.1)),
        ("flat_punch", short(size)),
        ("truncated_cone", slope, flat),
        ("truncated_sphere", blunt, flat),
        ("rounded_punch", flat, blunt),
        ("rounded_cone", slope, flat),
        ("sum",),
    ])
    if words != ("sum",):
        return words
    if not parts:
        return ("sphere", blunt)
    return ("sum", *(random_profile(chance, size, False) for _ in range(chance.randint(2, 3))))


def random_scene(index):
    chance = random.Random(1000 + index)
    size = 10 ** chance.uniform(-3, 1) if index % 4 else 10 ** chance.uniform(-8, 3)
    if index % 3:
        size = chance.uniform(0.5, 1.0)
    words = random_profile(chance, size)
    if any(part[0] == "power_law" and part[1] > 20 for part in (words, *words[1:]) if isinstance(part, tuple)):
        # A high power is a wall at r = 1.
        size = chance.uniform(0.9, 1.05)
    e_star = short(10 ** chance.uniform(3, 12))
    material = (e_star, short(e_star * chance.uniform(0.5, 1.2)), short(chance.uniform(0.02, 1.3)))
    profile = profile_of(words)
    a = mpf(size) * mpf(chance.uniform(0.6, 0.99))
    if profile.rim is not None:
        a = min(a, profile.rim)
    d = profile.g(a)
    if profile.rim is not None and a == profile.rim or a <= profile.core:
        d = d + mpf(size) * mpf(chance.uniform(0.001, 0.1))
    kind = chance.choice(["indentation", "indentation", "normal_force", "contact_radius"])
    if kind == "contact_radius" and a <= profile.core * (1 + mpf(10) ** -6) or profile.rim is not None:
        kind = "indentation"
    value = {"indentation": lambda: d, "contact_radius": lambda: a, "normal_force": lambda: load(profile, exact(e_star), d)}[kind]()
    preload = (kind, short(value))
    contact = Scene("", words, material, preload, [], []).contact()
    moves, room = [], 1.0 if profile.ceiling is not None else 1.4
    unit_d, unit_u = float(contact.d), float(contact.d * contact.m)
    here = 1.0
    reach = chance.choice([1.2, 1.2, 0.4, 1e-3, 1e-7])
    for count in range(chance.randint(2, 10)):
        what = chance.random()
        u = short(unit_u * chance.uniform(-reach, reach))
        if what < 0.45:
            moves.append(slide(u))
        elif what < 0.6:
            moves.append(Target(("U", u), None, True))
        elif what < 0.66 and reach > 0.3 and len(contact.nodes) < 6 and here > 0:
            limit = float(contact.mu * contact.normal_force())
            moves.append(push(short(limit * chance.uniform(-0.98, 0.98))))
        else:
            here = max(0.05, min(room, here + chance.uniform(-0.5, 0.5) * min(reach, 1.0)))
            if count < 4 and chance.random() < 0.05:
                here = -0.1
            target = short(unit_d * here, 6)
            moves.append(oblique(u, target) if chance.random() < 0.8 else press(target))
        carry_out(contact, moves[-1])
        here = float(contact.d) / unit_d
    if contact.d <= 0:
        moves.append(oblique(0.0, short(unit_d * 0.8, 6)))
        carry_out(contact, moves[-1])
        moves.append(slide(short(0.3 * unit_u)))
        carry_out(contact, moves[-1])
    contact.check(index)
    edge = contact.radius()
    radii = [short(edge * mpf(chance.uniform(0.01, 0.99)), 6) for _ in range(2)]
    kinks = [x for x in (contact.profile.radius(node.y) for node in contact.nodes[1:]) if x > 0]
    if kinks:
        near = chance.choice(kinks) * (1 + chance.choice([1, -1]) * mpf(10) ** mpf(chance.uniform(-9, -2)))
        radii.append(float(near))
    radii = [r for r in radii if 0 < r < edge * (1 - mpf(10) ** -9)]
    scene = Scene(str(index), words, material, preload, moves, ["force", ("kink", radii)])
    return [scene.head(), *(target.written() for target in moves), *answers(contact, scene.ask)]


def solve(scene):
    mp.dps = scene.digits
    contact = scene.contact()
    for target in scene.moves:
        carry_out(contact, target)
    contact.check()
    rows = [scene.head(), *(target.written() for target in scene.moves), *answers(contact, scene.ask)]
    mp.dps = 60
    return rows


def check_profiles():
    for words, radii in [
        (("sphere", 2.0), [0.3]),
        (("exact_sphere", 1.0), [1e-6, 0.3, 0.9]),
        (("cone", 0.1), [0.3]),
        (("power_law", 0.5, 1.0), [0.3]),
        (("power_law", 1000.0, 1.0), [0.97]),
        (("truncated_cone", 0.2, 0.1), [0.1001, 1.0]),
        (("truncated_sphere", 2.0, 0.1), [0.11, 1.0]),
        (("rounded_punch", 0.1, 1.0), [0.11, 1.0]),
        (("rounded_cone", 0.1, 0.1), [0.05, 0.11, 1.0]),
        (("tabulated", 0.0, 0.0, 0.2, 0.03, 0.4, 0.1, 0.5, 0.145, 0.8, 0.33), [0.1, 0.15, 0.7]),
        (("sum", ("sphere", 1.0), ("truncated_cone", 0.1, 0.2)), [0.1, 0.3]),
    ]:
        profile_of(words).check(radii)


def save(name, blocks):
    start, count = time.time(), 0
    path = os.path.join(HERE, name)
    with open(path + ".new", "w", encoding="ascii") as file:
        file.write("# Written by scenes.py.\n")
        for rows in blocks:
            file.write("\n".join(rows) + "\n")
            file.flush()
            count += 1
    os.replace(path + ".new", path)
    print(f"{name}: {count} scenes in {time.time() - start:.0f} s")


# ----------------------------------------------------------------------------------------------------------- curved paths

BALL = ("sphere", 1.0)
EVEN = (1.0, 0.8, 0.5)


def both(tangential, normal):
    return Target(tangential=tangential, normal=normal)


def curved_scenes():
    """(name, profile, straight moves, last move): mu F_N = 2/3 and u_max = 0.625 at d = 1."""
    slides = [slide(0.3), slide(-0.1)]
    for words, kind in ((BALL, "ball"), (("cone", 0.6), "cone")):
        yield f"{kind} displaced while the load rises without slip", words, [], both(("U", 0.2), ("N", 3.0))
        yield f"{kind} displaced while the load rises until it slips", words, [], both(("U", 1.0), ("N", 4.0))
        yield f"{kind} displaced while the load rises with slip all along", words, [], both(("U", 0.6), ("N", 1.6))
        yield f"{kind} displaced backward while the load rises until it slips", words, slides, both(("U", -1.1), ("N", 4.0))
        yield f"{kind} displaced while the load falls", words, slides, both(("U", 0.1), ("N", 0.4))
        yield f"{kind} displaced a little while the load falls", words, slides, both(("U", -0.08), ("N", 0.7))
        yield f"{kind} pushed while it is pressed without slip", words, [], both(("F", 0.4), ("d", 1.8))
        yield f"{kind} pushed while it is pressed with slip at first", words, [], both(("F", 0.7), ("d", 1.45))
        yield f"{kind} pushed back while it is pressed", words, slides, both(("F", -0.3), ("d", 1.7))
        yield f"{kind} pushed while it is released", words, slides, both(("F", 0.1), ("d", 0.6))
        yield f"{kind} pushed while the load rises without slip", words, slides, both(("F", 0.5), ("N", 3.5))
        yield f"{kind} pushed while the load rises with slip", words, slides, both(("F", 0.6), ("N", 1.9))
        yield f"{kind} pushed while the load falls", words, slides, both(("F", -0.05), ("N", 0.5))
        yield f"{kind} pushed the other way while the load falls", words, slides, both(("F", 0.1), ("N", 0.8))


CURVED = list(curved_scenes())


def curved_rows(index):
    name, words, moves, last = CURVED[index]
    mp.dps = 40
    scene = Scene(name, words, EVEN, ("indentation", 1.0), moves, [])
    contact = scene.contact()
    for target in moves:
        carry_out(contact, target)
    states = []
    for parts in (1, 4):
        state = Bent(contact)
        state.follow(last, parts)
        states.append(state)
    radii = [float(states[0].c.profile.radius(states[0].d) * mpf(share)) for share in (0.1, 0.4, 0.75, 0.97)]
    results = [[state.w * contact.m, state.force(), *(state.shear(exact(r)) for r in radii)] for state in states]
    for once, again in zip(*results):
        assert abs(once - again) < mpf(10) ** -24, (name, once, again)
    normal = load(contact.profile, contact.e, states[0].d)
    a = contact.profile.radius(states[0].d)
    unit = 2 * contact.e * a / pi if words[0] == "sphere" else normal / (pi * a * a)
    values = results[0]
    return [
        scene.head(),
        *(target.written() for target in moves),
        last.written(),
        "units," + ",".join(map(number, [contact.mu * normal, contact.mu * unit, contact.m * states[0].d])),
        f"displacement,{number(values[0])}",
        f"force,{number(values[1])}",
        f"normal_force,{number(normal)}",
        f"indentation,{number(states[0].d)}",
        *(f"shear,{r!r},{number(value)}" for r, value in zip(radii, values[2:])),
    ]


HARD = list(hard_scenes())


def hard_rows(index):
    start = time.time()
    rows = solve(HARD[index])
    if time.time() - start > 5:
        print(f"{HARD[index].name}: {time.time() - start:.1f} s", flush=True)
    return rows


def hard(pool):
    yield from pool.imap(hard_rows, range(len(HARD)))
    yield from long_scenes()


if __name__ == "__main__":
    check_profiles()
    asked = sys.argv[1:] or ["hard"]
    with multiprocessing.Pool() as pool:
        if "hard" in asked:
            save("hard_cases.csv", hard(pool))
        if "curved" in asked:
            save("curved.csv", pool.imap(curved_rows, range(len(CURVED))))
        if "accuracy" in asked:
            save("accuracy.csv", pool.imap(random_scene, range(500)))
