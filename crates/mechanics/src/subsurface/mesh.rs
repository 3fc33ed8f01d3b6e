//! The slopes of both load distributions over the radius, in panels that a Gauss rule integrates to round-off, and
//! gathered in a tree so that a distant point sees many panels as one.
//!
//! The stress at a point is a sum of smooth functions of t against dy = dg(t), with a branch point at t = r + i z. A
//! panel is a part of a cell: over its zeta = sqrt(t^2 - b^2) the rule integrates dg = gamma dzeta, and the branch
//! point is at zeta = sqrt((r + i z)^2 - b^2). Panels are halved near there: never is one longer than its distance
//! from it. A panel touches the branch point only at the surface; there zeta - sqrt(r^2 - b^2) = +-xi^2 takes the
//! root away. Over a tree's node that is half as long as its distance, 16 Chebyshev points stand for all below it,
//! with an error of 8^-16.

use super::complex::Complex;
use crate::cells::shape::Reach;
use crate::cells::span::Span;
use crate::cells::{Cell, SpanParts};
use crate::indenter::Indenter;
use crate::numerics::chebyshev::{self, SIXTEEN};
use crate::numerics::cluster_tree::{Cluster, ClusterTree};
use crate::numerics::gauss::TWELVE_POINTS;
use crate::profile::{Ring, StressRadius};

/// Points that stand for all panels of a node.
const CHEBYSHEV: usize = 16;
/// Panels that are closer together, over their radius, have no room for points that stand for them.
const CLOSEST: f64 = 1e-10;

/// Slopes at one radius: over the contact radius, that of the pressure in m, that of the shear in m of w.
#[derive(Clone, Copy, Debug)]
pub(super) struct Source {
    pub(super) t: f64,
    pub(super) normal: f64,
    pub(super) tangential: f64,
}

/// A part of a cell over which the shear has one slope.
#[derive(Clone, Copy, Debug)]
pub(super) struct MeshPanel {
    /// The number of the cell.
    cell: usize,
    span: Span,
    /// -dw/dy.
    share: f64,
}

/// Sources in the place of the panels of a stretch that is far.
#[derive(Clone, Debug)]
struct Stretch {
    low: f64,
    high: f64,
    sources: Vec<Source>,
}

/// Both distributions of a contact.
#[derive(Clone, Debug)]
pub(super) struct Mesh {
    /// How far the cells reach, m.
    reach: f64,
    panels: Vec<MeshPanel>,
    tree: ClusterTree<Stretch>,
    /// Levels at a vertical edge.
    edge: Option<Source>,
}

/// Distance of a stretch from the branch point.
fn distance(low: f64, high: f64, r: f64, z: f64) -> f64 {
    (low - r).max(r - high).max(0.0).hypot(z)
}

impl Mesh {
    /// The mesh of rings from the edge inward, each with its -dw/dy, for a contact of this radius, m.
    pub(super) fn new(profile: &Indenter, rings: &[(Ring, f64)], radius: f64) -> Mesh {
        let reach = rings.first().map_or(0.0, |(ring, _)| ring.outer.radius);
        let cells = profile.cells(Reach::Radius(reach));
        let mut panels = Vec::new();
        let mut edge = Source { t: 1.0, normal: 0.0, tangential: 0.0 };
        for (ring, share) in rings {
            let span = profile.span(ring);
            edge.normal += span.edge;
            edge.tangential += span.edge * share;
            let Some((cells, SpanParts { low, whole, high })) = cells.map(|cells| (cells, cells.parts(&span))) else {
                continue;
            };
            let whole = whole.rev().map(|index| (index, cells.span_of_cell(index)));
            let parts = high.into_iter().chain(whole).chain(low).filter(|(_, span)| span.gap > 0.0);
            panels.extend(parts.map(|(cell, span)| MeshPanel { cell, span, share: *share }));
        }
        panels.reverse();
        let tree = ClusterTree::new(panels.len(), 1, |items, halves| match halves {
            Some(halves) => Stretch::of_both(halves),
            None => {
                let panel = &panels[items.start];
                let cell = cells.map(|cells| &cells.cells[panel.cell]);
                let sources = cell.map_or_else(Vec::new, |cell| panel.sources(cell, radius));
                Stretch { low: panel.span.inner_radius / radius, high: panel.span.outer_radius / radius, sources }
            }
        });
        Mesh { reach, panels, tree, edge: Some(edge).filter(|edge| edge.normal > 0.0) }
    }

