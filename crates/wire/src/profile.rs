//! The profile: which shape touches the flat.
//!
//! The families with numbers for parameters, their documents, checks and limits come from the table
//! [`stickslip_mechanics::for_each_family!`]; tables of heights and sums are written out here, and contacts that are
//! known by their load curve alone in [`curve_profiles`](super::curve_profiles).

use std::fmt;
use std::marker::PhantomData;
use std::ops::RangeInclusive;
use std::sync::LazyLock;

use serde::de::value::{MapDeserializer, SeqDeserializer};
use serde::de::{DeserializeOwned, Error as _, IntoDeserializer, MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, forward_to_deserialize_any};
use utoipa::ToSchema;
use utoipa::openapi::{RefOr, Schema};

use stickslip_mechanics::profile::{Profile as Shape, Sum, Tabulated};
use stickslip_mechanics::{Elasticity, Error, for_each_family, profile as families, range};

use super::check::{Faults, JsonPath, accepted};
use super::curve_profiles::{AsperitiesProfile, EllipsoidProfile, LoadCurveProfile, MotionAxis};
use super::limits::{Array, Items, Limited, count};
use super::request::requests;

/// Declares everything that follows from the table of families.
macro_rules! documents {
    ($(
        $(#[$about:meta])* $module:ident::$Family:ident,
        $(#[doc = $about_document:literal])*
        $Document:ident { $($(#[$about_number:meta])* $number:ident: $RANGE:ident,)+ }
    )+) => {
        /// The shape of the indenter before it is loaded, chosen by `type`.
        #[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
        #[serde(tag = "type", rename_all = "snake_case")]
        #[schema(example = json!({"type": "sphere", "radius": 0.01}), no_recursion)]
        pub enum Profile {
            $($(#[$about])* $Family($Document),)+
            /// A measured profile, through whose points a smooth curve is drawn that keeps their monotony and
            /// convexity.
            Tabulated(TabulatedProfile),
            /// Several profiles added up, z = Σ zᵢ.
            Sum(SumProfile),
            /// Hertzian asperities on one rigid motion, which do not interact elastically. No stresses.
            Asperities(AsperitiesProfile),
            /// A load curve F_N(d), measured or computed elsewhere. No stresses.
            LoadCurve(LoadCurveProfile),
            /// An ellipsoid, or two bodies crossed: Hertz's ellipse of contact. No stresses.
            Ellipsoid(EllipsoidProfile),
        }

        requests! {$(
            $(#[doc = $about_document])*
            pub struct $Document {
                $($(#[$about_number])* pub $number: f64 = range::$RANGE,)+
            }
        )+}

        /// Schema, member and keywords of every limit.
        pub(super) fn limits() -> Vec<(&'static str, &'static str, serde_json::Value)> {
            [
                $(<$Document as Limited>::limits_of_schema(),)+
                TabulatedProfile::limits_of_schema(),
                SumProfile::limits_of_schema(),
                AsperitiesProfile::limits_of_schema(),
                LoadCurveProfile::limits_of_schema(),
                EllipsoidProfile::limits_of_schema(),
            ]
            .concat()
        }

        /// The schemas of the documents that [`Profile`] chooses from, by name: its recursion keeps the derivation from
        /// finding them.
        #[must_use]
        pub fn schemas() -> Vec<(String, RefOr<Schema>)> {
            fn named<T: ToSchema>() -> (String, RefOr<Schema>) {
                (T::name().into_owned(), T::schema())
            }
            vec![
                $(named::<$Document>(),)+
                named::<TabulatedProfile>(),
                named::<SumProfile>(),
                named::<AsperitiesProfile>(),
                named::<LoadCurveProfile>(),
                named::<EllipsoidProfile>(),
                named::<MotionAxis>(),
            ]
        }

        /// The names of the families.
        #[derive(Clone, Copy, Deserialize)]
        #[serde(rename_all = "snake_case")]
        enum Kind {
            $($Family,)+
            Tabulated,
            Sum,
            Asperities,
            LoadCurve,
            Ellipsoid,
        }

        impl Profile {
            /// The checked profile of these bodies, `None` if they are at fault; its own faults are noted at `at`, and
            /// so it is if `keep_going` has returned false.
            pub fn check(
                &self,
                bodies: Option<&Elasticity>,
                at: JsonPath<'_>,
                keep_going: &dyn Fn() -> bool,
                faults: &mut Faults,
            ) -> Option<Shape> {
                match self {
                    $(Profile::$Family(document) => {
                        document.check_members(at, faults);
                        accepted(families::$Family::new($(document.$number),+).map(Shape::$Family), at, faults)
                    })+
                    Profile::Tabulated(table) => check_table(table, Tabulated::new_while, at, keep_going, faults),
                    Profile::Sum(SumProfile { parts }) => check_sum(parts, bodies, at, keep_going, faults),
                    Profile::Asperities(asperities) => asperities.check(at, keep_going, faults),
                    Profile::LoadCurve(curve) => curve.check(bodies?, at, keep_going, faults),
                    Profile::Ellipsoid(ellipsoid) => ellipsoid.check(at, faults),
                }
            }
        }

        impl<'de> Deserialize<'de> for Profile {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                let members = deserializer.deserialize_map(MembersVisitor)?;
                match members.kind.ok_or_else(|| D::Error::missing_field("type"))? {
                    $(Kind::$Family => members.document().map(Profile::$Family),)+
                    Kind::Tabulated => members.document().map(Profile::Tabulated),
                    Kind::Sum => members.sum().map(Profile::Sum),
                    Kind::Asperities => members.document().map(Profile::Asperities),
                    Kind::LoadCurve => members.document().map(Profile::LoadCurve),
                    Kind::Ellipsoid => members.document().map(Profile::Ellipsoid),
                }
            }
        }
    };
}
for_each_family!(documents);

impl Profile {
    /// Points of all its tables and curves, and asperities: what preparing it takes time and memory for.
    #[must_use]
    pub fn points(&self) -> usize {
        match self {
            Profile::Tabulated(TabulatedProfile { r, .. }) => r.len(),
            Profile::Sum(SumProfile { parts }) => parts.iter().map(Profile::points).sum(),
            Profile::Asperities(asperities) => asperities.gaps.len(),
            Profile::LoadCurve(curve) => curve.indentation.len(),
            _ => 0,
        }
    }

    /// Whether what is prepared belongs to certain bodies: a load curve is scaled to their moduli.
    #[must_use]
    pub fn depends_on_bodies(&self) -> bool {
        matches!(self, Profile::LoadCurve(_))
    }
}

requests! {
/// A table of heights over radii, of equal lengths.
pub struct TabulatedProfile {
    /// Radii, m: from 0 on, increasing. The contact radius stays below the last.
    pub r: Vec<f64> = Array(TABLE_POINTS, range::TABLE_RADIUS),
    /// Heights z above the plane, m; an offset does not matter.
    pub z: Vec<f64> = Array(TABLE_POINTS, range::TABLE_HEIGHT),
    /// Standard errors of the indentation at which a contact has each radius, m, as `POST /profiles/fit` gives them:
    /// they take the place of what the heights say of their noise and of the shape between them. Of the length of `r`,
    /// and together with `pressure_error`.
    pub indentation_error: Option<Vec<f64>> = Array(TABLE_POINTS, range::INDENTATION_ERROR),
    /// The largest standard error of the pressure in a contact of each radius, over E*, a pure number. Of the length of
    /// `r`, and together with `indentation_error`.
    pub pressure_error: Option<Vec<f64>> = Array(TABLE_POINTS, range::PRESSURE_ERROR),
}

/// A sum of profiles.
pub struct SumProfile {
    /// The profiles that are added up.
    pub parts: Vec<Profile> = Items(SUM_PARTS),
}
}

/// Points of a tabulated profile.
const TABLE_POINTS: RangeInclusive<usize> = count(&range::TABLE_POINTS);
/// Profiles in one sum.
const SUM_PARTS: RangeInclusive<usize> = count(&range::PARTS);

/// The constructor of a table from radii and heights: on its own, or as part of a sum.
type Through = fn(&[f64], &[f64], &dyn Fn() -> bool) -> Result<Tabulated, Error>;

fn check_table(
    table: &TabulatedProfile,
    through: Through,
    at: JsonPath<'_>,
    keep_going: &dyn Fn() -> bool,
    faults: &mut Faults,
) -> Option<Shape> {
    let TabulatedProfile { r, z, indentation_error, pressure_error } = table;
    table.check_members(at, faults);
    for (name, given, other) in [
        ("indentation_error", indentation_error, pressure_error),
        ("pressure_error", pressure_error, indentation_error),
    ] {
        match given {
            None if other.is_some() => {
                faults.add(at.member(name), "the two errors of a table go together: give both or neither");
            }
            Some(errors) if errors.len() != r.len() => {
                faults.add(at.member(name), format_args!("{} elements: r has {}", errors.len(), r.len()));
            }
            _ => {}
        }
    }
    if !faults.is_empty() {
        return None;
    }
    let errors = indentation_error.as_ref().zip(pressure_error.as_ref());
    let made = through(r, z, keep_going).and_then(|made| match errors {
        Some((indentation, pressure)) => made.with_standard_errors(indentation, pressure),
        None => Ok(made),
    });
    accepted(made.map(Shape::Tabulated), at, faults)
}

fn check_sum(
    parts: &[Profile],
    bodies: Option<&Elasticity>,
    at: JsonPath<'_>,
    keep_going: &dyn Fn() -> bool,
    faults: &mut Faults,
) -> Option<Shape> {
    let place = at.member("parts");
    if !faults.length(place, parts.len(), &SUM_PARTS) {
        return None;
    }
    let mut check = |(index, part): (usize, &Profile)| match part {
        Profile::Tabulated(table) => check_table(table, Tabulated::part_while, place.index(index), keep_going, faults),
        part => part.check(bodies, place.index(index), keep_going, faults),
    };
    let shapes: Vec<_> = parts.iter().enumerate().map(&mut check).collect();
    let shapes: Option<Vec<Shape>> = shapes.into_iter().collect();
    match Sum::new_while(shapes?, keep_going) {
        Err(error @ Error::NoSurface { part }) => {
            faults.add(place.index(part), error);
            None
        }
        sum => accepted(sum.map(Shape::Sum), at, faults),
    }
}

/// The members of all families side by side. Reading them flat keeps the path of a fault, which serde's tagged enums
/// lose in their buffer, and allows `type` anywhere.
#[derive(Default)]
struct Members {
    kind: Option<Kind>,
    parts: Option<Vec<Profile>>,
    others: Vec<(&'static str, Member)>,
}

/// A member that the document of a family is read from again, without a detour by JSON: a table may be long.
enum Member {
    Number(f64),
    Column(Vec<f64>),
    Direction(MotionAxis),
    /// Parts of a sum, which no other family has.
    Parts,
}

/// The names of the members that are arrays of numbers.
const COLUMNS: [&str; 8] =
    ["r", "z", "indentation_error", "pressure_error", "radii", "gaps", "indentation", "normal_force"];

/// The names of all members, each once.
static NAMES: LazyLock<Vec<&'static str>> = LazyLock::new(|| {
    let mut names = vec!["type"];
    for name in limits().into_iter().map(|(_, name, _)| name).chain(["direction"]) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    names
});

impl Members {
    /// The document of a family, if all the members given belong to it.
    fn document<T: DeserializeOwned, E: serde::de::Error>(mut self) -> Result<T, E> {
        self.others.extend(self.parts.is_some().then_some(("parts", Member::Parts)));
        T::deserialize(MapDeserializer::new(self.others.into_iter()))
    }

    fn sum<E: serde::de::Error>(self) -> Result<SumProfile, E> {
        match (self.others.first(), self.parts) {
            (Some((foreign, _)), _) => Err(E::unknown_field(foreign, &["parts"])),
            (None, None) => Err(E::missing_field("parts")),
            (None, Some(parts)) => Ok(SumProfile { parts }),
        }
    }
}

impl<'de, E: serde::de::Error> IntoDeserializer<'de, E> for Member {
    type Deserializer = MemberDeserializer<E>;

    fn into_deserializer(self) -> MemberDeserializer<E> {
        MemberDeserializer(self, PhantomData)
    }
}

struct MemberDeserializer<E>(Member, PhantomData<E>);

impl<'de, E: serde::de::Error> Deserializer<'de> for MemberDeserializer<E> {
    type Error = E;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, E> {
        match self.0 {
            Member::Number(number) => visitor.visit_f64(number),
            Member::Column(numbers) => visitor.visit_seq(SeqDeserializer::new(numbers.into_iter())),
            Member::Direction(direction) => visitor.visit_enum(direction.name().into_deserializer()),
            Member::Parts => visitor.visit_unit(),
        }
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, E> {
        visitor.visit_some(self)
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf unit unit_struct
        newtype_struct seq tuple tuple_struct map struct enum identifier ignored_any
    }
}

/// The name of a member: an unknown one is a fault at its own place.
struct Name(&'static str);

impl<'de> Deserialize<'de> for Name {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let name = String::deserialize(deserializer)?;
        let known = NAMES.iter().find(|known| **known == name);
        known.map(|known| Name(known)).ok_or_else(|| D::Error::unknown_field(&name, &NAMES))
    }
}

struct MembersVisitor;

impl<'de> Visitor<'de> for MembersVisitor {
    type Value = Members;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an object")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Members, A::Error> {
        let mut members = Members::default();
        while let Some(Name(name)) = map.next_key()? {
            // `null` is not a value.
            let is_repeated = match name {
                "type" => members.kind.replace(map.next_value()?).is_some(),
                "parts" => members.parts.replace(map.next_value()?).is_some(),
                name => {
                    let value = match name {
                        "direction" => Member::Direction(map.next_value()?),
                        column if COLUMNS.contains(&column) => Member::Column(map.next_value()?),
                        _ => Member::Number(map.next_value()?),
                    };
                    members.others.push((name, value));
                    members.others.iter().filter(|(other, _)| *other == name).count() > 1
                }
            };
            if is_repeated {
                return Err(A::Error::duplicate_field(name));
            }
        }
        Ok(members)
    }
}
