//! The engine under every profile: g as a sequence of [`Cell`]s, and every integral of it by one set of rules.
//!
//! Shapes, sums and tables differ in what gives gamma at the points of their cells ([`shape`], [`grid`]); from there on
//! level, radius, load, moments, kernels and displacements follow here, by the cells up to some radius ([`Cells`]),
//! built when a contact first reaches them ([`stages`]). Many rings at many radii go through a tree of multipoles
//! ([`field`]).

#[cfg(test)]
pub(crate) mod call_count;
mod cell;
pub(crate) mod displacement;
pub(crate) mod falls;
pub(crate) mod field;
pub(crate) mod grid;
pub(crate) mod kernel;
pub(crate) mod moment_tree;
mod near_part;
pub(crate) mod parabola;
pub(crate) mod ring;
pub(crate) mod shape;
pub(crate) mod span;
pub(crate) mod stages;

use std::ops::Range;
use std::sync::OnceLock;

pub(crate) use cell::Cell;
use near_part::NearPart;

use crate::numerics::cluster_tree::{Cluster, ClusterTree};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::multipole::Multipole;
use falls::Steepness;
use kernel::Kernel;
use moment_tree::MomentTree;
use ring::{Moments, Point, Ring, StressRadius};
use span::Span;

/// Of a ring thinner than this share of its square, the part inside a border of two cells is found from its depth.
const THIN: f64 = 1e-3;

/// A stretch within the cell of this index.
pub(crate) type CellPart = (usize, Span);

/// A span by the cells that it lies in.
pub(crate) struct SpanParts {
    /// The part in its innermost cell, unless that is a whole cell.
    pub(crate) low: Option<CellPart>,
    /// The whole cells.
    pub(crate) whole: Range<usize>,
    /// The part in its outermost cell.
    pub(crate) high: Option<CellPart>,
}

/// Where cells end: square of the radius, m^2, radius, m, level, m, load, m^2, and the kernel at the centre.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Top {
    pub(crate) square: DoubleDouble,
    pub(crate) radius: f64,
    pub(crate) level: DoubleDouble,
    pub(crate) load: DoubleDouble,
    centre: f64,
}

/// Cells from the centre, or from the end of a flat, outward, each of which begins where the one before it ends.
#[derive(Debug)]
pub(crate) struct Cells {
    pub(crate) cells: Vec<Cell>,
    /// Where they begin: the radius, m, and the level, m.
    radii: Box<[f64]>,
    levels: Box<[f64]>,
    /// Moments and depth of all runs of cells.
    tree: MomentTree,
    /// The kernel's sources, made when a stress is first asked for.
    sources: OnceLock<ClusterTree<Multipole>>,
    /// How steep the cells before each are, and all of them, made when first asked for.
    steepness: OnceLock<Vec<Steepness>>,
    pub(crate) top: Top,
    /// Whether squares are as exact as they are beside a kink, everywhere: the edge is a branch point.
    all_digits: bool,
}

impl Cells {
    /// By cells of which each ends at the square where the next begins, and the last at `end`, m^2, if that is known
    /// with all its digits. Levels and loads are counted from the first; without any, all up to the end is flat.
    pub(crate) fn new(mut cells: Vec<Cell>, end: Option<DoubleDouble>) -> Cells {
        let mut top = Top {
            square: end.unwrap_or_default(),
            radius: 0.0,
            level: DoubleDouble::ZERO,
            load: DoubleDouble::ZERO,
            centre: 0.0,
        };
        let mut totals = Vec::with_capacity(cells.len());
        for cell in &mut cells {
            (cell.level, cell.load, cell.centre) = (top.level, top.load, top.centre);
            let moments = cell.moments(cell.whole(), cell.width);
            totals.push((moments, cell.depth));
            top.square = cell.end();
            top.radius = top.square.value().sqrt();
            top.level = top.level + DoubleDouble::from(cell.depth);
            top.load = top.load + DoubleDouble::from(cell.radius * cell.depth + moments.first);
            if top.centre < f64::INFINITY {
                top.centre += cell.kernel::<false>(&StressRadius::new(0.0), &cell_span(cell, top.square, top.radius));
            }
        }
        top.square = end.unwrap_or(top.square);
        top.radius = top.square.value().sqrt();
        Cells {
            radii: cells.iter().map(|cell| cell.radius).collect(),
            levels: cells.iter().map(|cell| cell.level.value()).collect(),
            tree: MomentTree::new(totals.into_iter()),
            sources: OnceLock::new(),
            steepness: OnceLock::new(),
            top,
            all_digits: false,
            cells,
        }
    }

