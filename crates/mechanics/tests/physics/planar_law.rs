//! The law of a contact that is moved in the plane step by step: against the exact law along a line, against the solver
//! of whole paths, and the laws of friction.

use std::f64::consts::{PI, TAU};

use stickslip_mechanics::rings::{
    Options, PlanarBuffers, PlanarContact, PlanarLaw, PlanarMove, PlanarState, PlanarTarget, follow,
};
use stickslip_mechanics::{
    Contact, Elasticity, Error, Move, Normal, Preload, Profile, Regime, Setup, Tangential, profile::LoadCurve,
};

use crate::support::{Random, UNIT, shapes};

/// A law, one contact of it, and what a step needs.
struct Stepped {
    law: PlanarLaw,
    contact: PlanarContact,
    buffers: PlanarBuffers,
}

impl Stepped {
    fn new(setup: Setup, rings: usize) -> Stepped {
        let law = PlanarLaw::new(setup, rings).unwrap();
        Stepped { contact: law.start(), law, buffers: PlanarBuffers::default() }
    }

    /// The state after a step to an indentation and a displacement.
    fn to(&mut self, depth: f64, displacement: [f64; 2]) -> PlanarState {
        let Stepped { law, contact, buffers } = self;
        law.step(contact, Normal::Indentation(depth), displacement, buffers).unwrap();
        contact.state()
    }
}

fn at_rest() -> Setup {
    UNIT.loaded(Preload::Indentation(0.0))
}

fn distance(one: [f64; 2], other: [f64; 2]) -> f64 {
    (one[0] - other[0]).hypot(one[1] - other[1])
}

#[test]
fn at_a_constant_load_steps_along_a_line_are_those_of_the_exact_law() {
    let mut random = Random(3);
    // On smooth shapes, and on those with a tip, a kink or a rim.
    let mut worst = [[0.0_f64; 2]; 2];
    for (profile, depth) in shapes() {
        let smooth = profile.indenter().smooth_centre()
            && profile.indenter().singular_radii().is_empty()
            && profile.indenter().rim_radius().is_none();
        let kind = usize::from(!smooth);
        let elasticity = Elasticity::effective(1.1e11, 9e10).unwrap();
        let setup = Setup { profile, elasticity, friction: 0.3, preload: Preload::Indentation(depth) };
        let mut exact = Contact::new(setup.clone()).unwrap();
        let (unit, full) = (0.3 * exact.normal_force(), exact.gross_slip_displacement());
        let mut steps = Stepped::new(setup, 40);
        let [x, y] = [0.6, -0.8];
        let mut errors = [0.0_f64; 2];
        for _ in 0..40 {
            let along = random.within(-1.2, 1.2) * full;
            let tangential = Some(Tangential::Displacement(along));
            exact.apply(&Move { tangential, normal: None, ..Move::default() }).unwrap();
            let state = steps.to(depth, [along * x, along * y]);
            errors[0] = errors[0].max(distance(state.force, [exact.force() * x, exact.force() * y]) / unit);
            let work = state.dissipated_energy - exact.state().dissipated_energy;
            errors[1] = errors[1].max(work.abs() / exact.state().dissipated_energy.max(unit * full));
        }
        worst[kind] = [0, 1].map(|of| worst[kind][of].max(errors[of]));
    }
    println!("force and work, on smooth and on other shapes: {worst:?}");
    let [[force, work], [kinked_force, kinked_work]] = worst;
    assert!(force < 2e-3 && work < 2e-3 && kinked_force < 0.3 / 40.0 && kinked_work < 2e-2, "{worst:?}");
}

#[test]
fn impacts_along_a_line_come_near_to_the_exact_law_as_rings_and_steps_are_refined() {
    let mut errors = Vec::new();
    for (rings, count) in [(20, 50), (40, 100), (80, 200)] {
        let mut exact = Contact::new(at_rest()).unwrap();
        let mut steps = Stepped::new(at_rest(), rings);
        let mut worst = [0.0_f64; 2];
        for index in 1..=count {
            let time = f64::from(index) / f64::from(count);
            let depth = if index == count { -0.01 } else { (PI * time).sin() };
            let along = 0.5 * (1.7 * TAU * time).sin();
            let tangential = Some(Tangential::Displacement(along));
            exact.apply(&Move { tangential, normal: Some(Normal::Indentation(depth)), ..Move::default() }).unwrap();
            let state = steps.to(depth, [0.8 * along, 0.6 * along]);
            let error = distance(state.force, [0.8 * exact.force(), 0.6 * exact.force()]);
            worst[0] = worst[0].max(error / UNIT.force_limit(1.0));
            let work = state.dissipated_energy - exact.state().dissipated_energy;
            worst[1] = worst[1].max(work.abs() / exact.state().dissipated_energy.max(0.1));
        }
        assert_eq!(steps.contact.state().regime, Regime::Separated);
        errors.push(worst);
    }
    println!("force and work: {errors:?}");
    assert!(errors[0][0] < 2e-3 && errors[2][0] < 2e-4 && errors[2][1] < 1e-3, "{errors:?}");
    assert!(errors.windows(2).all(|pair| pair[1][0] < 0.5 * pair[0][0]), "{errors:?}");
}

