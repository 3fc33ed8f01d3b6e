//! A row of springs over the radius of a contact, each in the middle of its cell, and its steps: the one stepper of
//! every limit law ([`SpringLaw`]), with a memory of its own where the bodies relax.
//!
//! In units of its stiffness a spring carries q = u - s within +-B, where s is the deflection that its memory keeps,
//! and B its room times a scale. Of Coulomb's law the room is p = w - s_z, w = d - g(x). Outside the contact nothing is
//! carried, and both deflections relax freely; a spring touches where d - g exceeds the deflection that is left, and
//! leaves where p would fall below zero. While it slips one way, u - s = +-m (w - s_z): so v_x -+ m v_z relaxes as if
//! it were free, however w moves. A step that is straight in d and U is therefore exact for each spring, but for what
//! it does more than once in the step: it touches or leaves once and begins to slip once. Without a memory s is zero.
//!
//! All springs are moved as if they touched and stuck throughout, one term after the other. Those that do not, are then
//! moved one by one.

mod spring;
mod step;

use std::sync::Arc;

pub(crate) use step::{Scratch, Slides};

use super::law::SpringLaw;
use crate::numerics::packing::{Packed, Reader};
use crate::viscoelastic::prony::Prony;

/// A row reaches this much beyond the contact radius that it is made for.
const ROOM: f64 = 1.25;

/// What one direction of a step is led by: a place, m or rad, or a sum over the row, N or N m.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Led {
    Place(f64),
    Sum(f64),
}

/// A row of springs.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Row {
    /// How many springs it has once there is a contact.
    count: usize,
    /// Width of a cell, m; zero before the first contact.
    pub(crate) width: f64,
    /// Whether all of them are under the flat of a punch, which ends with them.
    pub(crate) upright: bool,
    pub(crate) indentation: f64,
    /// The displacement, m, or angle, rad.
    pub(crate) position: f64,
    /// Friction work and that of the force or torque, J.
    pub(crate) works: [f64; 2],
    /// Normal force, N, of Coulomb's law alone, and the force, N, or torque, N m.
    pub(crate) sums: [f64; 2],
    /// Springs from this one on have never been touched.
    active: usize,
    pub(super) levels: Arc<[f64]>,
    weights: Arc<[f64]>,
    /// Rooms inside the contact, zero outside.
    pub(super) rooms: Vec<f64>,
    /// u of each.
    pub(super) carried: Vec<f64>,
    /// The v_i of the normal springs and of the others, those of one term after those of another.
    memory: [Vec<f64>; 2],
}

impl Row {
    /// Springs at an indentation, m, up to a contact radius, m, and some more.
    pub(crate) fn new(law: &SpringLaw<'_>, count: usize, indentation: f64, radius: f64) -> Row {
        let none = || Arc::from([]);
        let mut row = Row {
            count,
            width: 0.0,
            upright: false,
            indentation,
            position: 0.0,
            works: [0.0; 2],
            sums: [0.0; 2],
            active: 0,
            levels: none(),
            weights: none(),
            rooms: Vec::new(),
            carried: Vec::new(),
            memory: [Vec::new(), Vec::new()],
        };
        row.reach(law, radius);
        row
    }

    /// How many springs it has once there is a contact.
    pub(super) fn count(&self) -> usize {
        self.count
    }

    /// How many springs it has.
    pub(super) fn len(&self) -> usize {
        self.carried.len()
    }

    /// Indentation, displacement or angle, normal force, and force or torque.
    pub(crate) fn state(&self) -> [f64; 4] {
        [self.indentation, self.position, self.sums[0], self.sums[1]]
    }

    pub(super) fn place_of(&self, index: usize) -> f64 {
        (index as f64 + 0.5) * self.width
    }

    /// Another on the same springs, for what a step finds.
    pub(super) fn beside(&self) -> Row {
        let (levels, weights) = (Arc::clone(&self.levels), Arc::clone(&self.weights));
        let none = || Vec::new();
        Row { levels, weights, rooms: none(), carried: none(), memory: [none(), none()], ..*self }
    }

    /// Gives it the places of the springs of another row.
    fn take_shape(&mut self, other: &Row) {
        if !Arc::ptr_eq(&self.levels, &other.levels) {
            (self.levels, self.weights) = (Arc::clone(&other.levels), Arc::clone(&other.weights));
        }
        (self.count, self.width, self.upright) = (other.count, other.width, other.upright);
    }

    /// Whether it does not reach a contact radius, m.
    fn is_narrower_than(&self, radius: f64) -> bool {
        !self.upright && radius > 0.0 && radius > self.count as f64 * self.width
    }

