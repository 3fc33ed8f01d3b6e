//! Adhesive contacts: the closed forms of JKR, pull-off and jump-in, energies, the stress at the edge, and sliding on
//! the disc that adheres.

use std::f64::consts::PI;

use stickslip_mechanics::profile::{Cone, FlatPunch, PowerLaw, TruncatedCone};
use stickslip_mechanics::{
    Contact, Elasticity, Error, Friction, Move, Normal, Preload, Profile, Regime, Setup, Sphere, Tangential,
};

const WORK: f64 = 0.01;

fn setup(profile: Profile, adhesion: f64, shear_strength: f64, preload: Preload) -> Setup<Profile, Friction> {
    let elasticity = Elasticity::effective(1.0, 0.8).unwrap();
    Setup { profile, elasticity, friction: Friction { coefficient: 0.0, shear_strength, adhesion }, preload }
}

fn contact(profile: Profile, preload: Preload) -> Contact {
    Contact::new(setup(profile, WORK, 0.0, preload)).unwrap()
}

fn sphere() -> Profile {
    Profile::Sphere(Sphere::new(1.0).unwrap())
}

fn shapes() -> Vec<(&'static str, Profile)> {
    vec![
        ("ball", sphere()),
        ("cone", Profile::Cone(Cone::new(0.3).unwrap())),
        ("quartic", Profile::PowerLaw(PowerLaw::new(4.0, 0.7).unwrap())),
        ("truncated cone", Profile::TruncatedCone(TruncatedCone::new(0.3, 0.1).unwrap())),
        ("punch", Profile::FlatPunch(FlatPunch::new(0.4).unwrap())),
    ]
}

fn to(depth: f64) -> Move {
    Move { normal: Some(Normal::Indentation(depth)), ..Move::default() }
}

fn loaded(force: f64) -> Move {
    Move { normal: Some(Normal::NormalForce(force)), ..Move::default() }
}

fn pushed(displacement: f64) -> Move {
    Move { tangential: Some(Tangential::Displacement(displacement)), ..Move::default() }
}

fn near(found: f64, expected: f64, tolerance: f64, what: &str) {
    assert!((found - expected).abs() <= tolerance * expected.abs(), "{what}: {found:e}, expected {expected:e}");
}

#[test]
fn check_values_of_the_ball_are_met() {
    let contact = contact(sphere(), Preload::ContactRadius(0.3));
    near(contact.indentation(), -0.047_293_684_929_6, 1e-10, "indentation");
    near(contact.normal_force(), -0.046_376_210_957_7, 1e-10, "force");
    near(contact.summary().pull_off_force.unwrap(), -1.5 * PI * WORK, 1e-13, "pull-off force");
    // a^2/R - sqrt(2 pi a w/E*) at its least, and the force there.
    let a = 0.157_768_378_465_f64;
    let least = a * a - (2.0 * PI * a * WORK).sqrt();
    let mut pulled = contact.clone();
    pulled.apply(&to(least * (1.0 - 1e-12))).unwrap();
    near(pulled.contact_radius(), a, 1e-5, "radius at pull-off");
    near(pulled.normal_force(), -0.026_179_938_779_9, 1e-4, "force at pull-off");
    pulled.apply(&to(least * (1.0 + 1e-10))).unwrap();
    assert_eq!(pulled.state().regime, Regime::PulledOff);
    let mut pulled = self::contact(sphere(), Preload::ContactRadius(0.5));
    pulled.apply(&loaded(-1.5 * PI * WORK * (1.0 - 1e-12))).unwrap();
    near(pulled.contact_radius(), 0.328_171_451_834, 1e-5, "radius at pull-off");
    pulled.apply(&loaded(-1.5 * PI * WORK * (1.0 + 1e-10))).unwrap();
    let state = pulled.state();
    assert_eq!((state.regime, state.normal_force, state.contact_radius), (Regime::PulledOff, 0.0, 0.0));
    near(state.indentation, least, 1e-12, "where it parts");
    // From there the two numbers of the branch, exactly, by the radius that a preload names.
    let at = |radius: f64| self::contact(sphere(), Preload::ContactRadius(radius));
    near(at(a * (1.0 + 1e-11)).normal_force(), -0.026_179_938_779_9, 1e-10, "force at the last radius");
    near(at(0.328_171_451_834).normal_force(), -1.5 * PI * WORK, 1e-11, "force at the radius of pull-off");
}

#[test]
fn the_load_is_the_integral_of_the_pressure_with_its_edge() {
    for (name, profile) in shapes() {
        let contact = contact(profile, Preload::Indentation(0.02));
        // With r = a sin(t) the edge is bounded; the midpoint rule.
        let (a, count) = (contact.contact_radius(), 5_000);
        let sum: f64 = (0..count)
            .map(|index| {
                let t = 0.5 * PI * (f64::from(index) + 0.5) / f64::from(count);
                2.0 * PI * a * a * t.sin() * t.cos() * contact.pressure(a * t.sin())
            })
            .sum();
        near(sum * 0.5 * PI / f64::from(count), contact.normal_force(), 5e-4, name);
        assert_eq!(contact.pressures(&[0.3 * a]), [contact.pressure(0.3 * a)]);
        let near_edge = contact.pressure(a * (1.0 - 1e-10));
        assert!((near_edge < 0.0) == (name != "punch"), "{name}");
        let most = contact.summary().max_pressure;
        assert!(most.is_none_or(|most| (0..64).all(|place| contact.pressure(a * f64::from(place) / 64.0) <= most)));
    }
}

