//! Bodies with memory: elastomers, gels, polymers, whose moduli relax as one Prony series (constant Poisson's ratio).
//!
//! For each x the pressure of the plane contact is q(t) = int R(t - s) dw(s) inside, where w = d(t) - g(x), and zero
//! outside, where w relaxes freely (Lee & Radok 1960; Ting 1966; Argatov & Popov 2016); tangentially the same within
//! +-mu q. Since the transforms between x and r are pointwise, that is the half-space problem at every instant as long
//! as the contact is a disc and slip an outer annulus of one sign, which each step tests. Superposition does not hold,
//! so there is no slip history: springs step it ([`Rows`]).
//!
//! A step that is straight in d and U is exact for each spring. What is not is the sum over springs, and a path that is
//! straight in a force: then d or U follows a parabola in each step, whose curvature is extrapolated from the steps
//! before, and steps are as long as the tolerance allows for the difference from what the forces then ask for.

pub(crate) mod kernel;
pub(crate) mod prony;
pub(crate) mod steady;
#[cfg(test)]
mod tests;

use std::sync::Arc;

pub use prony::{MOST_TERMS, Prony, PronyTerm};

use crate::range;
use crate::range::error::Error;
use crate::springs::law::{CoulombLaw, SpringLaw};
use crate::springs::row::Slides;
use crate::springs::rows::{Course, Rows, Walk};

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

/// A move of a contact with memory.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Leg {
    pub(crate) normal: Course,
    pub(crate) tangential: Course,
    /// s.
    pub(crate) duration: f64,
}

/// How far d and U are from straight in the middle of steps, m, over the square of the part of the leg that each is.
#[derive(Clone, Copy, Debug, Default)]
struct Curvature {
    /// At the middle of the last step before, and of the last one, in parts of the leg.
    known: [Option<(f64, [f64; 2])>; 2],
    /// Of the last step that was accurate enough.
    accepted: Option<(f64, [f64; 2])>,
}

/// A contact with memory.
#[derive(Clone, Debug)]
pub(crate) struct Viscoelastic {
    pub(crate) prony: Arc<Prony>,
    pub(crate) rows: Rows,
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
        let (mut part, mut count, mut walk) = (0.0, 0usize, Walk::from(self));
        let mut curvature = Curvature::default();
        while part < 1.0 {
            if !keep_going() {
                return Err(Error::Interrupted);
            }
            let end = if part + 1.01 * stride >= 1.0 { 1.0 } else { part + stride };
            let allowed = tolerance * 2.0_f64.powi(i32::try_from(count / PATIENCE).unwrap_or(i32::MAX).min(40));
            let (bends, error, bend) = walk.step_along(law, leg, [part, end], &curvature)?;
            // Over what it may be; a path that is straight in d and U is exact.
            let excess = (error / allowed).max(bend / BEND);
            let again = !straight && excess > 1.0 && end - part > LEAST_PART;
            curvature.note([part, end], bends, !again);
            let pace = 0.8 / (error / allowed).powf(0.25).max((bend / BEND).sqrt()).max(1e-9);
            if again {
                stride = (end - part) * pace.clamp(0.1, 0.6);
                continue;
            }
            stride = (end - part) * pace.clamp(0.5, 3.0).max(f64::EPSILON);
            part = end;
            count += 1;
            if !straight {
                walk.next.note_path(error);
            }
            walk.next.note_difference(&SpringLaw::Coulomb(*law));
            walk.accept();
        }
        let mut after = walk.end();
        after.note_error(&SpringLaw::Coulomb(*law));
        after.time += leg.duration;
        *self = after;
        Ok(())
    }
}

impl Curvature {
    /// How far d and U are from straight in the middle of a part of the leg, m, by linear extrapolation.
    fn bow(&self, [begin, end]: [f64; 2]) -> [f64; 2] {
        let (middle, square) = (0.5 * (begin + end), (end - begin) * (end - begin));
        let curvature = match self.known {
            [Some((first, old)), Some((last, new))] => {
                [0, 1].map(|side| new[side] + (new[side] - old[side]) * (middle - last) / (last - first))
            }
            [None, Some((_, new))] => new,
            _ => [0.0; 2],
        };
        curvature.map(|of| of * square)
    }

    fn note(&mut self, [begin, end]: [f64; 2], bends: [f64; 2], accepted: bool) {
        let square = (end - begin) * (end - begin);
        self.known = [self.accepted, Some((0.5 * (begin + end), bends.map(|bend| bend / square)))];
        if accepted {
            self.accepted = self.known[1];
        }
    }
}

impl Walk<'_> {
    /// A step of the coarse row and two of the fine one, along parabolas. How far d and U are from straight where a
    /// force is prescribed, m; the force by which the parabolas of the fine row differ from that, and how far a force
    /// is from straight where it is not prescribed, over load and limit of friction.
    fn step_along(
        &mut self,
        coulomb: &CoulombLaw<'_>,
        leg: &Leg,
        [begin, end]: [f64; 2],
        curvature: &Curvature,
    ) -> Result<([f64; 2], f64, f64), Error> {
        let law = &SpringLaw::Coulomb(*coulomb);
        let middle = 0.5 * (begin + end);
        let bow = curvature.bow([begin, end]);
        let led = |from: f64, to: f64| ([leg.normal.led(to), leg.tangential.led(to)], curvature.bow([from, to]));
        let refused = |(index, Slides(limit))| Error::ForceExceedsFriction {
            target: leg.tangential.at(1.0),
            limit,
            part: [middle, end][index],
        };
        let (first, largest) = (self.here().fine.state(), self.here().largest[0]);
        let time = (end - begin) * leg.duration;
        let [half, last] = self.step(law, time, [led(begin, middle), led(middle, end)], bow).map_err(refused)?;
        for row in [&self.next.fine, &self.next.coarse] {
            if row.indentation > 0.0 {
                let radius = coulomb.indenter.contact_radius(row.indentation);
                range::CONTACT_RADIUS.check(coulomb.indenter.check_radius(radius)?)?;
            }
            range::INDENTATION.check(row.indentation)?;
            range::DISPLACEMENT.check(row.position)?;
        }
        let bend = |of: usize| half[of] - 0.5 * (first[of] + last[of]);
        let stiffness = law.stiffness(self.next.fine.radius(law));
        let load = largest.max(last[2]);
        let (mut bends, mut followed, mut free) = ([0.0; 2], 0.0_f64, 0.0_f64);
        let parts = [(leg.normal, load), (leg.tangential, coulomb.friction * load)];
        for (side, (course, unit)) in parts.into_iter().enumerate().filter(|(_, (_, unit))| *unit > f64::MIN_POSITIVE) {
            // Without a load the bodies are brought together at once.
            if course.is_force() && first[2] > 0.0 {
                bends[side] = bend(side);
                // A step of half the length is a quarter as far from it.
                followed = followed.max(0.25 * (bends[side] - bow[side]).abs() * stiffness[side] / unit);
            } else if !course.is_force() {
                free = free.max(bend(2 + side).abs() / unit);
            }
        }
        Ok((bends, followed, free))
    }
}
