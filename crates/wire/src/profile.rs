//! The profile: which shape touches the flat.
//!
//! The families with numbers for parameters, their documents, checks and limits come from the table
//! [`stickslip_mechanics::for_each_family!`]; tables of heights and sums are written out here, and contacts that are
//! known by their load curve alone in [`curve_profiles`](super::curve_profiles).

use std::collections::BTreeMap;
use std::fmt;
use std::sync::LazyLock;

use serde::de::{Error as _, MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};
use utoipa::ToSchema;
use utoipa::openapi::{RefOr, Schema};

use stickslip_mechanics::profile::{Profile as Shape, Sum, Tabulated};
use stickslip_mechanics::{Elasticity, Error, for_each_family, profile as families, range, range::Range};

use super::check::{Faults, JsonPath, accepted};
use super::curve_profiles::{AsperitiesProfile, EllipsoidProfile, LoadCurveProfile, MotionAxis};
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

        impl Kind {
            /// The members beside `type`, all of which are needed, but for one of the radii of asperities.
            fn members(self) -> &'static [&'static str] {
                match self {
                    $(Kind::$Family => &[$(stringify!($number)),+],)+
                    Kind::Tabulated => &["r", "z", "indentation_error", "pressure_error"],
                    Kind::Sum => &["parts"],
                    Kind::Asperities => &["radii", "radius", "gaps"],
                    Kind::LoadCurve => &["indentation", "normal_force"],
                    Kind::Ellipsoid => &["radii", "direction"],
                }
            }
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
                    $(Profile::$Family($Document { $($number),+ }) => {
                        $(faults.number(at.member(stringify!($number)), *$number, &range::$RANGE);)+
                        accepted(families::$Family::new($(*$number),+).map(Shape::$Family), at, faults)
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
                let mut members = deserializer.deserialize_struct("Members", &[], MembersVisitor)?;
                Ok(match members.kind()? {
                    $(Kind::$Family => Profile::$Family($Document {
                        $($number: members.number(stringify!($number))?),+
                    }),)+
                    Kind::Tabulated => {
                        let mut given = |name| members.columns.remove(name);
                        let indentation_error = given("indentation_error");
                        let pressure_error = given("pressure_error");
                        let (r, z) = (members.column("r")?, members.column("z")?);
                        Profile::Tabulated(TabulatedProfile { r, z, indentation_error, pressure_error })
                    }
                    Kind::Sum => Profile::Sum(SumProfile {
                        parts: members.parts.ok_or_else(|| D::Error::missing_field("parts"))?,
                    }),
                    Kind::Asperities => Profile::Asperities(AsperitiesProfile {
                        radii: members.columns.remove("radii"),
                        radius: members.numbers.get("radius").copied(),
                        gaps: members.column("gaps")?,
                    }),
                    Kind::LoadCurve => Profile::LoadCurve(LoadCurveProfile {
                        indentation: members.column("indentation")?,
                        normal_force: members.column("normal_force")?,
                    }),
                    Kind::Ellipsoid => Profile::Ellipsoid(EllipsoidProfile {
                        radii: members.column("radii")?,
                        direction: members.direction.ok_or_else(|| D::Error::missing_field("direction"))?,
                    }),
                })
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

/// A table of heights over radii, of equal lengths.
#[serde_with::apply(Option => #[serde(default, skip_serializing_if = "Option::is_none")] #[schema(nullable = false)])]
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
pub struct TabulatedProfile {
    /// Radii, m: from 0 on, increasing. The contact radius stays below the last.
    pub r: Vec<f64>,
    /// Heights z above the plane, m; an offset does not matter.
    pub z: Vec<f64>,
    /// Standard errors of the indentation at which a contact has each radius, m, as `POST /profiles/fit` gives them:
    /// they take the place of what the heights say of their noise and of the shape between them. Of the length of `r`,
    /// and together with `pressure_error`.
    pub indentation_error: Option<Vec<f64>>,
    /// The largest standard error of the pressure in a contact of each radius, over E*, a pure number. Of the length of
    /// `r`, and together with `indentation_error`.
    pub pressure_error: Option<Vec<f64>>,
}

/// A sum of profiles.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
pub struct SumProfile {
    /// The profiles that are added up.
    pub parts: Vec<Profile>,
}

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
        if given.is_none() && other.is_some() {
            faults.add(at.member(name), "the two errors of a table go together: give both or neither");
        }
    }
    let errors = indentation_error.as_ref().zip(pressure_error.as_ref());
    let columns = [("r", Some(r), &range::TABLE_RADIUS), ("z", Some(z), &range::TABLE_HEIGHT)].into_iter().chain([
        ("indentation_error", errors.map(|errors| errors.0), &range::INDENTATION_ERROR),
        ("pressure_error", errors.map(|errors| errors.1), &range::PRESSURE_ERROR),
    ]);
    for (name, numbers, range) in columns {
        let (place, Some(numbers)) = (at.member(name), numbers) else { continue };
        if name.ends_with("_error") && numbers.len() != r.len() {
            faults.add(place, format_args!("{} elements: r has {}", numbers.len(), r.len()));
        } else if faults.length(place, numbers.len(), &limits::TABLE_POINTS) {
            numbers.iter().enumerate().for_each(|(index, value)| faults.number(place.index(index), *value, range));
        }
    }
    if !faults.is_empty() {
        return None;
    }
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
    if !faults.length(place, parts.len(), &limits::SUM_PARTS) {
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
    numbers: BTreeMap<&'static str, f64>,
    columns: BTreeMap<&'static str, Vec<f64>>,
    direction: Option<MotionAxis>,
    parts: Option<Vec<Profile>>,
}

/// The names of the members that are arrays of numbers.
const COLUMNS: [&str; 8] =
    ["r", "z", "indentation_error", "pressure_error", "radii", "gaps", "indentation", "normal_force"];

/// The names of all members, each once.
static NAMES: LazyLock<Vec<&'static str>> = LazyLock::new(|| {
    let mut names = vec!["type"];
    for name in NUMBERS.iter().map(|(_, name, _)| *name).chain(COLUMNS).chain(["direction", "parts"]) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    names
});

