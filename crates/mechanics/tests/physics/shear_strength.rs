//! Contacts whose interface has a shear strength: closed forms, the law itself in r, Masing's rule, and what is
//! refused.

use std::f64::consts::PI;

use stickslip_mechanics::profile::{Cone, FlatPunch, PowerLaw, Sum, TruncatedCone};
use stickslip_mechanics::{
    Contact, Elasticity, Error, Friction, Move, Normal, Preload, Profile, Regime, Setup, Sphere, Tangential,
};

fn contact(profile: Profile, coefficient: f64, shear_strength: f64, preload: Preload) -> Contact {
    let elasticity = Elasticity::effective(1.0, 0.8).unwrap();
    let friction = Friction { coefficient, shear_strength, adhesion: 0.0 };
    Contact::new(Setup { profile, elasticity, friction, preload }).unwrap()
}

fn ball(coefficient: f64, shear_strength: f64) -> Contact {
    contact(Profile::Sphere(Sphere::new(1.0).unwrap()), coefficient, shear_strength, Preload::ContactRadius(1.0))
}

fn to(displacement: f64) -> Move {
    Move { tangential: Some(Tangential::Displacement(displacement)), ..Move::default() }
}

fn pulled(force: f64) -> Move {
    Move { tangential: Some(Tangential::Force(force)), ..Move::default() }
}

fn pressed(load: f64) -> Move {
    Move { normal: Some(Normal::NormalForce(load)), ..Move::default() }
}

fn shapes() -> Vec<(&'static str, Profile)> {
    vec![
        ("ball", Profile::Sphere(Sphere::new(1.0).unwrap())),
        ("cone", Profile::Cone(Cone::new(0.3).unwrap())),
        ("quartic", Profile::PowerLaw(PowerLaw::new(4.0, 0.7).unwrap())),
        ("three halves", Profile::PowerLaw(PowerLaw::new(1.5, 0.7).unwrap())),
        ("punch", Profile::FlatPunch(FlatPunch::new(1.0).unwrap())),
        ("truncated cone", Profile::TruncatedCone(TruncatedCone::new(0.3, 0.4).unwrap())),
    ]
}

fn near(found: f64, expected: f64, tolerance: f64, what: &str) {
    assert!((found - expected).abs() <= tolerance * expected.abs(), "{what}: {found:e}, expected {expected:e}");
}

#[test]
fn strength_alone_meets_its_closed_form() {
    // U = (2 tau_0/G*) sqrt(a^2 - c^2), F = 2 tau_0 (a^2 acos(c/a) + c sqrt(a^2 - c^2)), whatever the shape.
    for (name, profile) in shapes() {
        let (strength, g_star) = (0.3, 0.8);
        let virgin = contact(profile, 0.0, strength, Preload::Indentation(0.9));
        let a = virgin.contact_radius();
        let summary = virgin.summary();
        near(summary.gross_slip_force, PI * a * a * strength, 1e-13, name);
        near(summary.gross_slip_displacement, 2.0 * strength * a / g_star, 1e-13, name);
        for share in [0.0, 0.05, 0.3, 0.6, 0.9, 0.999, 1.0 - 1e-9] {
            let c = share * a;
            let root = ((a - c) * (a + c)).sqrt();
            let mut contact = virgin.clone();
            contact.apply(&to(2.0 * strength / g_star * root)).unwrap();
            let state = contact.state();
            near(state.force, 2.0 * strength * (a * a * root.atan2(c) + c * root), 1e-12, name);
            near(state.stick_radius, c, 1e-12, name);
            let mut by_force = virgin.clone();
            if share > 0.0 {
                by_force.apply(&pulled(state.force)).unwrap();
                near(by_force.displacement(), contact.displacement(), 1e-11, name);
            }
        }
    }
}

#[test]
fn check_values_are_met() {
    let strength = Contact::new(Setup {
        profile: Profile::Sphere(Sphere::new(1.0).unwrap()),
        elasticity: Elasticity::effective(1.0, 1.0).unwrap(),
        friction: Friction { shear_strength: 1.0, ..Friction::from(0.0) },
        preload: Preload::ContactRadius(1.0),
    })
    .unwrap();
    let mut contact = strength;
    contact.apply(&to(1.6)).unwrap();
    near(contact.force() / PI, 0.895_911_961_338, 1e-11, "force over pi");
    near(contact.state().stick_radius, 0.6, 1e-12, "stick radius");
    let first = contact.state().dissipated_energy;
    contact.apply(&to(-1.6)).unwrap();
    contact.apply(&to(1.6)).unwrap();
    near(contact.state().dissipated_energy - first, 1.288_045_457_087, 1e-11, "work of a cycle");

    let mut contact = ball(0.3, 0.2);
    contact.apply(&to(0.714_262_701_892_2)).unwrap();
    near(contact.state().stick_radius, 0.5, 1e-10, "stick radius");
    near(contact.force(), 0.942_084_101_235_5, 1e-10, "force");
    near(contact.summary().gross_slip_force, PI * 0.2 + 0.3 * contact.normal_force(), 1e-13, "gross slip");
}

