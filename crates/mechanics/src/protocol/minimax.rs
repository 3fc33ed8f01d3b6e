//! The sequence of amplitudes whose largest remaining shear stress is smallest, by equal alternating extrema.
//!
//! After gross slip and N reversals the shear stress is an alternating sum of kernels between the radii where slip
//! began. At such a radius only the kinks beyond it count. So, for a largest stress E, the kinks follow one after the
//! other from the edge inwards: each where the stress first meets E with the other sign. E is then lowered until the
//! centre meets it too.

use super::alternating;
use crate::indenter::{Indenter, InwardSum};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::roots::{between, largest_of};
use crate::profile::{Point, Ring, StressRadius};

/// The largest number of evaluations of E, after it has been bracketed.
const MAX_EVALUATIONS: i32 = 80;
/// Steps of one search for a kink, and of its refinement, at the most.
const STEPS: usize = 400;
/// Radii at which the core is sampled where its stress need not fall outwards.
const CORE: usize = 32;
/// The part of the stretch about the largest of these to which the place of the maximum is narrowed down.
const BRACKET: f64 = 3e-5;
/// Relative tolerance of E.
const TOLERANCE: f64 = 1e-13;
/// Factor by which E is changed until it is bracketed.
const STRIDE: f64 = 1.25;
/// An E below this share of the first guess counts as zero.
const LEAST: f64 = 1e-4;

/// Where reversals begin to slip, the outermost first, and the smallest of the alternating extrema over the largest.
pub(super) struct EqualExtrema {
    pub(super) kinks: Vec<Point>,
    pub(super) ratio: f64,
    /// The largest of them, over G* m/pi.
    pub(super) limit: f64,
}

/// A contact whose stress counts from a cut-off radius outwards.
pub(super) struct Problem<'a> {
    pub(super) indenter: &'a Indenter,
    pub(super) edge: Point,
    pub(super) cutoff: f64,
    pub(super) reversals: usize,
    pub(super) keep_going: &'a dyn Fn() -> bool,
}

/// The kinks from the edge inward, and the rings between them.
pub(super) struct VirginStrokes<'a> {
    problem: &'a Problem<'a>,
    pub(super) kinks: Vec<Point>,
    /// The stress, over G* m/pi, up to the innermost kink, of the rings beyond it.
    pub(super) beyond: InwardSum<'a>,
    /// The stress of the core over E, less one; `None` if fewer kinks than allowed were enough.
    pub(super) excess: Option<f64>,
}

impl VirginStrokes<'_> {
    /// The innermost kink, the edge without any.
    pub(super) fn last(&self) -> &Point {
        self.kinks.last().unwrap_or(&self.problem.edge)
    }

    /// The sign of the ring inside it.
    fn sign(&self) -> f64 {
        alternating(self.kinks.len(), 1.0)
    }

    fn turn_at(&mut self, kink: Point) {
        self.beyond.add(Ring::between(kink, *self.last()), self.sign());
        self.kinks.push(kink);
    }

    /// Shear stress over G* m/pi, but for the sign of the last stroke, up to the innermost kink.
    fn shear(&self, at: &StressRadius) -> f64 {
        let profile = self.problem.indenter;
        let core = Ring::between(profile.point(DoubleDouble::ZERO), *self.last());
        self.beyond.at(at) + self.sign() * profile.kernel(at, &core)
    }
}

