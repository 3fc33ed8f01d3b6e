//! The stress of a place over a cycle, as a curve: polynomials between the instants that matter, refined where it
//! takes more.
//!
//! At the surface a stress has the edge of the contact or of the slip pass like a root of the time, in the depth z like
//! a root of time + i z. So the parts between such instants are graded towards both ends: over an angle t with part =
//! from + (to - from) (1 - cos t)/2 those roots are smooth. There polynomials through Chebyshev points converge fast;
//! each is compared with the one through half of its points, and a stretch of t is halved where that does not help.

use std::cell::Cell;
use std::f64::consts::PI;

use crate::numerics::chebyshev::{NESTED_STEPS, nested_midpoints, nested_point, nested_products, nested_weights};
use crate::numerics::roots::largest;
use crate::range::error::Error;
use crate::subsurface::Stress;

/// Components xx, yy, zz, xy, yz, xz of the stress, Pa, then pressure, Pa, shear stress, Pa, and slip, m, of the
/// surface.
pub(super) type StressSample = [f64; 9];

/// The largest number of instants of a move at which a place is looked at.
pub const MAX_INSTANTS: usize = 4096;
/// So many of them are not exceeded by choice: the rest of the move then takes the fewest that it can.
const ENOUGH: usize = 1024;

/// Halvings of a stretch of t.
const DEPTH: u32 = 26;
/// Where a finer polynomial errs by more than this part of a coarser one, the stretch is halved.
const SLOW: f64 = 0.3;
/// The least part of the error of a coarser polynomial that a finer one is taken to leave.
const GAIN: f64 = 0.03;
/// The part of the stretch about a peak to which its place is narrowed down.
const BRACKET: f64 = 1e-9;

/// An instant of a cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instant {
    /// The index of the move.
    pub step: usize,
    /// The part of it that has been made, above 0 and up to 1.
    pub part: f64,
}

/// A stretch of a move over which a place is in or out of the contact, and its effect is smooth.
#[derive(Clone, Copy, Debug)]
pub(super) struct CurveStretch {
    pub(super) step: usize,
    pub(super) from: f64,
    pub(super) to: f64,
}

/// How far the samples may be off: stresses, Pa, and slip, m.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Allowance {
    pub(super) stress: f64,
    pub(super) slip: f64,
}

/// A polynomial over a part of a stretch.
#[derive(Clone, Debug)]
pub(super) struct Arc {
    stretch: CurveStretch,
    /// The angles t at its ends.
    angles: [f64; 2],
    /// The samples at the points, and at the points half a step between them.
    samples: Vec<StressSample>,
    between: Vec<StressSample>,
    /// The friction work per area over the friction, J/m^2, and the same by a coarser polynomial.
    work: [f64; 2],
    /// Whether the place is within the contact.
    pub(super) touched: bool,
}

/// The curve of a place, or a list of samples.
#[derive(Clone, Debug, Default)]
pub(super) struct StressCurve {
    arcs: Vec<Arc>,
    list: Vec<(Instant, StressSample)>,
    /// Estimated errors.
    pub(super) error: Allowance,
}

/// The largest value of a function of the samples of a curve.
#[derive(Clone, Copy, Debug)]
pub(super) struct CurvePeak {
    pub(super) value: f64,
    pub(super) sample: StressSample,
    pub(super) at: Instant,
}

impl CurveStretch {
    /// The part of the move at an angle.
    fn part(&self, angle: f64) -> f64 {
        let (near, far) = ((0.5 * angle).sin().powi(2), (0.5 * angle).cos().powi(2));
        let length = self.to - self.from;
        if near < far { self.from + length * near } else { self.to - length * far }
    }
}

/// The stress of a sample.
pub(super) fn stress(sample: &StressSample) -> Stress {
    let [xx, yy, zz, xy, yz, xz, ..] = *sample;
    Stress { xx, yy, zz, xy, yz, xz }
}

/// The distance of two samples: of the stresses, by their norm, and of the slip.
fn distance(one: &StressSample, other: &StressSample) -> Allowance {
    let off: StressSample = std::array::from_fn(|i| one[i] - other[i]);
    Allowance { stress: stress(&off).norm().max(off[6].abs()).max(off[7].abs()), slip: off[8].abs() }
}

fn combined(weights: &[f64], samples: &[StressSample]) -> StressSample {
    let mut sum = [0.0; 9];
    for (weight, sample) in weights.iter().zip(samples) {
        for (part, value) in sum.iter_mut().zip(sample) {
            *part += weight * value;
        }
    }
    sum
}

impl Allowance {
    fn most(self, other: Allowance) -> Allowance {
        Allowance { stress: self.stress.max(other.stress), slip: self.slip.max(other.slip) }
    }

