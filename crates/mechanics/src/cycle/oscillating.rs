//! Steady cycles under a load that oscillates too: stepped with the exact memory until they close.
//!
//! The drive is S0 cos(t), the load N + dN cos(t + phase). Such a path is curved; here it is followed by pairs of exact
//! straight moves, which end on the curve at equal steps of t. Where the displacement is given, the point between them
//! is moved off the curve so that the pair has its integral of U over d, on which friction work and the displacement of
//! newly touched levels depend (`curve_panel` says why), and steps are divided where slip begins or ends: what is left
//! falls with the fourth power of the step. Driven by a force, or through a machine, the steps in which slip turns are
//! not known, and it falls with the square. The steps are halved until two results agree.

use std::f64::consts::TAU;

use super::Drive;
use super::lap::OscillatingCycle;
use crate::contact::Contact;
use crate::contact::state::Normal;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::roots::{between, turning};
use crate::path::curved_path::PathPoint;
use crate::range::error::Error;
use crate::range::unit_prefix::short;
use crate::range::{self, Quantity};

/// Steps of a cycle at first, and at most.
const FEWEST: usize = 128;
const MOST: usize = 1 << 14;
/// Cycles after which a driven force closes the path; the second one does unless the load comes near zero.
const CYCLES: usize = 32;
/// Two cycles are the same if their work and force agree to this part of mu F_N and of its work.
const CLOSED: f64 = 1e-12;
/// Where slip turns closer than this part of a step to its end, it turns there.
const SAME_TURN: f64 = 1e-9;

/// An amplitude of the load, and by how much it runs ahead of the drive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OscillatingLoad {
    /// Amplitude of the normal force, N, or of the indentation, m.
    pub amplitude: Normal,
    /// The phase, rad.
    pub phase: f64,
}

/// Drive and load of a cycle, and the machine between drive and contact.
#[derive(Clone, Copy, Debug)]
pub struct Oscillation {
    /// The drive.
    pub drive: Drive,
    /// The load meanwhile.
    pub load: OscillatingLoad,
    /// Compliance of the machine, m/N; zero for none.
    pub compliance: f64,
}

impl Oscillation {
    /// The steady cycle about the present load of a contact, to `tolerance`, with harmonics up to the order `count`.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if the normal force would fall below zero or the indentation leave its range,
    /// [`Error::ForceExceedsFriction`] where friction does not hold a driven force, [`Error::Interrupted`] if
    /// `keep_going` returned false: it is asked at each step.
    ///
    /// ```
    #[doc = include_str!("../example.txt")]
    /// use stickslip_mechanics::cycle::{Drive, Oscillation, OscillatingLoad};
    ///
    /// let load = OscillatingLoad { amplitude: Normal::NormalForce(800.0), phase: 0.0 };
    /// let swing = Oscillation { drive: Drive::Displacement(0.002), load, compliance: 0.0 };
    /// let cycle = swing.steady(&contact, 1e-6, 0, &|| true)?;
    /// assert!(cycle.dissipated_energy > 0.0 && cycle.error <= 1e-6);
    /// # Ok::<(), Error>(())
    /// ```
    pub fn steady(
        &self,
        contact: &Contact,
        tolerance: f64,
        count: usize,
        keep_going: &dyn Fn() -> bool,
    ) -> Result<OscillatingCycle, Error> {
        contact.check_coulomb("a cycle under an oscillating load")?;
        let (mut steps, mut earlier) = (FEWEST, 0.0_f64);
        let mut coarse = self.followed(contact, steps, count, keep_going)?;
        loop {
            steps *= 2;
            let fine = self.followed(contact, steps, count, keep_going)?;
            let unit = self.force_unit(contact);
            let relative = |difference: f64, unit: f64| if unit > 0.0 { (difference / unit).abs() } else { 0.0 };
            let work = fine.dissipated_energy - coarse.dissipated_energy;
            let answer = fine.force_amplitude - coarse.force_amplitude;
            let change = relative(work, 4.0 * unit * fine.displacement_amplitude).max(relative(answer, unit));
            // Two results may agree by chance, three less easily.
            let error = change.max(0.25 * earlier) + fine.error;
            if error <= tolerance && earlier > 0.0 || steps >= MOST || change <= 0.0 {
                return Ok(OscillatingCycle { error, ..fine });
            }
            earlier = change;
            coarse = fine;
        }
    }

    /// mu F_N at the largest load, N.
    fn force_unit(&self, contact: &Contact) -> f64 {
        contact.friction
            * match self.load.amplitude {
                Normal::NormalForce(amplitude) => contact.normal_force + amplitude.abs(),
                Normal::Indentation(amplitude) => {
                    contact.normal_force_at(contact.history.edge().level + DoubleDouble::from(amplitude.abs()))
                }
            }
    }

