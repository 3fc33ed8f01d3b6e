//! Sums of kernels over the panels of a table, weighted by the rings they lie in, at many radii.
//!
//! A panel that lies in one ring has that ring's weight, and so has a cluster of such panels: what it does from afar is
//! that of the table times the weight. The few panels that rings cut are cut with them, and only the clusters that hold
//! one, or panels of several rings, get moments of their own; for a few radii only the small ones among them. So a
//! state costs in proportion to the number of its rings and not to that of the panels.
//!
//! Radii go through the tree together, in such an order that a cluster is far from the first of them and near the last:
//! at each cluster three runs part. Those from which it is far take its moments, side by side; those beyond it are
//! done; the others go on to its halves.

use std::ops::Range;

use super::kernel::Kernel;
use super::panel_sources::add_panel;
use super::panels::{Panels, SpanParts};
use super::{Span, StressRadius};
use crate::numerics::cluster_tree::Cluster;
use crate::numerics::multipole::Multipole;

/// Radii side by side.
const LANES: usize = 4;

/// For fewer radii than this, larger clusters than the next are summed half by half.
const MANY: usize = 64;

/// The moments of a cluster of so many panels are made of what is in it at once, not half by half.
const FEW_PANELS: usize = 2;

/// A stretch within the panel of this index, and its weight.
type Part = (usize, Span, f64);

/// The panels of a table by their weights.
pub(crate) struct WeightedPanels<'a> {
    table: &'a Panels,
    /// Runs of panels that lie in one ring, and its weight, from the centre outward.
    runs: Vec<(Range<usize>, f64)>,
    /// The parts of panels that rings cut, by their panels.
    parts: Vec<Part>,
    /// The clusters that have moments of their own, by their numbers.
    own: Vec<(usize, Multipole)>,
}

/// A radius and the panel that holds it.
struct Held {
    at: StressRadius,
    panel: usize,
}

/// A sum and that of the sizes of its terms.
pub(in super::super) type SumAndSize = (f64, f64);

