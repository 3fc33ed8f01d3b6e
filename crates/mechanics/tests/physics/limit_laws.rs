//! What holds under every limit law at a constant load, on random shapes and paths: friction, a shear strength, both,
//! the disc that adheres, and twist.

use proptest::prelude::{Strategy, prop, proptest};
use stickslip_mechanics::profile::{Cone, FlatPunch, PowerLaw, TruncatedCone};
use stickslip_mechanics::{Contact, Elasticity, Friction, Move, Preload, Profile, Setup, Sphere, Tangential};

use crate::support::config;

/// A contact under a law, and whether it is twisted.
#[derive(Clone, Debug)]
struct Scene {
    contact: Contact,
    twists: bool,
}

impl Scene {
    fn to(&self, target: f64) -> Move {
        let tangential = if self.twists { Tangential::Twist(target) } else { Tangential::Displacement(target) };
        Move { tangential: Some(tangential), ..Move::default() }
    }

    /// Its force or torque, and the energies dissipated and stored.
    fn after(&self, contact: &Contact) -> [f64; 3] {
        let state = contact.state();
        let force = if self.twists { state.torque.unwrap_or(0.0) } else { state.force };
        [force, state.dissipated_energy, state.elastic_energy]
    }

    /// Displacement and force of gross slip.
    fn limits(&self) -> [f64; 2] {
        let contact = if self.twists { self.contact.twisting().unwrap() } else { self.contact.clone() };
        let summary = contact.summary();
        [summary.gross_slip_displacement, summary.gross_slip_force]
    }
}

fn scenes() -> impl Strategy<Value = Scene> {
    let shape = (0..5_usize, 0.3..3.0_f64);
    let law = (0..5_usize, 0.05..1.0_f64, 0.05..1.0_f64, 0.1..0.9_f64);
    (shape, law).prop_map(|((shape, size), (law, coefficient, strength, depth))| {
        let profile = match shape {
            0 => Profile::Sphere(Sphere::new(size).unwrap()),
            1 => Profile::Cone(Cone::new(size).unwrap()),
            2 => Profile::PowerLaw(PowerLaw::new(1.0 + size, 1.0).unwrap()),
            3 => Profile::FlatPunch(FlatPunch::new(size).unwrap()),
            _ => Profile::TruncatedCone(TruncatedCone::new(0.3, size).unwrap()),
        };
        let friction = match law {
            0 | 4 => Friction::from(coefficient),
            1 => Friction { shear_strength: strength, ..Friction::from(0.0) },
            2 => Friction { shear_strength: strength, ..Friction::from(coefficient) },
            _ => Friction { shear_strength: strength, adhesion: 0.01, ..Friction::from(0.0) },
        };
        let elasticity = Elasticity::effective(1.0, 0.8).unwrap().with_shear_modulus(0.5).unwrap();
        let setup = Setup { profile, elasticity, friction, preload: Preload::Indentation(depth) };
        let mut scene = Scene { contact: Contact::new(setup).unwrap(), twists: law == 4 };
        if scene.twists {
            // Its limit is made once.
            scene.contact.apply(&scene.to(0.0)).unwrap();
        }
        scene
    })
}

proptest! {
    #![proptest_config(config(60))]

    #[test]
    fn loops_close_energy_is_kept_and_work_never_falls(
        scene in scenes(),
        turns in prop::collection::vec(-1.2..1.2_f64, 1..12),
        inner in 0.0..0.4_f64,
    ) {
        let [slip, limit] = scene.limits();
        // The limit of twist grows without bound towards the centre.
        let slip = if scene.twists { 0.3 * slip } else { slip };
        let first = |size: f64| {
            let mut contact = scene.contact.clone();
            contact.apply(&scene.to(size)).unwrap();
            scene.after(&contact)[0]
        };
        let mut contact = scene.contact.clone();
        let (mut place, mut before) = (0.0, [0.0; 3]);
        for turn in turns {
            let target = turn * slip;
            // By parts, for the work that is put in, and for Masing's rule while no loop is closed.
            let (parts, mut work) = (64, 0.0);
            let mut last = before[0];
            for part in 1..=parts {
                let here = place + (target - place) * f64::from(part) / f64::from(parts);
                contact.apply(&scene.to(here)).unwrap();
                let after = scene.after(&contact);
                work += 0.5 * (after[0] + last) * (target - place) / f64::from(parts);
                last = after[0];
                assert!(after[0].abs() <= limit * (1.0 + 1e-13));
                // A stroke follows no branch that is steeper than that from rest.
                let most = 2.0 * first(0.5 * (here - place).abs());
                assert!((after[0] - before[0]).abs() <= most + 1e-12 * limit, "{after:?} after {before:?}, {most}");
            }
            let after = scene.after(&contact);
            assert!(after[1] >= before[1]);
            let kept = after[1] + after[2] - before[1] - before[2];
            let unit = limit * (target - place).abs();
            assert!((kept - work).abs() <= 2e-2 * unit + 1e-13 * limit * slip, "{kept:e} and {work:e} of {unit:e}");
            // In one move it is the same, and an inner loop leaves no trace.
            let mut inside = contact.clone();
            inside.apply(&scene.to(target + inner * (place - target))).unwrap();
            inside.apply(&scene.to(target)).unwrap();
            assert!((scene.after(&inside)[0] - after[0]).abs() <= 1e-12 * limit);
            assert!((scene.after(&inside)[2] - after[2]).abs() <= 1e-12 * limit * slip);
            (place, before) = (target, after);
        }
    }
}
