//! The moves of a contact: straight ones in one step, curved ones through `curved_move`; and the first part of a move,
//! so that its path can be drawn point by point.

use crate::contact::Contact;
use crate::contact::state::{Move, Normal, Tangential};
use crate::numerics::double_double::DoubleDouble;
use crate::path::curved_move::DEFAULT_TOLERANCE;
use crate::path::curved_path::{CurvedMove, CurvedPath, NormalPath, PathPoint, TangentialPath};
use crate::range;
use crate::range::error::Error;
use crate::slip_history::limit::Coulomb;

impl Contact {
    /// Moves along a straight line, as [`Contact::apply_within`] with [`DEFAULT_TOLERANCE`].
    ///
    /// # Errors
    /// As [`Contact::apply_within`].
    ///
    /// ```
    #[doc = include_str!("../example.txt")]
    /// contact.apply(&slide(0.00375))?;
    /// // Half-way to gross slip (Cattaneo 1938): F = mu F_N (1 - (1 - U/u_max)^(3/2)).
    /// assert!((contact.force() - 2000.0 * (1.0 - 0.5_f64.powf(1.5))).abs() < 1e-9);
    /// # Ok::<(), Error>(())
    /// ```
    pub fn apply(&mut self, step: &Move) -> Result<(), Error> {
        self.apply_within(step, DEFAULT_TOLERANCE)
    }

    /// Moves along a line that is straight in the quantities named. A line in displacement and indentation is exact;
    /// one in a force, while the other quantity changes, is followed to `tolerance`, relative to mu F_N. An error
    /// leaves the contact as it was.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for a target outside [`range`](mod@range); [`Error::ForceExceedsFriction`] for a
    /// tangential force that friction cannot hold all the way; [`Error::BeyondProfile`], [`Error::NotConvexEnough`] and
    /// [`Error::BeyondReferenceLength`] for a normal target that the profile has no contact for, and
    /// [`Error::BulkNeedsConstantLoad`] for any of a line contact with a bulk stress; [`Error::LoadMustBeConstant`]
    /// where the load changes while a contact with a shear strength carries shear.
    ///
    /// ```
    #[doc = include_str!("../example.txt")]
    /// let force = Some(Tangential::Force(1000.0));
    /// let oblique = Move { tangential: force, normal: Some(Normal::NormalForce(8000.0)), ..Move::default() };
    /// contact.apply_within(&oblique, 1e-6)?;
    /// assert!((contact.force() - 1000.0).abs() < 1e-9 && contact.path_error() <= 1e-6);
    /// // Friction holds no more than mu F_N = 4 kN.
    /// let much = Move { tangential: Some(Tangential::Force(4001.0)), ..Move::default() };
    /// assert!(matches!(contact.apply(&much), Err(Error::ForceExceedsFriction { .. })));
    /// # Ok::<(), Error>(())
    /// ```
    pub fn apply_within(&mut self, step: &Move, tolerance: f64) -> Result<(), Error> {
        self.apply_while(step, tolerance, &|| true)
    }

    /// As [`Contact::apply_within`], while `keep_going` returns true: a curved move can take seconds.
    ///
    /// # Errors
    /// As [`Contact::apply_within`], and [`Error::Interrupted`].
    ///
    /// ```
    #[doc = include_str!("../example.txt")]
    /// let force = Some(Tangential::Force(1000.0));
    /// let oblique = Move { tangential: force, normal: Some(Normal::NormalForce(8000.0)), ..Move::default() };
    /// assert_eq!(contact.apply_while(&oblique, 1e-6, &|| false), Err(Error::Interrupted));
    /// assert_eq!(contact.force(), 0.0);
    /// # Ok::<(), Error>(())
    /// ```
    pub fn apply_while(&mut self, step: &Move, tolerance: f64, keep_going: &dyn Fn() -> bool) -> Result<(), Error> {
        self.apply_visited(step, tolerance, keep_going, &mut |_, _| ())
    }

    /// As [`Contact::apply_while`]; `visit` is told the part of the move that is done, from 0 to 1, and the contact at
    /// the end of each of the chords that the move is made of, of which a straight one has one.
    pub(crate) fn apply_visited(
        &mut self,
        step: &Move,
        tolerance: f64,
        keep_going: &dyn Fn() -> bool,
        visit: &mut dyn FnMut(f64, &Contact),
    ) -> Result<(), Error> {
        if self.viscoelastic.is_some() {
            self.apply_with_memory(step, tolerance, keep_going)?;
            visit(1.0, self);
            return Ok(());
        }
        if step.duration > 0.0 {
            return Err(Error::NoMemory);
        }
        if self.law.is_some() || step.twists() {
            self.apply_by_law(step, tolerance, keep_going)?;
            visit(1.0, self);
            return Ok(());
        }
        let normal = self.normal_path(step)?;
        let path = CurvedMove { tangential: self.tangential_path(step)?, normal };
        self.check_limit(&path)?;
        // Without a tangential target the displacement stays, and every path to the new indentation ends in the same
        // state; so does a path at a constant load.
        if step.tangential.is_none() || path.is_straight() {
            self.advance(&path.point(self, 1.0));
            visit(1.0, self);
            return Ok(());
        }
        // A path of many chords can be interrupted half-way.
        let before = self.clone_without_history();
        self.history.mark();
        let followed = self.follow(&path, tolerance, keep_going, visit);
        if followed.is_err() {
            self.history.return_to_mark();
            let history = std::mem::take(&mut self.history);
            *self = Contact { history, ..before };
        }
        self.history.unmark();
        followed
    }