#[test]
fn the_shear_stress_of_gross_slip_is_the_law_itself() {
    for (name, profile) in shapes() {
        let mut contact = contact(profile, 0.3, 0.2, Preload::Indentation(0.9));
        contact.apply(&to(-10.0)).unwrap();
        assert_eq!(contact.state().regime, Regime::GrossSlip);
        for step in 1..200 {
            let r = contact.contact_radius() * f64::from(step) / 200.0;
            let limit = 0.2 + 0.3 * contact.pressure(r);
            if limit.is_finite() {
                near(contact.shear(r), -limit, 2e-12, name);
            }
        }
        near(
            contact.shear(contact.contact_radius() * (1.0 - 1e-9)),
            -0.2 - 0.3 * contact.pressure(contact.contact_radius() * (1.0 - 1e-9)),
            1e-6,
            name,
        );
    }
}

#[test]
fn the_law_holds_in_r_on_any_path_and_work_never_falls() {
    for (name, profile) in shapes() {
        for (coefficient, strength) in [(0.3, 0.2), (0.0, 0.2), (0.4, 1e-3)] {
            let mut contact = contact(profile.clone(), coefficient, strength, Preload::Indentation(0.9));
            let (most, limit) = (contact.gross_slip_displacement(), contact.summary().gross_slip_force);
            let (mut seed, mut before) = (7_u64, contact.state());
            for _ in 0..40 {
                seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                let share = (seed >> 11) as f64 / (1_u64 << 53) as f64;
                contact.apply(&to(most * 1.1 * (2.0 * share - 1.0))).unwrap();
                let state = contact.state();
                let spent = state.dissipated_energy - before.dissipated_energy;
                assert!(spent >= 0.0, "{name}");
                assert!(state.force.abs() <= limit * (1.0 + 1e-14), "{name}");
                // The work that is put in is stored or dissipated: the force over a move lies between its limits.
                let step = (state.displacement - before.displacement).abs();
                assert!(spent <= 2.0 * limit * step * (1.0 + 1e-12), "{name}");
                for place in [0.01, 0.31, 0.62, 0.93, 0.999] {
                    let r = place * state.contact_radius;
                    let bound = strength + coefficient * contact.pressure(r);
                    assert!(contact.shear(r).abs() <= bound * (1.0 + 1e-10), "{name} at {r}");
                }
                before = state;
            }
        }
    }
}

#[test]
fn a_cycle_is_masings_and_closes() {
    for (name, profile) in shapes() {
        let virgin = contact(profile, 0.3, 0.2, Preload::Indentation(0.9));
        let most = 0.8 * virgin.gross_slip_displacement();
        let first = |displacement: f64| {
            let mut contact = virgin.clone();
            contact.apply(&to(displacement)).unwrap();
            contact.force()
        };
        let mut contact = virgin.clone();
        contact.apply(&to(most)).unwrap();
        let (top, energy) = (contact.force(), contact.state().elastic_energy);
        for share in [0.5, 0.0, -0.5, -1.0] {
            contact.apply(&to(share * most)).unwrap();
            near(contact.force(), top - 2.0 * first(0.5 * (1.0 - share) * most), 1e-11, name);
        }
        contact.apply(&to(most)).unwrap();
        near(contact.force(), top, 1e-14, name);
        near(contact.state().elastic_energy, energy, 1e-13, name);
    }
}

#[test]
fn the_energy_balance_holds() {
    for (name, profile) in shapes() {
        let mut contact = contact(profile, 0.3, 0.2, Preload::Indentation(0.9));
        let most = 0.7 * contact.gross_slip_displacement();
        // The work put in, by Simpson's rule along a first loading.
        let steps = 2000;
        let mut work = 0.0;
        for step in 0..=steps {
            contact.apply(&to(most * f64::from(step) / f64::from(steps))).unwrap();
            let weight = if step == 0 || step == steps { 1.0 } else { f64::from(2 + 2 * (step % 2)) };
            work += weight * contact.force();
        }
        work *= most / f64::from(steps) / 3.0;
        let state = contact.state();
        near(state.elastic_energy + state.dissipated_energy, work, 1e-9, name);
    }
}

