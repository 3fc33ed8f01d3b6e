//! Motion in the plane: rings against the exact law along a line, known values on ellipses, the laws of friction, and
//! their own statement of errors.

use std::f64::consts::TAU;

use stickslip_mechanics::profile::{Cone, LoadCurve};
use stickslip_mechanics::rings::{EllipseArc, Options, PlanarMove, PlanarState, PlanarTarget, Solution, follow};
use stickslip_mechanics::{Contact, Elasticity, Error, Move, Normal, Preload, Profile, Setup, Tangential};

use crate::support::{Random, UNIT, cases, shapes};

const DEFAULT: Options = Options { count: None, tolerance: 1e-3 };
const ROUGH: Options = Options { count: None, tolerance: 1e-2 };

fn to(tangential: PlanarTarget) -> PlanarMove {
    PlanarMove { tangential: Some(tangential), ..PlanarMove::default() }
}

fn solve(setup: Setup, moves: &[PlanarMove], options: &Options) -> Solution {
    follow(setup, moves, options, &|| true).unwrap()
}

/// A move to the beginning of an ellipse, and turns round it.
fn ellipse(radii: [f64; 2], per_turn: usize, turns: usize) -> Vec<PlanarMove> {
    let arc = |index: usize| {
        let turns = [index, index + 1].map(|index| index as f64 / per_turn as f64);
        to(PlanarTarget::Arc(EllipseArc { radii, phase: 0.0, turns }))
    };
    let begin = to(PlanarTarget::Displacement([radii[0], 0.0]));
    std::iter::once(begin).chain((0..per_turn * turns).map(arc)).collect()
}

/// Friction work of a turn over mu F_N u_max.
fn loss(solution: &Solution, per_turn: usize, turn: usize) -> f64 {
    let at = |turn: usize| solution.states[per_turn * turn].dissipated_energy;
    (at(turn + 1) - at(turn)) / (UNIT.force_limit(1.0) * UNIT.full_slip())
}

#[test]
fn turns_of_ellipses_lose_the_known_work() {
    // By an independent prototype in NumPy, to some 1e-4; the last digits by 160 rings.
    let known =
        [([0.6, 0.6], [0.4337, 0.5556], [0.43360, 0.55578]), ([0.6, 0.3], [f64::NAN, 0.2131], [0.18896, 0.21296])];
    for (radii, prototype, fine) in known {
        for (tolerance, per_turn) in [(1e-2, 16), (1e-3, 16), (1e-3, 64), (1e-4, 16)] {
            let solution = solve(UNIT.setup(), &ellipse(radii, per_turn, 2), &Options { count: None, tolerance });
            let stated = solution.force_error();
            assert!(stated <= tolerance, "{stated} for {tolerance}");
            for turn in 0..2 {
                let found = loss(&solution, per_turn, turn);
                assert!(
                    (found - fine[turn]).abs() <= solution.work_error + 3e-5,
                    "{radii:?}: {found} in turn {turn}, {} stated",
                    solution.work_error
                );
                let far = (found - prototype[turn]).abs() > 1e-3 && tolerance <= 1e-3;
                assert!(!far, "{radii:?}: {found} in turn {turn} to {tolerance}");
            }
            println!(
                "{radii:?} to {tolerance:e} by {per_turn}: {} rings, {} steps, {stated:.1e}, work {:.1e}",
                solution.count, solution.steps, solution.work_error
            );
        }
    }
}

/// Moves along a line at random, in fractions of gross slip, with changes of the indentation.
fn line(random: &mut Random, depth: f64, full: f64, moves: usize) -> Vec<(f64, Option<f64>)> {
    let step = |_| {
        let pressed = random.within(0.0, 1.0) < 0.6;
        let to = random.within(-1.5, 1.5) * full;
        (to, pressed.then(|| depth * random.within(0.5, 1.2)))
    };
    (0..moves).map(step).collect()
}

