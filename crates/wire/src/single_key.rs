//! Reading a choice that is an object with one key.
//!
//! serde's own externally tagged enums do as much, but call a second key a syntax error; here it is a fault with a
//! name. The value is read in place, so that a fault inside it keeps its path.

use serde::{Deserialize, Deserializer};

/// Implements `Deserialize` for an enum whose variants are the keys of a one-key object, or bare words.
macro_rules! single_key {
    ($name:ident { $($key:literal => $variant:ident),+ } $(or { $($word:literal => $unit:ident),+ })?) => {
        impl<'de> serde::Deserialize<'de> for $name {
            fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                struct Choice;

                impl<'de> serde::de::Visitor<'de> for Choice {
                    type Value = $name;

                    fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                        f.write_str("an object with one key, one of")?;
                        $(write!(f, " `{}`", $key)?;)+
                        $($(write!(f, ", or the string \"{}\"", $word)?;)+)?
                        Ok(())
                    }

                    fn visit_map<A: serde::de::MapAccess<'de>>(self, mut map: A) -> Result<$name, A::Error> {
                        use serde::de::Error;
                        let Some(key) = map.next_key::<String>()? else {
                            return Err(A::Error::invalid_length(0, &self));
                        };
                        let value = match key.as_str() {
                            $($key => $name::$variant(map.next_value()?),)+
                            _ => return Err(A::Error::unknown_variant(&key, &[$($key),+])),
                        };
                        match map.next_key::<String>()? {
                            None => Ok(value),
                            Some(second) => Err(A::Error::custom(format_args!(
                                "`{second}` conflicts with `{key}`, expected {}", &self as &dyn serde::de::Expected
                            ))),
                        }
                    }

                    $(fn visit_str<E: serde::de::Error>(self, word: &str) -> Result<$name, E> {
                        match word {
                            $($word => Ok($name::$unit),)+
                            _ => Err(E::invalid_value(serde::de::Unexpected::Str(word), &self)),
                        }
                    })?
                }

                deserializer.deserialize_any(Choice)
            }
        }
    };
}
pub(super) use single_key;

/// For members that may be left out but, once named, must have a value: some clients write NaN as `null`.
pub(super) fn not_null<'de, T: Deserialize<'de>, D: Deserializer<'de>>(deserializer: D) -> Result<Option<T>, D::Error> {
    T::deserialize(deserializer).map(Some)
}