    fn times(self, factor: f64) -> Allowance {
        Allowance { stress: factor * self.stress, slip: factor * self.slip }
    }

    /// The larger of both over the allowance.
    fn over(self, allowed: Allowance) -> f64 {
        let share = |off: f64, most: f64| if off > 0.0 { off / most } else { 0.0 };
        share(self.stress, allowed.stress).max(share(self.slip, allowed.slip))
    }
}

impl StressCurve {
    /// The stresses at the ends of some moves.
    pub(super) fn of_list(path: &[Stress]) -> StressCurve {
        let sample = |(step, stress): (usize, &Stress)| {
            let [xx, yy, zz, xy, yz, xz] = stress.components();
            (Instant { step, part: 1.0 }, [xx, yy, zz, xy, yz, xz, 0.0, 0.0, 0.0])
        };
        StressCurve { list: path.iter().enumerate().map(sample).collect(), ..StressCurve::default() }
    }

    /// The curve over some stretches within an allowance, from what `sample` says of a move, a part of it and whether
    /// the instant belongs to many places: the components, and whether the place is in contact. `None` where one is
    /// infinite.
    pub(super) fn follow(
        stretches: &[(CurveStretch, bool)],
        allowed: Allowance,
        mut sample: impl FnMut(usize, f64, bool) -> Result<(StressSample, bool), Error>,
    ) -> Result<Option<StressCurve>, Error> {
        let mut curve = StressCurve::default();
        let (mut step, taken) = (0, Cell::new(0));
        for (stretch, shared) in stretches {
            if stretch.step != step {
                step = stretch.step;
                taken.set(0);
            }
            let mut parts = vec![([0.0, PI], 0)];
            while let Some((angles, depth)) = parts.pop() {
                let mut at = |n: usize, j: usize| {
                    let angle = 0.5 * ((angles[0] + angles[1]) + (angles[1] - angles[0]) * nested_point(n, j));
                    taken.set(taken.get() + 1);
                    sample(stretch.step, stretch.part(angle), *shared)
                };
                let mut samples = Vec::with_capacity(NESTED_STEPS[1] + 1);
                let mut touched = false;
                for j in 0..=NESTED_STEPS[0] {
                    let (found, contact) = at(NESTED_STEPS[0], j)?;
                    // Its ends may be at the edge.
                    touched |= 2 * j == NESTED_STEPS[0] && contact;
                    samples.push(found);
                }
                let (mut level, mut before) = (0, None::<f64>);
                let (off, good) = loop {
                    let (n, finer) = (NESTED_STEPS[level], NESTED_STEPS[level + 1]);
                    let mut off = Allowance::default();
                    let mut all = Vec::with_capacity(finer + 1);
                    for (j, row) in nested_midpoints(level).iter().enumerate() {
                        let (found, _) = at(finer, 2 * j + 1)?;
                        off = off.most(distance(&found, &combined(row, &samples)));
                        all.extend([samples[j], found]);
                    }
                    all.push(samples[n]);
                    if !all.iter().flatten().all(|part| part.is_finite()) {
                        return Ok(None);
                    }
                    samples = all;
                    level += 1;
                    let share = off.over(allowed);
                    let gain = before.map_or(1.0, |before| share / before);
                    // As much as a further step would bring.
                    let left = off.times(if level > 1 { gain.clamp(GAIN, 1.0) } else { 1.0 });
                    if share <= 1.0 || left.over(allowed) <= 0.3 {
                        break (left, true);
                    }
                    if level + 1 == NESTED_STEPS.len() || (level > 1 && gain > SLOW) || taken.get() >= ENOUGH {
                        break (off, false);
                    }
                    before = Some(share);
                };
                let last = depth >= DEPTH || taken.get() >= ENOUGH;
                if good || last {
                    curve.error = curve.error.most(off);
                    curve.arcs.push(Arc::new(*stretch, angles, samples, touched, level));
                } else {
                    let middle = 0.5 * (angles[0] + angles[1]);
                    parts.extend([([middle, angles[1]], depth + 1), ([angles[0], middle], depth + 1)]);
                }
            }
        }
        Ok(Some(curve))
    }

    /// Instants of the move that took most.
    pub(super) fn instants(&self) -> usize {
        let of_move = |step: usize| -> usize {
            self.arcs.iter().filter(|arc| arc.stretch.step == step).map(|arc| arc.samples.len() - 1).sum()
        };
        let last = self.arcs.last().map_or(0, |arc| arc.stretch.step);
        (0..=last).map(of_move).max().unwrap_or(1).clamp(1, MAX_INSTANTS)
    }