#[test]
fn along_a_line_rings_have_the_forces_of_the_exact_law() {
    let mut random = Random(1);
    let shapes = shapes();
    let (mut worst, elasticity) = (vec![0.0_f64; shapes.len()], Elasticity::effective(1.1e11, 9e10).unwrap());
    for case in 0..cases(1000) as usize {
        let (profile, depth) = shapes[case % shapes.len()].clone();
        let setup = Setup { profile, elasticity, friction: 0.3, preload: Preload::Indentation(depth) };
        let mut exact = Contact::new(setup.clone()).unwrap();
        let [x, y] = {
            let angle = random.within(0.0, TAU);
            [angle.cos(), angle.sin()]
        };
        let path = line(&mut random, depth, exact.gross_slip_displacement(), 4);
        let turned = |&(along, normal): &(f64, Option<f64>)| PlanarMove {
            normal: normal.map(Normal::Indentation),
            ..to(PlanarTarget::Displacement([along * x, along * y]))
        };
        let moves: Vec<PlanarMove> = path.iter().map(turned).collect();
        // As many rings as asked for, and then, by default, none.
        let rings = solve(setup.clone(), &moves, &Options { count: Some(16), tolerance: 1e-2 });
        let served = (case % 10 == 0).then(|| solve(setup.clone(), &moves, &ROUGH));
        let mut largest = exact.normal_force();
        let mut errors = Vec::new();
        for (index, (along, normal)) in path.into_iter().enumerate() {
            let tangential = Some(Tangential::Displacement(along));
            exact.apply(&Move { tangential, normal: normal.map(Normal::Indentation), ..Move::default() }).unwrap();
            largest = largest.max(exact.normal_force());
            let expected = [exact.force() * x, exact.force() * y];
            let found = rings.states[index].force;
            errors.push((found[0] - expected[0]).hypot(found[1] - expected[1]));
            if let Some(served) = &served {
                let unit = 0.3 * largest;
                assert!(distance(served.states[index].force, expected) < 1e-13 * unit, "{served:?}");
                let work = served.states[index].dissipated_energy - exact.state().dissipated_energy;
                assert!(work.abs() < 1e-12 * unit * exact.gross_slip_displacement(), "{served:?}");
            }
        }
        let error = errors.into_iter().fold(0.0, f64::max) / (0.3 * largest);
        let ratio = error / rings.force_error();
        worst[case % shapes.len()] = ratio.max(worst[case % shapes.len()]);
    }
    println!("error along a line over the stated one, shape by shape: {worst:.2?}");
    assert!(worst.iter().all(|worst| *worst < 1.0), "{worst:?}");
}

/// Four moves: by displacement, with changing indentation, by force, and by force under a changing load.
fn random_path(random: &mut Random, kind: usize) -> Vec<PlanarMove> {
    let step = |_| {
        let size = if kind >= 2 { 0.6 } else { 1.2 };
        let pair = [random.within(-size, size), random.within(-size, size)];
        let normal = match kind {
            1 => Some(Normal::Indentation(random.within(0.5, 1.5))),
            3 => Some(Normal::NormalForce(random.within(1.0, 2.0))),
            _ => None,
        };
        let target = if kind >= 2 { PlanarTarget::Force(pair) } else { PlanarTarget::Displacement(pair) };
        PlanarMove { normal, ..to(target) }
    };
    (0..4).map(step).collect()
}

fn distance(one: [f64; 2], other: [f64; 2]) -> f64 {
    (one[0] - other[0]).hypot(one[1] - other[1])
}

