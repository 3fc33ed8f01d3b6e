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

/// What an instrument gives in place of a height that it has not measured, m: fill values in nanometres, and drops to
/// one height that no instrument calls missing.
const FILLS: [f64; 4] = [-9.999e-6, -3.2768e-5, 3.2767e-5, -3e-6];

/// An instrument that sees at least 1.4 times the contact: noise of 0.1 to 30 nm, white or correlated, a tilt of up to
/// 5e-3, an axis off the middle, outliers, missing heights, a tenth of dropouts or none, either way up.
fn instrument(random: &mut fastrand::Rng, a: f64, map: bool, dropouts: bool) -> Instrument {
    let half = a * (1.4 + 1.6 * random.f64());
    let mut off = |most: f64| most * (2.0 * random.f64() - 1.0);
    let axis = [off(0.15 * half), if map { off(0.15 * half) } else { 0.0 }];
    let tilt = [off(5e-3), if map { off(5e-3) } else { 0.0 }];
    Instrument {
        half,
        points: if map { random.usize(40..100) } else { (60.0 * 33f64.powf(random.f64())) as usize },
        map,
        axis,
        tilt,
        noise: 1e-10 * 300f64.powf(random.f64()),
        correlation: if random.bool() { 1 } else { random.usize(2..10) },
        outliers: 0.01,
        missing: 0.02,
        dropouts: if dropouts { 0.1 } else { 0.0 },
        fill: FILLS[random.usize(..FILLS.len())],
        sign: if random.bool() { 1.0 } else { -1.0 },
    }
}

/// The kinds of shapes, those of scans, and the quantities of a contact.
const KINDS: [&str; 5] = ["ball", "worn ball", "cone with a rounded tip", "rounded punch", "hyperboloid"];
const SCANS: [&str; 4] = ["line", "line, dropouts", "map", "map, dropouts"];
const QUANTITIES: [&str; 3] = ["largest pressure", "indentation", "contact radius"];

/// Of a quantity: errors over their standard errors, infinite where the scan was refused, and standard errors over the
/// truth.
#[derive(Clone, Default)]
struct Sample {
    errors: Vec<f64>,
    stated: Vec<f64>,
}

impl Sample {
    fn add(&mut self, found: Option<Estimate>, truth: f64) {
        self.errors.push(found.map_or(f64::INFINITY, |found| (found.value - truth).abs() / found.standard_error));
        self.stated.extend(found.map(|found| found.standard_error / truth));
    }

    /// How many are within so many standard errors.
    fn within(&self, errors: f64) -> usize {
        self.errors.iter().filter(|error| **error <= errors).count()
    }

    fn median_stated(&self) -> f64 {
        let mut stated = self.stated.clone();
        stated.sort_by(f64::total_cmp);
        stated.get(stated.len() / 2).copied().unwrap_or(f64::NAN)
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

/// Of each quantity, what the fits of these cases found; and how many of these surfaces of revolution were called
/// another thing.
fn samples<'a>(cases: impl Iterator<Item = &'a Case>) -> ([Sample; QUANTITIES.len()], usize) {
    let (mut samples, mut alarms) = (<[Sample; QUANTITIES.len()]>::default(), 0);
    for Case { index, shape, a, instrument, scan } in cases {
        let truth = truth(shape.profile(2.0 * instrument.half), Preload::ContactRadius(*a));
        let found = ScanFit::new(scan, &Options::default(), &|| true);
        let is_called_other = |fit: &ScanFit| {
            let found = &fit.diagnosis;
            let is_one = found.structure.is_none() && found.edge.is_none() && found.second_harmonic != Some(true);
            if !is_one {
                println!("{index}: {found:?} of {shape:?}, {instrument:?}, radius {a}");
            }
            !is_one
        };
        alarms += usize::from(found.as_ref().is_ok_and(is_called_other));
        let found = found.and_then(|fit| fit.contact(steel(), 0.3, Preload::NormalForce(truth.normal_force)));
        if let Err(error) = &found {
            println!("{index}: {error} of {shape:?}, {instrument:?}, radius {a}");
        }
        let found = found.ok();
        for (index_of, (sample, (estimate, truth))) in samples
            .iter_mut()
            .zip([
                (found.map(|found| found.max_pressure), truth.max_pressure.unwrap()),
                (found.map(|found| found.indentation), truth.indentation),
                (found.map(|found| found.contact_radius), truth.contact_radius),
            ])
            .enumerate()
        {
            sample.add(estimate, truth);
            if let Some(estimate) = estimate.filter(|_| sample.errors[sample.errors.len() - 1] > 3.0) {
                let quantity = QUANTITIES[index_of];
                println!("{index}: {quantity} {truth} but {estimate:?} of {shape:?}, {instrument:?}, radius {a}");
            }
        }
    }
    (samples, alarms)
}

#[test]
fn the_standard_errors_cover_the_truth_and_nothing_is_refused() {
    let mut random = fastrand::Rng::with_seed(2026);
    let scans = std::env::var("STICKSLIP_SCAN_CASES").map_or(200, |cases| cases.parse().unwrap());
    let cases: Vec<Case> = (0..scans)
        .map(|index| {
            let kind = index / KINDS.len() % SCANS.len();
            let (shape, a) = shape(&mut random, index % KINDS.len());
            let instrument = instrument(&mut random, a, kind >= 2, kind % 2 == 1);
            let scan = instrument.scan(&shape, &mut random);
            Case { index, shape, a, instrument, scan }
        })
        .collect();
    let cells = KINDS.len() * SCANS.len();
    let (samples, alarms): (Vec<_>, Vec<_>) = std::thread::scope(|scope| {
        let cases = &cases;
        let of_cell = |cell: usize| samples(cases.iter().skip(cell).step_by(cells));
        let halves = [0, 1].map(|half| {
            scope.spawn(move || (0..cells).filter(|cell| cell % 2 == half).map(of_cell).collect::<Vec<_>>())
        });
        let [even, odd] = halves.map(|half| half.join().unwrap());
        even.into_iter().zip(odd).flat_map(|(one, other)| [one, other]).unzip()
    });
    println!("| scan | body | scans | refused | {} |", QUANTITIES.join(" | "));
    println!("|---|---|---|---|---|---|---|");
    for (cell, samples) in samples.iter().enumerate() {
        let (count, answered) = (samples[0].errors.len(), samples[0].stated.len());
        let shares = samples.each_ref().map(|sample| {
            let share = |errors: f64| 100.0 * sample.within(errors) as f64 / count as f64;
            format!("{:.0}, {:.1} % ({:.2} %)", share(1.0), share(3.0), 100.0 * sample.median_stated())
        });
        let (scan, kind) = (SCANS[cell / KINDS.len()], KINDS[cell % KINDS.len()]);
        println!("| {scan} | {kind} | {count} | {} | {} |", count - answered, shares.join(" | "));
    }
    for (index, quantity) in QUANTITIES.iter().enumerate() {
        let within: usize = samples.iter().map(|samples| samples[index].within(3.0)).sum();
        println!("{quantity}: {:.2} % of {scans} within three standard errors", 100.0 * within as f64 / scans as f64);
        assert!(within * 1000 >= 975 * scans, "{quantity}: {within} of {scans}");
    }
    let alarms: usize = alarms.iter().sum();
    println!("{alarms} of {scans} are called no single surface of revolution");
    assert!(alarms * 50 <= scans, "{alarms} of {scans}");
}
