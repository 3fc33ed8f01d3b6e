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
use crate::numerics::roots::Bracket;
use crate::profile::StressRadius;
use derivative::{Derivative, NOISE, Pace};
use interval::{EndBehaviour, KNOT_FLOOR, MAX_PLACE, Sample, StressInterval};
use settled::Known;

/// With more intervals than this between the knots of a table, each is sampled at its middle and its ends alone.
const SPARSE_ABOVE: usize = 100;

/// A root is known when its place is to this, relative to one more than it: the distance to the nearer end, to as much
/// of itself. The stress at the extremum is then off by the square of this, which is far below its rounding.
const RESOLUTION: f64 = 1e-12;
/// Samples that are taken at once.
const SAMPLES_AT_ONCE: usize = 4096;

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
        // The knots between kink `index` and the next.
        let between = |index: usize| {
            let to = pieces.get(index + 1).map_or(edge.square, |next| next.inner.square);
            let begins = knots.partition_point(|knot| knot.at.square <= from(index).square);
            begins..knots.partition_point(|knot| knot.at.square < to).max(begins)
        };
        // How the derivative begins at each kink and knot.
        let mut begin = Vec::new();
        for index in (0..pieces.len()).filter(|&index| known[index] != Known::Sign) {
            if from(index).square < edge.square {
                let within = between(index);
                let sparse = within.len() > SPARSE_ABOVE;
                begin.push(from(index));
                begin.extend(knots[within].iter().filter_map(|knot| beside(knot, sparse)));
            }
        }
        let mut signs = derivative.at(&begin).into_iter();
        let mut sign = || signs.next().unwrap_or(0.0);
        let mut search = Search::new(&derivative);
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
                search.steps.push(Step::Cross(from, -bend));
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
            let mut start = self.start(index, &from, knots, sign());
            let within = between(index);
            let (ends, first, sparse) = (within.end, within.start, within.len() > SPARSE_ABOVE);
            let within = within.map(|index| {
                let Kink { at, powers } = knots[index];
                let infinite = beside(&knots[index], sparse).map_or(0.0, |_| sign());
                if powers.singular() && infinite.is_infinite() {
                    // Where tau is infinite its derivative has one sign on the one side and the other on the other.
                    let next = if index + 1 < ends { knots[index + 1].at.square } else { to.square };
                    let end = EndBehaviour::Inverse((next - at.square).value());
                    (at, (end, -infinite), (end, infinite))
                } else {
                    (at, (EndBehaviour::Logarithm, infinite), (EndBehaviour::Logarithm, infinite))
                }
            });
            let mut inner = from;
            for (position, (outer, end, next)) in within.chain([(to, last, last)]).enumerate() {
                if !pace.goes_on() {
                    return None;
                }
                // Beyond the last knot, the sign that the flat or the bend inside it hides may be known.
                let outermost = first + position == ends;
                let known = if !outermost {
                    Known::Nothing
                } else if position == 0 {
                    known[index]
                } else {
                    settled.known(index, inner.radius)
                };
                let one_change = known == Known::OneChange;
                if known == Known::Sign || one_change && start.1 * end.1 > 0.0 {
                    search.steps.push(Step::Cross(inner, -bend));
                } else {
                    search.add(StressInterval { inner, outer, start, end, sparse, one_change });
                }
                (inner, start) = (outer, next);
            }
        }
        let mut places = search.places();
        if pace.stopped() {
            return None;
        }
        let singular: Vec<StressRadius> = self.indenter.singular().collect();
        let spike = |place: &StressRadius| {
            place.square >= edge.square || singular.iter().any(|spike| spike.square == place.square)
        };
        places.retain(|place| !spike(place) && place.radius > 0.0);
        Some(Extrema { places, sum: derivative.into_sum() })
    }

    /// How the derivative, which has this sign there, begins beyond kink `index` of the slip history, the centre for
    /// the first.
    fn start(&self, index: usize, from: &StressRadius, knots: &[Kink], sign: f64) -> (EndBehaviour, f64) {
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

/// Where the sign of the derivative at a knot is asked for, if it is: at the same distance on either side a logarithm
/// has the same value, so that one sample serves both.
fn beside(Kink { at, powers }: &Kink, sparse: bool) -> Option<StressRadius> {
    if powers.singular() {
        Some(*at)
    } else {
        sparse.then(|| StressRadius { square: at.square * (1.0 + KNOT_FLOOR), ..*at })
    }
}

/// A step of the search on its way from the centre outward.
enum Step {
    /// Crosses a radius beyond which the derivative has the sign of a value.
    Cross(StressRadius, f64),
    /// Goes through an interval, which is sampled at these places.
    Interval(StressInterval, Vec<f64>),
}

/// An extremum.
enum Turn {
    /// At the radius where two intervals meet.
    At(StressRadius),
    /// Within an interval.
    Within(StressInterval, Bracket),
}

/// The search: samples of many intervals are taken at once, and their roots found side by side.
struct Search<'s, 'c, 'p> {
    derivative: &'s Derivative<'c, 'p>,
    /// The steps that have not been gone.
    steps: Vec<Step>,
    /// The samples that they take.
    samples: usize,
    /// The sign that the derivative had last, zero before the first.
    sign: f64,
    turns: Vec<Turn>,
}

