//! What least squares need beside the linear algebra of the library: mirrored sums, and a factor that knows when it is
//! singular.

use nalgebra::{Cholesky, DMatrix, DVector, DVectorView, Dyn};

/// Pivots below this share of their diagonal are rounding.
const SINGULAR: f64 = 1e-14;

/// Adds to an element of a symmetric matrix, and to its mirror image.
pub(crate) fn add(matrix: &mut DMatrix<f64>, row: usize, column: usize, value: f64) {
    matrix[(row, column)] += value;
    if row != column {
        matrix[(column, row)] += value;
    }
}

/// The factor of a symmetric matrix, if it is positive definite to round-off.
pub(crate) fn factor(matrix: DMatrix<f64>) -> Option<Cholesky<f64, Dyn>> {
    let diagonal = matrix.diagonal();
    let factor = matrix.cholesky()?;
    let regular = factor.l_dirty().diagonal().iter().zip(&diagonal).all(|(pivot, all)| pivot * pivot > SINGULAR * all);
    regular.then_some(factor)
}

/// The solution of a system.
pub(crate) fn solve(factor: &Cholesky<f64, Dyn>, right: &[f64]) -> Vec<f64> {
    factor.solve(&DVector::from_column_slice(right)).as_slice().to_vec()
}

/// v' A v.
pub(crate) fn quadratic(matrix: &DMatrix<f64>, v: &[f64]) -> f64 {
    let v = DVectorView::from_slice(v, v.len());
    (matrix * v).dot(&v)
}

/// The sum of the products.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
