//! The friction of a contact that follows a bench, from one measured cycle, against a ball in closed form (Cattaneo
//! 1938, Mindlin 1949; Masing 1926).

use std::f64::consts::TAU;

use stickslip_measured::cycle_friction::MeasuredCycle;

use crate::bench::{Bench, Normal};

/// The friction of the definition, which the bench does not have.
const FRICTION: f64 = 0.3;
/// Measurements of a cycle.
const POINTS: usize = 20;
/// Normal force, N.
const LOAD: f64 = 10.0;

/// A cycle from the largest displacement to the smallest and back; the amplitude is in units of the displacement of
/// gross slip at the friction of the definition, and the noise in those of the friction force.
fn cycle(friction: f64, amplitude: f64, noise: &mut impl FnMut() -> f64) -> [Vec<f64>; 2] {
    let unit = Bench { friction: FRICTION, ..Bench::default() }.gross_slip();
    let (limit, amplitude) = (friction * LOAD, amplitude * unit);
    let loading = |u: f64| limit * (1.0 - (1.0 - (u / unit * FRICTION / friction).min(1.0)).powf(1.5));
    let displacement: Vec<f64> =
        (0..=POINTS).map(|step| amplitude * (TAU * step as f64 / POINTS as f64).cos()).collect();
    let force = displacement.iter().enumerate().map(|(step, u)| {
        let sign = if step <= POINTS / 2 { 1.0 } else { -1.0 };
        let force = sign * (loading(amplitude) - 2.0 * loading(0.5 * (amplitude - sign * u)));
        // A force at rest, too.
        force + 0.05 + limit * noise()
    });
    [force.collect(), displacement]
}

fn friction([force, displacement]: [Vec<f64>; 2]) -> Option<(f64, [f64; 2])> {
    let mut cycle = MeasuredCycle::default();
    for (displacement, force) in displacement.into_iter().zip(force) {
        assert!(cycle.push(displacement, force, (1e-6, LOAD)));
    }
    cycle.friction(Bench { friction: FRICTION, ..Bench::default() }.contact(), &|| true).unwrap()
}

#[test]
fn friction_that_wears_in_is_followed_within_a_tenth_of_its_change() {
    let mut normal = Normal(fastrand::Rng::with_seed(5));
    let (mut total, mut covered) = (0.0, 0);
    for batch in 1..=20 {
        let truth = 0.3 + 0.3 * (1.0 - (-4.0 * f64::from(batch) / 20.0).exp());
        let (value, [low, high]) = friction(cycle(truth, 3.0, &mut || 0.01 * normal.next())).unwrap();
        assert!((value - truth).abs() < 0.03 && high - low < 0.03, "{value} in {low} to {high}, and not {truth}");
        total += (value - truth).abs();
        covered += usize::from(low <= truth && truth <= high);
    }
    assert!(total / 20.0 < 0.004 && covered >= 17, "{} off, {covered} covered", total / 20.0);
}

#[test]
fn a_cycle_that_does_not_slide_has_no_friction() {
    let mut still = || 0.0;
    assert!((friction(cycle(0.45, 3.0, &mut still)).unwrap().0 - 0.45).abs() < 1e-3);
    // Two thirds of the displacement of gross slip at this friction; a force of zero.
    assert_eq!(friction(cycle(0.45, 1.0, &mut still)), None);
    let [force, displacement] = cycle(0.45, 3.0, &mut still);
    assert_eq!(friction([vec![0.0; force.len()], displacement]), None);
}
