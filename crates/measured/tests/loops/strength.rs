//! Loops of contacts with a shear strength beside friction: what one load, two loads and partial slip tell of both.

use stickslip_measured::loops::{Error, Known, LoopFit, Note, Parameter, Record, Task, fit};
use stickslip_mechanics::profile::{FlatPunch, LoadCurve, Profile, RoundedPunch, TruncatedCone};
use stickslip_mechanics::{Elasticity, Sphere};

use crate::bench::{Bench, E_STAR, Normal, rigid};

const FREE: [Parameter; 3] = [Parameter::Friction, Parameter::GStar, Parameter::ShearStrength];
/// A strength that carries about as much as friction does.
const STRENGTH: f64 = 8e7;

fn bench(friction: f64, shear_strength: f64) -> Bench {
    Bench { friction, shear_strength, ..Bench::default() }
}

fn with_noise(mut record: Record, share: f64, seed: u64) -> Record {
    let largest = record.force.iter().fold(0.0_f64, |most, force| most.max(force.abs()));
    let mut normal = Normal(fastrand::Rng::with_seed(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15)));
    record.force.iter_mut().for_each(|force| *force += share * largest * normal.next());
    record
}

fn fitted(bench: &Bench, records: Vec<Record>, free: &[Parameter]) -> LoopFit {
    let task = Task { known: vec![rigid()], ..bench.task(records, free) };
    fit(&task, &|| true).unwrap()
}

fn value(found: &LoopFit, parameter: Parameter) -> f64 {
    found.estimates.iter().find(|one| one.parameter == parameter).unwrap().value
}

fn interval(found: &LoopFit, parameter: Parameter) -> [Option<f64>; 2] {
    found.estimates.iter().find(|one| one.parameter == parameter).unwrap().interval
}

fn covers(found: &LoopFit, parameter: Parameter, truth: f64) -> bool {
    let [low, high] = interval(found, parameter);
    low.is_none_or(|low| low <= truth) && high.is_none_or(|high| truth <= high)
}

/// Without noise all three come back, of shapes with and without a flat face and a vertical edge.
#[test]
fn friction_modulus_and_strength_come_back_without_noise() {
    let profiles = [
        Profile::Sphere(Sphere::new(0.01).unwrap()),
        Profile::TruncatedCone(TruncatedCone::new(0.01, 3e-5).unwrap()),
        Profile::RoundedPunch(RoundedPunch::new(3e-5, 0.01).unwrap()),
        Profile::FlatPunch(FlatPunch::new(1e-4).unwrap()),
    ];
    for profile in profiles {
        let name = format!("{profile:?}");
        let bench = Bench { profile, ..bench(0.2, STRENGTH) };
        let found = fitted(&bench, vec![bench.steady(1.6 * bench.gross_slip(), 200)], &FREE);
        let truth = [bench.friction, bench.g_star, bench.shear_strength];
        for (parameter, truth) in FREE.into_iter().zip(truth) {
            let value = value(&found, parameter);
            assert!((value / truth - 1.0).abs() < 1e-6, "{name} {parameter:?}: {value:e}, {truth:e}");
        }
        assert!((found.contact.shear_strength() / STRENGTH - 1.0).abs() < 1e-6, "{name}");
    }
}

/// A machine in series, a strength alone, and friction that is known: the same.
#[test]
fn a_strength_comes_back_behind_a_machine_and_without_friction() {
    let soft = Bench { compliance: 3e-8, ..bench(0.2, STRENGTH) };
    let amplitude = 1.5 * (soft.gross_slip() + soft.compliance * 5.0);
    let free = [&FREE[..], &[Parameter::MachineCompliance]].concat();
    let found = fit(&soft.task(vec![soft.virgin(amplitude, 400, 1.5)], &free), &|| true).unwrap();
    assert!((value(&found, Parameter::ShearStrength) / STRENGTH - 1.0).abs() < 1e-5, "{:?}", found.estimates);
    assert!((value(&found, Parameter::MachineCompliance) / 3e-8 - 1.0).abs() < 1e-5, "{:?}", found.estimates);

    let strong = bench(0.0, 2.0 * STRENGTH);
    let record = strong.steady(1.5 * strong.gross_slip(), 200);
    let none = Known { parameter: Parameter::Friction, value: 0.0, standard_error: 0.0 };
    let free = [Parameter::GStar, Parameter::ShearStrength];
    let task = Task { known: vec![rigid(), none], ..strong.task(vec![record.clone()], &free) };
    let found = fit(&task, &|| true).unwrap();
    assert!((value(&found, Parameter::ShearStrength) / (2.0 * STRENGTH) - 1.0).abs() < 1e-6, "{:?}", found.estimates);

    // Of a definition without friction a fit that names nothing seeks the strength.
    let task = Task { contact: strong.contact(), free: vec![], known: vec![rigid()], ..task };
    let found = fit(&task, &|| true).unwrap();
    assert!(found.free.contains(&Parameter::ShearStrength) && !found.free.contains(&Parameter::Friction));
    assert!((value(&found, Parameter::ShearStrength) / (2.0 * STRENGTH) - 1.0).abs() < 1e-6, "{:?}", found.estimates);

    // Friction is the one that is zero, where both are free.
    let found = fitted(&strong, vec![with_noise(record, 0.002, 1)], &FREE);
    assert!(covers(&found, Parameter::Friction, 0.0) && covers(&found, Parameter::ShearStrength, 2.0 * STRENGTH));
}

