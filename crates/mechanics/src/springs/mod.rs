//! The spring foundation of the paper: a discrete solver, independent of the exact one, to compare with.
//!
//! N springs at the midpoints of equal cells over twice the reach (Kraft & Pohrt 2016, section 2): normal stiffness E*
//! dx, tangential stiffness G* dx, each clamped to its own friction bound after every straight move. Forces are good to
//! order N^-2; stresses, from the piecewise linear displacement with an arcosh per cell, to order 1.5 to 2.

mod estimate;
pub(crate) mod law;
pub(crate) mod row;
pub(crate) mod rows;
mod shear_evaluation;
mod stress;
pub(crate) mod twist;

use std::cell::Cell;
use std::sync::Arc;

pub use shear_evaluation::ShearEvaluation;

use crate::contact::Contact;
use crate::contact::normal::ContactSummary;
use crate::contact::state::{Move, Normal, Regime, Setup, State, Tangential};
use crate::numerics::roots::turning;
use crate::profile::Profile;
use crate::range;
use crate::range::error::{Error, UnsupportedMove};

/// A slip up to this, relative to bound and move, is the rounding of displacements.
const NO_SLIP: f64 = 8.0 * f64::EPSILON;

/// A foundation of springs in contact.
#[derive(Clone, Debug)]
pub struct Springs {
    /// The exact contact that the foundation approximates, before its first move.
    virgin: Contact,
    /// The exact contact after the same moves.
    exact: Contact,
    spacing: f64,
    springs: Vec<Spring>,
    displacement: f64,
    indentation: f64,
    dissipated: f64,
    slipped: bool,
    stick_radius: f64,
    /// The largest friction limit, N, and the largest error of a force, N, of all states so far.
    largest_limit: f64,
    largest_force_error: f64,
}

#[derive(Clone, Copy, Debug)]
struct Spring {
    radius: f64,
    level: f64,
    /// How many springs of the row it represents: two, but one at the centre.
    weight: f64,
    carried: f64,
}

/// Springs that are placed between two questions whether to go on.
const SPRINGS_PER_QUESTION: usize = 1024;

/// The largest contact radius, m, on a path, as far as the contact can follow it.
///
/// # Errors
/// Those of [`Contact::new`].
///
/// ```
#[doc = include_str!("../example.txt")]
/// let deeper = Move { normal: Some(Normal::Indentation(0.04)), ..Move::default() };
/// let radius = stickslip_mechanics::springs::largest_contact_radius(&setup, [deeper])?;
/// assert!((radius - 0.2).abs() < 1e-15);
/// # Ok::<(), Error>(())
/// ```
pub fn largest_contact_radius<P: Into<Arc<Profile>> + Clone>(
    setup: &Setup<P>,
    moves: impl IntoIterator<Item = Move>,
) -> Result<f64, Error> {
    let mut contact = Contact::new(setup.clone())?;
    let mut reach = contact.contact_radius();
    for step in moves.into_iter().filter(|step| step.normal.is_some()) {
        if contact.apply(&Move { tangential: None, ..step }).is_err() {
            break;
        }
        reach = reach.max(contact.contact_radius());
    }
    Ok(reach)
}

/// ```
#[doc = include_str!("../example.txt")]
/// let mut springs = Springs::new(setup, 1000, 0.1)?;
/// assert!((springs.normal_force() / contact.normal_force() - 1.0).abs() < 1e-5);
/// springs.apply(&slide(0.00375))?;
/// contact.apply(&slide(0.00375))?;
/// assert!((springs.force() / contact.force() - 1.0).abs() < 1e-5);
/// # Ok::<(), Error>(())
/// ```
impl Springs {
    /// A virgin contact on `count` springs over twice `reach`, m, the largest contact radius to come.
    ///
    /// # Errors
    /// Those of [`Contact::new`], and [`Error::OutOfRange`] by [`range::SPRING_COUNT`].
    pub fn new<P: Into<Arc<Profile>>>(setup: Setup<P>, count: usize, reach: f64) -> Result<Springs, Error> {
        Springs::new_while(setup, count, reach, &|| true)
    }

