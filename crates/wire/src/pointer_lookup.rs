//! One number out of a reply, without writing the rest of it: a serializer that walks along a JSON pointer and passes by
//! whatever lies beside it.

use std::fmt;

use serde::ser::{Impossible, Serialize, SerializeSeq, SerializeStruct, SerializeTuple, Serializer};

use super::json_value::{Pointer, index};
use super::reply::finite;

/// What stands where a pointer points to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lookup {
    /// A number; none where JSON has `null` for it.
    Number(Option<f64>),
    /// Nothing.
    Nothing,
    /// Something that is no number.
    Other,
}

/// What stands in a reply where a pointer points to.
pub fn lookup(reply: &impl Serialize, pointer: &Pointer) -> Lookup {
    // What is not made for walking holds no number.
    reply.serialize(NumberAt(pointer.segments())).unwrap_or(Lookup::Other)
}

/// The way that is left.
struct NumberAt<'p>(&'p [String]);

/// A value of a kind that no reply has on the way to a number.
#[derive(Debug)]
struct Unexpected;

impl fmt::Display for Unexpected {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("unexpected kind of value")
    }
}

impl std::error::Error for Unexpected {}

impl serde::ser::Error for Unexpected {
    fn custom<T: fmt::Display>(_: T) -> Self {
        Unexpected
    }
}

impl NumberAt<'_> {
    fn end(self, here: Lookup) -> Result<Lookup, Unexpected> {
        Ok(if self.0.is_empty() { here } else { Lookup::Nothing })
    }
}

/// Inside an object or an array: the member that is wanted, the way behind it, and what has been found.
struct Inside<'p> {
    wanted: Option<&'p str>,
    element: Option<usize>,
    rest: &'p [String],
    passed: usize,
    found: Lookup,
}

impl<'p> Inside<'p> {
    fn new(path: &'p [String]) -> Inside<'p> {
        match path.split_first() {
            Some((wanted, rest)) => {
                Inside { wanted: Some(wanted), element: index(wanted), rest, passed: 0, found: Lookup::Nothing }
            }
            None => Inside { wanted: None, element: None, rest: path, passed: 0, found: Lookup::Other },
        }
    }
}

macro_rules! numbers {
    ($($method:ident($type:ty))*) => {
        $(fn $method(self, value: $type) -> Result<Lookup, Unexpected> {
            self.end(Lookup::Number(finite(value as f64)))
        })*
    };
}

impl<'p> Serializer for NumberAt<'p> {
    type Ok = Lookup;
    type Error = Unexpected;
    type SerializeSeq = Inside<'p>;
    type SerializeTuple = Inside<'p>;
    type SerializeTupleStruct = Impossible<Lookup, Unexpected>;
    type SerializeTupleVariant = Impossible<Lookup, Unexpected>;
    type SerializeMap = Impossible<Lookup, Unexpected>;
    type SerializeStruct = Inside<'p>;
    type SerializeStructVariant = Impossible<Lookup, Unexpected>;

    numbers! {
        serialize_i8(i8) serialize_i16(i16) serialize_i32(i32) serialize_i64(i64)
        serialize_u8(u8) serialize_u16(u16) serialize_u32(u32) serialize_u64(u64)
        serialize_f32(f32) serialize_f64(f64)
    }

    fn serialize_bool(self, _: bool) -> Result<Lookup, Unexpected> {
        self.end(Lookup::Other)
    }

    fn serialize_char(self, _: char) -> Result<Lookup, Unexpected> {
        self.end(Lookup::Other)
    }

    fn serialize_str(self, _: &str) -> Result<Lookup, Unexpected> {
        self.end(Lookup::Other)
    }

    fn serialize_bytes(self, _: &[u8]) -> Result<Lookup, Unexpected> {
        self.end(Lookup::Other)
    }

    fn serialize_none(self) -> Result<Lookup, Unexpected> {
        self.end(Lookup::Number(None))
    }

    fn serialize_some<T: Serialize + ?Sized>(self, value: &T) -> Result<Lookup, Unexpected> {
        value.serialize(self)
    }

    fn serialize_unit(self) -> Result<Lookup, Unexpected> {
        self.end(Lookup::Number(None))
    }

    fn serialize_unit_struct(self, _: &'static str) -> Result<Lookup, Unexpected> {
        self.end(Lookup::Other)
    }

