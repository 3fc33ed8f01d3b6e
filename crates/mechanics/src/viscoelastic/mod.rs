//! Bodies with memory: elastomers, gels, polymers, whose moduli relax as one Prony series (constant Poisson's ratio).
//!
//! For each x the pressure of the plane contact is q(t) = int R(t - s) dw(s) inside, where w = d(t) - g(x), and zero
//! outside, where w relaxes freely (Lee & Radok 1960; Ting 1966; Argatov & Popov 2016); tangentially the same within
//! +-mu q. Since the transforms between x and r are pointwise, that is the half-space problem at every instant as long
//! as the contact is a disc and slip an outer annulus of one sign, which each step tests. Superposition does not hold,
//! so there is no slip history: springs step it ([`Rows`]).
//!
//! A step that is straight in d and U is exact for each spring. What is not is the sum over springs, and a path that is
//! straight in a force: then the step is halved until d or U is straight enough.

pub(crate) mod prony;
pub(crate) mod steady;
#[cfg(test)]
mod tests;

use std::sync::Arc;

pub use prony::{MOST_TERMS, Prony, PronyTerm};

use crate::range;
use crate::range::error::Error;
use crate::springs::law::{CoulombLaw, SpringLaw};
use crate::springs::row::{Led, Scratch, Slides};
use crate::springs::rows::Rows;

/// Springs from the centre to the edge of the largest contact so far, some more or less.
pub(crate) const SPRINGS: usize = 1024;
/// How far a step may be from straight where nothing but instants depends on it, over the limits of friction and load.
const BEND: f64 = 0.05;
/// Steps after which the tolerance of a move is doubled, so that every move ends.
const PATIENCE: usize = 2_000;
/// The first step of a load that begins at zero, where the indentation begins vertically.
const FIRST_TOUCH: f64 = 1e-3;
/// The least part of a move that is a step, whatever its error.
const LEAST_PART: f64 = 1e-13;

/// A quantity along a move.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Course {
    /// An indentation or a displacement, m.
    Place { from: f64, to: f64 },
    /// A force, N.
    Force { from: f64, to: f64 },
}

/// A move of a contact with memory.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Leg {
    pub(crate) normal: Course,
    pub(crate) tangential: Course,
    /// s.
    pub(crate) duration: f64,
}

/// A contact with memory.
#[derive(Clone, Debug)]
pub(crate) struct Viscoelastic {
    pub(crate) prony: Arc<Prony>,
    pub(crate) rows: Rows,
}

impl Course {
    fn at(self, part: f64) -> f64 {
        let (Course::Place { from, to } | Course::Force { from, to }) = self;
        if part < 1.0 { from + part * (to - from) } else { to }
    }

    fn led(self, part: f64) -> Led {
        match self {
            Course::Place { .. } => Led::Place(self.at(part)),
            Course::Force { .. } => Led::Sum(self.at(part)),
        }
    }

    fn is_force(self) -> bool {
        matches!(self, Course::Force { .. })
    }

    fn is_still(self) -> bool {
        let (Course::Place { from, to } | Course::Force { from, to }) = self;
        from.to_bits() == to.to_bits()
    }
}

impl Rows {
    /// Bodies that are pressed together at once on so many springs, at an indentation, m, to a contact radius, m.
    pub(crate) fn pressed(law: &CoulombLaw<'_>, count: usize, [indentation, radius]: [f64; 2]) -> Rows {
        let law = SpringLaw::Coulomb(*law);
        let mut rows = Rows::new(&law, count, [indentation, radius]);
        rows.note_error(&law);
        rows
    }

    /// Follows a leg; nothing has changed when an error is returned.
    pub(crate) fn follow(
        &mut self,
        law: &CoulombLaw<'_>,
        leg: &Leg,
        tolerance: f64,
        keep_going: &dyn Fn() -> bool,
    ) -> Result<(), Error> {
        let slip_from = self.slip_from.take();
        let before = self.clone();
        let followed = self.steps_along(&before, law, leg, tolerance, keep_going);
        if followed.is_err() {
            *self = before;
            self.slip_from = slip_from;
        }
        followed
    }

