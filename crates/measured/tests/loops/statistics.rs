//! With noise, the standard errors and intervals that are stated are those that repetition shows.

use stickslip_measured::loops::{Estimate, Known, LoopFit, Note, Parameter, Record, fit};
use stickslip_mechanics::Sphere;
use stickslip_mechanics::profile::Profile;

use crate::bench::{Bench, E_STAR, Normal};

const REPETITIONS: usize = 200;
const NOISE: f64 = 0.03;

/// A ball with f = 3 N and k = 12 N/um behind a machine of 0.03 um/N.
fn bench() -> Bench {
    let contact_radius = (0.75_f64 * 10.0 * 0.01 / E_STAR).cbrt();
    Bench {
        profile: Profile::Sphere(Sphere::new(0.01).unwrap()),
        friction: 0.3,
        g_star: 12e6 / (2.0 * contact_radius),
        normal_force: 10.0,
        compliance: 3e-8,
        ..Bench::default()
    }
}

/// Fits of one loop under many draws of noise.
fn repeated(share: f64, free: &[Parameter], known: &[Known]) -> Vec<LoopFit> {
    let bench = bench();
    let clean = bench.steady(share * bench.gross_slip(), 500);
    let mut normal = Normal(fastrand::Rng::with_seed(22));
    let mut draw = || {
        let force = clean.force.iter().map(|force| force + NOISE * normal.next()).collect();
        let mut task = bench.task(vec![Record { force, ..clean.clone() }], free);
        for prior in known {
            // What is known is itself a measurement with its error.
            let value = prior.value + prior.standard_error * normal.next();
            task.known.push(Known { value, ..*prior });
        }
        fit(&task, &|| true).unwrap()
    };
    (0..REPETITIONS).map(|_| draw()).collect()
}

struct Spread {
    deviation: f64,
    stated: f64,
    covered: f64,
}

fn spread(fits: &[LoopFit], index: usize, truth: f64) -> Spread {
    let of = |value: fn(&Estimate) -> f64| fits.iter().map(move |fit| value(&fit.estimates[index]));
    let count = fits.len() as f64;
    let mean = of(|estimate| estimate.value).sum::<f64>() / count;
    let deviation =
        (of(|estimate| estimate.value).map(|value| (value - mean).powi(2)).sum::<f64>() / (count - 1.0)).sqrt();
    let mut errors: Vec<f64> = of(|estimate| estimate.standard_error.unwrap_or(f64::INFINITY)).collect();
    errors.sort_by(f64::total_cmp);
    let inside = |fit: &&LoopFit| {
        let [low, high] = fit.estimates[index].interval;
        low.is_none_or(|low| low <= truth) && high.is_none_or(|high| truth <= high)
    };
    let covered = fits.iter().filter(inside).count() as f64 / count;
    let spread = Spread { deviation: deviation / truth, stated: errors[errors.len() / 2] / truth, covered };
    println!(
        "{:?}: sd {:.4}, stated {:.4}, covered {}",
        fits[0].estimates[index].parameter, spread.deviation, spread.stated, covered
    );
    spread
}

#[test]
fn intervals_cover_and_standard_errors_are_right() {
    use Parameter::{Friction, GStar, MachineCompliance};
    let bench = bench();
    let truth = |parameter| match parameter {
        Friction => bench.friction,
        GStar => bench.g_star,
        _ => bench.compliance,
    };
    let held = Known { parameter: MachineCompliance, value: bench.compliance, standard_error: 0.0 };
    let prior = Known { standard_error: 3e-9, ..held };
    let cases: [(&str, f64, &[Parameter], &[Known]); 4] = [
        ("gross slip, compliance sought", 1.5, &[Friction, GStar, MachineCompliance], &[]),
        ("gross slip, compliance held", 1.5, &[Friction, GStar], &[held]),
        ("partial slip, compliance held", 0.7, &[Friction, GStar], &[held]),
        ("partial slip, compliance known to 10 %", 0.7, &[Friction, GStar], &[prior]),
    ];
    for (name, share, free, known) in cases {
        println!("{name}");
        let fits = repeated(share, free, known);
        // Wald & Wolfowitz (1940): noise changes its sign this often.
        let runs = |fit: &LoopFit| fit.residual.runs.count as f64 / fit.residual.runs.expected;
        let mean = fits.iter().map(runs).sum::<f64>() / fits.len() as f64;
        assert!((mean - 1.0).abs() < 0.02, "{name}: {mean} of the expected runs");
        for (index, &parameter) in free.iter().enumerate() {
            let Spread { deviation, stated, covered } = spread(&fits, index, truth(parameter));
            assert!((0.9..=0.99).contains(&covered), "{name}, {parameter:?}: {covered}");
            assert!((stated / deviation - 1.0).abs() < 0.2, "{name}, {parameter:?}: {stated} and {deviation}");
        }
    }
}

#[test]
fn a_loop_in_partial_slip_does_not_know_the_machine() {
    use Parameter::{Friction, GStar, MachineCompliance};
    let bench = bench();
    let fits = repeated(0.7, &[Friction, GStar, MachineCompliance], &[]);
    for (index, truth) in [bench.friction, bench.g_star, bench.compliance].into_iter().enumerate() {
        let Spread { covered, .. } = spread(&fits, index, truth);
        assert!((0.9..=0.99).contains(&covered));
    }
    assert!(fits[0].correlations[1][2].unwrap() > 0.999, "{:?}", fits[0].correlations);
    // Half as far, the interval of the friction must not be shorter than that of the stiffness suggests.
    let far = bench.steady(0.5 * bench.gross_slip(), 500);
    for seed in 0..10 {
        let mut normal = Normal(fastrand::Rng::with_seed(seed));
        let force = far.force.iter().map(|force| force + NOISE * normal.next()).collect();
        let task = bench.task(vec![Record { force, ..far.clone() }], &[Friction, GStar, MachineCompliance]);
        let found = fit(&task, &|| true).unwrap();
        let [low, high] = found.estimates[0].interval.map(Option::unwrap);
        assert!(high / low > 1.2, "seed {seed}: {:?}", found.estimates);
        assert!(found.identifiable.contains(&"1/(2 * g_star * contact_radius) + machine_compliance".to_owned()));
    }
    // The machine left out: no word of it, and yet the truth is within the intervals.
    let fits = repeated(0.7, &[Friction, GStar], &[]);
    for (index, truth) in [bench.friction, bench.g_star].into_iter().enumerate() {
        let Spread { covered, .. } = spread(&fits, index, truth);
        assert!(covered >= 0.9);
    }
    println!("{:?} {:?} {:?}", fits[0].estimates, fits[0].identifiable, fits[0].notes);
    assert!(fits.iter().all(|fit| fit.notes.contains(&Note::MachineComplianceUnknown)));
}
