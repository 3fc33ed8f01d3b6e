//! Moves that are straight in a force, followed by exact straight moves within a tolerance.
//!
//! A path straight in (F_x, F_N), (U, F_N) or (F_x, d) is a curve in (d, W). A straight move between two of its points
//! is exact unless W - d or W + d turns between them, where slip begins or ends, or levels come into contact without
//! slip, which keep the displacement gained since their touch. So the turns are searched for, and the stretches
//! between them followed by pairs of chords, each with the integral of the curve (`curve_panel`): the errors of two
//! pairs do not add up, and the error in the middle of a pair falls with the cube of its length.

use std::ops::{Add, Mul, Sub};

use crate::contact::Contact;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::roots::{largest, turning};
use crate::path::curve_panel::{PathPanel, lag, lever};
use crate::path::curved_path::{CurvedMove, CurvedPath, NormalPath, PathPoint, TangentialPath};
use crate::profile::Ring;
use crate::range::error::Error;

/// Error of the tangential force, relative to mu F_N, that a move may have unless the caller prescribes another.
pub const DEFAULT_TOLERANCE: f64 = 1e-10;
/// The largest number of chords of one move: a bound on its time and on the pieces that it leaves.
pub const MAX_CHORDS: usize = 1 << 16;
/// Up to this many chords the tolerance holds: ten times as many as a load that rises from zero takes at the default.
const FULL_TOLERANCE_CHORDS: usize = MAX_CHORDS / 2;
/// After every further interval of this many chords the tolerance is relaxed by a factor of eight, which halves the
/// number that the rest of the move needs: a move ends within [`MAX_CHORDS`], and its actual error is reported.
const RELAXATION_INTERVAL: usize = MAX_CHORDS / 16;

/// The share of the tolerance that the middle of a pair of chords may use; the rest is for the quadratures.
const PAIR_SHARE: f64 = 0.5;
/// The least share of it that the quadrature of one pair may use: without a least, a load that rises from zero could
/// not begin.
const QUADRATURE_SHARE: f64 = 1.0 / 1024.0;
/// A turn this near an end of a stretch, relative to its length, is at that end. W - d is flat there, so that its
/// extremum is right to the square of this.
const SAME_TURN: f64 = 1e-6;
/// The parts of a stretch to which a turn, and the place nearest to the limit of friction, are narrowed down.
const TURN: f64 = 1e-7;
const LIMIT: f64 = 1e-14;

/// The trace of a pair of chords in the history, as long as it is not wiped out.
struct Trace {
    /// The level from which on it lies.
    inner: DoubleDouble,
    /// Errors of the force in the middle of the pair and by its quadrature, relative to mu F_N.
    within: f64,
    quadrature: f64,
    /// Error of the slope of w over y, times the kernel of the ring, at the ring's inner radius.
    kernel: f64,
}

/// The factor by which the tolerance is relaxed after this many chords.
fn relaxation(chords: usize) -> f64 {
    let intervals = (chords + RELAXATION_INTERVAL).saturating_sub(FULL_TOLERANCE_CHORDS) / RELAXATION_INTERVAL;
    (0..intervals).fold(1.0, |factor, _| 8.0 * factor)
}

fn between<T: Copy + Add<Output = T> + Sub<Output = T> + Mul<f64, Output = T>>(from: T, to: T, part: f64) -> T {
    if part < 1.0 { from + (to - from) * part } else { to }
}

impl Contact {
    /// Follows a path that friction holds ([`Contact::check_limit`]) while `keep_going` returns true; `tolerance` is
    /// relative to mu F_N. `visit` is told the part of the path that is done, from 0 to 1, and the end of each chord.
    pub(crate) fn follow(
        &mut self,
        path: &dyn CurvedPath,
        tolerance: f64,
        keep_going: &dyn Fn() -> bool,
        visit: &mut dyn FnMut(f64, &Contact),
    ) -> Result<(), Error> {
        let here = self.history.edge().level;
        if here < DoubleDouble::ZERO && path.point(self, 0.0).indentation > here {
            // A gap closes before any force can rise.
            let touch =
                PathPoint { indentation: DoubleDouble::ZERO, normal_force: 0.0, displacement: self.displacement };
            self.advance(&touch);
            visit(0.0, self);
        }
        let unit = self.force_unit();
        let largest = self.friction * path.normal_force(self, 0.0).max(path.normal_force(self, 1.0));
        let relative = if largest > 0.0 { unit / largest } else { 0.0 };
        let (mut done, mut step, mut chords) = (0.0_f64, 1.0_f64, 0);
        let mut traces: Vec<Trace> = Vec::new();
        while done < 1.0 {
            if !keep_going() {
                return Err(Error::Interrupted);
            }
            let refinable = chords + 2 <= MAX_CHORDS && step > f64::EPSILON * done.max(f64::EPSILON);
            let next = if chords + 2 <= MAX_CHORDS && done + step < 1.0 { done + step } else { 1.0 };
            let panel = self.panel(path, done, next);
            if refinable && let Some(turn) = self.turn(path, (done, next), &panel) {
                step = turn - done;
                continue;
            }
            let (within, quadrature) = (relative * panel.within, relative * panel.quadrature);
            let tolerance = tolerance * relaxation(chords);
            let (most, most_quadrature) = (PAIR_SHARE * tolerance, tolerance * (next - done).max(QUADRATURE_SHARE));
            if refinable && (within > most || quadrature > most_quadrature) {
                // The error in the middle of a pair falls with the cube of its length.
                let shorter = if within > most { 0.9 * (most / within).cbrt() } else { 0.5 };
                step = (next - done) * shorter.clamp(0.02, 0.5);
                continue;
            }
            let straight = within.max(quadrature) <= f64::EPSILON;
            let inner = self.history.edge().level;
            if !straight {
                self.work_error += unit * panel.within * self.travel_to(&panel.end);
                self.advance(&panel.elbow);
                visit(0.5 * (done + next), self);
            }
            self.advance(&panel.end);
            visit(next, self);
            let slip = self.history.slip_from().map_or(panel.end.indentation, |start| start.level);
            while traces.last().is_some_and(|last| last.inner >= slip || last.inner >= panel.end.indentation) {
                traces.pop();
            }
            if panel.sticks {
                traces.push(Trace { inner, within, quadrature, kernel: panel.kernel });
            }
            done = next;
            chords += if straight { 1 } else { 2 };
            step *= 2.0;
        }
        // Each pair has the integral of the curve, so later moves find the error of one pair at most: that in
        // which its slip ends. The errors of the quadratures add up.
        self.path_error += traces.iter().fold(0.0, |most: f64, trace| most.max(trace.within));
        self.path_error += traces.iter().map(|trace| trace.quadrature).sum::<f64>();
        self.path_kernel = traces.iter().fold(self.path_kernel, |most, trace| most.max(trace.kernel));
        Ok(())
    }

