//! Friction work of one straight move: slip distance times friction bound, in closed form ring by ring.
//!
//! A point at level y that slips towards `sign` does so at a constant rate from some instant until the end of the move,
//! or until it leaves the contact, while its bound d - y changes at a constant rate. So its work is its slip times the
//! mean of the bound at both ends, a quadratic in y; no instant is simulated. Every term is positive: nothing cancels
//! however small the move. Works here are over 2 G* m^2, in m^3.

use super::piece::{Line, Piece, SAME_TURNING_POINT, THINNEST_CORE};
use crate::numerics::double_double::DoubleDouble;
use crate::profile::{Moments, Point, Ring};
use crate::slip_history::limit::Limit;

/// The ring that slips at the end of a move: towards `sign`, with w = sign (indentation - y).
pub(super) struct SlipRing {
    pub(super) sign: f64,
    /// Turns a stored w - W into w at the end of the move.
    pub(super) shift: DoubleDouble,
    /// Indentation at the end of the move, m.
    pub(super) indentation: DoubleDouble,
    /// Change of the bound while a point slips by two units of length.
    pub(super) lag: f64,
}

/// The inner end of a piece on the way of a slip.
pub(super) struct Inward {
    /// How far the stuck value would exceed the bound there, m; it never falls towards the edge.
    pub(super) excess: DoubleDouble,
    /// Its level over the indentation at the end of the move, m.
    height: f64,
}

impl SlipRing {
    /// The slip at the inner end of a piece.
    pub(super) fn inward(&self, piece: &Piece) -> Inward {
        let height = piece.inner.level - self.indentation;
        Inward { excess: (piece.start + self.shift).signed(self.sign) + height, height: height.value() }
    }

    /// The level within the piece at which slip begins; `None` if the whole piece slips.
    pub(super) fn crossing(&self, piece: &Piece, inward: &Inward, outer: &Point) -> Option<DoubleDouble> {
        let inner_excess = inward.excess;
        if inner_excess.value() >= 0.0 {
            return None;
        }
        // After constant load, slopes are -1, 0 or 1 and the division is a halving at most.
        let stuck_depth = match piece.line.slope.signed(self.sign).parts() {
            (slope, rest) if rest.abs() <= 0.0 && slope.abs() <= 0.0 => -inner_excess,
            (slope, rest) if rest.abs() <= 0.0 && slope >= 1.0 => (-inner_excess).halved(),
            _ => {
                let closing = DoubleDouble::from(1.0) + piece.line.slope.signed(self.sign);
                if closing.value() <= 0.0 {
                    return Some(outer.level);
                }
                -inner_excess.over(closing)
            }
        };
        let core = piece.inner.level.value() <= 0.0;
        let same = if core { THINNEST_CORE } else { SAME_TURNING_POINT };
        if stuck_depth.value() <= same * -inward.height {
            return None;
        }
        let level = piece.inner.level + stuck_depth;
        Some(if level < outer.level { level } else { outer.level })
    }

    /// Work on a ring of one old piece, all of which slipped, from the excess at its outer end.
    pub(super) fn work(&self, moments: &Moments, line: &Line, slip: f64, ring: &Ring) -> f64 {
        if ring.depth <= 0.0 {
            return 0.0;
        }
        let growth = 1.0 + self.sign * line.slope.value();
        let bound =
            if self.indentation == ring.outer.level { 0.0 } else { (self.indentation - ring.outer.level).value() };
        let mean = bound - self.lag * slip;
        let mean_growth = 1.0 + self.lag * growth;
        let Moments { width, first, second } = *moments;
        let work = slip * mean * width + (slip * mean_growth - growth * mean) * first - growth * mean_growth * second;
        work.max(0.0)
    }

    /// Work on a flat core of `radius`, all of it at level zero, where the excess is `slip`.
    pub(super) fn core_work(&self, slip: f64, radius: f64) -> f64 {
        let slip = slip.max(0.0);
        radius * slip * (self.indentation.value() - self.lag * slip)
    }
}

/// A fall of the indentation while the indenter moves.
pub(super) struct Unloading {
    /// Indentation at the start and at the end, m.
    pub(super) from: DoubleDouble,
    pub(super) to: DoubleDouble,
    /// The advance of the indenter meanwhile, scaled, m.
    pub(super) advance: DoubleDouble,
    /// Turns a stored w - W into w at the start.
    pub(super) shift: DoubleDouble,
}

impl Unloading {
    /// Work on the ring that leaves the contact: each point slips back to w = 0 before it lifts off, whatever the sign
    /// of its displacement. `rings` come from the edge inward, `core` is the innermost piece.
    pub(super) fn work<'a>(
        &self,
        limit: &impl Limit,
        rings: impl Iterator<Item = (Ring, &'a Line)>,
        core: Option<&Piece>,
    ) -> f64 {
        let fall = self.from - self.to;
        let lowest = if self.to.value() > 0.0 { self.to } else { DoubleDouble::ZERO };
        // The displacement of a point at y at its lift-off, by w - W and the position of the indenter by then.
        let drift = self.advance.over(fall);
        let carried = |line: &Line, level: DoubleDouble| line.at(level) + self.shift + drift * (self.from - level);
        let (drift, fall) = (drift.value(), fall.value());
        // The bound falls by `fall` while the slip gains `rate`: slip^2 fall/(2 rate) a point.
        let share = |carried_sign: f64| {
            let rate = carried_sign * drift + 1.0;
            if rate > 0.0 { 0.5 / rate } else { 0.0 }
        };
        debug_assert!(fall > 0.0);
        let mut work = 0.0;
        for (ring, line) in rings {
            if ring.outer.level <= lowest {
                break;
            }
            let inner = if ring.inner.level < lowest { limit.point(lowest) } else { ring.inner };
            let (at_inner, at_outer) = (carried(line, inner.level), carried(line, ring.outer.level));
            let steep = (at_outer - at_inner).value();
            let parts = if at_inner.value() * at_outer.value() < 0.0 {
                let fraction = at_inner.over(at_inner - at_outer);
                let middle = limit.point(inner.level + (ring.outer.level - inner.level) * fraction);
                [Some((Ring::between(inner, middle), 0.0)), Some((Ring::between(middle, ring.outer), at_outer.value()))]
            } else {
                [Some((Ring::between(inner, ring.outer), at_outer.value())), None]
            };
            let whole = (ring.outer.level - inner.level).value();
            for (part, end) in parts.into_iter().flatten() {
                if part.depth <= 0.0 {
                    continue;
                }
                let slope = steep / whole;
                let middle = end - 0.5 * slope * part.depth;
                let Moments { width, first, second } = limit.moments(&part);
                let squares = end * end * width - 2.0 * end * slope * first + slope * slope * second;
                work += share(middle.signum()) * squares.max(0.0);
            }
        }
        if self.to.value() <= 0.0
            && let Some(core) = core
        {
            let held = carried(&core.line, DoubleDouble::ZERO).value();
            work += core.inner.radius * share(held.signum()) * held * held;
        }
        work
    }
}
