//! A contact that is twisted under a load that changes, as a row of springs.
//!
//! A spring at x carries an angle w within +-B(x, d), and 16 G x^2 w dx of the torque. A change of the load changes B
//! unevenly, by dB/dd = C K(1 - x^2/a^2)/a, C = mu E*/(2 pi G), from d = g(x) on (Jaeger 1995), so that the slip
//! history of a constant load does not hold. But that rate falls where a grows, (E - K)/(1 - x^2/a^2) being negative,
//! so that B is concave along a move straight in d or F_N and in the angle. A spring that slips is then at its bound at
//! the end of the move, and one clamp is exact for it, however long the move. What is left is the sum over springs:
//! another row of half as many makes the same moves in steps twice as long, and the difference is the stated error.
//! Steps serve the friction work, whose bound is taken as straight within each, and a torque that is led while the load
//! changes.

use std::f64::consts::PI;

use super::stress::from_displacements;
use crate::indenter::Indenter;
use crate::numerics::gauss::EIGHT_POINTS;
use crate::numerics::packing::{Packed, Reader};
use crate::numerics::roots::within;
use crate::profile::complete;
use crate::range::error::Error;

/// Springs from the centre to the edge of the row, of the finer one.
const SPRINGS: usize = 2048;
/// A row reaches this much beyond the contact radius that it is made for.
const ROOM: f64 = 1.25;
/// How much larger the contact radius is at the end of a panel than at its beginning.
const WIDENING: f64 = 1.25;
/// Steps of a move that brings or takes all of the load, of the finer row, and the most where a torque is led.
const STEPS: [usize; 2] = [32, 1024];
/// A slip below this, over bound and move, is rounding.
const NO_SLIP: f64 = 1e-10;
/// Radii at which the stresses of both rows are compared.
const COMPARED: usize = 32;

/// What springs of twist are made of.
#[derive(Clone, Copy)]
pub(crate) struct TwistLaw<'a> {
    pub(crate) indenter: &'a Indenter,
    /// C, 1/m.
    pub(crate) unit: f64,
    /// G, Pa.
    pub(crate) shear_modulus: f64,
}

/// What a move leads, from its value before.
#[derive(Clone, Copy, Debug)]
pub(crate) enum TwistPath {
    Angle { from: f64, to: f64 },
    Torque { from: f64, to: f64 },
}

/// The springs of a contact that is twisted.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct TwistSprings {
    rows: [Row; 2],
    /// m.
    indentation: f64,
    /// From which radius on the last move slipped, m, if it did.
    pub(crate) slip_from: Option<f64>,
    pub(crate) steps: usize,
    /// The largest error of a torque, and the largest torque of gross slip, N m.
    largest_error: f64,
    largest_limit: f64,
    /// How far an angle was off where a torque was led, as a torque over that of gross slip.
    pub(crate) path_error: f64,
}

/// A row of springs, each in the middle of its cell.
#[derive(Clone, Debug, PartialEq)]
struct Row {
    /// m.
    width: f64,
    /// Whether the row ends at a vertical edge.
    upright: bool,
    angle: f64,
    /// Friction work, J.
    work: f64,
    levels: Vec<f64>,
    bounds: Vec<f64>,
    carried: Vec<f64>,
}

