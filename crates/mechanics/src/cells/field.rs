//! Sums of kernels over cells, weighted by the rings they lie in, at many radii.
//!
//! A cell that lies in one ring has that ring's weight, and so has a cluster of such cells: what it does from afar is
//! its own sources times the weight. The few cells that rings cut are cut with them, and only the clusters that hold
//! one, or cells of several rings, get moments of their own; for a few radii only the small ones among them. So a state
//! costs in proportion to the number of its rings and not to that of the cells.
//!
//! Radii go through the tree together, in such an order that a cluster is far from the first of them and near the last:
//! at each cluster three runs part. Those from which it is far take its moments, side by side; those beyond it are
//! done; the others go on to its halves.

use std::ops::Range;

#[cfg(test)]
use super::call_count;
use super::kernel::Kernel;
use super::ring::StressRadius;
use super::span::Span;
use super::{Cell, Cells, NearPart, SpanParts};
use crate::numerics::cluster_tree::{Cluster, ClusterTree};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::multipole::Multipole;

/// Radii side by side.
const LANES: usize = 4;

/// For fewer radii than this, larger clusters than the next are summed half by half.
pub(crate) const MANY: usize = 64;

/// The moments of a cluster of so many cells are made of what is in it at once, not half by half: few radii are far
/// from its halves and not from it.
const FEW_CELLS: usize = 8;

/// So many parts of a cell are summed one by one.
const FEW_PARTS: usize = 2;

/// A stretch within the cell of this index, and its weight.
type Part = (usize, Span, f64);

/// Cells by their weights.
pub(crate) struct WeightedCells<'a> {
    cells: &'a Cells,
    /// Runs of cells that lie in one ring, and its weight, from the centre outward.
    runs: Vec<(Range<usize>, f64)>,
    /// The parts of cells that rings cut, by their cells.
    parts: Vec<Part>,
    /// The clusters that have moments of their own, by their numbers.
    own: Vec<(usize, Multipole)>,
    /// The parts of cells that several rings cut, for many radii, by the numbers of the cells.
    crowds: Vec<(usize, ClusterTree<Multipole>)>,
    /// What rings cross at a vertical edge.
    rim: Option<Rim>,
}

/// A vertical edge: the square of its radius, m^2, the weighted levels that rings cross there, m, and their sizes.
#[derive(Clone, Copy)]
struct Rim {
    square: DoubleDouble,
    radius: f64,
    levels: f64,
    size: f64,
}

/// A radius and the cell that holds it.
struct Held {
    at: StressRadius,
    cell: usize,
}

/// A sum and that of the sizes of its terms.
pub(crate) type SumAndSize = (f64, f64);

