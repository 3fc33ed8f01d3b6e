//! The weighted kernels of many adjoining rings of a table, at many radii.
//!
//! A panel that lies in one ring has that ring's weight, and so has a cluster of such panels: its moments are those of the table times
//! the weight. The few panels that rings cut are cut with them, and only the clusters that hold one, or panels of several rings, get
//! moments of their own ([`Node`]). So a state costs in proportion to the number of its rings and not to that of the panels, and each radius goes
//! through the tree once, whatever the number of rings.

use std::cell::RefCell;

#[cfg(test)]
use super::super::call_count;
use super::legendre::{self, LegendreMoments, ORDERS};
use super::many_radii::ManyRadii;
use super::source_tree::{Cluster, add_panel};
use super::{Panel, Ring, Shape, Span, StressRadius, Tabulated, smooth_coordinate};
use std::ops::Range;

/// The panels of a table by their weights.
pub(crate) struct WeightedPanels<'a> {
    pub(super) table: &'a Tabulated,
    /// Runs of panels that lie in one ring, and its weight, from the centre outward.
    runs: Vec<(Range<usize>, f64)>,
    /// The parts of panels that rings cut, by their panels.
    pub(super) parts: Vec<(usize, Span, f64)>,
    /// The clusters whose panels do not count alike and those right below, children first.
    pub(super) nodes: Vec<Node>,
}

/// A cluster of panels.
pub(super) enum Node {
    /// The table's own of this number, times a weight.
    Even(usize, f64),
    /// The table's own of this number, with other moments, and its halves in the list, if it has any.
    Uneven(usize, LegendreMoments, Option<[usize; 2]>),
}

/// The sums at each radius of the kernels of rings times their weights; `None` with levels at a vertical edge.
pub(super) fn sums(table: &Tabulated, rings: &[(Ring, f64)], radii: &[StressRadius]) -> Option<Vec<f64>> {
    Some(ManyRadii::sums(&WeightedPanels::new(table, rings)?, radii))
}

