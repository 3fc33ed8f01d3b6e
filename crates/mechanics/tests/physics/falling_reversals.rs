//! The extrema of the shear stress after falling reversals on shapes with a flat end and on powers, against a scan of
//! the stress.

use std::cell::Cell;

use crate::extrema::{check, moved, power, sum, truncated_cone};
use crate::support::forall;
use proptest::prelude::*;
use stickslip_mechanics::Profile;
use stickslip_mechanics::profile::{RoundedPunch, TruncatedSphere};

/// Reversals that shrink: nearly all intervals between kinks are settled by a proof, or have one extremum at most.
#[test]
fn no_extremum_after_falling_reversals_is_missed_or_made_up() {
    let flat = || 0.02..0.4_f64;
    let shapes = prop_oneof![
        flat().prop_map(|flat| (truncated_cone(0.1, flat), vec![flat])),
        flat().prop_map(|flat| (Profile::TruncatedSphere(TruncatedSphere::new(1.0, flat).unwrap()), vec![flat])),
        flat().prop_map(|flat| (Profile::RoundedPunch(RoundedPunch::new(flat, 1.0).unwrap()), vec![flat])),
        (flat(), 2.0..4.0_f64).prop_map(|(flat, exponent)| {
            let punch = Profile::RoundedPunch(RoundedPunch::new(flat, 1.0).unwrap());
            (sum([punch, power(exponent, 0.5)]), vec![flat])
        }),
        (1.2..6.0_f64).prop_map(|exponent| (power(exponent, 0.2), vec![])),
        (2..7_u8).prop_map(|exponent| (power(f64::from(exponent), 0.2), vec![])),
    ];
    let shares = prop::collection::vec(0.3..0.999_f64, 1..12);
    let seen = Cell::new(0);
    forall(150, (shapes, 0.41..0.45_f64, 0.5..1.2_f64, shares), |((profile, mut notes), radius, first, shares)| {
        let sizes = shares.iter().scan(first, |size, share| Some(std::mem::replace(size, *size * share)));
        let path: Vec<f64> = sizes.enumerate().map(|(index, size)| size * [1.0, -1.0][index % 2]).collect();
        let contact = moved(profile, radius, &path);
        notes.push(contact.state().stick_radius);
        seen.set(seen.get() + check(&contact, &notes));
    });
    assert!(seen.get() > 300, "{} seen", seen.get());
}