#[test]
fn paths_in_the_plane_are_those_of_the_solver_of_whole_paths() {
    let mut random = Random(5);
    let mut worst = [0.0_f64; 2];
    for case in 0..30 {
        let mut point = || {
            let depth = if case % 2 == 0 { 1.0 } else { random.within(0.5, 1.5) };
            (depth, [random.within(-1.0, 1.0), random.within(-1.0, 1.0)])
        };
        let path = [point(), point(), point(), point()];
        let moves = path.map(|(depth, to)| PlanarMove {
            tangential: Some(PlanarTarget::Displacement(to)),
            normal: Some(Normal::Indentation(depth)),
            relative: false,
        });
        let known = follow(UNIT.setup(), &moves, &Options { count: None, tolerance: 3e-4 }, &|| true).unwrap();
        let mut steps = Stepped::new(UNIT.setup(), 40);
        let mut from = (1.0, [0.0; 2]);
        for ((depth, to), expected) in path.into_iter().zip(known.states) {
            for index in 1..=32 {
                let part = f64::from(index) / 32.0;
                let between = |begin: f64, end: f64| begin + part * (end - begin);
                steps.to(between(from.0, depth), [0, 1].map(|axis| between(from.1[axis], to[axis])));
            }
            let state = steps.contact.state();
            let kind = case % 2;
            worst[kind] = worst[kind].max(distance(state.force, expected.force) / UNIT.force_limit(1.0));
            from = (depth, to);
        }
    }
    println!("error at a constant and at a changing load: {worst:?}");
    assert!(worst[0] < 2e-3 && worst[1] < 1e-2, "{worst:?}");
}

#[test]
fn a_circle_loses_the_known_work() {
    let losses = |rings: usize, per_turn: u32| {
        let mut steps = Stepped::new(UNIT.setup(), rings);
        let mut before = steps.to(1.0, [0.6, 0.0]).dissipated_energy;
        [0, 1].map(|_| {
            let mut state = steps.contact.state();
            for index in 1..=per_turn {
                let angle = TAU * f64::from(index) / f64::from(per_turn);
                state = steps.to(1.0, [0.6 * angle.cos(), 0.6 * angle.sin()]);
            }
            let lost = state.dissipated_energy - before;
            before = state.dissipated_energy;
            lost / UNIT.force_limit(1.0)
        })
    };
    // By an independent prototype in NumPy.
    let known = [0.4337, 0.5556];
    for (rings, per_turn, error) in [(20, 64, 4e-3), (40, 256, 5e-4)] {
        let found = losses(rings, per_turn);
        assert!(found.iter().zip(known).all(|(found, known)| (found - known).abs() < error), "{found:?} by {per_turn}");
    }
}

/// Random steps in all quantities, with lift-offs, from tiny contacts to large ones.
fn wild(random: &mut Random) -> (f64, [f64; 2]) {
    let depth = 10.0_f64.powf(random.within(-8.0, 0.5));
    let depth = if random.within(0.0, 1.0) < 0.1 { -depth } else { depth };
    let size = 10.0_f64.powf(random.within(-8.0, 1.0));
    (depth, [random.within(-size, size), random.within(-size, size)])
}

