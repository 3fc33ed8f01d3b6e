"""Line contacts."""

from mpmath import acos, asin, cos, log, mp, mpf, pi, quad, sin, sqrt

from found.common import near, out, problem, root


def line_contact():
    e_body, nu, r, mu, length = 7.4e10, 0.33, 0.05, 0.6, 0.01
    load, kappa = 968.466409034, 198251.58437
    k = (1 - mpf(nu) ** 2) / mpf(e_body)
    modulus = 1 / (2 * k)
    per_length = mpf(load) / mpf(length)
    a = sqrt(4 * per_length * mpf(r) / (pi * modulus))
    peak = 2 * per_length / (pi * a)
    limit = mpf(mu) * mpf(load)
    shares = [0.5, -0.5, 0.5, -0.2, 0.1]
    forces = [float(f"{float(limit * mpf(share)):.9e}") for share in shares]
    # Strokes after wiping out: the virgin one to 0.5 N, then those from a turn to a turn.
    turns = [
        (mpf(forces[0]), mpf(0), 1),
        (mpf(forces[1]), mpf(forces[0]), 2),
        (mpf(forces[2]), mpf(forces[1]), 2),
        (mpf(forces[3]), mpf(forces[2]), 2),
        (mpf(forces[4]), mpf(forces[3]), 2),
    ]
    # The loop 0.5, -0.5, 0.5 closes: its last turn is the first one again.
    strokes = [turns[0], turns[3], turns[4]]
    ellipses = []
    for to, since, factor in strokes:
        sign = 1 if to > since else -1
        c = a * sqrt(1 - abs(to - since) / (factor * limit))
        shift = mpf(r) / mpf(mu) * k * mpf(kappa) * abs(to - since) / factor
        ellipses += [(factor * sign * mpf(mu) * peak, a, mpf(0)), (-factor * sign * mpf(mu) * peak * c / a, c, shift)]
    total = mp.fsum(pi / 2 * height * width for height, width, _ in ellipses) * mpf(length)
    near(total, forces[-1], 20, "force of a line contact")

    def shear(x):
        return mp.fsum(h * sqrt(max(1 - ((mpf(x) - e) / c) ** 2, 0)) for h, c, e in ellipses)

    places = [float(f"{float(a * mpf(part)):.9e}") for part in (-0.97, -0.5, 0.1, 0.7, 0.99)]
    points = [
        [float(f"{float(a * mpf(x)):.9e}"), 0.0, float(f"{float(a * mpf(z)):.9e}")]
        for x, z in ((0.95, 0.02), (-0.8, 0.1))
    ]
    tensors = {name: [] for name in ("xx", "yy", "zz", "xz")}
    for x, _, z in points:
        x, z = mpf(x), mpf(z)

        def line(height, width, middle, x=x, z=z):
            u = mp.mpc(x - middle, z)
            s = sqrt(u - width) * sqrt(u + width)
            return pi * height / width * (u - s), pi * height / width * (1 - u / s)

        c, slope = line(peak, a, mpf(0))
        q, q_slope = [mp.fsum(part) for part in zip(*(line(*ellipse) for ellipse in ellipses))]
        both = 2 / pi * c.imag - 2 / pi * q.real
        apart = -2 / pi * z * slope.real + 2 / pi * (q.real - z * q_slope.imag)
        xz = -z * slope.imag / pi + (q.imag + z * q_slope.real) / pi
        xx, zz = (both - apart) / 2, (both + apart) / 2
        # Flamant's lines of force, summed.
        sums = []
        for kind in range(3):

            def flamant(t, width, middle, kind=kind, x=x, z=z):
                rho = (x - middle - width * sin(t)) ** 2 + z * z
                off = x - middle - width * sin(t)
                return [off * off * z, z**3, off * z * z][kind] / rho**2 * cos(t) ** 2 * width

            def flamant_along(t, width, middle, kind=kind, x=x, z=z):
                rho = (x - middle - width * sin(t)) ** 2 + z * z
                off = x - middle - width * sin(t)
                return [off**3, off * z * z, off * off * z][kind] / rho**2 * cos(t) ** 2 * width

            cuts = [-pi / 2, asin(max(min(x / a, 1), -1)), pi / 2]
            value = -2 / pi * peak * quad(lambda t: flamant(t, a, mpf(0)), cuts, maxdegree=9)
            for height, width, middle in ellipses:
                at = asin(max(min((x - middle) / width, 1), -1))
                ends = [-pi / 2, at, pi / 2] if abs(at) < 1.57 else [-pi / 2, pi / 2]
                value -= 2 / pi * height * quad(lambda t, w=width, m=middle: flamant_along(t, w, m), ends, maxdegree=9)
            sums.append(value)
        for first, second in zip((xx, zz, xz), sums):
            near(first, second, 8, "stress below a line contact")
        yy = mpf(nu) * (xx + zz)
        for name, value in (("xx", xx + mpf(kappa) * mpf(forces[-1])), ("yy", yy), ("zz", zz), ("xz", xz)):
            tensors[name].append(value)
    inputs = {
        "radius": r,
        "length": length,
        "youngs_modulus": e_body,
        "poisson_ratio": nu,
        "friction": mu,
        "normal_force": load,
        "stress_per_force": kappa,
        "forces": forces,
        "x": places,
        "points": points,
    }
    outputs = {
        "contact_half_width": out("m", a),
        "shear": out("Pa", *(shear(x) for x in places), scale=mpf(mu) * peak),
        **{name: out("Pa", *values, scale=peak) for name, values in tensors.items()},
    }
    return problem(
        "line-contact",
        "A cylinder on a flat whose bulk stress follows the tangential force",
        "A cylinder of `radius` R and `length` L touches a half-space of the same material (`youngs_modulus`,"
        " `poisson_ratio`) in plane strain, under F_N = `normal_force` and friction mu. The tangential force"
        " on the first"
        " body (the cylinder) goes to each of `forces` along x; the second one carries a bulk stress sigma_xx ="
        " `stress_per_force` times this force. Asked after the last: half-width a, shear stress at `x`, and below"
        " `points` (x, y, z; z into the second body) the components of its stress, tension positive, xx with the bulk"
        " stress, yy without its share. Shear stress is positive along x on the second body.",
        "Each stroke adds two ellipses of traction, the inner one shifted by e = (R/mu) k sigma (k = (1 - nu^2)/E); the"
        " stress is in complex functions of x + i z. 40 digits.",
        "The ellipses add up to the force; the stress by quadrature of Flamant's line forces, to 8 digits.",
        ["Nowell & Hills 1987", "Johnson 1985, 10.1017/CBO9781139171731"],
        [{"name": "cylinder", "inputs": inputs, "outputs": outputs}],
        {
            "1e-2": "finite elements of some hundredth of the half-width",
            "1e-4": "converged singular integral equations",
            "1e-8": "the closed form",
        },
    )