impl TwistLaw<'_> {
    /// int dB/dd dd from one level to another, of springs up to the first one's contact radius: contact radii with
    /// their weights.
    fn panels(&self, [from, to]: [f64; 2], mut each: impl FnMut(f64, f64)) {
        let indenter = self.indenter;
        let mut ends = vec![from];
        let (first, last) = (indenter.radius(from), indenter.radius(to));
        let mut knots = indenter.knots_below(last).into_iter().filter(|knot| *knot > first).peekable();
        let mut radius = first;
        while radius > 0.0 && radius * WIDENING < last {
            let next = radius * WIDENING;
            radius = match knots.peek() {
                Some(knot) if *knot < next => *knot,
                _ => next,
            };
            while knots.next_if(|knot| *knot <= radius).is_some() {}
            ends.push(indenter.level(radius));
        }
        ends.extend(knots.map(|knot| indenter.level(knot)));
        // A vertical edge is pressed in from here on.
        let rim = indenter.rim_radius().filter(|rim| *rim <= last).map(|rim| indenter.level(rim));
        ends.extend(rim.filter(|level| *level > from));
        ends.push(to);
        for pair in ends.windows(2).filter(|pair| pair[1] > pair[0]) {
            for (place, weight) in EIGHT_POINTS {
                each(indenter.radius(pair[0] + place * (pair[1] - pair[0])), self.unit * weight * (pair[1] - pair[0]));
            }
        }
    }

    fn rate(x: f64, radius: f64) -> f64 {
        complete((x / radius).min(1.0))[0] / radius
    }

    /// The bounds at another indentation, m.
    fn bounds_at(&self, row: &Row, from: f64, to: f64) -> Vec<f64> {
        let [low, high] = [from.min(to), from.max(to)].map(|level| level.max(0.0));
        let mut shared = Vec::new();
        if high > low {
            self.panels([low, high], |radius, weight| shared.push((radius, weight)));
        }
        let springs = row.levels.iter().zip(&row.bounds).enumerate();
        springs
            .map(|(index, (&level, &bound))| {
                let x = row.place(index);
                if to <= level {
                    return 0.0;
                }
                let mut change = 0.0;
                if level <= low && self.indenter.radius(low) >= x {
                    change = shared.iter().map(|(radius, weight)| weight * TwistLaw::rate(x, *radius)).sum();
                } else {
                    self.panels([level.max(low), high], |radius, weight| change += weight * TwistLaw::rate(x, radius));
                }
                if to > from { bound + change } else { (bound - change).max(0.0) }
            })
            .collect()
    }
}

impl Row {
    fn place(&self, index: usize) -> f64 {
        (index as f64 + 0.5) * self.width
    }

    /// 16 G x^2 dx of a cell, N m.
    fn stiffness(&self, law: &TwistLaw<'_>, index: usize) -> f64 {
        let [inner, outer] = [index, index + 1].map(|end| end as f64 * self.width);
        16.0 * law.shear_modulus * self.width * (outer * outer + outer * inner + inner * inner) / 3.0
    }

    /// Virgin springs up to a contact radius, m, and some more, at an indentation, m.
    fn new(count: usize, law: &TwistLaw<'_>, radius: f64, indentation: f64) -> Row {
        let rim = law.indenter.rim_radius().filter(|rim| *rim <= ROOM * radius);
        let mut row = Row {
            width: rim.unwrap_or(ROOM * radius) / count as f64,
            upright: rim.is_some(),
            angle: 0.0,
            work: 0.0,
            levels: Vec::new(),
            bounds: vec![0.0; count],
            carried: vec![0.0; count],
        };
        row.place_levels(law);
        row.bounds = law.bounds_at(&row, 0.0, indentation);
        row
    }

    /// The levels of the springs, which follow from their width.
    fn place_levels(&mut self, law: &TwistLaw<'_>) {
        let end = law.indenter.limit_radius().unwrap_or(f64::INFINITY);
        let level = |x: f64| if x < end { law.indenter.level(x) } else { f64::INFINITY };
        let level = |x: f64| Some(level(x)).filter(|level| !level.is_nan()).unwrap_or(f64::INFINITY);
        self.levels = (0..self.carried.len()).map(|index| level(self.place(index))).collect();
    }

    /// Makes pairs of springs one until the row reaches a contact radius, m, at an indentation, m.
    fn reach(&mut self, law: &TwistLaw<'_>, radius: f64, indentation: f64) {
        let count = self.carried.len();
        while !self.upright && count as f64 * self.width < radius {
            let pair = |index: usize| {
                let [inner, outer] = [2 * index, 2 * index + 1].map(|spring| (self.stiffness(law, spring), spring));
                let sum = inner.0 * self.carried[inner.1] + outer.0 * self.carried[outer.1];
                sum / (inner.0 + outer.0)
            };
            let mut carried: Vec<f64> = (0..count / 2).map(pair).collect();
            carried.resize(count, 0.0);
            self.carried = carried;
            self.width *= 2.0;
            self.place_levels(law);
            self.bounds = vec![0.0; count];
            self.bounds = law.bounds_at(self, 0.0, indentation);
        }
    }

