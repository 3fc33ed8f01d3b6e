//! When a straight move reaches a level of the slip history: instants at which its effect is not smooth.
//!
//! A stuck level y slips when its w reaches the bound: s (w + s dW) = d + s dd - y, s = +-1, over the part s of the
//! move.
//! All is linear in that part, so that the instants are exact.

use super::SlipHistory;
use crate::numerics::double_double::DoubleDouble;

/// A kink of w over y whose slopes differ by less is one that the chords of a curved move have left.
const REAL_KINK: f64 = 0.02;
/// An instant nearer than this to the start of a move belongs to it.
const BEGINNING: f64 = 1e-12;

impl SlipHistory {
    /// The parts of the straight move to (`d1`, `w1`), above 0 and below 1, after which the edge passes a level, m, or
    /// slip reaches it.
    pub(in super::super) fn passes(&self, (d1, w1): (DoubleDouble, DoubleDouble), level: f64) -> Vec<f64> {
        let (dd, dw) = ((d1 - self.edge.level).value(), (w1 - self.position).value());
        let depth = self.edge.level.value() - level;
        let mut parts = vec![-depth / dd];
        if depth >= 0.0 && self.in_contact() {
            let piece = self.pieces.partition_point(|piece| piece.inner.level.value() <= level).max(1) - 1;
            let line = &self.pieces[piece].line;
            parts.extend(slips((line.at(DoubleDouble::from(level)) + self.shift()).value(), depth, (dd, dw)));
        }
        parts.retain(|part| *part > BEGINNING && *part < 1.0);
        parts
    }

    /// The parts of that move, above 0 and below 1, after which its effect on every level changes: the edge or the slip
    /// wipes out a kink of the history, the contact closes or opens, slip begins anew.
    pub(in super::super) fn turns(&self, (d1, w1): (DoubleDouble, DoubleDouble)) -> Vec<f64> {
        let (d0, dd, dw) = (self.edge.level.value(), (d1 - self.edge.level).value(), (w1 - self.position).value());
        let mut parts = vec![-d0 / dd];
        for (index, piece) in self.pieces.iter().enumerate().rev() {
            let (level, slope) = (piece.inner.level.value(), piece.line.slope.value());
            let held = (piece.start + self.shift()).value();
            // Where unloading comes back along a line of the history, nothing slips for an instant.
            let back = -(held + slope * (d0 - level)) / (slope * dd + dw);
            if dd < 0.0 && self.ring(index).outer.level.value() >= d0 + dd * back && level <= d0 + dd * back {
                parts.push(back);
            }
            let depth = d0 - level;
            let first = slips(held, depth, (dd, dw)).chain([-depth / dd].into_iter().filter(|part| *part >= 0.0));
            let first = first.fold(f64::INFINITY, f64::min);
            let below = index.checked_sub(1).map_or(f64::NAN, |below| self.pieces[below].line.slope.value());
            if below.is_nan() || (below - slope).abs() >= REAL_KINK {
                parts.push(first);
            }
            if first > 1.0 {
                break;
            }
        }
        parts.retain(|part| *part > BEGINNING && *part < 1.0);
        parts
    }

    /// The levels, m, at which w has a kink that no chord of a curved move has left, from the edge inward.
    pub(in super::super) fn kink_levels(&self) -> impl Iterator<Item = f64> + '_ {
        self.pieces.windows(2).rev().filter_map(|pair| {
            let change = (pair[1].line.slope - pair[0].line.slope).value().abs();
            (change >= REAL_KINK).then(|| pair[1].inner.level.value())
        })
    }
}

/// After which parts a level that holds w, so deep below the edge, reaches its bound on either side.
fn slips(held: f64, depth: f64, (dd, dw): (f64, f64)) -> impl Iterator<Item = f64> {
    [1.0, -1.0].into_iter().filter_map(move |sign| {
        let rate = sign * dw - dd;
        (rate > 0.0).then(|| ((depth - sign * held) / rate).max(0.0))
    })
}
