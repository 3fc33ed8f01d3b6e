//! Weighted sums of the kernels of adjoining rings, by the quickest way that the profile has.
//!
//! | way | of |
//! |---|---|
//! | [`SeriesRings`] | g' is a short power series in x |
//! | [`WeightedCells`] | all that has cells, kept with the profile or made for one sum |
//! | ring by ring | few of either, the tip of an uneven power, and what has no series |
//!
//! The bench `shapes` has a row for each.

use super::celled;
use super::shape::{CLEAR, Shape, span};
use super::slope_series::SeriesRings;
use super::{Point, Profile, Ring, Span, StressRadius};
#[cfg(test)]
use crate::cells::call_count;
use crate::cells::displacement::displacements;
use crate::cells::field::{Source, SumAndSize, WeightedCells};
use crate::cells::kernel::Kernel;
use crate::numerics::multipole::Multipole;

/// What the derivative of a cell's kernels counts for, in terms of a sum over rings.
const CELL_TERMS: usize = 8;
/// Terms of derivatives before the next question whether to go on.
const BETWEEN_QUESTIONS: usize = 4096;
/// As many kernels, rings times radii, are summed sooner than cells are weighted for all of them.
const FEW: usize = 40;
/// Few extrema are as near to the centre as this part of the radius of the core.
const CORE: f64 = 0.1;
/// The smallest radius, over that of the edge, that cells reach down to at a tip that is not smooth.
const INNERMOST: f64 = 1e-3;
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
        let edge = &rings.last()?.0.outer;
        let cells =
            WeightedCells::new(Source::Kept(Shape::celled(self, edge.radius)?), &self.spans(rings), radii.len());
        #[cfg(test)]
        radii.iter().for_each(|_| call_count::add(|calls| &mut calls.displacement_integral));
        Some(displacements(edge, ends, radii, |angle, radii| cells.sums(angle, radii)))
    }

    /// The spans of weighted rings.
    fn spans(&self, rings: &[(Ring, f64)]) -> Vec<(Span, f64)> {
        rings.iter().map(|(ring, weight)| (span(self, ring), *weight)).collect()
    }

    /// The cells up to an edge, best for radii of at least `least`, m, and the radius, m, that they reach down to.
    fn cells_within(&self, edge: &Point, least: f64) -> Option<(Source<'_>, f64)> {
        if let Some(cells) = Shape::celled(self, edge.radius) {
            return Some((Source::Kept(cells), 0.0));
        }
        let innermost = if self.facts().smooth_tip { 0.0 } else { (CLEAR * least).max(INNERMOST * edge.radius) };
        let cells = celled::between(self, innermost, (edge.square, edge.radius))?;
        Some((Source::Own(Box::new(cells)), innermost))
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

/// A weighted sum of kernels.
pub(crate) struct RingSum<'a> {
    profile: &'a Profile,
    /// From the centre outward.
    rings: Vec<(Ring, f64)>,
    /// Cells for radii from this one on, m.
    cells: Option<(WeightedCells<'a>, f64)>,
}

impl<'a> RingSum<'a> {
    /// Of rings from the centre outward, for so many radii, the best for those of at least `least`, m.
    fn new(profile: &'a Profile, rings: &[(Ring, f64)], radii: usize, least: f64) -> RingSum<'a> {
        let many = radii.saturating_mul(rings.len()) > FEW;
        let edge = rings.last().filter(|_| many).map(|(ring, _)| ring.outer);
        let cells = edge.and_then(|edge| profile.cells_within(&edge, least));
        let weighted = |cells| WeightedCells::new(cells, &profile.spans(rings), radii);
        let cells = cells.map(|(cells, innermost)| (weighted(cells), innermost));
        RingSum { profile, rings: rings.to_vec(), cells }
    }

    /// The sum at each radius.
    pub(crate) fn sums(&self, radii: &[StressRadius]) -> Vec<f64> {
        let mut sums: Vec<f64> = match &self.cells {
            Some((cells, _)) => cells.sums(Kernel::Root, radii).into_iter().map(|(sum, _)| sum).collect(),
            None => vec![0.0; radii.len()],
        };
        let kernel = |at, (ring, weight): &(Ring, f64)| weight * self.profile.kernel(at, ring);
        for (at, sum) in radii.iter().zip(&mut sums).filter(|(at, _)| self.is_ring_by_ring(at)) {
            *sum = beyond(&self.rings, at).map(|ring| kernel(at, ring)).sum();
        }
        sums
    }

    /// Its derivative with respect to r^2, 1/m^2, at each radius, with the sum of the sizes of what it adds up from.
    /// `goes_on` is called with how many terms follow; once it is false, derivatives are zero.
    pub(crate) fn slopes(&self, radii: &[StressRadius], goes_on: impl Fn(usize) -> bool) -> Vec<SumAndSize> {
        let zero = (0.0, 0.0);
        let mut sums = Vec::with_capacity(radii.len());
        let terms = CELL_TERMS + self.cells.as_ref().map_or(0, |(cells, _)| cells.parts());
        for radii in radii.chunks(BETWEEN_QUESTIONS.div_ceil(terms)) {
            match &self.cells {
                Some((cells, _)) if goes_on(terms * radii.len()) => sums.extend(cells.sums(Kernel::RootSlope, radii)),
                _ => sums.resize(sums.len() + radii.len(), zero),
            }
        }
        let add = |at, sum: SumAndSize, (ring, weight): &(Ring, f64)| {
            let term = weight * self.profile.kernel_slope(at, ring);
            (sum.0 + term, sum.1 + term.abs())
        };
        for (at, sum) in radii.iter().zip(&mut sums).filter(|(at, _)| self.is_ring_by_ring(at)) {
            *sum = zero;
            if goes_on(self.rings.len()) {
                *sum = beyond(&self.rings, at).fold(zero, |sum, ring| add(at, sum, ring));
            }
        }
        sums
    }

    /// Whether cells do not serve a radius.
    fn is_ring_by_ring(&self, at: &StressRadius) -> bool {
        self.cells.as_ref().is_none_or(|(_, innermost)| at.radius < *innermost)
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
    /// What is quicker than the profile's own kernels, if anything, and from which radius on, m.
    cells: Option<(Source<'a>, f64)>,
}

struct InwardRing {
    ring: Ring,
    span: Span,
    weight: f64,
    /// What stands for it from afar, where that is quicker.
    far: Option<Multipole>,
}

impl<'a> InwardSum<'a> {
    /// No rings yet, of about so many inside an edge.
    pub(crate) fn new(profile: &'a Profile, edge: &Point, rings: usize) -> InwardSum<'a> {
        // The kernels of a cone and of a parabola are quicker still.
        let quick = profile.slope_series(edge.radius).is_some_and(|series| series.len() <= 2);
        let cells = if quick { None } else { profile.cells_within(edge, 0.0) };
        InwardSum { profile, rings: Vec::with_capacity(rings), cells }
    }

    /// Adds a ring that ends where the last begins.
    pub(crate) fn add(&mut self, ring: Ring, weight: f64) {
        let span = span(self.profile, &ring);
        // The rounding of their squares would count for thin rings, which hold few kinks.
        let thick = span.edge <= 0.0 && (span.outer - span.inner).value() > THIN * span.outer.value();
        let far =
            self.cells.as_ref().filter(|(_, innermost)| thick && span.inner_radius >= *innermost).map(|(cells, _)| {
                let mut sources = Multipole::empty((span.inner.value(), span.outer.value()));
                cells.add_sources(&span, &mut sources);
                sources
            });
        self.rings.push(InwardRing { ring, span, weight, far });
    }

    /// The sum at a radius.
    pub(crate) fn at(&self, at: &StressRadius) -> f64 {
        let square = at.square.value();
        let near = self.cells.as_ref().filter(|(_, innermost)| at.radius >= *innermost);
        let kernel = |InwardRing { ring, span, weight, far }: &InwardRing| {
            weight
                * match (far.as_ref().filter(|far| far.is_far(square)), near) {
                    (Some(far), _) => far.potentials([square])[0],
                    (None, Some((cells, _))) if span.edge <= 0.0 => cells.sum(Kernel::Root, at, span),
                    _ => self.profile.kernel(at, ring),
                }
        };
        self.rings.iter().map(kernel).sum()
    }
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
            let mut sum = InwardSum::new(&table, &points[0], rings.len());
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
