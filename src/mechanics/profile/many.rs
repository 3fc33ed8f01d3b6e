//! The kernels of many adjoining rings, weighted and summed, at many radii.
//!
//! For the sphere K(r, x_outer) - K(r, x_inner) = (2/R) (x_outer^2 - x_inner^2)/(s_outer + s_inner), s = sqrt(x^2 - r^2): neighbours
//! share a root, the differences of the squares are known, and what is left runs over plain arrays, several rings at a time.

use super::{At, Profile, Ring, Sphere};

/// Additions that go on side by side: floating-point sums are not reordered by the compiler.
const LANES: usize = 4;

impl Profile {
    /// The sum of [`Profile::kernel`] times a weight over rings that adjoin each other from the centre outward, at each of
    /// `radii` (m).
    #[must_use]
    pub fn kernel_sums(&self, rings: &[(Ring, f64)], radii: &[f64]) -> Vec<f64> {
        if let Profile::Sphere(sphere) = self {
            let mut roots = Roots::new(sphere, rings);
            return radii.iter().map(|&radius| roots.sum(&At::radius(radius))).collect();
        }
        radii.iter().map(|&radius| self.kernel_sum(rings, &At::radius(radius))).collect()
    }

    fn kernel_sum(&self, rings: &[(Ring, f64)], at: &At) -> f64 {
        let beyond = rings.iter().rev().take_while(|(ring, _)| ring.outer.radius >= at.radius);
        beyond.filter(|(_, weight)| weight.abs() > 0.0).map(|(ring, weight)| weight * self.kernel(at, ring)).sum()
    }
}

/// Rings of a sphere as arrays.
struct Roots {
    /// x^2 where the rings meet, both parts, from the inner end of the first to the outer end of the last.
    squares: Vec<f64>,
    rests: Vec<f64>,
    /// (2/R) (x_outer^2 - x_inner^2) times the weight of each.
    shares: Vec<f64>,
    /// (2/R) times the weight of each.
    weights: Vec<f64>,
    roots: Vec<f64>,
}

impl Roots {
    fn new(sphere: &Sphere, rings: &[(Ring, f64)]) -> Roots {
        let first = rings.first().map(|(ring, _)| ring.inner.square);
        let squares = || first.into_iter().chain(rings.iter().map(|(ring, _)| ring.outer.square));
        let factor = 2.0 / sphere.curvature_radius();
        Roots {
            squares: squares().map(|square| square.parts().0).collect(),
            rests: squares().map(|square| square.parts().1).collect(),
            // x_outer^2 - x_inner^2 = R (y_outer - y_inner).
            shares: rings.iter().map(|(ring, weight)| 2.0 * weight * ring.depth).collect(),
            weights: rings.iter().map(|(_, weight)| weight * factor).collect(),
            roots: vec![0.0; rings.len() + 1],
        }
    }

    fn sum(&mut self, at: &At) -> f64 {
        let (square, rest) = at.square.parts();
        // Squares that nearly agree cancel without a loss, and the rest is what rounding them has lost.
        let excess = |place: usize, squares: &[f64], rests: &[f64]| (squares[place] - square) + (rests[place] - rest);
        // The rings rise outward, so that the first to reach beyond r is found by halving.
        let (mut low, mut high) = (0, self.shares.len());
        while low < high {
            let middle = low.midpoint(high);
            if excess(middle + 1, &self.squares, &self.rests) > 0.0 { high = middle } else { low = middle + 1 }
        }
        let cut = low;
        if cut == self.shares.len() {
            return 0.0;
        }
        #[cfg(test)]
        (cut..self.shares.len()).for_each(|_| super::count::add(|calls| &mut calls.kernel));
        let places = self.squares[cut + 1..].iter().zip(&self.rests[cut + 1..]);
        for (root, (one, other)) in self.roots[cut + 1..].iter_mut().zip(places) {
            *root = ((one - square) + (other - rest)).sqrt();
        }
        let inner = excess(cut, &self.squares, &self.rests);
        let reached = self.roots[cut + 1];
        let partial =
            if inner > 0.0 { self.shares[cut] / (reached + inner.sqrt()) } else { self.weights[cut] * reached };
        let (inner, outer, shares) = (&self.roots[cut + 1..], &self.roots[cut + 2..], &self.shares[cut + 1..]);
        let mut lanes = [0.0; LANES];
        let chunks = inner.chunks_exact(LANES).zip(outer.chunks_exact(LANES)).zip(shares.chunks_exact(LANES));
        for ((inner, outer), shares) in chunks {
            for lane in 0..LANES {
                lanes[lane] += shares[lane] / (inner[lane] + outer[lane]);
            }
        }
        let whole = shares.len() - shares.len() % LANES;
        let left = inner[whole..].iter().zip(&outer[whole..]).zip(&shares[whole..]);
        partial + lanes.iter().sum::<f64>() + left.map(|((inner, outer), share)| share / (inner + outer)).sum::<f64>()
    }
}