    /// Calls `visit(t - r, source)` for all sources of the stress at the distance `from_axis`, m, from the axis and the
    /// depth z, over the contact radius.
    pub(super) fn visit(
        &self,
        profile: &Indenter,
        radius: f64,
        (from_axis, z): (f64, f64),
        mut visit: impl FnMut(f64, &Source),
    ) {
        let Some(cells) = profile.cells(Reach::Radius(self.reach)) else { return };
        let (r, at) = (from_axis / radius, StressRadius::new(from_axis));
        let seen = |index: usize| {
            let panel = &self.panels[index];
            SeenPanel::new(panel, &cells.cells[panel.cell], radius, (&at, z))
        };
        let mut nears = Vec::with_capacity(4);
        let mut far = |cluster: &Cluster<Stretch>| {
            let Stretch { low, high, sources } = &cluster.sources;
            let taken = match cluster.halves {
                Some(_) => distance(*low, *high, r, z) >= 2.0 * (high - low),
                None => seen(cluster.items.start).is_far(),
            };
            if taken {
                sources.iter().for_each(|source| visit(source.t - r, source));
            }
            taken
        };
        self.tree.visit(0..self.panels.len(), &mut far, &mut |items| nears.push(items.start));
        nears.into_iter().for_each(|index| seen(index).visit(radius, r, &mut visit));
        if let Some(edge) = &self.edge {
            visit((radius - from_axis) / radius, edge);
        }
    }
}

impl MeshPanel {
    /// A part of the cell of this number, with the slope of the pressure for that of the shear.
    pub(super) fn new(cell: usize, span: Span) -> MeshPanel {
        MeshPanel { cell, span, share: 1.0 }
    }

    /// Calls `visit(t - r, source)` for the sources that a place at these radius and depth, over `radius`, sees of it.
    pub(super) fn visit(
        &self,
        cell: &Cell,
        radius: f64,
        place: (&StressRadius, f64),
        mut visit: impl FnMut(f64, &Source),
    ) {
        let (r, seen) = (place.0.radius / radius, SeenPanel::new(self, cell, radius, place));
        if seen.is_far() {
            self.sources(cell, radius).iter().for_each(|source| visit(source.t - r, source));
        } else {
            seen.visit(radius, r, &mut visit);
        }
    }

    /// The sources at the points of the rule.
    fn sources(&self, cell: &Cell, radius: f64) -> Vec<Source> {
        let part = cell.part(&self.span);
        let zeta = TWELVE_POINTS.map(|(share, _)| part.high - part.drop * share);
        let source = |((zeta, gamma), (_, weight)): ((f64, f64), (f64, f64))| {
            let normal = weight * part.drop * gamma;
            Source { t: cell.radius_at(zeta) / radius, normal, tangential: normal * self.share }
        };
        zeta.into_iter().zip(cell.gammas(zeta)).zip(TWELVE_POINTS).map(source).collect()
    }
}

/// A panel as a place sees it, over zeta less its value at the radius of the place, over the contact radius.
struct SeenPanel<'a> {
    cell: &'a Cell,
    share: f64,
    /// zeta at the radius of the place; zero where that is below the cell.
    origin: f64,
    /// How far the square of the radius of the place is below that of the cell, over that of the contact.
    gap: f64,
    /// Where the stress has its branch point.
    branch: Complex,
    low: f64,
    high: f64,
    /// Its true length over that between its rounded ends.
    stretch: f64,
}