    /// N m.
    fn torque(&self, law: &TwistLaw<'_>) -> f64 {
        self.carried.iter().enumerate().map(|(index, carried)| self.stiffness(law, index) * carried).sum()
    }

    /// The torque of gross slip, N m.
    fn limit(&self, law: &TwistLaw<'_>) -> f64 {
        self.bounds.iter().enumerate().map(|(index, bound)| self.stiffness(law, index) * bound).sum()
    }

    /// J.
    fn energy(&self, law: &TwistLaw<'_>) -> f64 {
        let springs = self.carried.iter().enumerate();
        0.5 * springs.map(|(index, carried)| self.stiffness(law, index) * carried * carried).sum::<f64>()
    }

    /// The least error that a row of this width can have of the torque, N m.
    fn least_error(&self, law: &TwistLaw<'_>) -> f64 {
        let load = |index: usize| self.stiffness(law, index) * self.carried[index];
        let last = self.carried.len() - if self.upright { 1 } else { 0 };
        (1..last.saturating_sub(1))
            .map(|index| (load(index - 1) - 2.0 * load(index) + load(index + 1)).abs())
            .sum::<f64>()
            / 16.0
    }

    /// A step to an indentation, m, and an angle or a torque. From which radius on it slipped, m, if it did; the
    /// torque of gross slip, N m, where that holds no such torque.
    fn step(&mut self, law: &TwistLaw<'_>, [from, to]: [f64; 2], target: TwistTarget) -> Result<Option<f64>, f64> {
        let after = if to.to_bits() == from.to_bits() { self.bounds.clone() } else { law.bounds_at(self, from, to) };
        // The part of the step in which a spring touches.
        let spans: Vec<f64> = self.levels.iter().map(|level| touching([from - level, to - level])).collect();
        let way = match target {
            TwistTarget::Angle(angle) => angle - self.angle,
            TwistTarget::Torque(torque) => self.way_for(law, &after, &spans, torque)?,
        };
        let mut slip_from = None;
        for index in 0..self.carried.len() {
            let (before, bound, share) = (self.bounds[index], after[index], way * spans[index]);
            if before <= 0.0 && bound <= 0.0 {
                continue;
            }
            let trial = self.carried[index] + share;
            let slip = trial.abs() - bound;
            self.carried[index] = trial.clamp(-bound, bound);
            if slip <= 0.0 {
                continue;
            }
            let change = bound - before;
            let rate = share * trial.signum() - change;
            let mean = if rate > 0.0 { bound - 0.5 * change * (slip / rate).min(1.0) } else { bound };
            self.work += self.stiffness(law, index) * slip * mean;
            if slip > NO_SLIP * (bound + share.abs()) && slip_from.is_none() {
                slip_from = Some(index as f64 * self.width);
            }
        }
        self.bounds = after;
        self.angle = if let TwistTarget::Angle(angle) = target { angle } else { self.angle + way };
        Ok(slip_from)
    }

    /// The change of the angle that gives a torque, N m.
    fn way_for(&self, law: &TwistLaw<'_>, bounds: &[f64], spans: &[f64], wanted: f64) -> Result<f64, f64> {
        let springs: Vec<[f64; 4]> = (0..self.carried.len())
            .filter(|index| bounds[*index] > 0.0 && spans[*index] > 0.0)
            .map(|index| [self.stiffness(law, index), self.carried[index], spans[index], bounds[index]])
            .collect();
        let limit: f64 = springs.iter().map(|[stiffness, _, _, bound]| stiffness * bound).sum();
        if limit <= 0.0 && wanted.abs() <= 0.0 {
            return Ok(0.0);
        }
        if wanted.abs() >= limit {
            return Err(limit);
        }
        let end = |sign: f64| {
            let ways = springs.iter().map(|[_, carried, span, bound]| (bound - sign * carried) / span);
            sign * ways.fold(0.0, f64::max)
        };
        let [low, high] = [end(-1.0), end(1.0)];
        let sum = |way: f64| {
            springs.iter().fold((-wanted, 0.0), |(sum, slope), [stiffness, carried, span, bound]| {
                let trial = carried + (low + way) * span;
                let sticks = if trial.abs() < *bound { stiffness * span } else { 0.0 };
                (sum + stiffness * trial.clamp(-bound, *bound), slope + sticks)
            })
        };
        Ok(low + within([0.0, high - low], -low, sum))
    }

