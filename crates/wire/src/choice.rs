//! Declaring choices: of a word, of an object with one key, of an object or a string; of a number or an array.
//!
//! serde's own externally tagged enums do as much as an object with one key, but call a second key a syntax error; here
//! it is a fault with a name. The value is read in place, so that a fault inside it keeps its path.

use std::marker::PhantomData;

use serde::de::value::SeqAccessDeserializer;
use serde::de::{Deserialize, Deserializer, Error, IgnoredAny, SeqAccess, Visitor};

/// Declares choices with the word of each, `words! { pub enum Name: Trait, .. of Other { Choice = "word", .. } .. }`,
/// the traits that they have beside those of all, and the type of the mechanics that has the same choices.
macro_rules! words {
    ($(
        $(#[doc = $about:literal])*
        pub enum $Name:ident $(: $($Trait:ident),+)? $(of $Other:ty)? {
            $($(#[$of_choice:meta])* $Choice:ident = $word:tt,)+
        }
    )+) => {$(
        $(#[doc = $about])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
        $(#[derive($($Trait),+)])?
        pub enum $Name {
            $($(#[$of_choice])* #[serde(rename = $word)] $Choice,)+
        }

        impl $crate::limits::Limited for $Name {}

        $crate::choice::same! { $Name [$($Other)?] $($Choice)+ }

        impl $Name {
            /// All of them.
            pub const ALL: [$Name; [$($word),+].len()] = [$($Name::$Choice),+];

            /// Its word.
            pub const fn name(self) -> &'static str {
                match self {
                    $($Name::$Choice => $word,)+
                }
            }
        }
    )+};
}
pub(crate) use words;

/// Converts between a type and another one with the same choices, if there is one.
macro_rules! same {
    ($Name:ident [] $($Choice:ident)+) => {};
    ($Name:ident [$Other:ty] $($Choice:ident)+) => {
        impl From<$Other> for $Name {
            fn from(other: $Other) -> $Name {
                match other {
                    $(<$Other>::$Choice => $Name::$Choice,)+
                }
            }
        }

        impl From<$Name> for $Other {
            fn from(this: $Name) -> $Other {
                match this {
                    $($Name::$Choice => <$Other>::$Choice,)+
                }
            }
        }
    };
}
pub(crate) use same;

/// Declares choices that are objects with one key, or words:
/// `choices! { pub enum Name { words { Choice = "word", .. } "key" => Choice(Type) = limit, .. } .. }`, with the traits
/// that they have beside those of all and the [limits](crate::limits) of the values.
macro_rules! choices {
    ($(
        $(#[doc = $about:literal])*
        $(#[schema($($schema:tt)*)])?
        pub enum $Name:ident $(: $($Trait:ident),+)? {
            $(words { $($(#[$of_word:meta])* $Word:ident = $word:literal,)+ })?
            $($(#[$of_key:meta])* $key:literal => $Choice:ident($Value:ty) $(= $limit:expr)?,)+
        }
    )+) => {$(
        $(#[doc = $about])*
        #[derive(Clone, Debug, PartialEq, serde::Serialize, utoipa::ToSchema $($(, $Trait)+)?)]
        #[serde(rename_all = "snake_case")]
        $(#[schema($($schema)*)])?
        pub enum $Name {
            $($($(#[$of_word])* $Word,)+)?
            $($(#[$of_key])* $Choice($Value),)+
        }

        impl<'de> serde::Deserialize<'de> for $Name {
            fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                struct Choice;

                impl<'de> serde::de::Visitor<'de> for Choice {
                    type Value = $Name;

                    fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                        f.write_str("an object with one key, one of")?;
                        $(write!(f, " `{}`", $key)?;)+
                        $($(write!(f, ", or the string \"{}\"", $word)?;)+)?
                        Ok(())
                    }

                    fn visit_map<A: serde::de::MapAccess<'de>>(self, mut map: A) -> Result<$Name, A::Error> {
                        use serde::de::Error;
                        let Some(key) = map.next_key::<String>()? else {
                            return Err(A::Error::invalid_length(0, &self));
                        };
                        let value = match key.as_str() {
                            $($key => $Name::$Choice(map.next_value()?),)+
                            _ => return Err(A::Error::unknown_variant(&key, &[$($key),+])),
                        };
                        match map.next_key::<String>()? {
                            None => Ok(value),
                            Some(second) => Err(A::Error::custom(format_args!(
                                "`{second}` conflicts with `{key}`, expected {}", &self as &dyn serde::de::Expected
                            ))),
                        }
                    }

                    $(fn visit_str<E: serde::de::Error>(self, word: &str) -> Result<$Name, E> {
                        match word {
                            $($word => Ok($Name::$Word),)+
                            _ => Err(E::invalid_value(serde::de::Unexpected::Str(word), &self)),
                        }
                    })?
                }

                deserializer.deserialize_any(Choice)
            }
        }

        impl $crate::limits::Limited for $Name {
            fn add_limits(found: &mut $crate::limits::LimitsOfSchemas) {
                let own = vec![$($(($key, $crate::limits::Limit::<$Value>::keywords(&$limit)),)?)+];
                if found.insert(stringify!($Name), own).is_none() {
                    $(<$Value as $crate::limits::Limited>::add_limits(found);)+
                }
            }

            fn check_limits(&self, at: $crate::check::JsonPath<'_>, faults: &mut $crate::check::Faults) {
                match self {
                    $($($Name::$Word => {})+)?
                    $($Name::$Choice(value) => {
                        $($crate::limits::Limit::check(&$limit, value, at.member($key), faults);)?
                        $crate::limits::Limited::check_limits(value, at.member($key), faults);
                    })+
                }
            }
        }
    )+};
}
pub(crate) use choices;

/// Implements `Deserialize` for an untagged enum of an object and a string: not by trial, so that a fault in the object
/// names its member.
macro_rules! object_or_string {
    ($Name:ident: $expected:literal, $Object:ident => $Choice:ident, $word:pat => $string:expr) => {
        impl $crate::limits::Limited for $Name {
            fn add_limits(found: &mut $crate::limits::LimitsOfSchemas) {
                $Object::add_limits(found);
            }

            fn check_limits(&self, at: $crate::check::JsonPath<'_>, faults: &mut $crate::check::Faults) {
                if let $Name::$Choice(object) = self {
                    object.check_limits(at, faults);
                }
            }
        }

        impl<'de> serde::Deserialize<'de> for $Name {
            fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                struct Choice;

                impl<'de> serde::de::Visitor<'de> for Choice {
                    type Value = $Name;

                    fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                        f.write_str($expected)
                    }

                    fn visit_map<A: serde::de::MapAccess<'de>>(self, map: A) -> Result<$Name, A::Error> {
                        let object = serde::de::value::MapAccessDeserializer::new(map);
                        <$Object as serde::Deserialize>::deserialize(object).map($Name::$Choice)
                    }

                    #[allow(unreachable_patterns, reason = "any string may be meant")]
                    fn visit_str<E: serde::de::Error>(self, word: &str) -> Result<$Name, E> {
                        match word {
                            $word => Ok($string),
                            _ => Err(E::invalid_value(serde::de::Unexpected::Str(word), &self)),
                        }
                    }
                }

                deserializer.deserialize_any(Choice)
            }
        }
    };
}
pub(crate) use object_or_string;

/// A number, or an array of numbers.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
#[serde(untagged)]
pub enum NumberOr<A> {
    /// A number.
    One(f64),
    /// An array.
    Many(A),
}

impl<A> crate::limits::Limited for NumberOr<A> {}

/// An array of numbers that a single one may take the place of.
pub trait Numbers {
    /// What is expected, for messages.
    const EXPECTED: &'static str;
}

impl<'de, A: Numbers + Deserialize<'de>> Deserialize<'de> for NumberOr<A> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(NumberOrVisitor(PhantomData))
    }
}

struct NumberOrVisitor<A>(PhantomData<A>);

impl<'de, A: Numbers + Deserialize<'de>> Visitor<'de> for NumberOrVisitor<A> {
    type Value = NumberOr<A>;

    fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(A::EXPECTED)
    }

    fn visit_f64<E: Error>(self, number: f64) -> Result<NumberOr<A>, E> {
        Ok(NumberOr::One(number))
    }

    fn visit_i64<E: Error>(self, number: i64) -> Result<NumberOr<A>, E> {
        Ok(NumberOr::One(number as f64))
    }

    fn visit_u64<E: Error>(self, number: u64) -> Result<NumberOr<A>, E> {
        Ok(NumberOr::One(number as f64))
    }

    fn visit_seq<S: SeqAccess<'de>>(self, mut elements: S) -> Result<NumberOr<A>, S::Error> {
        // A fault within has its index.
        let numbers = A::deserialize(SeqAccessDeserializer::new(&mut elements))?;
        match elements.next_element::<IgnoredAny>()? {
            None => Ok(NumberOr::Many(numbers)),
            // That can only be a pair.
            Some(_) => Err(Error::invalid_length(3, &self)),
        }
    }
}