    /// All samples that were taken, with their instants.
    pub(super) fn samples(&self) -> impl DoubleEndedIterator<Item = (Instant, &StressSample)> {
        let of_arcs = self.arcs.iter().flat_map(|arc| {
            let n = arc.samples.len() - 1;
            arc.samples.iter().enumerate().rev().map(move |(j, sample)| (arc.instant(nested_point(n, j)), sample))
        });
        self.list.iter().map(|(at, sample)| (*at, sample)).chain(of_arcs)
    }

    /// Friction work per area over the friction, J/m^2, and its estimated error.
    pub(super) fn work(&self) -> [f64; 2] {
        let touched = || self.arcs.iter().filter(|arc| arc.touched);
        [touched().map(|arc| arc.work[0]).sum(), touched().map(|arc| (arc.work[0] - arc.work[1]).abs()).sum()]
    }

    /// Where a function of the samples is largest, among the arcs that `wanted` names; `None` if there are none.
    pub(super) fn peak(
        &self,
        wanted: impl Fn(&Arc) -> bool,
        mut value: impl FnMut(&StressSample) -> f64,
    ) -> Option<CurvePeak> {
        let mut best: Option<CurvePeak> = None;
        for (at, sample) in &self.list {
            let here = value(sample);
            if best.is_none_or(|best| here > best.value) {
                best = Some(CurvePeak { value: here, sample: *sample, at: *at });
            }
        }
        let mut brackets: Vec<(&Arc, usize, f64)> = Vec::new();
        for arc in self.arcs.iter().filter(|arc| wanted(arc)) {
            let count = arc.samples.len() + arc.between.len();
            let values: Vec<f64> = (0..count).map(|index| value(arc.dense(index))).collect();
            // Each peak between the points, as the farthest ones from a centre may lie on one arc and be alike.
            for (index, here) in values.iter().enumerate() {
                if best.is_none_or(|best| *here > best.value) {
                    let at = arc.instant(nested_point(count - 1, index));
                    best = Some(CurvePeak { value: *here, sample: *arc.dense(index), at });
                }
                let sides = [index.saturating_sub(1), (index + 1).min(count - 1)].map(|side| here - values[side]);
                if sides[0] >= 0.0 && sides[1] >= 0.0 {
                    brackets.push((arc, index, here + sides[0].max(sides[1])));
                }
            }
        }
        for (arc, most, reach) in brackets {
            if best.is_some_and(|best| reach > best.value) {
                let peak = arc.peak_beside(most, &mut value);
                if best.is_none_or(|best| peak.value > best.value) {
                    best = Some(peak);
                }
            }
        }
        best
    }
}

impl Arc {
    fn new(stretch: CurveStretch, angles: [f64; 2], samples: Vec<StressSample>, touched: bool, level: usize) -> Arc {
        let between = nested_midpoints(level).iter().map(|row| combined(row, &samples)).collect();
        let every = |n: usize| -> f64 {
            let level = NESTED_STEPS.iter().position(|steps| *steps == n).unwrap_or(0);
            let stride = (samples.len() - 1) / n;
            let works = nested_products(level).iter().enumerate();
            let of = |(i, row): (usize, &Vec<f64>)| -> f64 {
                let gained: f64 = row.iter().enumerate().map(|(j, weight)| weight * samples[j * stride][8]).sum();
                samples[i * stride][6] * gained
            };
            works.map(of).sum::<f64>().abs()
        };
        let n = samples.len() - 1;
        let work = if touched { [every(n), every(n / 2)] } else { [0.0; 2] };
        Arc { stretch, angles, samples, between, work, touched }
    }

    /// The samples and those between them in turn.
    fn dense(&self, index: usize) -> &StressSample {
        if index.is_multiple_of(2) { &self.samples[index / 2] } else { &self.between[index / 2] }
    }

    /// The instant of a point of the interval from -1 to 1.
    fn instant(&self, x: f64) -> Instant {
        let [first, last] = self.angles;
        Instant { step: self.stretch.step, part: self.stretch.part(0.5 * ((first + last) + (last - first) * x)) }
    }

    /// The peak next to one of the dense samples, by the golden section.
    fn peak_beside(&self, index: usize, value: &mut impl FnMut(&StressSample) -> f64) -> CurvePeak {
        let n = self.samples.len() + self.between.len() - 1;
        let (low, high) = (nested_point(n, (index + 1).min(n)), nested_point(n, index.saturating_sub(1)));
        let mut best = CurvePeak { value: f64::NEG_INFINITY, sample: [0.0; 9], at: self.instant(0.0) };
        let mut look = |x: f64| {
            let sample = combined(&nested_weights(self.samples.len() - 1, x), &self.samples);
            let found = value(&sample);
            if found > best.value {
                best = CurvePeak { value: found, sample, at: self.instant(x) };
            }
            found
        };
        largest([low, high], BRACKET, &mut look);
        best
    }
}
