//! Weighted sums of the kernels of adjoining rings: in closed form for a ball, by its cells for every other profile.

use super::{Indenter, Parabola, Point, StressRadius};
use crate::cells::Cells;
#[cfg(test)]
use crate::cells::call_count;
use crate::cells::displacement::displacements;
use crate::cells::field::{MANY, SumAndSize, WeightedCells};
use crate::cells::kernel::Kernel;
use crate::cells::ring::Ring;
use crate::cells::shape::Reach;
use crate::cells::span::Span;
use crate::numerics::multipole::Multipole;

/// The cost of the derivative of the kernels of a cell, in terms of a sum over rings.
const CELL_TERMS: usize = 8;
/// Terms of derivatives before the next question whether to go on.
const BETWEEN_QUESTIONS: usize = 4096;
/// Radii from which on a search for extrema may ask for.
const SEARCH: usize = usize::MAX;
/// From so many rings on cells are quicker than closed forms at many radii.
const MANY_RINGS: usize = 128;

impl Indenter {
    /// The sum of [`Indenter::kernel`] times a weight over rings that adjoin each other from the centre outward, at
    /// each of `radii` (m).
    #[must_use]
    pub fn kernel_sums(&self, rings: &[(Ring, f64)], radii: &[f64]) -> Vec<f64> {
        self.kernel_sums_at(rings, &StressRadius::of_all(radii))
    }

    /// [`Indenter::kernel_sums`] at radii whose squares have all their digits.
    pub(crate) fn kernel_sums_at(&self, rings: &[(Ring, f64)], radii: &[StressRadius]) -> Vec<f64> {
        RingSum::new(self, rings, radii.len()).sums(radii)
    }

    /// The same sum for the search of its extrema.
    pub(crate) fn ring_sum(&self, rings: &[(Ring, f64)]) -> RingSum<'_> {
        RingSum::new(self, rings, SEARCH)
    }

    /// (2/pi) int v dx/sqrt(r^2 - x^2) over the radii x of the contact below r, m, at each of `radii`, at once: v, m,
    /// is straight in g over rings that adjoin each other from the centre to the edge, each with its dv/dg, and `ends`
    /// are its values at the centre and at the edge. NaN without a surface.
    pub(crate) fn displacements(&self, rings: &[(Ring, f64)], ends: (f64, f64), radii: &[StressRadius]) -> Vec<f64> {
        let edge = rings.last().map_or(Point::default(), |(ring, _)| ring.outer);
        let Some(cells) = self.cells(Reach::Radius(edge.radius)) else { return vec![f64::NAN; radii.len()] };
        let cells = WeightedCells::new(cells, &self.spans(rings), radii.len());
        #[cfg(test)]
        radii.iter().for_each(|_| call_count::add(|calls| &mut calls.displacement_integral));
        displacements(&edge, ends, radii, |angle, radii| cells.sums(angle, radii))
    }

    /// The spans of weighted rings.
    fn spans(&self, rings: &[(Ring, f64)]) -> Vec<(Span, f64)> {
        rings.iter().map(|(ring, weight)| (self.span(ring), *weight)).collect()
    }
}

