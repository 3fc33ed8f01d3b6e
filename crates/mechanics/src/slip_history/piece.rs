//! One straight piece of the slip history, and the sums over the pieces.
//!
//! A piece keeps the numbers that later moves need: the integrals over its ring, once they are known, and the value of
//! its line at its inner end. It is popped with the ends that it has now, and both depend on these alone, so that they
//! are the same to the last bit.

use std::fmt;

use crate::numerics::double_double::DoubleDouble;
use crate::profile::{Moments, Point, Ring};
use crate::slip_history::limit::Limit;

/// A stuck core thinner than this, relative to the indentation, is gross slip, because the displacement of gross slip
/// is itself rounded. w at the edge is rounded by as much.
pub(super) const THINNEST_CORE: f64 = 2.0 * f64::EPSILON;
/// Two turning points closer than this, relative to their distance from the edge, are one: a level that is reached
/// again differs in its last digits.
pub(super) const SAME_TURNING_POINT: f64 = 1e-28;

/// A straight part of w - W over y: `offset + slope * y`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(in super::super) struct Line {
    pub(in super::super) offset: DoubleDouble,
    pub(in super::super) slope: DoubleDouble,
}

impl Line {
    pub(in super::super) fn at(&self, level: DoubleDouble) -> DoubleDouble {
        if self.slope == DoubleDouble::ZERO { self.offset } else { self.offset + rise(self.slope, level) }
    }
}

/// `slope * level`, without a product for the slopes -1, 0 and 1 of all moves at constant load.
pub(super) fn rise(slope: DoubleDouble, level: DoubleDouble) -> DoubleDouble {
    let (whole, rest) = slope.parts();
    if rest.abs() > 0.0 {
        slope * level
    } else if whole.abs() >= 1.0 {
        level.signed(whole)
    } else {
        level * whole
    }
}

/// Sums over the pieces for force and elastic energy, from the centre outward: `force` = sum of slope * int X dy,
/// `energy` = sum of slope * int (w - W) X dy, and `size`, the sum of the magnitudes in `force`, with which rounding
/// errors scale.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Sums {
    pub(super) force: DoubleDouble,
    pub(super) energy: DoubleDouble,
    pub(super) size: f64,
}

/// One straight piece, from its inner end to the next piece's (or to the edge).
#[derive(Clone, Copy, Default)]
pub(in super::super) struct Piece {
    pub(in super::super) inner: Point,
    pub(in super::super) line: Line,
    /// The line at the inner end.
    pub(in super::super) start: DoubleDouble,
    /// The sums over the pieces nearer the centre.
    pub(super) below: Sums,
    /// The integrals over its ring, if they were wanted since its outer end moved.
    pub(super) moments: Option<Moments>,
}

/// The state alone: the numbers kept for later moves follow from it.
impl fmt::Debug for Piece {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Piece { inner, line, start: _, below, moments: _ } = self;
        f.debug_struct("Piece").field("inner", inner).field("line", line).field("below", below).finish()
    }
}

impl Piece {
    /// A piece from `inner` on.
    pub(super) fn new(inner: Point, line: Line, below: Sums, moments: Option<Moments>) -> Piece {
        Piece { inner, line, start: line.at(inner.level), below, moments }
    }

    /// The integrals over its ring, which ends at `outer`.
    pub(super) fn moments_to(&self, limit: &impl Limit, outer: &Point) -> Moments {
        self.moments.unwrap_or_else(|| limit.moments(&Ring::between(self.inner, *outer)))
    }

    /// The sums up to `outer`, where the piece ends from now on.
    #[inline]
    pub(super) fn end_at(&mut self, limit: &impl Limit, outer: &Point) -> Sums {
        let slope = self.line.slope.value();
        if slope.abs() <= 0.0 {
            self.moments = None;
            return self.below;
        }
        let ring = Ring::between(self.inner, *outer);
        let moments = limit.moments(&ring);
        self.moments = Some(moments);
        self.below.and(&moments, &ring, slope, self.line.at(outer.level).value())
    }
}

impl Sums {
    /// With the share of a ring of these moments, over which w - W has this slope up to its value at the outer end.
    #[inline]
    pub(super) fn and(&self, moments: &Moments, ring: &Ring, slope: f64, carried: f64) -> Sums {
        // By parts: int X dy = x_inner depth + int h dx, int (y_outer - y) X dy = (x_inner depth^2 + int h^2 dx)/2.
        let load = ring.inner.radius * ring.depth + moments.first;
        let lever = 0.5 * (ring.inner.radius * ring.depth * ring.depth + moments.second);
        Sums {
            force: self.force + DoubleDouble::from(slope * load),
            energy: self.energy + DoubleDouble::from(slope * (carried * load - slope * lever)),
            size: self.size + slope.abs() * load,
        }
    }
}
