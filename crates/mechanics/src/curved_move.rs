//! Moves that are straight in a force, followed by exact straight moves within a tolerance.
//!
//! A path straight in (F_x, F_N), (U, F_N) or (F_x, d) is a curve in (d, W). It is followed by chords between points of
//! the curve, each an exact move. A chord differs from the curve only for levels that come into contact on the way
//! (each keeps the displacement gained since its touch) and where slip begins between its ends; both errors are
//! estimated from the distance between the middle of the curve and the chord. While nothing slips, dU/dd = (E*/G*)
//! dF_x/dF_N: such stretches are straight and cost one chord.

use std::ops::{Add, Mul, Sub};

use super::profile::{Ring, StressRadius};
use super::{Contact, DoubleDouble, Error};

/// Error of the tangential force, relative to mu F_N, that a move may have unless the caller prescribes another.
pub const DEFAULT_TOLERANCE: f64 = 1e-10;
/// The largest number of chords of one move: a bound on its time and on the pieces that it leaves.
pub const MAX_CHORDS: usize = 1 << 16;
/// Up to this many chords the tolerance holds: a load that rises from zero to any value takes half of them at the
/// default.
const FULL_TOLERANCE_CHORDS: usize = MAX_CHORDS / 2;
/// After every further interval of this many chords the tolerance is relaxed by a factor of four, which halves the
/// number that the rest of the move needs: a move ends within [`MAX_CHORDS`], and its actual error is reported.
const RELAXATION_INTERVAL: usize = MAX_CHORDS / 16;

/// The share of the tolerance that a chord may use on which slip begins or ends.
const SLIP_CHANGE_SHARE: f64 = 1.0 / 16.0;

/// How the tangential target is reached: straight from one value to the other.
#[derive(Clone, Copy, Debug)]
pub(super) enum TangentialPath {
    Displacement { from: DoubleDouble, to: DoubleDouble },
    Force { from: f64, to: f64 },
}

/// How the normal target is reached.
#[derive(Clone, Copy, Debug)]
pub(super) enum NormalPath {
    Indentation { from: DoubleDouble, to: DoubleDouble },
    Force { from: f64, to: f64 },
}

/// A path straight in two quantities, over a parameter from 0 to 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct CurvedMove {
    pub(super) tangential: TangentialPath,
    pub(super) normal: NormalPath,
}

/// A point of the curve.
#[derive(Clone, Copy)]
pub(super) struct PathPoint {
    /// d, m.
    pub(super) indentation: DoubleDouble,
    /// F_N, N, that belongs to it.
    pub(super) normal_force: f64,
    /// U, m.
    pub(super) displacement: DoubleDouble,
}

/// The errors of a chord.
struct Deviation {
    /// int |error of w| dx, m^2.
    integral: f64,
    /// Whether slip begins or ends between its ends.
    slip_changes: bool,
    /// Error of the slope of w over y, times the kernel of the newly touched ring at its inner radius.
    kernel: f64,
}

/// The factor by which the tolerance is relaxed after this many chords.
fn relaxation(chords: usize) -> f64 {
    let intervals = (chords + RELAXATION_INTERVAL).saturating_sub(FULL_TOLERANCE_CHORDS) / RELAXATION_INTERVAL;
    (0..intervals).fold(1.0, |factor, _| 4.0 * factor)
}

fn between<T: Copy + Add<Output = T> + Sub<Output = T> + Mul<f64, Output = T>>(from: T, to: T, part: f64) -> T {
    if part < 1.0 { from + (to - from) * part } else { to }
}

impl Contact {
    /// Follows a path while `keep_going` returns true; `tolerance` is relative to mu F_N.
    pub(super) fn follow(
        &mut self,
        path: &CurvedMove,
        tolerance: f64,
        keep_going: &dyn Fn() -> bool,
    ) -> Result<(), Error> {
        self.check_limit(path)?;
        if matches!(path.normal, NormalPath::Force { .. }) && self.history.edge().level < DoubleDouble::ZERO {
            // A gap closes before any force can rise.
            let touch =
                PathPoint { indentation: DoubleDouble::ZERO, normal_force: 0.0, displacement: self.displacement };
            self.advance(&touch);
        }
        let unit = self.force_unit();
        let largest = self.friction * self.normal_force_on(path, 0.0).max(self.normal_force_on(path, 1.0));
        let (mut done, mut step, mut chords) = (0.0, 1.0_f64, 0);
        while done < 1.0 {
            if !keep_going() {
                return Err(Error::Interrupted);
            }
            let next = if chords < MAX_CHORDS && done + step < 1.0 { done + step } else { 1.0 };
            let end = self.point_on(path, next);
            let deviation = self.deviation(path, done, next, &end);
            let error = if largest > 0.0 { unit * deviation.integral / largest } else { 0.0 };
            let share = if deviation.slip_changes { SLIP_CHANGE_SHARE } else { next - done };
            let tolerance = tolerance * relaxation(chords);
            if error > tolerance * share && step > f64::EPSILON && chords < MAX_CHORDS {
                // The error of a smooth chord falls with the cube of its length, its share with the length.
                let shorter = if deviation.slip_changes { 0.25 } else { 0.9 * (tolerance * share / error).sqrt() };
                step = (next - done) * shorter.clamp(0.02, 0.5);
                continue;
            }
            // Errors of the force accumulate, those of the stress are local. Before the move, because gross slip wipes
            // out the error of the chord that leads into it too.
            self.path_error += error;
            self.path_kernel = self.path_kernel.max(deviation.kernel);
            self.advance(&end);
            done = next;
            chords += 1;
            step *= 2.0;
        }
        Ok(())
    }

