//! The weighted kernels of a table at many radii, in one passage through its tree.
//!
//! With the radii in rising order, a cluster is far from the first of them and near the last, so that at each cluster three runs part: those
//! from which it is far take its moments, side by side; those beyond it are done; the others go on to its halves.

use std::ops::Range;

use super::StressRadius;
use super::kernel_sums::{Node, WeightedPanels, parts_of};
use super::legendre::{self, LegendreMoments};
use super::panels::kernel_of_part;
use super::source_tree::Cluster;

/// Radii side by side.
const LANES: usize = 4;

/// Radii in rising order, and their sums.
pub(super) struct ManyRadii<'a> {
    panels: &'a WeightedPanels<'a>,
    radii: Vec<StressRadius>,
    squares: Vec<f64>,
    /// The panels that hold them.
    held: Vec<usize>,
    sums: Vec<f64>,
}

impl ManyRadii<'_> {
    /// The sums of the kernels at each radius.
    pub(super) fn sums(panels: &WeightedPanels, radii: &[StressRadius]) -> Vec<f64> {
        let order = StressRadius::rising(radii);
        let sorted: Vec<StressRadius> = order.iter().map(|&index| radii[index]).collect();
        let mut many = ManyRadii {
            panels,
            squares: sorted.iter().map(|at| at.square.value()).collect(),
            held: sorted.iter().map(|at| panels.table.find(at.radius)).collect(),
            sums: vec![0.0; radii.len()],
            radii: sorted,
        };
        many.visit_node(panels.nodes.len() - 1, 0..radii.len());
        let mut sums = vec![0.0; radii.len()];
        for (index, sum) in order.into_iter().zip(many.sums) {
            sums[index] = sum;
        }
        sums
    }

    /// Of these radii those that a cluster is far from, and those that are left; radii beyond it are neither.
    fn split(&self, cluster: &Cluster, some: Range<usize>) -> (Range<usize>, Range<usize>) {
        let end = some.start + self.held[some.clone()].partition_point(|&panel| panel < cluster.last);
        let far = self.squares[some.start..end].partition_point(|&square| legendre::is_far(cluster.interval, square));
        (some.start..some.start + far, some.start + far..end)
    }

    fn visit_node(&mut self, node: usize, some: Range<usize>) {
        let panels = self.panels;
        match &panels.nodes[node] {
            Node::Even(_, weight) if weight.abs() <= 0.0 => {}
            Node::Even(index, weight) => self.visit_cluster(*index, *weight, some),
            Node::Uneven(index, moments, children) => {
                let cluster = panels.table.sources.cluster(*index);
                let (far, left) = self.split(cluster, some);
                self.add_far(cluster.interval, moments, 1.0, far);
                if let Some(children) = children.filter(|_| !left.is_empty()) {
                    children.into_iter().for_each(|child| self.visit_node(child, left.clone()));
                } else if !left.is_empty() {
                    for (index, span, weight) in parts_of(&panels.parts, cluster.first) {
                        if weight.abs() > 0.0 {
                            let panel = &panels.table.panels[*index];
                            for radius in left.clone() {
                                self.sums[radius] += weight * kernel_of_part(panel, &self.radii[radius], span);
                            }
                        }
                    }
                }
            }
        }
    }

    /// Visits a cluster of panels of one weight.
    fn visit_cluster(&mut self, index: usize, weight: f64, some: Range<usize>) {
        let table = self.panels.table;
        let cluster = table.sources.cluster(index);
        let (far, left) = self.split(cluster, some);
        self.add_far(cluster.interval, &cluster.moments, weight, far);
        if left.is_empty() {
            return;
        }
        if let Some(children) = table.sources.children(index) {
            children.into_iter().for_each(|child| self.visit_cluster(child, weight, left.clone()));
        } else {
            for radius in left {
                self.sums[radius] += weight * table.kernel_of_panel(cluster.first, &self.radii[radius]);
            }
        }
    }

    fn add_far(&mut self, interval: (f64, f64), moments: &LegendreMoments, weight: f64, some: Range<usize>) {
        for (sums, squares) in self.sums[some.clone()].chunks_mut(LANES).zip(self.squares[some].chunks(LANES)) {
            if let [sum] = sums {
                *sum += weight * legendre::potential(interval, moments, squares[0]);
            } else {
                let below = std::array::from_fn(|lane| squares[lane.min(squares.len() - 1)]);
                let potentials: [f64; LANES] = legendre::potentials(interval, moments, below);
                sums.iter_mut().zip(potentials).for_each(|(sum, potential)| *sum += weight * potential);
            }
        }
    }
}
