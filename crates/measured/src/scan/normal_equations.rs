//! Least squares for the curvatures of a curve, from sums over the points of each interval.
//!
//! Within an interval of width h the curve is a quadratic in S = (r - r_j)/h, so that sums of S^k and z S^k say all
//! there is to know of the points: the equations cost no more for a million points than for a thousand. The penalty is
//! on steps of the curvature, so that a parabola, and no other shape, is free of it.

use nalgebra::DMatrix;

use super::curve::{Curve, interval};
use crate::linear::{add, dot, factor, quadratic, solve};

/// Columns beside the curve that a fit can have: tilt along x and y, shift of the axis along x and y.
pub(super) const MOST_COLUMNS: usize = 4;

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
    breaks: Vec<f64>,
    sums: Vec<Sums>,
    column_count: usize,
    columns: [[f64; MOST_COLUMNS]; MOST_COLUMNS],
    column_heights: [f64; MOST_COLUMNS],
    square: f64,
    /// The sum of the weights.
    pub(super) count: f64,
}

impl Statistics {
    pub(super) fn new(breaks: Vec<f64>, column_count: usize) -> Statistics {
        Statistics {
            sums: vec![Sums::default(); breaks.len() - 1],
            breaks,
            column_count,
            columns: Default::default(),
            column_heights: Default::default(),
            square: 0.0,
            count: 0.0,
        }
    }

    /// Adds a point of this height at radius r, with its other columns.
    pub(super) fn add(&mut self, weight: f64, r: f64, height: f64, columns: &[f64; MOST_COLUMNS]) {
        let index = interval(&self.breaks, r);
        let step = (r - self.breaks[index]) / (self.breaks[index + 1] - self.breaks[index]);
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
        let widths: Vec<f64> = self.breaks.windows(2).map(|ends| ends[1] - ends[0]).collect();
        let middles: Vec<f64> = self.breaks.windows(2).map(|ends| 0.5 * (ends[0] + ends[1])).collect();
        for (index, sums) in self.sums.iter().enumerate() {
            if sums.powers[0] <= 0.0 {
                continue;
            }
            // What one unit of each curvature adds, as a quadratic in S.
            let (start, width) = (self.breaks[index], widths[index]);
            let mut rows: Vec<(usize, [f64; 3])> = (0..index)
                .map(|inner| (inner, [widths[inner] * (start - middles[inner]), widths[inner] * width, 0.0]))
                .collect();
            rows.push((index, [0.0, 0.0, 0.5 * width * width]));
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
        // A curvature that drifts differs the more between neighbours, the wider its intervals are.
        let distances: Vec<f64> = middles.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let mean = distances.iter().sum::<f64>() / distances.len() as f64;
        let nearness: Vec<f64> = distances.iter().map(|distance| mean / distance).collect();
        Equations {
            breaks: self.breaks.clone(),
            intervals,
            matrix,
            right,
            square: self.square,
            count: self.count,
            scale,
            nearness,
            stiffness: vec![1.0; intervals - 1],
        }
    }
}

/// The normal equations without the penalty.
#[derive(Clone)]
pub(super) struct Equations {
    pub(super) breaks: Vec<f64>,
    pub(super) intervals: usize,
    pub(super) matrix: DMatrix<f64>,
    pub(super) right: Vec<f64>,
    square: f64,
    pub(super) count: f64,
    /// The mean of the curvatures' diagonal, which penalties are relative to.
    pub(super) scale: f64,
    /// One over the distance between neighbouring intervals, in units of one over the mean distance.
    pub(super) nearness: Vec<f64>,
    /// How much each step of the curvature counts beside that.
    pub(super) stiffness: Vec<f64>,
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

impl Solution {
    /// The variance of a residual of so many points.
    pub(super) fn variance(&self, count: f64) -> f64 {
        self.squares / (count - self.freedom).max(1.0)
    }
}

impl Equations {
    /// The same equations for a curvature that may step the farther the nearer the axis is: by its own size over a
    /// factor of the radius, as that of a tip of any sharpness does.
    pub(super) fn without_scale(&self) -> Equations {
        let mut equations = self.clone();
        let nearness = equations.nearness.iter_mut().zip(&self.breaks[1..]);

        let end = self.breaks[self.intervals];
        nearness.for_each(|(nearness, radius)| *nearness *= (radius / end).powi(3));
        equations
    }

    /// The matrix with the penalty on steps of the curvature.
    pub(super) fn penalised(&self, penalty: f64) -> DMatrix<f64> {
        let mut matrix = self.matrix.clone();
        for index in 1..self.intervals {
            let strength = penalty * self.scale * self.stiffness[index - 1] * self.nearness[index - 1];
            add(&mut matrix, index, index, strength);
            add(&mut matrix, index - 1, index - 1, strength);
            add(&mut matrix, index, index - 1, -strength);
        }
        matrix
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

    /// What a solution's curvatures change by when pairs of intervals have one curvature: how far they may be off
    /// because intervals are no shorter.
    pub(super) fn change_of_halving(&self, solution: &Solution) -> Vec<f64> {
        let (found, count) = (&solution.unknowns, self.intervals);
        let full = self.penalised(solution.penalty);
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
        (0..count).map(|row| coarse.as_ref().map_or(0.0, |coarse| coarse[pair_of(row)] - found[row])).collect()
    }

    /// The sum of squared residuals.
    fn squares(&self, unknowns: &[f64]) -> f64 {
        (self.square - 2.0 * dot(unknowns, &self.right) + quadratic(&self.matrix, unknowns)).max(1e-15 * self.square)
    }

    /// The curve of some unknowns, with a parabola added that had been taken off the heights.
    pub(super) fn curve(&self, unknowns: &[f64], parabola: f64) -> Curve {
        let curvatures = unknowns[..self.intervals].iter().map(|curvature| curvature + parabola).collect();
        Curve::new(self.breaks.clone(), curvatures, unknowns[self.intervals])
    }
}
