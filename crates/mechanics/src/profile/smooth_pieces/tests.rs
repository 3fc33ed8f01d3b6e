//! The sums over pieces against the integral of each ring by itself.

use super::super::{
    Cone, DoubleDouble, ExactSphere, PowerLaw, Profile, Ring, RoundedCone, RoundedPunch, Sphere, StressRadius, Sum,
    TruncatedCone, TruncatedSphere,
};
use super::SmoothPieces;

/// The radius of the contact, m.
const EDGE: f64 = 0.4;

fn power(exponent: f64) -> Profile {
    Profile::PowerLaw(PowerLaw::new(exponent, 0.2).unwrap())
}

fn families() -> Vec<Profile> {
    let sphere = || Profile::Sphere(Sphere::new(1.0).unwrap());
    let ball = || Profile::ExactSphere(ExactSphere::new(1.2).unwrap());
    let cone = |flat| Profile::TruncatedCone(TruncatedCone::new(0.1, flat).unwrap());
    let worn = || Profile::TruncatedSphere(TruncatedSphere::new(1.0, 0.1).unwrap());
    let punch = || Profile::RoundedPunch(RoundedPunch::new(0.2, 1.0).unwrap());
    let rounded = || Profile::RoundedCone(RoundedCone::new(0.1, 0.15).unwrap());
    let tip = || Profile::Cone(Cone::new(0.1).unwrap());
    let sum = |parts: Vec<Profile>| Profile::Sum(Sum::new(parts).unwrap());
    let two = || sum(vec![cone(0.1), cone(0.103), tip()]);
    let mixed = || sum(vec![worn(), power(2.7), rounded(), ball()]);
    vec![
        sphere(),
        ball(),
        tip(),
        power(1.3),
        power(2.7),
        power(4.0),
        cone(0.15),
        worn(),
        punch(),
        rounded(),
        two(),
        mixed(),
    ]
}

/// Rings of all widths with weights of both signs, out to the edge.
fn rings(profile: &Profile) -> Vec<(Ring, f64)> {
    let depth = profile.level(EDGE);
    let shares = [0.0, 0.02, 0.3, 0.3 + 1e-9, 0.5, 0.7, 0.72, 0.9, 1.0 - 1e-7, 1.0];
    let points = shares.map(|share| profile.point(DoubleDouble::from(share * depth)));
    let weight = |index: usize| if index.is_multiple_of(2) { 1.0 } else { -0.7 };
    points.windows(2).enumerate().map(|(index, pair)| (Ring::between(pair[0], pair[1]), weight(index))).collect()
}

#[test]
fn derivatives_of_a_sum_are_those_of_its_rings() {
    let radii: Vec<StressRadius> = (0..997).map(|index| StressRadius::new(EDGE * f64::from(index) / 997.0)).collect();
    for profile in families() {
        let rings = rings(&profile);
        let pieces = SmoothPieces::new(&profile, &rings, 0.0).unwrap();
        let alone: Vec<(f64, f64)> =
            radii.iter().flat_map(|at| pieces.slopes(std::slice::from_ref(at), |_| true)).collect();
        for ((at, (found, _)), (single, _)) in radii.iter().zip(pieces.slopes(&radii, |_| true)).zip(alone) {
            let terms = rings.iter().filter(|(ring, _)| ring.outer.radius >= at.radius);
            let terms: Vec<f64> = terms.map(|(ring, weight)| weight * profile.kernel_slope(at, ring)).collect();
            let (sum, size) = terms.iter().fold((0.0, 0.0), |(sum, size), term| (sum + term, size + term.abs()));
            if size.is_finite() {
                // A ring alone loses this much just beyond a radius, where two of its terms nearly cancel.
                let allowed = 2e-11 * size;
                assert!((found - sum).abs() <= allowed, "{profile:?} at {at:?}: {found:e} is not {sum:e}");
                assert!((single - sum).abs() <= allowed, "{profile:?} at {at:?} alone: {single:e} is not {sum:e}");
            }
        }
    }
}

#[test]
fn all_rings_inside_the_innermost_piece_count() {
    for profile in [power(1.3), power(2.7)] {
        // The pieces end at 1e-3 of the edge.
        let radii = [0.0, 1e-4, 5e-4, 0.5, 1.0].map(|share| EDGE * share);
        let points = radii.map(|radius| profile.point(DoubleDouble::from(profile.level(radius))));
        let rings = points.windows(2).zip([1.0, -0.7, 0.9, -1.0]);
        let rings: Vec<(Ring, f64)> = rings.map(|(pair, weight)| (Ring::between(pair[0], pair[1]), weight)).collect();
        let pieces = SmoothPieces::new(&profile, &rings, 0.0).unwrap();
        for share in [0.0, 3e-5, 2e-4, 7e-4] {
            let at = StressRadius::new(EDGE * share);
            let terms = rings.iter().filter(|(ring, _)| ring.outer.radius >= at.radius);
            let terms: Vec<f64> = terms.map(|(ring, weight)| weight * profile.kernel(&at, ring)).collect();
            let (sum, size) = terms.iter().fold((0.0, 0.0), |(sum, size), term| (sum + term, size + term.abs()));
            let found = pieces.sums(&[at])[0];
            assert!((found - sum).abs() <= 1e-13 * size, "{profile:?} at {share}: {found:e} is not {sum:e}");
            assert_eq!(found.to_bits(), pieces.sum(&at).to_bits(), "{profile:?} at {share}");
        }
    }
}
