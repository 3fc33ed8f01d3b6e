//! Where a fit begins: which way up the scan is, and about where its axis lies.
//!
//! The scan is thinned to the median of each cell of a grid, which single spikes do not reach. Its parabola by least
//! squares tells the way up; then a coarse curve is fitted about each axis of a grid over the scan.

use nalgebra::DMatrix;

use super::curve::equal_breaks;
use super::normal_equations::{MOST_COLUMNS, Statistics};
use crate::linear::{add, factor, solve};

/// Points that a median is taken of.
const CELL: usize = 5;
/// Cells along a line, and along each side of a map.
const CELLS: [usize; 2] = [400, 36];
/// Axes tried along a line, and along each side of a map.
const AXES: [usize; 2] = [41, 13];
/// Intervals of the coarse curve, and its penalty.
const INTERVALS: usize = 14;
const PENALTY: f64 = 1e-6;
/// How far below its height on the axis the coarse curve may go, as a share of its range: the gap opens outward.
const DIP: f64 = 0.05;
/// How far below its highest point it may end.
const FALL: f64 = 0.25;

/// The points whose heights are the medians of their cells.
pub(super) fn medians(points: &[[f64; 3]], plane: bool) -> Vec<[f64; 3]> {
    let [along, across] = if plane { [CELLS[1], CELLS[1]] } else { [CELLS[0], 1] };
    let wanted = points.len() / CELL;
    let side = if plane { (wanted as f64).sqrt() as usize } else { wanted };
    let (along, across) = (along.min(side).max(1), if plane { across.min(side).max(1) } else { 1 });
    // Coordinates are in units of the half extent.
    let cell = |value: f64, cells: usize| (((0.5 * (value + 1.0)) * cells as f64).max(0.0) as usize).min(cells - 1);
    let mut filled: Vec<Vec<usize>> = vec![Vec::new(); along * across];
    for (index, [x, y, _]) in points.iter().enumerate() {
        filled[cell(*x, along) * across + cell(*y, across)].push(index);
    }
    let median = |cell: &mut Vec<usize>| {
        let middle = cell.len().checked_sub(1)? / 2;
        let (_, &mut index, _) = cell.select_nth_unstable_by(middle, |&a, &b| points[a][2].total_cmp(&points[b][2]));
        Some(points[index])
    };
    let thinned: Vec<[f64; 3]> = filled.iter_mut().filter_map(median).collect();
    if thinned.len() < 4 * INTERVALS { points.to_vec() } else { thinned }
}

/// The curvature of the least-squares parabola with a tilt; zero if the points do not determine one.
pub(super) fn curvature(points: &[[f64; 3]], plane: bool) -> f64 {
    let size = if plane { 4 } else { 3 };
    let mut matrix = DMatrix::zeros(size, size);
    let mut right = vec![0.0; size];
    for &[x, y, z] in points {
        let columns = [1.0, 0.5 * (x * x + y * y), x, y];
        for row in 0..size {
            for column in 0..=row {
                add(&mut matrix, row, column, columns[row] * columns[column]);
            }
            right[row] += columns[row] * z;
        }
    }
    factor(matrix).map_or(0.0, |factor| solve(&factor, &right)[1])
}

/// The axis about which a coarse curve fits best; `None` if the gap opens outward about none.
pub(super) fn axis(points: &[[f64; 3]], plane: bool, keep_going: &dyn Fn() -> bool) -> Option<[f64; 2]> {
    let count = AXES[usize::from(plane)];
    let places = |axis: usize| -> Vec<f64> {
        if axis == 1 && !plane {
            return vec![0.0];
        }
        let (low, high) = points.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), point| {
            (low.min(point[axis]), high.max(point[axis]))
        });
        (0..count).map(|index| low + (high - low) * index as f64 / (count - 1) as f64).collect()
    };
    let across = places(1);
    let mut best: Option<(f64, [f64; 2])> = None;
    for &x in &places(0) {
        if !keep_going() {
            return None;
        }
        for &y in &across {
            let Some(cost) = cost(points, [x, y]) else { continue };
            if best.is_none_or(|(least, _)| cost < least) {
                best = Some((cost, [x, y]));
            }
        }
    }
    best.map(|(_, axis)| axis)
}

/// The sum of squared residuals about an axis; `None` if the gap does not open outward.
fn cost(points: &[[f64; 3]], [x0, y0]: [f64; 2]) -> Option<f64> {
    let radius = |point: &[f64; 3]| (point[0] - x0).hypot(point[1] - y0);
    let end = points.iter().map(radius).fold(0.0, f64::max);
    let mut statistics = Statistics::new(equal_breaks(end, INTERVALS), 0);
    for point in points {
        statistics.add(1.0, radius(point), point[2], &[0.0; MOST_COLUMNS]);
    }
    let equations = statistics.equations();
    let solution = equations.solve(PENALTY)?;
    let curve = equations.curve(&solution.unknowns, 0.0);
    let heights =
        || (0..=4 * INTERVALS).map(|index| curve.height(end * index as f64 / (4 * INTERVALS) as f64) - curve.offset);
    let (low, high) = heights().fold((0.0f64, 0.0f64), |(low, high), height| (low.min(height), high.max(height)));
    let fall = high - (curve.height(end) - curve.offset);
    if -low > DIP * (high - low) || fall > FALL * (high - low) {
        return None;
    }
    Some(solution.squares)
}
