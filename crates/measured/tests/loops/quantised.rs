//! Loops whose forces come in steps: are the intervals as wide as they have to be, and is it said?
//!
//! A hundred and fifty random loops by default, or as many as STICKSLIP_LOOP_CASES says.

use stickslip_measured::loops::{LoopFit, Note, Parameter, Record, fit};
use stickslip_mechanics::profile::{FlatPunch, Profile};

use crate::bench::{Bench, Normal, rigid};

fn cases() -> usize {
    std::env::var("STICKSLIP_LOOP_CASES").map_or(150, |cases| cases.parse().unwrap())
}

/// The record as a converter with this step shows it, whose zero is anywhere, after noise of this standard deviation,
/// N.
fn converted(record: &Record, step: f64, noise: f64, normal: &mut Normal) -> Record {
    let zero = step * normal.0.f64();
    let mut read = |force: &f64| {
        let force = force + noise * normal.next();
        if step > 0.0 { ((force - zero) / step).round() * step + zero } else { force }
    };
    Record { force: record.force.iter().map(&mut read).collect(), ..record.clone() }
}

/// A random bench, and a clean loop of it that slips as a whole.
fn bench(random: &mut fastrand::Rng) -> (Bench, Record) {
    let mut within = |low: f64, high: f64| low + (high - low) * random.f64();
    let bench = Bench { friction: within(0.1, 0.8), g_star: within(5e10, 1e11), ..Bench::default() };
    let share = within(1.2, 2.0);
    let points = random.usize(200..1_000);
    let record = bench.steady(share * bench.gross_slip(), points);
    (bench, record)
}

fn fitted(bench: &Bench, record: Record) -> LoopFit {
    let mut task = bench.task(vec![record], &[Parameter::Friction, Parameter::GStar]);
    task.known.push(rigid());
    fit(&task, &|| true).unwrap()
}

fn covers(fit: &LoopFit, index: usize, truth: f64) -> bool {
    let [low, high] = fit.estimates[index].interval.map(Option::unwrap);
    low <= truth && truth <= high
}

#[test]
fn intervals_from_quantised_forces_cover_and_the_reply_says_so() {
    let mut random = fastrand::Rng::with_seed(31);
    let (mut covered, mut widths) = ([0; 2], Vec::new());
    for index in 0..cases() {
        let (bench, clean) = bench(&mut random);
        // Steps of 1 to 6 % of the friction force, with a dither of none to half a step.
        let step = bench.friction * bench.normal_force * (0.01 + 0.05 * random.f64());
        let dither = step * [0.0, 0.1, 0.2, 1.0 / 3.0, 0.5][index % 5];
        let mut normal = Normal(fastrand::Rng::with_seed(random.u64(..)));
        let found = fitted(&bench, converted(&clean, step, dither, &mut normal));
        assert!(found.notes.contains(&Note::Quantised), "{index}: {step} of {dither}: {:?}", found.residual);
        assert!(!found.notes.contains(&Note::NotCoulomb), "{index}: {step} of {dither}: {:?}", found.residual);
        for (covered, (parameter, truth)) in covered.iter_mut().zip([(0, bench.friction), (1, bench.g_star)]) {
            *covered += usize::from(covers(&found, parameter, truth));
        }
        let [low, high] = found.estimates[0].interval.map(Option::unwrap);
        widths.push((high - low) * bench.normal_force / step);
    }
    widths.sort_by(f64::total_cmp);
    println!("friction and stiffness: {covered:?} of {}; median width {:.2} steps", cases(), widths[cases() / 2]);
    // Nominally 95 %: below 90 % is less likely than one in a hundred.
    assert!(covered.iter().all(|covered| covered * 10 >= 9 * cases()), "{covered:?}");
    assert!(widths[cases() - 1] < 1.5, "{}", widths[cases() - 1]);
}

#[test]
fn the_friction_of_steps_of_three_percent_with_a_dither_of_a_third_is_covered() {
    let mut random = fastrand::Rng::with_seed(3);
    let mut covered = 0;
    for _ in 0..cases() {
        let (bench, clean) = bench(&mut random);
        let step = 0.03 * bench.friction * bench.normal_force;
        // Evenly spread over a third of a step to either side.
        let dither = |force: &f64| force + step * (random.f64() - 0.5) / 1.5;
        let dithered = Record { force: clean.force.iter().map(dither).collect(), ..clean };
        let mut normal = Normal(fastrand::Rng::with_seed(7));
        covered +=
            usize::from(covers(&fitted(&bench, converted(&dithered, step, 0.0, &mut normal)), 0, bench.friction));
    }
    println!("{covered} of {}", cases());
    assert!(covered * 10 >= 9 * cases(), "{covered}");
}

#[test]
fn forces_without_steps_or_with_steps_far_below_the_noise_are_not_called_quantised() {
    let mut random = fastrand::Rng::with_seed(5);
    for index in 0..cases() {
        let (bench, clean) = bench(&mut random);
        let noise = bench.friction * bench.normal_force * 0.002 * 20f64.powf(random.f64());
        // None; digits of a file; a step of which the noise is as large as one and a half.
        let step = [0.0, 0.01 * noise, noise / 1.5][index % 3];
        let mut normal = Normal(fastrand::Rng::with_seed(random.u64(..)));
        let found = fitted(&bench, converted(&clean, step, noise, &mut normal));
        assert!(!found.notes.contains(&Note::Quantised), "{index}: {step} of {noise}");
    }
    // A punch without noise rises by equal steps, which no converter has made.
    let punch = Bench { profile: Profile::FlatPunch(FlatPunch::new(1e-4).unwrap()), ..Bench::default() };
    let far = 1.5 * punch.gross_slip();
    let triangle = |point: usize| far * (1.0 - (point as f64 / 50.0 - 2.0).abs().rem_euclid(4.0));
    let path = (0..400).map(|point| triangle(point % 200));
    let found = fitted(&punch, punch.record(path, stickslip_measured::loops::Start::Virgin));
    assert!(!found.notes.contains(&Note::Quantised), "{:?}", found.residual);
}

#[test]
fn a_noise_that_is_given_counts_beside_that_of_the_rounding() {
    let mut random = fastrand::Rng::with_seed(9);
    let (bench, clean) = bench(&mut random);
    let step = 0.04 * bench.friction * bench.normal_force;
    let mut normal = Normal(fastrand::Rng::with_seed(1));
    let mut task =
        bench.task(vec![converted(&clean, step, 0.3 * step, &mut normal)], &[Parameter::Friction, Parameter::GStar]);
    task.known.push(rigid());
    task.noise.force = Some(0.3 * step);
    let found = fit(&task, &|| true).unwrap();
    assert!((found.noise[0] / step - (0.09_f64 + 1.0 / 12.0).sqrt()).abs() < 1e-3, "{:?}", found.noise);
    assert!(found.notes.contains(&Note::Quantised) && covers(&found, 0, bench.friction));
}