impl SeenPanel<'_> {
    fn new<'a>(panel: &MeshPanel, cell: &'a Cell, radius: f64, (at, z): (&StressRadius, f64)) -> SeenPanel<'a> {
        let (square, part) = (radius * radius, cell.part(&panel.span));
        let beyond = (at.square - cell.square).value() / square;
        let origin = beyond.max(0.0).sqrt();
        let deep = Complex::new(-z * z, 2.0 * z * (at.radius / radius));
        let branch = Complex::new(beyond + deep.re, deep.im).root();
        let (branch, low, high) = if beyond > 0.0 {
            // The difference of two zeta has its digits from that of their radii, which are rounded as the place is.
            let from_origin = |end: f64, zeta: f64| {
                (end - at.radius) / radius * ((end + at.radius) / radius) / (zeta / radius + origin)
            };
            let branch = deep * Complex::new(branch.re + origin, branch.im).inverse();
            (branch, from_origin(panel.span.inner_radius, part.low), from_origin(panel.span.outer_radius, part.high))
        } else {
            (branch, part.low / radius, part.high / radius)
        };
        let (gap, stretch) = ((-beyond).max(0.0), part.drop / radius / (high - low));
        SeenPanel { cell, share: panel.share, origin, gap, branch, low, high, stretch }
    }

    /// Whether the rule holds over a part.
    fn resolves(&self, low: f64, high: f64) -> bool {
        distance(low, high, self.branch.re, self.branch.im) >= high - low
    }

    fn is_far(&self) -> bool {
        // One at a single radius lies somewhere within the rounding of that radius, where it is no peak.
        self.resolves(self.low, self.high)
            && (self.low < self.high || distance(self.low, self.high, self.branch.re, self.branch.im) > 0.0)
    }

    /// Visits the sources in ever shorter parts towards the branch point.
    fn visit(&self, radius: f64, r: f64, visit: &mut impl FnMut(f64, &Source)) {
        let mut rule = |nodes: [(f64, f64); 12]| {
            let zeta = nodes.map(|(at, _)| radius * (self.origin + at).max(0.0));
            for (((at, weight), zeta), gamma) in nodes.into_iter().zip(zeta).zip(self.cell.gammas(zeta)) {
                let above = self.gap + at * (2.0 * self.origin + at);
                let offset = above / (self.cell.radius_at(zeta) / radius + r);
                let normal = radius * self.stretch * weight * gamma;
                visit(offset, &Source { t: r + offset, normal, tangential: normal * self.share });
            }
        };
        let at_surface = self.branch.im <= 0.0;
        let mut parts = if self.low < self.high { vec![(self.low, self.high)] } else { Vec::new() };
        while let Some((low, high)) = parts.pop() {
            let length = high - low;
            if self.resolves(low, high) {
                rule(TWELVE_POINTS.map(|(at, weight)| (low + length * at, length * weight)));
            } else if low < 0.0 && high > 0.0 {
                parts.extend([(low, 0.0), (0.0, high)]);
            } else if at_surface && self.origin <= 0.0 && low == 0.0 && (length <= r || r <= 0.0) {
                rule(TWELVE_POINTS.map(|(at, weight)| (length * at, length * weight)));
            } else if at_surface && (low == 0.0 || high == 0.0) && 2.0 * length <= self.origin {
                let side = if low == 0.0 { length } else { -length };
                rule(TWELVE_POINTS.map(|(at, weight)| (side * at * at, 2.0 * length * at * weight)));
            } else {
                let middle = 0.5 * (low + high);
                parts.extend([(low, middle), (middle, high)]);
            }
        }
    }
}

impl Stretch {
    /// Two stretches, the inner one first.
    fn of_both([inner, outer]: [&Stretch; 2]) -> Stretch {
        let (low, high) = (inner.low, outer.high);
        let all = [&inner.sources[..], &outer.sources[..]].concat();
        let long = high - low > CLOSEST * high;
        let sources = if long && all.len() > CHEBYSHEV { condense(low, high, &all) } else { all };
        Stretch { low, high, sources }
    }
}

/// The sources at Chebyshev points that act like `all` on every polynomial of less than the 16th degree.
fn condense(low: f64, high: f64, all: &[Source]) -> Vec<Source> {
    let half = 0.5 * (high - low);
    let [mut normal, mut tangential] = [[0.0; CHEBYSHEV]; 2];
    for source in all {
        let place = (source.t - low) / half - 1.0;
        chebyshev::add_polynomials(&mut normal, place, source.normal);
        chebyshev::add_polynomials(&mut tangential, place, source.tangential);
    }
    let weights = SIXTEEN.weights(&normal).into_iter().zip(SIXTEEN.weights(&tangential));
    let source = |(t, (normal, tangential))| Source { t, normal, tangential };
    SIXTEEN.places(low, high).into_iter().zip(weights).map(source).collect()
}