    /// The same whose squares are as exact everywhere as they are beside a kink.
    pub(crate) fn with_all_digits(self) -> Cells {
        Cells { all_digits: true, ..self }
    }

    /// The kernel's sources g' dx over x^2.
    pub(crate) fn sources(&self) -> &ClusterTree<Multipole> {
        self.sources.get_or_init(|| {
            ClusterTree::new(self.cells.len(), 1, |items, halves| {
                let (first, last) = (&self.cells[items.start], &self.cells[items.end - 1]);
                let end = self.cells.get(items.end).map_or(self.top.square, |next| next.square);
                let mut sources = Multipole::empty(first.square, (end - first.square).value());
                match halves {
                    Some(halves) => halves.into_iter().for_each(|half| sources.add(half, 1.0)),
                    None => last.add_sources(&mut sources, 0.0, last.whole(), 1.0),
                }
                sources
            })
        })
    }

    /// The sources of a span.
    pub(crate) fn sources_of(&self, span: &Span) -> Multipole {
        let mut sources = Multipole::empty(span.inner, span.gap);
        let SpanParts { low, whole, high } = self.parts(span);
        for (index, part) in low.into_iter().chain(high) {
            let cell = &self.cells[index];
            cell.add_sources(&mut sources, (part.inner - span.inner).value(), cell.part(&part), 1.0);
        }
        let mut add = |cluster: &Cluster<Multipole>| {
            sources.add(&cluster.sources, 1.0);
            true
        };
        self.sources().visit(whole, &mut add, &mut |_| {});
        sources
    }

    /// g, m, at a radius, m.
    pub(crate) fn level(&self, radius: f64) -> f64 {
        if radius >= self.top.radius {
            return self.top.level.value();
        }
        let Some(cell) = self.cells.get(self.find(radius)) else { return 0.0 };
        (cell.level + DoubleDouble::from(cell.rise_to(cell.zeta(DoubleDouble::square_of(radius))))).value()
    }

    /// g' at a radius, m.
    pub(crate) fn slope(&self, radius: f64) -> f64 {
        match self.cells.get(self.find(radius)) {
            Some(cell) if radius >= cell.radius => {
                cell.slope_over_radius(cell.zeta(DoubleDouble::square_of(radius))) * radius
            }
            _ => 0.0,
        }
    }

    /// gamma at t = sqrt(x^2 - base^2), m.
    pub(crate) fn gamma(&self, base: f64, t: f64) -> f64 {
        let (square, above) = (DoubleDouble::square_of(base), DoubleDouble::square_of(t));
        let Some(cell) = self.cells.get(self.find((square + above).value().sqrt())) else { return 0.0 };
        let zeta_square = ((square - cell.square) + above).value();
        if zeta_square > 0.0 { cell.slope_over_radius(zeta_square.sqrt().min(cell.high)) * t } else { 0.0 }
    }