#[test]
fn the_load_changes_before_the_first_shear_alone() {
    let mut contact = ball(0.3, 0.2);
    let load = contact.normal_force();
    contact.apply(&pressed(0.5 * load)).unwrap();
    let mut direct =
        self::contact(Profile::Sphere(Sphere::new(1.0).unwrap()), 0.3, 0.2, Preload::NormalForce(0.5 * load));
    for contact in [&mut contact, &mut direct] {
        contact.apply(&to(0.1)).unwrap();
    }
    assert_eq!(contact.state(), direct.state());
    let before = contact.state();
    assert_eq!(contact.apply(&pressed(load)), Err(Error::LoadMustBeConstant));
    let oblique = Move { normal: Some(Normal::Indentation(0.9)), ..to(0.2) };
    assert_eq!(ball(0.3, 0.2).apply(&oblique), Err(Error::LoadMustBeConstant));
    assert_eq!(contact.state(), before);
    // A load that is named again stays as it is.
    contact.apply(&Move { normal: Some(Normal::NormalForce(0.5 * load)), ..to(0.15) }).unwrap();
    // Apart, the indenter goes anywhere.
    let mut contact = ball(0.3, 0.2);
    contact.apply(&Move { normal: Some(Normal::Indentation(-0.1)), ..Move::default() }).unwrap();
    assert_eq!(contact.state().regime, Regime::Separated);
    contact.apply(&to(5.0)).unwrap();
    assert!(matches!(contact.apply(&pulled(1.0)), Err(Error::ForceExceedsFriction { .. })));
    contact.apply(&pressed(0.5 * load)).unwrap();
    contact.apply(&to(5.1)).unwrap();
    near(contact.force(), before.force, 1e-12, "after touching again");
}

#[test]
fn a_packed_contact_comes_back_to_the_last_bit() {
    let virgin = ball(0.3, 0.2);
    let mut contact = virgin.clone();
    for target in [0.4, -0.2, 0.1] {
        contact.apply(&to(target)).unwrap();
    }
    let bytes = contact.pack();
    assert_eq!(bytes.len(), contact.packed_length());
    let mut back = virgin.unpack(&bytes).unwrap();
    assert_eq!(back.state(), contact.state());
    for contact in [&mut contact, &mut back] {
        contact.apply(&to(-0.6)).unwrap();
    }
    assert_eq!(back.state(), contact.state());
    assert!(ball(0.3, 0.25).unpack(&bytes).is_none() && ball(0.3, 0.0).unpack(&bytes).is_none());
    assert!(virgin.unpack(&bytes[..bytes.len() - 8]).is_none());
}

#[test]
fn bad_strengths_are_refused() {
    let make = |shear_strength: f64| {
        let elasticity = Elasticity::effective(1.0, 0.8).unwrap();
        let friction = Friction { shear_strength, ..Friction::from(0.3) };
        let profile = Profile::Sphere(Sphere::new(1.0).unwrap());
        Contact::new(Setup { profile, elasticity, friction, preload: Preload::ContactRadius(1.0) })
    };
    for strength in [-1.0, f64::NAN, f64::INFINITY, 2e18, 1e-11] {
        assert!(matches!(make(strength), Err(Error::OutOfRange { .. })), "{strength}");
    }
    // A strength that hardly counts gives what Coulomb's law gives.
    let (mut weak, mut none) = (make(1e-9).unwrap(), make(0.0).unwrap());
    for contact in [&mut weak, &mut none] {
        contact.apply(&to(0.2)).unwrap();
    }
    near(weak.force(), none.force(), 1e-8, "force");
    let sum = Sum::new(vec![Profile::FlatPunch(FlatPunch::new(1.0).unwrap()), Profile::Cone(Cone::new(0.3).unwrap())]);
    let mut contact = contact(Profile::Sum(sum.unwrap()), 0.3, 0.2, Preload::Indentation(2.0));
    contact.apply(&to(10.0)).unwrap();
    near(contact.force(), 0.3 * contact.normal_force() + PI * 0.2, 1e-13, "over the edge of a punch");
}
