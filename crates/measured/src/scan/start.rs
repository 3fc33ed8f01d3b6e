//! Where a fit begins: which way up the scan is, and about where its axis lies.
//!
//! The scan is thinned to the median of each cell of a grid, which single spikes do not reach. Its parabola by least
//! squares tells the way up; then a coarse curve is fitted about each axis of a grid over the scan.

use nalgebra::DMatrix;

use super::curve::equal_breaks;
use super::fit::Scaled;
use super::normal_equations::Statistics;
use crate::linear::{add, factor, solve};
use crate::robust::{HUBER, core_deviation};

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
/// Times that residuals are weighted.
const ROUNDS: usize = 4;
/// The least share of the heights that are of the surface.
const BODY: f64 = 0.6;
/// By how much the logarithm of the squares of a fit about an axis at the edge of the scan must be lower than that of
/// one about its middle. Correlated noise, and a tip that the intervals do not resolve, lower it by 0.7 to 1 for half
/// of that way in random scans.
const UNTESTED: f64 = 3.0;
/// Axes with a tilt that are chosen by their score, and how much of the scan lies on either side of them: a coarse
/// curve is too coarse for a score to compare those at the edge with.
const INNER: usize = 2;
const INNER_OVERLAP: f64 = 0.5;
/// Times that the distance of the axes tried is halved about those that are chosen.
const REFINEMENTS: i32 = 4;

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

/// Whether each height belongs to the surface: it does unless it is beyond a gap among the sorted heights that is wider
/// than all heights on the other side of the gap are apart. The search starts from the densest [`BODY`] of the heights.
pub(super) fn of_surface(points: &[[f64; 3]]) -> Vec<bool> {
    let mut heights: Vec<f64> = points.iter().map(|point| point[2]).collect();
    heights.sort_by(f64::total_cmp);
    let count = (BODY * heights.len() as f64).ceil() as usize;
    let widths = heights.windows(count).map(|body| body[count - 1] - body[0]);
    let densest = widths.enumerate().min_by(|a, b| a.1.total_cmp(&b.1));
    let (mut low, mut high) = densest.map_or((0, heights.len() - 1), |(low, _)| (low, low + count - 1));
    loop {
        let width = heights[high] - heights[low];
        let near = |gap: f64| gap <= width || width <= 0.0;
        if low > 0 && near(heights[low] - heights[low - 1]) {
            low -= 1;
        } else if high + 1 < heights.len() && near(heights[high + 1] - heights[high]) {
            high += 1;
        } else {
            break;
        }
    }
    points.iter().map(|point| (heights[low]..=heights[high]).contains(&point[2])).collect()
}

/// Where a fit may begin: the axes about which a coarse curve fits.
pub(super) struct Starts {
    /// The best without a tilt.
    pub(super) level: Option<[f64; 2]>,
    /// With one: those of the best score in the middle of the scan, and the one that fits best.
    pub(super) tilted: Vec<[f64; 2]>,
}

