//! The body of `POST /profiles/fit` and its reply: a scan of heights becomes a profile.

mod data;
mod reply;

pub use data::{LineScan, MapScan, PointScan, ScanData};
pub use reply::{Axis2, ColumnPair, ContactEstimate, Estimate, ProfileFitReply, ScanResidual};

use serde::de::value::MapAccessDeserializer;
use serde::de::{MapAccess, Unexpected, Visitor};
use serde::{Deserialize, Deserializer, Serialize};
use serde_with::{apply, skip_serializing_none};
use utoipa::ToSchema;

use stickslip_mechanics::range::{Quantity, Range};
use stickslip_mechanics::{Elasticity, Preload as Load, range};

use crate::check::{Faults, JsonPath, Rejection};
use crate::definition::{Material, Preload};
use crate::document::Document;
use crate::limits::{SCAN_KNOTS, limits};
use crate::prepare::Prepare;
use crate::single_key::{not_null, single_key};

/// The noise of a height that a scan may be said to have.
pub const SCAN_NOISE: Range = Range { quantity: Quantity::Place, unit: "m", min: 1e-15, max: 1.0 };
/// A coordinate of the axis.
pub const SCAN_AXIS: Range = Range { quantity: Quantity::Place, unit: "m", min: -1e3, max: 1e3 };

/// A scan of heights, and how a profile is to be fitted to it; the server keeps nothing of it.
#[skip_serializing_none]
#[apply(Option => #[serde(default, deserialize_with = "not_null")] #[schema(nullable = false)])]
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct ProfileFitRequest {
    /// The heights, with their places.
    pub scan: ScanData,
    /// The units of the scan: metres if it is left out. Everything else is in SI units.
    pub units: Option<ScanUnits>,
    /// Which way up the scan is; `auto` goes by the curvature of the surface.
    #[schema(default = "auto")]
    pub orientation: Option<ScanOrientation>,
    /// Where the axis of the body is, m; `auto` looks for it.
    pub centre: Option<Centre>,
    /// Whether a tilt is taken off where the scan distinguishes it from an axis that is off the middle.
    #[schema(default = true)]
    pub level: Option<bool>,
    /// What decides how smooth the profile is; `auto` is generalised cross-validation.
    pub smoothing: Option<Smoothing>,
    /// A load, for which the reply then has the contact.
    pub load: Option<ScanLoad>,
}

/// The units of a scan.
#[skip_serializing_none]
#[apply(Option => #[serde(default, deserialize_with = "not_null")] #[schema(nullable = false)])]
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct ScanUnits {
    /// That of x and y, and of dx and dy.
    pub lateral: Option<LengthUnit>,
    /// That of z.
    pub height: Option<LengthUnit>,
}

/// A unit of length.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
pub enum LengthUnit {
    /// Metre.
    #[default]
    #[serde(rename = "m")]
    Metre,
    /// Millimetre.
    #[serde(rename = "mm")]
    Millimetre,
    /// Micrometre.
    #[serde(rename = "um")]
    Micrometre,
    /// Nanometre.
    #[serde(rename = "nm")]
    Nanometre,
}

impl LengthUnit {
    /// All of them.
    pub const ALL: [LengthUnit; 4] =
        [LengthUnit::Metre, LengthUnit::Millimetre, LengthUnit::Micrometre, LengthUnit::Nanometre];

    /// It in metres.
    #[must_use]
    pub fn metres(self) -> f64 {
        match self {
            LengthUnit::Metre => 1.0,
            LengthUnit::Millimetre => 1e-3,
            LengthUnit::Micrometre => 1e-6,
            LengthUnit::Nanometre => 1e-9,
        }
    }

    /// Its symbol.
    #[must_use]
    pub fn symbol(self) -> &'static str {
        match self {
            LengthUnit::Metre => "m",
            LengthUnit::Millimetre => "mm",
            LengthUnit::Micrometre => "um",
            LengthUnit::Nanometre => "nm",
        }
    }
}

/// Which way up a scan is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum ScanOrientation {
    /// By the curvature of the surface.
    #[default]
    Auto,
    /// The body is highest on its axis.
    PeakUp,
    /// The body is lowest on its axis.
    PeakDown,
}

/// Where the axis is: the string `"auto"`, or a place.
// Untagged when written. It is read by hand below, so that a fault in the object names its member.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, ToSchema)]
#[serde(untagged)]
pub enum Centre {
    /// It is looked for.
    Auto(Auto),
    /// A place.
    At(CentrePlace),
}