    /// The same while `keep_going` returns true, which is asked every thousand springs.
    ///
    /// # Errors
    /// As [`Springs::new`], and [`Error::Interrupted`].
    pub fn new_while<P: Into<Arc<Profile>>>(
        setup: Setup<P>,
        count: usize,
        reach: f64,
        keep_going: &dyn Fn() -> bool,
    ) -> Result<Springs, Error> {
        range::SPRING_COUNT.check(count as f64)?;
        let setup = setup.shared();
        setup.profile.check_stress_field()?;
        setup.profile.check_round("the spring foundation")?;
        let contact = Contact::new(setup)?;
        let ContactSummary { indentation, contact_radius, .. } = contact.initial_summary();
        let spacing = 2.0 * reach / count as f64;
        let first = if count.is_multiple_of(2) { 0.5 } else { 0.0 };
        let spring = |index: usize| {
            let radius = (index as f64 + first) * spacing;
            let weight = if radius > 0.0 { 2.0 } else { 1.0 };
            Spring { radius, level: contact.indenter.level(radius), weight, carried: 0.0 }
        };
        let mut springs = Vec::with_capacity(count.div_ceil(2));
        for index in 0..count.div_ceil(2) {
            if index % SPRINGS_PER_QUESTION == 0 && !keep_going() {
                return Err(Error::Interrupted);
            }
            springs.push(spring(index));
        }
        let mut springs = Springs {
            exact: contact.clone(),
            virgin: contact,
            spacing,
            springs,
            displacement: 0.0,
            indentation,
            dissipated: 0.0,
            slipped: false,
            stick_radius: contact_radius,
            largest_limit: 0.0,
            largest_force_error: 0.0,
        };
        springs.note_error(springs.force(), springs.normal_force());
        Ok(springs)
    }

    /// The exact contact that the foundation approximates, before its first move.
    #[must_use]
    pub fn virgin(&self) -> &Contact {
        &self.virgin
    }

    /// Tangential stiffness of a spring, G* dx, N/m.
    fn stiffness(&self) -> f64 {
        self.virgin.elasticity.g_star() * self.spacing
    }

    /// Moves along a straight line. Nothing has changed when an error is returned.
    ///
    /// # Errors
    /// As [`Contact::apply`].
    pub fn apply(&mut self, step: &Move) -> Result<(), Error> {
        self.apply_while(step, &|| true)
    }

    /// The same while `keep_going` returns true, which is asked at each step of the search for a force.
    ///
    /// # Errors
    /// As [`Springs::apply`], and [`Error::Interrupted`].
    pub fn apply_while(&mut self, step: &Move, keep_going: &dyn Fn() -> bool) -> Result<(), Error> {
        if step.twists() {
            return Err(Error::Twisted("the spring foundation"));
        }
        match (step.normal, step.tangential) {
            (Some(Normal::NormalForce(_)), Some(_)) => {
                return Err(Error::Unsupported(UnsupportedMove::NormalForceWithTangentialTarget));
            }
            (Some(Normal::Indentation(_)), Some(Tangential::Force(_))) => {
                return Err(Error::Unsupported(UnsupportedMove::TangentialForceWithNormalTarget));
            }
            _ => {}
        }
        let held = match step.tangential {
            Some(Tangential::Force(target)) => {
                let target = if step.relative { self.force() + target } else { target };
                Some(self.displacement_for(range::FORCE.check(target)?, keep_going)?)
            }
            _ => None,
        };
        match (self.exact.apply(step), held) {
            // Near the limit of friction the springs may hold more than the exact contact.
            (Err(Error::ForceExceedsFriction { .. }), Some(displacement)) => {
                let tangential = Some(Tangential::Displacement(displacement));
                self.exact.apply(&Move { tangential, ..Move::default() })?;
            }
            (applied, _) => applied?,
        }
        self.advance(self.exact.indentation(), held.unwrap_or(self.exact.displacement()));
        Ok(())
    }

    fn advance(&mut self, d1: f64, u1: f64) {
        let scale = self.virgin.scale();
        let (dd, du) = (d1 - self.indentation, u1 - self.displacement);
        let stiffness = self.stiffness();
        let (mut work, mut carried, mut pressed) = (0.0, 0.0, 0.0);
        let mut stick_radius: f64 = 0.0;
        self.slipped = false;
        for spring in &mut self.springs {
            let (before, after) = (self.indentation - spring.level, d1 - spring.level);
            if before <= 0.0 && after <= 0.0 {
                continue;
            }
            // The part of the move in which the spring touches.
            let span = if before <= 0.0 {
                after / dd
            } else if after <= 0.0 {
                before / -dd
            } else {
                1.0
            };
            let trial = spring.carried + du * span;
            let bound = scale * after.max(0.0);
            let slip = trial.abs() - bound;
            if slip > 0.0 {
                let rate = du * trial.signum() - scale * dd;
                let mean = bound - 0.5 * scale * dd * slip / rate;
                work += spring.weight * stiffness * slip * mean;
                spring.carried = bound.copysign(trial);
            } else {
                spring.carried = trial;
            }
            // Where a loop closes, a spring comes back to its bound but for the last digits.
            if slip > NO_SLIP * (bound + (du * span).abs()) {
                self.slipped = true;
            } else {
                stick_radius = stick_radius.max(spring.radius + 0.5 * self.spacing);
            }
            if after > 0.0 {
                carried += spring.weight * spring.carried;
                pressed += spring.weight * after;
            }
        }
        self.dissipated += work;
        self.indentation = d1;
        self.displacement = u1;
        let radius = self.contact_radius();
        self.stick_radius = if self.slipped { stick_radius.min(radius) } else { radius };
        self.note_error(stiffness * carried, self.virgin.elasticity.e_star() * self.spacing * pressed);
    }

