//! What is wrong with a record is said, and outliers, noise of the displacement and excess are borne.

use proptest::prelude::*;
use stickslip_measured::loops::{Error, Known, MOST_POINTS, Note, Parameter, Record, Start, fit};
use stickslip_mechanics::profile::{Cone, Profile};

use crate::bench::{Bench, Normal, rigid};

const FREE: [Parameter; 2] = [Parameter::Friction, Parameter::GStar];

fn refused(bench: &Bench, record: Record, free: &[Parameter]) -> Error {
    fit(&bench.task(vec![record], free), &|| true).unwrap_err()
}

#[test]
fn a_record_that_is_no_loop_is_refused_by_what_it_lacks() {
    let bench = Bench::default();
    let good = bench.virgin(1.2 * bench.gross_slip(), 200, 1.25);
    let swapped = Record { displacement: good.force.clone(), force: good.displacement.clone(), ..good.clone() };
    // In units in which both columns have the size of the other one, only the sense of the loop betrays them.
    let ratio = 4.2 / (1.2 * bench.gross_slip());
    let scaled = Record {
        displacement: swapped.displacement.iter().map(|value| value / ratio).collect(),
        force: swapped.force.iter().map(|value| value * ratio).collect(),
        ..good.clone()
    };
    assert!(matches!(refused(&bench, scaled, &FREE), Error::WrongWay { record: 0, .. }));
    let times = |column: &[f64], factor: f64| column.iter().map(|value| value * factor).collect::<Vec<_>>();
    let mirrored = Record { force: times(&good.force, -1.0), ..good.clone() };
    assert!(matches!(refused(&bench, mirrored, &FREE), Error::WrongWay { .. }));
    let metres = Record { displacement: times(&good.displacement, 1e3), ..good.clone() };
    assert!(matches!(refused(&bench, metres, &FREE), Error::StiffnessUnit { .. }));
    let nanometres = Record { displacement: times(&good.displacement, 1e-3), ..good.clone() };
    assert!(matches!(refused(&bench, nanometres, &FREE), Error::StiffnessUnit { .. }));
    let kilonewtons = Record { force: times(&good.force, 1e3), ..good.clone() };
    assert!(matches!(refused(&bench, kilonewtons, &FREE), Error::ForceUnit { .. }));
    let millinewtons = Record { force: times(&good.force, 1e-3), ..good.clone() };
    assert!(matches!(refused(&bench, millinewtons, &FREE), Error::StiffnessUnit { .. }));
    let branch = bench.virgin(1.2 * bench.gross_slip(), 50, 0.24);
    assert!(matches!(refused(&bench, branch, &FREE), Error::SingleBranch { .. }));
    let flat = Record { force: vec![1.0; 200], ..good.clone() };
    assert!(matches!(refused(&bench, flat, &FREE), Error::ConstantForce { .. }));
    let still = Record { displacement: vec![1.0; 200], ..good.clone() };
    assert!(matches!(refused(&bench, still, &FREE), Error::ConstantDisplacement { .. }));
    let short = Record { force: good.force[..150].to_vec(), ..good.clone() };
    assert!(matches!(refused(&bench, short, &FREE), Error::TooFewPoints { .. }));
    let timeless = Record { time: None, ..good.clone() };
    assert!(matches!(refused(&bench, timeless, &[Parameter::Drift]), Error::NoTime { .. }));
    let both = refused(&bench, good.clone(), &[Parameter::GStar, Parameter::Radius]);
    assert!(both.to_string().contains("`g_star * (radius/e_star)^(1/3)`"), "{both}");
    let cone = Bench { profile: Profile::Cone(Cone::new(0.01).unwrap()), ..bench.clone() };
    let parameter = Parameter::Radius;
    assert_eq!(refused(&cone, good.clone(), &[parameter]), Error::NotOfProfile { parameter });
    let stopped = fit(&bench.task(vec![good], &FREE), &|| false).unwrap_err();
    assert_eq!(stopped, Error::Interrupted);
}

/// The force of a record with its sign, from its magnitude: against the motion from each turn to the next zero.
fn signed(record: &Record) -> Record {
    let Record { displacement, force, .. } = record;
    let rises: Vec<bool> =
        (0..force.len()).map(|place| displacement[place.max(1)] > displacement[place.max(1) - 1]).collect();
    let largest = force.iter().copied().fold(0.0, f64::max);
    let mut signed = Vec::with_capacity(force.len());
    for branch in rises.chunk_by(|one, next| one == next) {
        let forces = &force[signed.len()..signed.len() + branch.len()];
        let least = (0..forces.len()).min_by(|a, b| forces[*a].total_cmp(&forces[*b])).unwrap();
        let zero = if forces[least] < 0.3 * largest { least } else { 0 };
        let sign = |place: usize| if branch[0] == (place >= zero) { 1.0 } else { -1.0 };
        signed.extend(forces.iter().enumerate().map(|(place, force)| sign(place) * force));
    }
    Record { force: signed, ..record.clone() }
}

