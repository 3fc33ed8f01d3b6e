//! The profile: which shape touches the flat.
//!
//! The documents of the families whose parameters are plain numbers follow from their declarations
//! ([`stickslip_mechanics::profile::families`]); tables of heights and sums are written out here, and contacts that are
//! known by their load curve alone in [`curve_profiles`](super::curve_profiles), those along a line in
//! [`line_profiles`](super::line_profiles).

use std::fmt;
use std::marker::PhantomData;
use std::sync::LazyLock;

use serde::de::value::{MapDeserializer, SeqDeserializer};
use serde::de::{DeserializeOwned, Error as _, IntoDeserializer, MapAccess, Visitor};
use serde::ser::SerializeMap as _;
use serde::{Serializer, forward_to_deserialize_any};
use utoipa::PartialSchema;
use utoipa::openapi::schema::{AllOfBuilder, OneOfBuilder, SchemaFormat, Type};
use utoipa::openapi::{KnownFormat, ObjectBuilder, Ref, RefOr, Schema};

use stickslip_mechanics::Elasticity;
use stickslip_mechanics::profile::{Family, Parameter, Profile as Shape, Sum, Tabulated, families};

use super::check::accepted;
use super::curve_profiles::{AsperitiesProfile, EllipsoidProfile, LoadCurveProfile, MotionAxis};
use super::line_profiles::{CylinderProfile, RoundedPadProfile};
use crate::prelude::*;

