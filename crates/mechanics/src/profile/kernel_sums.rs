//! The kernels of many adjoining rings, weighted and summed, at many radii.
//!
//! A ring that is far from r acts by the points of a Gauss rule over its radii, and many of them as one cluster
//! ([`Multipole`]); only near rings are asked for their kernels. A rule counts as good where it finds the depth of its
//! ring, which is known.

use super::shape::span;
use super::slope_series::SeriesRings;
use super::smooth_pieces::SmoothPieces;
use super::sum::SumFields;
use super::tabulated::{self, Kernel, SumAndSize, WeightedPanels};
use super::{Profile, Ring, StressRadius};
use crate::numerics::cluster_tree::ClusterTree;
use crate::numerics::gauss::TWENTY_POINTS;
use crate::numerics::multipole::Multipole;

/// What the derivative of a table's kernels counts for, in terms of a sum over rings.
const PANEL_TERMS: usize = 8;
/// Fewer kernels than this, rings times radii, are summed sooner than clusters are made.
const FEW: usize = 256;
/// As many are summed sooner than pieces are made of the rings.
const FEW_FOR_PIECES: usize = 40;
/// Few extrema are as near to the centre as this part of the radius of the core.
const CORE: f64 = 0.1;
/// A ring is near if it is nearer than this, in squares of radii over that of the edge: a smaller difference has lost
/// digits.
const NEAR: f64 = 1e-3;

impl Profile {
    /// The sum of [`Profile::kernel`] times a weight over rings that adjoin each other from the centre outward, at each
    /// of `radii` (m).
    #[must_use]
    pub fn kernel_sums(&self, rings: &[(Ring, f64)], radii: &[f64]) -> Vec<f64> {
        self.kernel_sums_at(rings, &StressRadius::of_all(radii))
    }

    /// [`Profile::kernel_sums`] at radii whose squares have all their digits.
    pub(crate) fn kernel_sums_at(&self, rings: &[(Ring, f64)], radii: &[StressRadius]) -> Vec<f64> {
        let edge = rings.last().map_or(0.0, |(ring, _)| ring.outer.radius);
        if let Some(series) = self.slope_series(edge).filter(|_| edge > 0.0) {
            return SeriesRings::new(&series, edge, rings, |ring| self.span(ring).gap).sums(radii);
        }
        if let Some(sums) = self.sums_by_pieces(rings, radii) {
            return sums;
        }
        let fields =
            if rings.len() * radii.len() > tabulated::FEW { self.table_fields(rings, radii.len()) } else { None };
        if let Some(fields) = fields {
            return fields.sums(Kernel::Root, radii).into_iter().map(|(sum, _)| sum).collect();
        }
        let sources = Sources::new(self, rings, rings.len() * radii.len() > FEW);
        radii.iter().map(|at| sources.sum(at)).collect()
    }

    /// (2/pi) int v dx/sqrt(r^2 - x^2) over the radii x of the contact below r, m, at each of `radii`, at once: v, m,
    /// is straight in g over rings that adjoin each other from the centre to the edge, each with its dv/dg, and `ends`
    /// are its values at the centre and at the edge. `None` where ring by ring is no slower.
    pub(crate) fn displacements(
        &self,
        rings: &[(Ring, f64)],
        ends: (f64, f64),
        radii: &[StressRadius],
    ) -> Option<Vec<f64>> {
        let fields = self.table_fields(rings, radii.len())?;
        let edge = &rings.last()?.0.outer;
        Some(tabulated::displacements(edge, ends, radii, |angle, radii| fields.sums(angle, radii)))
    }

    /// What tables add to stresses and displacements over weighted rings, for sums at so many radii; `None` without a
    /// table.
    fn table_fields(&self, rings: &[(Ring, f64)], radii: usize) -> Option<TableFields<'_>> {
        match self {
            Profile::Tabulated(table) => table.weighted_panels(rings, radii).map(TableFields::Panels),
            Profile::Sum(sum) => SumFields::new(sum, rings, radii).map(TableFields::Parts),
            _ => None,
        }
    }

    /// The coefficients of g'(a xi) = sum of c_k xi^k, `a` being a radius, m, none of them negative; `None` where that
    /// is no series of at most [`MOST_POWERS`](super::slope_series::MOST_POWERS).
    pub(super) fn slope_series(&self, a: f64) -> Option<Vec<f64>> {
        match self {
            Profile::Cone(_) => Some(vec![self.slope(a)]),
            Profile::Sphere(_) => Some(vec![0.0, self.slope(a)]),
            Profile::PowerLaw(power) => power.slope_series(a),
            Profile::ExactSphere(sphere) => sphere.slope_series(a),
            Profile::Sum(sum) => sum.parts().iter().try_fold(Vec::new(), |mut sum, part| {
                let series = part.slope_series(a)?;
                sum.resize(sum.len().max(series.len()), 0.0);
                sum.iter_mut().zip(series).for_each(|(sum, c)| *sum += c);
                Some(sum)
            }),
            _ => None,
        }
    }
}

