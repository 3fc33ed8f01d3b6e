//! The fit in metres: its table, its covariance, and what is left of the scan.

use nalgebra::DMatrix;
use stickslip_mechanics::profile::{Profile, Tabulated};

use super::curve::{Curve, interval};
use super::diagnosis::Diagnosis;
use super::fit::{Fitted, Scaled};
use super::{
    Column, DRAWN_POINTS, Error, Estimate, Orientation, Scan, ScanFit, Units, contact, correlated_noise, noise,
    programme, start,
};
use crate::linear::dot;
use crate::steps::step as rounding_step;

/// The least g'(x)/x over its mean, as much as the table needs to rise.
const FLOORS: [f64; 10] = [1e-6, 1e-5, 1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 3e-2, 0.1, 0.3];
/// Steps of the heights below this share of their range, or of less than the residual over this, do not matter.
const LEAST_STEP: f64 = 2e-3;
const MOST_RESIDUAL: f64 = 0.7;
/// The share of the parabola of the mean curvature in the curve, where no floor makes the table rise.
/// The last is the parabola itself, which rises, with errors as large as the difference.
const SHARES: [f64; 7] = [0.01, 0.03, 0.1, 0.3, 0.6, 0.9, 1.0];
/// How many of the shares a curve of a number of intervals that was asked for may have.
const SHARES_OF_KNOTS: usize = 5;

/// The fit in m, with its table.
pub(super) fn finished(
    scan: &Scan,
    (fitted, other): (&Fitted, Option<&Fitted>),
    (scaled, units): (&Scaled, &Units),
    smooths: bool,
) -> Result<ScanFit, Error> {
    let Fitted { equations, solution, parabola, .. } = fitted;
    let bend = units.height / (units.length * units.length);
    let breaks: Vec<f64> = fitted.curve.breaks.iter().map(|radius| radius * units.length).collect();
    let (end, intervals) = (fitted.curve.end(), equations.intervals);
    let mean = 2.0 * (fitted.curve.height(end) - fitted.curve.offset) / (end * end);
    if mean <= 0.0 {
        return Err(Error::Hollow);
    }
    let rising = |floor: f64| {
        let unknowns = programme::constrained(equations, solution, *parabola - floor * mean);
        unknowns.unwrap_or_else(|| solution.unknowns.clone())
    };
    let unknowns = rising(0.0);
    let constrained = unknowns != solution.unknowns;
    // The mechanics draws a curve of its own through the table: where g hardly rises, that of the table may fall.
    let evened = |share: f64| {
        let mut evened = unknowns.clone();
        evened[..intervals].iter_mut().for_each(|curvature| *curvature += share * (mean - *parabola - *curvature));
        evened
    };
    let shares = if smooths { SHARES.len() } else { SHARES_OF_KNOTS };
    let evened = SHARES.into_iter().take(shares).map(evened);
    let candidates = std::iter::once(unknowns.clone()).chain(FLOORS.into_iter().map(rising)).chain(evened);
    let (mut made, mut lifted) = (None, unknowns.clone());
    for candidate in candidates {
        lifted = candidate;
        let curvatures = lifted[..intervals].iter().map(|curvature| (curvature + parabola) * bend).collect();
        made = table(Curve::new(breaks.clone(), curvatures, 0.0))?;
        if made.is_some() {
            break;
        }
    }
    let (table, profile, curve) = made.ok_or(Error::Rough)?;
    let variance = fitted.variance * fitted.inflation * bend * bend;
    // What the curvatures would change by with other intervals, another penalty, and without the lift.
    let lift = lifted.iter().zip(&unknowns).map(|(lifted, plain)| lifted - plain).collect();
    // About another axis that the scan does not exclude they are others.
    let about_other = |other: &Fitted| {
        let of = |place: usize| {
            let middle = 0.5 * (fitted.curve.breaks[place] + fitted.curve.breaks[place + 1]);
            other.curve.curvatures[interval(&other.curve.breaks, middle)] - fitted.curve.curvatures[place]
        };
        (0..intervals).map(of).collect::<Vec<f64>>()
    };
    let by_axis = other.map_or_else(|| vec![0.0; intervals], about_other);
    let systematic = [equations.change_of_halving(solution), fitted.without_scale.clone(), lift, by_axis];
    let by_correlation = correlated_noise::covariance(fitted, scaled);
    let covariance = DMatrix::from_fn(intervals, intervals, |row, column| {
        let off: f64 = systematic.iter().map(|off: &Vec<f64>| off[row] * off[column]).sum();
        let correlated = by_correlation.as_ref().map_or(0.0, |covariance| covariance[(row, column)]);
        variance * solution.inverse[(row, column)] + bend * bend * (off + correlated)
    });
    let standard_errors = contact::standard_errors(&curve, &covariance, &table.radius)?;
    // The radius of the curve that the scan shows: a tip too small for it could have any.
    let sharper = bend * fitted.without_scale[0];
    let variance_at_apex = (covariance[(0, 0)] - sharper * sharper).max(0.0);
    let apex = Estimate { value: curve.curvatures[0], standard_error: variance_at_apex.sqrt() };
    let radius_of_curvature = (apex.value > 0.0 && apex.value * apex.value > variance_at_apex)
        .then(|| Estimate { value: 1.0 / apex.value, standard_error: apex.standard_error / (apex.value * apex.value) });
    let (raw, left_out) = drawn(fitted, scaled, units, &curve);
    let residuals: Vec<f64> =
        fitted.residuals.iter().zip(&fitted.kept).filter(|(_, kept)| **kept).map(|(e, _)| *e).collect();
    let sign = if units.orientation == Orientation::PeakDown { 1.0 } else { -1.0 };
    let place = |axis: [f64; 2]| [0, 1].map(|index| units.middle[index] + axis[index] * units.length);
    let rms = (dot(&residuals, &residuals) / residuals.len() as f64).sqrt() * units.height;
    Ok(ScanFit {
        table,
        standard_errors,
        radius_of_curvature,
        centre: place(fitted.axis),
        tilt: fitted.tilt.map(|tilt| sign * tilt * units.height / units.length),
        orientation: units.orientation,
        rms,
        correlation_length: noise::correlation_lag(&residuals) * step(scan),
        used: fitted.kept.len(),
        fill_values: scan.fill_values,
        overlap: start::overlap(fitted.axis),
        outliers: fitted.kept.iter().filter(|kept| !**kept).count(),
        raw,
        left_out,
        g_margin: g_margin(&curve),
        constrained,
        other_axis: other.map(|other| place(other.axis)),
        height_step: height_step(scan, rms),
        diagnosis: Diagnosis::new(fitted, scaled, units),
        profile,
        curve,
        covariance,
    })
}

