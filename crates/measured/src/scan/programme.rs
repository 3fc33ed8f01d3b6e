//! The quadratic programme: the penalised fit among the curves whose g rises.
//!
//! Where g fell, the contact would be a ring. g' is linear in the curvatures, so that g' >= 0 at many radii makes a
//! convex programme, with one solution ([`quadratic_programme`]).

use nalgebra::{DMatrix, DVector};

use super::curve::g_slopes;
use super::normal_equations::{Equations, Solution};
use crate::quadratic_programme;

/// Radii in each interval at which g must rise. After a fall of the curvature, g' falls steepest at once.
const PLACES: [f64; 3] = [0.03, 0.3, 1.0];

/// The unknowns of the constrained fit; those of the plain one if g rises there. `parabola` is what the heights lack:
/// its curvature is to be added to all. `None` if the method fails.
pub(super) fn constrained(equations: &Equations, plain: &Solution, parabola: f64) -> Option<Vec<f64>> {
    let breaks = &equations.breaks;
    let places = breaks.windows(2).flat_map(|ends| PLACES.map(|share| ends[0] + share * (ends[1] - ends[0])));
    let rows: Vec<(f64, Vec<f64>)> = places.map(|x| (x, g_slopes(breaks, x))).collect();
    let rises = |(_, row): &(f64, Vec<f64>)| {
        row.iter().zip(&plain.unknowns).map(|(a, k)| a * (k + parabola)).sum::<f64>() >= 0.0
    };
    if rows.iter().all(rises) {
        return Some(plain.unknowns.clone());
    }
    let matrix = equations.penalised(plain.penalty);
    let size = matrix.nrows();
    // Unknowns in units of their own make all diagonals one.
    let units: Vec<f64> = (0..size).map(|index| 1.0 / matrix[(index, index)].sqrt()).collect();
    let quadratic = DMatrix::from_fn(size, size, |row, column| matrix[(row, column)] * units[row] * units[column]);
    // The step from the plain solution, which has no linear term: the digits of the heights do not enter.
    let mut constraints = DMatrix::zeros(rows.len(), size);
    let mut bounds = DVector::zeros(rows.len());
    for (index, (_, row)) in rows.iter().enumerate() {
        let scaled: Vec<f64> = row.iter().zip(&units).map(|(a, unit)| a * unit).collect();
        let length = scaled.iter().map(|value| value * value).sum::<f64>().sqrt();
        scaled.iter().enumerate().for_each(|(column, value)| constraints[(index, column)] = -value / length);
        let now: f64 = row.iter().zip(&plain.unknowns).map(|(a, k)| a * (k + parabola)).sum();
        bounds[index] = now / length;
    }
    let largest = bounds.amax().max(f64::MIN_POSITIVE);
    let steps = quadratic_programme::least(&quadratic, &constraints, &(bounds / largest))?;
    let steps = steps.iter().zip(&units).map(|(step, unit)| step * unit * largest);
    Some(plain.unknowns.iter().zip(steps).map(|(plain, step)| plain + step).collect())
}