    /// The displacement, m, that gives a tangential force, N: bisected, since the force only grows with it.
    fn displacement_for(&self, target: f64, keep_going: &dyn Fn() -> bool) -> Result<f64, Error> {
        let limit = self.virgin.friction * self.normal_force();
        if limit <= 0.0 && target.abs() <= 0.0 {
            return Ok(self.displacement);
        }
        if target.abs() >= limit {
            let way = (target - self.force()).abs();
            // Without friction the force is zero, and the move has no length.
            let part = if way > 0.0 { (limit - target.signum() * self.force()) / way } else { 0.0 };
            return Err(Error::ForceExceedsFriction { target, limit, part: part.clamp(0.0, 1.0) });
        }
        let scale = self.virgin.scale();
        let stiffness = self.stiffness();
        let force_at = |change: f64| -> f64 {
            self.in_contact()
                .map(|spring| {
                    let bound = scale * (self.indentation - spring.level);
                    spring.weight * stiffness * (spring.carried + change).clamp(-bound, bound)
                })
                .sum()
        };
        let widest = 2.0 * scale * self.indentation;
        let stopped = Cell::new(false);
        let [_, change] = turning([-widest, widest], |change| {
            stopped.set(stopped.get() || !keep_going());
            stopped.get() || force_at(change) >= target
        });
        if stopped.get() { Err(Error::Interrupted) } else { Ok(self.displacement + change) }
    }

    fn in_contact(&self) -> impl Iterator<Item = &Spring> {
        self.springs.iter().take_while(|spring| spring.level < self.indentation)
    }

    /// Tangential displacement of the indenter, m.
    #[must_use]
    pub fn displacement(&self) -> f64 {
        self.displacement
    }

    /// Displacement of gross slip on first loading, m, at the present load.
    #[must_use]
    pub fn gross_slip_displacement(&self) -> f64 {
        self.virgin.scale() * self.indentation.max(0.0)
    }

    /// Contact radius a, m.
    #[must_use]
    pub fn contact_radius(&self) -> f64 {
        if self.indentation < 0.0 { 0.0 } else { self.virgin.indenter.radius(self.indentation) }
    }

    /// Tangential force, N.
    #[must_use]
    pub fn force(&self) -> f64 {
        let sum: f64 = self.in_contact().map(|spring| spring.weight * spring.carried).sum();
        self.stiffness() * sum
    }

    /// Normal force, N.
    #[must_use]
    pub fn normal_force(&self) -> f64 {
        let sum: f64 = self.in_contact().map(|spring| spring.weight * (self.indentation - spring.level)).sum();
        self.virgin.elasticity.e_star() * self.spacing * sum
    }

    /// The state after the last move; `memory_depth` counts the springs in contact.
    #[must_use]
    pub fn state(&self) -> State {
        let stiffness = self.stiffness();
        let energy: f64 =
            self.in_contact().map(|spring| 0.5 * spring.weight * stiffness * spring.carried.powi(2)).sum();
        let regime = if self.indentation < 0.0 {
            Regime::Separated
        } else if !self.slipped {
            Regime::Stick
        } else if self.stick_radius > 0.0 {
            Regime::PartialSlip
        } else {
            Regime::GrossSlip
        };
        let conductance = self.virgin.conductance(self.indentation);
        State {
            displacement: self.displacement,
            force: self.force() + 0.0,
            indentation: self.indentation,
            normal_force: self.normal_force(),
            contact_radius: self.contact_radius(),
            stick_radius: if self.indentation < 0.0 { 0.0 } else { self.stick_radius },
            regime,
            dissipated_energy: self.dissipated,
            elastic_energy: energy,
            memory_depth: self.in_contact().count(),
            electrical_conductance: conductance.electrical,
            thermal_conductance: conductance.thermal,
            ..State::default()
        }
    }
}
