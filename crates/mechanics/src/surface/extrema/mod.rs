//! The extrema of the shear stress.
//!
//! Just inside a kink of the slip history, where the slope changes by gamma, tau falls off like -gamma sqrt(x - r), so
//! that its derivative is infinite there with a known sign; where f'' of the profile jumps it is log-infinite with one
//! sign on both sides, where f' jumps tau itself is; everywhere else tau is smooth. So the derivative is sampled
//! between these radii, ever closer to those it is infinite at, and an extremum is where its sign changes: within a
//! interval a root, between two the radius they meet at. Signs alternate from one to the next, so none is found twice.
//! That none is missed is proven where [`settled`] knows the sign, or that it changes once; elsewhere it rests on the
//! samples, and on the dense searches that they have been held against.

mod derivative;
mod interval;
mod settled;

use crate::cells::shape::Kink;
use crate::contact::Contact;
use crate::indenter::RingSum;
use crate::numerics::roots::between;
use crate::profile::StressRadius;
use derivative::{Derivative, NOISE, Pace};
use interval::{EndBehaviour, KNOT_FLOOR, MAX_PLACE, Sample, StressInterval};
use settled::Known;

/// With more intervals than this between the knots of a table, each is sampled at its middle and its ends alone.
const SPARSE_ABOVE: usize = 100;

/// A root is known when its place is to this, relative to one more than it: the distance to the nearer end, to as much
/// of itself. The stress at the extremum is then off by the square of this, which is far below its rounding.
const RESOLUTION: f64 = 1e-12;
/// The extrema of the shear stress.
pub(crate) struct Extrema<'a> {
    /// Their radii, from the centre outward.
    pub(crate) places: Vec<StressRadius>,
    /// The sum that gave the derivative, if it was asked for.
    pub(crate) sum: Option<RingSum<'a>>,
}