/// Tribometers log the magnitude of the force beside the coefficient of friction. With its sign it is fitted as the
/// loop is, and a loop of one sign, by an offset, is no magnitude.
#[test]
fn a_rectified_force_is_refused_and_fitted_with_its_sign() {
    for seed in 0..24 {
        let mut random = fastrand::Rng::with_seed(seed);
        let bench = Bench {
            compliance: [0.0, 3e-8][random.usize(..2)],
            offsets: [random.f64() * 1e-7, 0.1 * random.f64()],
            ..Bench::default()
        };
        let reach = [0.4, 0.8, 1.2, 2.0, 5.0, 60.0][random.usize(..6)];
        let amplitude = reach * bench.gross_slip();
        let mut loop_of = if random.bool() { bench.virgin(amplitude, 600, 2.25) } else { bench.steady(amplitude, 400) };
        let largest = loop_of.force.iter().fold(0.0, |most: f64, force| most.max(force.abs()));
        let size = largest * [0.0, 0.005, 0.02][random.usize(..3)];
        let mut normal = Normal(fastrand::Rng::with_seed(seed));
        loop_of.force.iter_mut().for_each(|force| *force += size * normal.next());
        let fitted = |record: Record| {
            let mut task = bench.task(vec![record], &FREE);
            task.known = vec![Known { value: bench.compliance, ..rigid() }];
            fit(&task, &|| true)
        };
        let expected = fitted(loop_of.clone()).unwrap();
        for sign in [1.0, -1.0] {
            let magnitude = loop_of.force.iter().map(|force| sign * force.abs()).collect();
            let error =
                fitted(Record { force: magnitude, ..loop_of.clone() }).map(|found| found.estimates).unwrap_err();
            assert_eq!(error, Error::Rectified { record: 0 }, "seed {seed}, {reach}, {size}");
            assert!(error.to_string().contains("Give the signed force"));
        }
        let magnitude = Record { force: loop_of.force.iter().map(|force| force.abs()).collect(), ..loop_of.clone() };
        let found = fitted(signed(&magnitude)).unwrap();
        for (found, expected) in found.estimates.iter().zip(&expected.estimates) {
            let near = 2.0 * expected.standard_error.unwrap() + 0.02 * expected.value;
            assert!((found.value - expected.value).abs() < near, "seed {seed}: {found:?} {expected:?}");
        }
        // A loop of one sign, beside zero or far from it, with noise of a third of the loop.
        let lift = [1.0, 1.2, 4.0][random.usize(..3)] * largest;
        let lifted = loop_of.force.iter().map(|force| force + lift + largest / 6.0 * normal.next()).collect();
        let fitted = fitted(Record { force: lifted, ..loop_of.clone() });
        assert!(!matches!(fitted, Err(Error::Rectified { .. })), "seed {seed}: {lift}");
    }
}

/// One point in fifty is anywhere.
#[test]
fn outliers_are_left_out_and_counted() {
    let bench = Bench::default();
    let mut normal = Normal(fastrand::Rng::with_seed(5));
    let mut record = bench.virgin(1.3 * bench.gross_slip(), 500, 1.25);
    for (place, force) in record.force.iter_mut().enumerate() {
        *force += 0.01 * normal.next() + if place % 50 == 7 { 3.0 * normal.next().signum() } else { 0.0 };
    }
    let mut task = bench.task(vec![record], &FREE);
    task.known = vec![rigid()];
    let found = fit(&task, &|| true).unwrap();
    assert!((found.residual.outliers - 0.02).abs() < 0.003, "{:?}", found.residual);
    assert!((found.noise[0] / 0.01 - 1.0).abs() < 0.1, "{:?}", found.noise);
    for (estimate, truth) in found.estimates.iter().zip([0.42, 7e10]) {
        assert!((estimate.value - truth).abs() < 4.0 * estimate.standard_error.unwrap(), "{estimate:?}");
    }
}