    /// Where slip begins or ends on a stretch, unless that is at an end of it: W - d or W + d has an extremum there.
    fn turn(&self, path: &dyn CurvedPath, (done, next): (f64, f64), panel: &PathPanel) -> Option<f64> {
        let (sign, rises_first) = panel.turn?;
        let towards = if rises_first { -1.0 } else { 1.0 };
        let distance = |part: f64| {
            let point = path.point(self, part);
            let rise = point.indentation - self.history.edge().level;
            towards * (self.advance_to(&point) * sign - rise).value()
        };
        let turn = largest([done, next], TURN, |part| -distance(part)).0;
        let margin = SAME_TURN * (next - done);
        (turn > done + margin && turn < next - margin).then_some(turn)
    }

    /// Refuses a path on which the tangential force does not stay below mu F_N, and reports where it first does not.
    pub(super) fn check_limit(&self, path: &CurvedMove) -> Result<(), Error> {
        let TangentialPath::Force { from, to } = path.tangential else { return Ok(()) };
        let room = |part: f64| self.friction * path.normal_force(self, part) - between(from, to, part).abs();
        let fails = |part: f64| {
            let limit = self.friction * path.normal_force(self, part);
            // A contact in gross slip is at its limit to round-off, and may turn back from there.
            room(part) < -16.0 * f64::EPSILON * limit || (part >= 1.0 && to.abs() >= limit && to.abs() > 0.0)
        };
        // F_N is straight or, over the indentation, convex; |F_x| is two straight lines. So on either side of F_x = 0
        // the room is convex, and lowest at an end unless the indentation changes.
        let middle = if from * to < 0.0 { from / (from - to) } else { 1.0 };
        let curved = matches!(path.normal, NormalPath::Indentation { from, to } if from != to);
        for (low, high) in [(0.0, middle), (middle, 1.0)] {
            let lowest = if curved { largest([low, high], LIMIT, |part| -room(part)).0 } else { high };
            let Some(bad) = [lowest, high].into_iter().find(|&part| fails(part)) else { continue };
            let [_, bad] = turning([low, bad], fails);
            let limit = self.friction * path.normal_force(self, bad);
            return Err(Error::ForceExceedsFriction { target: to, limit, part: bad });
        }
        Ok(())
    }

    /// Scaled displacement from here to a point of the path, m.
    pub(crate) fn advance_to(&self, point: &PathPoint) -> DoubleDouble {
        self.scaled(point.displacement) - self.history.position()
    }
}

impl CurvedPath for CurvedMove {
    fn normal_force(&self, contact: &Contact, part: f64) -> f64 {
        match self.normal {
            NormalPath::Force { from, to } => between(from, to, part),
            NormalPath::Indentation { from, to } if from == to => contact.normal_force(),
            NormalPath::Indentation { from, to } => contact.normal_force_at(between(from, to, part)),
        }
    }

    fn point(&self, contact: &Contact, part: f64) -> PathPoint {
        let normal_force = self.normal_force(contact, part);
        let indentation = match self.normal {
            NormalPath::Indentation { from, to } => between(from, to, part),
            NormalPath::Force { .. } => contact.indentation_for(normal_force),
        };
        let displacement = match self.tangential {
            TangentialPath::Displacement { from, to } => between(from, to, part),
            TangentialPath::Force { from, to } => {
                let target = between(from, to, part);
                let pressed = matches!(self.normal, NormalPath::Indentation { .. });
                let held = if pressed { contact.stuck_position(indentation, target) } else { None };
                held.map(|held| contact.unscaled(held))
                    .unwrap_or_else(|| contact.displacement_for(indentation, normal_force, target))
            }
        };
        PathPoint { indentation, normal_force, displacement }
    }

    fn gain(&self, contact: &Contact, ring: &Ring, advance: f64) -> Option<(f64, f64)> {
        match (self.tangential, self.normal) {
            (TangentialPath::Displacement { .. }, NormalPath::Force { .. }) => Some(lever(contact, ring, advance)),
            (TangentialPath::Force { .. }, NormalPath::Indentation { .. }) => Some(lag(contact, ring, advance)),
            // In two forces dU/dd = (E*/G*) dF_x/dF_N, and in displacement and indentation, the path is straight.
            _ => None,
        }
    }
}
