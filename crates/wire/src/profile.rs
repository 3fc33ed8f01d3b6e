//! The profile: which shape touches the flat.
//!
//! A new family is a variant of [`Profile`] with its document, a name in `Kind`, its members in `Members`, and an arm
//! in the two matches.

use serde::{Deserialize, Deserializer, Serialize, de::Error as _};
use utoipa::ToSchema;

use stickslip_mechanics::profile::{
    Cone, ExactSphere, FlatPunch, PowerLaw, Profile as Shape, RoundedCone, RoundedPunch, Sphere, Sum, Tabulated,
    TruncatedCone, TruncatedSphere,
};
use stickslip_mechanics::{Error, range, range::Range};

use super::check::{Faults, JsonPath};
use super::limits;
use super::single_key::not_null;

/// The shape of the indenter before it is loaded, chosen by `type`.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
#[serde(tag = "type", rename_all = "snake_case")]
#[schema(example = json!({"type": "sphere", "radius": 0.01}), no_recursion)]
pub enum Profile {
    /// Hertz's parabola z = r²/(2R), the shape that is meant by a sphere in contact mechanics.
    Sphere(SphereProfile),
    /// The sphere itself, z = R − √(R² − r²).
    ExactSphere(ExactSphereProfile),
    /// A cone, z = slope · r. Pressure and shear stress are infinite at its tip.
    Cone(ConeProfile),
    /// A power of the radius, z = coefficient · r^exponent.
    PowerLaw(PowerLawProfile),
    /// A cylinder with a sharp edge, where pressure and shear stress are infinite.
    FlatPunch(FlatPunchProfile),
    /// A cone with a flat end. Pressure and shear stress are infinite at the rim of the flat.
    TruncatedCone(TruncatedConeProfile),
    /// A worn sphere: a parabola with a flat end, at whose rim pressure and shear stress are infinite.
    TruncatedSphere(TruncatedSphereProfile),
    /// A flat end with a rounded edge, z = (r − flat_radius)²/(2 · edge_radius) outside the flat.
    RoundedPunch(RoundedPunchProfile),
    /// A cone whose tip is a parabola up to `tip_radius`.
    RoundedCone(RoundedConeProfile),
    /// A measured profile, through whose points a smooth curve is drawn that keeps their monotony and convexity.
    Tabulated(TabulatedProfile),
    /// Several profiles added up, z = Σ zᵢ.
    Sum(SumProfile),
}

/// A sphere in Hertz's approximation.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
pub struct SphereProfile {
    /// Radius of curvature R of the gap, m; for two spheres 1/R = 1/R₁ + 1/R₂.
    pub radius: f64,
}

/// A sphere without approximation.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
pub struct ExactSphereProfile {
    /// Radius R, m; the contact radius stays below it.
    pub radius: f64,
}

/// A cone.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
pub struct ConeProfile {
    /// Slope dz/dr, a pure number.
    pub slope: f64,
}

/// A power law.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
pub struct PowerLawProfile {
    /// Exponent n, a pure number.
    pub exponent: f64,
    /// Coefficient, m^(1−n).
    pub coefficient: f64,
}

/// A flat punch.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
pub struct FlatPunchProfile {
    /// Radius of the punch, m.
    pub radius: f64,
}

/// A truncated cone.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
pub struct TruncatedConeProfile {
    /// Slope dz/dr outside the flat, a pure number.
    pub slope: f64,
    /// Radius of the flat end, m.
    pub flat_radius: f64,
}

/// A truncated sphere.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
pub struct TruncatedSphereProfile {
    /// Radius of curvature R, m.
    pub radius: f64,
    /// Radius of the flat end, m.
    pub flat_radius: f64,
}

/// A flat punch with a rounded edge.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
pub struct RoundedPunchProfile {
    /// Radius of the flat end, m.
    pub flat_radius: f64,
    /// Radius of curvature of the edge, m.
    pub edge_radius: f64,
}

/// A cone with a rounded tip.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
pub struct RoundedConeProfile {
    /// Slope dz/dr of the cone, a pure number.
    pub slope: f64,
    /// Radius up to which the tip is a parabola, m.
    pub tip_radius: f64,
}

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

