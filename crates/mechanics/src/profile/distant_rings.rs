//! The kernels of many rings of a parabola, far from the radii that they are wanted at: near-linear in rings and radii.
//!
//! In units of the edge, z = xi^2 and Y = rho^2, a ring of weight w adds (c_1/2) w int dz/sqrt(z - Y). Over a cluster of rings of the
//! half-width h about z_0, with zeta = (z - z_0)/h, Z = (z_0 - Y)/h and Z = (t + 1/t)/2, Legendre's generating function says
//!
//! 1/sqrt(Z + zeta) = sqrt(2 t) sum of (-t)^n P_n(zeta),
//!
//! so that a cluster is its moments L_n = int w P_n(zeta) dz. It counts as far from its own width on, where Z >= 3 and t <= 0.172: what twenty
//! terms leave is below 5e-16 of the ring of weight one that the cluster fills, and the rounding of the sums over n rings, eps sqrt(n), comes
//! with a factor t. Lengths are measured from the cluster's own inner end, so that a history within a millionth of the edge keeps its digits.
//!
//! The moments are sums over the ends of rings: int P_n = (P_(n+1) - P_(n-1))/(2n + 1), where sums of Chebyshev's polynomials, which take the
//! fewest operations, give those of Legendre's.

use std::ops::Range;

use super::slope_series::{LANES, Lanes};

/// Terms of an expansion where t is largest, and the Z from which fewer do.
const TERMS: usize = 20;
const FEWER: [(f64, usize); 2] = [(12.0, 12), (6.0, 15)];
/// Polynomials that the moments take.
const SUMS: usize = TERMS + 1;
/// Rings in the smallest clusters.
const LEAF: usize = 12;
/// Ends whose polynomials are found side by side.
const BLOCK: usize = 4;
/// C(2j, j)/4^j, by which P_n(cos x) = sum over j of a_j a_(n-j) cos((n - 2j) x).
const SHARES: [f64; SUMS] = {
    let mut shares = [1.0; SUMS];
    let mut j = 1;
    while j < SUMS {
        shares[j] = shares[j - 1] * (2 * j - 1) as f64 / (2 * j) as f64;
        j += 1;
    }
    shares
};

/// Consecutive rings, from the edge inward.
struct Cluster {
    rings: Range<usize>,
    /// Half the difference of z between its ends.
    half: f64,
    moments: [f64; TERMS],
    /// The two clusters it is made of.
    parts: Option<[usize; 2]>,
}

/// Clusters of rings from the edge inward.
pub(super) struct DistantRings {
    clusters: Vec<Cluster>,
}

impl DistantRings {
    /// Rings by their gaps, differences of z, and weights.
    pub(super) fn new(rings: &[(f64, f64)]) -> DistantRings {
        let mut tree = DistantRings { clusters: Vec::with_capacity(2 * rings.len().div_ceil(LEAF / 2)) };
        if !rings.is_empty() {
            let mut ends = Vec::with_capacity(rings.len() + BLOCK);
            tree.build(rings, 0..rings.len(), &mut ends);
        }
        tree
    }

    fn build(&mut self, all: &[(f64, f64)], rings: Range<usize>, ends: &mut Vec<(f64, f64)>) -> usize {
        let (half, moments) = moments(&all[rings.clone()], ends);
        let parts = (rings.len() > LEAF).then(|| {
            let middle = rings.start.midpoint(rings.end);
            [rings.start..middle, middle..rings.end].map(|part| self.build(all, part, ends))
        });
        self.clusters.push(Cluster { rings, half, moments, parts });
        self.clusters.len() - 1
    }