    /// Places springs up to a contact radius, m, and some more, or makes pairs of them one until they reach it.
    fn reach(&mut self, law: &SpringLaw<'_>, radius: f64) {
        if !self.is_narrower_than(radius) {
            return;
        }
        if self.width <= 0.0 {
            let rim = law.indenter().rim_radius().filter(|rim| *rim <= ROOM * radius);
            self.upright = rim.is_some();
            self.width = rim.unwrap_or(ROOM * radius) / self.count as f64;
            self.carried = vec![0.0; self.count];
            let terms = law.prony().terms().len();
            self.memory.iter_mut().for_each(|list| *list = vec![0.0; terms * self.count]);
        }
        while self.count as f64 * self.width < radius {
            self.width *= 2.0;
            let lists = self.memory.iter_mut().flat_map(|list| list.chunks_exact_mut(self.count));
            for list in lists.chain([&mut self.carried[..]]) {
                for pair in 0..self.count / 2 {
                    let [inner, outer] = [2 * pair, 2 * pair + 1].map(|spring| (self.weights[spring], list[spring]));
                    list[pair] = (inner.0 * inner.1 + outer.0 * outer.1) / (inner.0 + outer.0);
                }
                list[self.count / 2..].fill(0.0);
            }
        }
        self.place(law);
        self.rooms = law.rooms(self);
        self.count_active();
        let pressed = self.weights.iter().zip(&self.rooms).map(|(weight, room)| weight * room);
        self.sums[0] = law.normal_unit() * pressed.sum::<f64>();
    }

    /// The levels and stiffnesses of the springs, which follow from their width.
    fn place(&mut self, law: &SpringLaw<'_>) {
        let indenter = law.indenter();
        let end = indenter.limit_radius().unwrap_or(f64::INFINITY);
        let level = |index: usize| {
            let radius = self.place_of(index);
            let level = if radius < end { indenter.level(radius) } else { f64::INFINITY };
            if level.is_nan() { f64::INFINITY } else { level }
        };
        self.levels = (0..self.len()).map(level).collect();
        self.weights = (0..self.len()).map(|index| law.weight(self.width, index)).collect();
    }

    fn count_active(&mut self) {
        let touched = |index: &usize| {
            let memory = self.memory.iter().flat_map(|list| list.iter().skip(*index).step_by(self.count));
            self.rooms[*index] > 0.0 || memory.into_iter().any(|v| v.abs() > 0.0)
        };
        self.active = (0..self.len()).rev().find(touched).map_or(0, |last| last + 1);
    }

    /// What memory keeps of one spring, of one side.
    fn kept(&self, prony: &Prony, side: usize, index: usize) -> f64 {
        let (mut kept, mut place) = (0.0, index);
        for term in prony.terms() {
            kept += term.ratio * self.memory[side][place];
            place += self.len();
        }
        kept
    }

    /// p of Coulomb's law, which follows from the memory.
    pub(super) fn rooms_by_memory(&self, prony: &Prony) -> Vec<f64> {
        let pressed: Vec<f64> = self.levels.iter().map(|level| self.indentation - level).collect();
        let mut p = Vec::new();
        prony.loads((&self.memory[0], self.len()), (&pressed, 0..self.len()), &mut p);
        p.iter_mut().for_each(|p| *p = p.max(0.0));
        p
    }

    /// Bends the springs of the contact by `deflection` of their places, m.
    pub(super) fn bend(&mut self, law: &SpringLaw<'_>, deflection: impl Fn(f64) -> f64) {
        let scale = law.scale();
        let bent = |index: usize| {
            let bound = scale * self.rooms[index];
            if bound > 0.0 { deflection(self.place_of(index)).clamp(-bound, bound) } else { 0.0 }
        };
        self.carried = (0..self.len()).map(bent).collect();
        self.sums[1] = self.weights.iter().zip(&self.carried).map(|(weight, carried)| weight * carried).sum();
    }

    /// The force, N, or torque, N m, of gross slip.
    pub(crate) fn limit(&self, law: &SpringLaw<'_>) -> f64 {
        match law {
            SpringLaw::Coulomb(law) => law.friction * self.sums[0],
            SpringLaw::Twist(_) => self.weights.iter().zip(&self.rooms).map(|(weight, room)| weight * room).sum(),
        }
    }