#[test]
fn steps_that_are_turned_or_mirrored_have_the_same_states_and_friction_bounds_them() {
    let mut random = Random(11);
    for rings in [4, 15, 40] {
        let (sin, cos) = random.within(0.0, TAU).sin_cos();
        let turned = |[x, y]: [f64; 2]| [cos * x - sin * y, sin * x + cos * y];
        let mirrored = |[x, y]: [f64; 2]| [x, -y];
        let maps: [&dyn Fn([f64; 2]) -> [f64; 2]; 2] = [&turned, &mirrored];
        for map in maps {
            let [mut one, mut other] = [0, 1].map(|_| Stepped::new(at_rest(), rings));
            let mut before = 0.0;
            for _ in 0..300 {
                let (depth, to) = wild(&mut random);
                let (state, image) = (one.to(depth, to), other.to(depth, map(to)));
                let unit = state.normal_force.max(f64::MIN_POSITIVE);
                assert!(distance(map(state.force), image.force) < 1e-9 * unit, "{state:?} {image:?}");
                assert!(state.force[0].hypot(state.force[1]) <= unit * (1.0 + 1e-12), "{state:?}");
                assert!(state.dissipated_energy >= before && state.elastic_energy >= 0.0, "{state:?}");
                assert!(state.stick_radius <= state.contact_radius, "{state:?}");
                before = state.dissipated_energy;
            }
        }
    }
}

#[test]
fn a_contact_that_parts_starts_afresh() {
    let [mut used, mut fresh] = [0, 1].map(|_| Stepped::new(at_rest(), 20));
    for index in 1..=10 {
        used.to(0.1 * f64::from(index), [0.05 * f64::from(index), -0.02]);
    }
    let held = used.contact.state();
    assert!(held.elastic_energy > 0.0 && held.force[0] > 0.0);
    for depth in [0.0, -0.1] {
        let parted = used.to(depth, [0.3, 0.4]);
        assert!(parted.force[0].hypot(parted.force[1]) <= 0.0 && parted.elastic_energy <= 0.0, "{parted:?}");
    }
    fresh.to(-0.1, [0.3, 0.4]);
    let lost = used.contact.state().dissipated_energy;
    for index in 1..=10 {
        let (depth, to) = (0.1 * f64::from(index), [0.3 + 0.03 * f64::from(index), 0.4]);
        let (one, other) = (used.to(depth, to), fresh.to(depth, to));
        assert_eq!(one.force.map(f64::to_bits), other.force.map(f64::to_bits));
        assert!((one.dissipated_energy - lost - other.dissipated_energy).abs() < 1e-12);
    }
}

#[test]
fn a_step_by_normal_force_is_one_to_its_indentation() {
    let [mut one, mut other] = [0, 1].map(|_| Stepped::new(UNIT.setup(), 20));
    let Stepped { law, contact, buffers } = &mut one;
    for (force, to) in [(1.0, [0.3, 0.1]), (2.0, [0.4, 0.5]), (0.5, [0.0, 0.5])] {
        law.step(contact, Normal::NormalForce(force), to, buffers).unwrap();
        let state = contact.state();
        assert!((state.normal_force - force).abs() <= 0.0);
        // Straight in the force, so that the middle of the step is another one.
        let by_depth = other.to(state.indentation, to);
        assert!(distance(state.force, by_depth.force) < 1e-2 * force, "{state:?} {by_depth:?}");
    }
}

#[test]
fn a_step_that_is_refused_changes_nothing() {
    let mut steps = Stepped::new(UNIT.setup(), 20);
    let before = steps.to(1.0, [0.3, 0.2]);
    let Stepped { law, contact, buffers } = &mut steps;
    let wrong = [
        (Normal::Indentation(f64::NAN), [0.0; 2]),
        (Normal::Indentation(1e10), [0.0; 2]),
        (Normal::NormalForce(-1.0), [0.0; 2]),
        (Normal::Indentation(1.0), [0.0, f64::INFINITY]),
    ];
    for (normal, to) in wrong {
        let refused = law.step(contact, normal, to, buffers).unwrap_err();
        assert!(matches!(refused, Error::OutOfRange { .. }), "{refused}");
        assert_eq!(contact.state(), before);
    }
    assert!(matches!(PlanarLaw::new(UNIT.setup(), 3).unwrap_err(), Error::OutOfRange { .. }));
    let setup = UNIT.setup();
    let curve = LoadCurve::new(&[0.0, 1e-6, 2e-6], &[0.0, 1.0, 3.0], &setup.elasticity).unwrap();
    let setup = Setup { profile: Profile::LoadCurve(curve), preload: Preload::NormalForce(1.0), ..setup };
    assert_eq!(PlanarLaw::new(setup, 20).unwrap_err(), Error::NoStressField { profile: "load_curve" });
    let mut smooth = Stepped::new(Setup { friction: 0.0, ..UNIT.setup() }, 20);
    let state = smooth.to(1.0, [0.3, 0.2]);
    assert!(state.force[0].hypot(state.force[1]) <= 0.0 && state.regime == Regime::GrossSlip, "{state:?}");
}
