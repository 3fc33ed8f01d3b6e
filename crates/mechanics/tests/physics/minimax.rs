//! The minimax protocol: its largest stress against known values, and against the other protocols on every finite
//! profile.

use crate::support::{follow, pressed, sphere};
use stickslip_mechanics::profile::{ExactSphere, PowerLaw, RoundedCone};
use stickslip_mechanics::protocol::{equal_peaks, falling_amplitude, minimax};
use stickslip_mechanics::{Profile, Residual};

fn left(profile: &Profile, path: &[f64]) -> Residual {
    let mut contact = pressed(profile.clone());
    follow(&mut contact, path);
    contact.residual()
}

#[test]
fn on_a_sphere_all_extrema_are_equal_and_as_small_as_they_can_be() {
    let profile = sphere(10.0);
    let unit = 0.3 * pressed(profile.clone()).summary().max_pressure.unwrap();
    for (reversals, known) in [(1, 0.600_000), (2, 0.471_894), (3, 0.400_606), (20, 0.167_500), (100, 0.075_794)] {
        let found = minimax(&pressed(profile.clone()), reversals, &|| true).unwrap();
        assert_eq!(found.displacements.len(), reversals + 1);
        assert!(found.gap < 1e-9, "{reversals}: {:e}", found.gap);
        let residual = left(&profile, &found.displacements);
        let max = residual.max.unwrap();
        assert!((max / unit - known).abs() < 1e-6, "{reversals}: {}", max / unit);
        let mut extrema = vec![residual.centre.unwrap()];
        extrema.extend(residual.peaks.iter().map(|peak| peak.shear));
        assert_eq!(extrema.len(), reversals + 1);
        for pair in extrema.windows(2) {
            assert!(pair[0] * pair[1] < 0.0, "{reversals}: the extrema alternate");
        }
        for extremum in extrema {
            assert!((extremum.abs() / max - 1.0).abs() < 1e-8, "{reversals}: {extremum} of {max}");
        }
    }
}

#[test]
fn it_is_never_above_the_other_protocols() {
    let power = |exponent| Profile::PowerLaw(PowerLaw::new(exponent, 0.1).unwrap());
    let profiles = [
        power(1.5),
        power(3.0),
        power(4.0),
        sphere(10.0),
        Profile::ExactSphere(ExactSphere::new(2.0).unwrap()),
        Profile::RoundedCone(RoundedCone::new(0.05, 0.15).unwrap()),
    ];
    for profile in profiles {
        for reversals in [1, 2, 5, 20] {
            let contact = pressed(profile.clone());
            let linear: Vec<f64> = falling_amplitude(reversals, contact.gross_slip_displacement()).collect();
            let equal = equal_peaks(&contact, reversals, None).unwrap();
            let best = minimax(&contact, reversals, &|| true).unwrap();
            let max = |path: &[f64]| left(&profile, path).max.unwrap();
            let (linear, equal, best) = (max(&linear), max(&equal.displacements), max(&best.displacements));
            assert!(best <= linear.min(equal) * (1.0 + 1e-9), "{profile:?} {reversals}: {best} {linear} {equal}");
        }
    }
}

#[test]
fn it_ends_when_it_is_stopped() {
    let contact = pressed(sphere(10.0));
    assert_eq!(minimax(&contact, 20, &|| false), None);
}
