//! Two hundred random scans of known shapes: how often do the stated standard errors cover the truth?

use stickslip_measured::scan::{Estimate, Options, ScanFit};
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
        _ => Shape::Punch(a * within(0.3, 0.8), a * within(30.0, 100.0)),
    };
    (shape, a)
}

/// An instrument that sees at least 1.4 times the contact: noise of 0.1 to 30 nm, white or correlated, tilt, an axis off the middle,
/// outliers, missing heights, either way up.
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

#[test]
fn the_standard_errors_cover_the_truth_and_nothing_is_refused() {
    let mut random = fastrand::Rng::with_seed(2026);
    const SCANS: usize = 200;
    let mut covered = [0; 3];
    for index in 0..SCANS {
        let (shape, a) = shape(&mut random, index % 4);
        let instrument = instrument(&mut random, a, index % 5 == 4);
        let scan = instrument.scan(&shape, &mut random);
        let truth = truth(shape.profile(2.0 * instrument.half), Preload::ContactRadius(a));
        let fit = ScanFit::new(&scan, &Options::default(), &|| true);
        let fit = fit.unwrap_or_else(|error| panic!("{index} {shape:?} {instrument:?}: {error}"));
        let found = fit.contact(steel(), 0.3, Preload::NormalForce(truth.normal_force));
        let found = found.unwrap_or_else(|error| panic!("{index} {shape:?} {instrument:?}: {error}"));
        let within = |estimate: Estimate, truth: f64| (estimate.value - truth).abs() <= 3.0 * estimate.standard_error;
        for (covered, within) in covered.iter_mut().zip([
            within(found.max_pressure, truth.max_pressure.unwrap()),
            within(found.indentation, truth.indentation),
            within(found.contact_radius, truth.contact_radius),
        ]) {
            *covered += usize::from(within);
        }
    }
    assert!(covered.iter().all(|covered| covered * 100 >= 95 * SCANS), "{covered:?} of {SCANS}");
}