impl Profile {
    /// The checked profile; its faults are noted at `at`.
    pub fn check(&self, at: JsonPath<'_>, faults: &mut Faults) -> Option<Shape> {
        let mut number = |name: &str, value: f64, range: &Range| faults.number(at.member(name), value, range);
        let shape = match self {
            Profile::Sphere(SphereProfile { radius }) => {
                number("radius", *radius, &range::RADIUS);
                Sphere::new(*radius).map(Shape::Sphere)
            }
            Profile::ExactSphere(ExactSphereProfile { radius }) => {
                number("radius", *radius, &range::RADIUS);
                ExactSphere::new(*radius).map(Shape::ExactSphere)
            }
            Profile::Cone(ConeProfile { slope }) => {
                number("slope", *slope, &range::SLOPE);
                Cone::new(*slope).map(Shape::Cone)
            }
            Profile::PowerLaw(PowerLawProfile { exponent, coefficient }) => {
                number("exponent", *exponent, &range::EXPONENT);
                number("coefficient", *coefficient, &range::COEFFICIENT);
                PowerLaw::new(*exponent, *coefficient).map(Shape::PowerLaw)
            }
            Profile::FlatPunch(FlatPunchProfile { radius }) => {
                number("radius", *radius, &range::RADIUS);
                FlatPunch::new(*radius).map(Shape::FlatPunch)
            }
            Profile::TruncatedCone(TruncatedConeProfile { slope, flat_radius }) => {
                number("slope", *slope, &range::SLOPE);
                number("flat_radius", *flat_radius, &range::FLAT_RADIUS);
                TruncatedCone::new(*slope, *flat_radius).map(Shape::TruncatedCone)
            }
            Profile::TruncatedSphere(TruncatedSphereProfile { radius, flat_radius }) => {
                number("radius", *radius, &range::RADIUS);
                number("flat_radius", *flat_radius, &range::FLAT_RADIUS);
                TruncatedSphere::new(*radius, *flat_radius).map(Shape::TruncatedSphere)
            }
            Profile::RoundedPunch(RoundedPunchProfile { flat_radius, edge_radius }) => {
                number("flat_radius", *flat_radius, &range::FLAT_RADIUS);
                number("edge_radius", *edge_radius, &range::EDGE_RADIUS);
                RoundedPunch::new(*flat_radius, *edge_radius).map(Shape::RoundedPunch)
            }
            Profile::RoundedCone(RoundedConeProfile { slope, tip_radius }) => {
                number("slope", *slope, &range::SLOPE);
                number("tip_radius", *tip_radius, &range::TIP_RADIUS);
                RoundedCone::new(*slope, *tip_radius).map(Shape::RoundedCone)
            }
            Profile::Tabulated(TabulatedProfile { r, z }) => return check_table(r, z, Tabulated::new, at, faults),
            Profile::Sum(SumProfile { parts }) => return check_sum(parts, at, faults),
        };
        noted(shape, at, faults)
    }
}

/// How a table is made of radii and heights: on its own, or as part of a sum.
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
    noted(through(r, z).map(Shape::Tabulated), at, faults)
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
    noted(Sum::new(shapes?).map(Shape::Sum), at, faults)
}

/// The shape, or a note of what is wrong with numbers that are each in their range.
fn noted(shape: Result<Shape, Error>, at: JsonPath<'_>, faults: &mut Faults) -> Option<Shape> {
    match shape {
        Ok(shape) => return Some(shape),
        // It follows from a fault that is known already.
        Err(_) if !faults.is_empty() => {}
        Err(error @ (Error::NotConvexEnough { .. } | Error::BeyondProfile { .. })) => faults.unanswerable(at, error),
        Err(Error::Table { what, index }) => match what.split_once(' ') {
            // One radius is out of order; the heights, and the two lengths, are at fault as a whole.
            Some(("r", rest)) if !rest.starts_with("and") => faults.add(at.member("r").index(index), what),
            _ => faults.add(at.member("z"), what),
        },
        Err(error) => faults.add(at, error),
    }
    None
}

/// The names of the families.
#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Kind {
    Sphere,
    ExactSphere,
    Cone,
    PowerLaw,
    FlatPunch,
    TruncatedCone,
    TruncatedSphere,
    RoundedPunch,
    RoundedCone,
    Tabulated,
    Sum,
}

impl Kind {
    /// The members beside `type`, all of which are needed.
    fn members(self) -> &'static [&'static str] {
        match self {
            Kind::Sphere | Kind::ExactSphere | Kind::FlatPunch => &["radius"],
            Kind::Cone => &["slope"],
            Kind::PowerLaw => &["exponent", "coefficient"],
            Kind::TruncatedCone => &["slope", "flat_radius"],
            Kind::TruncatedSphere => &["radius", "flat_radius"],
            Kind::RoundedPunch => &["flat_radius", "edge_radius"],
            Kind::RoundedCone => &["slope", "tip_radius"],
            Kind::Tabulated => &["r", "z"],
            Kind::Sum => &["parts"],
        }
    }
}