impl Profile {
    /// The derivatives of the weighted sum of kernels, if there is a way that is quicker than ring by ring.
    pub(crate) fn kernel_slopes<'a>(&'a self, rings: &[(Ring, f64)]) -> Option<KernelSlopes<'a>> {
        let core = rings.first().map_or(0.0, |(ring, _)| ring.outer.radius);
        let pieces = SmoothPieces::new(self, rings, CORE * core).map(SlopeSource::Pieces);
        pieces.or_else(|| self.table_fields(rings, usize::MAX).map(SlopeSource::Tables)).map(KernelSlopes)
    }

    /// The sums by [`SmoothPieces`].
    fn sums_by_pieces(&self, rings: &[(Ring, f64)], radii: &[StressRadius]) -> Option<Vec<f64>> {
        if rings.len() * radii.len() <= FEW_FOR_PIECES {
            return None;
        }
        let least = radii.iter().map(|at| at.radius).filter(|&radius| radius > 0.0).fold(f64::INFINITY, f64::min);
        Some(SmoothPieces::new(self, rings, least)?.sums(radii))
    }
}

/// Tables over weighted rings.
enum TableFields<'a> {
    Panels(WeightedPanels<'a>),
    Parts(SumFields<'a>),
}

impl TableFields<'_> {
    fn sums(&self, kernel: Kernel, radii: &[StressRadius]) -> Vec<SumAndSize> {
        match self {
            TableFields::Panels(panels) => panels.sums(kernel, radii),
            TableFields::Parts(parts) => parts.sums(kernel, radii),
        }
    }
}

/// The derivatives of a weighted sum of kernels with respect to r^2.
pub(crate) struct KernelSlopes<'a>(SlopeSource<'a>);

enum SlopeSource<'a> {
    Pieces(SmoothPieces<'a, Profile>),
    Tables(TableFields<'a>),
}

impl KernelSlopes<'_> {
    /// The sums that [`Profile::kernel_sums`] gives, at each radius, where what they are made of is the same.
    pub(crate) fn sums(&self, profile: &Profile, edge: f64, radii: &[StressRadius]) -> Option<Vec<f64>> {
        match &self.0 {
            SlopeSource::Pieces(pieces) if profile.slope_series(edge).is_none() => Some(pieces.sums(radii)),
            _ => None,
        }
    }

    /// The derivative, 1/m^2, at each radius, with the sum of the sizes of what it adds up from.
    /// `goes_on` is called with how many terms follow; once it is false, derivatives are zero.
    pub(crate) fn at(&self, radii: &[StressRadius], goes_on: impl Fn(usize) -> bool) -> Vec<(f64, f64)> {
        match &self.0 {
            SlopeSource::Pieces(pieces) => pieces.slopes(radii, goes_on),
            SlopeSource::Tables(_) if !goes_on(PANEL_TERMS * radii.len()) => vec![(0.0, 0.0); radii.len()],
            SlopeSource::Tables(fields) => fields.sums(Kernel::RootSlope, radii),
        }
    }
}

/// The weighted sum of the kernels of rings that are added one by one, from an edge inward.
pub(crate) struct InwardSum<'a> {
    profile: &'a Profile,
    rings: Vec<(Ring, f64)>,
    /// What is quicker than the rings, if anything.
    pieces: Option<SmoothPieces<'a, Profile>>,
}