#[test]
fn a_turn_loses_the_area_of_its_loop() {
    for (name, profile) in shapes() {
        for by_load in [false, true] {
            let mut contact = contact(profile.clone(), Preload::Indentation(0.3));
            let (high, low) = (0.3, -0.3);
            let top = contact.normal_force();
            let begin = contact.state();
            let (mut work, count) = (0.0, 4_000);
            let mut before = begin;
            let mut follow = |contact: &mut Contact, step: &Move| {
                contact.apply(step).unwrap();
                let state = contact.state();
                work += 0.5 * (state.normal_force + before.normal_force) * (before.indentation - state.indentation);
                before = state;
            };
            if by_load {
                let least = contact.summary().pull_off_force.unwrap();
                for step in 1..=count {
                    let share = f64::from(step) / f64::from(count);
                    follow(&mut contact, &loaded(top + (least * (1.0 - 1e-12) - top) * share));
                }
                // The load pulls the contact on to where it parts at the latest.
                let here = contact.state();
                contact.apply(&loaded(least * 1.01)).unwrap();
                work += here.normal_force * (here.indentation - contact.indentation());
                // Back to the load that the start had, over the jump into the contact without a load.
                let parted = contact.state();
                contact.apply(&loaded(0.0)).unwrap();
                assert!(contact.state().adhesion_loss > parted.adhesion_loss, "{name}");
                before = contact.state();
                let mut follow = |contact: &mut Contact, step: &Move| {
                    contact.apply(step).unwrap();
                    let state = contact.state();
                    work += 0.5 * (state.normal_force + before.normal_force) * (before.indentation - state.indentation);
                    before = state;
                };
                for step in 1..=count {
                    follow(&mut contact, &loaded(top * f64::from(step) / f64::from(count)));
                }
            } else {
                for step in (1..=count).map(|step| f64::from(step) / f64::from(count)) {
                    follow(&mut contact, &to(high + (low - high) * step));
                }
                assert_eq!(contact.state().regime, Regime::PulledOff, "{name}");
                for step in (1..=count).map(|step| f64::from(step) / f64::from(count)) {
                    follow(&mut contact, &to(low + (high - low) * step));
                }
            }
            let state = contact.state();
            near(state.normal_force, begin.normal_force, 1e-11, name);
            near(state.surface_energy.unwrap(), begin.surface_energy.unwrap(), 1e-11, name);
            near(state.adhesion_loss.unwrap(), -work, 5e-3, &format!("{name}, by load: {by_load}"));
        }
    }
}

#[test]
fn a_contact_jumps_in_at_zero_gap_and_is_apart_before() {
    for (name, profile) in shapes() {
        let mut contact = contact(profile.clone(), Preload::Indentation(0.05));
        contact.apply(&to(-1.0)).unwrap();
        assert_eq!(contact.state().regime, Regime::PulledOff, "{name}");
        contact.apply(&to(-1e-6)).unwrap();
        assert_eq!((contact.state().regime, contact.normal_force()), (Regime::PulledOff, 0.0), "{name}");
        contact.apply(&to(0.0)).unwrap();
        let held = self::contact(profile.clone(), Preload::Indentation(0.0));
        near(contact.normal_force(), held.normal_force(), 1e-12, name);
        assert!(name == "punch" || contact.normal_force() < 0.0, "{name}");
        // A load that could not be carried leaves bodies apart that are so.
        contact.apply(&to(-1.0)).unwrap();
        let loss = contact.state().adhesion_loss;
        contact.apply(&loaded(-10.0)).unwrap();
        assert_eq!((contact.state().regime, contact.state().adhesion_loss), (Regime::PulledOff, loss), "{name}");
        contact.apply(&loaded(0.9 * held.summary().pull_off_force.unwrap())).unwrap();
        assert!(contact.contact_radius() > 0.0, "{name}");
        near(contact.normal_force(), 0.9 * held.summary().pull_off_force.unwrap(), 1e-15, name);
    }
}

