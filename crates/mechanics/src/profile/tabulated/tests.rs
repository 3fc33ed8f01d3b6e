//! A table against the sum of a sphere and rounded punches that it is.

use super::super::{Profile, Ring, RoundedPunch, Sphere, StressRadius, Sum};
use super::*;

/// Radii and jumps of f'' of a convex profile, the first at the centre.
const BENDS: [(f64, f64); 8] =
    [(0.0, 0.7), (0.013, 2.0), (0.0131, 0.4), (0.2, 1.0), (0.35, 9.0), (0.36, 0.1), (0.9, 3.0), (0.99, 5.0)];

fn sum() -> Profile {
    let mut parts = vec![Profile::Sphere(Sphere::new(1.0 / BENDS[0].1).unwrap())];
    for (radius, bend) in &BENDS[1..] {
        parts.push(Profile::RoundedPunch(RoundedPunch::new(*radius, 1.0 / bend).unwrap()));
    }
    Profile::Sum(Sum::new(parts).unwrap())
}

/// The same as a table with `idle` knots where nothing happens between any two, up to the radius 1.3.
fn table(idle: u32) -> Profile {
    let mut radii: Vec<f64> = BENDS.iter().map(|bend| bend.0).chain([1.3]).collect();
    for pair in radii.clone().windows(2) {
        for i in 1..=idle {
            radii.push(pair[0] + (pair[1] - pair[0]) * f64::from(i) / f64::from(idle + 1));
        }
    }
    radii.sort_by(f64::total_cmp);
    let slope = |r: f64| BENDS.iter().map(|bend| bend.1 * (r - bend.0).max(0.0)).sum();
    let knots: Vec<Knot> = radii.iter().map(|&radius| Knot { radius, slope: slope(radius) }).collect();
    Profile::Tabulated(Tabulated::from_knots(&knots, false).unwrap())
}

fn worst(pairs: &[(f64, f64)]) -> f64 {
    pairs.iter().map(|(ours, exact)| ((ours - exact) / exact).abs()).fold(0.0, f64::max)
}

#[test]
fn a_table_is_a_sum_of_rounded_punches() {
    let sum = sum();
    for idle in [0, 3, 40] {
        let table = table(idle);
        let mut pairs = Vec::new();
        for i in 1..200 {
            let x = 0.0064 * f64::from(i);
            let y = sum.level(x);
            pairs.push((table.level(x), y));
            pairs.push((table.slope(x), sum.slope(x)));
            pairs.push((table.radius(y), x));
            pairs.push((Shape::load(&table, x), Shape::load(&sum, x)));
            pairs.push((table.indentation_for(Shape::load(&sum, x)), y));
        }
        assert!(worst(&pairs) < 3e-14, "{idle}: {:e}", worst(&pairs));
    }
}

#[test]
fn rings_of_a_table_are_those_of_the_sum() {
    let sum = sum();
    for idle in [0, 40] {
        let table = table(idle);
        for (inner, outer) in [(0.0, 1.2), (0.3, 1.1), (0.357, 0.358), (0.0130, 0.0132), (0.95, 0.95 + 1e-9)] {
            let ring = |profile: &Profile| {
                let level = |x: f64| DoubleDouble::from(sum.level(x));
                Ring::between(profile.point(level(inner)), profile.point(level(outer)))
            };
            let (ours, exact) = (ring(&table), ring(&sum));
            let (m, n) = (table.moments(&ours), sum.moments(&exact));
            let error = worst(&[(m.width, n.width), (m.first, n.first), (m.second, n.second)]);
            assert!(error < 1e-12, "{idle} {inner} {outer}: {error:e}");
            for share in [0.2, 0.45, 0.999, 1.0, 1.2] {
                let at = StressRadius::new(inner + share * (outer - inner));
                let mut pairs = vec![(table.displacement_integral(&at, &ours), sum.displacement_integral(&at, &exact))];
                if share < 1.0 {
                    pairs.push((table.kernel(&at, &ours), sum.kernel(&at, &exact)));
                    pairs.push((table.kernel_slope(&at, &ours), sum.kernel_slope(&at, &exact)));
                }
                // x^2 is known to round-off of x^2: in a ring of 1e-9 of it, near an edge, little of x^2 - r^2 is left.
                let allowed = if outer - inner > 1e-5 { 1e-10 } else { 1e-3 };
                assert!(worst(&pairs) < allowed, "{idle} {inner} {outer} {share}: {:e} {pairs:?}", worst(&pairs));
            }
        }
    }
}