    /// X(y)^2, m^2.
    pub(crate) fn square(&self, level: DoubleDouble) -> DoubleDouble {
        if level >= self.top.level {
            return self.top.square;
        }
        let Some(cell) = self.cells.get(last(&self.levels, |start| start <= level.value())) else {
            return self.top.square;
        };
        let rest = (level - cell.level).value();
        if rest <= 0.0 {
            return cell.square;
        }
        let square = cell.square + DoubleDouble::square_of(cell.zeta_of(rest));
        // Without a kink below, x has all the digits that it needs, and the edge is where its radius is.
        if cell.kink > 0.0 || self.all_digits { square } else { DoubleDouble::square_of(square.value().sqrt()) }
    }

    /// The level, m, up to which int X dy is this load, m^2.
    pub(crate) fn indentation_for(&self, load: f64) -> f64 {
        if load <= 0.0 {
            return 0.0;
        }
        let Top { radius, level, load: most, .. } = self.top;
        if load >= most.value() {
            return level.value() + (load - most.value()) / radius;
        }
        let index = self.cells.partition_point(|cell| cell.load.value() <= load).saturating_sub(1);
        let cell = &self.cells[index];
        let whole = self.cells.get(index + 1).map_or(self.top.load, |next| next.load) - cell.load;
        let rest = (DoubleDouble::from(load) - cell.load).value();
        let zeta = cell.zeta_of_load(rest, whole.value());
        (cell.level + DoubleDouble::from(cell.rise_to(zeta))).value()
    }

    /// The difference of the squares, m^2, of the ends of a ring of this depth, m.
    pub(crate) fn gap(&self, ring: &Ring, depth: f64) -> f64 {
        let outer = if ring.outer.square > self.top.square {
            Point { square: self.top.square, radius: self.top.radius, level: self.top.level }
        } else {
            ring.outer
        };
        let index = self.last_that(self.find(ring.inner.radius), |square| square <= ring.inner.square);
        let Some(cell) = self.cells.get(index) else { return 0.0 };
        let low = (ring.inner.square - cell.square).value().max(0.0);
        if let Some(next) = self.cells.get(index + 1).filter(|next| next.square < outer.square) {
            let plain = (outer.square - ring.inner.square).value();
            if plain > THIN * outer.square.value() {
                return plain;
            }
            // Each side from its own distance to the border, which a difference of squares may have lost.
            let whole = cell.high * cell.high;
            let inside = cell.gap(low, whole, (next.level - ring.inner.level).value().max(0.0), false);
            let zeta = next.zeta_of((outer.level - next.level).value().max(0.0));
            let beyond = if zeta < next.high { zeta * zeta } else { (outer.square - next.square).value() };
            return inside + beyond;
        }
        let high = (outer.square - cell.square).value().max(0.0);
        // Squares that were rounded with their radius have lost what the depth of a thin ring has.
        let rounded = cell.kink <= 0.0 && !self.all_digits && high - low <= THIN * outer.square.value();
        cell.gap(low, high, depth, rounded)
    }

    /// The moments over a span.
    pub(crate) fn moments(&self, span: &Span) -> Moments {
        let SpanParts { low, whole, high } = self.parts(span);
        let part = |(index, span): CellPart| {
            let cell = &self.cells[index];
            let part = cell.part(&span);
            (cell.moments(part, span.width()), cell.rise(part))
        };
        if whole.is_empty() && low.is_none() {
            return high.map(part).unwrap_or_default().0;
        }
        self.tree.across(whole, low.map(part).unwrap_or_default().0, high.map(part).unwrap_or_default())
    }

    /// The cell that holds a radius, m.
    pub(crate) fn find(&self, radius: f64) -> usize {
        last(&self.radii, |start| start <= radius)
    }

    /// The last cell, near `index`, that begins at a square with this property, or the first cell: a radius just beyond
    /// a border may be rounded onto it, or to its other side.
    fn last_that(&self, mut index: usize, holds: impl Fn(DoubleDouble) -> bool) -> usize {
        while self.cells.get(index + 1).is_some_and(|next| holds(next.square)) {
            index += 1;
        }
        while index > 0 && self.cells.get(index).is_some_and(|cell| !holds(cell.square)) {
            index -= 1;
        }
        index
    }

