//! Steps of the heights between neighbours, which the slopes beside them do not explain.
//!
//! Along a line across any body whose slope rises, the height from a point to the next changes by a slope between those
//! on the left and on the right: a kink is no step. What lies beyond both is the edge of a grain, of a scratch, or a
//! jump of the instrument. A running median takes off spikes of one or two points first, which are outliers.

use super::fit::{Fitted, Scaled};
use crate::robust::robust_deviation;
use crate::steps::step as rounding_step;

/// Outliers side by side that may be a grain.
const RUN: usize = 3;
/// Half the points of the running median.
const MEDIAN: usize = 2;
/// Points over which the slopes on either side are taken.
const SIDE: usize = 4;
/// Steps of so many standard deviations are no noise.
const SURE: f64 = 10.0;
/// Steps below this share of the range of the heights are errors of a curve of few points.
const LEAST: f64 = 1e-3;
/// Steps of rounded heights are the surface's own up to so many of them.
const ROUNDED: f64 = 3.0;

/// Edges that a map needs: three outliers side by side make one by chance in ten thousand points.
const OF_MAP: usize = 2;
/// The deviation of a third difference of independent values.
const THIRD: f64 = 4.472_135_954_999_58;

/// The largest step between neighbours, in standard deviations of the noise, if it is an edge.
pub(super) fn largest(fitted: &Fitted, scaled: &Scaled) -> Option<f64> {
    let all = scaled.points.len();
    let is_out = |place: usize| !fitted.kept[place];
    // Outliers on their own are none of an edge; a run of them may be a grain.
    let is_alone = |place: usize| {
        let before = (0..place).rev().take_while(|at| is_out(*at)).take(RUN).count();
        let after = (place + 1..all).take_while(|at| is_out(*at)).take(RUN).count();
        is_out(place) && before + after + 1 < RUN
    };
    let of_surface = (0..all).filter(|place| scaled.of_surface[*place] && !is_alone(*place));
    let surface: Vec<[f64; 3]> = of_surface.map(|place| scaled.points[place]).collect();
    let rows = || surface.chunk_by(|a, b| a[1].to_bits() == b[1].to_bits());
    let sizes: Vec<f64> = rows().flat_map(steps).collect();
    let heights: Vec<f64> = surface.iter().map(|point| point[2]).collect();
    let third = |z: &[[f64; 3]]| (z[3][2] - 3.0 * (z[2][2] - z[1][2]) - z[0][2]).abs() / THIRD;
    let mut of_neighbours: Vec<f64> = rows().flat_map(|row| row.windows(4).map(third)).collect();
    let deviation = robust_deviation(&mut of_neighbours).max(robust_deviation(&mut sizes.clone()));
    let least = (SURE * deviation).max(LEAST).max(ROUNDED * rounding_step(&heights).unwrap_or(0.0));
    let (count, most) = sizes.iter().filter(|size| **size > least).fold((0, 0.0), |(n, most), &s| (n + 1, s.max(most)));
    (count >= if scaled.plane { OF_MAP } else { 1 }).then(|| most / deviation.max(1e-6 * most))
}

/// How far each change of height along a row is beyond those of both sides.
fn steps(row: &[[f64; 3]]) -> Vec<f64> {
    let heights: Vec<f64> = (0..row.len())
        .map(|place| {
            let half = MEDIAN.min(place).min(row.len() - 1 - place);
            let mut near: Vec<f64> = row[place - half..=place + half].iter().map(|point| point[2]).collect();
            near.sort_by(f64::total_cmp);
            near[half]
        })
        .collect();
    let slope = |from: usize, to: usize| (heights[to] - heights[from]) / (row[to][0] - row[from][0]);
    let step = |place: usize| {
        let [left, right] = [slope(place - SIDE, place), slope(place + 1, place + 1 + SIDE)];
        let width = row[place + 1][0] - row[place][0];
        let (rise, low, high) = (slope(place, place + 1), left.min(right), left.max(right));
        (low - rise).max(rise - high).max(0.0) * width.abs()
    };
    let places = SIDE..row.len().saturating_sub(1 + SIDE);
    places.map(step).filter(|size| size.is_finite()).collect()
}