    /// The hoop stress, Pa, at a radius, m, of a contact of the radius `edge`, m.
    fn hoop(&self, law: &TwistLaw<'_>, edge: f64, radius: f64) -> f64 {
        let inside = self.levels.iter().zip(&self.carried).enumerate().filter(|(index, _)| self.place(*index) < edge);
        let nodes = inside.map(|(index, (_, carried))| (self.place(index), *carried));
        let at_edge = if self.upright && edge >= self.width * self.carried.len() as f64 * (1.0 - f64::EPSILON) {
            self.carried.last().copied().unwrap_or(0.0)
        } else {
            0.0
        };
        4.0 * law.shear_modulus * radius * from_displacements(nodes, edge, at_edge, radius)
    }
}

/// What a step leads.
#[derive(Clone, Copy, Debug)]
enum TwistTarget {
    Angle(f64),
    Torque(f64),
}

/// The part of a straight step in which a gap that begins and ends so is closed.
fn touching([before, after]: [f64; 2]) -> f64 {
    match (before > 0.0, after > 0.0) {
        (true, true) => 1.0,
        (false, true) => after / (after - before),
        (true, false) => before / (before - after),
        (false, false) => 0.0,
    }
}

impl TwistPath {
    fn at(self, part: f64) -> TwistTarget {
        let between = |from: f64, to: f64| if part < 1.0 { from + part * (to - from) } else { to };
        match self {
            TwistPath::Angle { from, to } => TwistTarget::Angle(between(from, to)),
            TwistPath::Torque { from, to } => TwistTarget::Torque(between(from, to)),
        }
    }
}

impl TwistSprings {
    /// The springs of a contact at an indentation, m, that carry `deflection` of their places, m, at an angle, rad.
    pub(crate) fn new(
        law: &TwistLaw<'_>,
        [indentation, reach]: [f64; 2],
        angle: f64,
        deflection: impl Fn(f64) -> f64,
    ) -> TwistSprings {
        let rows = [SPRINGS, SPRINGS / 2].map(|count| {
            let mut row = Row::new(count, law, reach, indentation);
            row.angle = angle;
            row.carried = row
                .bounds
                .iter()
                .enumerate()
                .map(
                    |(index, bound)| {
                        if *bound > 0.0 { deflection(row.place(index)).clamp(-bound, *bound) } else { 0.0 }
                    },
                )
                .collect();
            row
        });
        let mut springs = TwistSprings {
            rows,
            indentation: indentation.max(0.0),
            slip_from: None,
            steps: 0,
            largest_error: 0.0,
            largest_limit: 0.0,
            path_error: 0.0,
        };
        springs.note_error(law);
        springs
    }

    /// Follows a move, whose indentation at a part of it `level` gives, m. Nothing has changed when an error is
    /// returned.
    pub(crate) fn follow(
        &mut self,
        law: &TwistLaw<'_>,
        level: &dyn Fn(f64) -> f64,
        path: TwistPath,
        tolerance: f64,
        keep_going: &dyn Fn() -> bool,
    ) -> Result<(), Error> {
        let end = level(1.0).max(0.0);
        if end.to_bits() == self.indentation.to_bits() {
            *self = self.followed(law, level, path, 1, keep_going)?;
            return Ok(());
        }
        let change = (end - self.indentation).abs() / end.max(self.indentation);
        let mut count = 2 * ((0.5 * change * STEPS[0] as f64).ceil() as usize).max(1);
        let mut found = self.followed(law, level, path, count, keep_going)?;
        if let TwistPath::Torque { .. } = path {
            let mut error = f64::INFINITY;
            while error > tolerance && count < STEPS[1] {
                count *= 2;
                let finer = self.followed(law, level, path, count, keep_going)?;
                let apart = (finer.rows[0].angle - found.rows[0].angle).abs();
                let radius = law.indenter.radius(finer.indentation);
                let stiffness = 16.0 / 3.0 * law.shear_modulus * radius * radius * radius;
                let limit = finer.rows[0].limit(law);
                error = if limit > 0.0 { apart * stiffness / limit } else { 0.0 };
                found = finer;
            }
            found.path_error = found.path_error.max(error);
        }
        *self = found;
        Ok(())
    }

