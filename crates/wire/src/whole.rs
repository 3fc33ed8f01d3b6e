//! Whole numbers as JSON has them: `20`, `20.0` and `2e1` are the same number.

use std::fmt;

use serde::de::{Deserialize, Deserializer, Error, MapAccess, SeqAccess, Visitor};

/// Whole numbers up to this have no gaps as floating-point numbers.
const EXACT: f64 = (1_u64 << 53) as f64;

/// Reads a value; a whole number in whatever form.
pub(crate) fn read<'de, T: Deserialize<'de>, D: Deserializer<'de>>(deserializer: D) -> Result<T, D::Error> {
    T::deserialize(Whole(deserializer))
}

/// A deserializer that takes a whole number in whatever form, and is the one inside it for all else.
struct Whole<D>(D);

macro_rules! forwarded {
    ($($method:ident($($name:ident: $type:ty),*))*) => {
        $(fn $method<V: Visitor<'de>>(self, $($name: $type,)* visitor: V) -> Result<V::Value, D::Error> {
            self.0.$method($($name,)* visitor)
        })*
    };
}

impl<'de, D: Deserializer<'de>> Deserializer<'de> for Whole<D> {
    type Error = D::Error;

    fn deserialize_u64<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, D::Error> {
        self.0.deserialize_any(WholeVisitor(visitor))
    }

    forwarded! {
        deserialize_any() deserialize_bool() deserialize_i8() deserialize_i16() deserialize_i32() deserialize_i64()
        deserialize_u8() deserialize_u16() deserialize_u32() deserialize_f32() deserialize_f64() deserialize_char()
        deserialize_str() deserialize_string() deserialize_bytes() deserialize_byte_buf() deserialize_option()
        deserialize_unit() deserialize_seq() deserialize_map() deserialize_identifier() deserialize_ignored_any()
        deserialize_unit_struct(name: &'static str) deserialize_newtype_struct(name: &'static str)
        deserialize_tuple(length: usize) deserialize_tuple_struct(name: &'static str, length: usize)
        deserialize_struct(name: &'static str, members: &'static [&'static str])
        deserialize_enum(name: &'static str, variants: &'static [&'static str])
    }
}

/// A visitor of a whole number.
struct WholeVisitor<V>(V);

macro_rules! visited {
    ($($method:ident($type:ty))*) => {
        $(fn $method<E: Error>(self, value: $type) -> Result<V::Value, E> {
            self.0.$method(value)
        })*
    };
}

impl<'de, V: Visitor<'de>> Visitor<'de> for WholeVisitor<V> {
    type Value = V::Value;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.expecting(f)
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<V::Value, E> {
        let is_whole = value.fract() == 0.0 && (0.0..=EXACT).contains(&value);
        if is_whole { self.0.visit_u64(value as u64) } else { self.0.visit_f64(value) }
    }

    visited! { visit_bool(bool) visit_i64(i64) visit_u64(u64) visit_str(&str) }

    fn visit_unit<E: Error>(self) -> Result<V::Value, E> {
        self.0.visit_unit()
    }

    fn visit_seq<A: SeqAccess<'de>>(self, elements: A) -> Result<V::Value, A::Error> {
        self.0.visit_seq(elements)
    }

    fn visit_map<A: MapAccess<'de>>(self, members: A) -> Result<V::Value, A::Error> {
        self.0.visit_map(members)
    }
}

#[cfg(test)]
mod tests {
    use serde::Deserialize;
    use serde_json::from_str;

    use crate::path::FallingAmplitude;
    use crate::{ForkRequest, StressRequest};

    /// The whole number that a member takes from this text.
    fn member<T: for<'a> Deserialize<'a>>(name: &str, text: &str) -> Result<T, String> {
        from_str(&format!("{{\"{name}\": {text}}}")).map_err(|error| error.to_string())
    }

    #[test]
    fn a_whole_number_is_one_in_whatever_form() {
        for text in ["20", "20.0", "2e1", "2.0E+1", "200e-1"] {
            assert_eq!(member::<StressRequest>("points", text).unwrap().points, Some(20), "{text}");
            assert_eq!(member::<ForkRequest>("sequence", text).unwrap().sequence, Some(20), "{text}");
            assert_eq!(member::<FallingAmplitude>("reversals", text).unwrap().reversals, 20, "{text}");
        }
        for text in ["20.5", "-1.0", "-1", "1e300", "\"20\"", "[20]", "{}", "null", "true"] {
            for error in [
                member::<StressRequest>("points", text).map(drop),
                member::<FallingAmplitude>("reversals", text).map(drop),
            ] {
                assert!(error.unwrap_err().contains("expected usize"), "{text}");
            }
        }
    }
}
