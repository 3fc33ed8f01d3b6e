//! The kernels of profiles whose g' is a short power series in x, weighted and summed over adjoining rings at many
//! radii, and that of one ring.
//!
//! In units of the edge, xi = x/a, rho = r/a and g'(a xi) = sum of c_k xi^k, a kernel is the integral of
//! [`root_kernel`](crate::numerics::root_kernel) with t = xi and kappa = rho^2. No c_k is negative, so nothing cancels.
//!
//! Neighbouring rings share a root, and all runs over plain arrays, several radii at a time.

use std::ops::Range;

use super::distant_rings::DistantRings;
use super::shape::KernelOrder;
use super::{DoubleDouble, Ring, Span, StressRadius};
#[cfg(test)]
use crate::cells::call_count;
use crate::numerics::root_kernel::{MOST_TERMS, Series, Stretch, kernels};

/// Radii that are summed for side by side: roots and divisions take long, and one need not wait for another's.
const LANES: usize = 8;
/// The most powers of x in a series.
pub(super) const MOST_POWERS: usize = MOST_TERMS - 1;
/// With fewer rings than this, bringing radii in order costs more than it saves.
const WORTH_SORTING: usize = 8;
/// From so many rings and radii on those of a parabola are summed by clusters.
const MANY: (usize, usize) = (128, 48);
/// Squares of radii that differ by less, over that of the outer one, have lost digits that the depth of their ring has.
const THIN: f64 = 1e-3;

type Lanes = [f64; LANES];

/// Rings of a profile whose g' is a series, from the edge inward.
pub(super) struct SeriesRings {
    /// The coefficients c_k.
    series: Vec<f64>,
    edge: SeriesPoint,
    /// 1/a^2, m^-2.
    unit: f64,
    rings: Vec<InwardSeries>,
}

/// An end of a ring: x^2, m^2, in both parts, and xi.
struct SeriesPoint {
    square: f64,
    rest: f64,
    xi: f64,
}

impl SeriesPoint {
    fn new(square: DoubleDouble, radius: f64, edge: f64) -> SeriesPoint {
        let (square, rest) = square.parts();
        SeriesPoint { square, rest, xi: radius / edge }
    }
}

/// A ring by its inner end.
struct InwardSeries {
    end: SeriesPoint,
    /// Difference of xi^2 to its outer end.
    gap: f64,
    /// Whether that difference has digits that the squares of both ends have lost.
    thin: bool,
    weight: f64,
}

/// The squares of as many radii as there are lanes, in both parts, and the least and the greatest of them; rho and its
/// square.
struct SeriesPlace {
    square: Lanes,
    rest: Lanes,
    least: f64,
    greatest: f64,
    rho: Lanes,
    rho_square: Lanes,
}

impl SeriesRings {
    /// Rings and their weights, the outermost of which ends at the radius `edge`, m, that the series is in units of.
    /// `gap` is the difference of the squares of the radii of a ring, m^2.
    pub(super) fn new(series: Vec<f64>, edge: f64, rings: &[(Ring, f64)], gap: impl Fn(&Ring) -> f64) -> SeriesRings {
        let unit = 1.0 / (edge * edge);
        let inward = |(ring, weight): &(Ring, f64)| {
            let plain = (ring.outer.square - ring.inner.square).value();
            let thin = plain <= THIN * ring.outer.square.value();
            InwardSeries {
                end: SeriesPoint::new(ring.inner.square, ring.inner.radius, edge),
                gap: unit * if thin { gap(ring) } else { plain },
                thin,
                weight: *weight,
            }
        };
        let outermost = rings.last().map_or(DoubleDouble::ZERO, |(ring, _)| ring.outer.square);
        SeriesRings {
            series,
            edge: SeriesPoint::new(outermost, edge, edge),
            unit,
            rings: rings.iter().rev().map(inward).collect(),
        }
    }

    /// The sums at each radius.
    pub(super) fn sums(&self, radii: &[StressRadius]) -> Vec<f64> {
        let many = self.rings.len() >= MANY.0 && radii.len() >= MANY.1;
        if let ([0.0, c], true) = (self.series.as_slice(), many) {
            return self.sums_by_clusters(*c, radii);
        }
        let order =
            if self.rings.len() < WORTH_SORTING { (0..radii.len()).collect() } else { StressRadius::rising(radii) };
        let mut sums = vec![0.0; radii.len()];
        for order in order.chunks(LANES) {
            let place = self.place(order.iter().map(|&index| radii[index].square));
            let mut lanes = [0.0; LANES];
            self.add(0..self.rings.len(), &place, &mut lanes);
            for (&index, kernel) in order.iter().zip(lanes) {
                sums[index] = kernel;
            }
        }
        sums
    }

