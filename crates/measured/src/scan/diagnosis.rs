//! Is the residual of a scan noise, and is the body one of revolution?
//!
//! Neighbours on a line tell the noise: where the residual is far larger than their differences, or the rows of a map
//! differ by more than their noise, or outliers lie side by side, there are steps, grains or rows that drift beside
//! one surface. About the axis of a body of revolution no residual goes with twice the angle: the terms (u^2 - v^2)/2
//! and u v, by least squares, are a second harmonic. A body that has one has the principal curvatures of a paraboloid
//! through all heights.

use nalgebra::{DMatrix, DVector, Matrix2, Vector2};

use super::fit::{Fitted, Scaled};
use super::noise::correlation_lag;
use super::{Estimate, Units, edges};
use crate::robust::{OUTLIER, robust_deviation};

/// A residual of so many times the noise of neighbours is not noise: noise that is correlated over nine points has
/// three times.
const MOST_RATIO: f64 = 4.0;
/// Residuals that are correlated over more points are not noise.
const MOST_LAG: f64 = 12.0;
/// Residuals below this share of the range of the heights are errors of the curve.
const LEAST_RESIDUAL: f64 = 3e-4;
/// The variance of the third differences of the means of neighbouring rows, over that of noise, beyond which rows
/// drift, and that of independent values of unit variance.
const MOST_DRIFT: f64 = 4.0;
const THIRD: f64 = 20.0;
/// Points that a row needs.
const ROW_POINTS: usize = 5;
/// Outliers side by side that are no accident, and how many times as many of such runs as by chance.
const CLUSTER: usize = 3;
const MORE_THAN_CHANCE: f64 = 5.0;
const FEWEST_CLUSTERS: usize = 2;
/// Standard errors beyond which a second harmonic is no accident, and its least share of the mean curvature.
const SIGNIFICANT: f64 = 5.0;
const LEAST_HARMONIC: f64 = 0.01;
/// Correlations of neighbours beyond so many standard errors are no accident.
const CORRELATED: f64 = 4.0;
/// Radii below this share of the other one are not those of a body of revolution, and a paraboloid fits better that
/// leaves less than this share of what the profile leaves.
const ROUND: f64 = 0.98;
const BETTER: f64 = 0.5;
/// Curvatures below this share of the other one, or so many standard errors, are those of a cylinder.
const STRAIGHT: f64 = 0.02;
const STRAIGHT_ERRORS: f64 = 3.0;
/// Terms up to the second order, and with those of the fourth.
const SECOND: usize = 6;
const FOURTH: usize = 11;
/// Rounds in which heights that are far off a paraboloid are left out.
const ROUNDS: usize = 5;

/// A body that is not one of revolution, by its principal radii of curvature.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Paraboloid {
    /// The smaller radius of curvature, m.
    pub short: Estimate,
    /// The larger, m; `None` of a cylinder.
    pub long: Option<Estimate>,
    /// From the x axis of the scan to the direction of the larger radius, degrees from 0 to 180.
    pub angle: f64,
    /// How far the map extends in that direction, m.
    pub extent: f64,
}

/// What the residual says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Diagnosis {
    /// Whether neighbouring residuals are independent, as of white noise; `None` if there are no neighbours.
    pub random: Option<bool>,
    /// The residual over the noise of neighbours, where steps, grains or rows that drift lie beside one surface.
    pub structure: Option<f64>,
    /// The largest step between neighbouring heights, in standard deviations of their noise, if it is the edge of a
    /// grain or a jump of the instrument.
    pub edge: Option<f64>,
    /// Whether it has a second harmonic about the axis; `None` of a line, which does not show it.
    pub second_harmonic: Option<bool>,
    /// The body by its second harmonic.
    pub paraboloid: Option<Paraboloid>,
}

