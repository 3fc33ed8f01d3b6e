//! A table against the sum of a sphere and rounded punches that it is.

use super::super::{Profile, Ring, RoundedPunch, Sphere, StressRadius, Sum};
use super::*;
use crate::cells::field::WeightedCells;
use crate::cells::kernel::Kernel;
use crate::cells::ring::Point;
use crate::cells::span::Span;
use crate::cells::{Cell, Cells, SpanParts};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::gauss;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

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
    let knots: Vec<SplineKnot> = radii.iter().map(|&radius| SplineKnot { radius, slope: slope(radius) }).collect();
    Profile::Tabulated(Tabulated::from_knots(knots, false, &|| true).unwrap())
}

/// All cells of a table.
fn all(table: &Tabulated) -> &Cells {
    table.all_cells().unwrap()
}

/// int x dg, m^2.
fn load(profile: &Profile, x: f64) -> f64 {
    let ring = Ring::between(profile.indenter().point(0.0.into()), profile.indenter().point(profile.level(x).into()));
    ring.inner.radius * ring.depth + profile.indenter().moments(&ring).first
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
            pairs.push((table.indenter().radius(y), x));
            pairs.push((load(&table, x), load(&sum, x)));
            pairs.push((table.indenter().indentation_for(load(&sum, x)), y));
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
                Ring::between(profile.indenter().point(level(inner)), profile.indenter().point(level(outer)))
            };
            let (ours, exact) = (ring(&table), ring(&sum));
            let (m, n) = (table.indenter().moments(&ours), sum.indenter().moments(&exact));
            let error = worst(&[(m.width, n.width), (m.first, n.first), (m.second, n.second)]);
            assert!(error < 1e-12, "{idle} {inner} {outer}: {error:e}");
            for share in [0.2, 0.45, 0.999, 1.0, 1.2] {
                let at = StressRadius::new(inner + share * (outer - inner));
                let mut pairs = vec![(
                    table.indenter().displacement_integral(&at, &ours),
                    sum.indenter().displacement_integral(&at, &exact),
                )];
                if share < 1.0 {
                    pairs.push((table.indenter().kernel(&at, &ours), sum.indenter().kernel(&at, &exact)));
                    pairs.push((table.indenter().kernel_slope(&at, &ours), sum.indenter().kernel_slope(&at, &exact)));
                }
                // x^2 is known to round-off of x^2: in a ring of 1e-9 of it, near an edge, little of x^2 - r^2 is left.
                let allowed = if outer - inner > 1e-5 { 1e-10 } else { 1e-3 };
                assert!(worst(&pairs) < allowed, "{idle} {inner} {outer} {share}: {:e} {pairs:?}", worst(&pairs));
            }
        }
    }
}

/// A convex table of uneven steps, and bends of any size between them.
fn uneven(steps: &[(f64, f64)]) -> Tabulated {
    let (mut radii, mut heights, mut slope) = (vec![0.0], vec![0.0], 0.0);
    for (index, (step, bend)) in steps.iter().enumerate() {
        slope += bend * step;
        radii.push(radii[index] + step);
        heights.push(heights[index] + slope * step);
    }
    Tabulated::new(&radii, &heights).unwrap()
}

/// Rings between the levels at these shares of the largest radius, with weights.
fn rings(table: &Tabulated, shares: &[(f64, f64)]) -> Vec<(Ring, f64)> {
    let mut shares = shares.to_vec();
    shares.sort_by(|a, b| a.0.total_cmp(&b.0));
    let point = |share: f64| {
        let level = DoubleDouble::from(table.level(0.99 * share * table.end));
        let square = all(table).square(level);
        Point { level, radius: square.value().sqrt(), square }
    };
    let between = |pair: &[(f64, f64)]| (Ring::between(point(pair[0].0), point(pair[1].0)), pair[1].1);
    shares.windows(2).map(between).collect()
}

