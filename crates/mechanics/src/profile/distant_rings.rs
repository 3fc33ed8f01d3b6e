//! The kernels of many rings of a parabola, far from the radii that they are wanted at: near-linear in rings and radii.
//!
//! In units of the edge, X = xi^2 and Y = rho^2, a ring of weight w adds (c_1/2) w int dX/sqrt(X - Y): clusters of
//! rings are [`Multipole`]s. Their intervals begin at their own inner ends, so that a history within a millionth of the
//! edge keeps its digits, and the moments of the smallest ones are sums over the ends of rings: int P_n = (P_(n+1) -
//! P_(n-1))/(2n + 1).

use std::ops::Range;

use crate::numerics::cluster_tree::{Cluster, ClusterTree};
use crate::numerics::multipole::{Multipole, ORDERS, add_polynomials};

/// Rings in the smallest clusters.
const LEAF: usize = 12;

/// Clusters of rings from the edge inward.
pub(super) struct DistantRings(ClusterTree<Multipole>);

impl DistantRings {
    /// Rings by their gaps, differences of X, and weights.
    pub(super) fn new(rings: &[(f64, f64)]) -> DistantRings {
        DistantRings(ClusterTree::new(rings.len(), LEAF, |items, halves: Option<[&Multipole; 2]>| match halves {
            None => of_rings(&rings[items.clone()]),
            Some([outer, inner]) => {
                let (below, width) = (inner.interval.1, inner.interval.1 + outer.interval.1);
                let mut sources = Multipole::empty((0.0, width));
                sources.add_part((0.0, below), &inner.moments, 1.0);
                sources.add_part((below, width), &outer.moments, 1.0);
                sources
            }
        }))
    }

    /// Twice what the first `count` rings add to the sum of v_outer - v_inner times weights, where they are far from
    /// all places; `near` gets the runs of those that are not. `distance` is how far the inner end of a ring is beyond
    /// all the places, less its rounding, and `excess` how far it is beyond each.
    pub(super) fn sum<const N: usize>(
        &self,
        count: usize,
        distance: impl Fn(usize) -> f64,
        excess: impl Fn(usize) -> [f64; N],
        mut near: impl FnMut(Range<usize>),
    ) -> [f64; N] {
        let mut sums = [0.0; N];
        let mut far = |cluster: &Cluster<Multipole>| {
            let innermost = cluster.items.end - 1;
            let is_far = cluster.sources.is_far(-distance(innermost));
            if is_far {
                let potentials = cluster.sources.potentials(excess(innermost).map(|above| -above));
                sums.iter_mut().zip(potentials).for_each(|(sum, potential)| *sum += potential);
            }
            is_far
        };
        self.0.visit(0..count, &mut far, &mut near);
        sums
    }
}

/// Some rings.
fn of_rings(rings: &[(f64, f64)]) -> Multipole {
    // From the inner end on: how far each end is from it, and by how much the weight changes there.
    let (mut ends, mut changes) = ([0.0; LEAF + 1], [0.0; LEAF + 1]);
    let (mut reached, mut before) = (0.0, 0.0);
    for (index, &(gap, weight)) in rings.iter().rev().enumerate() {
        (ends[index], changes[index]) = (reached, before - weight);
        (reached, before) = (reached + gap, weight);
    }
    (ends[rings.len()], changes[rings.len()]) = (reached, before);
    let half = 0.5 * reached;
    let scale = if half > 0.0 { half.recip() } else { 0.0 };
    let mut sums = [0.0; ORDERS + 1];
    add_polynomials(&mut sums, &ends.map(|end| end * scale - 1.0), &changes);
    let mut sources = Multipole::empty((0.0, reached));
    sources.moments[0] = rings.iter().map(|(gap, weight)| gap * weight).sum();
    for n in 1..ORDERS {
        sources.moments[n] = half * (sums[n + 1] - sums[n - 1]) / (2 * n + 1) as f64;
    }
    sources
}
