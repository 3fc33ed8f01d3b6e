//! Bodies with memory: elastomers, gels, polymers, whose moduli relax as one Prony series (constant Poisson's ratio).
//!
//! For each x the pressure of the plane contact is q(t) = int R(t - s) dw(s) inside, where w = d(t) - g(x), and zero
//! outside, where w relaxes freely (Lee & Radok 1960; Ting 1966; Argatov & Popov 2016); tangentially the same within
//! +-mu q. Since the transforms between x and r are pointwise, that is the half-space problem at every instant as long
//! as the contact is a disc and slip an outer annulus of one sign, which each step tests. Superposition does not hold,
//! so there is no slip history: a row of springs is stepped ([`row`]).
//!
//! A step that is straight in d and U is exact for each spring. What is not is the sum over springs, and a path that is
//! straight in a force: then the step is halved until d or U is straight enough. Another row of half as many springs
//! makes the same path in steps twice as long, and the difference of the two is the stated error.

mod prony;
mod row;
pub(crate) mod steady;
#[cfg(test)]
mod tests;

use std::sync::Arc;

pub use prony::{MOST_TERMS, Prony, PronyTerm};
use row::{Led, Row};

use crate::indenter::Indenter;
use crate::numerics::packing::{Packed, Reader};
use crate::range::error::Error;

/// Springs from the centre to the edge of the largest contact so far, some more or less.
const SPRINGS: usize = 1024;
/// How far a step may be from straight where nothing but instants depends on it, over the limits of friction and load.
const BEND: f64 = 0.05;
/// Steps after which the tolerance of a move is doubled, so that every move ends.
const PATIENCE: usize = 2_000;
/// The first step of a load that begins at zero, where the indentation begins vertically.
const FIRST_TOUCH: f64 = 1e-3;
/// An error that says that nothing is known.
const MOST_ERROR: f64 = 1e6;
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

/// What springs are made of.
#[derive(Clone, Copy)]
pub(crate) struct Material<'a> {
    pub(crate) indenter: &'a Indenter,
    /// 2 E* and 2 G*, Pa.
    pub(crate) stiffness: [f64; 2],
    pub(crate) friction: f64,
}

/// A contact with memory.
#[derive(Clone, Debug)]
pub(crate) struct Viscoelastic {
    pub(crate) prony: Arc<Prony>,
    fine: Row,
    coarse: Row,
    pub(crate) time: f64,
    /// The place from which on the last move slipped, m, if it did.
    pub(crate) slip_from: Option<f64>,
    pub(crate) beyond: bool,
    pub(crate) steps: usize,
    largest_load: f64,
    /// Of the forces, over the largest load and its limit of friction.
    pub(crate) force_error: f64,
    /// The part of it that comes from paths straight in a force.
    pub(crate) path_error: f64,
}

impl Course {
    fn at(self, part: f64) -> f64 {
        let (Course::Place { from, to } | Course::Force { from, to }) = self;
        if part < 1.0 { from + part * (to - from) } else { to }
    }