/// A displacement that is noisy turns back and forth all the time; the loop is found in it, and its turning points are
/// refined.
#[test]
fn turning_points_are_found_in_a_noisy_displacement() {
    let bench = Bench::default();
    let size = 0.005 * bench.gross_slip();
    for seed in 0..10 {
        let mut normal = Normal(fastrand::Rng::with_seed(seed));
        let mut record = bench.virgin(1.3 * bench.gross_slip(), 1000, 2.25);
        record.displacement.iter_mut().for_each(|place| *place += size * normal.next());
        record.force.iter_mut().for_each(|force| *force += 0.005 * normal.next());
        let mut task = bench.task(vec![record], &FREE);
        task.known = vec![rigid()];
        let found = fit(&task, &|| true).unwrap();
        assert_eq!(found.curves[0].branch.last(), Some(&4));
        assert!((found.noise[1] / size - 1.0).abs() < 0.15, "{:?}", found.noise);
        for (estimate, truth) in found.estimates.iter().zip([0.42, 7e10]) {
            let error = (estimate.value - truth) / estimate.standard_error.unwrap();
            assert!(error.abs() < 4.0, "seed {seed}: {estimate:?}, off by {error}");
            assert!(estimate.standard_error.unwrap() < 0.02 * truth);
        }
    }
}

#[test]
fn a_million_points_are_thinned_and_gaps_are_no_matter() {
    let bench = Bench::default();
    let mut record = bench.virgin(1.3 * bench.gross_slip(), 200_000, 1.25);
    // A sensor was away for a while.
    for column in [&mut record.displacement, &mut record.force, record.time.as_mut().unwrap()] {
        column.drain(60_000..75_000);
    }
    let mut task = bench.task(vec![record], &FREE);
    task.known = vec![rigid()];
    let found = fit(&task, &|| true).unwrap();
    assert!(found.curves[0].displacement.len() <= MOST_POINTS + 2);
    assert!((found.estimates[0].value / 0.42 - 1.0).abs() < 1e-9);
}

#[test]
fn friction_that_grows_with_the_velocity_is_not_coulombs() {
    let bench = Bench::default();
    let amplitude = 3.0 * bench.gross_slip();
    let mut record = bench.virgin(amplitude, 500, 1.25);
    let mut normal = Normal(fastrand::Rng::with_seed(3));
    for (force, phase) in record.force.iter_mut().zip(0..) {
        *force += 0.3 * (std::f64::consts::TAU * 1.25 * f64::from(phase) / 500.0).cos() + 0.01 * normal.next();
    }
    let mut task = bench.task(vec![record], &FREE);
    task.known = vec![rigid()];
    let found = fit(&task, &|| true).unwrap();
    assert!(found.notes.contains(&Note::NotCoulomb), "{:?}", found.residual);
    // An offset that a steady loop does not have, and a way of which hardly any point sticks.
    let record = bench.steady(60.0 * bench.gross_slip(), 500);
    let mut task = bench.task(vec![record], &[Parameter::Friction, Parameter::GStar, Parameter::DisplacementOffset]);
    task.known = vec![rigid()];
    let found = fit(&task, &|| true).unwrap();
    assert_eq!(found.notes, [Note::BeyondGrossSlip, Note::FirstBranchUnknown]);
    assert_eq!(found.estimates[2].standard_error, None);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    /// Whatever the columns are, there is an answer or a refusal, and every number of an answer is finite.
    #[test]
    fn random_columns_give_a_fit_or_a_refusal(
        columns in prop::collection::vec((-1.0..1.0_f64, -1.0..1.0_f64), 0..60),
        scales in (-9.0..-5.0_f64, -2.0..2.0_f64),
        sought in prop::sample::subsequence(
            vec![Parameter::Friction, Parameter::GStar, Parameter::MachineCompliance, Parameter::DisplacementOffset,
                Parameter::ForceOffset, Parameter::Drift], 1..=6),
        virgin in any::<bool>(),
    ) {
        let bench = Bench::default();
        let scale = (10.0_f64.powf(scales.0), 10.0_f64.powf(scales.1));
        let (displacement, force) = columns.iter().map(|(u, f)| (u * scale.0, f * scale.1)).unzip();
        let time = Some((0..columns.len()).map(|place| place as f64).collect());
        let start = Some(if virgin { Start::Virgin } else { Start::Steady });
        let record = Record { displacement, force, time, normal_force: None, start, weight: 1.0 };
        if let Ok(found) = fit(&bench.task(vec![record], &sought), &|| true) {
            for estimate in found.estimates {
                prop_assert!(estimate.value.is_finite());
                prop_assert!(estimate.standard_error.is_none_or(f64::is_finite));
                prop_assert!(estimate.interval.iter().flatten().all(|end| end.is_finite()));
            }
            prop_assert!(found.residual.rms.is_finite());
            prop_assert!(found.curves[0].fitted.iter().all(|force| force.is_finite()));
        }
    }
}