/// A weighted sum of kernels of rings from the centre outward.
pub(crate) enum RingSum<'a> {
    Ball(&'a Parabola, Vec<(Ring, f64)>),
    Cells(WeightedCells<'a>),
    /// Without a stress field.
    Unknown,
}

impl<'a> RingSum<'a> {
    /// For sums at so many radii.
    fn new(indenter: &'a Indenter, rings: &[(Ring, f64)], radii: usize) -> RingSum<'a> {
        let edge = rings.last().map_or(0.0, |(ring, _)| ring.outer.radius);
        match (indenter.ball_face(), indenter.cells(Reach::Radius(edge))) {
            (Some(ball), _) if rings.len() < MANY_RINGS || radii < MANY => RingSum::Ball(ball, rings.to_vec()),
            (_, Some(cells)) => RingSum::Cells(WeightedCells::new(cells, &indenter.spans(rings), radii)),
            _ => RingSum::Unknown,
        }
    }

    /// The sum at each radius.
    pub(crate) fn sums(&self, radii: &[StressRadius]) -> Vec<f64> {
        self.all::<false>(radii).into_iter().map(|(sum, _)| sum).collect()
    }

    /// Its derivative with respect to r^2, 1/m^2, at each radius, with the sum of the sizes of what it adds up from.
    /// `goes_on` is called with how many terms follow; once it is false, derivatives are zero.
    pub(crate) fn slopes(&self, radii: &[StressRadius], goes_on: impl Fn(usize) -> bool) -> Vec<SumAndSize> {
        let mut sums = Vec::with_capacity(radii.len());
        let terms = match self {
            RingSum::Ball(_, rings) => rings.len(),
            RingSum::Cells(cells) => CELL_TERMS + cells.parts(),
            RingSum::Unknown => 1,
        };
        for radii in radii.chunks(BETWEEN_QUESTIONS.div_ceil(terms.max(1))) {
            if goes_on(terms * radii.len()) {
                sums.extend(self.all::<true>(radii));
            } else {
                sums.resize(sums.len() + radii.len(), (0.0, 0.0));
            }
        }
        sums
    }

    fn all<const SLOPE: bool>(&self, radii: &[StressRadius]) -> Vec<SumAndSize> {
        match self {
            RingSum::Ball(ball, rings) => {
                let order = StressRadius::rising(radii);
                let ordered: Vec<StressRadius> = order.iter().map(|&index| radii[index]).collect();
                let mut sums = vec![(0.0, 0.0); radii.len()];
                let found = ball.sums::<SLOPE>(rings, &ordered);
                order.into_iter().zip(found).for_each(|(index, sum)| sums[index] = sum);
                sums
            }
            RingSum::Cells(cells) => cells.sums(if SLOPE { Kernel::RootSlope } else { Kernel::Root }, radii),
            RingSum::Unknown => vec![(f64::NAN, f64::NAN); radii.len()],
        }
    }
}

/// The weighted sum of the kernels of rings that are added one by one, from an edge inward.
pub(crate) struct InwardSum<'a> {
    indenter: &'a Indenter,
    rings: Vec<InwardRing>,
    cells: Option<&'a Cells>,
}

struct InwardRing {
    ring: Ring,
    span: Span,
    weight: f64,
    far: Option<Multipole>,
}

impl<'a> InwardSum<'a> {
    /// No rings yet, of about so many inside an edge.
    pub(crate) fn new(indenter: &'a Indenter, edge: &Point, rings: usize) -> InwardSum<'a> {
        // The kernel of a ball is quicker still.
        let cells = if indenter.ball().is_some() { None } else { indenter.cells(Reach::Radius(edge.radius)) };
        InwardSum { indenter, rings: Vec::with_capacity(rings), cells }
    }

    /// Adds a ring that ends where the last begins.
    pub(crate) fn add(&mut self, ring: Ring, weight: f64) {
        let span = self.indenter.span(&ring);
        let far = self.cells.filter(|_| span.edge <= 0.0).map(|cells| cells.sources_of(&span));
        self.rings.push(InwardRing { ring, span, weight, far });
    }

    /// The sum at a radius.
    pub(crate) fn at(&self, at: &StressRadius) -> f64 {
        let kernel = |InwardRing { ring, span, weight, far }: &InwardRing| {
            weight
                * match (far.as_ref().filter(|far| Kernel::Root.is_far(far, at.square)), self.cells) {
                    (Some(far), _) => Kernel::Root.far(far, [at.square])[0],
                    (None, Some(cells)) if span.edge <= 0.0 => cells.sum(Kernel::Root, at, span),
                    _ => self.indenter.kernel(at, ring),
                }
        };
        self.rings.iter().map(kernel).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::super::Indenter;
    use super::InwardSum;
    use crate::numerics::double_double::DoubleDouble;
    use crate::profile::{Profile, Ring, StressRadius, Tabulated};

    #[test]
    fn rings_of_a_table_added_one_by_one_are_the_sum_of_their_kernels_however_thin_they_are() {
        let radii: Vec<f64> = (0..400).map(|index| 1e-3 * f64::from(index) / 399.0).collect();
        let heights: Vec<f64> = radii.iter().map(|r| 0.5 * r * r + 20.0 * r.powi(3)).collect();
        let table = Indenter::new(Profile::Tabulated(Tabulated::new(&radii, &heights).unwrap()));
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
