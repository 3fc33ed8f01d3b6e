//! The profile: which shape touches the flat.
//!
//! The families with numbers for parameters, their documents, checks and limits come from the table
//! [`stickslip_mechanics::for_each_family!`]; the other two, tables of heights and sums, are written out here.

use std::fmt;
use std::sync::LazyLock;

use serde::de::{Error as _, MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};
use utoipa::ToSchema;
use utoipa::openapi::{RefOr, Schema};

use stickslip_mechanics::profile::{Profile as Shape, Sum, Tabulated};
use stickslip_mechanics::{Error, TableFault, for_each_family, profile as families, range, range::Range};

use super::check::{Faults, JsonPath};
use super::limits;

/// Declares everything that follows from the table of families.
macro_rules! documents {
    ($(
        $(#[$about:meta])* $module:ident::$Family:ident,
        $(#[$about_document:meta])* $Document:ident { $($(#[$about_number:meta])* $number:ident: $RANGE:ident,)+ }
    )+) => {
        /// The shape of the indenter before it is loaded, chosen by `type`.
        #[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
        #[serde(tag = "type", rename_all = "snake_case")]
        #[schema(example = json!({"type": "sphere", "radius": 0.01}), no_recursion)]
        pub enum Profile {
            $($(#[$about])* $Family($Document),)+
            /// A measured profile, through whose points a smooth curve is drawn that keeps their monotony and convexity.
            Tabulated(TabulatedProfile),
            /// Several profiles added up, z = Σ zᵢ.
            Sum(SumProfile),
        }

        $(
            $(#[$about_document])*
            #[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
            pub struct $Document {
                $($(#[$about_number])* pub $number: f64,)+
            }
        )+

        /// The numbers of the families: schema, member and range of each.
        pub const NUMBERS: &[(&str, &str, Range)] =
            &[$($((stringify!($Document), stringify!($number), range::$RANGE),)+)+];

        /// The schemas of the documents that [`Profile`] chooses from, by name: its recursion keeps the derivation from finding them.
        #[must_use]
        pub fn schemas() -> Vec<(String, RefOr<Schema>)> {
            fn named<T: ToSchema>() -> (String, RefOr<Schema>) {
                (T::name().into_owned(), T::schema())
            }
            vec![$(named::<$Document>(),)+ named::<TabulatedProfile>(), named::<SumProfile>()]
        }

        /// The names of the families.
        #[derive(Clone, Copy, Deserialize)]
        #[serde(rename_all = "snake_case")]
        enum Kind {
            $($Family,)+
            Tabulated,
            Sum,
        }

        impl Kind {
            /// The members beside `type`, all of which are needed.
            fn members(self) -> &'static [&'static str] {
                match self {
                    $(Kind::$Family => &[$(stringify!($number)),+],)+
                    Kind::Tabulated => &["r", "z"],
                    Kind::Sum => &["parts"],
                }
            }
        }

        impl Profile {
            /// The checked profile; its faults are noted at `at`.
            pub fn check(&self, at: JsonPath<'_>, faults: &mut Faults) -> Option<Shape> {
                match self {
                    $(Profile::$Family($Document { $($number),+ }) => {
                        $(faults.number(at.member(stringify!($number)), *$number, &range::$RANGE);)+
                        accepted(families::$Family::new($(*$number),+).map(Shape::$Family), at, faults)
                    })+
                    Profile::Tabulated(TabulatedProfile { r, z }) => check_table(r, z, Tabulated::new, at, faults),
                    Profile::Sum(SumProfile { parts }) => check_sum(parts, at, faults),
                }
            }
        }

        impl<'de> Deserialize<'de> for Profile {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                let members = deserializer.deserialize_struct("Members", &[], MembersVisitor)?;
                Ok(match members.kind()? {
                    $(Kind::$Family => Profile::$Family($Document { $($number: members.number(stringify!($number))?),+ }),)+
                    Kind::Tabulated => Profile::Tabulated(TabulatedProfile {
                        r: members.r.ok_or_else(|| D::Error::missing_field("r"))?,
                        z: members.z.ok_or_else(|| D::Error::missing_field("z"))?,
                    }),
                    Kind::Sum => Profile::Sum(SumProfile {
                        parts: members.parts.ok_or_else(|| D::Error::missing_field("parts"))?,
                    }),
                })
            }
        }
    };
}
for_each_family!(documents);

/// A table of heights over radii, of equal lengths.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
pub struct TabulatedProfile {
    /// Radii, m: from 0 on, increasing. The contact radius stays below the last.
    pub r: Vec<f64>,
    /// Heights z above the plane, m; an offset does not matter.
    pub z: Vec<f64>,
}

/// A sum of profiles.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
pub struct SumProfile {
    /// The profiles that are added up.
    pub parts: Vec<Profile>,
}

/// The constructor of a table from radii and heights: on its own, or as part of a sum.
type Through = fn(&[f64], &[f64]) -> Result<Tabulated, Error>;

fn check_table(r: &[f64], z: &[f64], through: Through, at: JsonPath<'_>, faults: &mut Faults) -> Option<Shape> {
    for (name, numbers, range) in [("r", r, &range::TABLE_RADIUS), ("z", z, &range::TABLE_HEIGHT)] {
        let place = at.member(name);
        if faults.length(place, numbers.len(), &limits::TABLE_POINTS) {
            numbers.iter().enumerate().for_each(|(index, value)| faults.number(place.index(index), *value, range));
        }
    }
    if !faults.is_empty() {
        return None;
    }
    accepted(through(r, z).map(Shape::Tabulated), at, faults)
}

fn check_sum(parts: &[Profile], at: JsonPath<'_>, faults: &mut Faults) -> Option<Shape> {
    let place = at.member("parts");
    if !faults.length(place, parts.len(), &limits::SUM_PARTS) {
        return None;
    }
    let mut check = |(index, part): (usize, &Profile)| match part {
        Profile::Tabulated(TabulatedProfile { r, z }) => check_table(r, z, Tabulated::part, place.index(index), faults),
        part => part.check(place.index(index), faults),
    };
    let shapes: Vec<_> = parts.iter().enumerate().map(&mut check).collect();
    let shapes: Option<Vec<Shape>> = shapes.into_iter().collect();
    accepted(Sum::new(shapes?).map(Shape::Sum), at, faults)
}

/// The shape, unless the mechanics refuses it although each number is in its range: then a fault is added.
fn accepted(shape: Result<Shape, Error>, at: JsonPath<'_>, faults: &mut Faults) -> Option<Shape> {
    match shape {
        Ok(shape) => return Some(shape),
        // It follows from a fault that has been noted already.
        Err(_) if !faults.is_empty() => {}
        Err(error @ (Error::NotConvexEnough { .. } | Error::BeyondProfile { .. })) => faults.unanswerable(at, error),
        Err(Error::Table { fault, index }) => match fault {
            TableFault::FirstRadiusNotZero | TableFault::RadiusNotRising => {
                faults.add(at.member("r").index(index), fault);
            }
            // The heights, and the two lengths, are at fault as a whole.
            TableFault::LengthsDiffer | TableFault::HeightNeverRises => faults.add(at.member("z"), fault),
        },
        Err(error) => faults.add(at, error),
    }
    None
}

/// The members of all families side by side. Reading them flat keeps the path of a fault, which serde's tagged enums lose
/// in their buffer, and allows `type` anywhere.
#[derive(Default)]
struct Members {
    kind: Option<Kind>,
    /// At the first index of the name in [`NUMBERS`].
    numbers: [Option<f64>; NUMBERS.len()],
    r: Option<Vec<f64>>,
    z: Option<Vec<f64>>,
    parts: Option<Vec<Profile>>,
}

/// The names of all members, each once.
static NAMES: LazyLock<Vec<&'static str>> = LazyLock::new(|| {
    let mut names = vec!["type"];
    for name in NUMBERS.iter().map(|(_, name, _)| *name).chain(["r", "z", "parts"]) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    names
});

/// The index of the number of this name in [`Members::numbers`].
fn place_of(name: &str) -> Option<usize> {
    NUMBERS.iter().position(|(_, known, _)| *known == name)
}

impl Members {
    /// The family, if all the members given belong to it.
    fn kind<E: serde::de::Error>(&self) -> Result<Kind, E> {
        let kind = self.kind.ok_or_else(|| E::missing_field("type"))?;
        let given = |name: &str| match name {
            "r" => self.r.is_some(),
            "z" => self.z.is_some(),
            "parts" => self.parts.is_some(),
            _ => place_of(name).is_some_and(|place| self.numbers[place].is_some()),
        };
        match NAMES.iter().find(|name| given(name) && !kind.members().contains(name)) {
            Some(foreign) => Err(E::unknown_field(foreign, kind.members())),
            None => Ok(kind),
        }
    }

    fn number<E: serde::de::Error>(&self, name: &'static str) -> Result<f64, E> {
        place_of(name).and_then(|place| self.numbers[place]).ok_or_else(|| E::missing_field(name))
    }
}

/// The name of a member.
struct Name(&'static str);

impl<'de> Deserialize<'de> for Name {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct NameVisitor;

        impl Visitor<'_> for NameVisitor {
            type Value = Name;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("field identifier")
            }

            fn visit_str<E: serde::de::Error>(self, name: &str) -> Result<Name, E> {
                let known = NAMES.iter().find(|known| **known == name);
                known.map(|known| Name(known)).ok_or_else(|| E::unknown_field(name, &NAMES))
            }
        }

        deserializer.deserialize_identifier(NameVisitor)
    }
}

struct MembersVisitor;

impl<'de> Visitor<'de> for MembersVisitor {
    type Value = Members;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("struct Members")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Members, A::Error> {
        /// Reads the value of a member unless there is one already; `null` is not a value.
        fn read<'de, T: Deserialize<'de>, A: MapAccess<'de>>(
            member: &mut Option<T>,
            name: &'static str,
            map: &mut A,
        ) -> Result<(), A::Error> {
            if member.is_some() {
                return Err(A::Error::duplicate_field(name));
            }
            *member = Some(map.next_value()?);
            Ok(())
        }

        let mut members = Members::default();
        while let Some(Name(name)) = map.next_key()? {
            match name {
                "type" => read(&mut members.kind, name, &mut map)?,
                "r" => read(&mut members.r, name, &mut map)?,
                "z" => read(&mut members.z, name, &mut map)?,
                "parts" => read(&mut members.parts, name, &mut map)?,
                _ => {
                    if let Some(place) = place_of(name) {
                        read(&mut members.numbers[place], name, &mut map)?;
                    }
                }
            }
        }
        Ok(members)
    }
}
