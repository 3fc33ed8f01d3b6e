//! The springs against what is known of bodies with memory, and against many more springs.

use std::sync::Arc;

use super::*;
use crate::indenter::Indenter;
use crate::profile::{Profile, Sphere};
use crate::springs::row::{Led, Row, Scratch};

fn ball() -> Indenter {
    Profile::Sphere(Sphere::new(1.0).unwrap()).indenter()
}

fn series(terms: &[(f64, f64)]) -> Arc<Prony> {
    let terms: Vec<PronyTerm> = terms.iter().map(|&(ratio, time)| PronyTerm { ratio, time }).collect();
    Arc::new(Prony::new(&terms).unwrap())
}

fn place(from: f64, to: f64) -> Course {
    Course::Place { from, to }
}

#[test]
fn pressing_and_holding_a_ball_meet_lee_and_radok() {
    // E*(t) = 1 + 2 e^-t + 0.7 e^-10t; d = 0.01 t up to t = 1, then held.
    let (prony, indenter) = (series(&[(2.0 / 3.7, 1.0), (0.7 / 3.7, 0.1)]), ball());
    let law =
        SpringLaw::Coulomb(CoulombLaw { indenter: &indenter, prony: &prony, stiffness: [7.4, 7.4], friction: 0.5 });
    let mut row = Row::new(&law, 32_768, 0.0, 0.1);
    let mut force = |to: f64, time: f64| {
        let (mut after, targets) = (row.clone(), [Led::Place(to), Led::Place(0.0)]);
        row.step(&law, time, (targets, [0.0; 2]), &mut after, &mut Scratch::default()).unwrap();
        row = after;
        row.sums[0]
    };
    let (pressed, held) = (force(0.01, 1.0), force(0.01, 0.2));
    assert!((pressed / 3.313_590_044_343e-3 - 1.0).abs() < 1e-8, "{pressed}");
    assert!((held / 2.864_029_425_810e-3 - 1.0).abs() < 1e-8, "{held}");
}

/// A random path of a ball, by the springs of a request and by four times as many with a small tolerance.
#[test]
fn the_stated_error_is_never_below_a_third_of_the_true_one() {
    let indenter = ball();
    let mut random = fastrand::Rng::with_seed(73);
    let mut worst = 0.0_f64;
    for case in 0..200 {
        let count = 1 + case % 3;
        let terms: Vec<(f64, f64)> = (0..count)
            .map(|_| (0.9 / f64::from(count) * random.f64().max(0.05), 10.0_f64.powf(2.0 * random.f64() - 1.0)))
            .collect();
        let prony = series(&terms);
        let friction = 0.2 + random.f64();
        let law = CoulombLaw { indenter: &indenter, prony: &prony, stiffness: [2.0, 1.6], friction };
        let depth = 0.01 * (0.2 + random.f64());
        let start = [depth, depth.sqrt()];
        let [mut rough, mut fine] = [128, 512].map(|count| Rows::pressed(&law, count, start));
        for _ in 0..5 {
            let [load, force] = fine.fine.sums;
            let scale = friction * 2.0 / 1.6 * fine.fine.indentation.abs().max(1e-3);
            let normal = match random.u8(0..3) {
                0 => None,
                1 => Some(Course::Force { from: load, to: load.max(1e-4) * (0.3 + 1.4 * random.f64()) }),
                _ => Some(Course::Place { from: 0.0, to: 0.01 * (1.3 * random.f64() - 0.1) }),
            };
            let tangential = match random.u8(0..3) {
                0 => None,
                1 => Some(Course::Force { from: force, to: friction * load * (random.f64() - 0.5) }),
                _ => Some(Course::Place { from: 0.0, to: scale * (2.0 * random.f64() - 1.0) }),
            };
            let duration = if random.bool() { 10.0_f64.powf(2.0 * random.f64() - 1.0) } else { 0.0 };
            let follow = |springs: &mut Rows, tolerance: f64| {
                let from = |here: f64, course: Option<Course>| match course {
                    None => place(here, here),
                    Some(Course::Place { to, .. }) => place(here, to),
                    Some(force) => force,
                };
                let normal = from(springs.fine.indentation, normal);
                let tangential = from(springs.fine.position, tangential);
                let leg = Leg { normal, tangential, duration };
                springs.follow(&law, &leg, tolerance, &|| true)
            };
            if follow(&mut fine, 1e-5).is_err() || follow(&mut rough, 1e-3).is_err() {
                break;
            }
            let (found, expected) = (rough.fine.sums, fine.fine.sums);
            let limit = fine.largest[0];
            let radius = fine.fine.radius(&SpringLaw::Coulomb(law));
            let errors = [
                (found[0] - expected[0]).abs() / limit,
                (found[1] - expected[1]).abs() / (friction * limit),
                2.0 * radius * (rough.fine.indentation - fine.fine.indentation).abs() / limit,
                1.6 * radius * (rough.fine.position - fine.fine.position).abs() / (friction * limit),
            ];
            let stated = rough.force_error(&SpringLaw::Coulomb(law));
            for (index, error) in errors.into_iter().enumerate() {
                worst = worst.max(error / stated);
                assert!(error <= 3.0 * stated, "{case}: {index}: {error:e}, stated {stated:e}");
            }
        }
    }
    assert!(worst > 0.1, "an estimate that is far too large tells nothing: {worst}");
}
