//! Single families at numbers where digits are easily lost: thin rings, tips, tiny flats, the smallest and the largest
//! exponents.

use stickslip_mechanics::DoubleDouble;
use stickslip_mechanics::profile::{Cone, ExactSphere, PowerLaw, Profile, Ring, Sphere, StressRadius, TruncatedCone};

fn sphere(radius: f64) -> Profile {
    Profile::Sphere(Sphere::new(radius).unwrap())
}

/// The ring of a profile from one level to another.
fn ring(profile: &Profile, inner: DoubleDouble, outer: f64) -> Ring {
    Ring::between(profile.indenter().point(inner), profile.indenter().point(DoubleDouble::from(outer)))
}

#[test]
fn moments_of_a_thin_ring_keep_their_digits() {
    let sphere = sphere(2.0);
    for depth in [0.5, 1e-3, 1e-8, 1e-14] {
        let ring = ring(&sphere, DoubleDouble::from(0.5) - DoubleDouble::from(depth), 0.5);
        let m = sphere.indenter().moments(&ring);
        // Series about the edge: X(y) = sqrt(2 y), X' = 1/X.
        if depth < 1e-7 {
            assert!((m.width / depth - 1.0).abs() < 1e-7);
            assert!((m.first / (depth * depth / 2.0) - 1.0).abs() < 1e-7);
            assert!((m.second / (depth.powi(3) / 3.0) - 1.0).abs() < 1e-7);
        } else {
            let (x1, x2) = (ring.inner.radius, ring.outer.radius);
            let first = 0.5 * (x2 - x1) - (x2.powi(3) - x1.powi(3)) / 6.0;
            assert!((m.first - first).abs() < 1e-15);
        }
    }
}

#[test]
fn the_arc_of_a_sliver_keeps_its_digits() {
    // On the sphere of radius 1 m the square of a radius is the level.
    let (sphere, gap) = (sphere(1.0), 1e-20);
    let sliver = ring(&sphere, DoubleDouble::from(0.25) - DoubleDouble::from(gap), 0.25);
    // dx / sqrt(r^2 - x^2) with dx = gap / (2 x) and r = 1.
    let exact = gap / (2.0 * 0.5) / 0.75f64.sqrt();
    assert!((sphere.indenter().arc(&StressRadius::new(1.0), &sliver) / exact - 1.0).abs() < 1e-15);
}

#[test]
fn the_arc_up_to_r_is_a_quarter_turn() {
    let sphere = sphere(1.0);
    let whole = ring(&sphere, DoubleDouble::ZERO, 4.0);
    let arc = |radius: f64| sphere.indenter().arc(&StressRadius::new(radius), &whole);
    assert!((arc(1.5) - std::f64::consts::FRAC_PI_2).abs() < 1e-16);
    assert!((arc(4.0) - 0.5f64.asin()).abs() < 1e-16);
}

#[test]
fn far_from_the_limit_the_exact_sphere_is_the_paraboloid() {
    let sphere = Profile::ExactSphere(ExactSphere::new(2.0).unwrap());
    for level in [1e-20, 1e-12, 1e-8] {
        // R y (1 - y/(3R)) to second order.
        let square = sphere.indenter().point(DoubleDouble::from(level)).square.value();
        assert!((square / (2.0 * level * (1.0 - level / 6.0)) - 1.0).abs() < 1e-15, "{level}: {square}");
    }
}

#[test]
fn any_level_of_the_exact_sphere_has_a_radius_below_the_limit() {
    let sphere = Profile::ExactSphere(ExactSphere::new(1e-3).unwrap());
    for level in [1e-30, 1e-9, 1e-3, 1.0, 1e9] {
        let radius = sphere.indenter().radius(level);
        assert!(radius > 0.0 && radius <= 1e-3, "{level} {radius}");
        assert!(sphere.indenter().point(DoubleDouble::from(level)).square.value() <= 1e-6 * (1.0 + 1e-15));
    }
}

#[test]
fn only_the_ring_at_the_tip_of_a_cone_is_infinite_there() {
    let cone = Profile::Cone(Cone::new(0.4).unwrap());
    let at_tip = |inner: f64, outer: f64| {
        cone.indenter().kernel(&StressRadius::new(0.0), &ring(&cone, DoubleDouble::from(inner), outer))
    };
    assert_eq!(at_tip(0.0, 0.1).to_bits(), f64::INFINITY.to_bits());
    assert!((at_tip(0.1, 0.2) / (0.4 * std::f64::consts::FRAC_PI_2 * 2f64.ln()) - 1.0).abs() < 1e-15);
}