impl Diagnosis {
    pub(super) fn new(fitted: &Fitted, scaled: &Scaled, units: &Units) -> Diagnosis {
        let neighbours = Neighbours::new(fitted, scaled);
        let mean = mean_curvature(fitted);
        let fitted_to_all = scaled.plane.then(|| paraboloid(scaled, units)).flatten();
        // Far from a body of revolution the axis of the profile may be anywhere: a paraboloid that fits better shows
        // it.
        let mut sizes: Vec<f64> =
            fitted.residuals.iter().zip(&scaled.of_surface).filter(|(_, of)| **of).map(|(e, _)| e.abs()).collect();
        let of_profile = robust_deviation(&mut sizes);
        let is_better = fitted_to_all.as_ref().is_some_and(|(body, deviation)| {
            let is_long = body.long.is_none_or(|long| body.short.value < ROUND * long.value);
            is_long && *deviation < BETTER * of_profile && of_profile > LEAST_RESIDUAL
        });
        let second_harmonic = scaled.plane.then(|| is_better || has_second_harmonic(fitted, scaled, mean));
        let paraboloid = fitted_to_all.filter(|_| second_harmonic == Some(true)).map(|(body, _)| body);
        // A second harmonic is structure too, with a name of its own, but none that goes from row to row.
        let structured = row_drift(fitted, scaled) > MOST_DRIFT
            || second_harmonic != Some(true) && (neighbours.is_structured() || has_clusters(fitted, scaled));
        let edge = edges::largest(fitted, scaled);
        Diagnosis {
            random: neighbours.random(),
            structure: structured.then(|| neighbours.ratio()),
            edge,
            second_harmonic,
            paraboloid,
        }
    }
}

fn mean_curvature(fitted: &Fitted) -> f64 {
    let end = fitted.curve.end();
    2.0 * (fitted.curve.height(end) - fitted.curve.offset) / (end * end)
}

/// Pairs of points side by side on a line or in a row of a map.
fn pairs(scaled: &Scaled) -> impl Iterator<Item = (usize, usize)> {
    let same_row = |place: &usize| scaled.points[*place][1].to_bits() == scaled.points[place + 1][1].to_bits();
    (0..scaled.points.len().saturating_sub(1)).filter(same_row).map(|place| (place, place + 1))
}

/// Sums over neighbours.
struct Neighbours {
    count: usize,
    /// Of their differences, over the root of two.
    deviation: f64,
    rms: f64,
    /// The sum of products over the sum of squares.
    correlation: f64,
    /// Over how many points the residual is correlated.
    lag: f64,
}

impl Neighbours {
    fn new(fitted: &Fitted, scaled: &Scaled) -> Neighbours {
        let Fitted { residuals, kept, .. } = fitted;
        let both: Vec<(f64, f64)> =
            pairs(scaled).filter(|(a, b)| kept[*a] && kept[*b]).map(|(a, b)| (residuals[a], residuals[b])).collect();
        let of_kept: Vec<f64> =
            residuals.iter().zip(kept).filter(|(_, kept)| **kept).map(|(residual, _)| *residual).collect();
        let squares: f64 = both.iter().map(|(a, b)| 0.5 * (a * a + b * b)).sum();
        let products: f64 = both.iter().map(|(a, b)| a * b).sum();
        let mut differences: Vec<f64> = both.iter().map(|(a, b)| (a - b).abs()).collect();
        let count = both.len().max(1) as f64;
        Neighbours {
            count: both.len(),
            deviation: robust_deviation(&mut differences) / 2f64.sqrt(),
            rms: (squares / count).sqrt(),
            correlation: products / squares.max(f64::MIN_POSITIVE),
            lag: correlation_lag(&of_kept),
        }
    }

    fn ratio(&self) -> f64 {
        (self.rms / self.deviation.max(f64::MIN_POSITIVE)).clamp(1.0, 1e6)
    }

    fn random(&self) -> Option<bool> {
        (self.count >= super::FEWEST_POINTS / 2)
            .then(|| self.correlation.abs() * (self.count as f64).sqrt() <= CORRELATED || self.rms < LEAST_RESIDUAL)
    }

    fn is_structured(&self) -> bool {
        // The heights are in units of their range.
        let is_long = self.ratio() > MOST_RATIO || self.lag > MOST_LAG;
        self.count >= super::FEWEST_POINTS && self.rms > LEAST_RESIDUAL && is_long
    }
}

