//! An interval of radii in which the shear stress is smooth, and where its derivative is sampled there.

use crate::numerics::double_double::DoubleDouble;
use crate::profile::StressRadius;

/// Towards a kink of the slip history each distance is smaller by this factor, as a logarithm: beneath a thin ring the
/// derivative has structure of every size from the whole interval down to the ring's depth.
const KINK_STEP: f64 = 0.511;
/// The same towards a rim, whose inverse of the distance outweighs the kinks beyond sooner than a root does.
const RIM_STEP: f64 = 1.4;
/// Sampling ends this far below the depth of the ring beyond, where the kink or rim itself outweighs all else.
const KINK_FLOOR: f64 = 1e-3;
/// The same limit where the profile makes the derivative infinite: at this part of the square of the radius, half that
/// of the radius.
pub(super) const KNOT_FLOOR: f64 = 1e-14;
/// It is no further from the end than this, however thin the interval.
const LEAST_FLOOR: f64 = 14.0;
/// Beyond this place a distance is below the round-off of twice the digits.
pub(super) const MAX_PLACE: f64 = 72.0;
/// Towards a knot a logarithm is followed by places that grow by this factor.
const KNOT_STRIDE: f64 = 2.0;

/// How the derivative behaves at the end of an interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum EndBehaviour {
    /// It is smooth, or ends there.
    Smooth,
    /// It is infinite as the inverse root of the distance; the difference of the squares of the ring beyond, m^2.
    InverseRoot(f64),
    /// It is infinite as the logarithm of the distance, or a power nearly so.
    Logarithm,
    /// It is infinite as the inverse of the distance; the distance of the next kink beyond the end, in squares, m^2, or
    /// zero.
    Inverse(f64),
}

/// An interval of radii in which the shear stress is smooth. A *place* q in it runs from minus infinity at the inner
/// end to infinity at the outer: e^-|q| is the distance to the nearer end, in halves of the difference of their
/// squares.
#[derive(Clone, Copy)]
pub(super) struct StressInterval {
    pub(super) inner: StressRadius,
    pub(super) outer: StressRadius,
    /// How it begins, and the sign of the derivative there, zero if unknown.
    pub(super) start: (EndBehaviour, f64),
    /// How it ends, and the sign of the derivative there, zero if unknown.
    pub(super) end: (EndBehaviour, f64),
    /// Smooth, one of many intervals: it gets a few samples only.
    pub(super) sparse: bool,
    /// The derivative changes its sign once at most, to that of the end.
    pub(super) one_change: bool,
}

/// The derivative at a place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample {
    pub(super) place: f64,
    pub(super) value: f64,
}

impl StressInterval {
    pub(super) fn half(&self) -> f64 {
        0.5 * (self.outer.square - self.inner.square).value()
    }

    pub(super) fn at(&self, place: f64) -> StressRadius {
        let distance = DoubleDouble::from(self.half() * (-place.abs()).exp());
        let square = if place > 0.0 { self.outer.square - distance } else { self.inner.square + distance };
        StressRadius { radius: square.value().max(0.0).sqrt(), square }
    }

    /// Scales samples for comparison: near the end the derivative grows with the inverse of this.
    pub(super) fn weight(&self, place: f64) -> f64 {
        let end = if place > 0.0 { self.end.0 } else { self.start.0 };
        match end {
            EndBehaviour::Smooth | EndBehaviour::Logarithm => 1.0,
            EndBehaviour::InverseRoot(_) => (-0.5 * place.abs()).exp(),
            EndBehaviour::Inverse(_) => (-place.abs()).exp(),
        }
    }

    /// The place nearest to an end that is sampled where the profile makes the derivative infinite, without the sign.
    fn floor(&self) -> f64 {
        (self.half() / (KNOT_FLOOR * self.outer.square.value())).ln().clamp(LEAST_FLOOR, MAX_PLACE)
    }

    /// The place up to which the sign at an end is taken to hold: about a knot as far as the floor.
    pub(super) fn limit(&self, end: EndBehaviour) -> f64 {
        if end == EndBehaviour::Logarithm { self.floor() } else { f64::INFINITY }
    }

    /// The places at which it is sampled, from the inner end to the outer.
    pub(super) fn places(&self) -> Vec<f64> {
        let inward = self.towards(self.start).into_iter().rev().map(|place| -place);
        inward.chain([0.0]).chain(self.towards(self.end)).collect()
    }

    /// The places from the middle towards an end.
    fn towards(&self, (end, sign): (EndBehaviour, f64)) -> Vec<f64> {
        let (half, floor) = (self.half(), self.floor());
        let by_steps = |step: f64, last: f64| {
            let steps = (1..).map(move |index| step * f64::from(index));
            let mut places: Vec<f64> = steps.take_while(|&place| place < last).collect();
            if last > 0.0 {
                places.push(last);
            }
            places
        };
        if self.one_change {
            // As many as are found side by side.
            let unknown = end == EndBehaviour::Logarithm && sign.abs() <= 0.0;
            return [3.0].into_iter().chain(unknown.then_some(floor.max(4.0))).collect();
        }
        match end {
            EndBehaviour::Smooth => vec![0.6, 1.6, 4.0],
            EndBehaviour::InverseRoot(beyond) => {
                let least = if beyond > 0.0 { KINK_FLOOR * beyond.min(2.0 * half) } else { KINK_FLOOR * half };
                by_steps(KINK_STEP, (half / least).ln().min(0.5 * MAX_PLACE))
            }
            EndBehaviour::Logarithm if self.sparse && sign.abs() > 0.0 => Vec::new(),
            EndBehaviour::Logarithm if self.sparse => vec![floor],
            EndBehaviour::Logarithm => {
                let strides = std::iter::successors(Some(0.25), |place| Some(place * KNOT_STRIDE));
                strides.take_while(|&place| place < floor).chain([floor]).collect()
            }
            EndBehaviour::Inverse(beyond) => by_steps(RIM_STEP, (half / (KINK_FLOOR * beyond)).ln().clamp(0.0, floor)),
        }
    }
}
