//! The error estimates of tables with few points, or with points at geometric distances, against closed forms.

use crate::support::masing::Masing;
use crate::support::power_sums::{PowerSum, Pressed};
use crate::support::{Random, config, displace};
use proptest::prelude::*;
use stickslip_mechanics::profile::Tabulated;
use stickslip_mechanics::{Contact, Elasticity, Preload, Profile, Setup};

const E_STAR: f64 = 1e6;

/// A smooth convex body of about unit size.
fn body(random: &mut Random) -> PowerSum {
    match random.bits() % 3 {
        0 => PowerSum(vec![(random.within(0.1, 1.0), random.within(2.0, 6.0))]),
        1 => PowerSum(vec![(random.within(0.1, 1.0), 2.0), (random.within(0.05, 1.0), 4.0)]),
        _ => PowerSum(vec![(0.5, 2.0), (random.within(0.01, 0.5), 3.0), (random.within(0.01, 0.5), 6.0)]),
    }
}

/// Zero, and radii up to one each `ratio` times the one before.
fn geometric(points: u64, ratio: f64) -> Vec<f64> {
    let last = points - 1;
    let part = |index: u64| if index == 0 { 0.0 } else { ratio.powf(-((last - index) as f64)) };
    (0..points).map(part).collect()
}

/// Errors over their estimates and estimates, force and stress.
struct Compared {
    errors: [f64; 2],
    /// With the shift of kinks of the stress.
    plain: [f64; 2],
    estimates: [f64; 2],
}

fn compare(random: &mut Random, body: &PowerSum, radii: &[f64]) -> Option<Compared> {
    let heights: Vec<f64> = radii.iter().map(|&r| body.height(r)).collect();
    let table = Profile::Tabulated(Tabulated::new(radii, &heights).ok()?);
    let exact = body.pressed(E_STAR);
    let share = random.within(0.3, 0.9);
    let (g_star, friction) = (random.within(5e5, 1.2e6), 0.4);
    let preload = match random.bits() % 3 {
        0 => Preload::ContactRadius(share),
        1 => Preload::Indentation(exact.level(share)),
        _ => Preload::NormalForce(exact.force(share)),
    };
    let elasticity = Elasticity::effective(E_STAR, g_star).unwrap();
    let mut found = Contact::new(Setup { profile: table, elasticity, friction, preload }).ok()?;
    let full = friction * E_STAR / g_star * exact.level(share);
    let mut path = Masing::new(full);
    for _ in 0..1 + random.bits() % 4 {
        let target = full * random.within(-0.9, 0.9);
        found.apply(&displace(target)).unwrap();
        path.go(target);
    }
    let estimate = found.accuracy();
    let force =
        (found.force() - friction * exact.tangential_force(share, &path)).abs() / (friction * exact.force(share));
    let (stress, plain) = worst_stress(random, &found, &exact, (share, friction), &path, estimate.force_error);
    let estimates = [estimate.force_error, estimate.stress_error];
    Some(Compared { errors: [force, stress], plain: [force, plain], estimates })
}

/// The largest error of the shear stress over mu p_max at a few radii, without and with that of a kink by its shift.
fn worst_stress(
    random: &mut Random,
    found: &Contact,
    exact: &Pressed,
    (edge, friction): (f64, f64),
    path: &Masing,
    moved: f64,
) -> (f64, f64) {
    let unit = (0..40).map(|index| exact.pressure(edge, edge * f64::from(index) / 40.0)).fold(0.0, f64::max);
    // A kink lies where the level of the table does.
    let moved = moved.min(0.1) * edge;
    let (mut least, mut most) = (0.0_f64, 0.0_f64);
    for _ in 0..6 {
        let radius = edge * random.within(0.0, 1.0);
        let near = [radius, (radius - moved).max(0.0), radius + moved].map(|r| exact.shear(edge, path, r));
        let (low, high) =
            (near.iter().copied().fold(f64::MAX, f64::min), near.iter().copied().fold(f64::MIN, f64::max));
        let value = found.shear(radius) / friction;
        least = least.max((value - value.clamp(low, high)).abs() / unit);
        most = most.max((value - near[0]).abs() / unit);
    }
    (least, most)
}

/// How the radii of a table are spread.
#[derive(Clone, Copy, Debug)]
enum Spread {
    /// Four to six points at geometric distances.
    FewGeometric,
    /// More of them.
    ManyGeometric,
    /// Four to nine points, unevenly.
    FewUneven,
}

impl Spread {
    fn radii(self, random: &mut Random) -> Vec<f64> {
        match self {
            Spread::FewGeometric => geometric(4 + random.bits() % 3, random.within(1.3, 4.0)),
            Spread::ManyGeometric => geometric(7 + random.bits() % 30, random.within(1.05, 2.5)),
            Spread::FewUneven => {
                let count = 3 + random.bits() % 6;
                let uneven = random.within(0.0, 0.4);
                let mut radii: Vec<f64> =
                    (0..=count).map(|index| (index as f64 + random.within(-uneven, uneven)) / count as f64).collect();
                (radii[0], radii[count as usize]) = (0.0, 1.0);
                radii
            }
        }
    }
}

/// A random table of this spread against its body; `None` where the table has no contact of that load.
fn scene(spread: Spread, random: &mut Random) -> Option<Compared> {
    let body = body(random);
    let radii = spread.radii(random);
    compare(random, &body, &radii)
}

/// No estimate is below a third of the truth.
fn hold(spread: Spread, seed: u64) -> Result<(), TestCaseError> {
    let Some(Compared { errors, estimates, .. }) = scene(spread, &mut Random(seed)) else { return Ok(()) };
    for (index, what) in ["force", "stress"].into_iter().enumerate() {
        let (error, estimate) = (errors[index], estimates[index]);
        // The quadrature of the pressures is good to 1e-8.
        prop_assert!(error <= 3.0 * estimate + 1e-8, "{what}: {error:.1e}, estimated {estimate:.1e}");
    }
    Ok(())
}

proptest! {
    #![proptest_config(config(400))]

    #[test]
    fn estimates_of_four_to_six_points_at_geometric_distances_are_honest(seed in any::<u64>()) {
        hold(Spread::FewGeometric, seed)?;
    }

    #[test]
    fn estimates_of_more_points_at_geometric_distances_are_honest(seed in any::<u64>()) {
        hold(Spread::ManyGeometric, seed)?;
    }

    #[test]
    fn estimates_of_a_few_uneven_points_are_honest(seed in any::<u64>()) {
        hold(Spread::FewUneven, seed)?;
    }
}

#[test]
fn estimates_of_coarse_tables_are_usually_within_a_hundred_times_the_error() {
    for spread in [Spread::FewGeometric, Spread::ManyGeometric, Spread::FewUneven] {
        let mut random = Random(3);
        let compared: Vec<Compared> = (0..400).filter_map(|_| scene(spread, &mut random)).collect();
        assert!(compared.len() > 200, "only {} tables were followed", compared.len());
        for (index, what) in ["force", "stress"].into_iter().enumerate() {
            let ratio = |one: &Compared| one.estimates[index] / one.plain[index].max(1e-12);
            let mut ratios: Vec<f64> = compared.iter().map(ratio).collect();
            ratios.sort_by(f64::total_cmp);
            let [least, median] = [ratios[0], ratios[ratios.len() / 2]];
            println!("{spread:?}, {what}: estimate over error {least:.2} at the least, {median:.1} usually");
            assert!(least > 0.33 && median < 100.0, "{spread:?}, {what}: {least}, {median}");
        }
    }
}