    /// The springs after so many steps of the finer row.
    fn followed(
        &self,
        law: &TwistLaw<'_>,
        level: &dyn Fn(f64) -> f64,
        path: TwistPath,
        count: usize,
        keep_going: &dyn Fn() -> bool,
    ) -> Result<TwistSprings, Error> {
        let mut after = self.clone();
        let [fine, coarse] = &mut after.rows;
        let mut slip_from: Option<f64> = None;
        for (row, count) in [(fine, count), (coarse, count.div_ceil(2))] {
            let (mut from, is_fine) = (self.indentation, row.carried.len() == SPRINGS);
            for step in 1..=count {
                if !keep_going() {
                    return Err(Error::Interrupted);
                }
                let part = step as f64 / count as f64;
                let to = level(part).max(0.0);
                row.reach(law, law.indenter.radius(to), from);
                let target = path.at(part);
                let slipped = row.step(law, [from, to], target).map_err(|limit| match path {
                    TwistPath::Angle { to: target, .. } | TwistPath::Torque { to: target, .. } => {
                        Error::TorqueExceedsFriction { target, limit }
                    }
                })?;
                if let Some(place) = slipped.filter(|_| is_fine) {
                    slip_from = Some(slip_from.map_or(place, |known| known.min(place)));
                }
                from = to;
            }
        }
        after.steps += count;
        after.slip_from = slip_from;
        after.indentation = level(1.0).max(0.0);
        after.note_error(law);
        Ok(after)
    }

    /// Takes the present state into the stated error.
    fn note_error(&mut self, law: &TwistLaw<'_>) {
        self.largest_limit = self.largest_limit.max(self.rows[0].limit(law));
        self.largest_error = self.largest_error.max(self.error(law));
    }

    /// Of the torque, N m.
    fn error(&self, law: &TwistLaw<'_>) -> f64 {
        let [fine, coarse] = &self.rows;
        let radius = law.indenter.radius(self.indentation);
        let stiffness = 16.0 / 3.0 * law.shear_modulus * radius * radius * radius;
        let apart = (fine.torque(law) - coarse.torque(law)).abs() + stiffness * (fine.angle - coarse.angle).abs();
        apart.max(fine.least_error(law))
    }

    /// The error of the torque over that of gross slip, for all states so far.
    pub(crate) fn force_error(&self, law: &TwistLaw<'_>) -> f64 {
        let relative = |error: f64, limit: f64| if limit > 0.0 { error / limit } else { 0.0 };
        let present = relative(self.error(law), self.rows[0].limit(law));
        present.max(relative(self.largest_error, self.largest_limit)) + self.path_error
    }

    /// The error of the hoop stress, Pa.
    pub(crate) fn hoop_error(&self, law: &TwistLaw<'_>) -> f64 {
        let edge = law.indenter.radius(self.indentation);
        let radii = (0..COMPARED).map(|index| edge * (index as f64 + 0.5) / COMPARED as f64);
        let [fine, coarse] = &self.rows;
        radii.map(|radius| (fine.hoop(law, edge, radius) - coarse.hoop(law, edge, radius)).abs()).fold(0.0, f64::max)
    }

    /// The hoop stress, Pa, at a radius, m.
    pub(crate) fn hoop(&self, law: &TwistLaw<'_>, radius: f64) -> f64 {
        self.rows[0].hoop(law, law.indenter.radius(self.indentation), radius.abs())
    }

