//! The fit in metres: its table, its covariance, and what is left of the scan.

use nalgebra::DMatrix;
use stickslip_mechanics::profile::{Profile, Tabulated};

use super::curve::Curve;
use super::fit::{Fitted, Scaled};
use super::{
    Column, DRAWN_POINTS, Error, Estimate, Orientation, Scan, ScanFit, Units, contact, noise, programme, start,
};
use crate::linear::dot;

/// The least g'(x)/x over its mean, as much as the table needs to rise.
const FLOORS: [f64; 10] = [1e-6, 1e-5, 1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 3e-2, 0.1, 0.3];
/// The share of the parabola of the mean curvature in the curve, where no floor makes the table rise.
const SHARES: [f64; 5] = [0.01, 0.03, 0.1, 0.3, 0.6];

/// The fit in m, with its table.
pub(super) fn finished(scan: &Scan, fitted: &Fitted, scaled: &Scaled, units: &Units) -> Result<ScanFit, Error> {
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
    let candidates =
        std::iter::once(unknowns.clone()).chain(FLOORS.into_iter().map(rising)).chain(SHARES.into_iter().map(evened));
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
    let systematic = [equations.change_of_halving(solution), fitted.without_scale.clone(), lift];
    let covariance = DMatrix::from_fn(intervals, intervals, |row, column| {
        let off: f64 = systematic.iter().map(|off: &Vec<f64>| off[row] * off[column]).sum();
        variance * solution.inverse[(row, column)] + bend * bend * off
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
    Ok(ScanFit {
        table,
        standard_errors,
        radius_of_curvature,
        centre: [0, 1].map(|axis| units.middle[axis] + fitted.axis[axis] * units.length),
        tilt: fitted.tilt.map(|tilt| sign * tilt * units.height / units.length),
        orientation: units.orientation,
        rms: (dot(&residuals, &residuals) / residuals.len() as f64).sqrt() * units.height,
        correlation_length: noise::correlation_lag(&residuals) * step(scan),
        used: fitted.kept.len(),
        fill_values: scan.fill_values,
        overlap: start::overlap(fitted.axis),
        outliers: fitted.kept.iter().filter(|kept| !**kept).count(),
        raw,
        left_out,
        g_margin: g_margin(&curve),
        constrained,
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