/// The table of a curve, with a point at the ends and the middle of each interval, and the profile that it makes;
/// `None` if that does not rise.
fn table(curve: Curve) -> Result<Option<(Column, Profile, Curve)>, Error> {
    use stickslip_mechanics::Error as Refusal;
    let halves = curve.breaks.windows(2).flat_map(|ends| [ends[0], 0.5 * (ends[0] + ends[1])]);
    let radius: Vec<f64> = halves.chain([curve.end()]).collect();
    let height: Vec<f64> = radius.iter().map(|&r| curve.height(r)).collect();
    match Tabulated::new(&radius, &height).map(Profile::Tabulated) {
        Ok(profile) if profile.indenter().check_radius(curve.end() * (1.0 - 1e-9)).is_ok() => {
            Ok(Some((Column { radius, height }, profile, curve)))
        }
        Ok(_) | Err(Refusal::NotConvexEnough { .. } | Refusal::Table { .. }) => Ok(None),
        Err(error) => Err(error.into()),
    }
}

/// The step of the heights, if it is not small beside the residual, nor beside the shape.
fn height_step(scan: &Scan, rms: f64) -> Option<f64> {
    let heights: Vec<f64> = scan.points.iter().map(|point| point[2]).collect();
    let (low, high) = heights.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), &z| (a.min(z), b.max(z)));
    rounding_step(&heights).filter(|step| *step > LEAST_STEP * (high - low) && rms < MOST_RESIDUAL * step)
}

/// The least g'(x)/x over the mean.
fn g_margin(curve: &Curve) -> f64 {
    let (count, end) = (4 * curve.curvatures.len(), curve.end());
    let ratios = (1..=count).map(|index| {
        let x = end * index as f64 / count as f64;
        (x, curve.g_slope(x) / x)
    });
    let (least, sum, all) = ratios
        .fold((f64::INFINITY, 0.0, 0.0), |(least, sum, all), (x, ratio)| (least.min(ratio), sum + ratio * x, all + x));
    (least * all / sum).max(0.0)
}

/// The median distance of neighbouring points, m.
fn step(scan: &Scan) -> f64 {
    let mut steps: Vec<f64> =
        scan.points.windows(2).map(|pair| (pair[1][0] - pair[0][0]).hypot(pair[1][1] - pair[0][1])).collect();
    let middle = steps.len() / 2;
    *steps.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// The points that were fitted and those left out, above the zero of the curve of the table: with the mean of the
/// heights that were fitted.
fn drawn(fitted: &Fitted, scaled: &Scaled, units: &Units, table: &Curve) -> (Column, Column) {
    let place = |(point, residual): (&[f64; 3], &f64)| {
        let r = (point[0] - fitted.axis[0]).hypot(point[1] - fitted.axis[1]);
        [r * units.length, (fitted.curve.height(r) + residual) * units.height]
    };
    let places: Vec<[f64; 2]> = scaled.points.iter().zip(&fitted.residuals).map(place).collect();
    let of = |wanted: bool| {
        let chosen = places.iter().zip(&fitted.kept).filter(move |(_, kept)| **kept == wanted);
        chosen.map(|(place, _)| *place).collect::<Vec<[f64; 2]>>()
    };
    let kept = of(true);
    let zero = kept.iter().map(|[r, height]| height - table.height(*r)).sum::<f64>() / kept.len() as f64;
    let column = |mut chosen: Vec<[f64; 2]>| {
        chosen.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let stride = chosen.len().div_ceil(DRAWN_POINTS).max(1);
        let (radius, height) = chosen.iter().step_by(stride).map(|[r, height]| (*r, height - zero)).unzip();
        Column { radius, height }
    };
    (column(kept), column(of(false)))
}
