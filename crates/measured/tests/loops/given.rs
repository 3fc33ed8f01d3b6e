//! Records that were fitted wrongly: turns between samples, noise of the displacement, drift. Each is a loop of a steel
//! ball on a rigid plane, made without this library; columns are displacement (um), force (N) and time (s).

use stickslip_measured::loops::{LoopFit, Noise, Note, Parameter, Record, Start, Task, fit};
use stickslip_mechanics::profile::Profile;
use stickslip_mechanics::{Contact, Elasticity, Preload, Setup, Sphere};

use crate::bench::rigid;

const FRICTION: f64 = 0.3;
const G_STAR: f64 = 4.0 * (2.1e11 / 2.6) / 1.7;

fn record(table: &str) -> Record {
    let rows: Vec<Vec<f64>> =
        table.lines().map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect()).collect();
    let column = |place: usize, unit: f64| rows.iter().map(|row| row[place] * unit).collect();
    let time = (rows[0].len() > 2).then(|| column(2, 1.0));
    let start = Some(Start::Steady);
    Record { displacement: column(0, 1e-6), force: column(1, 1.0), time, normal_force: None, start, weight: 1.0 }
}

/// Friction and another parameter, for a ball of 10 mm under 10 N whose friction is thought to be 0.25.
fn fitted(record: Record, sought: Parameter, noise: Noise) -> LoopFit {
    let contact = Contact::new(Setup {
        profile: Profile::Sphere(Sphere::new(0.01).unwrap()),
        elasticity: Elasticity::effective(2.1e11 / 0.91, G_STAR).unwrap(),
        friction: 0.25,
        preload: Preload::NormalForce(10.0),
    })
    .unwrap();
    let free = vec![Parameter::Friction, sought];
    fit(&Task { contact, records: vec![record], free, known: vec![rigid()], noise }, &|| true).unwrap()
}

/// Both truths are in their intervals of at most this half-width, relative, and nothing is warned of.
#[track_caller]
fn holds(found: &LoopFit, truths: [f64; 2], widest: [f64; 2]) {
    for ((estimate, truth), widest) in found.estimates.iter().zip(truths).zip(widest) {
        let [low, high] = estimate.interval.map(Option::unwrap);
        assert!(low <= truth && truth <= high, "{truth}: {estimate:?}");
        assert!(high - low <= 2.0 * widest * truth.abs(), "{truth}: {estimate:?}");
    }
    assert_eq!(found.notes, [] as [Note; 0], "{:?}", found.residual);
}

#[test]
fn a_triangle_that_turns_between_its_samples() {
    for (table, widest) in [
        (include_str!("../data/loops/triangle.csv"), [4e-3, 1e-2]),
        (include_str!("../data/loops/triangle_without_noise.csv"), [1e-5, 1e-5]),
    ] {
        holds(&fitted(record(table), Parameter::GStar, Noise::default()), [FRICTION, G_STAR], widest);
    }
}

#[test]
fn a_noise_of_the_displacement_that_is_not_told_and_one_that_is() {
    let table = include_str!("../data/loops/sine_noisy_displacement.csv");
    let found = fitted(record(table), Parameter::GStar, Noise::default());
    holds(&found, [FRICTION, G_STAR], [1e-3, 5e-3]);
    let told = Noise { force: Some(0.006), displacement: Some(1.7219916758754415e-9) };
    let found = fitted(record(include_str!("../data/loops/noises_told.csv")), Parameter::GStar, told);
    holds(&found, [FRICTION, G_STAR], [1e-3, 5e-3]);
}

#[test]
fn a_drift_is_taken_off_before_turns_are_sought() {
    for (table, drift) in [
        (include_str!("../data/loops/triangle_drift.csv"), 2e-10),
        (include_str!("../data/loops/sine_drift_of_1_percent.csv"), 2.51124e-9),
        (include_str!("../data/loops/sine_drift_of_15_percent.csv"), 3.75e-8),
    ] {
        let found = fitted(record(table), Parameter::Drift, Noise::default());
        holds(&found, [FRICTION, drift], [1e-3, 0.1]);
    }
}
