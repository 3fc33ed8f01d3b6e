//! Any JSON value whose objects have no repeated members, and JSON pointers into it: the base of a sweep.

use std::cell::Cell;
use std::fmt;

use serde::de::{DeserializeSeed, Error, MapAccess, SeqAccess, Visitor};
use serde_json::{Map, Number};

use super::check::escaped;
use super::limits;
use crate::prelude::*;

/// A JSON value without repeated members.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(transparent)]
pub struct JsonValue(pub Value);

impl Limited for JsonValue {}

/// Objects of a value at most: as many as a path has moves, and those around them. One takes some 700 bytes, however
/// short it is.
const OBJECTS: usize = limits::PATH_MOVES.end().saturating_add(1_000);

impl<'de> Deserialize<'de> for JsonValue {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        JsonValueVisitor { objects: &Cell::new(0) }.deserialize(deserializer).map(JsonValue)
    }
}

#[derive(Clone, Copy)]
struct JsonValueVisitor<'a> {
    /// The objects so far.
    objects: &'a Cell<usize>,
}

impl<'de> DeserializeSeed<'de> for JsonValueVisitor<'_> {
    type Value = Value;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Value, D::Error> {
        deserializer.deserialize_any(self)
    }
}

/// Methods for values without members or elements.
macro_rules! plain {
    ($($method:ident($type:ty))*) => {
        $(fn $method<E: Error>(self, value: $type) -> Result<Value, E> {
            Ok(value.into())
        })*
    };
}

impl<'de> Visitor<'de> for JsonValueVisitor<'_> {
    type Value = Value;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a JSON value")
    }

    plain! { visit_bool(bool) visit_i64(i64) visit_u64(u64) visit_str(&str) }

    fn visit_f64<E: Error>(self, value: f64) -> Result<Value, E> {
        Number::from_f64(value).map(Value::Number).ok_or_else(|| E::custom("number out of range"))
    }

    fn visit_unit<E: Error>(self) -> Result<Value, E> {
        Ok(Value::Null)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut elements: A) -> Result<Value, A::Error> {
        let mut values = Vec::new();
        while let Some(value) = elements.next_element_seed(self)? {
            values.push(value);
        }
        Ok(Value::Array(values))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut members: A) -> Result<Value, A::Error> {
        self.objects.set(self.objects.get().saturating_add(1));
        if self.objects.get() > OBJECTS {
            return Err(A::Error::custom(format_args!("more than the {OBJECTS} objects that are allowed")));
        }
        let mut values = Map::new();
        while let Some(name) = members.next_key::<String>()? {
            if values.contains_key(&name) {
                return Err(A::Error::custom(format_args!("duplicate field `{name}`")));
            }
            let value = members.next_value_seed(self)?;
            values.insert(name, value);
        }
        Ok(Value::Object(values))
    }
}

/// A JSON pointer (RFC 6901), split into its segments.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Pointer(Box<[String]>);

impl Pointer {
    /// Splits a pointer into its segments; none if it is not a JSON pointer.
    pub fn parse(text: &str) -> Option<Pointer> {
        if text.is_empty() {
            return Some(Pointer(Box::default()));
        }
        let segment = |segment: &str| {
            let rest = segment.replace("~0", "").replace("~1", "");
            (!rest.contains('~')).then(|| segment.replace("~1", "/").replace("~0", "~"))
        };
        text.strip_prefix('/')?.split('/').map(segment).collect::<Option<_>>().map(Pointer)
    }

    /// Its segments.
    pub fn segments(&self) -> &[String] {
        &self.0
    }

    /// Puts a number where it points to: in place of a number, or as a member that is missing. Returns whether it
    /// could.
    pub fn put(&self, document: &mut Value, number: Number) -> bool {
        let Some((last, parents)) = self.0.split_last() else { return false };
        let parent = parents.iter().try_fold(document, |node, segment| match node {
            Value::Object(members) => members.get_mut(segment),
            Value::Array(elements) => index(segment).and_then(|index| elements.get_mut(index)),
            _ => None,
        });
        match parent {
            Some(Value::Object(members)) => match members.get_mut(last) {
                Some(Value::Number(found)) => *found = number,
                Some(_) => return false,
                None => drop(members.insert(last.clone(), Value::Number(number))),
            },
            Some(Value::Array(elements)) => match index(last).and_then(|index| elements.get_mut(index)) {
                Some(Value::Number(found)) => *found = number,
                _ => return false,
            },
            _ => return false,
        }
        true
    }
}

impl fmt::Display for Pointer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.iter().try_for_each(|segment| write!(f, "/{}", escaped(segment)))
    }
}

/// The index of an element, as RFC 6901 writes it.
pub fn index(segment: &str) -> Option<usize> {
    let plain = segment == "0" || !segment.starts_with(['0', '+']);
    plain.then(|| segment.parse().ok()).flatten()
}