/// Declares the profiles whose documents are written out, with the `type` of each.
macro_rules! profiles {
    ($($(#[doc = $about:literal])* $word:literal => $Kind:ident($Members:ident),)+) => {
        /// The shape of the indenter before it is loaded, chosen by `type`.
        #[derive(Clone, Debug, PartialEq, Serialize)]
        #[serde(tag = "type")]
        pub enum Profile {
            $($(#[doc = $about])* #[serde(rename = $word)] $Kind($Members),)+
            /// A shape whose parameters are plain numbers.
            #[serde(untagged)]
            Closed(ClosedProfile),
        }

        /// What a `type` stands for.
        enum Kind {
            $($Kind,)+
            Closed(&'static Document),
        }

        impl Kind {
            fn of(word: &str) -> Option<Kind> {
                match word {
                    $($word => Some(Kind::$Kind),)+
                    _ => CLOSED.iter().find(|document| document.family.name == word).map(Kind::Closed),
                }
            }
        }

        /// The words of the profiles whose documents are written out, the names of their schemas, and these.
        fn written_out() -> Vec<(&'static str, String, RefOr<Schema>)> {
            vec![$(($word, $Members::name().into_owned(), $Members::schema())),+]
        }

        impl Limited for Profile {
            fn add_limits(found: &mut LimitsOfSchemas) {
                let limit = |of: &Parameter| (of.name, Limit::<f64>::keywords(&of.range));
                for Document { family, schema, .. } in &*CLOSED {
                    found.insert(schema, family.parameters.iter().map(limit).collect());
                }
                $($Members::add_limits(found);)+
            }

            fn check_limits(&self, at: JsonPath<'_>, faults: &mut Faults) {
                match self {
                    Profile::Closed(ClosedProfile { document, numbers }) => {
                        for (parameter, number) in document.family.parameters.iter().zip(numbers) {
                            faults.number(at.member(parameter.name), *number, &parameter.range);
                        }
                    }
                    $(Profile::$Kind(members) => members.check_limits(at, faults),)+
                }
            }
        }

        impl Members {
            #[allow(unreachable_patterns, reason = "a sum is read in another way")]
            fn profile<E: serde::de::Error>(self, kind: Kind) -> Result<Profile, E> {
                match kind {
                    Kind::Closed(document) => self.closed(document).map(Profile::Closed),
                    Kind::Sum => self.sum().map(Profile::Sum),
                    $(Kind::$Kind => self.document().map(Profile::$Kind),)+
                }
            }
        }
    };
}

profiles! {
    /// A measured profile, through whose points a smooth curve is drawn that keeps their monotony and convexity.
    "tabulated" => Tabulated(TabulatedProfile),
    /// Several profiles added up, z = Σ zᵢ.
    "sum" => Sum(SumProfile),
    /// Hertzian asperities on one rigid body, which do not interact elastically. Without a stress field.
    "asperities" => Asperities(AsperitiesProfile),
    /// A load curve F_N(d), measured or computed elsewhere. Without a stress field.
    "load_curve" => LoadCurve(LoadCurveProfile),
    /// An ellipsoid, or two bodies crossed: Hertz's ellipse of contact. Without a stress field.
    "ellipsoid" => Ellipsoid(EllipsoidProfile),
    /// A cylinder pressed along a line.
    "cylinder" => Cylinder(CylinderProfile),
    /// A flat pad with rounded edges pressed along a line.
    "rounded_pad" => RoundedPad(RoundedPadProfile),
}

/// A profile of a family whose parameters are plain numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct ClosedProfile {
    document: &'static Document,
    numbers: Vec<f64>,
}

/// The document of a family.
#[derive(Debug)]
struct Document {
    family: &'static Family,
    /// The name of its schema: `TruncatedConeProfile` of `truncated_cone`.
    schema: String,
    /// The names of its members.
    members: Vec<&'static str>,
}

impl PartialEq for Document {
    fn eq(&self, other: &Document) -> bool {
        self.schema == other.schema
    }
}

/// Those of all families, in their order.
static CLOSED: LazyLock<Vec<Document>> = LazyLock::new(|| {
    let document = |family: &&'static Family| {
        let words = family.name.split('_').map(|word| word[..1].to_uppercase() + &word[1..]);
        let members = family.parameters.iter().map(|parameter| parameter.name).collect();
        Document { family, schema: words.collect::<String>() + "Profile", members }
    };
    families().iter().map(document).collect()
});

impl Serialize for ClosedProfile {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let numbers = self.document.members.iter().zip(&self.numbers);
        let mut map = serializer.serialize_map(None)?;
        map.serialize_entry("type", self.document.family.name)?;
        numbers.into_iter().try_for_each(|(name, number)| map.serialize_entry(name, number))?;
        map.end()
    }
}

/// The names of the families with the schemas of their documents, and the names of these.
fn documents() -> Vec<(&'static str, String, RefOr<Schema>)> {
    let closed = CLOSED.iter().map(|Document { family, schema, .. }| {
        let document = family.parameters.iter().fold(ObjectBuilder::new(), |document, parameter| {
            let format = SchemaFormat::KnownFormat(KnownFormat::Double);
            let about = Some(parameter.about);
            let number = ObjectBuilder::new().schema_type(Type::Number).format(Some(format)).description(about);
            document.property(parameter.name, number).required(parameter.name)
        });
        (family.name, schema.clone(), document.description(Some(family.about)).into())
    });
    closed.chain(written_out()).collect()
}

/// The schemas of the documents that [`Profile`] chooses from, by name: its recursion keeps the derivation from finding
/// them.
pub fn schemas() -> Vec<(String, RefOr<Schema>)> {
    let direction = (<MotionAxis as ToSchema>::name().into_owned(), MotionAxis::schema());
    documents().into_iter().map(|(_, name, schema)| (name, schema)).chain([direction]).collect()
}

impl ToSchema for Profile {}

impl PartialSchema for Profile {
    #[expect(deprecated, reason = "tools of version 3.0 of OpenAPI read `example`")]
    fn schema() -> RefOr<Schema> {
        let choice = OneOfBuilder::new()
            .description(Some("The shape of the indenter before it is loaded, chosen by `type`."))
            .example(Some(json!({"type": "sphere", "radius": 0.01})));
        let choices = documents().into_iter().fold(choice, |choice, (family, name, _)| {
            let name_of_family = ObjectBuilder::new().schema_type(Type::String).enum_values(Some([family]));
            let tag = ObjectBuilder::new().property("type", name_of_family).required("type");
            choice.item(AllOfBuilder::new().item(Ref::from_schema_name(name)).item(tag))
        });
        choices.into()
    }
}

impl<'de> Deserialize<'de> for Kind {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        static WORDS: LazyLock<Vec<&str>> = LazyLock::new(|| documents().into_iter().map(|kind| kind.0).collect());
        let word = String::deserialize(deserializer)?;
        Kind::of(&word).ok_or_else(|| D::Error::unknown_variant(&word, &WORDS))
    }
}

impl Profile {
    /// Hertz's parabola of this radius of curvature, m: the first family.
    pub fn sphere(radius: f64) -> Profile {
        Profile::Closed(ClosedProfile { document: &CLOSED[0], numbers: vec![radius] })
    }

    /// The checked profile of these bodies, `None` if they are at fault; its own faults are noted at `at`, and so it is
    /// if `keep_going` has returned false.
    pub fn check(
        &self,
        bodies: Option<&Elasticity>,
        at: JsonPath<'_>,
        keep_going: &dyn Fn() -> bool,
        faults: &mut Faults,
    ) -> Option<Shape> {
        faults.none_within(at)?;
        match self {
            Profile::Closed(ClosedProfile { document: Document { family, .. }, numbers }) => {
                accepted((family.make)(numbers), at, faults)
            }
            Profile::Tabulated(table) => check_table(table, Tabulated::new_while, at, keep_going, faults),
            Profile::Sum(SumProfile { parts }) => check_sum(parts, bodies, at, keep_going, faults),
            Profile::Asperities(asperities) => asperities.check(at, keep_going, faults),
            Profile::LoadCurve(curve) => curve.check(bodies?, at, keep_going, faults),
            Profile::Ellipsoid(ellipsoid) => ellipsoid.check(at, faults),
            Profile::Cylinder(cylinder) => cylinder.check(at, faults),
            Profile::RoundedPad(pad) => pad.check(at, faults),
        }
    }
}

impl<'de> Deserialize<'de> for Profile {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let mut members = deserializer.deserialize_map(MembersVisitor)?;
        let kind = members.kind.take().ok_or_else(|| D::Error::missing_field("type"))?;
        members.profile(kind)
    }
}