impl WeightedCells<'_> {
    /// The cells of spans from the centre outward, each with its weight, for sums at so many radii.
    pub(crate) fn new<'a>(cells: &'a Cells, spans: &[(Span, f64)], radii: usize) -> WeightedCells<'a> {
        let (mut runs, mut parts) = (Vec::with_capacity(spans.len()), Vec::with_capacity(2 * spans.len()));
        let mut rim: Option<Rim> = None;
        for (span, weight) in spans {
            if span.edge > 0.0 {
                let levels = weight * span.edge;
                let before = rim.map_or((0.0, 0.0), |rim| (rim.levels, rim.size));
                let (levels, size) = (before.0 + levels, before.1 + levels.abs());
                rim = Some(Rim { square: span.outer, radius: span.outer_radius, levels, size });
            }
            if span.gap <= 0.0 {
                continue;
            }
            let SpanParts { low, whole, high } = cells.parts(span);
            parts.extend(low.map(|(index, span)| (index, span, *weight)));
            if !whole.is_empty() {
                runs.push((whole, *weight));
            }
            parts.extend(high.map(|(index, span)| (index, span, *weight)));
        }
        let mut weighted = WeightedCells { cells, runs, parts, own: Vec::new(), crowds: Vec::new(), rim };
        if radii >= MANY {
            weighted.crowds = weighted.crowds();
        }
        if let Some(root) = weighted.cells.sources().root() {
            weighted.gather(root, radii >= MANY);
        }
        weighted
    }

    /// How many parts of cells rings cut.
    pub(crate) fn parts(&self) -> usize {
        self.parts.len()
    }

    /// The weight of each of these cells, if they have one; zero outside the rings.
    fn weight(&self, cells: &Range<usize>) -> Option<f64> {
        let run = self.runs.partition_point(|(run, _)| run.end <= cells.start);
        match self.runs.get(run) {
            Some((run, weight)) if run.start <= cells.start => (cells.end <= run.end).then_some(*weight),
            next => {
                let part = self.parts.partition_point(|part| part.0 < cells.start);
                let cut = self.parts.get(part).is_some_and(|part| part.0 < cells.end);
                (!cut && next.is_none_or(|(run, _)| run.start >= cells.end)).then_some(0.0)
            }
        }
    }

    /// The parts of a cell.
    fn parts_of(&self, cell: usize) -> &[Part] {
        let first = self.parts.partition_point(|part| part.0 < cell);
        let count = self.parts[first..].partition_point(|part| part.0 == cell);
        &self.parts[first..first + count]
    }

    /// The clusters of the parts of a cell.
    fn crowd(&self, cell: usize) -> Option<&ClusterTree<Multipole>> {
        let place = self.crowds.binary_search_by_key(&cell, |crowd| crowd.0);
        place.ok().map(|place| &self.crowds[place].1)
    }

    /// Clusters of the parts of each cell that several rings cut, over x^2 from their own inner ends on, so that rings
    /// within a millionth of the edge keep their digits.
    fn crowds(&self) -> Vec<(usize, ClusterTree<Multipole>)> {
        let cut = self.parts.chunk_by(|one, next| one.0 == next.0).filter(|parts| parts.len() > FEW_PARTS);
        let clusters = |parts: &[Part]| {
            let cell = &self.cells.cells[parts[0].0];
            let tree = ClusterTree::new(parts.len(), 1, |items, halves: Option<[&Multipole; 2]>| {
                let width = parts[items.clone()].iter().map(|(_, span, _)| span.gap).sum();
                let (_, span, weight) = &parts[items.start];
                let mut sources = Multipole::empty(span.inner, width);
                match halves {
                    Some(halves) => halves.into_iter().for_each(|half| sources.add(half, 1.0)),
                    None => cell.add_sources(&mut sources, 0.0, cell.part(span), *weight),
                }
                sources
            });
            (parts[0].0, tree)
        };
        cut.map(clusters).collect()
    }

    /// Lists the moments of a cluster whose cells do not weigh alike, if it is small or `all` are wanted, after those
    /// below it.
    fn gather(&mut self, number: usize, all: bool) {
        let cluster = self.cells.sources().cluster(number);
        if self.weight(&cluster.items).is_some() {
            return;
        }
        // Wider than it is far from the centre, it is far from no radius, and neither is a cluster that holds it.
        let is_far = Kernel::Root.is_far(&cluster.sources, DoubleDouble::ZERO);
        let is_small = is_far && cluster.items.len() <= FEW_CELLS;
        let wanted = is_far && (all || is_small);
        let (origin, width) = (cluster.sources.origin, cluster.sources.width);
        if let Some(halves) = cluster.halves.filter(|_| !is_small) {
            halves.into_iter().for_each(|half| self.gather(half, all));
        }
        if wanted {
            let mut sources = Multipole::empty(origin, width);
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
        let cluster = self.cells.sources().cluster(number);
        match (self.weight(&cluster.items), self.own(number), cluster.halves) {
            (Some(weight), _, _) if weight.abs() > 0.0 => sources.add(&cluster.sources, weight),
            (Some(_), _, _) => {}
            (None, Some(own), _) => sources.add(own, 1.0),
            (None, None, Some(halves)) => halves.into_iter().for_each(|half| self.add_cluster(half, sources)),
            (None, None, None) => self.add_parts(cluster, sources),
        }
    }

    /// Adds the sources of the parts of a cell. All but the first make the most of the cell: the first counts as what
    /// is left by them.
    fn add_parts(&self, cluster: &Cluster<Multipole>, sources: &mut Multipole) {
        let index = cluster.items.start;
        if let Some(root) = self.crowd(index).and_then(|crowd| Some(&crowd.cluster(crowd.root()?).sources)) {
            return sources.add(root, 1.0);
        }
        let (cell, parts) = (&self.cells.cells[index], self.parts_of(index));
        let covered = parts.windows(2).all(|pair| pair[0].1.outer == pair[1].1.inner)
            && parts.first().is_some_and(|(_, span, _)| span.inner <= cell.square)
            && parts.last().is_some_and(|(_, span, _)| span.outer >= self.cells.span_of_cell(index).outer);
        let base = if covered { parts[0].2 } else { 0.0 };
        if base.abs() > 0.0 {
            sources.add(&cluster.sources, base);
        }
        for (_, span, weight) in parts {
            if (weight - base).abs() > 0.0 {
                cell.add_sources(sources, sources.place(span.inner), cell.part(span), weight - base);
            }
        }
    }

    /// The sums of a kernel at radii.
    pub(crate) fn sums(&self, kernel: Kernel, radii: &[StressRadius]) -> Vec<SumAndSize> {
        let mut order = StressRadius::rising(radii);
        if kernel.is_angle() {
            order.reverse();
        }
        let held = |&index: &usize| {
            let at = radii[index];
            Held { at, cell: self.cells.find(at.radius) }
        };
        let held: Vec<Held> = order.iter().map(held).collect();
        let (mut ordered, mut sums) = (vec![(0.0, 0.0); radii.len()], vec![(0.0, 0.0); radii.len()]);
        if let Some(root) = self.cells.sources().root() {
            self.visit(root, None, kernel, &held, &mut ordered);
        }
        order.into_iter().zip(ordered).for_each(|(index, sum)| sums[index] = sum);
        if let Some(rim) = self.rim {
            radii.iter().zip(&mut sums).for_each(|(at, sum)| rim.add(kernel, at, sum));
        }
        sums
    }

    /// Adds what a cluster does, the weight of whose cells may be known, at radii in rising order, of an angle in
    /// falling order.
    fn visit(&self, number: usize, known: Option<f64>, kernel: Kernel, radii: &[Held], sums: &mut [SumAndSize]) {
        let cluster = self.cells.sources().cluster(number);
        let weight = known.or_else(|| self.weight(&cluster.items));
        let met = radii.partition_point(|held| kernel.meets(&cluster.items, held.cell));
        if met == 0 || weight.is_some_and(|weight| weight.abs() <= 0.0) {
            return;
        }
        let (radii, sums) = (&radii[..met], &mut sums[..met]);
        let sources = match weight {
            Some(_) => Some(&cluster.sources),
            None => self.own(number),
        };
        let far = sources.map_or(0, |sources| {
            let far = radii.partition_point(|held| kernel.is_far(sources, held.at.square));
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
        let whole = weight.map(|weight| [(index, self.cells.span_of_cell(index), weight)]);
        let parts = match &whole {
            Some(whole) => whole,
            None => self.parts_of(index),
        };
        let crowd = if whole.is_none() && !kernel.is_angle() { self.crowd(index) } else { None };
        match crowd.and_then(|tree| Some((tree, tree.root()?))) {
            Some((tree, root)) => self.visit_crowd(tree, root, parts, kernel, radii, sums),
            None => self.add_parts_near(parts, kernel, radii, sums),
        }
    }

    /// Adds what a cluster of parts of a cell does at radii in rising order.
    fn visit_crowd(
        &self,
        tree: &ClusterTree<Multipole>,
        number: usize,
        parts: &[Part],
        kernel: Kernel,
        radii: &[Held],
        sums: &mut [SumAndSize],
    ) {
        let Cluster { items, sources, halves } = tree.cluster(number);
        let some = &parts[items.clone()];
        let outer = some[some.len() - 1].1.outer;
        let met = radii.partition_point(|held| held.at.square < outer);
        let far = radii[..met].partition_point(|held| kernel.is_far(sources, held.at.square));
        add_far(kernel, sources, 1.0, &radii[..far], &mut sums[..far]);
        let (radii, sums) = (&radii[far..met], &mut sums[far..met]);
        if radii.is_empty() {
            return;
        }
        match halves {
            Some(halves) => halves.iter().for_each(|&half| self.visit_crowd(tree, half, parts, kernel, radii, sums)),
            None => self.add_parts_near(some, kernel, radii, sums),
        }
    }

    /// Adds what parts of a cell do at radii that are near.
    fn add_parts_near(&self, parts: &[Part], kernel: Kernel, radii: &[Held], sums: &mut [SumAndSize]) {
        // Radii beyond a part have no share of its kernels.
        let inside = |span: &Span| radii.partition_point(|held| span.excess(held.at.square).1 > 0.0);
        for (index, span, weight) in parts.iter().filter(|part| part.2.abs() > 0.0) {
            let cell = &self.cells.cells[*index];
            match kernel {
                Kernel::Root => {
                    let inside = inside(span);
                    add_near::<false>(cell, span, *weight, &radii[..inside], &mut sums[..inside]);
                }
                Kernel::RootSlope => {
                    let inside = inside(span);
                    add_near::<true>(cell, span, *weight, &radii[..inside], &mut sums[..inside]);
                }
                Kernel::Arccos | Kernel::Arcsin => {
                    for (held, sum) in radii.iter().zip(&mut *sums) {
                        add_to(sum, weight * kernel.near(cell, &held.at, span));
                    }
                }
            }
        }
    }
}

impl Rim {
    /// Adds what it does at a radius.
    fn add(&self, kernel: Kernel, at: &StressRadius, sum: &mut SumAndSize) {
        if self.levels.abs() <= 0.0 {
            return;
        }
        let share = kernel.of_place(self.square, self.radius, at);
        *sum = (sum.0 + self.levels * share, sum.1 + self.size * share.abs());
    }
}

/// Adds the kernels of a part of a cell, which radii are near, times its weight.
fn add_near<const SLOPE: bool>(cell: &Cell, span: &Span, weight: f64, radii: &[Held], sums: &mut [SumAndSize]) {
    let near = NearPart::new(cell, span);
    for (radii, sums) in radii.chunks(LANES).zip(sums.chunks_mut(LANES)) {
        #[cfg(test)]
        call_count::add(|calls| if SLOPE { &mut calls.kernel_slope } else { &mut calls.kernel });
        if let ([held], [sum]) = (radii, &mut *sums) {
            add_to(sum, weight * near.kernels::<1, SLOPE>([held.at.square])[0]);
        } else {
            // Lanes left over repeat the last.
            let squares = std::array::from_fn(|lane| radii[lane.min(radii.len() - 1)].at.square);
            let kernels = near.kernels::<LANES, SLOPE>(squares);
            sums.iter_mut().zip(kernels).for_each(|(sum, kernel)| add_to(sum, weight * kernel));
        }
    }
}

/// Adds what sources do at radii that are far from them.
fn add_far(kernel: Kernel, sources: &Multipole, weight: f64, radii: &[Held], sums: &mut [SumAndSize]) {
    for (radii, sums) in radii.chunks(LANES).zip(sums.chunks_mut(LANES)) {
        if let ([held], [sum]) = (radii, &mut *sums) {
            add_to(sum, weight * kernel.far(sources, [held.at.square])[0]);
        } else {
            // Lanes left over repeat the last.
            let squares: [_; LANES] = std::array::from_fn(|lane| radii[lane.min(radii.len() - 1)].at.square);
            let far = kernel.far(sources, squares);
            sums.iter_mut().zip(far).for_each(|(sum, far)| add_to(sum, weight * far));
        }
    }
}

pub(crate) fn add_to(sum: &mut SumAndSize, term: f64) {
    *sum = (sum.0 + term, sum.1 + term.abs());
}
