//! The sources dg of cells over x^2, by what they do from afar.

use super::Cell;
use super::cell::Part;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::multipole::Multipole;

/// Sources over x^2, m^2, from where they begin on, so that those of a narrow stretch keep their digits.
#[derive(Clone, Debug)]
pub(crate) struct Sources {
    pub(crate) origin: DoubleDouble,
    /// Over how far x^2 lies beyond the origin.
    pub(crate) beyond: Multipole,
}

impl Sources {
    /// A stretch of this width, in squares, m^2, without sources.
    pub(crate) fn empty(origin: DoubleDouble, width: f64) -> Sources {
        Sources { origin, beyond: Multipole::empty((0.0, width)) }
    }

    pub(crate) fn width(&self) -> f64 {
        self.beyond.interval.1
    }

    /// Adds sources within the stretch, times a factor.
    pub(crate) fn add(&mut self, part: &Sources, factor: f64) {
        self.add_beyond((part.origin - self.origin).value(), part, factor);
    }

    /// Adds sources that begin this far beyond the origin, m^2, times a factor.
    pub(crate) fn add_beyond(&mut self, start: f64, part: &Sources, factor: f64) {
        self.beyond.add_part((start, start + part.width()), &part.beyond.moments, factor);
    }

    /// Adds those of a part of a cell, which begins at a square.
    pub(crate) fn add_part(&mut self, cell: &Cell, begins: DoubleDouble, part: Part, factor: f64) {
        cell.add_sources(&mut self.beyond, (begins - self.origin).value(), part, factor);
    }

    /// How far a square, m^2, lies beyond the origin.
    pub(crate) fn place(&self, square: DoubleDouble) -> f64 {
        (square - self.origin).value()
    }
}