    /// The normal side of the path at an angle of the drive: indentation and normal force.
    fn load_at(&self, contact: &Contact, angle: f64) -> (DoubleDouble, f64) {
        let swing = (angle + self.load.phase).cos();
        match self.load.amplitude {
            Normal::NormalForce(amplitude) => {
                let force = (contact.normal_force + amplitude * swing).max(0.0);
                (contact.indentation_for(force), force)
            }
            Normal::Indentation(amplitude) => {
                let level = contact.history.edge().level + DoubleDouble::from(amplitude * swing);
                (level, contact.normal_force_at(level))
            }
        }
    }

    fn check(&self, contact: &Contact) -> Result<(), Error> {
        if contact.indenter.line().is_some_and(|line| line.bulk().is_some()) {
            return Err(Error::BulkNeedsConstantLoad);
        }
        match self.load.amplitude {
            Normal::NormalForce(amplitude) => {
                if amplitude.is_nan() || amplitude.abs() > contact.normal_force {
                    let allowed = format!("up to the normal force, {} N", short(contact.normal_force));
                    return Err(Error::OutOfRange { quantity: Quantity::NormalForce, value: amplitude, allowed });
                }
                let largest = range::check_normal_force(contact.normal_force + amplitude.abs())?;
                contact.check_indentation(contact.indentation_for(largest).value())
            }
            Normal::Indentation(amplitude) => {
                contact.check_indentation(contact.indentation() - amplitude.abs())?;
                contact.check_indentation(contact.indentation() + amplitude.abs())
            }
        }
    }

    /// The cycle in so many steps, after as many cycles as it takes to close.
    fn followed(
        &self,
        contact: &Contact,
        steps: usize,
        count: usize,
        keep_going: &dyn Fn() -> bool,
    ) -> Result<OscillatingCycle, Error> {
        self.check(contact)?;
        let mut moving = contact.without_history();
        self.step_to(contact, &mut moving, 0.0, None)?;
        let unit = self.force_unit(contact);
        let (mut before, mut end) = self.lap(contact, &mut moving, (steps, count), keep_going)?;
        for _ in 1..CYCLES {
            let (mut lap, ends) = self.lap(contact, &mut moving, (steps, count), keep_going)?;
            let most = (4.0 * unit * lap.displacement_amplitude).max(f64::MIN_POSITIVE);
            let work = (lap.dissipated_energy - before.dissipated_energy).abs() / most;
            let change = work.max((ends - end).abs() / unit.max(f64::MIN_POSITIVE));
            // Under a driven displacement a cycle clamps each spring to the same bounds again: the first one closes.
            lap.error = if self.displaced().is_some() { 0.0 } else { change };
            (before, end) = (lap, ends);
            if before.error <= CLOSED {
                break;
            }
        }
        Ok(before)
    }

    /// One cycle in so many steps, and the force at its end, N.
    fn lap(
        &self,
        contact: &Contact,
        moving: &mut Contact,
        (steps, count): (usize, usize),
        keep_going: &dyn Fn() -> bool,
    ) -> Result<(OscillatingCycle, f64), Error> {
        let start = moving.dissipated;
        let (mut states, mut answers) = (vec![moving.state()], Vec::with_capacity(steps / 2));
        for index in 1..=steps / 2 {
            if !keep_going() {
                return Err(Error::Interrupted);
            }
            let angle = |step: usize| TAU * step as f64 / steps as f64;
            let (from, to) = (angle(2 * index - 2), angle(2 * index));
            let mut here = from;
            for next in self.turns(contact, from, to).into_iter().chain([to]) {
                let middle = 0.5 * (here + next);
                self.step_to(contact, moving, middle, self.elbow(contact, [here, middle, next]))?;
                self.step_to(contact, moving, next, None)?;
                here = next;
                states.push(moving.state());
            }
            let force_driven = matches!(self.drive, Drive::Force(_));
            answers.push(if force_driven { moving.displacement() } else { moving.force() });
        }
        let work = (moving.dissipated - start).value();
        let cycle = OscillatingCycle::through(contact, &states, work, (&answers, count), self.compliance);
        Ok((cycle, moving.force()))
    }

    /// The amplitude of the displacement where that is given, m.
    fn displaced(&self) -> Option<f64> {
        match self.drive {
            Drive::Displacement(amplitude) if self.compliance <= 0.0 => Some(amplitude),
            _ => None,
        }
    }