/// The mean square of the third differences of neighbouring rows' means, over what noise within the rows gives it: of
/// a paraboloid they are zero, whatever the profile leaves of it.
fn row_drift(fitted: &Fitted, scaled: &Scaled) -> f64 {
    if !scaled.plane {
        return 0.0;
    }
    let mut rows: Vec<[f64; 3]> = Vec::new();
    let mut last = f64::NAN;
    for ((point, residual), kept) in scaled.points.iter().zip(&fitted.residuals).zip(&fitted.kept) {
        if point[1].to_bits() != last.to_bits() {
            rows.push([0.0; 3]);
            last = point[1];
        }
        if let (Some(row), true) = (rows.last_mut(), *kept) {
            *row = [row[0] + residual, row[1] + residual * residual, row[2] + 1.0];
        }
    }
    rows.retain(|row| row[2] >= ROW_POINTS as f64);
    let count = rows.iter().map(|row| row[2]).sum::<f64>();
    let mean = |row: &[f64; 3]| row[0] / row[2];
    let within = |row: &[f64; 3]| row[1] - row[2] * mean(row) * mean(row);
    let variance = rows.iter().map(within).sum::<f64>() / count.max(1.0);
    let size = count / rows.len().max(1) as f64;
    if rows.len() < ROW_POINTS || variance.sqrt() < LEAST_RESIDUAL {
        return 0.0;
    }
    let means: Vec<f64> = rows.iter().map(mean).collect();
    let third = |z: &[f64]| (z[3] - 3.0 * (z[2] - z[1]) - z[0]).powi(2) / THIRD;
    let differences = means.windows(4).map(third);
    differences.sum::<f64>() / (means.len() - 3) as f64 / (variance / size)
}

/// Whether outliers lie side by side more often than by chance.
fn has_clusters(fitted: &Fitted, scaled: &Scaled) -> bool {
    let out = |place: usize| scaled.of_surface[place] && !fitted.kept[place];
    let all = scaled.points.len();
    let share = (0..all).filter(|place| out(*place)).count() as f64 / all as f64;
    let (mut run, mut runs) = (usize::from(out(0)), 0);
    for (before, here) in pairs(scaled) {
        run = match (out(before), out(here)) {
            (true, true) => run + 1,
            (_, here) => usize::from(here),
        };
        runs += usize::from(run == CLUSTER);
    }
    runs >= FEWEST_CLUSTERS && runs as f64 > MORE_THAN_CHANCE * all as f64 * share.powi(CLUSTER as i32)
}

/// Whether the residual has a second harmonic about the axis.
fn has_second_harmonic(fitted: &Fitted, scaled: &Scaled, mean_curvature: f64) -> bool {
    let places = scaled.points.iter().map(|point| [point[0] - fitted.axis[0], point[1] - fitted.axis[1]]);
    let kept: Vec<(Vector2<f64>, f64)> = places
        .zip(&fitted.residuals)
        .zip(&fitted.kept)
        .filter(|(_, kept)| **kept)
        .map(|(([u, v], residual), _)| (Vector2::new(0.5 * (u * u - v * v), u * v), *residual))
        .collect();
    let normal: Matrix2<f64> = kept.iter().map(|(row, _)| row * row.transpose()).sum();
    let right: Vector2<f64> = kept.iter().map(|(row, residual)| row * *residual).sum();
    let Some(inverse) = normal.try_inverse() else { return false };
    let harmonic = inverse * right;
    let left: f64 = kept.iter().map(|(row, residual)| (residual - row.dot(&harmonic)).powi(2)).sum();
    let (explained, variance) = (harmonic.dot(&right), left / kept.len().max(1) as f64);
    // What is most of the residual needs no test: it would count as correlated noise there.
    let is_surely = explained > left || explained > SIGNIFICANT * SIGNIFICANT * variance * fitted.inflation;
    is_surely && harmonic.norm() > LEAST_HARMONIC * mean_curvature
}

/// The columns of 1, x, y, x^2/2, x y, y^2/2, and then of x^4 to y^4, at the places of some points.
fn powers(points: &[[f64; 3]], columns: usize) -> DMatrix<f64> {
    let mut powers = DMatrix::zeros(points.len(), columns);
    for (place, &[x, y, _]) in points.iter().enumerate() {
        let (xx, xy, yy) = (x * x, x * y, y * y);
        let row = [1.0, x, y, 0.5 * xx, xy, 0.5 * yy, xx * xx, xx * xy, xx * yy, xy * yy, yy * yy];
        row.iter().take(columns).enumerate().for_each(|(column, value)| powers[(place, column)] = *value);
    }
    powers
}