impl WeightedPanels<'_> {
    /// `None` with levels at a vertical edge.
    pub(in super::super) fn new<'a>(table: &'a Tabulated, rings: &[(Ring, f64)]) -> Option<WeightedPanels<'a>> {
        let (mut runs, mut parts) = (Vec::with_capacity(rings.len()), Vec::with_capacity(2 * rings.len()));
        for (ring, weight) in rings {
            let span = table.span(ring);
            if span.edge > 0.0 {
                return None;
            }
            let (low, whole, high) = table.parts(&span);
            parts.extend(low.map(|(index, span)| (index, span, *weight)));
            if !whole.is_empty() {
                runs.push((whole, *weight));
            }
            parts.extend(high.map(|(index, span)| (index, span, *weight)));
        }
        let mut panels = WeightedPanels { table, runs, parts, nodes: Vec::new() };
        panels.gather(table.sources.root());
        Some(panels)
    }

    /// The weight of each of these panels, if they have one; zero outside the rings.
    fn weight(&self, panels: &Range<usize>) -> Option<f64> {
        let run = self.runs.partition_point(|(run, _)| run.end <= panels.start);
        match self.runs.get(run) {
            Some((run, weight)) if run.start <= panels.start => (panels.end <= run.end).then_some(*weight),
            next => {
                let part = self.parts.partition_point(|part| part.0 < panels.start);
                let cut = self.parts.get(part).is_some_and(|part| part.0 < panels.end);
                (!cut && next.is_none_or(|(run, _)| run.start >= panels.end)).then_some(0.0)
            }
        }
    }

    /// Lists a cluster of the table after all that is needed below it.
    fn gather(&mut self, index: usize) {
        let table = self.table;
        let cluster = table.sources.cluster(index);
        if let Some(weight) = self.weight(&(cluster.first..cluster.last)) {
            self.nodes.push(Node::Even(index, weight));
            return;
        }
        let mut moments = [0.0; ORDERS];
        // Wider than it is far from the centre, it is far from no radius, and neither is a cluster that holds it.
        let wanted = legendre::is_far(cluster.interval, 0.0);
        let children = table.sources.children(index).map(|children| {
            children.map(|child| {
                self.gather(child);
                let (number, own, factor) = match &self.nodes[self.nodes.len() - 1] {
                    Node::Even(number, weight) => (*number, &table.sources.cluster(*number).moments, *weight),
                    Node::Uneven(number, moments, _) => (*number, moments, 1.0),
                };
                if wanted && factor.abs() > 0.0 {
                    let from = table.sources.cluster(number).interval;
                    legendre::add_shifted(&mut moments, cluster.interval, from, own, factor);
                }
                self.nodes.len() - 1
            })
        });
        if wanted && children.is_none() {
            self.add_parts(cluster, &mut moments);
        }
        self.nodes.push(Node::Uneven(index, moments, children));
    }

    /// Adds the moments of the parts of a panel. All but the first make the most of the panel: the first counts as what is left by them.
    fn add_parts(&self, cluster: &Cluster, moments: &mut LegendreMoments) {
        let panel = &self.table.panels[cluster.first];
        let parts = parts_of(&self.parts, cluster.first);
        let covered = parts.windows(2).all(|pair| pair[0].1.outer == pair[1].1.inner)
            && parts.first().is_some_and(|(_, span, _)| span.inner <= panel.square)
            && parts.last().is_some_and(|(_, span, _)| span.outer >= self.table.span_of_panel(cluster.first).outer);
        let base = if covered { parts[0].2 } else { 0.0 };
        if base.abs() > 0.0 {
            moments.iter_mut().zip(&cluster.moments).for_each(|(moment, whole)| *moment += base * whole);
        }
        for (_, span, weight) in parts {
            if (weight - base).abs() > 0.0 {
                let ends = (panel.t_of(span.inner), panel.t_of(span.outer));
                add_panel(moments, cluster.interval, panel, ends, weight - base);
            }
        }
    }

    /// The derivative of the sum with respect to r^2, 1/m^2, and the sum of the sizes of its parts.
    pub(in super::super) fn slope(&self, at: &StressRadius) -> (f64, f64) {
        let (mut sum, mut size) = (0.0, 0.0);
        let part = |panel: &Panel, span: &Span| {
            #[cfg(test)]
            call_count::add(|calls| &mut calls.kernel_slope);
            smooth_coordinate::kernel_slope(panel, at, span)
        };
        let whole = |index: usize| part(&self.table.panels[index], &self.table.span_of_panel(index));
        let (panels, below) = (self.table.find(at.radius)..self.table.panels.len(), at.square.value());
        let far = |interval, moments: &LegendreMoments| legendre::potential_slope(interval, moments, below);
        self.visit(
            panels,
            |interval| legendre::is_far(interval, below),
            far,
            whole,
            part,
            |part| {
                sum += part;
                size += part.abs();
            },
        );
        (sum, size)
    }

    /// Adds what these panels do: by clusters where those are far, else panel by panel and part by part.
    pub(super) fn visit(
        &self,
        panels: Range<usize>,
        is_far: impl Fn((f64, f64)) -> bool,
        far: impl Fn((f64, f64), &LegendreMoments) -> f64,
        whole: impl Fn(usize) -> f64,
        part: impl Fn(&Panel, &Span) -> f64,
        add: impl FnMut(f64),
    ) {
        let add = RefCell::new(add);
        let mut open = vec![self.nodes.len() - 1];
        while let Some(node) = open.pop() {
            match &self.nodes[node] {
                Node::Even(_, weight) if weight.abs() <= 0.0 => {}
                Node::Even(index, weight) => self.table.sources.visit(
                    *index,
                    &panels,
                    &is_far,
                    &mut |cluster: &Cluster| add.borrow_mut()(weight * far(cluster.interval, &cluster.moments)),
                    &mut |panel| add.borrow_mut()(weight * whole(panel)),
                ),
                Node::Uneven(index, moments, children) => {
                    let Cluster { first, last, interval, .. } = self.table.sources.cluster(*index);
                    if *last <= panels.start || *first >= panels.end {
                        continue;
                    }
                    if *first >= panels.start && *last <= panels.end && is_far(*interval) {
                        add.borrow_mut()(far(*interval, moments));
                    } else if let Some(children) = children {
                        open.extend(children);
                    } else {
                        for (index, span, weight) in parts_of(&self.parts, *first) {
                            if weight.abs() > 0.0 {
                                add.borrow_mut()(weight * part(&self.table.panels[*index], span));
                            }
                        }
                    }
                }
            }
        }
    }
}

/// The parts of a panel, of all in rising order.
pub(super) fn parts_of(parts: &[(usize, Span, f64)], index: usize) -> &[(usize, Span, f64)] {
    let first = parts.partition_point(|part| part.0 < index);
    let count = parts[first..].partition_point(|part| part.0 == index);
    &parts[first..first + count]
}