impl WeightedPanels<'_> {
    /// The panels of spans from the centre outward, each with its weight, for sums at so many radii; `None` with levels
    /// at a vertical edge.
    pub(super) fn new<'a>(table: &'a Panels, spans: &[(Span, f64)], radii: usize) -> Option<WeightedPanels<'a>> {
        let (mut runs, mut parts) = (Vec::with_capacity(spans.len()), Vec::with_capacity(2 * spans.len()));
        for (span, weight) in spans {
            if span.edge > 0.0 {
                return None;
            }
            let SpanParts { low, whole, high } = table.parts(span);
            parts.extend(low.map(|(index, span)| (index, span, *weight)));
            if !whole.is_empty() {
                runs.push((whole, *weight));
            }
            parts.extend(high.map(|(index, span)| (index, span, *weight)));
        }
        let mut panels = WeightedPanels { table, runs, parts, own: Vec::new() };
        panels.gather(table.sources().root()?, radii >= MANY);
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

    /// The parts of a panel.
    fn parts_of(&self, panel: usize) -> &[Part] {
        let first = self.parts.partition_point(|part| part.0 < panel);
        let count = self.parts[first..].partition_point(|part| part.0 == panel);
        &self.parts[first..first + count]
    }

    /// Lists the moments of a cluster whose panels do not weigh alike, if it is small or `all` are wanted, after those
    /// below it.
    fn gather(&mut self, number: usize, all: bool) {
        let cluster = self.table.sources().cluster(number);
        if self.weight(&cluster.items).is_some() {
            return;
        }
        let is_small = cluster.items.len() <= FEW_PANELS;
        if let Some(halves) = cluster.halves.filter(|_| !is_small) {
            halves.into_iter().for_each(|half| self.gather(half, all));
        }
        // Wider than it is far from the centre, it is far from no radius, and neither is a cluster that holds it.
        if (all || is_small) && cluster.sources.is_far(0.0) {
            let mut sources = Multipole::empty(cluster.sources.interval);
            self.add_cluster(number, &mut sources);
            self.own.push((number, sources));
        }
    }

    /// The moments that a cluster has of its own.
    fn own(&self, number: usize) -> Option<&Multipole> {
        self.own.binary_search_by_key(&number, |own| own.0).ok().map(|index| &self.own[index].1)
    }

    /// Adds the weighted sources of a cluster.
    fn add_cluster(&self, number: usize, sources: &mut Multipole) {
        let cluster = self.table.sources().cluster(number);
        match (self.weight(&cluster.items), self.own(number), cluster.halves) {
            (Some(weight), _, _) if weight.abs() > 0.0 => sources.add(&cluster.sources, weight),
            (Some(_), _, _) => {}
            (None, Some(own), _) => sources.add(own, 1.0),
            (None, None, Some(halves)) => halves.into_iter().for_each(|half| self.add_cluster(half, sources)),
            (None, None, None) => self.add_parts(cluster, sources),
        }
    }

    /// Adds the sources of the parts of a panel. All but the first make the most of the panel: the first counts as what
    /// is left by them.
    fn add_parts(&self, cluster: &Cluster<Multipole>, sources: &mut Multipole) {
        let index = cluster.items.start;
        let (panel, parts) = (&self.table.panels[index], self.parts_of(index));
        let covered = parts.windows(2).all(|pair| pair[0].1.outer == pair[1].1.inner)
            && parts.first().is_some_and(|(_, span, _)| span.inner <= panel.square)
            && parts.last().is_some_and(|(_, span, _)| span.outer >= self.table.span_of_panel(index).outer);
        let base = if covered { parts[0].2 } else { 0.0 };
        if base.abs() > 0.0 {
            sources.add(&cluster.sources, base);
        }
        for (_, span, weight) in parts {
            if (weight - base).abs() > 0.0 {
                add_panel(sources, panel, (panel.t_of(span.inner), panel.t_of(span.outer)), weight - base);
            }
        }
    }

    /// The sums of a kernel at radii.
    pub(in super::super) fn sums(&self, kernel: Kernel, radii: &[StressRadius]) -> Vec<SumAndSize> {
        let mut order = StressRadius::rising(radii);
        if kernel.is_angle() {
            order.reverse();
        }
        let held = |&index: &usize| Held { at: radii[index], panel: self.table.find(radii[index].radius) };
        let held: Vec<Held> = order.iter().map(held).collect();
        let (mut ordered, mut sums) = (vec![(0.0, 0.0); radii.len()], vec![(0.0, 0.0); radii.len()]);
        if let Some(root) = self.table.sources().root() {
            self.visit(root, None, kernel, &held, &mut ordered);
        }
        order.into_iter().zip(ordered).for_each(|(index, sum)| sums[index] = sum);
        sums
    }

    /// Adds what a cluster does, the weight of whose panels may be known, at radii in rising order, of an angle in
    /// falling order.
    fn visit(&self, number: usize, known: Option<f64>, kernel: Kernel, radii: &[Held], sums: &mut [SumAndSize]) {
        let cluster = self.table.sources().cluster(number);
        let weight = known.or_else(|| self.weight(&cluster.items));
        let met = radii.partition_point(|held| kernel.meets(&cluster.items, held.panel));
        if met == 0 || weight.is_some_and(|weight| weight.abs() <= 0.0) {
            return;
        }
        let (radii, sums) = (&radii[..met], &mut sums[..met]);
        let sources = match weight {
            Some(_) => Some(&cluster.sources),
            None => self.own(number),
        };
        let far = sources.map_or(0, |sources| {
            let far = radii.partition_point(|held| kernel.is_far(sources, held.at.square.value()));
            add_far(kernel, sources, weight.unwrap_or(1.0), &radii[..far], &mut sums[..far]);
            far
        });
        let (radii, sums) = (&radii[far..], &mut sums[far..]);
        if radii.is_empty() {
            return;
        }
        if let Some(halves) = cluster.halves {
            halves.into_iter().for_each(|half| self.visit(half, weight, kernel, radii, sums));
            return;
        }
        let index = cluster.items.start;
        let whole = weight.map(|weight| [(index, self.table.span_of_panel(index), weight)]);
        let parts = match &whole {
            Some(whole) => whole,
            None => self.parts_of(index),
        };
        for (_, span, weight) in parts.iter().filter(|part| part.2.abs() > 0.0) {
            for (held, sum) in radii.iter().zip(&mut *sums) {
                add_to(sum, weight * kernel.near(&self.table.panels[index], &held.at, span));
            }
        }
    }
}

/// Adds what sources do at radii that are far from them.
fn add_far(kernel: Kernel, sources: &Multipole, weight: f64, radii: &[Held], sums: &mut [SumAndSize]) {
    for (radii, sums) in radii.chunks(LANES).zip(sums.chunks_mut(LANES)) {
        if let ([held], [sum]) = (radii, &mut *sums) {
            add_to(sum, weight * kernel.far(sources, [held.at.square.value()])[0]);
        } else {
            // Lanes left over repeat the last.
            let squares: [f64; LANES] = std::array::from_fn(|lane| radii[lane.min(radii.len() - 1)].at.square.value());
            let far = kernel.far(sources, squares);
            sums.iter_mut().zip(far).for_each(|(sum, far)| add_to(sum, weight * far));
        }
    }
}

pub(in super::super) fn add_to(sum: &mut SumAndSize, term: f64) {
    *sum = (sum.0 + term, sum.1 + term.abs());
}
