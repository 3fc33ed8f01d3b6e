//! The integrals of a sum with tables are those between its kinks, and its kernels those of its parts.

use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use super::super::shape::{self, KernelOrder, Shape};
use super::super::{
    Cone, FlatPunch, Moments, PowerLaw, Profile, Ring, RoundedPunch, Sphere, StressRadius, Tabulated, TruncatedCone,
};
use super::Sum;

/// Heights of uneven steps whose slope changes by any amount but falls nowhere.
fn table(steps: &[(f64, f64)]) -> Profile {
    let (mut radii, mut heights, mut slope) = (vec![0.0], vec![0.0], 0.0);
    for (step, bend) in steps {
        let (r, z): (f64, f64) = (radii[radii.len() - 1], heights[heights.len() - 1]);
        slope += bend * step;
        radii.push(r + 1e-3 * step);
        heights.push(z + 1e-6 * slope * step);
    }
    Profile::Tabulated(Tabulated::new(&radii, &heights).unwrap())
}

fn other(index: usize) -> Profile {
    match index {
        0 => Profile::Sphere(Sphere::new(1.0).unwrap()),
        1 => Profile::Cone(Cone::new(1e-3).unwrap()),
        2 => Profile::PowerLaw(PowerLaw::new(2.7, 0.3).unwrap()),
        3 => Profile::RoundedPunch(RoundedPunch::new(2e-3, 1.0).unwrap()),
        _ => table(&[(0.7, 0.4); 40]),
    }
}

fn close(found: f64, expected: f64, part: f64) -> bool {
    (found - expected).abs() <= part * expected.abs()
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 64, failure_persistence: None, rng_seed: RngSeed::Fixed(0), ..ProptestConfig::default()
    })]

    #[test]
    fn integrals_across_kinks_are_those_from_kink_to_kink(
        steps in prop::collection::vec((0.05..1.0_f64, 0.2..1.0_f64), 12..60),
        ends in prop::collection::vec(0.0..1.0_f64, 2..9),
        index in 0..5_usize,
    ) {
        let profile = Profile::Sum(Sum::new(vec![other(index), table(&steps)]).unwrap());
        let Profile::Sum(sum) = &profile else { panic!("a sum") };
        let limit = 0.95 * profile.limit_radius().unwrap();
        let mut levels: Vec<f64> = ends.iter().map(|share| profile.level(share * limit)).collect();
        levels.sort_by(f64::total_cmp);
        let points: Vec<_> = levels.iter().map(|&level| profile.point(level.into())).collect();
        let rings: Vec<(Ring, f64)> = points
            .windows(2)
            .enumerate()
            .map(|(index, pair)| (Ring::between(pair[0], pair[1]), if index % 2 == 0 { 1.0 } else { -0.7 }))
            .filter(|(ring, _)| ring.depth > 1e-6 * levels[levels.len() - 1])
            .collect();
        for (ring, _) in &rings {
            let span = shape::span(sum, ring);
            let (found, expected) = (sum.moments(&span, ring.outer.level.value()), shape::moments(sum, &span));
            let parts = |moments: Moments| [moments.width, moments.first, moments.second];
            for (found, expected) in parts(found).into_iter().zip(parts(expected)) {
                prop_assert!(close(found, expected, 2e-14), "{found:e} instead of {expected:e}");
            }
        }
        let radii: Vec<StressRadius> =
            (1..40).map(|index| StressRadius::new(limit * (f64::from(index) - 0.3) / 40.0)).collect();
        if rings.len() + 1 == points.len() {
            for (at, found) in radii.iter().zip(profile.kernel_sums_at(&rings, &radii)) {
                let kernel = |ring: &Ring| {
                    let span = shape::span(sum, ring);
                    sum.parts.iter().map(|part| Shape::kernel(part, KernelOrder::Value, at, &span)).sum::<f64>()
                };
                let terms = rings.iter().map(|(ring, weight)| weight * kernel(ring));
                let (expected, size) = terms.fold((0.0, 0.0), |(sum, size), term| (sum + term, size + term.abs()));
                prop_assert!((found - expected).abs() <= 1e-13 * size, "at {at:?}: {found:e} instead of {expected:e}");
            }
        }
    }
}

#[test]
fn a_punch_that_ends_inside_all_flats_of_a_sum_is_a_punch() {
    let flat = |radius| Profile::TruncatedCone(TruncatedCone::new(0.1, radius).unwrap());
    let punch = || Profile::FlatPunch(FlatPunch::new(1e-3).unwrap());
    for radius in [1e-3, 2e-3] {
        let sum = Profile::Sum(Sum::new(vec![flat(radius), punch()]).unwrap());
        let ring = |profile: &Profile| Ring::between(profile.point(0.0.into()), profile.point(1e-6.into()));
        assert_eq!(sum.moments(&ring(&sum)), punch().moments(&ring(&punch())));
        let at = StressRadius::new(5e-4);
        assert!((sum.kernel(&at, &ring(&sum)) / punch().kernel(&at, &ring(&punch())) - 1.0).abs() < 1e-15);
    }
}
