//! The stated error of the friction work of curved moves, against the same path at a much finer tolerance.

use stickslip_mechanics::{Contact, Elasticity, Move, Normal, Preload, Setup, Tangential};

use crate::support::{Random, cases, shapes};

#[test]
fn stated_errors_of_the_friction_work_are_not_too_small() {
    let mut random = Random(11);
    let mut largest = 0.0_f64;
    for case in 0..cases(60) {
        let shapes = shapes();
        let (profile, depth) = shapes[case as usize % shapes.len()].clone();
        let elasticity = Elasticity::effective(1e11, 8e10).unwrap();
        let setup = Setup { profile, elasticity, friction: 0.4, preload: Preload::Indentation(depth) };
        let start = Contact::new(setup).unwrap();
        let load = start.normal_force();
        let slide = start.gross_slip_displacement();
        let moves: Vec<Move> = (0..6)
            .map(|_| {
                let (part, size) = (random.within(-1.5, 1.5), random.within(0.3, 1.5));
                let held = Some(Tangential::Force(0.6 * part * 0.4 * load * size.min(1.0)));
                let (tangential, normal) = match random.bits() % 3 {
                    0 => (Some(Tangential::Displacement(part * slide)), Normal::NormalForce(size * load)),
                    1 => (held, Normal::Indentation(size * depth)),
                    _ => (held, Normal::NormalForce(size * load)),
                };
                Move { tangential, normal: Some(normal), ..Move::default() }
            })
            .collect();
        let follow = |tolerance: f64| {
            let mut contact = start.clone();
            for step in &moves {
                // A force beyond friction is refused by both.
                let _ = contact.apply_within(step, tolerance);
            }
            contact
        };
        let exact = follow(1e-12);
        for tolerance in [1e-3, 1e-5, 1e-7] {
            let found = follow(tolerance);
            let off = (found.state().dissipated_energy - exact.state().dissipated_energy).abs();
            let stated = found.work_error() + exact.work_error() + 1e-13 * exact.state().dissipated_energy;
            largest = largest.max(off / stated);
            assert!(off <= 3.0 * stated, "{case} {tolerance:e}: {off:e}, stated {stated:e}");
            assert!(stated <= 30.0 * tolerance * 0.4 * load * slide, "{case} {tolerance:e}: {stated:e}");
        }
    }
    assert!(largest > 1e-3, "{largest}");
}
