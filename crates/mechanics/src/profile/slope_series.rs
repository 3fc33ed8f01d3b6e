//! The kernels of profiles whose g' is a short power series in x, weighted and summed over adjoining rings at many
//! radii.
//!
//! In units of the edge, xi = x/a, rho = r/a, v = sqrt(xi^2 - rho^2) and g'(a xi) = sum of c_k xi^k. With I_k = int
//! xi^k dxi/v, I_0 = ln(xi + v), I_1 = v and I_k = [xi^(k-1) v]/k + (1 - 1/k) rho^2 I_(k-2), so that the kernel is
//! v A(xi^2) + xi v B(xi^2) + L ln(xi + v), whose polynomials depend on r alone. No c_k is negative, so nothing cancels
//! in them, and between the ends of a ring differences are taken of each factor, not of the products.
//!
//! Neighbouring rings share a root, and all runs over plain arrays, several radii at a time.

use std::ops::Range;

#[cfg(test)]
use super::call_count;
use super::distant_rings::DistantRings;
use super::{DoubleDouble, Ring, StressRadius};
use crate::numerics::logarithm::ln_1p;

/// Radii that are summed for side by side: roots and divisions take long, and one need not wait for another's.
pub(super) const LANES: usize = 8;
/// The most powers of x in a series.
pub(super) const MOST_POWERS: usize = 40;
/// With fewer rings than this, bringing radii in order costs more than it saves.
const WORTH_SORTING: usize = 8;
/// From so many rings and radii on those of a parabola are summed by clusters.
const MANY: (usize, usize) = (128, 48);
/// Squares of radii that differ by less, over that of the outer one, have lost digits that the depth of their ring has.
const THIN: f64 = 1e-3;

pub(super) type Lanes = [f64; LANES];

/// Rings of a profile whose g' is a series, from the edge inward.
pub(super) struct SeriesRings<'a> {
    /// The coefficients c_k.
    series: &'a [f64],
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

/// The squares of as many radii as there are lanes, in both parts, and the least and the greatest of them.
struct SeriesPlace {
    square: Lanes,
    rest: Lanes,
    least: f64,
    greatest: f64,
}

impl SeriesPlace {
    /// Lanes left over repeat the first.
    fn of(squares: impl Iterator<Item = DoubleDouble>) -> SeriesPlace {
        let mut place = SeriesPlace { square: [0.0; LANES], rest: [0.0; LANES], least: f64::INFINITY, greatest: 0.0 };
        let mut count = 0;
        for square in squares.take(LANES) {
            (place.square[count], place.rest[count]) = square.parts();
            count += 1;
        }
        for lane in count..LANES {
            (place.square[lane], place.rest[lane]) = (place.square[0], place.rest[0]);
        }
        place.least = place.square.iter().copied().fold(f64::INFINITY, f64::min);
        place.greatest = place.square.iter().copied().fold(0.0, f64::max);
        place
    }