/// The word for what the service chooses.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Auto {
    /// The service chooses.
    Auto,
}

/// The place of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct CentrePlace {
    /// Along the line, or along the rows of a map, m.
    pub x: f64,
    /// Along the columns of a map, m; 0 if it is left out, as for a line.
    #[serde(default, skip_serializing_if = "Option::is_none", deserialize_with = "not_null")]
    #[schema(nullable = false)]
    pub y: Option<f64>,
}
limits!(CentrePlace { x: SCAN_AXIS, y: SCAN_AXIS });

/// What decides how smooth a profile is, one key or `"auto"`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Smoothing {
    /// Generalised cross-validation.
    Auto,
    /// The standard deviation of the noise of a height, m.
    Noise(f64),
    /// So many intervals of constant curvature, without a penalty on their differences.
    Knots(usize),
}
single_key!(Smoothing { "noise" => Noise, "knots" => Knots } or { "auto" => Auto });
limits!(enum Smoothing { Noise "noise": SCAN_NOISE, Knots "knots": SCAN_KNOTS });

/// A load on the body that was scanned.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct ScanLoad {
    /// The elastic constants.
    pub material: Material,
    /// Coulomb's coefficient of friction μ, a pure number.
    pub friction: f64,
    /// The normal load.
    pub preload: Preload,
}
limits!(ScanLoad { friction: range::FRICTION });

impl<'de> Deserialize<'de> for Centre {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(CentreVisitor)
    }
}

struct CentreVisitor;

impl<'de> Visitor<'de> for CentreVisitor {
    type Value = Centre;

    fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("an object with `x`, or the string \"auto\"")
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Centre, A::Error> {
        CentrePlace::deserialize(MapAccessDeserializer::new(map)).map(Centre::At)
    }

    fn visit_str<E: serde::de::Error>(self, word: &str) -> Result<Centre, E> {
        if word == "auto" { Ok(Centre::Auto(Auto::Auto)) } else { Err(E::invalid_value(Unexpected::Str(word), &self)) }
    }
}

/// A checked request, in SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct ProfileFitTask {
    /// Places and heights, m; a missing height is NaN.
    pub points: Vec<[f64; 3]>,
    /// Whether the points are along one line through the axis.
    pub line: bool,
    /// JSON pointer to the scan.
    pub pointer: &'static str,
    /// Which way up.
    pub orientation: ScanOrientation,
    /// The axis, if it is known, m.
    pub centre: Option<[f64; 2]>,
    /// Whether a tilt may be taken off.
    pub level: bool,
    /// How smooth.
    pub smoothing: Smoothing,
    /// The load, if there is one.
    pub load: Option<(Elasticity, f64, Load)>,
}

impl Document for ProfileFitRequest {
    type Checked = ProfileFitTask;

    fn check_with(self, _: &dyn Prepare) -> Result<ProfileFitTask, Rejection> {
        let (mut faults, root) = (Faults::default(), JsonPath::Root);
        let units = self.units.unwrap_or_default();
        let units = [units.lateral, units.height].map(|unit| unit.unwrap_or_default().metres());
        let line = matches!(self.scan, ScanData::Line(_));
        let pointer = self.scan.pointer();
        let points = self.scan.check(units, root.member("scan"), &mut faults);
        let centre = match self.centre {
            Some(Centre::At(place)) => {
                place.check_members(root.member("centre"), &mut faults);
                Some([place.x, place.y.unwrap_or(0.0)])
            }
            Some(Centre::Auto(Auto::Auto)) | None => None,
        };
        if let Some(smoothing) = &self.smoothing {
            smoothing.check_members(root.member("smoothing"), &mut faults);
        }
        let load = self.load.as_ref().map(|load| {
            let at = root.member("load");
            let elasticity = load.material.check(at.member("material"), &mut faults);
            load.check_members(at, &mut faults);
            let preload = load.preload.check(at.member("preload"), &mut faults);
            elasticity.map(|elasticity| (elasticity, load.friction, preload))
        });
        let task = points.map(|points| ProfileFitTask {
            points,
            line,
            pointer,
            orientation: self.orientation.unwrap_or_default(),
            centre,
            level: self.level.unwrap_or(true),
            smoothing: self.smoothing.unwrap_or(Smoothing::Auto),
            load: load.flatten(),
        });
        faults.done(task)
    }
}
