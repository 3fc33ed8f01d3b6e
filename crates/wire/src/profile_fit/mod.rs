//! The body of `POST /profiles/fit` and its reply: a scan of heights becomes a profile.

mod data;
mod reply;

pub use data::{LineScan, MapScan, PointScan, ScanData};
pub use reply::{Axis2, ColumnPair, ContactEstimate, Estimate, ProfileFitReply, ScanResidual, SuggestedProfile};

use stickslip_mechanics::{Elasticity, Preload as Load};

use crate::prelude::*;

/// The noise of a height that a scan may be said to have.
pub const SCAN_NOISE: Range = Range { quantity: Quantity::Place, unit: "m", min: 1e-15, max: 1.0 };
/// A coordinate of the axis.
pub const SCAN_AXIS: Range = Range { quantity: Quantity::Place, unit: "m", min: -1e3, max: 1e3 };

requests! {
/// A scan of heights, and how to fit a profile to it. Nothing is stored.
pub struct ProfileFitRequest {
    /// The heights, with their places.
    pub scan: ScanData,
    /// The units of the scan; if left out, metres. Everything else is in SI units.
    pub units: Option<ScanUnits>,
    /// Which way up the scan is; `auto` derives it from the curvature of the surface.
    #[schema(default = "auto")]
    pub orientation: Option<ScanOrientation>,
    /// Where the axis of the body is, m; `auto` searches for it.
    pub centre: Option<Centre>,
    /// Whether to subtract a tilt, if the scan distinguishes it from an off-centre axis.
    #[schema(default = true)]
    pub level: Option<bool>,
    /// How the smoothness of the profile is chosen; `auto` is generalised cross-validation.
    pub smoothing: Option<Smoothing>,
    /// A load, for which the reply then describes the contact.
    pub load: Option<ScanLoad>,
}

/// The units of a scan.
pub struct ScanUnits: Copy, Default {
    /// Unit of x and y, and of dx and dy.
    pub lateral: Option<LengthUnit>,
    /// Unit of z.
    pub height: Option<LengthUnit>,
}

/// The place of an axis.
pub struct CentrePlace: Copy {
    /// Along the line, or along the rows of a map, m.
    pub x: f64 = SCAN_AXIS,
    /// Along the columns of a map, m; if left out, 0, as for a line.
    pub y: Option<f64> = SCAN_AXIS,
}

/// A load on the body that was scanned.
pub struct ScanLoad {
    /// The elastic constants.
    pub material: Material,
    /// Coulomb's coefficient of friction μ, a pure number.
    pub friction: f64 = range::FRICTION,
    /// The normal load.
    pub preload: Preload,
}
}

words! {
/// A unit of length.
pub enum LengthUnit: Default {
    /// Metre.
    #[default]
    Metre = "m",
    /// Millimetre.
    Millimetre = "mm",
    /// Micrometre.
    Micrometre = "um",
    /// Nanometre.
    Nanometre = "nm",
}
}

impl LengthUnit {
    /// It in metres.
    pub fn metres(self) -> f64 {
        match self {
            LengthUnit::Metre => 1.0,
            LengthUnit::Millimetre => 1e-3,
            LengthUnit::Micrometre => 1e-6,
            LengthUnit::Nanometre => 1e-9,
        }
    }
}

words! {
/// Which way up a scan is.
pub enum ScanOrientation: Default {
    /// By the curvature of the surface.
    #[default]
    Auto = "auto",
    /// The body is highest on its axis.
    PeakUp = "peak_up",
    /// The body is lowest on its axis.
    PeakDown = "peak_down",
}
}

words! {
/// What a scan says of the symmetry of its body.
pub enum Axisymmetry {
    /// A map was tested for a second harmonic about its axis.
    Tested = "tested",
    /// A line knows one section alone.
    Assumed = "assumed",
}
}

/// Where the axis is: the string `"auto"`, or a place.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, ToSchema)]
#[serde(untagged)]
pub enum Centre {
    /// The service searches for it.
    Auto(Auto),
    /// A place.
    At(CentrePlace),
}

/// The string that leaves a choice to the service.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Auto {
    /// The service chooses.
    Auto,
}

choices! {
/// How the smoothness of a profile is chosen, one key or `"auto"`.
pub enum Smoothing: Copy {
    words {
        /// Generalised cross-validation.
        Auto = "auto",
    }
    /// The standard deviation of the noise of a height, m.
    "noise" => Noise(f64) = SCAN_NOISE,
    /// This many intervals of constant curvature, without a penalty on their differences.
    "knots" => Knots(usize) = 4..=100_usize,
}
}

object_or_string!(
    Centre: "an object with `x`, or the string \"auto\"",
    CentrePlace => At,
    "auto" => Centre::Auto(Auto::Auto)
);

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

    fn checked(self, _: &dyn Prepare, faults: &mut Faults) -> Option<Self::Checked> {
        let root = JsonPath::Root;
        let units = self.units.unwrap_or_default();
        let units = [units.lateral, units.height].map(|unit| unit.unwrap_or_default().metres());
        let line = matches!(self.scan, ScanData::Line(_));
        let pointer = self.scan.pointer();
        let points = self.scan.check(units, root.member("scan"), faults);
        let centre = match self.centre {
            Some(Centre::At(place)) => Some([place.x, place.y.unwrap_or(0.0)]),
            Some(Centre::Auto(Auto::Auto)) | None => None,
        };
        let load = self.load.as_ref().and_then(|load| {
            load.preload.check_pressing(root.member("load").member("preload"), faults);
            let elasticity = load.material.check(root.member("load").member("material"), faults)?;
            Some((elasticity, load.friction, (&load.preload).into()))
        });
        points.map(|points| ProfileFitTask {
            points,
            line,
            pointer,
            orientation: self.orientation.unwrap_or_default(),
            centre,
            level: self.level.unwrap_or(true),
            smoothing: self.smoothing.unwrap_or(Smoothing::Auto),
            load,
        })
    }
}