    fn steps_along(
        &mut self,
        before: &Rows,
        law: &CoulombLaw<'_>,
        leg: &Leg,
        tolerance: f64,
        keep_going: &dyn Fn() -> bool,
    ) -> Result<(), Error> {
        let curved = leg.normal.is_force() && !leg.tangential.is_still() || leg.tangential.is_force();
        let straight = leg.duration <= 0.0 && (!curved || leg.normal.is_still());
        let forced = leg.normal.is_force() || leg.tangential.is_force();
        let shortest = law.prony.shortest_time();
        let mut stride = match (straight, leg.duration > 0.0) {
            (true, _) => 1.0,
            (false, true) => (0.25 * shortest / leg.duration).min(if forced { 0.25 } else { 1.0 }),
            (false, false) => 0.125,
        };
        if leg.normal.is_force() && self.fine.sums[0] <= 0.0 && !straight {
            stride = stride.min(FIRST_TOUCH);
        }
        let (mut part, mut count) = (0.0, 0usize);
        let began = self.time;
        let (mut scratch, mut last) = ([Scratch::default(), Scratch::default()], None);
        while part < 1.0 {
            if !keep_going() {
                return Err(Error::Interrupted);
            }
            let end = if part + 1.01 * stride >= 1.0 { 1.0 } else { part + stride };
            let allowed = tolerance * 2.0_f64.powi(i32::try_from(count / PATIENCE).unwrap_or(i32::MAX).min(40));
            if !straight && part > 0.0 {
                let kept: &mut Rows = last.get_or_insert_with(|| self.clone());
                kept.take_from(self);
            }
            let (bend, exact) = self.step_along(law, leg, [part, end], &mut scratch)?;
            // Over what it may be; a path that is straight in d and U is exact.
            let excess = (bend / allowed).max(exact / BEND);
            if !straight && excess > 1.0 && end - part > LEAST_PART {
                self.take_from(last.as_ref().filter(|_| part > 0.0).unwrap_or(before));
                stride = (end - part) * (0.8 / excess.sqrt()).clamp(0.1, 0.6);
                continue;
            }
            stride = (end - part) * (0.8 / excess.sqrt().max(1e-9)).clamp(0.5, 3.0).max(f64::EPSILON);
            part = end;
            count += 1;
            if !straight {
                self.note_path(bend);
            }
            self.note_difference(&SpringLaw::Coulomb(*law));
        }
        self.note_error(&SpringLaw::Coulomb(*law));
        self.time = began + leg.duration;
        Ok(())
    }

    /// A step of the coarse row and two of the fine one. How far d or U is from straight where a force leads it, and a
    /// force where it does not, over load and limit of friction.
    fn step_along(
        &mut self,
        coulomb: &CoulombLaw<'_>,
        leg: &Leg,
        [begin, end]: [f64; 2],
        scratch: &mut [Scratch; 2],
    ) -> Result<(f64, f64), Error> {
        let law = &SpringLaw::Coulomb(*coulomb);
        let middle = 0.5 * (begin + end);
        let led = |part: f64| [leg.normal.led(part), leg.tangential.led(part)];
        let refused = |(index, Slides(limit))| Error::ForceExceedsFriction {
            target: leg.tangential.at(1.0),
            limit,
            part: [middle, end][index],
        };
        let first = self.fine.state();
        let time = (end - begin) * leg.duration;
        let [half, last] = self.step(law, time, [led(middle), led(end)], scratch).map_err(refused)?;
        for row in [&self.fine, &self.coarse] {
            if row.indentation > 0.0 {
                let radius = coulomb.indenter.contact_radius(row.indentation);
                range::CONTACT_RADIUS.check(coulomb.indenter.check_radius(radius)?)?;
            }
            range::INDENTATION.check(row.indentation)?;
            range::DISPLACEMENT.check(row.position)?;
        }
        let bend = |of: usize| (half[of] - 0.5 * (first[of] + last[of])).abs();
        let stiffness = law.stiffness(self.fine.radius(law));
        let load = self.largest[0].max(last[2]);
        let (mut followed, mut free) = (0.0_f64, 0.0_f64);
        let parts = [(leg.normal, load), (leg.tangential, coulomb.friction * load)];
        for (side, (course, unit)) in parts.into_iter().enumerate().filter(|(_, (_, unit))| *unit > f64::MIN_POSITIVE) {
            if course.is_force() {
                // Without a load the bodies are brought together at once.
                let bend = if first[2] > 0.0 { bend(side) } else { 0.0 };
                followed = followed.max(bend * stiffness[side] / unit);
            } else {
                free = free.max(bend(2 + side) / unit);
            }
        }
        Ok((followed, free))
    }
}
