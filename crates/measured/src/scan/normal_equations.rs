//! Least squares for the curvatures of a curve, from sums over the points of each interval.
//!
//! Within an interval the curve is a quadratic in S = (r - r_j)/h, so that sums of S^k and z S^k say all there is to know of the
//! points: the equations cost no more for a million points than for a thousand. The penalty is on steps of the curvature, so
//! that a parabola, and no other shape, is free of it.

use nalgebra::{DMatrix, DVectorView};

use super::curve::Curve;
use crate::linear::{add, dot, factor, quadratic, solve};

/// Columns beside the curve that a fit can have: tilt along x and y, shift of the axis along x and y.
pub(super) const MOST_COLUMNS: usize = 4;

/// The curvatures found lack what the penalty takes, about half of it in a step that is half smoothed away: so it counts as often.
const LACKING: f64 = 2.0;

/// Sums over the points of one interval.
#[derive(Clone, Copy, Default)]
struct Sums {
    /// S^k.
    powers: [f64; 5],
    /// z S^k.
    heights: [f64; 3],
    /// S^k times each other column.
    columns: [[f64; MOST_COLUMNS]; 3],
}

/// The sums over all points.
pub(super) struct Statistics {
    width: f64,
    sums: Vec<Sums>,
    column_count: usize,
    columns: [[f64; MOST_COLUMNS]; MOST_COLUMNS],
    column_heights: [f64; MOST_COLUMNS],
    square: f64,
    /// The sum of the weights.
    pub(super) count: f64,
}

impl Statistics {
    pub(super) fn new(width: f64, intervals: usize, column_count: usize) -> Statistics {
        Statistics {
            width,
            sums: vec![Sums::default(); intervals],
            column_count,
            columns: Default::default(),
            column_heights: Default::default(),
            square: 0.0,
            count: 0.0,
        }
    }

    /// Adds a point of this height at radius r, with its other columns.
    pub(super) fn add(&mut self, weight: f64, r: f64, height: f64, columns: &[f64; MOST_COLUMNS]) {
        let place = r / self.width;
        let index = (place as usize).min(self.sums.len() - 1);
        let step = place - index as f64;
        let sums = &mut self.sums[index];
        let mut power = weight;
        for k in 0..5 {
            sums.powers[k] += power;
            if k < 3 {
                sums.heights[k] += power * height;
                for (sum, column) in sums.columns[k].iter_mut().zip(columns) {
                    *sum += power * column;
                }
            }
            power *= step;
        }
        for (index, column) in columns.iter().enumerate() {
            for (sum, other) in self.columns[index].iter_mut().zip(columns) {
                *sum += weight * column * other;
            }
            self.column_heights[index] += weight * column * height;
        }
        self.square += weight * height * height;
        self.count += weight;
    }

    /// The normal equations: unknown are the curvatures, the height on the axis, and the other columns' factors.
    pub(super) fn equations(&self) -> Equations {
        let intervals = self.sums.len();
        let size = intervals + 1 + self.column_count;
        let mut matrix = DMatrix::zeros(size, size);
        let mut right = vec![0.0; size];
        let area = self.width * self.width;
        for (index, sums) in self.sums.iter().enumerate() {
            if sums.powers[0] <= 0.0 {
                continue;
            }
            // What one unit of each curvature adds, as a quadratic in S.
            let mut rows: Vec<(usize, [f64; 3])> =
                (0..index).map(|inner| (inner, [area * ((index - inner) as f64 - 0.5), area, 0.0])).collect();
            rows.push((index, [0.0, 0.0, 0.5 * area]));
            rows.push((intervals, [1.0, 0.0, 0.0]));
            for (place, &(row, quadratic)) in rows.iter().enumerate() {
                let mut products = [0.0; 3];
                for (k, product) in products.iter_mut().enumerate() {
                    *product = dot(&quadratic, &sums.powers[k..k + 3]);
                }
                for &(column, other) in &rows[..=place] {
                    add(&mut matrix, row, column, dot(&products, &other));
                }
                right[row] += dot(&quadratic, &sums.heights);
                for column in 0..self.column_count {
                    let product = (0..3).map(|k| quadratic[k] * sums.columns[k][column]).sum();
                    add(&mut matrix, intervals + 1 + column, row, product);
                }
            }
        }
        for row in 0..self.column_count {
            for column in 0..=row {
                add(&mut matrix, intervals + 1 + row, intervals + 1 + column, self.columns[row][column]);
            }
            right[intervals + 1 + row] = self.column_heights[row];
        }
        let scale = (0..intervals).map(|index| matrix[(index, index)]).sum::<f64>() / intervals as f64;
        let stiffness = vec![1.0; intervals - 1];
        Equations {
            width: self.width,
            intervals,
            matrix,
            right,
            square: self.square,
            count: self.count,
            scale,
            stiffness,
        }
    }
}

