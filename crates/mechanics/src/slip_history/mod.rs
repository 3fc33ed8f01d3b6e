//! The slip history of a contact: a stack of straight pieces.
//!
//! Let y = g(x) run from 0 at the centre to the indentation d at the edge, w = u_x/m be the tangential displacement of
//! the surface and W = U/m that of the indenter, both scaled by m = mu E*/G*. A point at y slips where |w| reaches
//! d - y. For every path straight in (d, W), w is a continuous, piecewise straight function of y with slopes from -1
//! to 1, and the slip of one move is one outer ring y > y*. Hence each move works on the top of the stack alone: whole
//! pieces beyond the bound are popped, the next is cut where it meets the bound, and one straight slip piece is pushed.
//! Stuck pieces are stored relative to the indenter, so that a move does not change them. The rule is Masing's with
//! wiping-out at constant load, and that of the memory diagrams of Aleshin & Van Den Abeele (2012) at a changing one.
//!
//! The cost of a move is constant on average, whatever came before; nothing is discretised, and turning points are kept
//! as absolute positions, so no error accumulates.

mod bounded;
mod friction_work;
mod instants;
pub(crate) mod limit;
mod packed;
mod piece;
mod undo;

use crate::numerics::double_double::DoubleDouble;
use crate::profile::{Moments, Point, Ring};
use crate::slip_history::limit::Limit;
use friction_work::{SlipRing, Unloading};
pub(super) use piece::{Line, Piece};
use piece::{SAME_TURNING_POINT, Sums, THINNEST_CORE, rise};

/// The largest share of a change of the load that may be rounding.
const ROUNDED_SHARE: f64 = 1e-6;

/// The state of the tangential problem in scaled units: lengths in m, integrals of X over y in m^2.
#[derive(Clone, Debug, Default)]
pub(super) struct SlipHistory {
    /// From the centre outward; empty without contact.
    pieces: Vec<Piece>,
    /// Level d and radius a of the edge; a level below zero is a gap.
    edge: Point,
    total: Sums,
    /// W, and the value it had when the stack was last begun: pieces are relative to the latter.
    position: DoubleDouble,
    reference: DoubleDouble,
    /// y*, where the slip of the last move began; `None` if nothing slipped. A move that closes an inner loop exactly
    /// wipes out pieces that it left stuck, so this may lie outside the inner end of the top piece.
    slip_from: Option<Point>,
    /// What a move that may yet fail needs to be undone.
    mark: Option<Box<undo::Mark>>,
    #[cfg(test)]
    _copies: super::cells::call_count::CountedCopies,
}

impl SlipHistory {
    /// A virgin contact at indentation d, m.
    pub(super) fn new(limit: &impl Limit, indentation: DoubleDouble) -> SlipHistory {
        let mut history = SlipHistory { edge: edge_at(limit, indentation), ..SlipHistory::default() };
        if history.in_contact() {
            // The whole contact as one unloaded piece.
            let inner = limit.centre();
            history.pieces.push(Piece { inner, ..Piece::default() });
        }
        history
    }

    /// The same virgin contact where the scaled displacement is `position`, m.
    pub(super) fn at_position(self, position: DoubleDouble) -> SlipHistory {
        SlipHistory { position, reference: position, ..self }
    }

    /// Becomes a copy of `other` in the memory that it has; no move is under way.
    pub(super) fn copy_from(&mut self, other: &SlipHistory) {
        self.pieces.clone_from(&other.pieces);
        self.mark = None;
        let &SlipHistory { edge, total, position, reference, slip_from, .. } = other;
        (self.edge, self.total, self.slip_from) = (edge, total, slip_from);
        (self.position, self.reference) = (position, reference);
    }

    /// Whether nothing has moved it since it touched, or all of it slides along unloaded: w = 0 everywhere.
    pub(super) fn is_virgin(&self) -> bool {
        self.total.size <= 0.0 && self.shift() == DoubleDouble::ZERO
    }

    pub(super) fn pieces(&self) -> &[Piece] {
        &self.pieces
    }

    pub(super) fn edge(&self) -> &Point {
        &self.edge
    }

