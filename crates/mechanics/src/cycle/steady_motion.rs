//! The steady motion of a driven mass on a contact.
//!
//! At its largest displacement A the mass is at rest, and the contact remembers nothing but A: the loops of the period
//! before lie within. Amplitude and instant of that turning point are two unknowns, and half a period later the mass
//! must be at rest at -A: two equations, solved by Broyden's method with motions that are followed roughly at first.
//! Where a start does not lead to the root, the next is the motion of the mass after ever more periods, which draws
//! near the steady one.

use std::f64::consts::{PI, TAU};

use super::Response;
use super::mass_motion::{DrivenMass, Motion, Unfinished};
use crate::numerics::broyden::{Matrix, inverse, product, updated};

/// Steps of Broyden's method for one start, and halvings of a step that does not bring the end nearer.
const STEPS: usize = 24;
const HALVINGS: usize = 3;
/// A step that leaves more than this share of the residual asks for a new Jacobian.
const SLOW: f64 = 0.3;
/// The longest step, of the amplitude as a part of itself and of the instant, rad.
const LONGEST: [f64; 2] = [0.3, 0.5];
/// Differences for the Jacobian, and how far from where it was taken it still gives errors.
const DIFFERENCE: f64 = 1e-4;
const NEAR: f64 = 1e-2;
/// The tolerance of a step of a rough motion, as part of the amplitude.
const ROUGH: f64 = 1e-5;
/// Periods that are followed between two starts double up to 2 to this power.
const DOUBLINGS: i32 = 8;
/// The tolerance of a step of a motion, as part of the tolerance asked for, and by what it is tightened, how often,
/// where that does not suffice; and the least of all.
const SHARE: f64 = 1e-1;
const TIGHTER: f64 = 1e-2;
const TIGHTENINGS: usize = 3;
const LEAST: f64 = 1e-13;
/// The residual, in tolerances of a step, that is accepted where no step makes it smaller.
const RESIDUAL: f64 = 1e3;

type Attempt<T> = Result<T, Unfinished>;

/// The inverse of the Jacobian of the residual, and the derivatives of the first harmonic, cosine and sine.
#[derive(Clone, Copy)]
struct Slopes {
    taken_at: [f64; 2],
    inverse: Matrix,
    waves: Matrix,
}

/// A motion of half a period from a turning point, and its residual at the end, m: of displacement and speed.
struct Tried {
    /// Amplitude, m, and angle of the turning point.
    from: [f64; 2],
    motion: Motion,
    off: [f64; 2],
}