/// A strength of the definition is known as friction is: the other one is found beside it.
#[test]
fn a_strength_that_is_known_leaves_friction_to_be_found() {
    let bench = bench(0.2, STRENGTH);
    let record = bench.steady(1.6 * bench.gross_slip(), 200);
    let free = [Parameter::Friction, Parameter::GStar];
    let task = Task { contact: bench.contact(), known: vec![rigid()], ..bench.task(vec![record.clone()], &free) };
    let known = Known { parameter: Parameter::ShearStrength, value: STRENGTH, standard_error: 0.0 };
    let by_name = Task { known: vec![rigid(), known], ..bench.task(vec![record], &free) };
    for task in [task, by_name] {
        let found = fit(&task, &|| true).unwrap();
        assert!((value(&found, Parameter::Friction) / 0.2 - 1.0).abs() < 1e-6, "{:?}", found.estimates);
        assert!((found.contact.shear_strength() / STRENGTH - 1.0).abs() < 1e-12);
    }
}

/// Radius and E* change the area under a strength: two loads tell a wrong radius.
#[test]
fn a_radius_that_is_free_changes_the_area_of_the_strength() {
    let bench = bench(0.2, STRENGTH);
    let heavy = Bench { normal_force: 40.0, ..bench.clone() };
    let records = vec![bench.steady(1.6 * bench.gross_slip(), 200), heavy.steady(1.6 * heavy.gross_slip(), 200)];
    let free = [Parameter::Friction, Parameter::Radius, Parameter::ShearStrength];
    let g_star = Known { parameter: Parameter::GStar, value: bench.g_star, standard_error: 0.0 };
    let mut task = bench.task(records, &free);
    let wrong = Bench { profile: Profile::Sphere(Sphere::new(0.013).unwrap()), ..Bench::default() };
    (task.contact, task.known) = (wrong.contact(), vec![rigid(), g_star]);
    let found = fit(&task, &|| true).unwrap();
    for (parameter, truth) in free.into_iter().zip([0.2, 0.01, STRENGTH]) {
        assert!((value(&found, parameter) / truth - 1.0).abs() < 1e-5, "{:?}", found.estimates);
    }
}

/// Intervals of records with noise: under one load, the shape of the loop alone separates both; under two, the forces
/// of gross slip do.
#[test]
fn intervals_cover_friction_and_strength() {
    let cases = std::env::var("STICKSLIP_LOOP_CASES").map_or(30, |cases| cases.parse().unwrap());
    for loads in [1, 2] {
        let (mut covered, mut widths, mut alarms) = ([0; 3], [vec![], vec![], vec![]], 0);
        for case in 0..cases {
            let mut random = fastrand::Rng::with_seed(case as u64 + 1000 * loads as u64);
            let bench = bench(0.05 + 0.3 * random.f64(), STRENGTH * (0.1 + 1.5 * random.f64()));
            let records = (0..loads).map(|load| {
                let bench = Bench { normal_force: 10.0 * 4_f64.powi(load), ..bench.clone() };
                let record = bench.steady((1.2 + random.f64()) * bench.gross_slip(), 150);
                with_noise(record, 0.01, (case * 10 + load) as u64)
            });
            let found = fitted(&bench, records.collect(), &FREE);
            let truth = [bench.friction, bench.g_star, bench.shear_strength];
            for (place, (parameter, truth)) in FREE.into_iter().zip(truth).enumerate() {
                covered[place] += usize::from(covers(&found, parameter, truth));
                let [low, high] = interval(&found, parameter);
                widths[place].push(low.zip(high).map_or(f64::INFINITY, |(low, high)| 0.5 * (high - low) / truth));
            }
            let alarm = [Note::NotCoulomb, Note::OmittedParameter, Note::NotConverged];
            alarms += usize::from(alarm.iter().any(|note| found.notes.contains(note)));
        }
        let medians = widths.map(|mut widths: Vec<f64>| {
            widths.sort_by(f64::total_cmp);
            widths[widths.len() / 2]
        });
        println!("{loads} loads: covered {covered:?} of {cases}, half-widths {medians:.3?}, alarms {alarms}");
        let least = 0.95 - 4.0 * (0.95 * 0.05 / cases as f64).sqrt();
        assert!(covered.iter().all(|covered| *covered as f64 >= least * cases as f64), "{covered:?}");
        assert!(50 * alarms <= cases.max(50) as usize, "{alarms}");
        assert!(loads == 1 || medians[2] < 0.2, "{medians:?}");
    }
}

