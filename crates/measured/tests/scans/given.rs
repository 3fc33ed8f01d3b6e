//! Scans that were fitted wrongly: what they say now.

use stickslip_measured::scan::{Options, Scan, ScanFit};
use stickslip_mechanics::Preload;

use crate::steel;
use crate::synthetic::{Shape, normal};

/// The two columns of a file, in micrometres and nanometres.
fn scan(text: &str) -> Vec<[f64; 2]> {
    let numbers = |line: &str| line.split(',').map(|number| number.parse::<f64>().unwrap()).collect::<Vec<_>>();
    text.lines().skip(1).map(numbers).map(|row| [1e-6 * row[0], 1e-9 * row[1]]).collect()
}

fn fit(points: impl IntoIterator<Item = [f64; 2]>) -> ScanFit {
    ScanFit::new(&Scan::line(points), &Options::default(), &|| true).unwrap()
}

#[test]
fn a_tilted_punch_has_its_axis_between_its_flanks() {
    // With a tilt any axis on a parabolic flank fits: one was found 75 um beside the punch, and 113.1(1) nm.
    let fit = fit(scan(include_str!("data/punch_tilted.csv")));
    let contact = fit.contact(steel(), 0.3, Preload::NormalForce(1.501_452_899_220_043_3)).unwrap();
    assert!((contact.indentation.value - 64.84e-9).abs() < 3.0 * contact.indentation.standard_error, "{contact:?}");
    assert!(contact.indentation.standard_error < 2e-9, "{contact:?}");
    assert!((fit.centre[0] - 6.124e-6).abs() < 1e-6 && (fit.tilt[0].abs() - 1.214e-3).abs() < 2e-5, "{:?}", fit.tilt);
}

#[test]
fn the_tilt_of_a_hyperboloid_is_taken_off() {
    // The tilt was left in, with a residual of 14 nm where the noise is 0.19 nm.
    let fit = fit(scan(include_str!("data/hyper_tilted.csv")));
    assert!((fit.centre[0] + 5.733e-6).abs() < 1e-6 && (fit.tilt[0].abs() - 1.627e-3).abs() < 2e-5, "{:?}", fit.tilt);
    assert!(fit.rms < 4e-10, "{}", fit.rms);
}

#[test]
fn a_dropout_anywhere_changes_nothing() {
    // A ball of 8 mm: one height, a tenth and a third of the heights are dropouts, at fill values and at others.
    let ball = |count: usize| {
        let at = move |index: usize| 1.2e-4 * (index as f64 / (count - 1) as f64 - 0.5);
        let noise = |index: usize| 0.3e-9 * (((index * 7919) % 101) as f64 / 50.0 - 1.0);
        (0..count).map(move |index| [at(index), noise(index) - at(index).powi(2) / 0.016])
    };
    let mut random = fastrand::Rng::with_seed(3);
    for count in [25, 51, 201] {
        for height in [-9.999e-6_f64, -3e-6, 5e-7, -2e-7] {
            for share in [0.0, 0.1, 1.0 / 3.0] {
                // A third of heights like those of the surface, and of few points, is part of it.
                if share > 0.2 && (count < 100 || height.abs() < 1e-6) {
                    continue;
                }
                let mut points: Vec<[f64; 2]> = ball(count).collect();
                let one = random.usize(..count);
                for (index, point) in points.iter_mut().enumerate() {
                    if index == one || random.f64() < share {
                        point[1] = height;
                    }
                }
                let fit = fit(points);
                let radius = fit.radius_of_curvature.unwrap();
                let off = (radius.value - 8e-3).abs();
                let case = format!("{count} {height} {share}: {radius:?} {} {}", fit.outliers, fit.fill_values);
                assert!(off < 4.0 * radius.standard_error + 1e-5 && radius.standard_error < 1e-3, "{case}");
            }
        }
    }
}

#[test]
fn fill_values_are_counted_as_missing_heights() {
    let dropped = |height: f64| {
        let mut points = scan(include_str!("data/punch_tilted.csv"));
        (0..points.len()).step_by(9).for_each(|index| points[index][1] = height);
        fit(points)
    };
    for height in [-9.999e-6_f64, -3.2768e-5, 3.2767e-5, 1e30, f64::INFINITY] {
        let fit = dropped(height);
        assert_eq!((fit.fill_values, fit.used, fit.outliers), (23, 183, 0), "{height}");
    }
}

#[test]
fn a_ball_that_was_scanned_on_one_side_keeps_its_axis() {
    let mut random = fastrand::Rng::with_seed(5);
    let at = |index: usize| 1e-6 * (index as f64 - 20.0);
    let points = (0..401).map(|index| [at(index), at(index).powi(2) / 0.02 + 1e-9 * normal(&mut random)]);
    let fit = fit(points);
    assert!(fit.centre[0].abs() < 1e-6 && fit.tilt[0].abs() <= 0.0, "{:?} {:?}", fit.centre, fit.tilt);
    assert!((fit.overlap - 0.1).abs() < 0.01, "{}", fit.overlap);
}

#[test]
fn what_was_fitted_and_the_profile_have_one_zero() {
    for shape in [Shape::Ball(0.01), Shape::WornBall(0.01, 4e-5, 1e-5), Shape::Punch(6e-5, 5e-3)] {
        let mut random = fastrand::Rng::with_seed(8);
        let at = |index: usize| 2e-4 * (index as f64 / 500.0 - 1.0);
        let fit = fit((0..1001).map(|index| [at(index), shape.height(at(index).abs()) + 3e-9 * normal(&mut random)]));
        let (radius, height) = (&fit.table.radius, &fit.table.height);
        let profile = |r: f64| {
            let above = radius.partition_point(|at| *at < r).clamp(1, radius.len() - 1);
            let share = (r - radius[above - 1]) / (radius[above] - radius[above - 1]);
            height[above - 1] + share * (height[above] - height[above - 1])
        };
        let raw = &fit.raw;
        let off =
            raw.radius.iter().zip(&raw.height).map(|(r, z)| z - profile(*r)).sum::<f64>() / raw.radius.len() as f64;
        assert!(off.abs() < 0.05 * fit.rms, "{shape:?}: {off} of {}", fit.rms);
    }
}