impl<'a> InwardSum<'a> {
    /// No rings yet, of about so many inside an edge at a radius, m.
    pub(crate) fn new(profile: &'a Profile, edge: f64, rings: usize) -> InwardSum<'a> {
        // The kernels of a cone and of a parabola are quicker still.
        let quick = profile.slope_series(edge).is_some_and(|series| series.len() <= 2);
        let pieces = (!quick).then(|| SmoothPieces::within(profile, edge, 0.0, rings));
        InwardSum { profile, rings: Vec::with_capacity(rings), pieces }
    }

    /// Adds a ring that ends where the last begins.
    pub(crate) fn add(&mut self, ring: Ring, weight: f64) {
        let span = span(self.profile, &ring);
        if self.pieces.as_mut().is_some_and(|pieces| pieces.add(&span, weight).is_none()) {
            self.pieces = None;
        }
        self.rings.push((ring, weight));
    }

    /// The sum at a radius.
    pub(crate) fn at(&self, at: &StressRadius) -> f64 {
        match &self.pieces {
            Some(pieces) => pieces.sum(at),
            None => self.rings.iter().map(|(ring, weight)| weight * self.profile.kernel(at, ring)).sum(),
        }
    }
}

/// Rings of any profile, and what stands for those that are far.
struct Sources<'a> {
    profile: &'a Profile,
    rings: &'a [(Ring, f64)],
    /// Empty of few rings and radii.
    tree: ClusterTree<Far>,
    /// [`NEAR`] in m^2.
    margin: f64,
}

/// What stands for a cluster of rings from afar; none if the rule is not good for one of them.
type Far = Option<Multipole>;

impl Sources<'_> {
    /// The sources of rings and their weights, in a tree if there are `many`.
    fn new<'a>(profile: &'a Profile, rings: &'a [(Ring, f64)], many: bool) -> Sources<'a> {
        let edge = rings.last().map(|(ring, _)| ring.outer).unwrap_or_default();
        let clusters = if many { rings.len() } else { 0 };
        let tree = ClusterTree::new(clusters, 1, |items, halves: Option<[&Far; 2]>| {
            let (inner, outer) = (&rings[items.start].0.inner, &rings[items.end - 1].0.outer);
            let mut sources = Multipole::empty((inner.square.value(), outer.square.value()));
            match halves {
                Some(halves) => {
                    for half in halves {
                        sources.add(half.as_ref()?, 1.0);
                    }
                }
                None => add_ring(&mut sources, profile, &rings[items.start], edge.level.value())?,
            }
            Some(sources)
        });
        Sources { profile, rings, tree, margin: NEAR * edge.square.value() }
    }

    fn sum(&self, at: &StressRadius) -> f64 {
        let square = at.square.value();
        let first = self.rings.partition_point(|(ring, _)| ring.outer.radius < at.radius);
        let kernel = |(ring, weight): &(Ring, f64)| {
            if weight.abs() > 0.0 { weight * self.profile.kernel(at, ring) } else { 0.0 }
        };
        if self.tree.root().is_none() {
            return self.rings[first..].iter().map(kernel).sum();
        }
        let (mut far, mut near) = (0.0, 0.0);
        self.tree.visit(
            first..self.rings.len(),
            &mut |cluster| {
                let beyond = square + self.margin;
                let away = |sources: &&Multipole| sources.is_far(beyond) && sources.interval.0 - beyond >= self.margin;
                let sources = cluster.sources.as_ref().filter(away);
                far += sources.map_or(0.0, |sources| sources.potentials([square])[0]);
                sources.is_some()
            },
            &mut |items| near += self.rings[items].iter().map(kernel).sum::<f64>(),
        );
        far + near
    }
}

/// Adds the points of a ring; `None` if they miss its depth by more than the rounding of the level `top`, m.
fn add_ring(sources: &mut Multipole, profile: &Profile, (ring, weight): &(Ring, f64), top: f64) -> Option<()> {
    let (low, high) = (ring.inner.radius, ring.outer.radius);
    let nodes = TWENTY_POINTS.map(|(u, share)| (low + (high - low) * u, (high - low) * share));
    let rises = nodes.map(|(x, share)| share * profile.slope(x));
    let sum: f64 = rises.iter().sum();
    if !(sum > 0.0 && (sum - ring.depth).abs() <= 4.0 * f64::EPSILON * top) {
        return None;
    }
    sources
        .add_sources(&nodes.map(|(x, _)| (x - low) * (x + low)), &rises.map(|rise| weight * ring.depth / sum * rise));
    Some(())
}
