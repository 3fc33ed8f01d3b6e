//! Random scans of known shapes: how often do the stated standard errors cover the truth?
//!
//! Two hundred by default, or as many as STICKSLIP_SCAN_CASES says.

use stickslip_measured::scan::{Estimate, Options, Scan, ScanFit};
use stickslip_mechanics::Preload;

use crate::synthetic::{Instrument, Shape};
use crate::{steel, truth};

/// A shape and the radius of its contact.
fn shape(random: &mut fastrand::Rng, kind: usize) -> (Shape, f64) {
    let mut within = |low: f64, high: f64| low * (high / low).powf(random.f64());
    let a = within(4e-5, 2e-4);
    let shape = match kind {
        0 => Shape::Ball(a * within(60.0, 300.0)),
        1 => {
            let flat = a * within(0.3, 0.7);
            Shape::WornBall(a * within(60.0, 300.0), flat, flat * within(0.2, 0.5))
        }
        2 => Shape::Cone(within(0.003, 0.03), a * within(0.3, 0.8)),
        3 => Shape::Punch(a * within(0.3, 0.8), a * within(30.0, 100.0)),
        _ => Shape::Hyperboloid(within(0.003, 0.03), a * within(0.02, 0.5)),
    };
    (shape, a)
}

/// An instrument that sees at least 1.4 times the contact: noise of 0.1 to 30 nm, white or correlated, tilt, an axis
/// off the middle, outliers, missing heights, either way up.
fn instrument(random: &mut fastrand::Rng, a: f64, map: bool) -> Instrument {
    let half = a * (1.4 + 1.6 * random.f64());
    let mut off = |most: f64| most * (2.0 * random.f64() - 1.0);
    let axis = [off(0.15 * half), if map { off(0.15 * half) } else { 0.0 }];
    let tilt = [off(1e-3), if map { off(1e-3) } else { 0.0 }];
    Instrument {
        half,
        points: if map { random.usize(40..100) } else { random.usize(300..2_000) },
        map,
        axis,
        tilt,
        noise: 1e-10 * 300f64.powf(random.f64()),
        correlation: if random.bool() { 1 } else { random.usize(2..10) },
        outliers: 0.01,
        missing: 0.02,
        sign: if random.bool() { 1.0 } else { -1.0 },
    }
}

/// The kinds of shapes, and the quantities of a contact.
const KINDS: [&str; 5] = ["ball", "worn ball", "cone with a rounded tip", "rounded punch", "hyperboloid"];
const QUANTITIES: [&str; 3] = ["largest pressure", "indentation", "contact radius"];

/// Of one kind and quantity: errors over their standard errors, and standard errors over the truth.
#[derive(Clone, Default)]
struct Sample {
    errors: Vec<f64>,
    stated: Vec<f64>,
}

impl Sample {
    fn add(&mut self, estimate: Estimate, truth: f64) {
        self.errors.push((estimate.value - truth).abs() / estimate.standard_error);
        self.stated.push(estimate.standard_error / truth);
    }

    /// How many are within so many standard errors.
    fn within(&self, errors: f64) -> usize {
        self.errors.iter().filter(|error| **error <= errors).count()
    }

    fn median_stated(&self) -> f64 {
        let mut stated = self.stated.clone();
        stated.sort_by(f64::total_cmp);
        stated[stated.len() / 2]
    }
}

/// A contact of a shape, as an instrument saw it.
struct Case {
    index: usize,
    shape: Shape,
    a: f64,
    instrument: Instrument,
    scan: Scan,
}

/// Of each quantity, what the fits of these cases found.
fn samples<'a>(cases: impl Iterator<Item = &'a Case>) -> [Sample; QUANTITIES.len()] {
    let mut samples = <[Sample; QUANTITIES.len()]>::default();
    for Case { index, shape, a, instrument, scan } in cases {
        let truth = truth(shape.profile(2.0 * instrument.half), Preload::ContactRadius(*a));
        let fit = ScanFit::new(scan, &Options::default(), &|| true);
        let fit = fit.unwrap_or_else(|error| panic!("{index} {shape:?} {instrument:?}: {error}"));
        let found = fit.contact(steel(), 0.3, Preload::NormalForce(truth.normal_force));
        let found = found.unwrap_or_else(|error| panic!("{index} {shape:?} {instrument:?}: {error}"));
        for (sample, (estimate, truth)) in samples.iter_mut().zip([
            (found.max_pressure, truth.max_pressure.unwrap()),
            (found.indentation, truth.indentation),
            (found.contact_radius, truth.contact_radius),
        ]) {
            sample.add(estimate, truth);
            if (estimate.value - truth).abs() > 3.0 * estimate.standard_error {
                println!("{index}: {truth} but {estimate:?} of {shape:?}, {instrument:?}, radius {a}");
            }
        }
    }
    samples
}

#[test]
fn the_standard_errors_cover_the_truth_and_nothing_is_refused() {
    let mut random = fastrand::Rng::with_seed(2026);
    let scans = std::env::var("STICKSLIP_SCAN_CASES").map_or(200, |cases| cases.parse().unwrap());
    let cases: Vec<Case> = (0..scans)
        .map(|index| {
            let (shape, a) = shape(&mut random, index % KINDS.len());
            let instrument = instrument(&mut random, a, index / KINDS.len() % 5 == 4);
            let scan = instrument.scan(&shape, &mut random);
            Case { index, shape, a, instrument, scan }
        })
        .collect();
    let samples: Vec<_> = std::thread::scope(|scope| {
        let cases = &cases;
        let kinds: [_; KINDS.len()] =
            std::array::from_fn(|kind| scope.spawn(move || samples(cases.iter().skip(kind).step_by(KINDS.len()))));
        kinds.map(|kind| kind.join().unwrap()).into()
    });
    for (kind, samples) in KINDS.iter().zip(&samples) {
        for (quantity, sample) in QUANTITIES.iter().zip(samples) {
            let count = sample.errors.len();
            let [one, two, three] = [1.0, 2.0, 3.0].map(|errors| 100.0 * sample.within(errors) as f64 / count as f64);
            let (median, worst) = (100.0 * sample.median_stated(), sample.errors.iter().copied().fold(0.0, f64::max));
            println!(
                "{kind}, {quantity}: {one:.1} %, {two:.1} %, {three:.1} % of {count} within 1, 2, 3; farthest \
                 {worst:.1}; standard error {median:.3} %"
            );
            // A kind of its own has too few scans by default for more than this.
            assert!(sample.within(3.0) * 100 >= 92 * count, "{kind}, {quantity}");
        }
    }
    for (index, quantity) in QUANTITIES.iter().enumerate() {
        let within: usize = samples.iter().map(|samples| samples[index].within(3.0)).sum();
        assert!(within * 1000 >= 975 * scans, "{quantity}: {within} of {scans}");
    }
}
