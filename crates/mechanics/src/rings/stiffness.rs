//! Rings of equal area, and the stiffness of a half-space against their displacements.
//!
//! A constant traction tau_j on a ring is, in the foundation of the MDR, the line load tau_j phi_j(t) with
//! phi_j(t) = 2 [sqrt(r_j^2 - t^2) - sqrt(r_(j-1)^2 - t^2)], where roots of negative numbers are zero (Popov & Heß
//! 2015). So the elastic energy of all rings is tau A tau/2 with A_jk = (2/G*) int_0^a phi_j phi_k dt, and the mean
//! displacement of a ring is (A tau)_j/W_j, W_j its area. Lengths here are relative to the outermost radius a, forces
//! to G* a times the unit of displacement.

use std::f64::consts::{FRAC_PI_2, PI};

/// Rings between the radii sqrt(j/N).
#[derive(Debug)]
pub(super) struct RingStiffness {
    pub(super) count: usize,
    /// The force on each ring by the displacements of all, row by row.
    stiffness: Vec<f64>,
    /// The same where the sum of all forces is given, and the common displacement follows.
    held: Vec<f64>,
    /// The force on each ring when all move by one.
    together: Vec<f64>,
    /// The sum of these: 2 of a continuous foundation.
    pub(super) total: f64,
}

impl RingStiffness {
    pub(super) fn new(count: usize) -> RingStiffness {
        let overlap = |j: usize, k: usize| overlap((j as f64 / count as f64).sqrt(), (k as f64 / count as f64).sqrt());
        let overlaps: Vec<f64> =
            (0..=count).flat_map(|j| (0..=count).map(move |k| overlap(j.max(k), j.min(k)))).collect();
        let at = |j: usize, k: usize| overlaps[j * (count + 1) + k];
        let area = PI / count as f64;
        let mut compliance = vec![0.0; count * count];
        for (j, row) in compliance.chunks_exact_mut(count).enumerate() {
            for (k, entry) in row.iter_mut().enumerate() {
                let crossed = (at(j + 1, k + 1) - at(j, k + 1)) - (at(j + 1, k) - at(j, k));
                *entry = 8.0 * crossed / (area * area);
            }
        }
        let stiffness = inverse(compliance, count);
        let together: Vec<f64> = stiffness.chunks_exact(count).map(|row| row.iter().sum()).collect();
        let total: f64 = together.iter().sum();
        let mut held = stiffness.clone();
        for (row, own) in held.chunks_exact_mut(count).zip(&together) {
            row.iter_mut().zip(&together).for_each(|(entry, other)| *entry -= own * other / total);
        }
        RingStiffness { count, stiffness, held, together, total }
    }

    /// The stiffness, row by row: against given displacements, or under a given sum of forces.
    pub(super) fn stiffness(&self, force_given: bool) -> &[f64] {
        if force_given { &self.held } else { &self.stiffness }
    }

    /// The share of each ring in the force that all carry when they move together, times [`RingStiffness::total`].
    pub(super) fn together(&self) -> &[f64] {
        &self.together
    }

    /// Outer radius of the ring before the one of this number.
    pub(super) fn radius(&self, index: usize) -> f64 {
        (index as f64 / self.count as f64).sqrt()
    }
}

/// A vector in the plane.
pub(super) type Vector = [f64; 2];

/// int_0^s sqrt(r^2 - t^2) sqrt(s^2 - t^2) dt for s <= r: with k = s/r it is s^2 r [(1 + k^2) E(k) - (1 - k^2) K(k)]/(3
/// k^2), with the complete elliptic integrals by the arithmetic-geometric mean (Abramowitz & Stegun 1972, 17.6).
fn overlap(r: f64, s: f64) -> f64 {
    if s <= 0.0 {
        return 0.0;
    }
    let square = (s / r) * (s / r);
    if square >= 1.0 {
        return 2.0 / 3.0 * s * s * r;
    }
    let (mut mean, mut other, mut power, mut sum) = (1.0, (1.0 - square).sqrt(), 0.5, 0.5 * square);
    for _ in 0..8 {
        let half = 0.5 * (mean - other);
        (mean, other) = (0.5 * (mean + other), (mean * other).sqrt());
        power *= 2.0;
        sum += power * half * half;
    }
    let first = FRAC_PI_2 / mean;
    let second = first * (1.0 - sum);
    s * s * r * ((1.0 + square) * second - (1.0 - square) * first) / (3.0 * square)
}

/// The inverse of a positive definite matrix, by Gauss and Jordan without pivots.
fn inverse(mut matrix: Vec<f64>, size: usize) -> Vec<f64> {
    for pivot in 0..size {
        let inverse = matrix[pivot * size + pivot].recip();
        matrix[pivot * size + pivot] = 1.0;
        matrix[pivot * size..(pivot + 1) * size].iter_mut().for_each(|entry| *entry *= inverse);
        let row: Vec<f64> = matrix[pivot * size..(pivot + 1) * size].to_vec();
        for (index, other) in matrix.chunks_exact_mut(size).enumerate().filter(|(index, _)| *index != pivot) {
            debug_assert!(index < size);
            let factor = std::mem::replace(&mut other[pivot], 0.0);
            other.iter_mut().zip(&row).for_each(|(entry, of_pivot)| *entry -= factor * of_pivot);
        }
    }
    // Symmetric but for rounding, on which the solver of a step relies.
    for j in 0..size {
        for k in 0..j {
            let mean = 0.5 * (matrix[j * size + k] + matrix[k * size + j]);
            matrix[j * size + k] = mean;
            matrix[k * size + j] = mean;
        }
    }
    matrix
}

#[cfg(test)]
mod tests {
    use super::{RingStiffness, overlap};
    use crate::numerics::gauss::{TWENTY_POINTS, integral};

    #[test]
    fn overlaps_of_ring_loads_are_their_integrals() {
        for s in [0.1_f64, 0.5, 0.9, 0.999, 1.0] {
            // t = s sin(x) takes the root at the upper end away.
            let inner = |x: f64| (1.0 - (s * x.sin()).powi(2)).sqrt() * (s * x.cos()).powi(2);
            let panels = (0..8).map(|panel| {
                let width = std::f64::consts::FRAC_PI_2 / 8.0;
                integral(&TWENTY_POINTS, width, |x| inner(f64::from(panel) * width + x))
            });
            let expected: f64 = panels.sum();
            assert!((overlap(1.0, s) - expected).abs() < 1e-6 * expected, "{s}: {} {expected}", overlap(1.0, s));
        }
        assert!((overlap(2.0, 1.0) / (8.0 * overlap(1.0, 0.5)) - 1.0).abs() < 1e-14);
    }

    #[test]
    fn rings_that_move_together_are_as_stiff_as_a_flat_punch() {
        // 2 G* a, Mindlin (1949); the mean displacement of a ring knows less than every point of it.
        let errors: Vec<f64> =
            [10, 20, 40].into_iter().map(|count| RingStiffness::new(count).total / 2.0 - 1.0).collect();
        assert!(errors[2].abs() < 4e-3, "{errors:?}");
        assert!(errors.windows(2).all(|pair| pair[1].abs() < 0.6 * pair[0].abs()), "{errors:?}");
    }
}
