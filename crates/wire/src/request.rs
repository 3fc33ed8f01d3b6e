//! Declaring the objects of requests.
//!
//! Declarations within `requests!`, `choices!` and `words!` begin at the margin: the descriptions in the OpenAPI
//! document have the lines of these comments.

use crate::prelude::*;

/// Declares objects of requests, `requests! { pub struct Name: Copy, .. { pub member: Type = limit, .. } .. }`, with
/// the traits that they have beside those of all, and the [limits](crate::limits) of their members. An unknown member
/// is a fault. A member of the type `Option` may be left out but, once named, must have a value: some clients write NaN
/// as `null`.
macro_rules! requests {
    ($(
        $(#[doc = $about:literal])*
        $(#[schema($($schema:tt)*)])?
        pub struct $Name:ident $(: $($Trait:ident),+)? {
            $($(#[$of_member:meta])* pub $member:ident: $type:ty $(= $limit:expr)?,)*
        }
    )+) => {$(
        $(#[doc = $about])*
        #[serde_with::skip_serializing_none]
        #[serde_with::apply(
            Option => #[serde(default, deserialize_with = "crate::request::not_null")] #[schema(nullable = false)],
            usize => #[serde(deserialize_with = "crate::whole::read")],
            u64 => #[serde(deserialize_with = "crate::whole::read")],
        )]
        #[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema $($(, $Trait)+)?)]
        #[serde(deny_unknown_fields, remote = "Self")]
        $(#[schema($($schema)*)])?
        pub struct $Name {
            $($(#[$of_member])* pub $member: $type,)*
        }

        impl serde::Serialize for $Name {
            fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                $Name::serialize(self, serializer)
            }
        }

        // From objects alone: serde would also accept an array of the members' values, in the order of declaration.
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

        impl $crate::limits::Limited for $Name {
            fn add_limits(found: &mut $crate::limits::LimitsOfSchemas) {
                let own = vec![$($(
                    (
                        $crate::request::name_in_json(stringify!($member)),
                        $crate::limits::Limit::<$type>::keywords(&$limit),
                    ),
                )?)*];
                if found.insert(stringify!($Name), own).is_none() {
                    $(<$type as $crate::limits::Limited>::add_limits(found);)*
                }
            }

            fn check_limits(&self, at: $crate::check::JsonPath<'_>, faults: &mut $crate::check::Faults) {
                $(
                    let place = at.member(const { $crate::request::name_in_json(stringify!($member)) });
                    $($crate::limits::Limit::check(&$limit, &self.$member, place, faults);)?
                    $crate::limits::Limited::check_limits(&self.$member, place, faults);
                )*
            }
        }
    )+};
}
pub(crate) use requests;

/// Declares objects of replies, `replies! { pub struct Name: Copy, .. omits Option of Other { .. } .. }`, with the
/// traits that they have beside those of all, and the type of the mechanics that has the same members. A member without
/// a value is `null` or, with `omits Option`, left out.
macro_rules! replies {
    ($(
        $(#[$about:meta])*
        pub struct $Name:ident $(: $($Trait:ident),+)? $(omits $Option:ident)? $(of $Other:ty)? {
            $($(#[$of_member:meta])* pub $member:ident: $type:ty,)*
        }
    )+) => {$(
        $(#[serde_with::apply(
            $Option => #[serde(skip_serializing_if = "Option::is_none")] #[schema(nullable = false)]
        )])?
        #[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema $($(, $Trait)+)?)]
        $(#[$about])*
        pub struct $Name {
            $($(#[$of_member])* pub $member: $type,)*
        }

        $crate::request::same_members! { $Name [$($Other)?] $($member)* }
    )+};
}
pub(crate) use replies;

/// Converts from a type with the same members, if there is one.
macro_rules! same_members {
    ($Name:path [] $($member:ident)*) => {};
    ($Name:path [$Other:ty] $($member:ident)*) => {
        impl From<$Other> for $Name {
            fn from(other: $Other) -> Self {
                $Name { $($member: other.$member.into(),)* }
            }
        }
    };
}
pub(crate) use same_members;

/// The name of a member in JSON: that of a Rust keyword is written `r#name`.
pub(crate) const fn name_in_json(member: &'static str) -> &'static str {
    if let [b'r', b'#', ..] = member.as_bytes() { member.split_at(2).1 } else { member }
}

/// For members that may be left out but, once named, must have a value: some clients write NaN as `null`.
pub(crate) fn not_null<'de, T: Deserialize<'de>, D: Deserializer<'de>>(deserializer: D) -> Result<Option<T>, D::Error> {
    crate::whole::read(deserializer).map(Some)
}
