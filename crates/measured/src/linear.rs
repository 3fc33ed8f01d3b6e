//! Small dense symmetric matrices and their Cholesky factors.

/// A symmetric matrix, all of whose elements are stored row by row.
#[derive(Clone, Debug)]
pub(crate) struct Symmetric {
    size: usize,
    elements: Vec<f64>,
}

impl Symmetric {
    pub(crate) fn zero(size: usize) -> Symmetric {
        Symmetric { size, elements: vec![0.0; size * size] }
    }

    pub(crate) fn size(&self) -> usize {
        self.size
    }

    pub(crate) fn at(&self, row: usize, column: usize) -> f64 {
        self.elements[row * self.size + column]
    }

    /// Adds to an element, and to its mirror image.
    pub(crate) fn add(&mut self, row: usize, column: usize, value: f64) {
        self.elements[row * self.size + column] += value;
        if row != column {
            self.elements[column * self.size + row] += value;
        }
    }

    /// Adds to one element alone: the caller adds to its mirror image too.
    pub(crate) fn add_one(&mut self, row: usize, column: usize, value: f64) {
        self.elements[row * self.size + column] += value;
    }

    pub(crate) fn subtract(&mut self, other: &Symmetric) {
        self.elements.iter_mut().zip(&other.elements).for_each(|(element, other)| *element -= other);
    }

    pub(crate) fn row(&self, row: usize) -> &[f64] {
        &self.elements[row * self.size..(row + 1) * self.size]
    }

    /// v' A v.
    pub(crate) fn quadratic(&self, v: &[f64]) -> f64 {
        (0..self.size).map(|row| v[row] * dot(self.row(row), v)).sum()
    }

    /// The trace of the product with another symmetric matrix.
    pub(crate) fn trace_of_product(&self, other: &Symmetric) -> f64 {
        dot(&self.elements, &other.elements)
    }

    /// The lower factor, if the matrix is positive definite to round-off.
    pub(crate) fn cholesky(&self) -> Option<Cholesky> {
        let mut factor = self.clone();
        let size = self.size;
        for column in 0..size {
            let (above, rest) = factor.elements.split_at_mut(column * size);
            let row = &mut rest[..size];
            // Row by row, so that the inner products run along them.
            for earlier in 0..column {
                row[earlier] = (row[earlier] - dot(&row[..earlier], &above[earlier * size..][..earlier]))
                    / above[earlier * size + earlier];
            }
            let pivot = row[column] - dot(&row[..column], &row[..column]);
            if pivot <= 1e-14 * self.at(column, column) {
                return None;
            }
            row[column] = pivot.sqrt();
        }
        Some(Cholesky { factor })
    }
}

/// The factor L of A = L L'.
pub(crate) struct Cholesky {
    factor: Symmetric,
}

impl Cholesky {
    /// The solution of A x = b.
    pub(crate) fn solve(&self, right: &[f64]) -> Vec<f64> {
        let size = self.factor.size;
        let mut x = right.to_vec();
        for row in 0..size {
            let line = self.factor.row(row);
            x[row] = (x[row] - dot(&line[..row], &x[..row])) / line[row];
        }
        for row in (0..size).rev() {
            let line = self.factor.row(row);
            x[row] /= line[row];
            let known = x[row];
            x[..row].iter_mut().zip(&line[..row]).for_each(|(x, factor)| *x -= factor * known);
        }
        x
    }

    /// The inverse of A.
    pub(crate) fn inverse(&self) -> Symmetric {
        let size = self.factor.size;
        // Row i of L^-1 follows from those before it.
        let mut lower = vec![0.0; size * size];
        for row in 0..size {
            let line = self.factor.row(row);
            let (before, rest) = lower.split_at_mut(row * size);
            let found = &mut rest[..=row];
            for (earlier, factor) in line[..row].iter().enumerate() {
                let known = &before[earlier * size..][..=earlier];
                found.iter_mut().zip(known).for_each(|(sum, known)| *sum -= factor * known);
            }
            found[row] = 1.0;
            found.iter_mut().for_each(|value| *value /= line[row]);
        }
        // A^-1 = L^-T L^-1, one rank at a time.
        let mut inverse = Symmetric::zero(size);
        for row in 0..size {
            let found = &lower[row * size..][..=row];
            for (index, &value) in found.iter().enumerate() {
                let sums = &mut inverse.elements[index * size..][..=index];
                sums.iter_mut().zip(found).for_each(|(sum, other)| *sum += value * other);
            }
        }
        for row in 0..size {
            for column in 0..row {
                inverse.elements[column * size + row] = inverse.elements[row * size + column];
            }
        }
        inverse
    }
}

pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_inverse_undoes_its_matrix() {
        // The Hilbert matrix with a ridge.
        let mut matrix = Symmetric::zero(6);
        for row in 0..6 {
            for column in 0..=row {
                matrix.add(row, column, 1.0 / (row + column + 1) as f64);
            }
            matrix.add(row, row, 0.1);
        }
        let factor = matrix.cholesky().unwrap();
        let inverse = factor.inverse();
        for row in 0..6 {
            let mut unit = vec![0.0; 6];
            unit[row] = 1.0;
            let solved = factor.solve(&unit);
            for column in 0..6 {
                let product = dot(matrix.row(column), inverse.row(row));
                assert!((product - unit[column]).abs() < 1e-13);
                assert!((solved[column] - inverse.at(row, column)).abs() < 1e-13);
            }
        }
        matrix.add(0, 0, -9.0);
        assert!(matrix.cholesky().is_none());
    }
}