#[test]
fn true_errors_are_at_most_three_times_the_stated_ones() {
    let mut random = Random(54);
    let mut worst = [0.0_f64; 4];
    for case in 0..cases(300) as usize {
        let path = random_path(&mut random, case % 4);
        let coarse = solve(UNIT.setup(), &path, &ROUGH);
        let fine = solve(UNIT.setup(), &path, &Options { count: Some(4 * coarse.count), tolerance: 1e-3 });
        let unit = coarse.states.iter().map(|state| state.normal_force).fold(UNIT.force_limit(1.0), f64::max);
        let stated = coarse.force_error();
        let depth = coarse.states.iter().map(|state| state.indentation).fold(1.0, f64::max);
        for (one, other) in coarse.states.iter().zip(&fine.states) {
            worst[0] = worst[0].max(distance(one.force, other.force) / unit / stated);
            worst[1] = worst[1].max(distance(one.displacement, other.displacement) / depth / stated);
            worst[2] = worst[2]
                .max((one.dissipated_energy - other.dissipated_energy).abs() / unit / depth / coarse.work_error);
        }
        let edge = coarse.pressed().contact_radius();
        let radii: Vec<f64> = (0..50).map(|index| f64::from(index) / 50.0 * edge).collect();
        let unit = coarse.pressed().summary().unit_shear();
        for (one, other) in coarse.shears(&radii).into_iter().zip(fine.shears(&radii)) {
            worst[3] = worst[3].max(distance(one, other) / unit / coarse.stress_error());
        }
    }
    println!(
        "true over stated: force {:.2}, displacement {:.2}, work {:.2}, stress {:.2}",
        worst[0], worst[1], worst[2], worst[3]
    );
    assert!(worst.iter().all(|worst| *worst < 3.0), "{worst:?}");
}

#[test]
fn a_path_that_is_turned_or_mirrored_has_the_same_states() {
    let mut random = Random(7);
    for case in 0..40 {
        let path = random_path(&mut random, case % 4);
        let (sin, cos) = random.within(0.0, TAU).sin_cos();
        let turned = |[x, y]: [f64; 2]| [cos * x - sin * y, sin * x + cos * y];
        let mirrored = |[x, y]: [f64; 2]| [x, -y];
        let maps: [&dyn Fn([f64; 2]) -> [f64; 2]; 2] = [&turned, &mirrored];
        for map in maps {
            let mapped = |step: &PlanarMove| PlanarMove {
                tangential: step.tangential.map(|target| match target {
                    PlanarTarget::Displacement(to) => PlanarTarget::Displacement(map(to)),
                    PlanarTarget::Force(to) => PlanarTarget::Force(map(to)),
                    PlanarTarget::Arc(arc) => PlanarTarget::Arc(arc),
                }),
                ..*step
            };
            let one = solve(UNIT.setup(), &path, &ROUGH);
            let other = solve(UNIT.setup(), &path.iter().map(mapped).collect::<Vec<_>>(), &ROUGH);
            for (one, other) in one.states.iter().zip(&other.states) {
                assert!(distance(map(one.force), other.force) < 1e-12, "{case}: {:?} {:?}", one.force, other.force);
                assert!(distance(map(one.displacement), other.displacement) < 1e-12, "{case}");
                assert!((one.dissipated_energy - other.dissipated_energy).abs() < 1e-12, "{case}");
            }
        }
    }
}

#[test]
fn friction_bounds_every_stress_and_its_work_is_the_work_less_the_energy() {
    let mut random = Random(8);
    for case in 0..100 {
        let path = random_path(&mut random, case % 4);
        let solution = solve(UNIT.setup(), &path, &ROUGH);
        let mut before = 0.0;
        for state in &solution.states {
            assert!(state.dissipated_energy >= before, "{case}");
            before = state.dissipated_energy;
            let left = state.work - state.elastic_energy - state.dissipated_energy;
            assert!(left.abs() < 1e-9, "{case}: {left:e} of {state:?}");
            assert!(state.force[0].hypot(state.force[1]) <= state.normal_force * (1.0 + 1e-12), "{case}: {state:?}");
        }
        let edge = solution.pressed().contact_radius();
        let radii: Vec<f64> = (0..=40).map(|index| f64::from(index) / 40.0 * edge).collect();
        for (shear, pressure) in solution.shears(&radii).into_iter().zip(solution.pressed().pressures(&radii)) {
            assert!(shear[0].hypot(shear[1]) <= pressure * (1.0 + 1e-14), "{case}");
        }
    }
}

