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

use super::law::SpringLaw;
use super::row::{Led, Row, Slides};
use super::rows::{Course, Rows, Walk};
use super::stress::from_displacements;
use crate::indenter::Indenter;
use crate::numerics::gauss::EIGHT_POINTS;
use crate::profile::complete;
use crate::range::error::Error;

/// Springs from the centre to the edge of the row, of the finer one.
pub(crate) const SPRINGS: usize = 2048;
/// How much larger the contact radius is at the end of a panel than at its beginning.
const WIDENING: f64 = 1.25;
/// Steps of a move that brings or takes all of the load, of the finer row, and the most where a torque is led.
const STEPS: [usize; 2] = [32, 1024];
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

    /// Brings the bounds of springs at these levels, m, to another indentation, m.
    pub(super) fn change_bounds(&self, levels: &[f64], width: f64, bounds: &mut [f64], [from, to]: [f64; 2]) {
        let [low, high] = [from.min(to), from.max(to)].map(|level| level.max(0.0));
        let mut shared = Vec::new();
        if high > low {
            self.panels([low, high], |radius, weight| shared.push((radius, weight)));
        }
        for (index, (&level, bound)) in levels.iter().zip(bounds).enumerate() {
            let x = (index as f64 + 0.5) * width;
            if to <= level {
                *bound = 0.0;
                continue;
            }
            let mut change = 0.0;
            if level <= low && self.indenter.radius(low) >= x {
                change = shared.iter().map(|(radius, weight)| weight * TwistLaw::rate(x, *radius)).sum();
            } else {
                self.panels([level.max(low), high], |radius, weight| change += weight * TwistLaw::rate(x, radius));
            }
            *bound = if to > from { *bound + change } else { (*bound - change).max(0.0) };
        }
    }
}

impl Row {
    /// The hoop stress, Pa, at a radius, m, of a contact of the radius `edge`, m.
    fn hoop(&self, law: &TwistLaw<'_>, edge: f64, radius: f64) -> f64 {
        let inside =
            self.levels.iter().zip(&self.carried).enumerate().filter(|(index, _)| self.place_of(*index) < edge);
        let nodes = inside.map(|(index, (_, carried))| (self.place_of(index), *carried));
        let at_edge = if self.upright && edge >= self.width * self.carried.len() as f64 * (1.0 - f64::EPSILON) {
            self.carried.last().copied().unwrap_or(0.0)
        } else {
            0.0
        };
        4.0 * law.shear_modulus * radius * from_displacements(nodes, edge, at_edge, radius)
    }
}

impl Rows {
    /// The springs of a contact at an indentation, m, that carry `deflection` of their places, m, at an angle, rad.
    pub(crate) fn of_twist(
        law: &TwistLaw<'_>,
        [indentation, reach]: [f64; 2],
        angle: f64,
        deflection: impl Fn(f64) -> f64,
    ) -> Rows {
        let law = SpringLaw::Twist(*law);
        let mut rows = Rows::new(&law, SPRINGS, [indentation, reach]);
        for row in [&mut rows.fine, &mut rows.coarse] {
            row.position = angle;
            row.bend(&law, &deflection);
        }
        rows.note_error(&law);
        rows
    }

    /// Follows a move, whose indentation at a part of it `level` gives, m. Nothing has changed when an error is
    /// returned.
    pub(crate) fn twist(
        &mut self,
        law: &TwistLaw<'_>,
        level: &dyn Fn(f64) -> f64,
        path: Course,
        tolerance: f64,
        keep_going: &dyn Fn() -> bool,
    ) -> Result<(), Error> {
        let law = SpringLaw::Twist(*law);
        let (here, end) = (self.fine.indentation, level(1.0).max(0.0));
        if end.to_bits() == here.to_bits() {
            *self = self.twisted(&law, level, path, 1, keep_going)?;
            return Ok(());
        }
        let change = (end - here).abs() / end.max(here);
        let mut count = 2 * ((0.5 * change * STEPS[0] as f64).ceil() as usize).max(1);
        let mut found = self.twisted(&law, level, path, count, keep_going)?;
        if path.is_force() {
            let mut error = f64::INFINITY;
            while error > tolerance && count < STEPS[1] {
                count *= 2;
                let finer = self.twisted(&law, level, path, count, keep_going)?;
                let apart = (finer.fine.position - found.fine.position).abs();
                let limit = finer.fine.limit(&law);
                error = if limit > 0.0 { apart * law.stiffness(finer.fine.radius(&law))[1] / limit } else { 0.0 };
                found = finer;
            }
            found.note_path(error);
        }
        *self = found;
        Ok(())
    }

    /// The springs after so many steps of the finer row.
    fn twisted(
        &self,
        law: &SpringLaw<'_>,
        level: &dyn Fn(f64) -> f64,
        path: Course,
        count: usize,
        keep_going: &dyn Fn() -> bool,
    ) -> Result<Rows, Error> {
        let mut walk = Walk::from(self);
        let refused = |(_, Slides(limit))| Error::TorqueExceedsFriction { target: path.at(1.0), limit };
        let led = |step: usize| {
            let part = step as f64 / count as f64;
            ([Led::Place(level(part).max(0.0)), path.led(part)], [0.0; 2])
        };
        for step in (0..count).step_by(2) {
            if !keep_going() {
                return Err(Error::Interrupted);
            }
            if count > 1 {
                walk.step(law, 0.0, [led(step + 1), led(step + 2)], [0.0; 2]).map_err(refused)?;
            } else {
                walk.step(law, 0.0, [led(1)], [0.0; 2]).map_err(refused)?;
            }
            walk.accept();
        }
        let mut after = walk.end();
        after.note_error(law);
        Ok(after)
    }

    /// The error of the hoop stress, Pa.
    pub(crate) fn hoop_error(&self, law: &TwistLaw<'_>) -> f64 {
        let edge = law.indenter.radius(self.fine.indentation);
        let radii = (0..COMPARED).map(|index| edge * (index as f64 + 0.5) / COMPARED as f64);
        let apart = |radius: f64| self.fine.hoop(law, edge, radius) - self.coarse.hoop(law, edge, radius);
        radii.map(|radius| apart(radius).abs()).fold(0.0, f64::max)
    }

    /// The hoop stress, Pa, at a radius, m.
    pub(crate) fn hoop(&self, law: &TwistLaw<'_>, radius: f64) -> f64 {
        self.fine.hoop(law, law.indenter.radius(self.fine.indentation), radius.abs())
    }

    /// Whether any spring is bent.
    pub(crate) fn carries(&self) -> bool {
        self.fine.carried.iter().any(|carried| carried.abs() > 0.0)
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