    /// Springs from the centre to the edge of the row.
    pub(crate) fn count(&self) -> usize {
        SPRINGS
    }

    pub(crate) fn angle(&self) -> f64 {
        self.rows[0].angle
    }

    /// Friction work since the springs were made, J.
    pub(crate) fn work(&self) -> f64 {
        self.rows[0].work
    }

    /// Torque, N m, and elastic energy, J.
    pub(crate) fn results(&self, law: &TwistLaw<'_>) -> [f64; 2] {
        [self.rows[0].torque(law), self.rows[0].energy(law)]
    }

    /// Whether any spring is twisted.
    pub(crate) fn carries(&self) -> bool {
        self.rows[0].carried.iter().any(|carried| carried.abs() > 0.0)
    }

    pub(crate) fn heap_bytes(&self) -> usize {
        size_of::<TwistSprings>() + 3 * (SPRINGS + SPRINGS / 2) * size_of::<f64>()
    }

    /// All that a move changes, as numbers.
    pub(crate) fn pack(&self, bytes: &mut Vec<u8>) {
        let slip_from = self.slip_from.unwrap_or(-1.0);
        let numbers = [self.indentation, slip_from, self.steps as f64];
        let errors = [self.largest_error, self.largest_limit, self.path_error];
        numbers.iter().chain(&errors).for_each(|number| number.pack(bytes));
        for row in &self.rows {
            let Row { width, upright, angle, work, levels: _, bounds, carried } = row;
            [*width, f64::from(u8::from(*upright)), *angle, *work].iter().for_each(|number| number.pack(bytes));
            bounds.iter().chain(carried).for_each(|number| number.pack(bytes));
        }
    }

    /// How many bytes that are.
    pub(crate) fn packed_length() -> usize {
        size_of::<f64>() * (6 + 2 * 4 + 2 * (SPRINGS + SPRINGS / 2))
    }

    pub(crate) fn unpack(reader: &mut Reader<'_>, law: &TwistLaw<'_>) -> Option<TwistSprings> {
        let mut next = || f64::unpack(reader);
        let [indentation, slip_from, steps] = [next()?, next()?, next()?];
        let [largest_error, largest_limit, path_error] = [next()?, next()?, next()?];
        let mut row = |count: usize| {
            let [width, upright, angle, work] = [next()?, next()?, next()?, next()?];
            let bounds = (0..count).map(|_| next()).collect::<Option<Vec<f64>>>()?;
            let carried = (0..count).map(|_| next()).collect::<Option<Vec<f64>>>()?;
            let mut row = Row { width, upright: upright > 0.0, angle, work, levels: Vec::new(), bounds, carried };
            row.place_levels(law);
            Some(row)
        };
        let rows = [row(SPRINGS)?, row(SPRINGS / 2)?];
        let slip_from = Some(slip_from).filter(|from| *from >= 0.0);
        let steps = steps as usize;
        reader.0.is_empty().then_some(TwistSprings {
            rows,
            indentation,
            slip_from,
            steps,
            largest_error,
            largest_limit,
            path_error,
        })
    }
}

/// The torque of gross slip, N m, of a contact of this indentation, m: (pi/2) mu E* int X^2 dy, which asks for the load
/// curve alone.
pub(crate) fn gross_slip_torque(indenter: &Indenter, traction: f64, indentation: f64) -> f64 {
    if indentation <= 0.0 {
        return 0.0;
    }
    // Below the first panel X^2 dy is less than rounding.
    let least = indenter.level(LEAST_RADIUS * indenter.radius(indentation)).max(0.0).min(indentation);
    let law = TwistLaw { indenter, unit: 1.0, shear_modulus: 1.0 };
    let mut sum = 0.0;
    law.panels([least, indentation], |radius, weight| sum += weight * radius * radius);
    0.5 * PI * traction * sum
}

/// A contact radius over the largest, the square of which is rounding.
const LEAST_RADIUS: f64 = 1e-6;
