//! Weighted sums of the kernels of adjoining rings, by the quickest way that the profile has.
//!
//! | way | of |
//! |---|---|
//! | [`SeriesRings`] | g' is a short power series in x |
//! | [`SmoothPieces`] | short series resolve g between few kinks |
//! | [`WeightedCells`], [`SumFields`] | tables, and sums with them |
//! | ring by ring | few of either, and what has no series |
//!
//! The bench `shapes` has a row for each.

use super::shape::span;
use super::slope_series::SeriesRings;
use super::smooth_pieces::SmoothPieces;
use super::sum::SumFields;
use super::tabulated;
use super::{Profile, Ring, Span, StressRadius};
use crate::cells::displacement::displacements;
use crate::cells::field::{SumAndSize, WeightedCells};
use crate::cells::kernel::Kernel;
use crate::numerics::multipole::Multipole;

/// What the derivative of a table's kernels counts for, in terms of a sum over rings.
const PANEL_TERMS: usize = 8;
/// As many kernels, rings times radii, are summed sooner than pieces are made of the rings.
const FEW_FOR_PIECES: usize = 40;
/// Few extrema are as near to the centre as this part of the radius of the core.
const CORE: f64 = 0.1;
/// Rings are summed by themselves from afar too, if the squares of their ends differ by less than this share.
const THIN: f64 = 1e-3;

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
            return SeriesRings::new(series, edge, rings, |ring| self.span(ring).gap).sums(radii);
        }
        let least = radii.iter().map(|at| at.radius).filter(|&radius| radius > 0.0).fold(f64::INFINITY, f64::min);
        RingSum::new(self, rings, radii.len(), least).sums(radii)
    }

    /// The same sum for the search of its extrema.
    pub(crate) fn ring_sum(&self, rings: &[(Ring, f64)]) -> RingSum<'_> {
        let core = rings.first().map_or(0.0, |(ring, _)| ring.outer.radius);
        RingSum::new(self, rings, usize::MAX, CORE * core)
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
        Some(displacements(edge, ends, radii, |angle, radii| fields.sums(angle, radii)))
    }

    /// What tables add to stresses and displacements over weighted rings, for sums at so many radii; `None` without a
    /// table.
    fn table_fields(&self, rings: &[(Ring, f64)], radii: usize) -> Option<TableFields<'_>> {
        match self {
            Profile::Tabulated(table) => table.weighted_cells(rings, radii).map(TableFields::Cells),
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

/// Tables over weighted rings.
enum TableFields<'a> {
    Cells(WeightedCells<'a>),
    Parts(SumFields<'a>),
}

impl TableFields<'_> {
    fn sums(&self, kernel: Kernel, radii: &[StressRadius]) -> Vec<SumAndSize> {
        match self {
            TableFields::Cells(cells) => cells.sums(kernel, radii),
            TableFields::Parts(parts) => parts.sums(kernel, radii),
        }
    }
}

/// A weighted sum of kernels.
pub(crate) struct RingSum<'a>(Way<'a>);

enum Way<'a> {
    Pieces(SmoothPieces<'a, Profile>),
    Tables(TableFields<'a>),
    /// From the centre outward.
    Rings(&'a Profile, Vec<(Ring, f64)>),
}

impl<'a> RingSum<'a> {
    /// Of rings from the centre outward, for so many radii, the best for those of at least `least`, m.
    fn new(profile: &'a Profile, rings: &[(Ring, f64)], radii: usize, least: f64) -> RingSum<'a> {
        let kernels = radii.saturating_mul(rings.len());
        let pieces = (kernels > FEW_FOR_PIECES).then(|| SmoothPieces::new(profile, rings, least));
        if let Some(pieces) = pieces.flatten() {
            return RingSum(Way::Pieces(pieces));
        }
        let fields = (kernels > tabulated::FEW).then(|| profile.table_fields(rings, radii));
        RingSum(fields.flatten().map_or_else(|| Way::Rings(profile, rings.to_vec()), Way::Tables))
    }

    /// The sum at each radius.
    pub(crate) fn sums(&self, radii: &[StressRadius]) -> Vec<f64> {
        match &self.0 {
            Way::Pieces(pieces) => pieces.sums(radii),
            Way::Tables(fields) => fields.sums(Kernel::Root, radii).into_iter().map(|(sum, _)| sum).collect(),
            Way::Rings(profile, rings) => {
                let kernel = |at, (ring, weight): &(Ring, f64)| weight * profile.kernel(at, ring);
                radii.iter().map(|at| beyond(rings, at).map(|ring| kernel(at, ring)).sum()).collect()
            }
        }
    }

    /// Its derivative with respect to r^2, 1/m^2, at each radius, with the sum of the sizes of what it adds up from.
    /// `goes_on` is called with how many terms follow; once it is false, derivatives are zero.
    pub(crate) fn slopes(&self, radii: &[StressRadius], goes_on: impl Fn(usize) -> bool) -> Vec<SumAndSize> {
        match &self.0 {
            Way::Pieces(pieces) => pieces.slopes(radii, goes_on),
            Way::Tables(_) if !goes_on(PANEL_TERMS * radii.len()) => vec![(0.0, 0.0); radii.len()],
            Way::Tables(fields) => fields.sums(Kernel::RootSlope, radii),
            Way::Rings(profile, rings) => {
                let add = |at, sum: SumAndSize, (ring, weight): &(Ring, f64)| {
                    let term = weight * profile.kernel_slope(at, ring);
                    (sum.0 + term, sum.1 + term.abs())
                };
                let of = |at| {
                    if goes_on(rings.len()) {
                        beyond(rings, at).fold((0.0, 0.0), |sum, ring| add(at, sum, ring))
                    } else {
                        (0.0, 0.0)
                    }
                };
                radii.iter().map(of).collect()
            }
        }
    }
}

/// The rings beyond a radius that weigh something: what has no weight adds nothing, even where its kernel is infinite.
fn beyond<'r>(rings: &'r [(Ring, f64)], at: &StressRadius) -> impl Iterator<Item = &'r (Ring, f64)> {
    let first = rings.partition_point(|(ring, _)| ring.outer.radius < at.radius);
    rings[first..].iter().filter(|(_, weight)| weight.abs() > 0.0)
}

/// The weighted sum of the kernels of rings that are added one by one, from an edge inward.
pub(crate) struct InwardSum<'a> {
    profile: &'a Profile,
    rings: Vec<InwardRing>,
    /// What is quicker than the rings, if anything.
    pieces: Option<SmoothPieces<'a, Profile>>,
}

