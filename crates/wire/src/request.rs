//! Declaring the objects of requests.
//!
//! Declarations within `requests!`, `choices!` and `words!` begin at the margin: the descriptions in the OpenAPI
//! document have the lines of these comments.

use serde::{Deserialize, Deserializer};

/// Declares objects of requests, `requests! { pub struct Name: Copy, .. { pub member: Type = limit, .. } .. }`, with
/// the traits that they have beside those of all, and the [limits](crate::limits) of their members. An unknown member
/// is a fault. A member of the type `Option` may be left out but, once named, must have a value: some clients write NaN
/// as `null`. With `and Shared`, it has the limited members of that document too, which checks them itself.
macro_rules! requests {
    ($(
        $(#[doc = $about:literal])*
        $(#[schema($($schema:tt)*)])?
        pub struct $Name:ident $(: $($Trait:ident),+)? $(and $Shared:ty)? {
            $($(#[$of_member:meta])* pub $member:ident: $type:ty $(= $limit:expr)?,)*
        }
    )+) => {$(
        $(#[doc = $about])*
        #[serde_with::skip_serializing_none]
        #[serde_with::apply(
            Option => #[serde(default, deserialize_with = "crate::request::not_null")] #[schema(nullable = false)]
        )]
        #[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema $($(, $Trait)+)?)]
        #[serde(deny_unknown_fields, remote = "Self")]
        $(#[schema($($schema)*)])?
        pub struct $Name {
            $($(#[$of_member])* pub $member: $type,)*
        }

        $crate::request::object!($Name);

        impl $crate::limits::Limited for $Name {
            const SCHEMA: &'static str = stringify!($Name);

            fn limits() -> Vec<(&'static str, serde_json::Value)> {
                #[allow(unused_mut)]
                let mut limits = vec![$($(
                    (
                        $crate::request::name_in_json(stringify!($member)),
                        $crate::limits::Limit::<$type>::keywords(&$limit),
                    ),
                )?)*];
                $(limits.extend(<$Shared as $crate::limits::Limited>::limits());)?
                limits
            }

            #[allow(unused_variables, reason = "a document may have no limits")]
            fn check_members(&self, at: $crate::check::JsonPath<'_>, faults: &mut $crate::check::Faults) {
                $($(
                    let place = at.member($crate::request::name_in_json(stringify!($member)));
                    $crate::limits::Limit::check(&$limit, &self.$member, place, faults);
                )?)*
            }
        }
    )+};
}
pub(crate) use requests;

/// Declares objects of replies, `replies! { pub struct Name: Copy, .. omits Option { .. } .. }`, with the traits that
/// they have beside those of all. A member without a value is `null` or, with `omits Option`, left out.
macro_rules! replies {
    ($(
        $(#[$about:meta])*
        pub struct $Name:ident $(: $($Trait:ident),+)? $(omits $Option:ident)? { $($members:tt)* }
    )+) => {$(
        $(#[serde_with::apply(
            $Option => #[serde(skip_serializing_if = "Option::is_none")] #[schema(nullable = false)]
        )])?
        #[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema $($(, $Trait)+)?)]
        $(#[$about])*
        pub struct $Name { $($members)* }
    )+};
}
pub(crate) use replies;

/// Has a struct, for which serde derives its implementations as those of `remote = "Self"`, read from objects alone:
/// serde would also accept an array of the members' values, in the order of their declaration.
macro_rules! object {
    ($Name:ident) => {
        impl serde::Serialize for $Name {
            fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                $Name::serialize(self, serializer)
            }
        }

        impl<'de> serde::Deserialize<'de> for $Name {
            fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                struct Object;

                impl<'de> serde::de::Visitor<'de> for Object {
                    type Value = $Name;

                    fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                        f.write_str("an object")
                    }

                    fn visit_map<A: serde::de::MapAccess<'de>>(self, members: A) -> Result<$Name, A::Error> {
                        $Name::deserialize(serde::de::value::MapAccessDeserializer::new(members))
                    }
                }

                deserializer.deserialize_map(Object)
            }
        }
    };
}
pub(crate) use object;

/// The name of a member in JSON: that of a Rust keyword is written `r#name`.
pub(crate) fn name_in_json(member: &'static str) -> &'static str {
    member.trim_start_matches("r#")
}

/// For members that may be left out but, once named, must have a value: some clients write NaN as `null`.
pub(crate) fn not_null<'de, T: Deserialize<'de>, D: Deserializer<'de>>(deserializer: D) -> Result<Option<T>, D::Error> {
    T::deserialize(deserializer).map(Some)
}
