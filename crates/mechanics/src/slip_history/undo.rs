//! A move is undone by truncation: the pieces that it has taken off the stack are put back.
//!
//! A move works on the top of the stack alone, and what it leaves of the pieces below is unchanged but for the
//! integrals that a piece keeps. So the cost of a mark and of the return to it is that of the moves in between, however
//! long the history is.

use super::{Piece, Point, SlipHistory, Sums};
use crate::numerics::double_double::DoubleDouble;

/// The state to return to: the pieces below `kept` are still on the stack, `taken` are those above, the outermost
/// first.
#[derive(Clone, Debug)]
pub(super) struct Mark {
    kept: usize,
    taken: Vec<Piece>,
    edge: Point,
    total: Sums,
    position: DoubleDouble,
    reference: DoubleDouble,
    slip_from: Option<Point>,
}

impl SlipHistory {
    /// Keeps what [`SlipHistory::return_to_mark`] needs, from here on.
    pub(in super::super) fn mark(&mut self) {
        let &mut SlipHistory { edge, total, position, reference, slip_from, .. } = self;
        let kept = self.pieces.len();
        self.mark = Some(Box::new(Mark { kept, taken: Vec::new(), edge, total, position, reference, slip_from }));
    }

    /// Keeps it no longer.
    pub(in super::super) fn unmark(&mut self) {
        self.mark = None;
    }

    /// Undoes all moves since the mark.
    pub(in super::super) fn return_to_mark(&mut self) {
        let Some(mark) = self.mark.take() else { return };
        let Mark { kept, taken, edge, total, position, reference, slip_from } = *mark;
        self.pieces.truncate(kept);
        if let Some(top) = self.pieces.last_mut() {
            top.moments = None;
        }
        self.pieces.extend(taken.into_iter().rev().map(|piece| Piece { moments: None, ..piece }));
        (self.edge, self.total, self.position) = (edge, total, position);
        (self.reference, self.slip_from) = (reference, slip_from);
    }

    /// Takes all pieces but so many off the stack.
    pub(super) fn cut_to(&mut self, count: usize) {
        if let Some(mark) = &mut self.mark
            && count < mark.kept
        {
            mark.taken.extend(self.pieces[count..mark.kept].iter().rev());
            mark.kept = count;
        }
        self.pieces.truncate(count);
    }

    /// Takes the outermost piece off the stack.
    pub(super) fn pop(&mut self) {
        self.cut_to(self.pieces.len().saturating_sub(1));
    }
}
