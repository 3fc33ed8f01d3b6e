//! Consecutive items in a binary tree of clusters, each with sources that replace its items from afar.

use std::ops::Range;

/// Consecutive items.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Cluster<S> {
    pub(crate) items: Range<usize>,
    pub(crate) sources: S,
    /// The numbers of its halves; none of the smallest clusters.
    pub(crate) halves: Option<[usize; 2]>,
}

/// The clusters, each after its halves: the last one has all items.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ClusterTree<S>(Vec<Cluster<S>>);

impl<S> ClusterTree<S> {
    /// The tree over `count` items, with up to `leaf` of them in its smallest clusters. `sources` gives the
    /// sources of a cluster by its items or by the sources of its halves.
    pub(crate) fn new(
        count: usize,
        leaf: usize,
        sources: impl Fn(&Range<usize>, Option<[&S; 2]>) -> S,
    ) -> ClusterTree<S> {
        let mut tree = ClusterTree(Vec::with_capacity(2 * count.div_ceil(leaf.div_ceil(2))));
        if count > 0 {
            tree.build(0..count, leaf, &sources);
        }
        tree
    }

    fn build(
        &mut self,
        items: Range<usize>,
        leaf: usize,
        sources: &impl Fn(&Range<usize>, Option<[&S; 2]>) -> S,
    ) -> usize {
        let halves = (items.len() > leaf).then(|| {
            let middle = items.start.midpoint(items.end);
            [items.start..middle, middle..items.end].map(|half| self.build(half, leaf, sources))
        });
        let of_halves = halves.map(|halves| halves.map(|half| &self.0[half].sources));
        let sources = sources(&items, of_halves);
        self.0.push(Cluster { items, sources, halves });
        self.0.len() - 1
    }

    /// The number of the cluster of all items, if there are any.
    pub(crate) fn root(&self) -> Option<usize> {
        self.0.len().checked_sub(1)
    }

    pub(crate) fn cluster(&self, number: usize) -> &Cluster<S> {
        &self.0[number]
    }

    /// Goes through the items `items`: `far` gets whole clusters and returns whether it has used them, `near`
    /// gets the other items, run by run.
    pub(crate) fn visit<'a>(
        &'a self,
        items: Range<usize>,
        far: &mut impl FnMut(&'a Cluster<S>) -> bool,
        near: &mut impl FnMut(Range<usize>),
    ) {
        if let Some(root) = self.root() {
            self.descend(root, &items, far, near);
        }
    }

    fn descend<'a>(
        &'a self,
        number: usize,
        items: &Range<usize>,
        far: &mut impl FnMut(&'a Cluster<S>) -> bool,
        near: &mut impl FnMut(Range<usize>),
    ) {
        let cluster = &self.0[number];
        let some = cluster.items.start.max(items.start)..cluster.items.end.min(items.end);
        if some.is_empty() || some == cluster.items && far(cluster) {
            return;
        }
        match cluster.halves {
            Some(halves) => halves.into_iter().for_each(|half| self.descend(half, items, far, near)),
            None => near(some),
        }
    }
}