    /// Gathers the clusters that are far, and the runs of rings that are not, as `distance` has it: how far the inner end of a ring is
    /// beyond all the places. Rings behind the one that contains the innermost place, `last`, do not count.
    pub(super) fn divide(
        &self,
        last: usize,
        distance: impl Fn(usize) -> f64,
        far: &mut Vec<usize>,
        near: &mut Vec<Range<usize>>,
    ) {
        far.clear();
        near.clear();
        let mut open: Vec<usize> = self.clusters.len().checked_sub(1).into_iter().collect();
        while let Some(index) = open.pop() {
            let Cluster { rings, half, parts, .. } = &self.clusters[index];
            if rings.start > last {
                continue;
            }
            if *half > 0.0 && distance(rings.end - 1) >= 2.0 * half {
                far.push(index);
            } else if let Some([outer, inner]) = parts {
                open.extend([*inner, *outer]);
            } else {
                match near.last_mut() {
                    Some(run) if run.end == rings.start => run.end = rings.end,
                    _ => near.push(rings.clone()),
                }
            }
        }
    }

    /// Twice what far clusters add to the sum of v_outer - v_inner times weights; `excess` is how far the inner end of a ring is beyond each
    /// place.
    pub(super) fn sum(&self, far: &[usize], excess: impl Fn(usize) -> Lanes) -> Lanes {
        let mut sums = [0.0; LANES];
        for &index in far {
            let Cluster { rings, half, moments, .. } = &self.clusters[index];
            let recip = half.recip();
            let ratio = excess(rings.end - 1).map(|below| below * recip + 1.0);
            let least = ratio.into_iter().fold(f64::INFINITY, f64::min);
            let terms = FEWER.iter().find(|(from, _)| least >= *from).map_or(TERMS, |(_, terms)| *terms);
            let t = ratio.map(|z| 1.0 / (z + ((z - 1.0) * (z + 1.0)).sqrt()));
            let mut series = [0.0; LANES];
            for moment in moments[..terms].iter().rev() {
                for lane in 0..LANES {
                    series[lane] = moment - t[lane] * series[lane];
                }
            }
            for lane in 0..LANES {
                sums[lane] += (2.0 * recip * t[lane]).sqrt() * series[lane];
            }
        }
        sums
    }
}

/// Half the width of a cluster and its moments; `ends` is room to work in.
fn moments(rings: &[(f64, f64)], ends: &mut Vec<(f64, f64)>) -> (f64, [f64; TERMS]) {
    // From the inner end on: how far each end is from it, and by how much the weight changes there.
    ends.clear();
    let (mut reached, mut before) = (0.0, 0.0);
    for &(gap, weight) in rings.iter().rev() {
        ends.push((reached, before - weight));
        (reached, before) = (reached + gap, weight);
    }
    ends.push((reached, before));
    while !ends.len().is_multiple_of(BLOCK) {
        ends.push((0.0, 0.0));
    }
    let half = 0.5 * reached;
    let scale = if half > 0.0 { 2.0 / half } else { 0.0 };
    let mut sums = [[0.0; BLOCK]; SUMS];
    for block in ends.chunks_exact(BLOCK) {
        let twice: [f64; BLOCK] = std::array::from_fn(|lane| block[lane].0 * scale - 2.0);
        let mut this: [f64; BLOCK] = std::array::from_fn(|lane| block[lane].1);
        let mut before: [f64; BLOCK] = std::array::from_fn(|lane| 0.5 * twice[lane] * this[lane]);
        for sum in &mut sums {
            for lane in 0..BLOCK {
                sum[lane] += this[lane];
                (this[lane], before[lane]) = (twice[lane] * this[lane] - before[lane], this[lane]);
            }
        }
    }
    let waves = sums.map(|sum| (sum[0] + sum[1]) + (sum[2] + sum[3]));
    let legendre: [f64; SUMS] =
        std::array::from_fn(|n| (0..=n).map(|j| SHARES[j] * SHARES[n - j] * waves[n.abs_diff(2 * j)]).sum());
    let mut moments = [rings.iter().map(|(gap, weight)| gap * weight).sum(); TERMS];
    for n in 1..TERMS {
        moments[n] = half * (legendre[n + 1] - legendre[n - 1]) / (2 * n + 1) as f64;
    }
    (half, moments)
}
