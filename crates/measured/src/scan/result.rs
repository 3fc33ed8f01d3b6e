//! The fit in metres: its table, its covariance, and what is left of the scan.

use nalgebra::DMatrix;
use stickslip_mechanics::profile::{Profile, Tabulated};

use super::curve::Curve;
use super::fit::{Fitted, Scaled};
use super::{Column, DRAWN_POINTS, Error, Estimate, Orientation, Scan, ScanFit, Units, noise, programme};
use crate::linear::dot;

/// Parabolas added to a curve whose table does not rise, as shares of its mean curvature.
const LIFTS: [f64; 8] = [0.0, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1];
/// Intervals between neighbouring points of the table.
const TABLE_STEP: f64 = 0.5;

/// The fit in m, with its table.
pub(super) fn finished(scan: &Scan, fitted: &Fitted, scaled: &Scaled, units: &Units) -> Result<ScanFit, Error> {
    let Fitted { equations, solution, parabola, .. } = fitted;
    let unknowns = programme::constrained(equations, solution, *parabola);
    let unknowns = unknowns.unwrap_or_else(|| solution.unknowns.clone());
    let constrained = unknowns != solution.unknowns;
    let bend = units.height / (units.length * units.length);
    let curve = equations.curve(&unknowns, *parabola);
    let curvatures: Vec<f64> = curve.curvatures.iter().map(|curvature| curvature * bend).collect();
    let width = curve.width * units.length;
    let reach = width * curvatures.len() as f64;
    let mean = 2.0 * (curve.height(curve.end()) - curve.offset) / curve.end().powi(2) * bend;
    if mean * reach * reach <= 0.0 {
        return Err(Error::Hollow);
    }
    let (table, profile, curve) = table(width, &curvatures, mean)?;
    let intervals = curvatures.len();
    let variance = fitted.variance * fitted.inflation * bend * bend;
    let systematic = equations.systematic(solution);
    let covariance = DMatrix::from_fn(intervals, intervals, |row, column| {
        let off: f64 = systematic.iter().map(|off| off[row] * off[column]).sum();
        variance * solution.inverse[(row, column)] + bend * bend * off
    });
    let apex = Estimate { value: curvatures[0], standard_error: covariance[(0, 0)].sqrt() };
    let radius_of_curvature = (apex.value > 0.0 && apex.value * apex.value > covariance[(0, 0)])
        .then(|| Estimate { value: 1.0 / apex.value, standard_error: apex.standard_error / (apex.value * apex.value) });
    let (raw, left_out) = drawn(fitted, scaled, units);
    let residuals: Vec<f64> =
        fitted.residuals.iter().zip(&fitted.kept).filter(|(_, kept)| **kept).map(|(e, _)| *e).collect();
    let sign = if units.orientation == Orientation::PeakDown { 1.0 } else { -1.0 };
    Ok(ScanFit {
        table,
        radius_of_curvature,
        centre: [0, 1].map(|axis| units.middle[axis] + fitted.axis[axis] * units.length),
        tilt: fitted.tilt.map(|tilt| sign * tilt * units.height / units.length),
        orientation: units.orientation,
        rms: (dot(&residuals, &residuals) / residuals.len() as f64).sqrt() * units.height,
        correlation_length: noise::correlation_lag(&residuals) * step(scan),
        used: fitted.kept.len(),
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

/// The table of a curve, and the profile that it makes. The mechanics draws a curve of its own through the points: where g hardly
/// rises, that of the table may fall, and a small parabola lifts it.
fn table(width: f64, curvatures: &[f64], mean: f64) -> Result<(Column, Profile, Curve), Error> {
    let mut refused = Error::Rough;
    for lift in LIFTS {
        let curve = Curve::new(width, curvatures.iter().map(|curvature| curvature + lift * mean).collect(), 0.0);
        let radius: Vec<f64> = (0..=2 * curvatures.len()).map(|index| index as f64 * TABLE_STEP * width).collect();
        let height: Vec<f64> = radius.iter().map(|&r| curve.height(r)).collect();
        let end = radius[radius.len() - 1];
        match Tabulated::new(&radius, &height).map(Profile::Tabulated) {
            Ok(profile) if profile.check_radius(end * (1.0 - 1e-9)).is_ok() => {
                return Ok((Column { radius, height }, profile, curve));
            }
            Ok(_)
            | Err(stickslip_mechanics::Error::NotConvexEnough { .. } | stickslip_mechanics::Error::Table { .. }) => {}
            Err(error) => refused = error.into(),
        }
    }
    Err(refused)
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

/// The points as the curve sees them, fitted and left out.
fn drawn(fitted: &Fitted, scaled: &Scaled, units: &Units) -> (Column, Column) {
    let column = |wanted: bool| {
        let mut chosen: Vec<[f64; 2]> = scaled
            .points
            .iter()
            .zip(fitted.residuals.iter().zip(&fitted.kept))
            .filter(|(_, (_, kept))| **kept == wanted)
            .map(|(point, (residual, _))| {
                let r = (point[0] - fitted.axis[0]).hypot(point[1] - fitted.axis[1]);
                [r * units.length, (fitted.curve.height(r) - fitted.curve.offset + residual) * units.height]
            })
            .collect();
        chosen.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let stride = chosen.len().div_ceil(DRAWN_POINTS).max(1);
        let kept: Vec<&[f64; 2]> = chosen.iter().step_by(stride).collect();
        Column {
            radius: kept.iter().map(|point| point[0]).collect(),
            height: kept.iter().map(|point| point[1]).collect(),
        }
    };
    (column(true), column(false))
}
