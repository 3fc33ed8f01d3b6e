//! Two equations of two unknowns: the inverse of their Jacobian, and Broyden's (1965) update of it.

pub(crate) type Matrix = [[f64; 2]; 2];

pub(crate) fn product(matrix: &Matrix, vector: [f64; 2]) -> [f64; 2] {
    matrix.map(|row| row[0] * vector[0] + row[1] * vector[1])
}

/// The inverse of a matrix, if it has one.
pub(crate) fn inverse([[a, b], [c, d]]: Matrix) -> Option<Matrix> {
    let determinant = a * d - b * c;
    let inverse = [[d, -b], [-c, a]].map(|row| row.map(|value| value / determinant));
    inverse.iter().flatten().all(|value| value.is_finite()).then_some(inverse)
}

/// The inverse of a Jacobian after a step of the unknowns that has changed the equations by so much.
pub(crate) fn updated(inverse: &Matrix, step: [f64; 2], change: [f64; 2]) -> Matrix {
    let expected = product(inverse, change);
    let weights = [0, 1].map(|column| step[0] * inverse[0][column] + step[1] * inverse[1][column]);
    let scale = step[0] * expected[0] + step[1] * expected[1];
    let entry =
        |row: usize, column: usize| inverse[row][column] + (step[row] - expected[row]) * weights[column] / scale;
    [[entry(0, 0), entry(0, 1)], [entry(1, 0), entry(1, 1)]]
}