#[test]
fn after_a_long_way_friction_acts_along_the_last_move() {
    let mut random = Random(3);
    for far in [1e3, 1e6, 1e9] {
        let step = |_| PlanarMove {
            tangential: Some(PlanarTarget::Displacement([random.within(-far, far), random.within(-far, far)])),
            normal: Some(Normal::Indentation(random.within(0.5, 2.0))),
            relative: false,
        };
        let path: Vec<PlanarMove> = (0..12).map(step).collect();
        let solution = solve(UNIT.setup(), &path, &ROUGH);
        let mut before = [0.0; 2];
        for state in &solution.states {
            let [x, y] = [0, 1].map(|axis| state.displacement[axis] - before[axis]);
            let limit = UNIT.setup().friction * state.normal_force / x.hypot(y);
            let expected = [limit * x, limit * y];
            let off = distance(state.force, expected) / (limit * x.hypot(y));
            assert!(off < solution.force_error() + 30.0 / far, "{far:e}: {off:e}");
            before = state.displacement;
        }
    }
}

#[test]
fn what_has_no_answer_is_refused_at_its_move() {
    let force = |x: f64, y: f64| to(PlanarTarget::Force([x, y]));
    let limit = UNIT.force_limit(1.0);
    let refused = |moves: &[PlanarMove]| follow(UNIT.setup(), moves, &DEFAULT, &|| true).unwrap_err();
    // The pair is what counts, not its components.
    let refusal = refused(&[force(0.5 * limit, 0.5 * limit), force(0.8 * limit, -0.8 * limit)]);
    assert_eq!(refusal.index, Some(1));
    assert!(matches!(refusal.error, Error::ForceExceedsFriction { .. }), "{}", refusal.error);
    let far = PlanarMove { normal: Some(Normal::Indentation(1e12)), ..force(0.0, 0.1) };
    assert!(matches!(refused(&[force(0.1, 0.0), far]).error, Error::OutOfRange { .. }));
    let setup = UNIT.loaded(Preload::NormalForce(1.0));
    let curve = LoadCurve::new(&[0.0, 1e-6, 2e-6], &[0.0, 1.0, 3.0], &setup.elasticity).unwrap();
    let setup = Setup { profile: Profile::LoadCurve(curve), ..setup };
    let refusal = follow(setup, &[force(0.1, 0.1)], &DEFAULT, &|| true).unwrap_err();
    assert_eq!((refusal.index, refusal.error), (None, Error::NoStressField { profile: "load_curve" }));
    let stopped = follow(UNIT.setup(), &ellipse([0.6, 0.6], 16, 1), &DEFAULT, &|| false).unwrap_err();
    assert_eq!(stopped.error, Error::Interrupted);
}

#[test]
fn without_friction_or_contact_nothing_is_carried() {
    let path = ellipse([0.6, 0.6], 16, 1);
    let smooth = solve(Setup { friction: 0.0, ..UNIT.setup() }, &path, &DEFAULT);
    let carries = |state: &PlanarState| state.force[0].hypot(state.force[1]) > 0.0 || state.dissipated_energy > 0.0;
    assert!(!smooth.states.iter().any(carries));
    let lifted: Vec<PlanarMove> =
        path.into_iter().map(|step| PlanarMove { normal: Some(Normal::Indentation(-0.1)), ..step }).collect();
    let apart = solve(UNIT.setup(), &lifted, &DEFAULT);
    // The move that lifts off slips until then.
    let held = |state: &PlanarState| state.force[0].hypot(state.force[1]) > 0.0 || state.contact_radius > 0.0;
    assert!(!apart.states.iter().any(held));
}