    /// Refuses a path on which the tangential force does not stay below mu F_N, and reports where it first does not.
    fn check_limit(&self, path: &CurvedMove) -> Result<(), Error> {
        let TangentialPath::Force { from, to } = path.tangential else { return Ok(()) };
        let room = |part: f64| self.friction * self.normal_force_on(path, part) - between(from, to, part).abs();
        let fails = |part: f64| {
            let limit = self.friction * self.normal_force_on(path, part);
            // A contact in gross slip is at its limit to round-off, and may turn back from there.
            room(part) < -16.0 * f64::EPSILON * limit || (part >= 1.0 && to.abs() >= limit)
        };
        // F_N is straight or, over the indentation, convex; |F_x| is two straight lines. So on either side of F_x = 0
        // the room is convex, and lowest at an end unless the indentation changes.
        let middle = if from * to < 0.0 { from / (from - to) } else { 1.0 };
        let curved = matches!(path.normal, NormalPath::Indentation { from, to } if from != to);
        for (low, high) in [(0.0, middle), (middle, 1.0)] {
            let lowest = if curved { lowest_of(&room, low, high) } else { high };
            let Some(bad) = [lowest, high].into_iter().find(|&part| fails(part)) else { continue };
            let (mut good, mut bad) = (low, bad);
            for _ in 0..64 {
                let half = 0.5 * (good + bad);
                if fails(half) { bad = half } else { good = half }
            }
            let limit = self.friction * self.normal_force_on(path, bad);
            return Err(Error::ForceExceedsFriction { target: to, limit, part: bad });
        }
        Ok(())
    }

    /// Normal force, N, at a point of the path.
    fn normal_force_on(&self, path: &CurvedMove, part: f64) -> f64 {
        match path.normal {
            NormalPath::Force { from, to } => between(from, to, part),
            NormalPath::Indentation { from, to } if from == to => self.normal_force(),
            NormalPath::Indentation { from, to } => self.normal_force_at(between(from, to, part)),
        }
    }

    fn point_on(&self, path: &CurvedMove, part: f64) -> PathPoint {
        let normal_force = self.normal_force_on(path, part);
        let indentation = match path.normal {
            NormalPath::Indentation { from, to } => between(from, to, part),
            NormalPath::Force { .. } => self.indentation_for(normal_force),
        };
        let displacement = match path.tangential {
            TangentialPath::Displacement { from, to } => between(from, to, part),
            TangentialPath::Force { from, to } => {
                self.unscaled(self.position_for(indentation, normal_force, between(from, to, part)))
            }
        };
        PathPoint { indentation, normal_force, displacement }
    }

    /// The errors of the chord from here to `end`, judged at the middle of its stretch.
    fn deviation(&self, path: &CurvedMove, done: f64, next: f64, end: &PathPoint) -> Deviation {
        let start = self.history.edge().level;
        let rise = end.indentation - start;
        if rise.abs() <= DoubleDouble::ZERO {
            return Deviation { integral: 0.0, slip_changes: false, kernel: 0.0 };
        }
        let middle = self.point_on(path, 0.5 * (done + next));
        let half_rise = middle.indentation - start;
        let (half, whole) = (self.advance_to(&middle), self.advance_to(end));
        let off = (half - (whole * half_rise).over(rise)).value().abs();
        // Slip towards s goes on while s dW - dd > 0.
        let slips = |advance: DoubleDouble, rise: DoubleDouble, sign: f64| (advance * sign - rise).value() > 0.0;
        let slip_changes = [1.0, -1.0]
            .into_iter()
            .any(|sign| slips(half, half_rise, sign) != slips(whole - half, rise - half_rise, sign));
        let lower = if rise.value() > 0.0 { start } else { end.indentation };
        let lower = if lower.value() > 0.0 { lower } else { DoubleDouble::ZERO };
        let upper = if rise.value() > 0.0 { end.indentation } else { start };
        let edge = self.profile.point(upper);
        let touched = Ring::between(self.profile.point(lower), edge);
        let width = if slip_changes { edge.radius } else { self.profile.moments(&touched).width };
        // A parabola's slope is four times its height over its base off its chord's.
        let kernel =
            4.0 * off / rise.abs().value() * self.profile.kernel(&StressRadius::of_point(&touched.inner), &touched);
        Deviation { integral: off * width, slip_changes, kernel }
    }

    /// Scaled displacement from here to a point of the path, m.
    fn advance_to(&self, point: &PathPoint) -> DoubleDouble {
        self.scaled(point.displacement) - self.history.position()
    }
}

/// The minimum of a convex function on an interval, by ternary search down to round-off.
fn lowest_of(function: &impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    for _ in 0..80 {
        let third = (high - low) / 3.0;
        if function(low + third) <= function(high - third) { high -= third } else { low += third }
    }
    0.5 * (low + high)
}
