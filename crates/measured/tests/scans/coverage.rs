//! Two hundred random scans of known shapes: how often do the stated standard errors cover the truth?

use stickslip_measured::scan::{Estimate, Options, ScanFit};
use stickslip_mechanics::{Contact, Elasticity, Preload, Setup, elasticity::Body};

use crate::synthetic::{Instrument, Shape};

fn steel() -> Elasticity {
    Elasticity::against_rigid(Body::new(2.1e11, 0.3).unwrap())
}

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

#[test]
fn standard_errors_cover_the_truth() {
    let mut random = fastrand::Rng::with_seed(std::env::var("SEED").map_or(2026, |s| s.parse().unwrap()));
    let (mut covered, mut refused, mut all) = ([0usize; 4], 0, 0usize);
    for index in 0..200 {
        let kind = index % 4;
        let (shape, a) = shape(&mut random, kind);
        let map = index % 5 == 4;
        let reach = a * (1.4 + 1.6 * random.f64());
        let noise = 1e-10 * 300f64.powf(random.f64());
        let correlation = if random.bool() { 1 } else { 2 + random.usize(..8) };
        let points = if map { 40 + random.usize(..60) } else { 300 + random.usize(..1700) };
        let mut off = || 0.15 * reach * (2.0 * random.f64() - 1.0);
        let axis = [off(), if map { off() } else { 0.0 }];
        let mut lean = || 1e-3 * (2.0 * random.f64() - 1.0);
        let tilt = [lean(), if map { lean() } else { 0.0 }];
        let sign = if random.bool() { 1.0 } else { -1.0 };
        let instrument = Instrument {
            half: reach,
            points,
            map,
            axis,
            tilt,
            noise,
            correlation,
            outliers: 0.01,
            missing: 0.02,
            sign,
        };
        let scan = instrument.scan(&shape, &mut random);
        let truth = Contact::new(Setup {
            profile: shape.profile(2.0 * reach),
            elasticity: steel(),
            friction: 0.3,
            preload: Preload::ContactRadius(a),
        })
        .unwrap()
        .summary();
        if let Ok(only) = std::env::var("ONLY")
            && !only.split(',').any(|o| o == index.to_string())
        {
            continue;
        }
        all += 1;
        let found = ScanFit::new(&scan, &Options::default(), &|| true)
            .and_then(|fit| Ok((fit.contact(steel(), 0.3, Preload::NormalForce(truth.normal_force))?, fit)));
        let (found, fit) = match found {
            Ok(found) => found,
            Err(error) => {
                refused += 1;
                println!("{index} {shape:?} {instrument:?}: {error}");
                continue;
            }
        };
        let off = |estimate: Estimate, truth: f64| (estimate.value - truth) / estimate.standard_error;
        let offs = [
            off(found.max_pressure, truth.max_pressure.unwrap()),
            off(found.indentation, truth.indentation),
            off(found.contact_radius, truth.contact_radius),
        ];
        for (covered, off) in covered.iter_mut().zip(offs) {
            *covered += usize::from(off.abs() <= 3.0);
        }
        println!(
            "{index:3} kind {kind} map {map} noise {:.1} nm corr {correlation} n {points} f(a) {:.0} nm: p {:+.2} SE ({:+.2} % +- {:.2} %), d {:+.2}, a {:+.2}; edf {} tilt {:?}/{:?} axis err {:.2} um rms {:.2} nm outl {} g {:.2} {} o {:?}",
            noise * 1e9,
            shape.height(a) * 1e9,
            offs[0],
            100.0 * (found.max_pressure.value / truth.max_pressure.unwrap() - 1.0),
            100.0 * found.max_pressure.standard_error / truth.max_pressure.unwrap(),
            offs[1],
            offs[2],
            0,
            fit.tilt[0] * sign,
            tilt[0],
            1e6 * (fit.centre[0] - axis[0]).hypot(fit.centre[1] - axis[1]),
            fit.rms * 1e9,
            fit.outliers,
            fit.g_margin,
            fit.constrained,
            fit.orientation,
        );
    }
    println!("{covered:?} of {all}, refused {refused}");
    assert!(covered[0] * 100 >= 95 * all && refused == 0);
}
