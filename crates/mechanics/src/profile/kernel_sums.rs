//! The kernels of many adjoining rings, weighted and summed, at many radii.
//!
//! For the sphere K(r, x_outer) - K(r, x_inner) = (2/R) (x_outer^2 - x_inner^2)/(s_outer + s_inner), s = sqrt(x^2 - r^2): neighbours
//! share a root, the differences of the squares are known, and what is left runs over plain arrays, several radii at a time.

#[cfg(test)]
use super::call_count;
use super::shape::Shape;
use super::{DoubleDouble, Profile, Ring, StressRadius};

/// Radii that are summed for side by side: roots and divisions take long, and one need not wait for another's.
const LANES: usize = 8;

impl Profile {
    /// The sum of [`Profile::kernel`] times a weight over rings that adjoin each other from the centre outward, at each of
    /// `radii` (m).
    #[must_use]
    pub fn kernel_sums(&self, rings: &[(Ring, f64)], radii: &[f64]) -> Vec<f64> {
        let ring_by_ring = || radii.iter().map(|&radius| self.kernel_sum(rings, &StressRadius::new(radius))).collect();
        Shape::kernel_sums(self, rings, radii).unwrap_or_else(ring_by_ring)
    }

    fn kernel_sum(&self, rings: &[(Ring, f64)], at: &StressRadius) -> f64 {
        let beyond = rings.iter().rev().take_while(|(ring, _)| ring.outer.radius >= at.radius);
        beyond.filter(|(_, weight)| weight.abs() > 0.0).map(|(ring, weight)| weight * self.kernel(at, ring)).sum()
    }
}

/// Rings of a sphere as arrays, from the edge inward.
pub(super) struct Roots {
    /// The outer edge.
    edge: DoubleDouble,
    rings: Vec<Inward>,
}

/// The terms of a ring that do not depend on its outer end.
struct Inward {
    /// x_inner^2, m^2, both parts.
    square: f64,
    rest: f64,
    /// (2/R) (x_outer^2 - x_inner^2) times the weight.
    share: f64,
    /// (2/R) times the weight.
    weight: f64,
}

impl Roots {
    /// The rings of a sphere of this curvature radius, m, and their weights.
    pub(super) fn new(curvature_radius: f64, rings: &[(Ring, f64)]) -> Roots {
        let factor = 2.0 / curvature_radius;
        let inward = |(ring, weight): &(Ring, f64)| {
            let (square, rest) = ring.inner.square.parts();
            // x_outer^2 - x_inner^2 = R (y_outer - y_inner).
            Inward { square, rest, share: 2.0 * weight * ring.depth, weight: weight * factor }
        };
        Roots {
            edge: rings.last().map_or(DoubleDouble::ZERO, |(ring, _)| ring.outer.square),
            rings: rings.iter().rev().map(inward).collect(),
        }
    }

    /// The sums at each radius, m.
    pub(super) fn sums(&self, radii: &[f64]) -> Vec<f64> {
        let mut sums = Vec::with_capacity(radii.len());
        for radii in radii.chunks(LANES) {
            // Lanes left over repeat the first.
            let mut squares = [DoubleDouble::square_of(radii[0]); LANES];
            for (square, &radius) in squares.iter_mut().zip(radii) {
                *square = DoubleDouble::square_of(radius);
            }
            sums.extend_from_slice(&self.lanes(&squares)[..radii.len()]);
        }
        sums
    }

    /// The sums at as many radii as there are lanes, whose squares are given.
    fn lanes(&self, squares: &[DoubleDouble; LANES]) -> [f64; LANES] {
        let (square, rest) = (squares.map(|square| square.parts().0), squares.map(|square| square.parts().1));
        let least = square.iter().copied().fold(f64::INFINITY, f64::min);
        let greatest = square.iter().copied().fold(0.0, f64::max);
        // Squares that nearly agree cancel without a loss, and the rest is what rounding them has lost.
        let excess = |lane: usize, one: f64, other: f64| (one - square[lane]) + (other - rest[lane]);
        let (one, other) = self.edge.parts();
        let mut reached: [f64; LANES] = std::array::from_fn(|lane| root_of(excess(lane, one, other)));
        let mut sums = [0.0; LANES];
        // Most rings lie clearly beyond all the radii of this chunk, and need no choice.
        let clear = greatest * (1.0 + 4.0 * f64::EPSILON);
        let (beyond, others) = self.rings.split_at(self.rings.partition_point(|ring| ring.square > clear));
        for ring in beyond {
            #[cfg(test)]
            call_count::add(|calls| &mut calls.kernel);
            let root: [f64; LANES] = std::array::from_fn(|lane| excess(lane, ring.square, ring.rest).sqrt());
            for lane in 0..LANES {
                sums[lane] += ring.share / (reached[lane] + root[lane]);
            }
            reached = root;
        }
        for ring in others {
            #[cfg(test)]
            call_count::add(|calls| &mut calls.kernel);
            let root: [f64; LANES] = std::array::from_fn(|lane| root_of(excess(lane, ring.square, ring.rest)));
            for lane in 0..LANES {
                let whole = ring.share / (reached[lane] + root[lane]);
                let cut = ring.weight * reached[lane];
                sums[lane] += if root[lane] > 0.0 { whole } else { cut };
            }
            reached = root;
            if ring.square < least {
                break;
            }
        }
        sums
    }
}

/// The root of what is positive, and zero of all else.
fn root_of(square: f64) -> f64 {
    (if square > 0.0 { square } else { 0.0 }).sqrt()
}