#[test]
fn steps_are_not_refined_far_beyond_what_the_most_rings_leave() {
    // Under the tip of a cone even the most rings err by more than this tolerance.
    let setup = Setup { profile: Profile::Cone(Cone::new(0.02).unwrap()), ..UNIT.setup() };
    let full = Contact::new(setup.clone()).unwrap().gross_slip_displacement();
    let path = ellipse([0.6 * full, 0.3 * full], 16, 1);
    let solution = solve(setup, &path, &Options { count: None, tolerance: 1e-5 });
    let error = solution.force_error();
    assert!(solution.count == 160 && error > 2.0 / 160.0_f64.powi(2) && error < 4e-4, "{error:e}");
    assert!(solution.steps <= 1_500, "{} steps", solution.steps);
}

#[test]
fn two_hundred_straight_moves_are_those_of_the_exact_contact_without_a_ring() {
    let mut random = Random(7);
    let mut exact = UNIT.contact();
    let mut moves = Vec::new();
    for _ in 0..200 {
        let along = random.within(-0.9, 0.9);
        moves.push(to(PlanarTarget::Displacement([0.6 * along, 0.8 * along])));
        let step = Move { tangential: Some(Tangential::Displacement(0.36 * along + 0.64 * along)), ..Move::default() };
        exact.apply(&step).unwrap();
    }
    let solution = solve(UNIT.setup(), &moves, &Options { count: None, tolerance: 1e-5 });
    assert_eq!((solution.count, solution.steps, solution.states.len()), (0, 0, 200));
    assert!(solution.force_error() < 1e-15 && solution.work_error < 1e-15 && solution.stress_error() < 1e-15);
    let unit = UNIT.force_limit(1.0);
    let last = solution.states[199];
    assert!(distance(last.force, [0.6 * exact.force(), 0.8 * exact.force()]) < 1e-13 * unit, "{last:?}");
    let radii = [0.0, 0.3, 0.7, 0.9, 1.1];
    let stress = exact.shears(&radii);
    for (shear, expected) in solution.shears(&radii).into_iter().zip(stress) {
        assert!(distance(shear, [0.6 * expected, 0.8 * expected]) < 1e-12, "{shear:?} {expected}");
    }
    for (radius, expected) in radii.into_iter().zip(exact.slips(&radii)) {
        let found = solution.slip(radius).map(|[x, y]| 0.6 * x + 0.8 * y);
        let off = found.unwrap_or(-1.0) - expected.unwrap_or(-1.0);
        assert!(off.abs() < 1e-12 && solution.friction_work(radius).is_nan(), "{radius}: {found:?} {expected:?}");
    }
}

#[test]
fn numbers_of_options_and_arcs_out_of_range_are_refused_at_their_move() {
    for tolerance in [f64::NAN, 0.0, -1e-3, f64::INFINITY] {
        let refused = follow(UNIT.setup(), &ellipse([0.5, 0.5], 8, 1), &Options { count: None, tolerance }, &|| true);
        assert!(refused.is_err_and(|refusal| refusal.index.is_none()), "{tolerance}");
    }
    let arc = EllipseArc { radii: [0.5, 0.5], phase: 0.0, turns: [0.0, 0.1] };
    let bad = [
        PlanarTarget::Arc(EllipseArc { radii: [f64::NAN, 0.5], ..arc }),
        PlanarTarget::Arc(EllipseArc { radii: [0.5, f64::INFINITY], ..arc }),
        PlanarTarget::Arc(EllipseArc { phase: f64::NAN, ..arc }),
        PlanarTarget::Arc(EllipseArc { turns: [0.0, 1e300], ..arc }),
        PlanarTarget::Displacement([f64::NAN, 0.0]),
        PlanarTarget::Force([0.0, f64::NEG_INFINITY]),
    ];
    for target in bad {
        for options in [DEFAULT, Options { count: Some(8), ..DEFAULT }] {
            let moves = [to(PlanarTarget::Displacement([0.1, 0.0])), to(target)];
            let refused = follow(UNIT.setup(), &moves, &options, &|| true).map(|_| ());
            let named = refused
                .is_err_and(|refusal| refusal.index == Some(1) && matches!(refusal.error, Error::OutOfRange { .. }));
            assert!(named, "{target:?}");
        }
    }
}
