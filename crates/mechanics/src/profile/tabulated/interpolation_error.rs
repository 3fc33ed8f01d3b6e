//! The error of the curve through a table, estimated from the curve through half of the points.
//!
//! f' of the curve through every other point is taken from f' of the curve through all: once for the points of even
//! index and once for those of odd, because an interval that a half keeps whole hardly differs there, however large its
//! error is. On smooth data the difference is some three times the error of the curve through all, whose order is n^-2,
//! and nearer to once where the surface has a kink: half of it, for the half of the points that differs more, is the
//! error estimate. Its Abel integral estimates the error of g, itself that of the pressure: a step of f' of T adds
//! (pi/2) T arcosh to the kernel.

use super::spline::{Knot, knots};

/// Radii at which errors are estimated.
const RADII: usize = 16;

/// The interpolation error up to a radius.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct InterpolationError {
    /// int |error of g| dx + a max |error of g|, m^2: a force over 2 E*.
    pub load: f64,
    /// Error of the kernel, pure number.
    pub kernel: f64,
}

impl InterpolationError {
    /// Of two profiles added up.
    #[must_use]
    pub fn and(self, other: InterpolationError) -> InterpolationError {
        InterpolationError { load: self.load + other.load, kernel: self.kernel + other.kernel }
    }
}

/// Error estimates at increasing radii, m, each for all the radii up to it.
pub(super) fn up_to_radii(radii: &[f64], heights: &[f64], curve: &[Knot]) -> Vec<(f64, InterpolationError)> {
    let mut found = vec![(0.0, InterpolationError::default()); RADII];
    for thinned in thinned(radii, heights) {
        for (here, next) in found.iter_mut().zip(against(curve, &thinned, radii[radii.len() - 1])) {
            let (load, kernel) = (here.1.load.max(next.1.load), here.1.kernel.max(next.1.kernel));
            *here = (next.0, InterpolationError { load, kernel });
        }
    }
    found
}

/// Error estimates at increasing radii up to `end`, m, from one other curve.
fn against(curve: &[Knot], other: &[Knot], end: f64) -> Vec<(f64, InterpolationError)> {
    let difference = difference(curve, other);
    let mut found = Vec::with_capacity(RADII);
    let (mut area, mut level) = (0.0, 0.0f64);
    for index in 1..=RADII {
        let radius = end * index as f64 / RADII as f64;
        let here = level_at(&difference, radius).abs();
        area += here * end / RADII as f64;
        level = level.max(here);
        let steepest = difference.iter().take_while(|knot| knot.radius < radius).map(|knot| knot.slope.abs());
        let kernel = std::f64::consts::FRAC_PI_2 * steepest.fold(0.0, f64::max);
        found.push((radius, InterpolationError { load: area + radius * level, kernel }));
    }
    found
}

/// Curves through half of the points and both ends: those of even index, and those of odd. One of them joins the last
/// interval with its neighbour, and the largest errors are there where distances grow outward. Of a few points, a
/// parabola through the first and the last.
fn thinned(radii: &[f64], heights: &[f64]) -> Vec<Vec<Knot>> {
    let last = radii.len() - 1;
    if last < 4 {
        let slope = 2.0 * (heights[last] - heights[0]) / radii[last];
        return vec![vec![Knot { radius: 0.0, slope: 0.0 }, Knot { radius: radii[last], slope }]];
    }
    let half = |parity: usize| {
        let kept = |all: &[f64]| -> Vec<f64> {
            let kept = all.iter().enumerate().filter(|(index, _)| index % 2 == parity || [0, last].contains(index));
            kept.map(|(_, value)| *value).collect()
        };
        knots(&kept(radii), &kept(heights))
    };
    vec![half(0), half(1)]
}

/// Half of one curve's f' less the other's, at the knots of both.
fn difference(one: &[Knot], other: &[Knot]) -> Vec<Knot> {
    let mut radii: Vec<f64> = one.iter().chain(other).map(|knot| knot.radius).collect();
    radii.sort_by(f64::total_cmp);
    radii.dedup_by(|a, b| a.to_bits() == b.to_bits());
    let (mut one, mut other) = (one, other);
    let mut half = |radius| 0.5 * (slope_at(&mut one, radius) - slope_at(&mut other, radius));
    radii.into_iter().map(|radius| Knot { radius, slope: half(radius) }).collect()
}

/// f' of a curve at a radius; the knots below it are dropped, as the next radius lies beyond it.
fn slope_at(knots: &mut &[Knot], radius: f64) -> f64 {
    while knots.len() > 2 && knots[1].radius < radius {
        *knots = &knots[1..];
    }
    let (low, high) = (knots[0], knots[1]);
    low.slope + (high.slope - low.slope) * ((radius - low.radius) / (high.radius - low.radius))
}

/// x int_0^x f' dr/sqrt(x^2 - r^2), f' straight between the knots.
fn level_at(knots: &[Knot], x: f64) -> f64 {
    let place = |r: f64| ((x - r) * (x + r)).max(0.0).sqrt();
    let mut sum = 0.0;
    for pair in knots.windows(2) {
        let (low, high) = (pair[0].radius, pair[1].radius.min(x));
        if low >= x {
            break;
        }
        let curvature = (pair[1].slope - pair[0].slope) / (pair[1].radius - low);
        let constant = pair[0].slope - curvature * low;
        sum += constant * (high.atan2(place(high)) - low.atan2(place(low))) + curvature * (place(low) - place(high));
    }
    x * sum
}