/// The second derivatives on the axis of the surface of the fourth order, without cubic terms: a body with two planes
/// of symmetry has none.
fn fourth_order(points: &[[f64; 3]]) -> Option<DVector<f64>> {
    let matrix = powers(points, FOURTH);
    let heights = DVector::from_iterator(points.len(), points.iter().map(|point| point[2]));
    let found = matrix.tr_mul(&matrix).cholesky()?.solve(&matrix.tr_mul(&heights));
    Some(found.rows(3, 3).into_owned())
}

/// The paraboloid through the heights, and the standard deviation of what it leaves, in the range of the heights.
fn paraboloid(scaled: &Scaled, units: &Units) -> Option<(Paraboloid, f64)> {
    let mut chosen: Vec<[f64; 3]> =
        scaled.points.iter().zip(&scaled.of_surface).filter(|(_, of)| **of).map(|(point, _)| *point).collect();
    let (mut found, mut covariance, mut deviation) = (DVector::zeros(6), DMatrix::zeros(6, 6), 0.0);
    for _ in 0..ROUNDS {
        let matrix = powers(&chosen, SECOND);
        let heights = DVector::from_iterator(chosen.len(), chosen.iter().map(|point| point[2]));
        let inverse = matrix.tr_mul(&matrix).try_inverse()?;
        found = &inverse * matrix.tr_mul(&heights);
        let residuals = &heights - &matrix * &found;
        let variance = residuals.norm_squared() / chosen.len().saturating_sub(6).max(1) as f64;
        // What a shape that is no paraboloid leaves, or correlated noise, goes on over many points in both directions.
        let mut steps: Vec<f64> = (1..chosen.len())
            .filter(|place| chosen[*place][1].to_bits() == chosen[place - 1][1].to_bits())
            .map(|place| (residuals[place] - residuals[place - 1]).abs())
            .collect();
        let of_neighbours = (0.5 * robust_deviation(&mut steps).powi(2)).max(1e-4 * variance);
        let inflation = if steps.is_empty() { 1.0 } else { (variance / of_neighbours).max(1.0) };
        covariance = inverse * (variance * inflation * inflation);
        let mut sizes: Vec<f64> = residuals.iter().map(|value| value.abs()).collect();
        deviation = robust_deviation(&mut sizes);
        let most = OUTLIER * deviation;
        let before = chosen.len();
        let mut place = 0;
        chosen.retain(|_| {
            place += 1;
            residuals[place - 1].abs() <= most
        });
        if chosen.len() == before || chosen.len() < super::FEWEST_POINTS {
            break;
        }
    }
    // A curvature that is not the same everywhere: what the terms of the fourth order change.
    let off = fourth_order(&chosen).map_or_else(|| DVector::zeros(3), |other| other - found.rows(3, 3));
    covariance.view_mut((3, 3), (3, 3)).ger(1.0, &off, &off, 1.0);
    let tensor = Matrix2::new(found[3], found[4], found[4], found[5]).symmetric_eigen();
    let order = if tensor.eigenvalues[0] >= tensor.eigenvalues[1] { [0, 1] } else { [1, 0] };
    let curvature = |index: usize| {
        let direction = tensor.eigenvectors.column(index);
        let gradient = [direction[0].powi(2), 2.0 * direction[0] * direction[1], direction[1].powi(2)];
        let sum = |row: usize| (0..3).map(|column| covariance[(3 + row, 3 + column)] * gradient[column]).sum::<f64>();
        let variance: f64 = (0..3).map(|row| gradient[row] * sum(row)).sum();
        [tensor.eigenvalues[index], variance.max(0.0).sqrt()]
    };
    let [[short, short_error], [long, long_error]] = order.map(curvature);
    let bend = units.height / (units.length * units.length);
    let radius = |value: f64, error: f64| Estimate {
        value: 1.0 / (value * bend),
        standard_error: error / (value * value * bend),
    };
    let straight = (STRAIGHT * short).max(STRAIGHT_ERRORS * long_error);
    // A saddle is no profile of a contact.
    if short <= 0.0 || long < -straight {
        return None;
    }
    let direction = tensor.eigenvectors.column(order[1]);
    let along = chosen.iter().map(|[x, y, _]| direction[0] * x + direction[1] * y);
    let (low, high) = along.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    let body = Paraboloid {
        short: radius(short, short_error),
        long: (long > straight).then(|| radius(long, long_error)),
        angle: direction[1].atan2(direction[0]).to_degrees().rem_euclid(180.0),
        extent: (high - low) * units.length,
    };
    Some((body, deviation))
}