    /// The least error that a row of this width can have of the sums, N or N m.
    pub(super) fn least_errors(&self, law: &SpringLaw<'_>) -> [f64; 2] {
        let end = (self.len() - usize::from(self.upright)).min(self.active + 2);
        let (unit, mut q) = (law.normal_unit(), Vec::new());
        law.prony().loads((&self.memory[1], self.len()), (&self.carried, 0..end), &mut q);
        let springs = self.weights.iter().zip(&self.rooms).zip(&q);
        let mut loads =
            springs.map(|((weight, room), q)| [weight * unit * room, if *room > 0.0 { weight * q } else { 0.0 }]);
        let (mut sums, mut near) = ([0.0; 2], [(); 2].map(|()| loads.next().unwrap_or_default()));
        for next in loads {
            (0..2).for_each(|side| sums[side] += (near[0][side] - 2.0 * near[1][side] + next[side]).abs());
            near = [near[1], next];
        }
        sums.map(|sum| sum / 16.0)
    }

    /// The contact radius, m: where the pressure of the last springs inside, or the gap of the first ones outside, is
    /// zero if extrapolated linearly over the level. On the side that a moving edge leaves behind, springs have changed
    /// their state for a short time alone, and the extrapolation ends beyond the edge: pressure grows the less, and the
    /// gap the more, the farther a spring is from it. So the nearer one of the two is right.
    pub(crate) fn radius(&self, law: &SpringLaw<'_>) -> f64 {
        let (prony, indenter) = (law.prony(), law.indenter());
        let last = self.rooms[..self.active].iter().rposition(|room| *room > 0.0);
        let Some(last) = last.filter(|_| !prony.terms().is_empty()) else {
            // A tip that touches less than one spring does.
            let virgin = self.memory[0].iter().all(|v| v.abs() <= 0.0);
            return if virgin { indenter.radius(self.indentation.max(0.0)) } else { 0.0 };
        };
        if last + 1 == self.levels.len() {
            return self.levels.len() as f64 * self.width;
        }
        let pressure = |index: usize| self.indentation - self.levels[index] - self.kept(prony, 0, index);
        let zero = |[near, far]: [usize; 2]| {
            let (p, level) = (pressure(near), self.levels[near]);
            level + p * (self.levels[far] - level) / (p - pressure(far))
        };
        let inside = (last > 0).then(|| zero([last, last - 1]));
        let outside = (last + 2 < self.len()).then(|| zero([last + 1, last + 2]));
        let between = inside.into_iter().chain(outside).filter(|level| *level > self.levels[last]);
        indenter.radius(between.fold(self.levels[last + 1], f64::min)).min(self.place_of(last + 1))
    }

    /// The energy of the deflection along the surface, J.
    pub(crate) fn energy(&self, law: &SpringLaw<'_>) -> f64 {
        let (prony, stride) = (law.prony(), self.len());
        let (relaxed, terms) = (prony.relaxed(), prony.terms());
        let springs = self.weights.iter().zip(&self.carried).enumerate();
        let energy = springs.map(|(index, (weight, u))| {
            let each = self.memory[1].iter().skip(index).step_by(stride.max(1)).zip(terms);
            let stored = each.map(|(v, term)| term.ratio * (u - v) * (u - v)).sum::<f64>();
            weight * relaxed * u * u + weight * stored
        });
        0.5 * energy.sum::<f64>()
    }

    pub(crate) fn heap_bytes(&self) -> usize {
        size_of::<f64>() * (2 * self.levels.len() + self.numbers().count())
    }

    /// All that a move changes.
    fn numbers(&self) -> impl Iterator<Item = &f64> {
        let lists = [&self.rooms, &self.carried, &self.memory[0], &self.memory[1]];
        let own = [&self.width, &self.indentation, &self.position];
        own.into_iter().chain(&self.works).chain(&self.sums).chain(lists.into_iter().flatten())
    }

    pub(crate) fn pack(&self, bytes: &mut Vec<u8>) {
        self.numbers().chain([&f64::from(u8::from(self.upright))]).for_each(|number| number.pack(bytes));
    }

    /// How many bytes that are.
    pub(crate) fn packed_length(&self) -> usize {
        size_of::<f64>() * (1 + self.numbers().count())
    }

    pub(crate) fn unpack(reader: &mut Reader<'_>, law: &SpringLaw<'_>, count: usize) -> Option<Row> {
        let mut next = || f64::unpack(reader);
        let mut row = Row::new(law, count, 0.0, 0.0);
        row.width = next()?;
        (row.indentation, row.position) = (next()?, next()?);
        row.works = [next()?, next()?];
        row.sums = [next()?, next()?];
        let terms = law.prony().terms().len();
        let count = if row.width > 0.0 { count } else { 0 };
        let mut list = |length: usize| (0..length).map(|_| next()).collect::<Option<Vec<f64>>>();
        (row.rooms, row.carried) = (list(count)?, list(count)?);
        row.memory = [list(terms * count)?, list(terms * count)?];
        row.upright = next()? > 0.0;
        row.place(law);
        row.count_active();
        Some(row)
    }
}
