//! Moments of adjoining rings: those of any run of them, from a few sums that are known already.

use std::ops::Range;

use super::ring::Moments;

/// Moments and depth, m, of all runs of rings, as a binary tree with the leaves in its second half.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct MomentTree(Vec<(Moments, f64)>);

impl MomentTree {
    /// The tree over rings from the centre outward, each with its depth, m.
    pub(crate) fn new(rings: impl ExactSizeIterator<Item = (Moments, f64)>) -> MomentTree {
        let leaves = rings.len().next_power_of_two();
        let mut tree = vec![(Moments::default(), 0.0); 2 * leaves];
        for (leaf, ring) in tree[leaves..].iter_mut().zip(rings) {
            *leaf = ring;
        }
        for index in (1..leaves).rev() {
            tree[index] = join(tree[2 * index], tree[2 * index + 1]);
        }
        MomentTree(tree)
    }

    /// The rings first..last together.
    pub(crate) fn run(&self, first: usize, last: usize) -> (Moments, f64) {
        let leaves = self.0.len() / 2;
        let (mut low, mut high) = (first + leaves, last + leaves);
        let (mut inner, mut outer) = ((Moments::default(), 0.0), (Moments::default(), 0.0));
        while low < high {
            if low % 2 == 1 {
                inner = join(inner, self.0[low]);
                low += 1;
            }
            if high % 2 == 1 {
                high -= 1;
                outer = join(self.0[high], outer);
            }
            (low, high) = (low / 2, high / 2);
        }
        join(inner, outer)
    }

    /// The moments of a run of rings with the rings inside it and with those outside it, of a depth, m.
    pub(crate) fn across(&self, run: Range<usize>, inside: Moments, (outside, depth): (Moments, f64)) -> Moments {
        join((inside, 0.0), join(self.run(run.start, run.end), (outside, depth))).0
    }
}

/// Two adjacent runs as one.
fn join(inner: (Moments, f64), outer: (Moments, f64)) -> (Moments, f64) {
    (Moments::stack(inner.0, outer.0, outer.1), inner.1 + outer.1)
}