    /// Change of the indentation per angle of the drive, m.
    fn sinking(&self, contact: &Contact, angle: f64) -> f64 {
        let swing = -(angle + self.load.phase).sin();
        match self.load.amplitude {
            Normal::Indentation(amplitude) => amplitude * swing,
            Normal::NormalForce(amplitude) => {
                let radius = contact.indenter.radius(self.load_at(contact, angle).0.value());
                amplitude * swing / (2.0 * contact.elasticity.e_star() * radius)
            }
        }
    }

    /// The angles inside a step at which the load turns or slip begins or ends: where d or, if the displacement is
    /// given, W - d or W + d has an extremum.
    fn turns(&self, contact: &Contact, from: f64, to: f64) -> Vec<f64> {
        let signs: &[f64] = if self.displaced().is_some() { &[0.0, 1.0, -1.0] } else { &[0.0] };
        let scaled = self.displaced().map_or(0.0, |amplitude| contact.scaled(amplitude.into()).value());
        let turn = |&sign: &f64| {
            let rate = |angle: f64| -sign * scaled * angle.sin() - self.sinking(contact, angle);
            let rising = rate(from) > 0.0;
            if rising == (rate(to) > 0.0) {
                return None;
            }
            let [low, high] = turning([from, to], |angle| (rate(angle) > 0.0) != rising);
            let margin = SAME_TURN * (to - from);
            (low > from + margin && high < to - margin).then_some(high)
        };
        let mut turns: Vec<f64> = signs.iter().filter_map(turn).collect();
        turns.sort_by(f64::total_cmp);
        turns
    }

    /// The displacement, m, between two straight moves with the integral of U over d of the curve; `None` where it is
    /// not given, or where one of the two would slip otherwise than the curve.
    fn elbow(&self, contact: &Contact, angles: [f64; 3]) -> Option<f64> {
        let amplitude = self.displaced()?;
        let moved = angles.map(|angle| amplitude * angle.cos());
        let levels = angles.map(|angle| self.load_at(contact, angle).0);
        let rates = angles.map(|angle| self.sinking(contact, angle));
        // Simpson's rule.
        let curve =
            (moved[0] * rates[0] + 4.0 * moved[1] * rates[1] + moved[2] * rates[2]) * (angles[2] - angles[0]) / 6.0;
        let [low, high] = [levels[1] - levels[0], levels[2] - levels[1]].map(DoubleDouble::value);
        let elbow = (2.0 * curve - moved[0] * low - moved[2] * high) / (low + high);
        let slips = |middle: f64| {
            let ways = [(middle - moved[0], low), (moved[2] - middle, high)];
            ways.map(|(advance, rise)| [advance > contact.scale() * rise, -advance > contact.scale() * rise])
        };
        let same = low * high > 0.0 && slips(moved[1]) == slips(elbow) && slips(elbow)[0] == slips(elbow)[1];
        same.then_some(elbow)
    }

    /// Moves on to an angle of the drive, or to an elbow beside it.
    fn step_to(&self, contact: &Contact, moving: &mut Contact, angle: f64, elbow: Option<f64>) -> Result<(), Error> {
        let (indentation, normal_force) = self.load_at(contact, angle);
        let limit = contact.friction * normal_force;
        let displacement = match self.drive {
            Drive::Displacement(amplitude) => {
                let target = elbow.unwrap_or(amplitude * angle.cos());
                if self.compliance > 0.0 && limit > 0.0 {
                    self.shared(moving, (indentation, normal_force), target)
                } else {
                    DoubleDouble::from(target)
                }
            }
            Drive::Force(amplitude) => {
                let target = amplitude * angle.cos();
                if target.abs() >= limit && target.abs() > 0.0 {
                    return Err(Error::ForceExceedsFriction { target, limit, part: angle / TAU });
                }
                moving.displacement_for(indentation, normal_force, target)
            }
        };
        moving.advance(&PathPoint { indentation, normal_force, displacement });
        Ok(())
    }

    /// The displacement of the indenter where it and the machine take `target` together, m.
    fn shared(&self, moving: &Contact, (indentation, normal_force): (DoubleDouble, f64), target: f64) -> DoubleDouble {
        let limit = moving.friction * normal_force;
        let at = |force: f64| moving.displacement_for(indentation, normal_force, force);
        let missing = |force: f64| target - self.compliance * force - at(force).value();
        // Just inside the limit; beyond it the contact slides.
        let most = limit * (1.0 - f64::EPSILON);
        let (at_low, at_high) = (missing(-most), missing(most));
        if at_high >= 0.0 || at_low <= 0.0 {
            let force = if at_high >= 0.0 { limit } else { -limit };
            return DoubleDouble::from(target - self.compliance * force);
        }
        at(between([(-most, at_low), (most, at_high)], 4.0 * f64::EPSILON * limit, missing))
    }
}