impl Contact {
    /// All extrema of the shear stress for 0 < r < a, from the centre outward; `None` if `keep_going` returned false.
    pub(crate) fn extrema(&self, keep_going: impl Fn() -> bool) -> Option<Extrema<'_>> {
        let edge = StressRadius::of_point(self.history.edge());
        let bends = self.bends();
        let pieces = self.history.pieces();
        // From kink `index` (the centre for the first) outward.
        let from = |index: usize| {
            if index == 0 { StressRadius::new(0.0) } else { StressRadius::of_point(&pieces[index].inner) }
        };
        let settled = self.settled();
        let known: Vec<Known> = (0..pieces.len()).map(|index| settled.known(index, from(index).radius)).collect();
        // A long table has many, which no settled interval needs.
        let searched = known.iter().any(|known| *known != Known::Sign);
        let knots = self.indenter.kinks();
        let knots = &knots[..knots.partition_point(|knot| searched && knot.at.square < edge.square)];
        let pace = Pace::new(&keep_going);
        let derivative = Derivative::new(self, &pace);
        let mut search = Search { derivative: &derivative, sign: 0.0, places: Vec::new() };
        for (index, &bend) in bends.iter().enumerate() {
            if !pace.goes_on() {
                return None;
            }
            // Out to kink `index + 1`, which bends by `bend`.
            let from = from(index);
            if from.square >= edge.square {
                // The rest is at a vertical edge.
                break;
            }
            if known[index] == Known::Sign {
                search.cross(&from, -bend);
                continue;
            }
            let outer = pieces.get(index + 1).map_or(*self.history.edge(), |next| next.inner);
            let to = StressRadius::of_point(&outer);
            let beyond = pieces.get(index + 2).map_or(*self.history.edge(), |next| next.inner);
            let last = if to.square >= edge.square && self.indenter.is_upright(self.history.edge()) {
                (EndBehaviour::Logarithm, 0.0)
            } else {
                (EndBehaviour::InverseRoot((beyond.square - outer.square).value()), -bend)
            };
            let begins = knots.partition_point(|knot| knot.at.square <= from.square);
            let ends = knots.partition_point(|knot| knot.at.square < to.square).max(begins);
            let sparse = ends - begins > SPARSE_ABOVE;
            let within = (begins..ends).map(|index| {
                let Kink { at, powers } = knots[index];
                let rim = powers.singular();
                // At the same distance on either side a logarithm has the same value: one sample serves both.
                let beside = at.square * (1.0 + KNOT_FLOOR);
                let infinite = if rim {
                    derivative.at(&at)
                } else if sparse {
                    derivative.at(&StressRadius { square: beside, ..at })
                } else {
                    0.0
                };
                if rim && infinite.is_infinite() {
                    // Where tau is infinite its derivative has one sign on the one side and the other on the other.
                    let next = if index + 1 < ends { knots[index + 1].at.square } else { to.square };
                    let end = EndBehaviour::Inverse((next - at.square).value());
                    (at, (end, -infinite), (end, infinite))
                } else {
                    (at, (EndBehaviour::Logarithm, infinite), (EndBehaviour::Logarithm, infinite))
                }
            });
            let mut start = self.start(index, &from, knots, &derivative);
            let mut inner = from;
            for (position, (outer, end, next)) in within.chain([(to, last, last)]).enumerate() {
                if !pace.goes_on() {
                    return None;
                }
                // Beyond the last knot, the sign that the flat or the bend inside it hides may be known.
                let outermost = begins + position == ends;
                let known = if !outermost {
                    Known::Nothing
                } else if position == 0 {
                    known[index]
                } else {
                    settled.known(index, inner.radius)
                };
                let one_change = known == Known::OneChange;
                if known == Known::Sign || one_change && start.1 * end.1 > 0.0 {
                    search.cross(&inner, -bend);
                } else {
                    search.search_interval(&StressInterval { inner, outer, start, end, sparse, one_change });
                }
                (inner, start) = (outer, next);
            }
        }
        if pace.stopped() {
            return None;
        }
        let Search { mut places, .. } = search;
        let singular: Vec<StressRadius> = self.indenter.singular().collect();
        let spike = |place: &StressRadius| {
            place.square >= edge.square || singular.iter().any(|spike| spike.square == place.square)
        };
        places.retain(|place| !spike(place) && place.radius > 0.0);
        Some(Extrema { places, sum: derivative.into_sum() })
    }

    /// How the derivative begins beyond kink `index` of the slip history, the centre for the first.
    fn start(
        &self,
        index: usize,
        from: &StressRadius,
        knots: &[Kink],
        derivative: &Derivative<'_, '_>,
    ) -> (EndBehaviour, f64) {
        let sign = derivative.at(from);
        let end = if index == 0 {
            let slips = self.history.pieces()[0].line.slope.value().abs() > 0.0;
            if !slips || self.indenter.smooth_centre() { EndBehaviour::Smooth } else { EndBehaviour::Inverse(0.0) }
        } else if knots.iter().any(|knot| knot.at.square == from.square) {
            return (EndBehaviour::Logarithm, 0.0);
        } else {
            EndBehaviour::Smooth
        };
        (end, sign)
    }

    /// Change of slope at each kink, from the first beyond the centre to the edge.
    fn bends(&self) -> Vec<f64> {
        let slope = |index: usize| self.history.pieces().get(index).map_or(0.0, |piece| piece.line.slope.value());
        (0..self.history.pieces().len()).map(|index| slope(index + 1) - slope(index)).collect()
    }
}

/// The search on its way from the centre outward.
struct Search<'s, 'c, 'p> {
    derivative: &'s Derivative<'c, 'p>,
    /// The sign that the derivative had last, zero before the first.
    sign: f64,
    places: Vec<StressRadius>,
}