/// The normal equations without the penalty.
pub(super) struct Equations {
    pub(super) width: f64,
    pub(super) intervals: usize,
    pub(super) matrix: DMatrix<f64>,
    pub(super) right: Vec<f64>,
    square: f64,
    pub(super) count: f64,
    /// The mean of the curvatures' diagonal, which penalties are relative to.
    scale: f64,
    /// How much each step of the curvature counts.
    stiffness: Vec<f64>,
}

/// A solution for one penalty.
#[derive(Clone, Debug)]
pub(super) struct Solution {
    pub(super) penalty: f64,
    pub(super) unknowns: Vec<f64>,
    /// The inverse of the penalised matrix.
    pub(super) inverse: DMatrix<f64>,
    /// The sum of squared residuals.
    pub(super) squares: f64,
    /// Degrees of freedom that the fit takes: the trace of its influence matrix.
    pub(super) freedom: f64,
}

impl Equations {
    /// The matrix with the penalty on steps of the curvature.
    pub(super) fn penalised(&self, penalty: f64) -> DMatrix<f64> {
        let mut matrix = self.matrix.clone();
        for index in 1..self.intervals {
            let strength = penalty * self.scale * self.stiffness[index - 1];
            add(&mut matrix, index, index, strength);
            add(&mut matrix, index - 1, index - 1, strength);
            add(&mut matrix, index, index - 1, -strength);
        }
        matrix
    }

    /// Lets the curvature step where it does in a solution: beside an edge a uniform penalty would smooth it away, and elsewhere
    /// leave noise in.
    pub(super) fn adapt(&mut self, solution: &Solution) {
        let steps: Vec<f64> =
            solution.unknowns[..self.intervals].windows(2).map(|pair| (pair[1] - pair[0]).powi(2)).collect();
        let typical = steps.iter().sum::<f64>() / steps.len() as f64;
        if typical > 0.0 {
            self.stiffness = steps.iter().map(|step| 1.0 / (1.0 + step / typical)).collect();
        }
    }

    /// The solution for a penalty; `None` if the points do not determine it.
    pub(super) fn solve(&self, penalty: f64) -> Option<Solution> {
        let factor = factor(self.penalised(penalty))?;
        let unknowns = solve(&factor, &self.right);
        let inverse = factor.inverse();
        let squares = self.squares(&unknowns);
        let freedom = inverse.dot(&self.matrix);
        Some(Solution { penalty, unknowns, inverse, squares, freedom })
    }

    /// How far a solution's curvatures may be off whatever the noise: what the penalty takes from the curvatures that were found,
    /// -(N + P)^-1 P k, and what they change by when pairs of intervals have one curvature.
    pub(super) fn systematic(&self, solution: &Solution) -> [Vec<f64>; 2] {
        let (found, count) = (&solution.unknowns, self.intervals);
        let full = self.penalised(solution.penalty);
        let pulled = (&full - &self.matrix) * DVectorView::from_slice(found, found.len());
        let taken = (&solution.inverse * pulled).iter().take(count).map(|lack| LACKING * lack).collect();

        let pair_of = |row: usize| if row < count { row / 2 } else { row - count + count.div_ceil(2) };
        let size = pair_of(found.len() - 1) + 1;
        let (mut matrix, mut right) = (DMatrix::zeros(size, size), vec![0.0; size]);
        for row in 0..found.len() {
            for column in 0..found.len() {
                matrix[(pair_of(row), pair_of(column))] += full[(row, column)];
            }
            right[pair_of(row)] += self.right[row];
        }
        let coarse = factor(matrix).map(|factor| solve(&factor, &right));
        let changed = (0..count).map(|row| coarse.as_ref().map_or(0.0, |coarse| coarse[pair_of(row)] - found[row]));
        [taken, changed.collect()]
    }

    /// The sum of squared residuals.
    fn squares(&self, unknowns: &[f64]) -> f64 {
        (self.square - 2.0 * dot(unknowns, &self.right) + quadratic(&self.matrix, unknowns)).max(1e-15 * self.square)
    }

    /// The curve of some unknowns, with a parabola added that had been taken off the heights.
    pub(super) fn curve(&self, unknowns: &[f64], parabola: f64) -> Curve {
        let curvatures = unknowns[..self.intervals].iter().map(|curvature| curvature + parabola).collect();
        Curve::new(self.width, curvatures, unknowns[self.intervals])
    }
}