    fn serialize_unit_variant(self, _: &'static str, _: u32, _: &'static str) -> Result<Lookup, Unexpected> {
        self.end(Lookup::Other)
    }

    fn serialize_newtype_struct<T: Serialize + ?Sized>(self, _: &'static str, value: &T) -> Result<Lookup, Unexpected> {
        value.serialize(self)
    }

    fn serialize_newtype_variant<T: Serialize + ?Sized>(
        self,
        _: &'static str,
        _: u32,
        variant: &'static str,
        value: &T,
    ) -> Result<Lookup, Unexpected> {
        match self.0.split_first() {
            Some((wanted, rest)) if wanted == variant => value.serialize(NumberAt(rest)),
            Some(_) => Ok(Lookup::Nothing),
            None => Ok(Lookup::Other),
        }
    }

    fn serialize_seq(self, _: Option<usize>) -> Result<Inside<'p>, Unexpected> {
        Ok(Inside::new(self.0))
    }

    fn serialize_tuple(self, _: usize) -> Result<Inside<'p>, Unexpected> {
        Ok(Inside::new(self.0))
    }

    fn serialize_tuple_struct(self, _: &'static str, _: usize) -> Result<Self::SerializeTupleStruct, Unexpected> {
        Err(Unexpected)
    }

    fn serialize_tuple_variant(
        self,
        _: &'static str,
        _: u32,
        _: &'static str,
        _: usize,
    ) -> Result<Self::SerializeTupleVariant, Unexpected> {
        Err(Unexpected)
    }

    fn serialize_map(self, _: Option<usize>) -> Result<Self::SerializeMap, Unexpected> {
        Err(Unexpected)
    }

    fn serialize_struct(self, _: &'static str, _: usize) -> Result<Inside<'p>, Unexpected> {
        Ok(Inside::new(self.0))
    }

    fn serialize_struct_variant(
        self,
        _: &'static str,
        _: u32,
        _: &'static str,
        _: usize,
    ) -> Result<Self::SerializeStructVariant, Unexpected> {
        Err(Unexpected)
    }
}

impl SerializeSeq for Inside<'_> {
    type Ok = Lookup;
    type Error = Unexpected;

    fn serialize_element<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), Unexpected> {
        if self.element == Some(self.passed) {
            self.found = value.serialize(NumberAt(self.rest))?;
        }
        self.passed = self.passed.saturating_add(1);
        Ok(())
    }

    fn end(self) -> Result<Lookup, Unexpected> {
        Ok(self.found)
    }
}

impl SerializeTuple for Inside<'_> {
    type Ok = Lookup;
    type Error = Unexpected;

    fn serialize_element<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), Unexpected> {
        SerializeSeq::serialize_element(self, value)
    }

    fn end(self) -> Result<Lookup, Unexpected> {
        Ok(self.found)
    }
}

impl SerializeStruct for Inside<'_> {
    type Ok = Lookup;
    type Error = Unexpected;

    fn serialize_field<T: Serialize + ?Sized>(&mut self, name: &'static str, value: &T) -> Result<(), Unexpected> {
        if self.wanted == Some(name) {
            self.found = value.serialize(NumberAt(self.rest))?;
        }
        Ok(())
    }

    fn end(self) -> Result<Lookup, Unexpected> {
        Ok(self.found)
    }
}

#[cfg(test)]
mod tests {
    use super::{Lookup, lookup};
    use crate::json_value::Pointer;
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
            let found = lookup(&residual, &Pointer::parse(pointer).unwrap());
            assert_eq!(found, Lookup::Number(written.pointer(pointer).unwrap().as_f64()), "{pointer}");
        }
        for (pointer, found) in [
            ("/peaks/2/radius", Lookup::Nothing),
            ("/peaks/00/radius", Lookup::Nothing),
            ("/none", Lookup::Nothing),
            ("/max/0", Lookup::Nothing),
            ("/centre/0", Lookup::Nothing),
            ("/peaks", Lookup::Other),
            ("/peaks/0", Lookup::Other),
            ("", Lookup::Other),
        ] {
            assert_eq!(lookup(&residual, &Pointer::parse(pointer).unwrap()), found, "{pointer}");
        }
        let stress = Stress { radius: vec![0.0], pressure: None, shear: None, slip: None, displacement: None };
        assert_eq!(lookup(&stress, &Pointer::parse("/shear/0").unwrap()), Lookup::Nothing);
    }
}