/// A loop in partial slip under one load does not tell friction from strength, and says so: neither is named as
/// determined, and the interval of the strength begins at none.
#[test]
fn a_record_that_cannot_tell_friction_from_strength_says_so() {
    for seed in 0..5 {
        let bench = bench(0.3, 0.3 * STRENGTH);
        let record = with_noise(bench.steady(0.5 * bench.gross_slip(), 150), 0.01, seed);
        let found = fitted(&bench, vec![record], &FREE);
        let named = |name: &str| found.identifiable.iter().any(|one| one == name);
        assert!(!named("friction") && !named("shear_strength"), "{:?}", found.identifiable);
        assert!(covers(&found, Parameter::Friction, 0.3), "{:?}", found.estimates);
        let [low, high] = interval(&found, Parameter::ShearStrength);
        assert!(low.is_none_or(|low| low <= 0.0), "{:?}", found.estimates);
        assert!(high.is_none_or(|high| high >= 0.3 * STRENGTH), "{:?}", found.estimates);
        assert!(found.notes.contains(&Note::PartialSlipOnly));
    }
    // Gross slip under one load with coarse noise: the force of gross slip is determined, its two parts are not.
    let bench = bench(0.2, STRENGTH);
    let record = with_noise(bench.steady(1.5 * bench.gross_slip(), 60), 0.05, 3);
    let found = fitted(&bench, vec![record], &FREE);
    let sum = "friction * normal_force + pi * contact_radius^2 * shear_strength";
    assert!(found.identifiable.iter().any(|one| one == sum), "{:?} {:?}", found.identifiable, found.estimates);
}

/// A strength that was left out shows in its score, and one that is not there does not.
#[test]
fn a_strength_that_was_left_out_shows_in_its_score() {
    let score = |bench: &Bench, seed: u64| {
        let record = with_noise(bench.steady(1.5 * bench.gross_slip(), 200), 0.005, seed);
        let found = fitted(bench, vec![record], &FREE[..2]);
        let one = found.omitted.iter().find(|one| one.parameter == Parameter::ShearStrength).unwrap().clone();
        (one, found)
    };
    for seed in 0..5 {
        let (one, found) = score(&bench(0.2, STRENGTH), seed);
        assert!(one.is_significant() && found.notes.contains(&Note::OmittedParameter), "{one:?}");
        assert!(one.value.unwrap() > 0.0, "{one:?}");
        let (one, _) = score(&bench(0.3, 0.0), seed);
        assert!(!one.is_significant(), "{one:?}");
    }
}

/// A contact that is known by its load curve alone has no strength.
#[test]
fn a_load_curve_has_no_strength_to_fit() {
    let depth: Vec<f64> = (0..40).map(|k| f64::from(k) * 1e-7).collect();
    let force: Vec<f64> = depth.iter().map(|depth| E_STAR * 0.1 * depth.powf(1.5)).collect();
    let curve = LoadCurve::new(&depth, &force, &Elasticity::effective(E_STAR, 8.5e10).unwrap()).unwrap();
    let bench = Bench { profile: Profile::LoadCurve(curve), normal_force: 1.0, ..bench(0.3, 0.0) };
    let record = bench.steady(1.5 * bench.gross_slip(), 100);
    let refused = fit(&bench.task(vec![record], &FREE), &|| true).unwrap_err();
    assert_eq!(refused, Error::NotOfProfile { parameter: Parameter::ShearStrength });
}
