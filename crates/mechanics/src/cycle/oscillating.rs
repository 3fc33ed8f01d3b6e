//! Steady cycles under a load that oscillates too: stepped with the exact memory until they close.
//!
//! The drive is S0 cos(t), the load N + dN cos(t + phase). Such a path is curved. Where the displacement is given it is
//! followed as curved moves are (`path/curved_move.rs`), in stretches that end at equal steps of t and where the load
//! turns: the integral of W over d of a pair of chords is that of the curve by Simpson's rule, and what is left falls
//! with the fourth power of the step. Driven by a force, or through a machine, the path is followed by chords between
//! its points, and it falls with the square. The steps are halved until two results agree.

use std::f64::consts::{PI, TAU};

use super::Drive;
use super::lap::OscillatingCycle;
use crate::contact::Contact;
use crate::contact::state::Normal;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::roots::between;
use crate::path::curved_path::{CurvedPath, PathPoint};
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
/// Where the load turns closer than this part of a step to its end, it turns there.
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

    /// The indentation, m, at an angle of the drive.
    fn indentation_at(&self, contact: &Contact, angle: f64) -> DoubleDouble {
        match self.load.amplitude {
            Normal::NormalForce(_) => contact.indentation_for(self.normal_force_at(contact, angle)),
            Normal::Indentation(amplitude) => {
                contact.history.edge().level + DoubleDouble::from(amplitude * (angle + self.load.phase).cos())
            }
        }
    }

    /// The normal force there, N.
    fn normal_force_at(&self, contact: &Contact, angle: f64) -> f64 {
        match self.load.amplitude {
            Normal::NormalForce(amplitude) => {
                (contact.normal_force + amplitude * (angle + self.load.phase).cos()).max(0.0)
            }
            Normal::Indentation(_) => contact.normal_force_at(self.indentation_at(contact, angle)),
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
        Swing { oscillation: self, contact, angles: [0.0; 2] }.chord_to(&mut moving, 1.0)?;
        let unit = self.force_unit(contact);
        let (mut before, mut end) = self.lap(contact, &mut moving, (steps, count), keep_going)?;
        for _ in 1..CYCLES {
            let (mut lap, ends) = self.lap(contact, &mut moving, (steps, count), keep_going)?;
            let most = (4.0 * unit * lap.displacement_amplitude).max(f64::MIN_POSITIVE);
            let work = (lap.dissipated_energy - before.dissipated_energy).abs() / most;
            let change = work.max((ends - end).abs() / unit.max(f64::MIN_POSITIVE));
            // Under a driven displacement a cycle clamps each spring to the same bounds again: the first one closes.
            lap.error = if self.displaces() { 0.0 } else { change };
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
            let angle = |step: usize| TAU * step as f64 / steps as f64;
            let [mut here, to] = [angle(2 * index - 2), angle(2 * index)];
            for next in self.turn([here, to]).into_iter().chain([to]) {
                let stretch = Swing { oscillation: self, contact, angles: [here, next] };
                if self.displaces() {
                    moving.follow(&stretch, f64::INFINITY, keep_going, &mut |_, _| ())?;
                } else if keep_going() {
                    stretch.chord_to(moving, 0.5)?;
                    stretch.chord_to(moving, 1.0)?;
                } else {
                    return Err(Error::Interrupted);
                }
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

    /// Whether the displacement of the indenter is given.
    fn displaces(&self) -> bool {
        matches!(self.drive, Drive::Displacement(_)) && self.compliance <= 0.0
    }

    /// Change of the indentation per angle of the drive, m.
    fn sinking(&self, contact: &Contact, angle: f64) -> f64 {
        let swing = -(angle + self.load.phase).sin();
        match self.load.amplitude {
            Normal::Indentation(amplitude) => amplitude * swing,
            Normal::NormalForce(amplitude) => {
                let radius = contact.indenter.radius(self.indentation_at(contact, angle).value());
                amplitude * swing / (2.0 * contact.elasticity.e_star() * radius)
            }
        }
    }

    /// The angle inside a step at which the load turns.
    fn turn(&self, [from, to]: [f64; 2]) -> Option<f64> {
        let turn = ((from + self.load.phase) / PI).ceil() * PI - self.load.phase;
        let margin = SAME_TURN * (to - from);
        (turn > from + margin && turn < to - margin).then_some(turn)
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

/// The path between two angles of the drive.
struct Swing<'a> {
    oscillation: &'a Oscillation,
    /// Under the mean load.
    contact: &'a Contact,
    angles: [f64; 2],
}

impl Swing<'_> {
    fn angle(&self, part: f64) -> f64 {
        let [from, to] = self.angles;
        if part < 1.0 { from + part * (to - from) } else { to }
    }

    /// Moves straight to a point of the path, at which friction must hold a driven force.
    fn chord_to(&self, moving: &mut Contact, part: f64) -> Result<(), Error> {
        if let Drive::Force(amplitude) = self.oscillation.drive {
            let (target, limit) =
                (amplitude * self.angle(part).cos(), moving.friction * self.normal_force(moving, part));
            if target.abs() >= limit && target.abs() > 0.0 {
                return Err(Error::ForceExceedsFriction { target, limit, part: self.angle(part) / TAU });
            }
        }
        moving.advance(&self.point(moving, part));
        Ok(())
    }
}

impl CurvedPath for Swing<'_> {
    fn normal_force(&self, _moving: &Contact, part: f64) -> f64 {
        self.oscillation.normal_force_at(self.contact, self.angle(part))
    }

    fn point(&self, moving: &Contact, part: f64) -> PathPoint {
        let indentation = self.oscillation.indentation_at(self.contact, self.angle(part));
        let normal_force = self.normal_force(moving, part);
        let swing = self.angle(part).cos();
        let displacement = match self.oscillation.drive {
            Drive::Displacement(amplitude)
                if self.oscillation.compliance > 0.0 && moving.friction * normal_force > 0.0 =>
            {
                self.oscillation.shared(moving, (indentation, normal_force), amplitude * swing)
            }
            Drive::Displacement(amplitude) => DoubleDouble::from(amplitude * swing),
            Drive::Force(amplitude) => moving.displacement_for(indentation, normal_force, amplitude * swing),
        };
        PathPoint { indentation, normal_force, displacement }
    }

    fn rate(&self, part: f64) -> Option<f64> {
        let [from, to] = self.angles;
        Some((to - from) * self.oscillation.sinking(self.contact, self.angle(part)))
    }
}
