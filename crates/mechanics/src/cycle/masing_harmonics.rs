//! The harmonics of a steady cycle whose displacement is driven, without a machine.
//!
//! With c = cos(th), h = S (1 - c)/2 the depth that a branch has slipped and S that which the drive would, the
//! integrals of [`harmonics`](super::harmonics) are taken by parts once more: with e_m = th - sin(2 m th)/(2 m), q_m =
//! sin^2(m th)/m and n = 2 m + 1,
//!
//! int_0^h sin(n th) dh = (S/4) (e_(m+1) - e_m), int_0^h cos(n th) dh = (S/4) (q_(m+1) - q_m),
//!
//! so that int sin(n th) X dh is an integral over the radii of the ring, for which no profile has to be inverted.

use std::f64::consts::PI;

use super::{SteadyCycle, sphere_harmonics};
use crate::profile::ring_nodes::{DepthNode, RingNodes};

/// Angles below which x - sin(x) is summed, of so many terms.
const SMALL: f64 = 1.0;
const TERMS: usize = 9;

/// Sums of e_m and q_m, for m from zero on.
type HarmonicSums = Vec<[f64; 2]>;

/// int sin(n th) dR and int cos(n th) dR for odd n up to `count`, without the straight part unless the contact slides;
/// where they are not resolved to round-off, also by a coarser rule.
pub(super) fn integrals(cycle: &SteadyCycle<'_>, count: usize) -> (HarmonicSums, Option<HarmonicSums>) {
    let (contact, ring) = (cycle.contact, &cycle.ring);
    let orders = count.div_ceil(2);
    if ring.depth <= 0.0 {
        return (vec![[0.0; 2]; orders], None);
    }
    let slides = cycle.slide > 0.0;
    let total = ring.depth + cycle.slide / contact.scale();
    if let Some(sums) = sphere_harmonics::integrals(cycle, total, count) {
        return (sums, None);
    }
    let unit = 2.0 * contact.elasticity.g_star() * contact.scale() * 0.25 * total;
    let result = |nodes: &[DepthNode]| {
        let mut sums = vec![[0.0; 2]; orders + 1];
        for node in nodes {
            add(&mut sums, node.weight, node.depth, total);
        }
        if slides {
            add(&mut sums, ring.inner.radius, ring.depth, total);
        } else {
            sums[0][0] += PI * cycle.moments.width;
        }
        sums.windows(2).map(|pair| [0, 1].map(|kind| unit * (pair[1][kind] - pair[0][kind]))).collect::<HarmonicSums>()
    };
    match contact.profile.ring_nodes(ring, total, count + 1) {
        RingNodes::Resolved(nodes) => (result(&nodes), None),
        RingNodes::Compared(coarse, fine) => (result(&fine), Some(result(&coarse))),
    }
}

/// Adds e_m and q_m where the drive has fallen by `depth` of `total`, m from one on; both are zero at m = 0.
fn add(sums: &mut HarmonicSums, weight: f64, depth: f64, total: f64) {
    let left = (total - depth).max(0.0);
    let (sin, cos) = (2.0 * (depth * left).sqrt() / total, (left - depth) / total);
    let angle = sin.atan2(cos);
    let (mut turned, mut m) = ([sin, cos], 1.0);
    for sum in &mut sums[1..] {
        let [s, c] = turned;
        let double = 2.0 * m * angle;
        let less = if double < SMALL { less_sine(double) } else { double - 2.0 * s * c };
        sum[0] += weight * less / (2.0 * m);
        sum[1] += weight * s * s / m;
        turned = [s * cos + c * sin, c * cos - s * sin];
        m += 1.0;
    }
}

/// x - sin(x) of a small x, to round-off of itself.
fn less_sine(x: f64) -> f64 {
    let (square, mut sum) = (x * x, 1.0);
    for term in (2..TERMS).rev() {
        let order = 2.0 * term as f64;
        sum = 1.0 - square * sum / (order * (order + 1.0));
    }
    x * square / 6.0 * sum
}
