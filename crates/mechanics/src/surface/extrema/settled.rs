//! Intervals between kinks of the slip history in which the sign of d tau/d(r^2) is known without a search, or has one
//! change at most.
//!
//! With s_i the slope of the piece over the ring i and r in the ring j, whose outer end is c, d tau/d(r^2) is a
//! positive factor times s_j D - sum over i > j of s_i R_i. D = -dK(r, c)/d(r^2) falls as c grows, and R_i = int dy/(2
//! v^3) > 0 over the levels of the ring i, v = sqrt(x^2 - r^2), since d^2 K/(d(r^2) dc) = g'(c)/(2 v^3) > 0. The sign
//! is that of s_j in two cases:
//!
//! - The bends s_(i+1) - s_i alternate in sign and do not grow outward, and the kernel up to the edge falls: by parts,
//!   the sum is an alternating one of the D up to each kink, none of which is below that up to the edge, led by the
//!   first.
//! - The slopes alternate in sign, their size times the depth of the ring does not grow outward beyond the ring j, and
//!   the kernel up to c falls: v only grows outward, so each R_i outweighs the next, and the first of them has the sign
//!   of s_j D.
//!
//! Whether a kernel falls is known from [`Falls::least`](crate::cells::falls::Falls), once for all r of an
//! interval. Where it may not, but g'/x rises ever less with x^2
//! ([`Falls::concavely`](crate::cells::falls::Falls)), D grows with r. Then the derivative over that of the
//! factor grows away from zero too, and changes its sign once at most, in the same two cases: dD/d(r^2) falls as c
//! grows, as D does, by d^2 D/(d(r^2) dc) = -3 g'(c)/(4 v^5), and of the dR_i/d(r^2) = int 3 dy/(4 v^5) each outweighs
//! the next.

use std::cell::LazyCell;

use crate::contact::Contact;
use crate::profile::Ring;

/// The growth of a share outward that the rounding of levels explains: as much as the search takes for zero.
const SAME_SHARE: f64 = super::NOISE;

/// The order of bends and slopes from one piece outward.
#[derive(Clone, Copy)]
struct Outward {
    /// The bends alternate and do not grow.
    bends: bool,
    /// The slopes alternate, and their shares do not grow beyond this piece.
    slopes: bool,
}

/// Knowledge about the derivative in the ring of a piece, from a radius in it outward.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Known {
    /// It has the sign of the piece's slope.
    Sign,
    /// It changes its sign once at most, to that of the piece's slope.
    OneChange,
    /// Nothing.
    Nothing,
}

/// The pieces of a slip history, with the order of bends and slopes from each outward.
pub(super) struct Settled<'a> {
    contact: &'a Contact,
    pieces: Vec<Outward>,
}

impl Settled<'_> {
    /// Knowledge about the derivative in the ring of a piece from the radius `from`, m, on.
    pub(super) fn known(&self, index: usize, from: f64) -> Known {
        let Outward { bends, slopes } = self.pieces[index];
        let profile = &self.contact.indenter;
        let (outer, edge) = (self.contact.history.ring(index).outer.radius, self.contact.history.edge().radius);
        let to_edge = LazyCell::new(|| profile.falls(from, edge));
        if bends && to_edge.least > 0.0 || slopes && profile.falls(from, outer).least > 0.0 {
            Known::Sign
        } else if (bends || slopes) && to_edge.concavely {
            Known::OneChange
        } else {
            Known::Nothing
        }
    }
}

impl Contact {
    /// The order of the bends and slopes of the slip history.
    pub(super) fn settled(&self) -> Settled<'_> {
        let pieces = self.history.pieces();
        let slope = |index: usize| pieces.get(index).map_or(0.0, |piece| piece.line.slope.value());
        let bend = |index: usize| slope(index + 1) - slope(index);
        let rings: Vec<Ring> = (0..pieces.len()).map(|index| self.history.ring(index)).collect();
        let share = |index: usize| slope(index).abs() * rings[index].depth;
        // At a vertical edge stresses are infinite, whatever lies inside it.
        let upright = rings.last().is_some_and(|ring| self.indenter.edge_depth(ring) > 0.0);
        let mut settled = vec![Outward { bends: false, slopes: false }; pieces.len()];
        let mut beyond = Outward { bends: true, slopes: true };
        for index in (0..pieces.len()).rev() {
            let last = index + 1 == pieces.len();
            beyond.bends &= if last {
                // Without a bend at the edge there is no first term to lead.
                bend(index).abs() > 0.0 && !upright
            } else {
                bend(index) * bend(index + 1) < 0.0 && bend(index).abs() >= bend(index + 1).abs()
            };
            beyond.slopes &= if last {
                slope(index).abs() > 0.0
            } else {
                let falls = index + 2 >= pieces.len() || share(index + 1) * (1.0 + SAME_SHARE) >= share(index + 2);
                slope(index) * slope(index + 1) < 0.0 && falls
            };
            settled[index] = Outward { slopes: beyond.slopes && !(last && upright), ..beyond };
        }
        Settled { contact: self, pieces: settled }
    }
}