#[test]
fn kernels_of_odd_powers_are_finite_at_the_centre_and_so_are_their_slopes_off_it() {
    let centre = StressRadius::new(0.0);
    for n in [3.0, 5.0, 7.0] {
        let power = Profile::PowerLaw(PowerLaw::new(n, 0.2).unwrap());
        let whole = ring(&power, DoubleDouble::ZERO, power.indenter().level(0.4));
        // int g'(x)/x dx = n B x^(n-1)/(n - 1).
        let kernel = power.indenter().slope(0.4) / (n - 1.0);
        let [sum, ..] = power.indenter().kernel_sums(&[(whole, 1.0)], &[0.0, 1e-170, 0.1])[..] else {
            panic!("three sums")
        };
        assert!((sum / kernel - 1.0).abs() < 1e-14, "{n}: {sum} {kernel}");
        // Half of int g'(x)/x^3 dx.
        let outer = ring(&power, DoubleDouble::from(power.indenter().level(0.1)), power.indenter().level(0.4));
        let scale = power.indenter().slope(1.0);
        let slope = 0.5
            * scale
            * if n > 3.0 { (0.4_f64.powf(n - 3.0) - 0.1_f64.powf(n - 3.0)) / (n - 3.0) } else { 4_f64.ln() };
        let found = power.indenter().kernel_slope(&centre, &outer);
        assert!((found / slope - 1.0).abs() < 1e-13, "{n}: {found} {slope}");
    }
}

#[test]
fn slopes_of_kernels_are_finite_at_any_radius_off_the_centre() {
    for r in [1e-9, 1e-90, 1e-150] {
        let at = StressRadius::new(r);
        // int x^2 dx/sqrt(x^2 - r^2) = (a v + r^2 ln((a + v)/r))/2 and int x^4 dx/sqrt(x^2 - r^2) for r << a.
        for (n, slope) in [(3.0, 0.5 * ((2.0 * 0.4_f64 / r).ln() - 1.0)), (5.0, 0.25 * 0.4 * 0.4)] {
            let power = Profile::PowerLaw(PowerLaw::new(n, 0.2).unwrap());
            let whole = ring(&power, DoubleDouble::ZERO, power.indenter().level(0.4));
            let found = power.indenter().kernel_slope(&at, &whole) / power.indenter().slope(1.0);
            assert!((found / slope - 1.0).abs() < 1e-12, "{n} at {r}: {found} is not {slope}");
        }
    }
}

#[test]
fn power_laws_from_the_smallest_exponent_to_the_largest() {
    // kappa = sqrt(pi) Gamma(n/2 + 1)/Gamma((n + 1)/2), the g(1) of f = r^n, to 17 digits.
    for (n, kappa) in [
        (0.1, 1.067672466624002),
        (0.5, 1.3110287771460598),
        (1.0, std::f64::consts::FRAC_PI_2),
        (1.5, 1.7972103521033884),
        (2.0, 2.0),
        (3.0, 2.356194490192345),
        (17.0, 5.244057134085929),
        (1000.0, 39.643182531295324),
    ] {
        let relative = Profile::PowerLaw(PowerLaw::new(n, 1.0).unwrap()).indenter().level(1.0) / kappa - 1.0;
        assert!(relative.abs() < 2e-15, "{n}: {relative:e}");
    }
}

#[test]
fn a_tiny_flat_and_a_huge_one() {
    for flat in [1e-12, 1e-3, 1.0, 1e6] {
        let cone = Profile::TruncatedCone(TruncatedCone::new(0.3, flat).unwrap());
        for level in [1e-9, 1e-3, 1.0, 1e3] {
            let back = cone.indenter().level(cone.indenter().radius(level));
            // Near the flat the level depends on x - b, of which a rounded x keeps few digits.
            let allowed =
                1e-15 * (level + cone.indenter().slope(cone.indenter().radius(level)) * cone.indenter().radius(level));
            assert!((back - level).abs() < allowed, "{flat} {level} {back}");
        }
    }
}