def pad():
    b, r, length, modulus, load = mpf(5e-4), mpf(0.05), mpf(0.01), mpf(4e10), 1000.0

    def weight(a):
        return (a * a / 2 * acos(b / a) - b / 2 * sqrt(a * a - b * b)) / r

    a = root(lambda a: weight(a) - load / length / modulus, b * mpf("1.000001"), mpf(0.01))
    places = [0.0, 2e-4, 4.5e-4, 5.5e-4, float(f"{float(a * mpf(0.97)):.6e}")]

    def pressure(x):
        # (1/pi) int_x^a G'(t)/sqrt(t^2 - x^2) dt over t > b, with t^2 = x^2 + v^2.
        low = max(b, mpf(x))
        start = sqrt(low * low - mpf(x) ** 2)
        return (
            modulus
            / pi
            * quad(lambda v: acos(min(b / sqrt(mpf(x) ** 2 + v * v), 1)) / r, [start, sqrt(a * a - mpf(x) ** 2)])
        )

    def closed(x):
        # Ciavarella, Hills and Monno: sin phi = x/a, sin phi0 = b/a.
        phi, phi0 = asin(mpf(x) / a), asin(b / a)
        part = (pi - 2 * phi0) * cos(phi) + sin(phi) * log(abs(sin(phi + phi0) / sin(phi - phi0)))
        part += sin(phi0) * log(abs(mp.tan((phi + phi0) / 2) * mp.tan((phi - phi0) / 2)))
        return 2 * load / length / (pi * a) / (pi - 2 * phi0 - sin(2 * phi0)) * part

    pressures = [pressure(x) for x in places]
    for first, second in zip(pressures, map(closed, places)):
        near(first, second, 15, "pressure of a pad")
    inputs = {
        "flat_half_width": 5e-4,
        "edge_radius": 0.05,
        "length": 0.01,
        "e_star": 4e10,
        "normal_force": load,
        "x": places,
    }
    return problem(
        "pad",
        "A flat pad with rounded edges",
        "A rigid pad, flat for |x| < b = `flat_half_width` and then a parabola of radius `edge_radius`, of"
        " `length` L, is"
        " pressed into a half-space of modulus E* in plane strain. Asked: half-width of the contact, and"
        " pressure at `x`.",
        "P/E* = (a^2/2 acos(b/a) - b/2 sqrt(a^2 - b^2))/R solved for a; pressure as a superposition of flat punches.",
        "The closed form of the pressure in logarithms.",
        ["Ciavarella, Hills & Monno 1998", "Shtaerman 1949"],
        [
            {
                "name": "pad",
                "inputs": inputs,
                "outputs": {"contact_half_width": out("m", a), "pressure": out("Pa", *pressures)},
            }
        ],
    )