impl Search<'_, '_, '_> {
    /// Crosses a radius beyond which the derivative has the sign of `value`.
    fn cross(&mut self, at: &StressRadius, value: f64) {
        if self.sign * value.signum() < 0.0 {
            self.places.push(*at);
        }
        self.sign = value.signum();
    }

    fn sample(&self, interval: &StressInterval, place: f64) -> Sample {
        Sample { place, value: self.derivative.at(&interval.at(place)) * interval.weight(place) }
    }

    /// Goes through an interval from its inner end to its outer.
    fn search_interval(&mut self, interval: &StressInterval) {
        if interval.half() <= 0.0 {
            return;
        }
        let inward = interval.places(interval.start).into_iter().rev().map(|place| -place);
        let outward = interval.places(interval.end);
        let mut samples = vec![Sample { place: -interval.limit(interval.start.0), value: interval.start.1 }];
        let places: Vec<f64> = inward.chain([0.0]).chain(outward).collect();
        let radii: Vec<StressRadius> = places.iter().map(|&place| interval.at(place)).collect();
        let values = self.derivative.at_all(&radii);
        let sample = |(place, value): (f64, f64)| Sample { place, value: value * interval.weight(place) };
        samples.extend(places.into_iter().zip(values).map(sample));
        samples.push(Sample { place: interval.limit(interval.end.0), value: interval.end.1 });
        samples.retain(|sample| sample.value.abs() > 0.0);
        let Some(first) = samples.first() else { return };
        self.cross(&interval.inner, first.value);
        for (index, pair) in samples.windows(2).enumerate() {
            let (before, after) = (pair[0], pair[1]);
            if before.value * after.value < 0.0 {
                self.find_root(interval, before, after);
            } else if !interval.one_change
                && let Some(&next) = samples.get(index + 2)
                && after.value * next.value > 0.0
                && before.place.is_finite()
                && next.place.is_finite()
                && after.value.abs() < before.value.abs().min(next.value.abs())
                && let Some(dip) = self.dip(interval, before, next)
            {
                // Two roots between samples of one sign.
                self.find_root(interval, before, dip);
                self.find_root(interval, dip, next);
            }
        }
    }

    /// Where the derivative dips through zero between two samples of one sign, if it does.
    fn dip(&self, interval: &StressInterval, mut low: Sample, mut high: Sample) -> Option<Sample> {
        let sign = low.value.signum();
        for _ in 0..48 {
            let third = (high.place - low.place) / 3.0;
            let (lower, upper) = (self.sample(interval, low.place + third), self.sample(interval, high.place - third));
            if let Some(&through) = [lower, upper].iter().find(|sample| sample.value * sign < 0.0) {
                return Some(through);
            }
            let [a, b, c, d] = [low, lower, upper, high].map(|sample| sample.value.abs());
            // A curve that is bent upward stays above the lines drawn on from either side, which meet at this value.
            let (fall, rise) = (a - b, d - c);
            let least = if fall + rise > 0.0 { (b * rise + c * fall - fall * rise) / (fall + rise) } else { b.min(c) };
            if least > 0.0 {
                return None;
            }
            if b < c { high = upper } else { low = lower }
        }
        None
    }

    /// Finds the change of sign between two samples. At an end that is infinitely far the sign alone is known.
    fn find_root(&mut self, interval: &StressInterval, from: Sample, to: Sample) {
        let end = |sample: Sample, other: Sample| {
            let size = if sample.place.is_finite() { sample.value.abs() } else { other.value.abs() };
            (sample.place.clamp(-MAX_PLACE, MAX_PLACE), size.copysign(sample.value))
        };
        let ends = [end(from, to), end(to, from)];
        let nearest = if ends[0].0 * ends[1].0 > 0.0 { ends[0].0.abs().min(ends[1].0.abs()) } else { 0.0 };
        let root = between(ends, RESOLUTION * (1.0 + nearest), |place| self.sample(interval, place).value);
        self.sign = -from.value.signum();
        // An extremum this near to the centre cannot be distinguished from the centre.
        if interval.inner.square.value() > 0.0 || root > 1.0 - MAX_PLACE {
            self.places.push(interval.at(root));
        }
    }
}