    /// The same of a parabola of this c_1, what is far from a few neighbouring radii by [`DistantRings`].
    fn sums_by_clusters(&self, c: f64, radii: &[StressRadius]) -> Vec<f64> {
        let rings: Vec<(f64, f64)> = self.rings.iter().map(|ring| (ring.gap, ring.weight)).collect();
        let distant = DistantRings::new(&rings);
        let (order, mut sums) = (StressRadius::rising(radii), vec![0.0; radii.len()]);
        for order in order.chunks(LANES) {
            let place = self.place(order.iter().map(|&index| radii[index].square));
            let mut lanes = [0.0; LANES];
            let last = self.rings.partition_point(|ring| ring.end.square >= place.least);
            // Far by so much that the rounding of a difference does not count.
            let distance = |index: usize| {
                let square = self.rings[index].end.square;
                (square * (1.0 - 4.0 * f64::EPSILON) - place.greatest) * self.unit
            };
            let excess = |index: usize| self.excess(&self.rings[index].end, &place);
            let near = |run: Range<usize>| self.add(run, &place, &mut lanes);
            let sum = distant.sum(self.rings.len().min(last + 1), distance, excess, near);
            for ((&index, near), far) in order.iter().zip(lanes).zip(sum) {
                sums[index] = near + 0.5 * c * far;
            }
        }
        sums
    }

    /// Some radii, of which lanes left over repeat the first.
    fn place(&self, squares: impl Iterator<Item = DoubleDouble>) -> SeriesPlace {
        let (mut square, mut rest) = ([0.0; LANES], [0.0; LANES]);
        let mut count = 0;
        for one in squares.take(LANES) {
            (square[count], rest[count]) = one.parts();
            count += 1;
        }
        for lane in count..LANES {
            (square[lane], rest[lane]) = (square[0], rest[0]);
        }
        let least = square.iter().copied().fold(f64::INFINITY, f64::min);
        let greatest = square.iter().copied().fold(0.0, f64::max);
        let rho_square = square.map(|square| square * self.unit);
        SeriesPlace { square, rest, least, greatest, rho: rho_square.map(f64::sqrt), rho_square }
    }

    /// How far an end is beyond each radius. Squares that nearly agree cancel without a loss, and the rest is what
    /// rounding them has lost.
    fn excess(&self, end: &SeriesPoint, place: &SeriesPlace) -> Lanes {
        std::array::from_fn(|lane| ((end.square - place.square[lane]) + (end.rest - place.rest[lane])) * self.unit)
    }

    /// Adds what the rings `run` say at as many radii as there are lanes.
    fn add(&self, run: Range<usize>, place: &SeriesPlace, sums: &mut Lanes) {
        let series = of(&self.series);
        let edge = run.start.checked_sub(1).map_or(&self.edge, |outer| &self.rings[outer].end);
        let (mut outer, mut v_high): (&SeriesPoint, Lanes) = (edge, self.excess(edge, place).map(root_of));
        for ring in &self.rings[run] {
            #[cfg(test)]
            call_count::add(|calls| &mut calls.kernel);
            let below = self.excess(&ring.end, place);
            let v_low = below.map(root_of);
            if ring.thin {
                for lane in 0..LANES {
                    if below[lane] > -0.5 * ring.gap {
                        v_high[lane] = root_of(below[lane] + ring.gap);
                    }
                }
            }
            if ring.weight.abs() > 0.0 {
                let (mut low, mut gap) = ([ring.end.xi; LANES], [ring.gap; LANES]);
                for lane in 0..LANES {
                    if below[lane] <= 0.0 {
                        (low[lane], gap[lane]) = (place.rho[lane], v_high[lane] * v_high[lane]);
                    }
                }
                let stretch = Stretch { kappa: place.rho_square, low, high: outer.xi, v_low, v_high, gap };
                let (kernels, _) = kernels::<LANES, false>(series, &stretch);
                for lane in 0..LANES {
                    sums[lane] += ring.weight * kernels[lane];
                }
            }
            (outer, v_high) = (&ring.end, v_low);
            if ring.end.square < place.least {
                break;
            }
        }
    }
}

/// A series with what it consists of.
fn of(terms: &[f64]) -> Series<'_> {
    Series { terms, odd: terms.iter().step_by(2).all(|c| *c <= 0.0) }
}

/// The root of what is positive, and zero of all else.
fn root_of(square: f64) -> f64 {
    (if square > 0.0 { square } else { 0.0 }).sqrt()
}

/// The kernel of a span, or its derivative with respect to r^2, 1/m^2, from the right, by a series in units of the
/// span's outer radius.
pub(super) fn kernel(series: &[f64], order: KernelOrder, at: &StressRadius, span: &Span) -> f64 {
    let (inner, outer) = span.excess(at.square);
    if outer <= 0.0 {
        return 0.0;
    }
    let unit = 1.0 / (span.outer_radius * span.outer_radius);
    let (low, v_low, gap) =
        if inner > 0.0 { (span.inner_radius, inner * unit, span.gap) } else { (at.radius, 0.0, outer) };
    let stretch = Stretch {
        kappa: [at.square.value() * unit],
        low: [low / span.outer_radius],
        high: 1.0,
        v_low: [v_low.sqrt()],
        v_high: [(outer * unit).sqrt()],
        gap: [gap * unit],
    };
    let series = of(series);
    match order {
        KernelOrder::Value => kernels::<1, false>(series, &stretch).0[0],
        KernelOrder::Slope => kernels::<1, true>(series, &stretch).1[0] * unit,
    }
}
