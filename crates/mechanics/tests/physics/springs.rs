//! The paper's spring foundation against the exact solver: two solutions that share nothing but the profile.

use crate::support::{PLAIN, Worst, displace, forall, paths, push};
use stickslip_mechanics::protocol::falling_amplitude;
use stickslip_mechanics::springs::largest_contact_radius;
use stickslip_mechanics::{Contact, Error, Move, Springs};

/// Falling amplitude with twenty reversals, as in the paper.
fn falling() -> Vec<Move> {
    falling_amplitude(20, PLAIN.full_slip()).map(displace).collect()
}

/// Rising and falling load, growth without slip, gross slip, lift-off and contact anew.
fn slanted() -> Vec<Move> {
    let path = [
        (1.0, 0.6),
        (1.3, 0.7),
        (0.8, 0.3),
        (1.1, -0.45),
        (0.6, 1.9),
        (0.9, 1.85),
        (-0.2, 1.0),
        (0.7, 0.5),
        (1.2, 0.9),
        (1.2, 0.1),
        (1.0, 0.35),
    ];
    path.iter().map(|&waypoint| PLAIN.towards(waypoint)).collect()
}

/// The largest errors over a path, each over its unit: forces (tangential and normal), shear stress at the end,
/// friction work.
#[derive(Clone, Copy, Debug)]
struct Errors {
    force: f64,
    stress: f64,
    work: f64,
}

fn errors(moves: &[Move], count: usize) -> Errors {
    let setup = PLAIN.setup();
    let mut exact = Contact::new(setup.clone()).unwrap();
    let mut springs =
        Springs::new(setup.clone(), count, largest_contact_radius(&setup, moves.iter().copied()).unwrap()).unwrap();
    let (limit, unit) = (PLAIN.force_limit(PLAIN.radius), PLAIN.stress_limit(PLAIN.radius));
    let mut errors = Errors { force: 0.0, stress: 0.0, work: 0.0 };
    for step in moves {
        exact.apply(step).unwrap();
        springs.apply(step).unwrap();
        let (state, other) = (exact.state(), springs.state());
        errors.force = errors.force.max((state.force - other.force).abs() / limit);
        errors.force = errors.force.max((state.normal_force - other.normal_force).abs() * PLAIN.friction / limit);
        let work = (state.dissipated_energy - other.dissipated_energy).abs() / (limit * PLAIN.full_slip());
        errors.work = errors.work.max(work);
    }
    let edge = exact.state().contact_radius;
    // Off the kinks, which with these paths lie at rational r^2/a^2 of small denominators.
    for index in 0..100 {
        let r = edge * (f64::from(index) + 0.37) / 100.0;
        errors.stress = errors.stress.max((exact.shear(r) - springs.shear(r)).abs() / unit);
    }
    errors
}

/// The slope of a straight line through the logarithms, over numbers of springs that double. Where kinks fall between
/// the springs is a matter of chance: several numbers near each other share their mean square.
fn orders(moves: &[Move], first: usize, doublings: u32) -> [f64; 3] {
    let points: Vec<(f64, [f64; 3])> = (0..=doublings)
        .map(|power| {
            let count = first << power;
            let near = [0, 17, 34, 51, 68].map(|part| errors(moves, count + count * part / 400));
            let mean = |of: fn(&Errors) -> f64| (near.iter().map(|near| of(near).powi(2)).sum::<f64>() / 5.0).sqrt();
            let logs = [mean(|e| e.force), mean(|e| e.stress), mean(|e| e.work)].map(f64::log2);
            (f64::from(power), logs)
        })
        .collect();
    let count = points.len() as f64;
    let middle = points.iter().map(|(x, _)| x).sum::<f64>() / count;
    let spread: f64 = points.iter().map(|(x, _)| (x - middle).powi(2)).sum();
    [0, 1, 2].map(|index| -points.iter().map(|(x, logs)| (x - middle) * logs[index]).sum::<f64>() / spread)
}

#[test]
fn forces_err_to_order_two_and_stresses_to_order_three_halves_or_more() {
    for (name, moves) in [("falling amplitude", falling()), ("oblique path", slanted())] {
        let [force, stress, work] = orders(&moves, 800, 6);
        println!("{name}: orders {force:.2} (force), {stress:.2} (stress), {work:.2} (work)");
        assert!((1.8..=2.3).contains(&force), "{name}: force errs to order {force}");
        assert!((1.4..=2.2).contains(&stress), "{name}: stress errs to order {stress}");
        assert!((1.8..=2.3).contains(&work), "{name}: friction work errs to order {work}");
    }
}

#[test]
fn a_hundred_thousand_springs_agree_with_the_stack() {
    let count = 100_001;
    for (name, moves, stress) in [("falling amplitude", falling(), 1e-5), ("oblique path", slanted(), 1e-6)] {
        let errors = errors(&moves, count);
        println!("{name}: {errors:?}");
        assert!(errors.force < 1e-8 && errors.work < 1e-8 && errors.stress < stress, "{name}: {errors:?}");
    }
}

#[test]
fn random_oblique_paths_agree_with_springs() {
    // Two thousand springs: h^2 of the span is 1e-6.
    let forces = Worst::new("force of 2000 springs / mu F_N", 1e-5);
    let works = Worst::new("friction work of 2000 springs / (mu F_N u_max)", 1e-5);
    forall(100, paths::oblique_steps(25), |steps| {
        let moves: Vec<Move> = paths::waypoints(&steps).iter().map(|&waypoint| PLAIN.towards(waypoint)).collect();
        let setup = PLAIN.setup();
        let mut exact = Contact::new(setup.clone()).unwrap();
        let mut springs =
            Springs::new(setup.clone(), 2000, largest_contact_radius(&setup, moves.iter().copied()).unwrap()).unwrap();
        for step in &moves {
            exact.apply(step).unwrap();
            springs.apply(step).unwrap();
            let (state, other) = (exact.state(), springs.state());
            let limit = PLAIN.force_limit(PLAIN.radius.max(state.contact_radius));
            forces.close(other.force, state.force, limit);
            forces.close(other.normal_force * PLAIN.friction, state.normal_force * PLAIN.friction, limit);
            works.close(
                other.dissipated_energy,
                state.dissipated_energy,
                limit * PLAIN.full_slip() * moves.len() as f64,
            );
        }
    });
}

#[test]
fn force_control_of_springs_meets_the_force_and_the_exact_displacement() {
    let forces = Worst::new("force under force control of springs / mu F_N", 1e-12);
    let displacements = Worst::new("displacement under force control, springs against exact / u_max", 1e-5);
    let setup = PLAIN.setup();
    let mut exact = Contact::new(setup.clone()).unwrap();
    let mut springs = Springs::new(setup, 20_000, PLAIN.radius).unwrap();
    let limit = PLAIN.force_limit(PLAIN.radius);
    for share in [0.5, -0.2, 0.1, 0.1, -0.7, 0.95, 0.0, -0.999] {
        exact.apply(&push(share * limit)).unwrap();
        springs.apply(&push(share * limit)).unwrap();
        forces.close(springs.force(), share * limit, limit);
        displacements.close(springs.state().displacement, exact.state().displacement, PLAIN.full_slip());
    }
    let before = springs.state();
    let refused = springs.apply(&push(1.001 * limit)).unwrap_err();
    assert!(matches!(refused, Error::ForceExceedsFriction { .. }), "{refused}");
    assert_eq!(springs.state(), before);
}