/// The axes about which a coarse curve fits best; `None` if the work was ended.
pub(super) fn axes(scan: &Scaled, keep_going: &dyn Fn() -> bool) -> Option<Starts> {
    let surface = scan.points.iter().zip(&scan.of_surface).filter(|(_, of_surface)| **of_surface);
    let points = medians(&surface.map(|(point, _)| *point).collect::<Vec<_>>(), scan.plane);
    let (count, directions) = (AXES[usize::from(scan.plane)], 1 + usize::from(scan.plane));
    let bounds = [0, 1].map(|axis| {
        let values = points.iter().map(|point| point[axis]);
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)))
    });
    let step = bounds.map(|(low, high)| (high - low) / (count - 1) as f64);
    let rows = if scan.plane { count } else { 1 };
    let place =
        |index: usize| [bounds[0].0 + step[0] * (index % count) as f64, bounds[1].0 + step[1] * (index / count) as f64];
    let mut costs = [Vec::new(), Vec::new()];
    for index in 0..count * rows {
        if !keep_going() {
            return None;
        }
        for (costs, tilts) in costs.iter_mut().zip([0, directions]) {
            costs.push(cost(&points, place(index), tilts));
        }
    }
    let refined = |index: usize, tilts: usize, costs: &[f64]| {
        let (mut axis, mut least) = (place(index), costs[index]);
        for halving in 1..=REFINEMENTS {
            for (direction, sign) in [(0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0)].into_iter().take(2 * directions) {
                let mut moved = axis;
                moved[direction] += sign * step[direction] * 0.5f64.powi(halving);
                let cost = cost(&points, moved, tilts);
                if cost < least {
                    (axis, least) = (moved, cost);
                }
            }
        }
        axis
    };
    let least = |of: &mut dyn Iterator<Item = usize>, costs: &[f64]| {
        of.filter(|index| costs[*index].is_finite()).min_by(|a, b| costs[*a].total_cmp(&costs[*b]))
    };
    let [level, tilted] = &costs;
    let is_lowest = |index: &usize| {
        let near = |at: usize, count: usize| at.saturating_sub(1)..(at + 2).min(count);
        let mut about =
            near(index / count, rows).flat_map(|row| near(index % count, count).map(move |c| row * count + c));
        tilted[*index].is_finite() && about.all(|other| tilted[*index] <= tilted[other])
    };
    let mut lowest: Vec<usize> = (0..tilted.len()).filter(is_lowest).collect();
    let best = least(&mut lowest.iter().copied(), tilted);
    let score = |index: &usize| score(tilted[*index].powi(2), place(*index));
    lowest.sort_by(|a, b| score(a).total_cmp(&score(b)));
    let inner = |index: &usize| overlap(place(*index)) >= INNER_OVERLAP;
    let mut chosen: Vec<usize> = lowest.into_iter().filter(inner).take(INNER).chain(best).collect();
    chosen.sort_unstable();
    chosen.dedup();
    Some(Starts {
        level: least(&mut (0..level.len()), level).map(|index| refined(index, 0, level)),
        tilted: chosen.into_iter().map(|index| refined(index, directions, tilted)).collect(),
    })
}

/// How far the scan reaches to both sides of an axis, in half its extent.
pub(super) fn overlap(axis: [f64; 2]) -> f64 {
    1.0 - axis[0].abs().max(axis[1].abs())
}

/// What an axis is chosen by: the logarithm of the squares of its fit, less what the scan tests of it.
pub(super) fn score(squares: f64, axis: [f64; 2]) -> f64 {
    squares.ln() - UNTESTED * overlap(axis)
}

/// The sum of the sizes of the residuals about an axis, weighted by Huber; infinite if the gap does not open outward.
fn cost(points: &[[f64; 3]], [x0, y0]: [f64; 2], tilts: usize) -> f64 {
    let radius = |point: &[f64; 3]| (point[0] - x0).hypot(point[1] - y0);
    let end = points.iter().map(radius).fold(0.0, f64::max);
    let mut weights = vec![1.0; points.len()];
    let mut sum = f64::INFINITY;
    for _ in 0..ROUNDS {
        let mut statistics = Statistics::new(equal_breaks(end, INTERVALS), tilts);
        for (point, weight) in points.iter().zip(&weights) {
            statistics.add(*weight, radius(point), point[2], &[point[0] - x0, point[1] - y0, 0.0, 0.0]);
        }
        let equations = statistics.equations();
        let Some(solution) = equations.solve(PENALTY) else { return f64::INFINITY };
        let curve = equations.curve(&solution.unknowns, 0.0);
        let heights = || {
            (0..=4 * INTERVALS).map(|index| curve.height(end * index as f64 / (4 * INTERVALS) as f64) - curve.offset)
        };
        let (low, high) = heights().fold((0.0f64, 0.0f64), |(low, high), height| (low.min(height), high.max(height)));
        let fall = high - (curve.height(end) - curve.offset);
        let opens = -low <= DIP * (high - low) && fall <= FALL * (high - low);
        let tilt = &solution.unknowns[INTERVALS + 1..];
        let residual = |point: &[f64; 3]| {
            let plane: f64 = tilt.iter().zip([point[0] - x0, point[1] - y0]).map(|(slope, place)| slope * place).sum();
            (point[2] - curve.height(radius(point)) - plane).abs()
        };
        let sizes: Vec<f64> = points.iter().map(residual).collect();
        sum = if opens { sizes.iter().sum() } else { f64::INFINITY };
        let most = HUBER * core_deviation(&mut sizes.clone());
        weights.iter_mut().zip(&sizes).for_each(|(weight, size)| *weight = (most / size).min(1.0));
    }
    sum
}
