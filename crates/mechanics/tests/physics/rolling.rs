//! Rolling against Carter's values, and the shear stress against the laws that it must keep.

use std::f64::consts::FRAC_PI_2;

use stickslip_mechanics::profile::{LineContact, Profile};
use stickslip_mechanics::rolling::{Drive, Rolling};
use stickslip_mechanics::{Contact, Elasticity, Error, Preload, Setup};

use crate::support::{PLAIN, quadrature::integral};

const FRICTION: f64 = 0.3;
const RADIUS: f64 = 0.05;

fn cylinder() -> Contact {
    Contact::new(Setup {
        profile: Profile::Line(LineContact::cylinder(RADIUS, 0.01, None).unwrap()),
        elasticity: Elasticity::effective(1.2e11, 1.2e11).unwrap(),
        friction: FRICTION,
        preload: Preload::NormalForce(1000.0),
    })
    .unwrap()
}

#[test]
fn creep_is_that_of_carter_both_ways() {
    let contact = cylinder();
    let unit = FRICTION * contact.contact_radius() / RADIUS;
    for (ratio, creep) in [(0.2, 0.105_572_809_000), (0.5, 0.292_893_218_813), (0.9, 0.683_772_233_983)] {
        let rolling = Rolling::of(&contact, Drive::Ratio(ratio)).unwrap();
        assert!((rolling.creep() / unit - creep).abs() < 1e-12, "{ratio}");
        let back = Rolling::of(&contact, Drive::Creep(-rolling.creep())).unwrap();
        assert!((back.ratio() + ratio).abs() < 1e-14);
        assert!((back.shear(0.0) / rolling.shear(0.0) + 1.0).abs() < 1e-13);
    }
}

#[test]
fn the_shear_stress_carries_the_force_within_friction_and_sticks_with_one_creep() {
    let contact = cylinder();
    let a = contact.contact_radius();
    let rolling = Rolling::of(&contact, Drive::Ratio(0.6)).unwrap();
    let [from, to] = rolling.stick();
    assert!((to - a).abs() <= 0.0);
    for index in 0..=1000 {
        let x = a * (f64::from(index) / 500.0 - 1.0);
        let limit = FRICTION * contact.pressures(&[x.abs()])[0];
        assert!(rolling.shear(x) >= 0.0 && rolling.shear(x) <= limit * (1.0 + 1e-12) + 1e-3, "{x:e}");
        assert!(x >= from || (rolling.shear(x) - limit).abs() <= 1e-9 * limit + 1e-3, "{x:e} slips");
    }
    // Over the angle whose sine is x/a, in which the outer ellipse has no root at its ends; 0.01 m is the length.
    let over_angle = |angle: f64| rolling.shear(a * angle.sin()) * a * angle.cos();
    let edge = (from / a).asin();
    let force = 0.01 * (integral(&over_angle, -FRAC_PI_2, edge, 1e-9) + integral(&over_angle, edge, FRAC_PI_2, 1e-9));
    assert!((force / (0.6 * FRICTION * 1000.0) - 1.0).abs() < 1e-6, "{force}");
    assert!([1.01 * a, -2.0 * a].iter().all(|x| rolling.shear(*x).abs() <= 0.0));
}

#[test]
fn other_profiles_and_gross_slip_are_refused() {
    assert_eq!(Rolling::of(&PLAIN.contact(), Drive::Ratio(0.1)), Err(Error::OnlyCylinder));
    let contact = cylinder();
    for drive in [Drive::Ratio(1.0), Drive::Ratio(f64::NAN), Drive::Creep(1.0), Drive::Creep(f64::NEG_INFINITY)] {
        assert!(matches!(Rolling::of(&contact, drive), Err(Error::OutOfRange { .. })), "{drive:?}");
    }
}