impl Problem<'_> {
    /// A sum over the rings between the edge, the kinks and `least`, with the signs of their strokes, the outermost
    /// being positive.
    pub(super) fn sum_down_to(&self, least: Point, kinks: &[Point], part: impl Fn(&Ring) -> f64) -> f64 {
        let mut outer = self.edge;
        let ring = |inner: &Point| Ring::between(*inner, std::mem::replace(&mut outer, *inner));
        kinks.iter().chain([&least]).map(ring).enumerate().map(|(index, ring)| alternating(index, part(&ring))).sum()
    }

    /// The shear stress over G* m/pi after kinks, but for the sign of the last stroke, of the rings beyond `least`.
    pub(super) fn shear_down_to(&self, least: Point, kinks: &[Point], at: &StressRadius) -> f64 {
        let beyond = kinks.partition_point(|kink| kink.radius >= at.radius);
        let least = kinks.get(beyond).unwrap_or(&least);
        self.sum_down_to(*least, &kinks[..beyond], |ring| self.indenter.kernel(at, ring))
    }

    /// How far strokes lead that slip down to kinks, scaled by m, if the last of them goes forwards.
    pub(super) fn way(&self, edge: DoubleDouble, kinks: &[Point]) -> f64 {
        let stroke = |(index, kink): (usize, &Point)| alternating(index, 2.0 * (edge - kink.level).value());
        kinks.iter().enumerate().map(stroke).sum()
    }

    /// No kinks yet.
    fn edge_alone(&self) -> VirginStrokes<'_> {
        let beyond = InwardSum::new(self.indenter, &self.edge, self.reversals);
        VirginStrokes { problem: self, kinks: Vec::with_capacity(self.reversals), beyond, excess: None }
    }

    /// The first level below the last kink where the stress meets `limit`, if there is one beyond the cut-off.
    fn next(&self, strokes: &VirginStrokes<'_>, limit: f64) -> Option<Point> {
        let (kinks, sign) = (strokes.kinks.as_slice(), strokes.sign());
        let top = strokes.last().level.value();
        let least = if self.cutoff > 0.0 { self.indenter.level(self.cutoff) } else { 0.0 };
        let missing = |level: f64| {
            let point = self.indenter.point(DoubleDouble::from(level));
            limit - sign * strokes.shear(&StressRadius::of_point(&point))
        };
        // Steps of a fraction of the last spacing, and ever longer ones: a stress that turns back is not stepped over.
        let before = match kinks {
            [.., beyond, last] => (beyond.level - last.level).value(),
            [last] => (self.edge.level - last.level).value(),
            [] => top / (64.0 * (self.reversals * self.reversals) as f64),
        };
        let mut step = (0.4 * before).max(4.0 * f64::EPSILON * top);
        let (mut high, mut at_high) = (top, limit);
        let (mut low, mut at_low) = (high, at_high);
        for _ in 0..STEPS {
            if high <= least {
                return None;
            }
            low = (high - step).max(least);
            at_low = missing(low);
            if at_low <= 0.0 {
                break;
            }
            (high, at_high) = (low, at_low);
            step *= 1.25;
        }
        if at_low > 0.0 || low <= 0.0 {
            return None;
        }
        // A difference below the rounding of the stress counts as zero.
        let rounded = |level| Some(missing(level)).filter(|value| value.abs() > 1e-15 * limit).unwrap_or(0.0);
        let level = between([(high, at_high), (low, at_low)], 2.0 * f64::EPSILON * high, rounded);
        Some(self.indenter.point(DoubleDouble::from(level)))
    }

    /// The largest stress of the core, with the sign that the next kink would stop it at.
    fn core(&self, strokes: &VirginStrokes<'_>) -> f64 {
        let sign = strokes.sign();
        let width = strokes.last().radius - self.cutoff;
        let value = |part: f64| sign * strokes.shear(&StressRadius::new(self.cutoff + width * part));
        if self.indenter.falls(0.0, self.edge.radius).least > 0.0 {
            return value(0.0);
        }
        let parts: Vec<f64> = (0..=CORE).map(|index| index as f64 / CORE as f64).collect();
        largest_of(&parts, 1, BRACKET, value).1
    }

    /// The kinks for one E, and a share of it for the outermost extremum; `None` if `keep_going` returned false.
    pub(super) fn march(&self, limit: f64, share: f64) -> Option<VirginStrokes<'_>> {
        let mut strokes = self.edge_alone();
        while strokes.kinks.len() < self.reversals {
            if !(self.keep_going)() {
                return None;
            }
            match self.next(&strokes, if strokes.kinks.is_empty() { share * limit } else { limit }) {
                Some(kink) => strokes.turn_at(kink),
                None => return Some(strokes),
            }
        }
        strokes.excess = Some(self.core(&strokes) / limit - 1.0);
        Some(strokes)
    }

    /// The smallest E, and its kinks; `None` if `keep_going` returned false, or there is no such E.
    pub(super) fn solve(&self) -> Option<EqualExtrema> {
        let middle = StressRadius::new(0.5 * (self.cutoff + self.edge.radius));
        let guess = self.edge_alone().shear(&middle) / (self.reversals as f64).sqrt();
        let (limit, strokes) = smallest(guess, TOLERANCE, None, |limit| {
            let strokes = self.march(limit, 1.0)?;
            // Where fewer kinks are enough, the core has no stress.
            Some((strokes.excess.unwrap_or(-1.0), Some(strokes)))
        })?;
        let ratio = (self.core(&strokes) / limit).clamp(0.0, 1.0);
        Some(EqualExtrema { kinks: strokes.kinks, ratio, limit })
    }
}

/// The smallest largest stress E that strokes keep to, and these strokes. `march` gives the strokes for an E, if there
/// are any, and by how much their stress exceeds it, over it: below zero where fewer strokes are enough. `None` if
/// it was stopped, or no E fits.
///
/// Too large an E can be as wrong as too small a one if strokes are to end somewhere: with a `pace`, a factor, E is
/// sought to both sides of the guess, in steps of that.
pub(super) fn smallest<T>(
    guess: f64,
    tolerance: f64,
    pace: Option<f64>,
    mut march: impl FnMut(f64) -> Option<(f64, Option<T>)>,
) -> Option<(f64, T)> {
    if !(guess > 0.0 && guess.is_finite()) {
        return None;
    }
    let (mut best, mut stopped) = (None::<(f64, T)>, false);
    let mut excess = |limit: f64| {
        let Some((excess, strokes)) = (if stopped { None } else { march(limit) }) else {
            stopped = true;
            return 0.0;
        };
        if excess <= 0.0 && best.as_ref().is_none_or(|(least, _)| limit < *least) {
            best = strokes.map(|strokes| (limit, strokes)).or(best.take());
        }
        // The one that fits is kept, so that a little too much stress goes on.
        if (-tolerance..=0.0).contains(&excess) { 0.0 } else { excess }
    };
    let start = (guess, excess(guess));
    let (mut low, mut high) = (start, start);
    let signs: &[i32] = if pace.is_some() { &[1, -1] } else { &[1] };
    for power in (1..=MAX_EVALUATIONS).flat_map(|power| signs.iter().map(move |sign| sign * power)) {
        if high.1 <= 0.0 {
            break;
        }
        let limit = guess * pace.unwrap_or(STRIDE).powi(power);
        let tried = (limit, excess(limit));
        if tried.1 <= 0.0 {
            high = tried;
        } else if power > 0 {
            low = tried;
        }
    }
    if high.0 <= low.0 {
        low = high;
    }
    for _ in 0..MAX_EVALUATIONS {
        if low.1 > 0.0 || low.0 < LEAST * guess {
            break;
        }
        high = low;
        low = (high.0 / STRIDE, excess(high.0 / STRIDE));
    }
    if high.1 > 0.0 {
        return None;
    }
    between([low, high], tolerance * high.0, &mut excess);
    Some(best?).filter(|_| !stopped)
}