/// The kernel of a part of a cell as int q dv, v = sqrt(x^2 - r^2), by Gauss's rule on stretches that halve towards
/// the lower end, where t may begin like a root of v.
fn graded_kernel(cell: &Cell, at: &StressRadius, span: &Span) -> f64 {
    let (inner, outer) = ((span.inner - at.square).value().max(0.0).sqrt(), (span.outer - at.square).value());
    let kappa = (at.square - cell.square).value();
    // By the difference of the squares, which a thin part knows better than the roots do.
    let gap = if inner > 0.0 { span.gap } else { outer };
    let (mut sum, mut width) = (0.0, gap / (outer.max(0.0).sqrt() + inner));
    if outer <= 0.0 {
        return 0.0;
    }
    for _ in 0..50 {
        width *= 0.5;
        sum += gauss::integral(&gauss::TWENTY_POINTS, width, |step| {
            let v = inner + width + step;
            cell.slope_over_radius((kappa + v * v).max(0.0).sqrt().min(cell.high))
        });
    }
    sum
}

fn steps() -> impl Strategy<Value = Vec<(f64, f64)>> {
    prop::collection::vec(((-3.0..0.0_f64).prop_map(|power| 10.0_f64.powf(power)), 0.01..1.0_f64), 3..120)
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 64, failure_persistence: None, rng_seed: RngSeed::Fixed(0), ..ProptestConfig::default()
    })]

    #[test]
    fn weighted_kernels_are_the_sums_of_those_of_cells(
        steps in steps(),
        shares in prop::collection::vec((0.0..1.0_f64, -1.0..1.0_f64), 2..12),
        radii in prop::collection::vec(0.0..1.0_f64, 1..20),
    ) {
        let table = uneven(&steps);
        let rings = rings(&table, &shares);
        let radii: Vec<StressRadius> = radii.iter().map(|share| StressRadius::new(share * table.end)).collect();
        let span = |ring: &Ring| Span::of(ring, all(&table).gap(ring, ring.depth), 0.0);
        let by_cells = |at: &StressRadius, ring: &Ring| {
            let cells = all(&table);
            let SpanParts { low, whole, high } = cells.parts(&span(ring));
            let whole = whole.map(|index| (index, cells.span_of_cell(index)));
            let kernel = |(index, span): (usize, Span)| graded_kernel(&cells.cells[index], at, &span);
            low.into_iter().chain(whole).chain(high).map(kernel).sum::<f64>()
        };
        let size: f64 = rings.iter().map(|(ring, _)| by_cells(&StressRadius::new(0.0), ring)).sum();
        let spans: Vec<(Span, f64)> = rings.iter().map(|(ring, weight)| (span(ring), *weight)).collect();
        let sums = WeightedCells::new(all(&table), &spans, radii.len()).sums(Kernel::Root, &radii);
        for (at, (sum, _)) in radii.iter().zip(sums) {
            let exact: f64 = rings.iter().map(|(ring, weight)| weight * by_cells(at, ring)).sum();
            prop_assert!((sum - exact).abs() <= 3e-14 * size, "{:e}: {sum:e} {exact:e}", at.radius);
            for (ring, _) in &rings {
                let (kernel, exact) = (all(&table).sum(Kernel::Root, at, &span(ring)), by_cells(at, ring));
                prop_assert!((kernel - exact).abs() <= 3e-14 * size, "{:e}: {kernel:e} {exact:e}", at.radius);
            }
        }
    }

    #[test]
    fn a_radius_is_found_again_by_its_level(steps in steps(), shares in prop::collection::vec(0.0..1.0_f64, 1..30)) {
        let table = uneven(&steps);
        for share in shares {
            let radius = share * table.end;
            let level = DoubleDouble::from(table.level(radius));
            let found = table.level(all(&table).square(level).value().sqrt());
            let allowed = 1e-14 * level.value() + 1e-16 * table.level(table.end);
            prop_assert!((found - level.value()).abs() <= allowed, "{radius:e}: {found:e}");
        }
    }
}