    /// W, m.
    pub(super) fn position(&self) -> DoubleDouble {
        self.position
    }

    /// W since the stack was begun: added to a stored w - W it gives w.
    pub(super) fn shift(&self) -> DoubleDouble {
        self.position - self.reference
    }

    pub(super) fn slip_from(&self) -> Option<&Point> {
        self.slip_from.as_ref()
    }

    /// Whether the last move slipped and has left the trace of gross slip alone: the whole contact at its bound,
    /// whether it slipped all of it or closed a loop that began there.
    pub(super) fn slipped_to_one_piece(&self) -> bool {
        self.slip_from.is_some() && self.pieces.len() == 1
    }

    pub(super) fn in_contact(&self) -> bool {
        self.edge.level.value() > 0.0
    }

    /// int_0^a w dx, m^2; times 2 G* m it is the tangential force.
    pub(super) fn force(&self) -> f64 {
        -self.total.force.value()
    }

    /// The sum of the magnitudes of the terms of [`SlipHistory::force`], m^2.
    pub(super) fn force_size(&self) -> f64 {
        self.total.size
    }

    /// The share of int_0^a w dx that the pieces nearer the centre than piece `index` have.
    pub(super) fn force_below(&self, index: usize) -> DoubleDouble {
        -self.pieces[index].below.force
    }

    /// int_0^a w^2 dx / 2, m^3; times 2 G* m^2 it is the elastic energy.
    pub(super) fn energy(&self) -> f64 {
        -(self.shift() * self.total.force + self.total.energy).value()
    }

    /// The rings of the stack with their lines, from the edge inward.
    pub(super) fn rings(&self) -> impl DoubleEndedIterator<Item = (Ring, &Line)> {
        self.pieces.iter().enumerate().rev().map(|(index, piece)| (self.ring(index), &piece.line))
    }

    /// The ring of piece `index`.
    pub(super) fn ring(&self, index: usize) -> Ring {
        let outer = self.pieces.get(index + 1).map_or(self.edge, |next| next.inner);
        Ring::between(self.pieces[index].inner, outer)
    }

    /// The friction work on the ring that leaves the contact on the way to indentation `d1` and scaled displacement
    /// `w1`.
    fn unloading_work(&self, limit: &impl Limit, d1: DoubleDouble, w1: DoubleDouble) -> f64 {
        let (from, advance, shift) = (self.edge.level, w1 - self.position, self.shift());
        Unloading { from, to: d1, advance, shift }.work(limit, self.rings(), self.pieces.first())
    }

    /// The same slopes over other levels, at whose points they then begin: what stresses read, without sums and without
    /// a position.
    pub(super) fn moved_to(&self, point: impl Fn(DoubleDouble) -> Point) -> SlipHistory {
        let moved = |piece: &Piece| {
            let line = Line { slope: piece.line.slope, ..Line::default() };
            Piece::new(point(piece.inner.level), line, Sums::default(), None)
        };
        let edge = if self.in_contact() { point(self.edge.level) } else { self.edge };
        let mut pieces: Vec<Piece> = Vec::with_capacity(self.pieces.len());
        for piece in self.pieces.iter().map(moved) {
            // A ring that is thinner than the rounding of its levels has none left.
            pieces.retain(|before| before.inner.level < piece.inner.level);
            pieces.push(piece);
        }
        pieces.retain(|piece| piece.inner.level < edge.level);
        SlipHistory { pieces, edge, ..SlipHistory::default() }
    }

    /// w at a level, m.
    pub(super) fn deflection(&self, level: DoubleDouble) -> f64 {
        let piece = self.pieces.iter().rfind(|piece| piece.inner.level <= level).or(self.pieces.first());
        piece.map_or(0.0, |piece| (piece.line.at(level) + self.shift()).value())
    }

    /// Bytes held beyond the struct itself.
    pub(super) fn heap_bytes(&self) -> usize {
        self.pieces.capacity() * size_of::<Piece>()
    }