struct InwardRing {
    ring: Ring,
    weight: f64,
    /// What stands for it from afar, where that is quicker.
    far: Option<Multipole>,
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
        self.rings.push(InwardRing { ring, weight, far: far_sources(self.profile, &span) });
    }

    /// The sum at a radius.
    pub(crate) fn at(&self, at: &StressRadius) -> f64 {
        if let Some(pieces) = &self.pieces {
            return pieces.sum(at);
        }
        let square = at.square.value();
        let kernel = |InwardRing { ring, weight, far }: &InwardRing| {
            weight
                * match far.as_ref().filter(|far| far.is_far(square)) {
                    Some(far) => far.potentials([square])[0],
                    None => self.profile.kernel(at, ring),
                }
        };
        self.rings.iter().map(kernel).sum()
    }
}

/// What stands from afar for a ring of a table, or of a sum with tables, in which there may be many knots.
fn far_sources(profile: &Profile, span: &Span) -> Option<Multipole> {
    let mut sources = Multipole::empty((span.inner.value(), span.outer.value()));
    let parts = match profile {
        Profile::Tabulated(_) => std::slice::from_ref(profile),
        Profile::Sum(sum) if sum.parts().iter().any(|part| matches!(part, Profile::Tabulated(_))) => sum.parts(),
        _ => return None,
    };
    // The rounding of their squares would count for thin rings, which hold few knots.
    if span.edge > 0.0 || (span.outer - span.inner).value() <= THIN * span.outer.value() {
        return None;
    }
    for part in parts {
        match part {
            Profile::Tabulated(table) => table.add_sources(span, &mut sources),
            other => SmoothPieces::of_span(other, span, span.inner_radius)?.add_sources(&mut sources),
        }
    }
    Some(sources)
}

#[cfg(test)]
mod tests {
    use super::super::{Profile, Ring, StressRadius, Tabulated};
    use super::InwardSum;
    use crate::numerics::double_double::DoubleDouble;

    #[test]
    fn rings_of_a_table_added_one_by_one_are_the_sum_of_their_kernels_however_thin_they_are() {
        let radii: Vec<f64> = (0..400).map(|index| 1e-3 * f64::from(index) / 399.0).collect();
        let heights: Vec<f64> = radii.iter().map(|r| 0.5 * r * r + 20.0 * r.powi(3)).collect();
        let table = Profile::Tabulated(Tabulated::new(&radii, &heights).unwrap());
        let edge = table.level(8e-4);
        for width in [0.3, 1e-2, 1e-4, 1e-6, 1e-8, 1e-10] {
            let ends = [edge, edge * (1.0 - width), edge * (1.0 - 2.0 * width)];
            let points = ends.map(|level| table.point(DoubleDouble::from(level)));
            let rings = [(Ring::between(points[1], points[0]), 1.0), (Ring::between(points[2], points[1]), -0.4)];
            let mut sum = InwardSum::new(&table, points[0].radius, rings.len());
            for (ring, weight) in &rings {
                sum.add(*ring, *weight);
            }
            for distance in [0.1, 0.9, 1.1, 3.0, 1e3] {
                let r = points[2].radius * (1.0 - (distance * width).min(0.9));
                let at = StressRadius::new(r);
                let expected: f64 = rings.iter().map(|(ring, weight)| weight * table.kernel(&at, ring)).sum();
                let found = sum.at(&at);
                assert!((found / expected - 1.0).abs() < 1e-12, "{width} {distance}: {found} is not {expected}");
            }
        }
    }
}