    pub(crate) fn normal_path(&self, step: &Move) -> Result<NormalPath, Error> {
        let here = self.history.edge().level;
        if step.normal.is_some() && self.indenter.line().is_some_and(|line| line.bulk().is_some()) {
            return Err(Error::BulkNeedsConstantLoad);
        }
        Ok(match step.normal {
            None => NormalPath::Indentation { from: here, to: here },
            Some(Normal::Indentation(depth)) => {
                let depth = DoubleDouble::from(depth);
                let to = if step.relative { here + depth } else { depth };
                self.check_indentation(to.value())?;
                NormalPath::Indentation { from: here, to }
            }
            Some(Normal::NormalForce(force)) => {
                let from = self.normal_force();
                let to = range::check_normal_force(if step.relative { from + force } else { force })?;
                // The load that is carried already does not move the edge by the rounding of its indentation.
                if to.to_bits() == from.to_bits() && here.value() >= 0.0 {
                    return Ok(NormalPath::Indentation { from: here, to: here });
                }
                self.check_indentation(self.indentation_for(to).value())?;
                NormalPath::Force { from, to }
            }
        })
    }

    /// Whether the profile has a contact of this indentation, m.
    pub(crate) fn check_indentation(&self, indentation: f64) -> Result<(), Error> {
        range::INDENTATION.check(indentation)?;
        if indentation > 0.0 {
            range::CONTACT_RADIUS.check(self.indenter.check_radius(self.indenter.contact_radius(indentation))?)?;
        }
        Ok(())
    }

    pub(crate) fn tangential_path(&self, step: &Move) -> Result<TangentialPath, Error> {
        let here = self.displacement;
        Ok(match step.tangential {
            None => TangentialPath::Displacement { from: here, to: here },
            Some(Tangential::Displacement(target)) => {
                let target = DoubleDouble::from(target);
                let to = if step.relative { here + target } else { target };
                range::DISPLACEMENT.check(to.value())?;
                TangentialPath::Displacement { from: here, to }
            }
            Some(Tangential::Force(target)) => {
                let from = self.force();
                let to = range::FORCE.check(if step.relative { from + target } else { target })?;
                TangentialPath::Force { from, to }
            }
            Some(Tangential::Twist(_) | Tangential::Torque(_)) => return Err(Error::TwistWithShift),
        })
    }

    /// The move, with absolute targets, to the fraction `part` (0 to 1) of `step`. It is straight in the same
    /// quantities: a sequence of such moves with rising fractions follows the same line. It takes no time.
    ///
    /// ```
    #[doc = include_str!("../example.txt")]
    /// let half = contact.partial_move(&slide(0.002), 0.5);
    /// assert_eq!(half.tangential, Some(Tangential::Displacement(0.001)));
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn partial_move(&self, step: &Move, part: f64) -> Move {
        let towards = |from: f64, target: f64| from + part * if step.relative { target } else { target - from };
        Move {
            tangential: step.tangential.map(|target| match target {
                Tangential::Displacement(to) => Tangential::Displacement(towards(self.displacement.value(), to)),
                Tangential::Force(to) => Tangential::Force(towards(self.force(), to)),
                Tangential::Twist(to) => Tangential::Twist(towards(self.state().twist.unwrap_or(0.0), to)),
                Tangential::Torque(to) => Tangential::Torque(towards(self.state().torque.unwrap_or(0.0), to)),
            }),
            normal: step.normal.map(|target| match target {
                Normal::Indentation(to) => Normal::Indentation(towards(self.indentation(), to)),
                Normal::NormalForce(to) => Normal::NormalForce(towards(self.normal_force(), to)),
            }),
            relative: false,
            duration: 0.0,
        }
    }

    /// How far points slip at most on the way to a point, m: as the indenter moves, and as the bound of slip does.
    pub(crate) fn travel_to(&self, point: &PathPoint) -> f64 {
        let moved = (point.displacement - self.displacement).value().abs();
        let pressed = (point.indentation - self.history.edge().level).value().abs();
        moved + self.scale() * pressed
    }

    /// The straight move in displacement and indentation that every other move is made of.
    pub(crate) fn advance(&mut self, point: &PathPoint) {
        if self.path_error > 0.0 {
            let carried = self.friction * self.normal_force.max(point.normal_force);
            self.work_error += self.path_error * carried * self.travel_to(point);
        }
        self.displacement = point.displacement;
        self.normal_force = point.normal_force;
        let scaled_work =
            self.history.advance(&Coulomb(&self.indenter), point.indentation, self.scaled(point.displacement));
        let scale = self.scale();
        let work = 2.0 * self.elasticity.g_star() * scale * scale * scaled_work;
        self.dissipated = self.dissipated + DoubleDouble::from(work);
        if self.history.slipped_to_one_piece() {
            // Gross slip wipes out the history, and its errors with it.
            self.path_error = 0.0;
            self.path_kernel = 0.0;
        }
    }
}
