//! One number of a reply, without writing the rest of it: a serializer that follows a JSON pointer and skips everything
//! else.

use std::fmt;

use serde::ser::{Impossible, Serialize, SerializeSeq, SerializeStruct, SerializeTuple, Serializer};

use super::json_value::{Pointer, index};
use super::reply::finite;

/// The value at a pointer into a reply.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lookup {
    /// A number; none where JSON has `null` for it.
    Number(Option<f64>),
    /// Nothing.
    Nothing,
    /// A value that is not a number.
    Other,
}

/// The value at `pointer` in a reply.
pub fn lookup(reply: &impl Serialize, pointer: &Pointer) -> Lookup {
    reply.serialize(NumberAt(pointer.segments())).unwrap_or(Lookup::Other)
}

/// The segments of the pointer that remain.
struct NumberAt<'p>(&'p [String]);

impl NumberAt<'_> {
    fn end(self, here: Lookup) -> Result<Lookup, fmt::Error> {
        Ok(if self.0.is_empty() { here } else { Lookup::Nothing })
    }
}

/// Inside an object or an array: the wanted member or element, the segments behind it, and what has been found.
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

/// Methods for numbers.
macro_rules! numbers {
    ($($method:ident($type:ty))*) => {
        $(fn $method(self, value: $type) -> Result<Lookup, fmt::Error> {
            self.end(Lookup::Number(finite(value as f64)))
        })*
    };
}

/// Methods for values that are no numbers.
macro_rules! no_numbers {
    ($($method:ident($($type:ty),*))*) => {
        $(fn $method(self, $(_: $type),*) -> Result<Lookup, fmt::Error> {
            self.end(Lookup::Other)
        })*
    };
}

/// Methods for kinds of values that no reply has.
macro_rules! unexpected {
    ($($method:ident($($type:ty),*) -> $ok:ident)*) => {
        $(fn $method(self, $(_: $type),*) -> Result<Self::$ok, fmt::Error> {
            Err(fmt::Error)
        })*
    };
}

impl<'p> Serializer for NumberAt<'p> {
    type Ok = Lookup;
    type Error = fmt::Error;
    type SerializeSeq = Inside<'p>;
    type SerializeTuple = Inside<'p>;
    type SerializeTupleStruct = Impossible<Lookup, fmt::Error>;
    type SerializeTupleVariant = Impossible<Lookup, fmt::Error>;
    type SerializeMap = Impossible<Lookup, fmt::Error>;
    type SerializeStruct = Inside<'p>;
    type SerializeStructVariant = Impossible<Lookup, fmt::Error>;

    numbers! {
        serialize_i8(i8) serialize_i16(i16) serialize_i32(i32) serialize_i64(i64)
        serialize_u8(u8) serialize_u16(u16) serialize_u32(u32) serialize_u64(u64)
        serialize_f32(f32) serialize_f64(f64)
    }

    no_numbers! {
        serialize_bool(bool) serialize_char(char) serialize_str(&str) serialize_bytes(&[u8])
        serialize_unit_struct(&'static str) serialize_unit_variant(&'static str, u32, &'static str)
    }

    unexpected! {
        serialize_tuple_struct(&'static str, usize) -> SerializeTupleStruct
        serialize_tuple_variant(&'static str, u32, &'static str, usize) -> SerializeTupleVariant
        serialize_map(Option<usize>) -> SerializeMap
        serialize_struct_variant(&'static str, u32, &'static str, usize) -> SerializeStructVariant
    }

    fn serialize_none(self) -> Result<Lookup, fmt::Error> {
        self.end(Lookup::Number(None))
    }

    fn serialize_some<T: Serialize + ?Sized>(self, value: &T) -> Result<Lookup, fmt::Error> {
        value.serialize(self)
    }

    fn serialize_unit(self) -> Result<Lookup, fmt::Error> {
        self.end(Lookup::Number(None))
    }

    fn serialize_newtype_struct<T: Serialize + ?Sized>(self, _: &'static str, value: &T) -> Result<Lookup, fmt::Error> {
        value.serialize(self)
    }

    fn serialize_newtype_variant<T: Serialize + ?Sized>(
        self,
        _: &'static str,
        _: u32,
        variant: &'static str,
        value: &T,
    ) -> Result<Lookup, fmt::Error> {
        match self.0.split_first() {
            Some((wanted, rest)) if wanted == variant => value.serialize(NumberAt(rest)),
            Some(_) => Ok(Lookup::Nothing),
            None => Ok(Lookup::Other),
        }
    }

    fn serialize_seq(self, _: Option<usize>) -> Result<Inside<'p>, fmt::Error> {
        Ok(Inside::new(self.0))
    }

    fn serialize_tuple(self, _: usize) -> Result<Inside<'p>, fmt::Error> {
        Ok(Inside::new(self.0))
    }

    fn serialize_struct(self, _: &'static str, _: usize) -> Result<Inside<'p>, fmt::Error> {
        Ok(Inside::new(self.0))
    }
}

impl SerializeSeq for Inside<'_> {
    type Ok = Lookup;
    type Error = fmt::Error;

    fn serialize_element<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), fmt::Error> {
        if self.element == Some(self.passed) {
            self.found = value.serialize(NumberAt(self.rest))?;
        }
        self.passed = self.passed.saturating_add(1);
        Ok(())
    }

    fn end(self) -> Result<Lookup, fmt::Error> {
        Ok(self.found)
    }
}

impl SerializeTuple for Inside<'_> {
    type Ok = Lookup;
    type Error = fmt::Error;

    fn serialize_element<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), fmt::Error> {
        SerializeSeq::serialize_element(self, value)
    }

    fn end(self) -> Result<Lookup, fmt::Error> {
        SerializeSeq::end(self)
    }
}

impl SerializeStruct for Inside<'_> {
    type Ok = Lookup;
    type Error = fmt::Error;

    fn serialize_field<T: Serialize + ?Sized>(&mut self, name: &'static str, value: &T) -> Result<(), fmt::Error> {
        if self.wanted == Some(name) {
            self.found = value.serialize(NumberAt(self.rest))?;
        }
        Ok(())
    }

    fn end(self) -> Result<Lookup, fmt::Error> {
        Ok(self.found)
    }
}