    /// Moves along the straight line to indentation `d1` and scaled displacement `w1`. Returns the friction work over
    /// 2 G* m^2, m^3.
    #[must_use]
    pub(super) fn advance(&mut self, limit: &impl Limit, d1: DoubleDouble, w1: DoubleDouble) -> f64 {
        self.slip_from = None;
        if !self.in_contact() {
            let d0 = self.edge.level;
            if d1.value() <= 0.0 {
                self.place(limit, d1, w1);
                return 0.0;
            }
            let touching = self.position + ((w1 - self.position) * (-d0)).over(d1 - d0);
            self.place(limit, DoubleDouble::ZERO, touching);
        }
        if d1.value() <= 0.0 {
            let work = self.unloading_work(limit, d1, w1);
            self.place(limit, d1, w1);
            return work;
        }
        let dw = w1 - self.position;
        let dd = if d1 == self.edge.level { DoubleDouble::ZERO } else { d1 - self.edge.level };
        if dd >= dw.abs() {
            self.grow(limit, d1, w1);
            return 0.0;
        }
        self.slip(limit, (d1, w1), (dd, dw))
    }

    /// Out of contact, or just touching: a position and nothing else.
    fn place(&mut self, limit: &impl Limit, indentation: DoubleDouble, position: DoubleDouble) {
        self.cut_to(0);
        self.total = Sums::default();
        self.edge = edge_at(limit, indentation);
        self.position = position;
        self.reference = position;
    }

    /// The load rises at least as fast as the indenter moves: nothing slips, and what is touched on the way keeps the
    /// displacement gained since its touch.
    fn grow(&mut self, limit: &impl Limit, d1: DoubleDouble, w1: DoubleDouble) {
        let d0 = self.edge.level;
        let rise = d1 - d0;
        if rise.value() <= 0.0 {
            return;
        }
        let slope = -(w1 - self.position).over(rise);
        let inner = self.edge;
        self.position = w1;
        self.edge = edge_at(limit, d1);
        // A straight path in two steps is one path: the top piece is drawn out as long as it still meets the edge.
        let straight_on = self.pieces.last().is_some_and(|top| {
            let off = (top.line.at(d1) + self.shift()).abs();
            off.value() <= round_off(d1, self.shift(), rise)
        });
        if straight_on {
            self.close(limit);
        } else {
            let ring = Ring::between(inner, self.edge);
            self.push_through(&limit.moments(&ring), &ring, (slope, self.shift()), self.total);
        }
    }

