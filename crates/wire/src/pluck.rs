//! One number out of a reply, without writing the rest of it: a serializer that walks along a JSON pointer and passes by
//! whatever lies beside it.

use std::fmt;

use serde::ser::{Impossible, Serialize, SerializeSeq, SerializeStruct, SerializeTuple, Serializer};

use super::any::{Pointer, index};
use super::reply::finite;

/// What stands where a pointer points to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Found {
    /// A number; none where JSON has `null` for it.
    Number(Option<f64>),
    /// Nothing.
    Nothing,
    /// Something that is no number.
    Other,
}

/// What stands in a reply where a pointer points to.
pub fn pluck(reply: &impl Serialize, pointer: &Pointer) -> Found {
    // What is not made for walking holds no number.
    reply.serialize(Pluck(pointer.segments())).unwrap_or(Found::Other)
}

/// The way that is left.
struct Pluck<'p>(&'p [String]);

/// A value of a kind that no reply has on the way to a number.
#[derive(Debug)]
struct Unforeseen;

impl fmt::Display for Unforeseen {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("unforeseen")
    }
}

impl std::error::Error for Unforeseen {}

impl serde::ser::Error for Unforeseen {
    fn custom<T: fmt::Display>(_: T) -> Self {
        Unforeseen
    }
}

impl Pluck<'_> {
    fn end(self, here: Found) -> Result<Found, Unforeseen> {
        Ok(if self.0.is_empty() { here } else { Found::Nothing })
    }
}

/// Inside an object or an array: the member that is wanted, the way behind it, and what has been found.
struct Inside<'p> {
    wanted: Option<&'p str>,
    element: Option<usize>,
    rest: &'p [String],
    passed: usize,
    found: Found,
}

impl<'p> Inside<'p> {
    fn new(path: &'p [String]) -> Inside<'p> {
        match path.split_first() {
            Some((wanted, rest)) => {
                Inside { wanted: Some(wanted), element: index(wanted), rest, passed: 0, found: Found::Nothing }
            }
            None => Inside { wanted: None, element: None, rest: path, passed: 0, found: Found::Other },
        }
    }
}

macro_rules! numbers {
    ($($method:ident($type:ty))*) => {
        $(fn $method(self, value: $type) -> Result<Found, Unforeseen> {
            self.end(Found::Number(finite(value as f64)))
        })*
    };
}

impl<'p> Serializer for Pluck<'p> {
    type Ok = Found;
    type Error = Unforeseen;
    type SerializeSeq = Inside<'p>;
    type SerializeTuple = Inside<'p>;
    type SerializeTupleStruct = Impossible<Found, Unforeseen>;
    type SerializeTupleVariant = Impossible<Found, Unforeseen>;
    type SerializeMap = Impossible<Found, Unforeseen>;
    type SerializeStruct = Inside<'p>;
    type SerializeStructVariant = Impossible<Found, Unforeseen>;

    numbers! {
        serialize_i8(i8) serialize_i16(i16) serialize_i32(i32) serialize_i64(i64)
        serialize_u8(u8) serialize_u16(u16) serialize_u32(u32) serialize_u64(u64)
        serialize_f32(f32) serialize_f64(f64)
    }

    fn serialize_bool(self, _: bool) -> Result<Found, Unforeseen> {
        self.end(Found::Other)
    }

    fn serialize_char(self, _: char) -> Result<Found, Unforeseen> {
        self.end(Found::Other)
    }

    fn serialize_str(self, _: &str) -> Result<Found, Unforeseen> {
        self.end(Found::Other)
    }

    fn serialize_bytes(self, _: &[u8]) -> Result<Found, Unforeseen> {
        self.end(Found::Other)
    }

    fn serialize_none(self) -> Result<Found, Unforeseen> {
        self.end(Found::Number(None))
    }

    fn serialize_some<T: Serialize + ?Sized>(self, value: &T) -> Result<Found, Unforeseen> {
        value.serialize(self)
    }

    fn serialize_unit(self) -> Result<Found, Unforeseen> {
        self.end(Found::Number(None))
    }

    fn serialize_unit_struct(self, _: &'static str) -> Result<Found, Unforeseen> {
        self.end(Found::Other)
    }

    fn serialize_unit_variant(self, _: &'static str, _: u32, _: &'static str) -> Result<Found, Unforeseen> {
        self.end(Found::Other)
    }

    fn serialize_newtype_struct<T: Serialize + ?Sized>(self, _: &'static str, value: &T) -> Result<Found, Unforeseen> {
        value.serialize(self)
    }