    /// The parts of a span outside the flat core.
    pub(crate) fn parts(&self, span: &Span) -> SpanParts {
        let beyond_flat = |first: &Cell| span.above(first.square, first.radius);
        let Some(span) = &self.cells.first().and_then(beyond_flat) else {
            return SpanParts { low: None, whole: 0..0, high: None };
        };
        let outer = last(&self.radii, |start| start < span.outer_radius);
        let outer = self.last_that(outer, |square| square < span.outer);
        let inner = self.last_that(self.find(span.inner_radius), |square| square <= span.inner).min(outer);
        if inner == outer {
            return SpanParts { low: None, whole: outer..outer, high: Some((outer, *span)) };
        }
        let (this, next) = (&self.cells[inner], &self.cells[inner + 1]);
        let whole = span.inner <= this.square;
        let low = if whole { None } else { span.below(next.square, next.radius).map(|span| (inner, span)) };
        let top = &self.cells[outer];
        let high = span.above(top.square, top.radius).map(|span| (outer, span));
        SpanParts { low, whole: if whole { inner } else { inner + 1 }..outer, high }
    }

    /// A cell as a span, up to the very square where the next one begins.
    pub(crate) fn span_of_cell(&self, index: usize) -> Span {
        let (square, radius) =
            self.cells.get(index + 1).map_or((self.top.square, self.top.radius), |next| (next.square, next.radius));
        cell_span(&self.cells[index], square, radius)
    }

    /// The sum of a kernel over the part of a span beyond r.
    pub(crate) fn sum(&self, kernel: Kernel, at: &StressRadius, span: &Span) -> f64 {
        let Some(span) = span.above(at.square, at.radius) else { return 0.0 };
        let SpanParts { low, whole, high } = self.parts(&span);
        let part = |(index, span): CellPart| kernel.near(&self.cells[index], at, &span);
        let between = if kernel == Kernel::Root && at.radius <= 0.0 && whole.start == 0 {
            self.cells.get(whole.end).map_or(self.top.centre, |cell| cell.centre)
        } else if whole.is_empty() {
            0.0
        } else {
            let (mut far, mut near) = (0.0, 0.0);
            self.sources().visit(
                whole,
                &mut |cluster| {
                    let is_far = kernel.is_far(&cluster.sources, at.square);
                    if is_far {
                        far += kernel.far(&cluster.sources, [at.square])[0];
                    }
                    is_far
                },
                &mut |cells| near += cells.map(|index| part((index, self.span_of_cell(index)))).sum::<f64>(),
            );
            near + far
        };
        low.into_iter().chain(high).map(part).sum::<f64>() + between
    }

    /// int h dx/sqrt(r^2 - x^2), m, over the part of a span below r, h the rise of g up to the outer end of the span.
    pub(crate) fn displacement_integral(&self, at: &StressRadius, span: &Span) -> f64 {
        let SpanParts { low, whole, high } = self.parts(span);
        let whole = whole.rev().map(|index| (index, self.span_of_cell(index)));
        let (mut sum, mut above) = (0.0, 0.0);
        for (index, part) in high.into_iter().chain(whole).chain(low) {
            let cell = &self.cells[index];
            sum += cell.displacement_integral(at, &part) + above * part.arc(at);
            above += cell.rise(cell.part(&part));
        }
        sum
    }
}

/// A cell as a span that ends at this square.
fn cell_span(cell: &Cell, outer: DoubleDouble, outer_radius: f64) -> Span {
    let gap = (outer - cell.square).value();
    Span { inner: cell.square, outer, inner_radius: cell.radius, outer_radius, gap, edge: 0.0 }
}

/// The last of the values, which do not fall, that is below something; the first if none is.
fn last(values: &[f64], below: impl Fn(f64) -> bool) -> usize {
    values.partition_point(|&value| below(value)).saturating_sub(1)
}
