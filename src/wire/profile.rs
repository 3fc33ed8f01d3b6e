//! The profile: which shape touches the flat.
//!
//! A new family is a variant of [`Profile`] with its document, a name in `Kind`, its members in `Members`, and an arm
//! in the two matches.

use serde::{Deserialize, Deserializer, Serialize, de::Error as _};
use utoipa::ToSchema;

use crate::mechanics::{self, range};

use super::check::{At, Faults};
use super::one_key::given;

/// The shape of the indenter before it is loaded, chosen by `type`.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
#[serde(tag = "type", rename_all = "snake_case")]
#[schema(example = json!({"type": "sphere", "radius": 0.01}))]
pub enum Profile {
    /// Hertz's parabola z = r²/(2R), the shape that is meant by a sphere in contact mechanics.
    Sphere(SphereProfile),
}

/// A sphere in Hertz's approximation.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
pub struct SphereProfile {
    /// Radius of curvature R of the gap, m; for two spheres 1/R = 1/R₁ + 1/R₂.
    pub radius: f64,
}

impl Profile {
    /// The checked profile; its faults are noted at `at`.
    pub fn check(&self, at: At<'_>, faults: &mut Faults) -> Option<mechanics::profile::Profile> {
        match self {
            Profile::Sphere(sphere) => {
                faults.number(at.member("radius"), sphere.radius, &range::RADIUS);
                mechanics::profile::Sphere::new(sphere.radius).ok().map(mechanics::profile::Profile::Sphere)
            }
        }
    }

    /// The radius of curvature against which a contact radius is small or large, m, where the shape has one.
    #[must_use]
    pub fn curvature_radius(&self) -> Option<f64> {
        match self {
            Profile::Sphere(sphere) => Some(sphere.radius),
        }
    }
}

/// The names of the families.
#[derive(Deserialize)]
#[serde(rename_all = "snake_case")]
enum Kind {
    Sphere,
}

/// The members of all families side by side. Reading them flat keeps the path of a fault, which serde's tagged enums lose
/// in their buffer, and lets `type` stand anywhere.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Members {
    #[serde(rename = "type")]
    kind: Kind,
    #[serde(default, deserialize_with = "given")]
    radius: Option<f64>,
}

impl<'de> Deserialize<'de> for Profile {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let members = Members::deserialize(deserializer)?;
        match members.kind {
            Kind::Sphere => {
                let radius = members.radius.ok_or_else(|| D::Error::missing_field("radius"))?;
                Ok(Profile::Sphere(SphereProfile { radius }))
            }
        }
    }
}