    fn serialize_newtype_variant<T: Serialize + ?Sized>(
        self,
        _: &'static str,
        _: u32,
        variant: &'static str,
        value: &T,
    ) -> Result<Found, Unforeseen> {
        match self.0.split_first() {
            Some((wanted, rest)) if wanted == variant => value.serialize(Pluck(rest)),
            Some(_) => Ok(Found::Nothing),
            None => Ok(Found::Other),
        }
    }

    fn serialize_seq(self, _: Option<usize>) -> Result<Inside<'p>, Unforeseen> {
        Ok(Inside::new(self.0))
    }

    fn serialize_tuple(self, _: usize) -> Result<Inside<'p>, Unforeseen> {
        Ok(Inside::new(self.0))
    }

    fn serialize_tuple_struct(self, _: &'static str, _: usize) -> Result<Self::SerializeTupleStruct, Unforeseen> {
        Err(Unforeseen)
    }

    fn serialize_tuple_variant(
        self,
        _: &'static str,
        _: u32,
        _: &'static str,
        _: usize,
    ) -> Result<Self::SerializeTupleVariant, Unforeseen> {
        Err(Unforeseen)
    }

    fn serialize_map(self, _: Option<usize>) -> Result<Self::SerializeMap, Unforeseen> {
        Err(Unforeseen)
    }

    fn serialize_struct(self, _: &'static str, _: usize) -> Result<Inside<'p>, Unforeseen> {
        Ok(Inside::new(self.0))
    }

    fn serialize_struct_variant(
        self,
        _: &'static str,
        _: u32,
        _: &'static str,
        _: usize,
    ) -> Result<Self::SerializeStructVariant, Unforeseen> {
        Err(Unforeseen)
    }
}

impl SerializeSeq for Inside<'_> {
    type Ok = Found;
    type Error = Unforeseen;

    fn serialize_element<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), Unforeseen> {
        if self.element == Some(self.passed) {
            self.found = value.serialize(Pluck(self.rest))?;
        }
        self.passed = self.passed.saturating_add(1);
        Ok(())
    }

    fn end(self) -> Result<Found, Unforeseen> {
        Ok(self.found)
    }
}

impl SerializeTuple for Inside<'_> {
    type Ok = Found;
    type Error = Unforeseen;

    fn serialize_element<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), Unforeseen> {
        SerializeSeq::serialize_element(self, value)
    }

    fn end(self) -> Result<Found, Unforeseen> {
        Ok(self.found)
    }
}

impl SerializeStruct for Inside<'_> {
    type Ok = Found;
    type Error = Unforeseen;

    fn serialize_field<T: Serialize + ?Sized>(&mut self, name: &'static str, value: &T) -> Result<(), Unforeseen> {
        if self.wanted == Some(name) {
            self.found = value.serialize(Pluck(self.rest))?;
        }
        Ok(())
    }

    fn end(self) -> Result<Found, Unforeseen> {
        Ok(self.found)
    }
}

#[cfg(test)]
mod tests {
    use super::{Found, pluck};
    use crate::any::Pointer;
    use crate::{Peak, Residual, Stress};

    #[test]
    fn a_number_is_found_as_a_pointer_finds_it_in_the_written_document() {
        let peak = |radius, shear| Peak { radius, shear };
        let residual = Residual {
            centre: None,
            peaks: vec![peak(1e-5, Some(-2.5)), peak(2e-5, None)],
            max: Some(2.5),
            min: Some(2.5),
            mean: Some(2.5),
        };
        let written = serde_json::to_value(&residual).unwrap();
        for pointer in ["/max", "/centre", "/peaks/0/radius", "/peaks/0/shear", "/peaks/1/shear"] {
            let found = pluck(&residual, &Pointer::parse(pointer).unwrap());
            assert_eq!(found, Found::Number(written.pointer(pointer).unwrap().as_f64()), "{pointer}");
        }
        for (pointer, found) in [
            ("/peaks/2/radius", Found::Nothing),
            ("/peaks/00/radius", Found::Nothing),
            ("/none", Found::Nothing),
            ("/max/0", Found::Nothing),
            ("/centre/0", Found::Nothing),
            ("/peaks", Found::Other),
            ("/peaks/0", Found::Other),
            ("", Found::Other),
        ] {
            assert_eq!(pluck(&residual, &Pointer::parse(pointer).unwrap()), found, "{pointer}");
        }
        let stress = Stress { radius: vec![0.0], pressure: None, shear: None, slip: None, displacement: None };
        assert_eq!(pluck(&stress, &Pointer::parse("/shear/0").unwrap()), Found::Nothing);
    }
}
