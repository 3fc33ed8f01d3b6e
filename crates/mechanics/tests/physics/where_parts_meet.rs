//! Flats, rims and kinks where the parts of a sum meet, and annuli as thin as a unit in the last place of their radius.

use crate::support::{displace, of_family, push, sphere};
use stickslip_mechanics::profile::{LineContact, Sum};
use stickslip_mechanics::{Contact, Elasticity, Error, Preload, Profile, Setup};

fn contact(profile: Profile, preload: Preload, friction: f64) -> Contact {
    let elasticity = Elasticity::effective(1.2e11, 1e11).unwrap();
    Contact::new(Setup { profile, elasticity, friction, preload }).unwrap()
}

/// A punch of this radius, m, and another profile.
fn with_punch(radius: f64, other: Profile) -> Profile {
    Profile::Sum(Sum::new(vec![of_family("flat_punch", &[radius]), other]).unwrap())
}

#[test]
fn a_flat_beyond_the_rim_of_a_punch_is_not_touched() {
    let cone = || of_family("truncated_cone", &[0.05, 5e-4]);
    let mut pressed = contact(with_punch(1e-4, cone()), Preload::NormalForce(24.0), 0.3);
    // The punch alone: F_N = 2 E* b d.
    assert!((pressed.indentation() / 1e-6 - 1.0).abs() < 1e-14, "{}", pressed.indentation());
    pressed.apply(&displace(1e-8)).unwrap();
    pressed.apply(&displace(1e-6)).unwrap();
    assert!((pressed.force() / 7.2 - 1.0).abs() < 1e-14, "{} N", pressed.force());
    let by_depth = contact(with_punch(1e-4, cone()), Preload::Indentation(1e-6), 0.3);
    assert!((by_depth.normal_force() / 24.0 - 1.0).abs() < 1e-14, "{} N", by_depth.normal_force());
}

#[test]
fn the_pressure_is_infinite_at_a_rim_beyond_a_kink() {
    for other in [of_family("rounded_punch", &[5e-5, 0.01]), of_family("rounded_cone", &[0.05, 5e-5])] {
        let mut contact = contact(with_punch(1e-4, other), Preload::Indentation(1e-5), 0.3);
        assert_eq!(contact.contact_radius().to_bits(), 1e-4_f64.to_bits());
        assert_eq!(contact.summary().max_pressure, None);
        assert!(contact.pressure(1e-4).is_infinite());
        contact.apply(&displace(1e-7)).unwrap();
        assert_eq!(contact.residual().max, None);
    }
}

#[test]
fn the_largest_shear_stress_of_an_annulus_thinner_than_a_unit_of_its_radius_is_found() {
    for load in [0.1, 0.3] {
        let profile = of_family("truncated_sphere", &[0.05, 0.01]);
        let mut contact = contact(profile, Preload::NormalForce(load), 0.5);
        contact.apply(&push(0.25 * load)).unwrap();
        let largest = contact.residual().max.unwrap();
        for radius in [0.0, 5e-3, 9.9e-3, 9.99e-3, 9.999e-3, 9.999_99e-3] {
            let shear = contact.shear(radius);
            assert!(shear.abs() <= largest, "{load} N: {shear} Pa at {radius} m exceeds {largest} Pa");
        }
    }
}

#[test]
fn a_line_is_no_part_of_a_sum() {
    let cylinder = LineContact::cylinder(0.05, 0.01, None).unwrap();
    let pad = LineContact::rounded_pad(5e-4, 0.05, 0.01, None).unwrap();
    for line in [cylinder, pad] {
        let refused = Sum::new(vec![sphere(0.01), Profile::Line(line)]);
        assert_eq!(refused.unwrap_err(), Error::NoSurface { part: 1 });
    }
}