    fn led(self, part: f64, stiffness: f64) -> Led {
        match self {
            Course::Place { .. } => Led::Place(self.at(part)),
            Course::Force { .. } => Led::Sum(self.at(part) / stiffness),
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

impl Viscoelastic {
    /// Bodies that are first pressed together at this indentation, m, to a contact radius, m.
    pub(crate) fn new(prony: Arc<Prony>, material: &Material<'_>, indentation: f64, radius: f64) -> Viscoelastic {
        Viscoelastic::on(SPRINGS, prony, material, [indentation, radius])
    }

    /// The same on rows of this many springs, and half as many.
    fn on(count: usize, prony: Arc<Prony>, material: &Material<'_>, [indentation, radius]: [f64; 2]) -> Viscoelastic {
        let mut rows = [count, count / 2].map(|count| Row::new(count, 0.0));
        for row in &mut rows {
            row.reach(material.indenter, &prony, radius);
            let (at, still) = (Led::Place(indentation), Led::Place(0.0));
            // A displacement that stays is held.
            let _ = row.step(&prony, (material.indenter, 0.0), 0.0, at, still);
        }
        let [fine, coarse] = rows;
        let mut contact = Viscoelastic {
            prony,
            fine,
            coarse,
            time: 0.0,
            slip_from: None,
            beyond: false,
            steps: 0,
            largest_load: 0.0,
            force_error: 0.0,
            path_error: 0.0,
        };
        contact.note_error(material);
        contact
    }

    pub(crate) fn indentation(&self) -> f64 {
        self.fine.indentation
    }

    pub(crate) fn displacement(&self) -> f64 {
        self.fine.displacement
    }

    /// Normal and tangential force, N.
    pub(crate) fn forces(&self, material: &Material<'_>) -> [f64; 2] {
        let [p, q] = self.fine.sums();
        [p * material.stiffness[0], q * material.stiffness[1]]
    }

    /// Contact radius, m.
    pub(crate) fn radius(&self, indenter: &Indenter) -> f64 {
        self.fine.radius(&self.prony, indenter)
    }

    /// Springs from the centre to the edge of the row.
    pub(crate) fn count(&self) -> usize {
        self.fine.count
    }

    /// Friction work, the work of the tangential force, and the energy of the tangential deformation, J.
    pub(crate) fn energies(&self, material: &Material<'_>) -> [f64; 3] {
        let unit = material.stiffness[1];
        [self.fine.friction_work * unit, self.fine.work * unit, 0.5 * self.fine.energy(&self.prony) * unit]
    }

    pub(crate) fn heap_bytes(&self) -> usize {
        let rows = self.fine.count + self.coarse.count;
        size_of::<Viscoelastic>() + rows * (4 + 2 * self.prony.terms().len()) * size_of::<f64>()
    }

    /// Follows a leg; nothing has changed when an error is returned.
    pub(crate) fn follow(
        &mut self,
        material: &Material<'_>,
        leg: &Leg,
        tolerance: f64,
        keep_going: &dyn Fn() -> bool,
    ) -> Result<(), Error> {
        let before = self.clone();
        let followed = self.steps_along(&before, material, leg, tolerance, keep_going);
        if followed.is_err() {
            *self = before;
        }
        followed
    }

    fn steps_along(
        &mut self,
        before: &Viscoelastic,
        material: &Material<'_>,
        leg: &Leg,
        tolerance: f64,
        keep_going: &dyn Fn() -> bool,
    ) -> Result<(), Error> {
        let curved = leg.normal.is_force() && !leg.tangential.is_still() || leg.tangential.is_force();
        let straight = leg.duration <= 0.0 && (!curved || leg.normal.is_still());
        let forced = leg.normal.is_force() || leg.tangential.is_force();
        let shortest = self.prony.shortest_time();
        let mut stride = match (straight, leg.duration > 0.0) {
            (true, _) => 1.0,
            (false, true) => (0.25 * shortest / leg.duration).min(if forced { 0.25 } else { 1.0 }),
            (false, false) => 0.125,
        };
        if leg.normal.is_force() && self.forces(material)[0] <= 0.0 && !straight {
            stride = stride.min(FIRST_TOUCH);
        }
        let (mut part, mut count) = (0.0, 0usize);
        let began = self.time;
        self.slip_from = None;
        while part < 1.0 {
            if !keep_going() {
                return Err(Error::Interrupted);
            }
            let end = if part + 1.01 * stride >= 1.0 { 1.0 } else { part + stride };
            let allowed = tolerance * 2.0_f64.powi(i32::try_from(count / PATIENCE).unwrap_or(i32::MAX).min(40));
            let rows = (!straight && part > 0.0).then(|| (self.fine.clone(), self.coarse.clone()));
            let (bend, exact, slip_from, beyond) = self.step(material, leg, [part, end])?;
            // Over what it may be; a path that is straight in d and U is exact.
            let excess = (bend / allowed).max(exact / BEND);
            if !straight && excess > 1.0 && end - part > LEAST_PART {
                (self.fine, self.coarse) = rows.unwrap_or_else(|| (before.fine.clone(), before.coarse.clone()));
                stride = (end - part) * (0.8 / excess.sqrt()).clamp(0.1, 0.6);
                continue;
            }
            stride = (end - part) * (0.8 / excess.sqrt().max(1e-9)).clamp(0.5, 3.0).max(f64::EPSILON);
            part = end;
            count += 1;
            self.steps += 2;
            self.path_error = self.path_error.max(if straight { 0.0 } else { bend.min(MOST_ERROR) });
            self.slip_from = match (self.slip_from, slip_from) {
                (Some(one), Some(other)) => Some(one.min(other)),
                (one, other) => one.or(other),
            };
            self.beyond |= beyond;
            self.note_error(material);
        }
        self.time = began + leg.duration;
        Ok(())
    }

    /// A step of the coarse row and two of the fine one. How far d or U is from straight where a force leads it, and a
    /// force where it does not, over load and limit of friction; the place of slip; whether a condition is broken.
    fn step(
        &mut self,
        material: &Material<'_>,
        leg: &Leg,
        [begin, end]: [f64; 2],
    ) -> Result<(f64, f64, Option<f64>, bool), Error> {
        let prony = Arc::clone(&self.prony);
        let scale = material.friction * material.stiffness[0] / material.stiffness[1];
        let state = |row: &Row| {
            let [p, q] = row.sums();
            [row.indentation, row.displacement, p, q]
        };
        let led =
            |part: f64| (leg.normal.led(part, material.stiffness[0]), leg.tangential.led(part, material.stiffness[1]));
        let refused = |row::Slides(limit), part: f64| Error::ForceExceedsFriction {
            target: leg.tangential.at(1.0),
            limit: limit * material.stiffness[1],
            part,
        };
        let go = |row: &mut Row, from: f64, to: f64| {
            let (normal, tangential) = led(to);
            let time = (to - from) * leg.duration;
            let slipped = row.step(&prony, (material.indenter, scale), time, normal, tangential);
            let slipped = slipped.map_err(|slides| refused(slides, to))?;
            if row.indentation > 0.0 {
                let radius = material.indenter.contact_radius(row.indentation);
                crate::range::CONTACT_RADIUS.check(material.indenter.check_radius(radius)?)?;
            }
            crate::range::INDENTATION.check(row.indentation)?;
            crate::range::DISPLACEMENT.check(row.displacement)?;
            Ok::<_, Error>(slipped)
        };
        let middle = 0.5 * (begin + end);
        let first = state(&self.fine);
        let one = go(&mut self.fine, begin, middle)?;
        let half = state(&self.fine);
        let two = go(&mut self.fine, middle, end)?;
        let last = state(&self.fine);
        go(&mut self.coarse, begin, end)?;
        let bend = |of: usize| (half[of] - 0.5 * (first[of] + last[of])).abs();
        let radius = self.radius(material.indenter);
        let load = (self.largest_load / material.stiffness[0]).max(last[2]).max(f64::MIN_POSITIVE);
        let limit = (scale * load).max(f64::MIN_POSITIVE);
        let (mut followed, mut free) = (0.0_f64, 0.0_f64);
        let parts = [(leg.normal, 0, 2, load), (leg.tangential, 1, 3, limit)];
        for (course, place, force, unit) in parts {
            if unit > f64::MIN_POSITIVE {
                if course.is_force() {
                    // Without a load the bodies are brought together at once.
                    let bend = if first[2] > 0.0 { bend(place) } else { 0.0 };
                    followed = followed.max(bend * radius / unit);
                } else {
                    free = free.max(bend(force) / unit);
                }
            }
        }
        let slip_from = [one, two].into_iter().filter(|slipped| slipped.any).map(|slipped| slipped.from);
        Ok((followed, free, slip_from.reduce(f64::min), one.beyond || two.beyond))
    }

    /// Takes the present state into the stated error.
    fn note_error(&mut self, material: &Material<'_>) {
        let (fine, coarse, least) = (self.fine.sums(), self.coarse.sums(), self.fine.bends());
        self.largest_load = self.largest_load.max(fine[0] * material.stiffness[0]);
        let radius = self.radius(material.indenter);
        let scale = material.friction * material.stiffness[0] / material.stiffness[1];
        let load = self.largest_load / material.stiffness[0];
        let apart = [
            (self.fine.indentation - self.coarse.indentation, load),
            (self.fine.displacement - self.coarse.displacement, scale * load),
        ];
        for (side, (apart, unit)) in apart.into_iter().enumerate() {
            if unit > 0.0 {
                let error = ((fine[side] - coarse[side]).abs() + radius * apart.abs()).max(least[side]);
                self.force_error = self.force_error.max((error / unit).min(MOST_ERROR));
            }
        }
    }

    /// All that a move changes, as numbers.
    pub(crate) fn pack(&self, bytes: &mut Vec<u8>) {
        let beyond = f64::from(u8::from(self.beyond));
        let slip_from = self.slip_from.unwrap_or(-1.0);
        let numbers = [self.time, slip_from, beyond, self.steps as f64, self.largest_load, self.force_error];
        numbers.iter().chain([&self.path_error]).for_each(|number| number.pack(bytes));
        for row in [&self.fine, &self.coarse] {
            let Row { width, indentation, displacement, friction_work, work, .. } = *row;
            let upright = f64::from(u8::from(row.upright));
            [width, upright, indentation, displacement, friction_work, work].iter().for_each(|value| value.pack(bytes));
            let lists = [&row.normal, &row.tangential, &row.carried];
            lists.into_iter().flatten().for_each(|value| value.pack(bytes));
        }
    }

    /// How many bytes that are.
    pub(crate) fn packed_length(&self) -> usize {
        let lists: usize = [&self.fine, &self.coarse]
            .iter()
            .map(|row| row.normal.len() + row.tangential.len() + row.carried.len())
            .sum();
        size_of::<f64>() * (7 + 2 * 6 + lists)
    }

    /// The packed state of a contact of this definition.
    pub(crate) fn unpack(&self, reader: &mut Reader<'_>, indenter: &Indenter) -> Option<Viscoelastic> {
        let mut contact = self.clone();
        let mut next = || f64::unpack(reader);
        contact.time = next()?;
        contact.slip_from = Some(next()?).filter(|from| *from >= 0.0);
        contact.beyond = next()? > 0.0;
        contact.steps = next()? as usize;
        (contact.largest_load, contact.force_error, contact.path_error) = (next()?, next()?, next()?);
        let terms = self.prony.terms().len();
        for row in [&mut contact.fine, &mut contact.coarse] {
            row.width = next()?;
            row.upright = next()? > 0.0;
            (row.indentation, row.displacement) = (next()?, next()?);
            (row.friction_work, row.work) = (next()?, next()?);
            let count = if row.width > 0.0 { row.count } else { 0 };
            for (list, length) in
                [(&mut row.normal, terms * count), (&mut row.tangential, terms * count), (&mut row.carried, count)]
            {
                *list = (0..length).map(|_| next()).collect::<Option<Vec<f64>>>()?;
            }
            row.place(indenter, &self.prony);
        }
        reader.0.is_empty().then_some(contact)
    }
}