impl DrivenMass<'_> {
    /// The steady oscillation to `tolerance`, of the amplitude, sought from an amplitude and a phase on.
    pub(super) fn steady(&self, start: [f64; 2], tolerance: f64) -> Attempt<Response> {
        let (mut best, mut from, mut share): (Option<Response>, _, _) = (None, start, SHARE);
        for _ in 0..=TIGHTENINGS {
            let step = (share * tolerance).max(LEAST);
            let (tried, slopes) = match self.search(from, step) {
                Err(Unfinished::NotFound) => break,
                found => found?,
            };
            let found = self.response(&tried, &slopes);
            if best.is_none_or(|best| found.amplitude_error < best.amplitude_error) {
                best = Some(found);
            }
            if found.amplitude_error.max(found.peak_error) <= tolerance * found.amplitude || step <= LEAST {
                break;
            }
            from = tried.from;
            share *= TIGHTER;
        }
        best.ok_or(Unfinished::NotFound)
    }

    /// The same with motions of one tolerance of a step, as part of the amplitude.
    fn search(&self, start: [f64; 2], step: f64) -> Attempt<(Tried, Slopes)> {
        let mut from = start;
        let mut moving = Motion::at_rest(self, start[0], start[1]);
        for doubling in 0..=DOUBLINGS {
            match self.solve(from, step) {
                Err(Unfinished::NotFound) => {}
                found => return found,
            }
            for periods in [2_f64.powi(doubling), 1.0] {
                moving.extremes = [None; 2];
                let next = moving.angle + TAU * periods;
                self.follow(&mut moving, next, ROUGH * start[0])?;
            }
            if let [Some((upper, angle)), Some((lower, _))] = moving.extremes {
                from = [0.5 * (upper - lower), angle.rem_euclid(TAU)];
            }
        }
        Err(Unfinished::NotFound)
    }

    /// The turning point from which the mass comes to its mirror image, near `start`.
    fn solve(&self, start: [f64; 2], step: f64) -> Attempt<(Tried, Slopes)> {
        let rough = ROUGH.max(step);
        let here = self.tried(start, rough * start[0])?;
        let slopes = self.slopes_beside(&here, rough * start[0])?;
        let (here, slopes) = self.approach(here, slopes, rough)?;
        let fine = self.tried(here.from, step * here.from[0])?;
        let (found, slopes) = self.approach(fine, slopes, step)?;
        // A motion that went farther than it began has begun at another of its turning points.
        let farthest = found.motion.extremes.iter().flatten().fold(0.0_f64, |most, (place, _)| most.max(place.abs()));
        let amplitude = found.from[0];
        if amplitude <= 0.0 || farthest > (1.0 + RESIDUAL * step) * amplitude {
            return Err(Unfinished::NotFound);
        }
        let moved = [(amplitude / slopes.taken_at[0]).ln(), found.from[1] - slopes.taken_at[1]];
        let near = moved.iter().all(|change| change.abs() < NEAR);
        let slopes = if near { slopes } else { self.slopes(found.from, rough * amplitude)? };
        Ok((found, slopes))
    }

    /// Broyden's method with motions of this tolerance of a step, as part of the amplitude.
    fn approach(&self, mut here: Tried, mut slopes: Slopes, step: f64) -> Attempt<(Tried, Slopes)> {
        let mut fresh = true;
        for _ in 0..STEPS {
            let tolerance = step * here.from[0];
            if self.size(here.off) <= tolerance {
                return Ok((here, slopes));
            }
            let renewed = |from: [f64; 2]| self.slopes(from, ROUGH.max(step) * from[0]);
            let full = product(&slopes.inverse, here.off).map(|change| -change);
            let limits = [LONGEST[0] * here.from[0], LONGEST[1]];
            let mut part = full.iter().zip(limits).fold(1.0_f64, |part, (change, most)| part.min(most / change.abs()));
            let mut nearer = None;
            for _ in 0..=if fresh { HALVINGS } else { 0 } {
                let tried = self.tried([0, 1].map(|index| here.from[index] + part * full[index]), tolerance)?;
                if self.size(tried.off) < (1.0 - 0.1 * part) * self.size(here.off) {
                    nearer = Some(tried);
                    break;
                }
                part *= 0.5;
            }
            let Some(tried) = nearer else {
                if fresh {
                    // A residual that no step makes smaller is the rounding of the motions.
                    let rounded = self.size(here.off) <= RESIDUAL * tolerance;
                    return rounded.then_some((here, slopes)).ok_or(Unfinished::NotFound);
                }
                (slopes, fresh) = (renewed(here.from)?, true);
                continue;
            };
            fresh = self.size(tried.off) > SLOW * self.size(here.off);
            if fresh {
                slopes = renewed(tried.from)?;
            } else {
                let [step, change] = [(here.from, tried.from), (here.off, tried.off)]
                    .map(|(before, after)| [after[0] - before[0], after[1] - before[1]]);
                slopes.inverse = updated(&slopes.inverse, step, change);
            }
            here = tried;
        }
        Err(Unfinished::NotFound)
    }

    /// Half a period from a turning point, each step to `tolerance`, m.
    fn tried(&self, from: [f64; 2], tolerance: f64) -> Attempt<Tried> {
        let mut motion = Motion::at_rest(self, from[0], from[1]);
        self.follow(&mut motion, from[1] + PI, tolerance)?;
        let off = [motion.displacement + from[0], motion.speed];
        Ok(Tried { from, motion, off })
    }

    /// The size of a residual, m.
    fn size(&self, off: [f64; 2]) -> f64 {
        off[0].hypot(off[1] / self.fastest())
    }

    /// The derivatives at a turning point, by motions to this tolerance, m.
    fn slopes(&self, from: [f64; 2], tolerance: f64) -> Attempt<Slopes> {
        self.slopes_beside(&self.tried(from, tolerance)?, tolerance)
    }

    /// The derivatives beside a motion, of motions to the same `tolerance`, m.
    fn slopes_beside(&self, middle: &Tried, tolerance: f64) -> Attempt<Slopes> {
        let steps = [DIFFERENCE * middle.from[0], DIFFERENCE];
        let (mut slopes, mut waves) = ([[0.0; 2]; 2], [[0.0; 2]; 2]);
        for (index, step) in steps.into_iter().enumerate() {
            let mut beside = middle.from;
            beside[index] += step;
            let beside = self.tried(beside, tolerance)?;
            for row in 0..2 {
                slopes[row][index] = (beside.off[row] - middle.off[row]) / step;
                waves[row][index] = (beside.motion.sums[row] - middle.motion.sums[row]) * 2.0 / (PI * step);
            }
        }
        let inverse = inverse(slopes).ok_or(Unfinished::NotFound)?;
        Ok(Slopes { taken_at: middle.from, inverse, waves })
    }

    /// The response, with its error: that of the motion and its residual, through the derivatives.
    fn response(&self, found: &Tried, slopes: &Slopes) -> Response {
        let [cos, sin, force_cos, force_sin, third_cos, third_sin] = found.motion.sums.map(|sum| sum * 2.0 / PI);
        let [displaced, sped] = found.motion.error.map(|error| 2.0 * error);
        let off = [found.off[0].abs() + displaced, found.off[1].abs() + sped + displaced * self.fastest()];
        let magnitudes = |matrix: &Matrix| matrix.map(|row| row.map(f64::abs));
        let moved = product(&magnitudes(&slopes.inverse), off);
        let [cos_error, sin_error] = product(&magnitudes(&slopes.waves), moved);
        let first_force = force_cos.hypot(force_sin);
        Response {
            frequency: self.frequency,
            amplitude: cos.hypot(sin),
            phase: sin.atan2(cos),
            peak: found.from[0],
            third_harmonic: if first_force > 0.0 { third_cos.hypot(third_sin) / first_force } else { 0.0 },
            amplitude_error: cos_error.hypot(sin_error) + displaced,
            peak_error: moved[0] + displaced,
        }
    }
}
