//! Without noise, a fit finds what the bench was.

use stickslip_measured::loops::{Known, Note, Parameter, Record, Start, fit};
use stickslip_mechanics::profile::{
    Asperities, Cone, ExactSphere, FlatPunch, LoadCurve, PowerLaw, Profile, RoundedCone, RoundedPunch, Tabulated,
    TruncatedCone, TruncatedSphere,
};
use stickslip_mechanics::{Elasticity, Sphere};

use crate::bench::{Bench, E_STAR, rigid};

fn profiles() -> Vec<Profile> {
    let radii: Vec<f64> = (0..200).map(|index| 1e-6 * f64::from(index)).collect();
    let heights: Vec<f64> = radii.iter().map(|r| 50.0 * r * r * (1.0 + 3e3 * r)).collect();
    let depths: Vec<f64> = (0..100).map(|index| 1e-8 * f64::from(index)).collect();
    let forces: Vec<f64> = depths.iter().map(|d: &f64| 2e10 * d.powf(1.5) + 1e5 * d).collect();
    let elasticity = Elasticity::effective(E_STAR, 8.5e10).unwrap();
    let asperities: Vec<[f64; 2]> = (0..20).map(|index| [1e-4, 1e-8 * f64::from(index)]).collect();
    let (curvatures, gaps): (Vec<f64>, Vec<f64>) = asperities.iter().map(|[r, h]| (*r, *h)).unzip();
    vec![
        Profile::Sphere(Sphere::new(0.01).unwrap()),
        Profile::Cone(Cone::new(0.01).unwrap()),
        Profile::PowerLaw(PowerLaw::new(2.7, 1e4).unwrap()),
        Profile::PowerLaw(PowerLaw::new(4.0, 1e10).unwrap()),
        Profile::ExactSphere(ExactSphere::new(0.01).unwrap()),
        Profile::FlatPunch(FlatPunch::new(5e-5).unwrap()),
        Profile::TruncatedCone(TruncatedCone::new(0.01, 2e-5).unwrap()),
        Profile::TruncatedSphere(TruncatedSphere::new(0.01, 3e-5).unwrap()),
        Profile::RoundedPunch(RoundedPunch::new(5e-5, 1e-3).unwrap()),
        Profile::RoundedCone(RoundedCone::new(0.01, 2e-5).unwrap()),
        Profile::Tabulated(Tabulated::new(&radii, &heights).unwrap()),
        Profile::LoadCurve(LoadCurve::new(&depths, &forces, &elasticity).unwrap()),
        Profile::Asperities(Asperities::new(&curvatures, &gaps).unwrap()),
    ]
}

/// Every profile, in partial and in gross slip, from the first move and within a cycle.
#[test]
fn friction_and_modulus_come_back_on_every_profile() {
    for profile in profiles() {
        let bench = Bench { profile, ..Bench::default() };
        for share in [0.6, 1.4] {
            let amplitude = share * bench.gross_slip();
            for record in [bench.virgin(amplitude, 300, 1.25), bench.steady(amplitude, 300)] {
                let mut task = bench.task(vec![record], &[Parameter::Friction, Parameter::GStar]);
                task.known = vec![rigid()];
                // A flat punch either sticks or slides: below gross slip its loop has no friction.
                let slides = share > 1.0 || !matches!(bench.profile, Profile::FlatPunch(_));
                if !slides {
                    task.free = vec![Parameter::GStar];
                    task.contact = bench.contact();
                }
                let found = fit(&task, &|| true).unwrap();
                for estimate in &found.estimates {
                    let truth = if estimate.parameter == Parameter::Friction { 0.42 } else { 7e10 };
                    let error = (estimate.value / truth - 1.0).abs();
                    assert!(error < 1e-9, "{:?} at {share}: {estimate:?}, off by {error:e}", bench.profile);
                }
                assert_eq!(found.notes.contains(&Note::PartialSlipOnly), share < 1.0);
            }
        }
    }
}

#[test]
fn six_parameters_of_a_bench_are_recovered() {
    let bench = Bench { compliance: 3e-8, offsets: [2e-8, 0.05], drift: 1e-12, ..Bench::default() };
    for share in [0.6, 1.5] {
        let record = bench.virgin(share * bench.gross_slip(), 500, 2.25);
        let free = [
            Parameter::Friction,
            Parameter::GStar,
            Parameter::MachineCompliance,
            Parameter::DisplacementOffset,
            Parameter::ForceOffset,
            Parameter::Drift,
        ];
        let found = fit(&bench.task(vec![record], &free), &|| true).unwrap();
        for (estimate, truth) in found.estimates.iter().zip([0.42, 7e10, 3e-8, 2e-8, 0.05, 1e-12]) {
            assert!((estimate.value / truth - 1.0).abs() < 1e-8, "{estimate:?}");
        }
        assert!((found.contact.friction() / 0.42 - 1.0).abs() < 1e-8);
    }
}

