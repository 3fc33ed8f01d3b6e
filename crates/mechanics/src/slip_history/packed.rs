//! The history as bytes: edge, sums up to it, position, reference, whether and where the last slip began, then the
//! pieces.
//!
//! The pieces come last, so that their number follows from the length, and no stored length can request more memory
//! than there are bytes.

use super::super::packed::{Reader, Writer};
use super::{DoubleDouble, Line, Piece, SlipHistory, Sums};

/// Numbers of a level with its radius.
const POINT: usize = 5;
/// Numbers of the sums.
const SUMS: usize = 5;
/// Bytes before the pieces: edge, sums, position, reference, mark and start of slip.
const HEAD: usize = (POINT + SUMS + 2 + 2 + 1 + POINT) * size_of::<f64>();
/// Bytes of a piece: its inner end, its line, the sums below it.
const PIECE: usize = (POINT + 4 + SUMS) * size_of::<f64>();

impl SlipHistory {
    pub(in super::super) fn packed_length(&self) -> usize {
        HEAD + PIECE * self.pieces.len()
    }

    pub(in super::super) fn pack(&self, writer: &mut Writer) {
        writer.point(&self.edge);
        self.total.pack(writer);
        writer.double(self.position);
        writer.double(self.reference);
        writer.number(if self.slip_from.is_some() { 1.0 } else { 0.0 });
        writer.point(&self.slip_from.unwrap_or_default());
        for piece in &self.pieces {
            writer.point(&piece.inner);
            writer.double(piece.line.offset);
            writer.double(piece.line.slope);
            piece.below.pack(writer);
        }
    }

    /// `None` unless the numbers are finite, the pieces rise from the centre to the edge, and there are some if and
    /// only if there is a contact.
    pub(in super::super) fn unpack(reader: &mut Reader<'_>) -> Option<SlipHistory> {
        let edge = reader.point()?;
        let total = Sums::unpack(reader)?;
        let (position, reference) = (reader.double()?, reader.double()?);
        let slips = reader.number()? > 0.0;
        let slip_from = Some(reader.point()?).filter(|_| slips);
        let count = reader.count(PIECE)?;
        let mut pieces: Vec<Piece> = Vec::with_capacity(count);
        for _ in 0..count {
            let inner = reader.point()?;
            let line = Line { offset: reader.double()?, slope: reader.double()? };
            let sound = match pieces.last() {
                None => inner.level == DoubleDouble::ZERO,
                Some(below) => inner.level >= below.inner.level,
            };
            if !sound || inner.level >= edge.level {
                return None;
            }
            pieces.push(Piece::new(inner, line, Sums::unpack(reader)?, None));
        }
        let history = SlipHistory { pieces, edge, total, position, reference, slip_from };
        (history.in_contact() != history.pieces.is_empty()).then_some(history)
    }
}

impl Sums {
    fn pack(&self, writer: &mut Writer) {
        writer.double(self.force);
        writer.double(self.energy);
        writer.number(self.size);
    }

    fn unpack(reader: &mut Reader<'_>) -> Option<Sums> {
        Some(Sums { force: reader.double()?, energy: reader.double()?, size: reader.number()? })
    }
}