    /// How far an end is beyond each of them. Squares that nearly agree cancel without a loss, and the rest is what
    /// rounding them has lost.
    fn excess(&self, end: &SeriesPoint, unit: f64) -> Lanes {
        std::array::from_fn(|lane| ((end.square - self.square[lane]) + (end.rest - self.rest[lane])) * unit)
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

/// The polynomials A and B by rising powers of xi^2, and L, at the radii of a chunk; empty or `None` where they are
/// zero.
struct Antiderivative {
    a: Vec<Lanes>,
    b: Vec<Lanes>,
    log: Option<Lanes>,
}

impl Antiderivative {
    /// That of a series, whose numbers [`Antiderivative::fill`] sets.
    fn of(series: &[f64]) -> Antiderivative {
        let terms = |first: usize| {
            let last = (first..series.len()).step_by(2).rfind(|&k| series[k] > 0.0);
            vec![[0.0; LANES]; last.map_or(0, |last| 1 + (last - first) / 2)]
        };
        let (a, b) = (terms(1), terms(2));
        let log = (!b.is_empty() || series.first().is_some_and(|&c| c > 0.0)).then_some([0.0; LANES]);
        Antiderivative { a, b, log }
    }

    /// Sets the numbers at radii of these rho^2.
    fn fill(&mut self, series: &[f64], squares: &Lanes) {
        let fill = |terms: &mut [Lanes], first: usize| {
            let mut carried = [0.0; LANES];
            for (index, term) in terms.iter_mut().enumerate().rev() {
                let k = first + 2 * index;
                let power = k as f64;
                for lane in 0..LANES {
                    let whole = series[k] + carried[lane];
                    term[lane] = whole / power;
                    carried[lane] = (1.0 - 1.0 / power) * squares[lane] * whole;
                }
            }
            carried
        };
        fill(&mut self.a, 1);
        let carried = fill(&mut self.b, 2);
        self.log = self.log.map(|_| carried.map(|carried| series[0] + carried));
    }
}

/// A polynomial at `square` by its coefficients, one at least, and its divided difference between there and `other`.
fn at(coefficients: &[Lanes], square: f64, other: f64) -> (Lanes, Lanes) {
    let (mut value, mut difference) = (coefficients[coefficients.len() - 1], [0.0; LANES]);
    for coefficient in coefficients.iter().rev().skip(1) {
        for lane in 0..LANES {
            difference[lane] = difference[lane] * other + value[lane];
            value[lane] = value[lane] * square + coefficient[lane];
        }
    }
    (value, difference)
}

impl SeriesRings<'_> {
    /// Rings and their weights, the outermost of which ends at the radius `edge`, m, that the series is in units of.
    /// `gap` is the difference of the squares of the radii of a ring, m^2.
    pub(super) fn new<'a>(
        series: &'a [f64],
        edge: f64,
        rings: &[(Ring, f64)],
        gap: impl Fn(&Ring) -> f64,
    ) -> SeriesRings<'a> {
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
        let parabola = matches!(self.series, [0.0, _]);
        if parabola && self.rings.len() >= MANY.0 && radii.len() >= MANY.1 {
            return self.sums_by_clusters(radii);
        }
        let order =
            if self.rings.len() < WORTH_SORTING { (0..radii.len()).collect() } else { StressRadius::rising(radii) };
        let mut sums = vec![0.0; radii.len()];
        let mut antiderivative = Antiderivative::of(self.series);
        for order in order.chunks(LANES) {
            let place = SeriesPlace::of(order.iter().map(|&index| radii[index].square));
            let mut lanes = [0.0; LANES];
            antiderivative.fill(self.series, &place.square.map(|square| square * self.unit));
            self.add(0..self.rings.len(), &place, &antiderivative, &mut lanes);
            for (&index, lane) in order.iter().zip(lanes) {
                sums[index] = lane;
            }
        }
        sums
    }

    /// The same of a parabola, what is far from a few neighbouring radii by [`DistantRings`].
    fn sums_by_clusters(&self, radii: &[StressRadius]) -> Vec<f64> {
        let rings: Vec<(f64, f64)> = self.rings.iter().map(|ring| (ring.gap, ring.weight)).collect();
        let distant = DistantRings::new(&rings);
        let (order, mut sums) = (StressRadius::rising(radii), vec![0.0; radii.len()]);
        let mut antiderivative = Antiderivative::of(self.series);
        for order in order.chunks(LANES) {
            let place = SeriesPlace::of(order.iter().map(|&index| radii[index].square));
            let mut lanes = [0.0; LANES];
            antiderivative.fill(self.series, &place.square.map(|square| square * self.unit));
            let last = self.rings.partition_point(|ring| ring.end.square >= place.least);
            // Far by so much that the rounding of a difference does not count.
            let distance = |index: usize| {
                let square = self.rings[index].end.square;
                (square * (1.0 - 4.0 * f64::EPSILON) - place.greatest) * self.unit
            };
            let excess = |index: usize| place.excess(&self.rings[index].end, self.unit);
            let near = |run: Range<usize>| self.add(run, &place, &antiderivative, &mut lanes);
            let sum = distant.sum(self.rings.len().min(last + 1), distance, excess, near);
            for ((&index, near), far) in order.iter().zip(lanes).zip(sum) {
                sums[index] = near + 0.5 * self.series[1] * far;
            }
        }
        sums
    }

    /// Adds what the rings `run` say at as many radii as there are lanes.
    fn add(&self, run: Range<usize>, place: &SeriesPlace, antiderivative: &Antiderivative, sums: &mut Lanes) {
        let SeriesPlace { square, least, greatest, .. } = *place;
        let excess = |end: &SeriesPoint| place.excess(end, self.unit);
        let rho_square: Lanes = square.map(|square| square * self.unit);
        let edge = run.start.checked_sub(1).map_or(&self.edge, |outer| &self.rings[outer].end);
        let (mut outer, mut reached): (&SeriesPoint, Lanes) = (edge, excess(edge).map(root_of));
        // Most rings lie clearly beyond all the radii of this chunk.
        let clear = greatest * (1.0 + 4.0 * f64::EPSILON);
        for ring in &self.rings[run] {
            #[cfg(test)]
            call_count::add(|calls| &mut calls.kernel);
            let below = excess(&ring.end);
            let inner = below.map(root_of);
            if ring.thin {
                for lane in 0..LANES {
                    if below[lane] > -0.5 * ring.gap {
                        reached[lane] = root_of(below[lane] + ring.gap);
                    }
                }
            }
            if ring.weight.abs() > 0.0 {
                let kernels = if ring.end.square > clear {
                    antiderivative.whole(ring, outer, &inner, &reached)
                } else {
                    let whole = antiderivative.whole(ring, outer, &inner, &reached);
                    let cut = antiderivative.cut(outer, &rho_square, &reached);
                    std::array::from_fn(|lane| if inner[lane] > 0.0 { whole[lane] } else { cut[lane] })
                };
                for lane in 0..LANES {
                    sums[lane] += ring.weight * kernels[lane];
                }
            }
            (outer, reached) = (&ring.end, inner);
            if ring.end.square < least {
                break;
            }
        }
    }
}