impl Profile {
    /// Points of all its tables and curves, and asperities: what preparing it takes time and memory for.
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
    pub fn depends_on_bodies(&self) -> bool {
        matches!(self, Profile::LoadCurve(_))
    }
}

requests! {
/// A table of heights over radii, of equal lengths.
pub struct TabulatedProfile {
    /// Radii, m: increasing from 0. The contact radius must stay below the last.
    pub r: Vec<f64> = Array(TABLE_POINTS, range::TABLE_RADIUS),
    /// Heights z above the plane, m; an offset does not matter.
    pub z: Vec<f64> = Array(TABLE_POINTS, range::TABLE_HEIGHT),
    /// Standard errors of the indentation at which a contact has each radius, m, as `POST /profiles/fit` gives them:
    /// they replace the estimates from the noise of the heights and from the shape between them. One for each radius in
    /// `r`; requires `pressure_error`.
    pub indentation_error: Option<Vec<f64>> = Array(TABLE_POINTS, range::INDENTATION_ERROR),
    /// The largest standard error of the pressure in a contact of each radius, over E*, a pure number. One for each
    /// radius in `r`; requires `indentation_error`.
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
    for (name, given, other) in [
        ("indentation_error", indentation_error, pressure_error),
        ("pressure_error", pressure_error, indentation_error),
    ] {
        match given {
            None if other.is_some() => {
                faults.add(at.member(name), "the two errors of a table go together: give both or neither");
            }
            Some(errors) if errors.len() != r.len() => {
                faults.add(at.member(name), format_args!("{} elements, but r has {}", errors.len(), r.len()));
            }
            _ => {}
        }
    }
    faults.none_within(at)?;
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
    let mut check = |(index, part): (usize, &Profile)| match part {
        Profile::Tabulated(table) => check_table(table, Tabulated::part_while, place.index(index), keep_going, faults),
        part => part.check(bodies, place.index(index), keep_going, faults),
    };
    let shapes: Vec<_> = parts.iter().enumerate().map(&mut check).collect();
    let shapes: Option<Vec<Shape>> = shapes.into_iter().collect();
    match Sum::new_while(shapes?, keep_going) {
        Err(error @ Error::NoSurface { part }) => faults.refuse(place.index(part), error),
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
    let mut limits = LimitsOfSchemas::new();
    Profile::add_limits(&mut limits);
    names.extend(limits.into_values().flatten().map(|(name, _)| name).chain(["direction"]));
    names.sort_unstable();
    names.dedup();
    names
});

impl Members {
    /// The document of a family, if all the members given belong to it.
    fn document<T: DeserializeOwned, E: serde::de::Error>(mut self) -> Result<T, E> {
        self.others.extend(self.parts.is_some().then_some(("parts", Member::Parts)));
        T::deserialize(MapDeserializer::new(self.others.into_iter()))
    }

    /// The parameters of a family, if these are the members given.
    fn closed<E: serde::de::Error>(self, document: &'static Document) -> Result<ClosedProfile, E> {
        let names = &document.members;
        let mut numbers = vec![None; names.len()];
        for (name, member) in self.others.into_iter().chain(self.parts.map(|_| ("parts", Member::Parts))) {
            match (names.iter().position(|known| *known == name), member) {
                (Some(at), Member::Number(number)) => numbers[at] = Some(number),
                _ => return Err(E::unknown_field(name, names)),
            }
        }
        let given = |(number, name): (Option<f64>, &&'static str)| number.ok_or_else(|| E::missing_field(name));
        let numbers = numbers.into_iter().zip(names).map(given).collect::<Result<_, E>>()?;
        Ok(ClosedProfile { document, numbers })
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