/// In partial slip one load leaves the machine open; the stiffness of a ball goes with the root of the third degree of
/// the load, that of a machine not at all.
#[test]
fn two_loads_separate_the_contact_from_its_machine() {
    let light = Bench { compliance: 3e-8, ..Bench::default() };
    let heavy = Bench { normal_force: 80.0, ..light.clone() };
    let mut records = vec![light.steady(0.5 * light.gross_slip(), 300), heavy.steady(0.5 * heavy.gross_slip(), 300)];
    let free = [Parameter::Friction, Parameter::GStar, Parameter::MachineCompliance];
    // One newton in a hundred, with alternating sign, stands for noise.
    for record in &mut records {
        let unit = if record.normal_force == Some(10.0) { 0.03 } else { 0.24 };
        record.force.iter_mut().zip(0..).for_each(|(force, place)| *force += [unit, -unit][place % 2]);
    }
    let error = |records: &[Record]| {
        let found = fit(&light.task(records.to_vec(), &free), &|| true).unwrap();
        found.estimates[2].standard_error.unwrap() / 3e-8
    };
    let (one, both) = (error(&records[..1]), error(&records));
    assert!(both < 0.2 * one, "{one} and {both}");
}

#[test]
fn the_radius_and_the_reduced_modulus_take_the_part_of_the_shear_modulus() {
    let bench = Bench { g_star: 8.5e10, ..Bench::default() };
    let record = bench.virgin(1.3 * bench.gross_slip(), 300, 1.25);
    let mut task = bench.task(vec![record], &[Parameter::Friction, Parameter::Radius]);
    task.known = vec![rigid()];
    let wrong = Bench { profile: Profile::Sphere(Sphere::new(0.014).unwrap()), friction: 0.3, ..bench.clone() };
    task.contact = wrong.contact();
    let found = fit(&task, &|| true).unwrap();
    assert!((found.estimates[1].value / 0.01 - 1.0).abs() < 1e-9, "{:?}", found.estimates);
    assert!((found.contact.contact_radius() / bench.contact().contact_radius() - 1.0).abs() < 1e-9);
    // G* (R/E*)^(1/3) is what counts: with R too large by 1.4, E* comes out too large by 1.4.
    task.free = vec![Parameter::Friction, Parameter::EStar];
    let found = fit(&task, &|| true).unwrap();
    assert!((found.estimates[1].value / (1.4 * E_STAR) - 1.0).abs() < 1e-9, "{:?}", found.estimates);
}

#[test]
fn what_is_known_counts_as_one_more_measurement() {
    let bench = Bench { compliance: 3e-8, ..Bench::default() };
    let record = bench.steady(0.6 * bench.gross_slip(), 300);
    let mut task = bench.task(vec![record], &[Parameter::Friction, Parameter::GStar]);
    task.noise.force = Some(0.04);
    let known = Known { parameter: Parameter::MachineCompliance, value: 3e-8, standard_error: 3e-9 };
    task.known = vec![known];
    let found = fit(&task, &|| true).unwrap();
    let compliance = found.estimates[2];
    assert_eq!(compliance.parameter, Parameter::MachineCompliance);
    assert!((compliance.value / 3e-8 - 1.0).abs() < 1e-6 && compliance.standard_error.unwrap() <= 3e-9);
    assert!(!found.notes.contains(&Note::MachineComplianceUnknown));
    // Held, the others are known better.
    task.known[0].standard_error = 0.0;
    let held = fit(&task, &|| true).unwrap();
    assert!(held.estimates[1].standard_error.unwrap() < found.estimates[1].standard_error.unwrap());
}

/// A triangle that is smaller each time, and a record of many equal cycles that begins and ends anywhere.
#[test]
fn loops_need_not_be_one_cycle() {
    let bench = Bench::default();
    let unit = bench.gross_slip();
    let corners = [0.0, 1.2, -0.9, 0.7, -0.5, 0.3, -0.1];
    let falling = corners
        .windows(2)
        .flat_map(|ends| (0..60).map(move |step| ends[0] + (ends[1] - ends[0]) * f64::from(step) / 60.0));
    let falling = bench.record(falling.map(|place| place * unit), Start::Virgin);
    let cycles = (0..1500).map(|point| 0.9 * unit * (0.3 + f64::from(point) * 0.0513).sin());
    let mut many = bench.record(cycles, Start::Steady);
    for column in [&mut many.displacement, &mut many.force, many.time.as_mut().unwrap()] {
        column.drain(..211);
    }
    // What came before the second record is known up to where its points missed the turning points.
    for (record, tolerance) in [(falling, 1e-9), (many, 1e-5)] {
        let mut task = bench.task(vec![record], &[Parameter::Friction, Parameter::GStar, Parameter::ForceOffset]);
        task.known = vec![rigid()];
        let found = fit(&task, &|| true).unwrap();
        assert!((found.estimates[0].value / 0.42 - 1.0).abs() < tolerance, "{:?}", found.estimates);
        assert!((found.estimates[1].value / 7e10 - 1.0).abs() < tolerance, "{:?}", found.estimates);
    }
}