#[test]
fn loads_and_indentations_lead_to_the_same_branch() {
    for (name, profile) in shapes() {
        let mut one = contact(profile.clone(), Preload::Indentation(0.03));
        for depth in [0.2, 0.05, -0.01, 0.02, 0.4] {
            one.apply(&to(depth)).unwrap();
            near(one.indentation(), depth, 1e-12, name);
            // By its definition: g(a) - sqrt(2 pi a w/E*), at a vertical edge above that.
            let a = one.contact_radius();
            let level = one.indenter().level(a) - (2.0 * PI * a * WORK).sqrt();
            assert!(name == "punch" || (one.indentation() - level).abs() < 1e-12, "{name}");
            // Below that a load makes some of these shapes jump.
            if depth > 0.15 {
                let mut other = contact(profile.clone(), Preload::Indentation(1.0));
                other.apply(&loaded(one.normal_force())).unwrap();
                near(other.contact_radius(), a, 1e-12, name);
                near(other.indentation(), depth, 1e-11, name);
            }
        }
    }
    // Kendall: F = -sqrt(8 pi E* w a^3).
    let punch = contact(Profile::FlatPunch(FlatPunch::new(0.4).unwrap()), Preload::Indentation(0.0));
    let kendall = -(8.0 * PI * WORK * 0.4_f64.powi(3)).sqrt();
    near(punch.summary().pull_off_force.unwrap(), kendall, 1e-14, "punch");
}

#[test]
fn sliding_on_the_disc_that_adheres_is_that_of_the_strength_alone() {
    let (strength, g_star) = (0.3, 0.8);
    for (name, profile) in shapes() {
        let mut contact = Contact::new(setup(profile, WORK, strength, Preload::Indentation(0.3))).unwrap();
        contact.apply(&loaded(0.5 * contact.summary().pull_off_force.unwrap())).unwrap();
        assert!(contact.normal_force() < 0.0);
        let a = contact.contact_radius();
        near(contact.summary().gross_slip_force, PI * a * a * strength, 1e-12, name);
        let c = 0.6 * a;
        contact.apply(&pushed(2.0 * strength / g_star * 0.8 * a)).unwrap();
        let state = contact.state();
        near(state.stick_radius, c, 1e-12, name);
        near(state.force, 2.0 * strength * a * a * (0.6_f64.acos() + 0.48), 1e-11, name);
        assert!(state.surface_energy.is_some_and(|energy| energy < 0.0) && state.indentation < 0.3);
        for step in [loaded(0.1), to(0.1), to(-5.0)] {
            assert_eq!(contact.apply(&step), Err(Error::LoadMustBeConstant), "{name}");
        }
        // The same load and the same indentation are no change.
        contact.apply(&to(contact.indentation())).unwrap();
        contact.apply(&loaded(contact.normal_force())).unwrap();
        assert_eq!((contact.force(), contact.indentation()), (state.force, state.indentation));
    }
}

#[test]
fn what_has_no_adhesion_is_refused() {
    let make = |work: f64, preload| Contact::new(setup(sphere(), work, 0.0, preload)).map(drop);
    for work in [-1.0, f64::NAN, f64::INFINITY, 2e3, 1e-13] {
        assert!(matches!(make(work, Preload::Indentation(0.1)), Err(Error::OutOfRange { .. })), "{work}");
    }
    let torn = [Preload::NormalForce(-0.0472), Preload::Indentation(-0.08), Preload::ContactRadius(0.15)];
    for preload in torn {
        let Err(Error::OutOfRange { allowed, .. }) = make(WORK, preload) else { panic!("{preload:?}") };
        assert!(allowed.contains("pulls off"), "{allowed}");
    }
    let Error::OutOfRange { .. } = make(0.0, Preload::NormalForce(-1.0)).unwrap_err() else { panic!() };
    let friction = Friction { coefficient: 0.3, shear_strength: 0.0, adhesion: WORK };
    let with = Setup { friction, ..setup(sphere(), WORK, 0.0, Preload::Indentation(0.1)) };
    assert_eq!(Contact::new(with).map(drop), Err(Error::FrictionWithAdhesion));
    // A gap that rises more slowly than the root of the radius has no stable contact.
    let blunt = Profile::PowerLaw(PowerLaw::new(0.3, 0.7).unwrap());
    assert!(matches!(Contact::new(setup(blunt, WORK, 0.0, Preload::Indentation(0.1))), Err(Error::OutOfRange { .. })));
    let plain = contact(sphere(), Preload::Indentation(0.1));
    assert_eq!(plain.check_coulomb("wear"), Err(Error::Adhesive("wear")));
    assert!(plain.clone().apply(&loaded(f64::NAN)).is_err() && plain.clone().apply(&to(f64::NAN)).is_err());
}

#[test]
fn a_packed_contact_comes_back_to_the_last_bit() {
    let virgin = Contact::new(setup(sphere(), WORK, 0.3, Preload::Indentation(0.02))).unwrap();
    let mut contact = virgin.clone();
    for step in [to(-1.0), to(0.01), loaded(-0.03), pushed(0.01), pushed(-0.005)] {
        contact.apply(&step).unwrap();
        let bytes = contact.pack();
        assert_eq!(bytes.len(), contact.packed_length());
        let back = virgin.unpack(&bytes).unwrap();
        assert_eq!(back.state(), contact.state());
        assert!(virgin.unpack(&bytes[..bytes.len() - 8]).is_none());
        let other = Contact::new(setup(sphere(), 2.0 * WORK, 0.3, Preload::Indentation(0.02))).unwrap();
        assert!(other.unpack(&bytes).is_none());
    }
}
