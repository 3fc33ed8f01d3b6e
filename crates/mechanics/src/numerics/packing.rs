//! Values as bytes, one number after the other: little-endian `f64`.

use super::double_double::DoubleDouble;

/// A value that is written as numbers one after the other, and read again if all are finite.
pub(crate) trait Packed: Sized {
    fn pack(&self, bytes: &mut Vec<u8>);
    fn unpack(reader: &mut Reader<'_>) -> Option<Self>;
}

/// A struct is packed field by field.
macro_rules! packed {
    ($Type:ident { $($field:ident),+ }) => {
        impl Packed for $Type {
            fn pack(&self, bytes: &mut Vec<u8>) {
                $(self.$field.pack(bytes);)+
            }

            fn unpack(reader: &mut Reader<'_>) -> Option<Self> {
                Some($Type { $($field: Packed::unpack(reader)?),+ })
            }
        }
    };
}
pub(crate) use packed;

impl Packed for f64 {
    fn pack(&self, bytes: &mut Vec<u8>) {
        bytes.extend_from_slice(&self.to_le_bytes());
    }

    fn unpack(reader: &mut Reader<'_>) -> Option<f64> {
        reader.any().filter(|value| value.is_finite())
    }
}

impl Packed for DoubleDouble {
    fn pack(&self, bytes: &mut Vec<u8>) {
        let (hi, lo) = self.parts();
        hi.pack(bytes);
        lo.pack(bytes);
    }

    fn unpack(reader: &mut Reader<'_>) -> Option<DoubleDouble> {
        Some(DoubleDouble::from_parts(f64::unpack(reader)?, f64::unpack(reader)?))
    }
}

/// Reads numbers one after the other; `None` after the last byte.
pub(crate) struct Reader<'a>(pub(crate) &'a [u8]);

impl Reader<'_> {
    pub(crate) fn bytes<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (head, rest) = self.0.split_first_chunk()?;
        self.0 = rest;
        Some(*head)
    }

    /// A number whatever its bits.
    pub(crate) fn any(&mut self) -> Option<f64> {
        self.bytes().map(f64::from_le_bytes)
    }

    /// The number of items of `size` bytes in the rest, if it is whole.
    pub(crate) fn count(&self, size: usize) -> Option<usize> {
        self.0.len().is_multiple_of(size).then_some(self.0.len() / size)
    }
}