/// The members of all families side by side. Reading them flat keeps the path of a fault, which serde's tagged enums lose
/// in their buffer, and lets `type` stand anywhere.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Members {
    #[serde(rename = "type")]
    kind: Kind,
    #[serde(default, deserialize_with = "not_null")]
    radius: Option<f64>,
    #[serde(default, deserialize_with = "not_null")]
    slope: Option<f64>,
    #[serde(default, deserialize_with = "not_null")]
    exponent: Option<f64>,
    #[serde(default, deserialize_with = "not_null")]
    coefficient: Option<f64>,
    #[serde(default, deserialize_with = "not_null")]
    flat_radius: Option<f64>,
    #[serde(default, deserialize_with = "not_null")]
    edge_radius: Option<f64>,
    #[serde(default, deserialize_with = "not_null")]
    tip_radius: Option<f64>,
    #[serde(default, deserialize_with = "not_null")]
    r: Option<Vec<f64>>,
    #[serde(default, deserialize_with = "not_null")]
    z: Option<Vec<f64>>,
    #[serde(default, deserialize_with = "not_null")]
    parts: Option<Vec<Profile>>,
}

impl Members {
    /// Refuses what belongs to another family.
    fn belong<E: serde::de::Error>(&self) -> Result<(), E> {
        let given = [
            ("radius", self.radius.is_some()),
            ("slope", self.slope.is_some()),
            ("exponent", self.exponent.is_some()),
            ("coefficient", self.coefficient.is_some()),
            ("flat_radius", self.flat_radius.is_some()),
            ("edge_radius", self.edge_radius.is_some()),
            ("tip_radius", self.tip_radius.is_some()),
            ("r", self.r.is_some()),
            ("z", self.z.is_some()),
            ("parts", self.parts.is_some()),
        ];
        let known = self.kind.members();
        match given.iter().find(|(name, is_there)| *is_there && !known.contains(name)) {
            Some((stranger, _)) => Err(E::unknown_field(stranger, known)),
            None => Ok(()),
        }
    }
}

impl<'de> Deserialize<'de> for Profile {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let members = Members::deserialize(deserializer)?;
        members.belong()?;
        let Members { kind, radius, slope, exponent, coefficient, flat_radius, edge_radius, tip_radius, r, z, parts } =
            members;
        let needed = |value: Option<f64>, name| value.ok_or_else(|| D::Error::missing_field(name));
        let radius = || needed(radius, "radius");
        let slope = || needed(slope, "slope");
        let flat_radius = || needed(flat_radius, "flat_radius");
        Ok(match kind {
            Kind::Sphere => Profile::Sphere(SphereProfile { radius: radius()? }),
            Kind::ExactSphere => Profile::ExactSphere(ExactSphereProfile { radius: radius()? }),
            Kind::Cone => Profile::Cone(ConeProfile { slope: slope()? }),
            Kind::PowerLaw => Profile::PowerLaw(PowerLawProfile {
                exponent: needed(exponent, "exponent")?,
                coefficient: needed(coefficient, "coefficient")?,
            }),
            Kind::FlatPunch => Profile::FlatPunch(FlatPunchProfile { radius: radius()? }),
            Kind::TruncatedCone => {
                Profile::TruncatedCone(TruncatedConeProfile { slope: slope()?, flat_radius: flat_radius()? })
            }
            Kind::TruncatedSphere => {
                Profile::TruncatedSphere(TruncatedSphereProfile { radius: radius()?, flat_radius: flat_radius()? })
            }
            Kind::RoundedPunch => Profile::RoundedPunch(RoundedPunchProfile {
                flat_radius: flat_radius()?,
                edge_radius: needed(edge_radius, "edge_radius")?,
            }),
            Kind::RoundedCone => Profile::RoundedCone(RoundedConeProfile {
                slope: slope()?,
                tip_radius: needed(tip_radius, "tip_radius")?,
            }),
            Kind::Tabulated => Profile::Tabulated(TabulatedProfile {
                r: r.ok_or_else(|| D::Error::missing_field("r"))?,
                z: z.ok_or_else(|| D::Error::missing_field("z"))?,
            }),
            Kind::Sum => Profile::Sum(SumProfile { parts: parts.ok_or_else(|| D::Error::missing_field("parts"))? }),
        })
    }
}