impl<'s, 'c, 'p> Search<'s, 'c, 'p> {
    fn new(derivative: &'s Derivative<'c, 'p>) -> Search<'s, 'c, 'p> {
        Search { derivative, steps: Vec::new(), samples: 0, sign: 0.0, turns: Vec::new() }
    }

    /// Adds an interval to the steps.
    fn add(&mut self, interval: StressInterval) {
        if interval.half() <= 0.0 {
            return;
        }
        let places = interval.places();
        self.samples += places.len();
        self.steps.push(Step::Interval(interval, places));
        if self.samples >= SAMPLES_AT_ONCE {
            self.go();
        }
    }

    /// Goes the steps that are waiting.
    fn go(&mut self) {
        let steps = std::mem::take(&mut self.steps);
        let mut radii = Vec::with_capacity(std::mem::take(&mut self.samples));
        for step in &steps {
            if let Step::Interval(interval, places) = step {
                radii.extend(places.iter().map(|&place| interval.at(place)));
            }
        }
        let mut values = self.derivative.at(&radii).into_iter();
        for step in steps {
            match step {
                Step::Cross(at, value) => self.cross(&at, value),
                Step::Interval(interval, places) => {
                    let sample = |(place, value): (f64, f64)| Sample { place, value: value * interval.weight(place) };
                    self.go_through(&interval, places.into_iter().zip(&mut values).map(sample));
                }
            }
        }
    }

    /// All extrema, at the end.
    fn places(mut self) -> Vec<StressRadius> {
        self.go();
        loop {
            let next = |turn| match turn {
                &mut Turn::Within(interval, ref mut bracket) => bracket.next().map(|place| (interval, place, bracket)),
                Turn::At(_) => None,
            };
            let open: Vec<(StressInterval, f64, &mut Bracket)> = self.turns.iter_mut().filter_map(next).collect();
            if open.is_empty() {
                break;
            }
            let radii: Vec<StressRadius> = open.iter().map(|(interval, place, _)| interval.at(*place)).collect();
            for ((interval, place, bracket), value) in open.into_iter().zip(self.derivative.at(&radii)) {
                bracket.take(place, value * interval.weight(place));
            }
        }
        let place = |turn| match turn {
            Turn::At(radius) => Some(radius),
            // An extremum this near to the centre cannot be distinguished from the centre.
            Turn::Within(interval, bracket) => (interval.inner.square.value() > 0.0
                || bracket.root() > 1.0 - MAX_PLACE)
                .then(|| interval.at(bracket.root())),
        };
        self.turns.into_iter().filter_map(place).collect()
    }

    /// Crosses a radius beyond which the derivative has the sign of `value`.
    fn cross(&mut self, at: &StressRadius, value: f64) {
        if self.sign * value.signum() < 0.0 {
            self.turns.push(Turn::At(*at));
        }
        self.sign = value.signum();
    }

    fn sample<const N: usize>(&self, interval: &StressInterval, places: [f64; N]) -> [Sample; N] {
        let values = self.derivative.at(&places.map(|place| interval.at(place)));
        std::array::from_fn(|lane| Sample { place: places[lane], value: values[lane] * interval.weight(places[lane]) })
    }

    /// Goes through an interval from its inner end to its outer, past samples of it.
    fn go_through(&mut self, interval: &StressInterval, between: impl Iterator<Item = Sample>) {
        let end = |(end, sign): (EndBehaviour, f64)| Sample { place: interval.limit(end), value: sign };
        let start = end(interval.start);
        let mut samples = vec![Sample { place: -start.place, ..start }];
        samples.extend(between.chain([end(interval.end)]));
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
            let [lower, upper] = self.sample(interval, [low.place + third, high.place - third]);
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

    /// Leaves a change of sign between two samples to be found. At an end infinitely far away the sign alone is known.
    fn find_root(&mut self, interval: &StressInterval, from: Sample, to: Sample) {
        let end = |sample: Sample, other: Sample| {
            let size = if sample.place.is_finite() { sample.value.abs() } else { other.value.abs() };
            (sample.place.clamp(-MAX_PLACE, MAX_PLACE), size.copysign(sample.value))
        };
        let ends = [end(from, to), end(to, from)];
        let nearest = if ends[0].0 * ends[1].0 > 0.0 { ends[0].0.abs().min(ends[1].0.abs()) } else { 0.0 };
        self.sign = -from.value.signum();
        self.turns.push(Turn::Within(*interval, Bracket::new(ends, RESOLUTION * (1.0 + nearest))));
    }
}