    /// An outer ring slips on the way to (d1, w1), which is (dd, dw) from here.
    fn slip(
        &mut self,
        limit: &impl Limit,
        (d1, w1): (DoubleDouble, DoubleDouble),
        (dd, dw): (DoubleDouble, DoubleDouble),
    ) -> f64 {
        let mut work = 0.0;
        let (sign, mut excess);
        if dd.value() < 0.0 {
            work += self.unloading_work(limit, d1, w1);
            while self.pieces.last().is_some_and(|top| top.inner.level >= d1) {
                self.pop();
            }
            self.edge = edge_at(limit, d1);
            self.position = w1;
            if let Some(top) = self.pieces.last_mut() {
                top.moments = None;
            }
            let trial = self.pieces.last().map_or(DoubleDouble::ZERO, |top| top.line.at(d1)) + self.shift();
            if trial.abs().value() <= round_off(d1, self.shift(), dd) {
                // The move takes the last rise of the load back along the same line.
                self.close(limit);
                return work;
            }
            sign = trial.value().signum();
            excess = trial.value().abs();
        } else {
            self.position = w1;
            sign = dw.value().signum();
            excess = if dd == DoubleDouble::ZERO { dw.value().abs() } else { (dw.signed(sign) - dd).value() };
        }
        let (mut rate, mut lag) = (0.0, 0.0);
        if dd != DoubleDouble::ZERO {
            rate = (dw.signed(sign) - dd).value();
            lag = if rate > 0.0 { dd.value() / (2.0 * rate) } else { 0.0 };
        }
        let shift = self.shift();
        let slipping = SlipRing { sign, shift, indentation: d1, lag };
        if dd.value() > 0.0 {
            let touched = Ring::between(self.edge, edge_at(limit, d1));
            let core = if self.pieces.is_empty() { touched.inner.radius * touched.depth * touched.depth } else { 0.0 };
            work += (limit.moments(&touched).second + core) * rate / (2.0 * dd.value());
        }
        let mut outer = self.edge;
        let mut slipped = None;
        // Where a loop closes, the old pieces within it lie at the bound and are popped, though they did not slip.
        let at_bound = closes_at(d1, shift, excess);
        let mut stuck_from = None;
        let start = loop {
            if stuck_from.is_none() && excess <= at_bound {
                stuck_from = Some(outer);
            }
            let Some(top) = self.pieces.last() else { break limit.centre() };
            let inward = slipping.inward(top);
            if let Some(level) = slipping.crossing(top, &inward, &outer) {
                let cut = limit.point(level);
                let ring = Ring::between(cut, outer);
                let moments = limit.moments(&ring);
                work += slipping.work(&moments, &top.line, excess, &ring);
                // At constant load, a slip that stays within one piece is itself the piece to be pushed.
                slipped = (outer.level == d1).then_some(moments);
                break cut;
            }
            let ring = Ring::between(top.inner, outer);
            work += slipping.work(&top.moments_to(limit, &outer), &top.line, excess, &ring);
            excess = inward.excess.value();
            outer = top.inner;
            self.pop();
            if self.pieces.is_empty() {
                work += slipping.core_work(excess, outer.radius);
            }
        };
        if dd.value() > 0.0 {
            self.edge = edge_at(limit, d1);
        }
        let below = if let Some(top) = self.pieces.last_mut() {
            top.end_at(limit, &start)
        } else {
            self.reference = w1;
            Sums::default()
        };
        self.slip_from = Some(stuck_from.unwrap_or(start));
        if start.level < d1 {
            let ring = Ring::between(start, self.edge);
            let moments = slipped.unwrap_or_else(|| limit.moments(&ring));
            let shift = if self.pieces.is_empty() { DoubleDouble::ZERO } else { shift };
            self.push_through(&moments, &ring, (DoubleDouble::from(-sign), shift), below);
        } else {
            self.slip_from = None;
            self.total = below;
        }
        work
    }

    /// Adds a piece of the given slope over `ring`, which ends at the edge, where w = 0 and w - W is what `shift`
    /// undoes.
    fn push_through(
        &mut self,
        moments: &Moments,
        ring: &Ring,
        (slope, shift): (DoubleDouble, DoubleDouble),
        below: Sums,
    ) {
        let line = Line { offset: -(shift + rise(slope, self.edge.level)), slope };
        self.pieces.push(Piece::new(ring.inner, line, below, Some(*moments)));
        self.total = below.and(moments, ring, slope.value(), -shift.value());
    }

    /// Sums up to the edge, from the sums below the top piece.
    fn close(&mut self, limit: &impl Limit) {
        let edge = self.edge;
        self.total = self.pieces.last_mut().map_or_else(Sums::default, |top| top.end_at(limit, &edge));
    }
}

/// The error of w at the edge by the rounding of a path, seen from where the contact last slid as a whole: how far
/// it has slid before does not count. A change of the load by a few units in the last place is followed exactly as
/// given.
fn round_off(indentation: DoubleDouble, shift: DoubleDouble, change: DoubleDouble) -> f64 {
    (THINNEST_CORE * (indentation.value() + shift.value().abs())).min(ROUNDED_SHARE * change.value().abs())
}

/// An excess over the bound up to this, m, is rounding; `change` is that of the move at the edge.
fn closes_at(indentation: DoubleDouble, shift: DoubleDouble, change: f64) -> f64 {
    (SAME_TURNING_POINT * (indentation.value() + shift.value().abs())).min(ROUNDED_SHARE * change)
}

/// The edge of a contact at `indentation`; with a gap there is none, and its radius is zero.
fn edge_at(limit: &impl Limit, indentation: DoubleDouble) -> Point {
    if indentation.value() < 0.0 { Point { level: indentation, ..Point::default() } } else { limit.point(indentation) }
}