impl Members {
    fn has(&self, name: &str) -> bool {
        match name {
            "type" => self.kind.is_some(),
            "parts" => self.parts.is_some(),
            "direction" => self.direction.is_some(),
            name => self.numbers.contains_key(name) || self.columns.contains_key(name),
        }
    }

    /// The family, if all the members given belong to it.
    fn kind<E: serde::de::Error>(&self) -> Result<Kind, E> {
        let kind = self.kind.ok_or_else(|| E::missing_field("type"))?;
        let foreign = |name: &&&str| **name != "type" && self.has(name) && !kind.members().contains(name);
        match NAMES.iter().find(foreign) {
            Some(foreign) => Err(E::unknown_field(foreign, kind.members())),
            None => Ok(kind),
        }
    }

    fn column<E: serde::de::Error>(&mut self, name: &'static str) -> Result<Vec<f64>, E> {
        self.columns.remove(name).ok_or_else(|| E::missing_field(name))
    }

    fn number<E: serde::de::Error>(&self, name: &'static str) -> Result<f64, E> {
        self.numbers.get(name).copied().ok_or_else(|| E::missing_field(name))
    }
}

/// The name of a member.
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
        f.write_str("struct Members")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Members, A::Error> {
        let mut members = Members::default();
        while let Some(Name(name)) = map.next_key()? {
            if members.has(name) {
                return Err(A::Error::duplicate_field(name));
            }
            // `null` is not a value.
            match name {
                "type" => members.kind = Some(map.next_value()?),
                "parts" => members.parts = Some(map.next_value()?),
                "direction" => members.direction = Some(map.next_value()?),
                column if COLUMNS.contains(&column) => drop(members.columns.insert(column, map.next_value()?)),
                number => drop(members.numbers.insert(number, map.next_value()?)),
            }
        }
        Ok(members)
    }
}
