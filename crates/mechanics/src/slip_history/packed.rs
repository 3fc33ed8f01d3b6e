//! The history as bytes: edge, sums up to it, position, reference, whether and where the last slip began, then the
//! pieces.
//!
//! The pieces come last, so that their number follows from the length, and no stored length can request more memory
//! than there are bytes.

use super::{Line, Piece, Point, SlipHistory, Sums};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::packing::{Packed, Reader, packed};

/// Bytes before the pieces: edge, sums, position, reference, mark and start of slip.
const HEAD: usize = 2 * size_of::<Point>() + size_of::<Sums>() + 2 * size_of::<DoubleDouble>() + size_of::<f64>();
/// Bytes of a piece: its inner end, its line, the sums below it.
const PIECE: usize = size_of::<Point>() + size_of::<Line>() + size_of::<Sums>();

packed!(Point { level, radius, square });
packed!(Line { offset, slope });
packed!(Sums { force, energy, size });

impl SlipHistory {
    pub(in super::super) fn packed_length(&self) -> usize {
        HEAD + PIECE * self.pieces.len()
    }
}

impl Packed for SlipHistory {
    fn pack(&self, bytes: &mut Vec<u8>) {
        self.edge.pack(bytes);
        self.total.pack(bytes);
        self.position.pack(bytes);
        self.reference.pack(bytes);
        f64::from(u8::from(self.slip_from.is_some())).pack(bytes);
        self.slip_from.unwrap_or_default().pack(bytes);
        for piece in &self.pieces {
            piece.inner.pack(bytes);
            piece.line.pack(bytes);
            piece.below.pack(bytes);
        }
    }

    /// `None` unless the numbers are finite, the pieces rise from the centre to the edge, and there are some if and
    /// only if there is a contact.
    fn unpack(reader: &mut Reader<'_>) -> Option<SlipHistory> {
        let (edge, total): (Point, _) = (Packed::unpack(reader)?, Packed::unpack(reader)?);
        let (position, reference) = (Packed::unpack(reader)?, Packed::unpack(reader)?);
        let slips = f64::unpack(reader)? > 0.0;
        let slip_from = Some(Packed::unpack(reader)?).filter(|_| slips);
        let count = reader.count(PIECE)?;
        let mut pieces: Vec<Piece> = Vec::with_capacity(count);
        for _ in 0..count {
            let (inner, line) = (Point::unpack(reader)?, Packed::unpack(reader)?);
            let sound = match pieces.last() {
                None => inner.level == DoubleDouble::ZERO,
                Some(below) => inner.level >= below.inner.level,
            };
            if !sound || inner.level >= edge.level {
                return None;
            }
            pieces.push(Piece::new(inner, line, Packed::unpack(reader)?, None));
        }
        let history = SlipHistory { pieces, edge, total, position, reference, slip_from, ..SlipHistory::default() };
        (history.in_contact() != history.pieces.is_empty()).then_some(history)
    }
}