impl Antiderivative {
    /// The kernels of a whole ring by the v at both its ends.
    fn whole(&self, ring: &InwardSeries, outer: &SeriesPoint, v: &Lanes, v_outer: &Lanes) -> Lanes {
        let (xi, xi_outer) = (ring.end.xi, outer.xi);
        let width = ring.gap / (xi + xi_outer);
        let rise: Lanes = std::array::from_fn(|lane| ring.gap / (v[lane] + v_outer[lane]));
        let mut sum = [0.0; LANES];
        if !self.a.is_empty() {
            let (value, difference) = at(&self.a, xi_outer * xi_outer, xi * xi);
            for lane in 0..LANES {
                sum[lane] += rise[lane] * value[lane] + v[lane] * ring.gap * difference[lane];
            }
        }
        if !self.b.is_empty() {
            let (value, difference) = at(&self.b, xi_outer * xi_outer, xi * xi);
            for lane in 0..LANES {
                sum[lane] += (width * v_outer[lane] + xi * rise[lane]) * value[lane]
                    + xi * v[lane] * ring.gap * difference[lane];
            }
        }
        if let Some(log) = &self.log {
            let ratio: Lanes = std::array::from_fn(|lane| (width + rise[lane]) / (xi + v[lane]));
            let logarithm = ln_1p(ratio);
            for lane in 0..LANES {
                // At the centre the logarithm is infinite, and of all shapes but a cone its share is zero.
                sum[lane] += if log[lane] > 0.0 { log[lane] * logarithm[lane] } else { 0.0 };
            }
        }
        sum
    }

    /// The kernels of what lies beyond the radii of the lanes, up to the outer end of a ring that contains them; zero
    /// where that end is inside them.
    fn cut(&self, outer: &SeriesPoint, rho_square: &Lanes, v_outer: &Lanes) -> Lanes {
        let mut sum = [0.0; LANES];
        let square = outer.xi * outer.xi;
        for (terms, power) in [(&self.a, 1.0), (&self.b, outer.xi)].into_iter().filter(|(terms, _)| !terms.is_empty()) {
            let (value, _) = at(terms, square, square);
            for lane in 0..LANES {
                sum[lane] += power * v_outer[lane] * value[lane];
            }
        }
        if let Some(log) = &self.log {
            let ratio: Lanes = std::array::from_fn(|lane| {
                let (rho, v) = (rho_square[lane].sqrt(), v_outer[lane]);
                if v > 0.0 { (v * v / (outer.xi + rho) + v) / rho } else { 0.0 }
            });
            let logarithm = ln_1p(ratio);
            for lane in 0..LANES {
                // At the centre the logarithm is infinite, and of all shapes but a cone its share is zero.
                sum[lane] += if log[lane] > 0.0 { log[lane] * logarithm[lane] } else { 0.0 };
            }
        }
        sum
    }
}

/// The root of what is positive, and zero of all else.
fn root_of(square: f64) -> f64 {
    (if square > 0.0 { square } else { 0.0 }).sqrt()
}
