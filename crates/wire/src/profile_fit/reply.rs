//! The reply of `POST /profiles/fit`.

use super::{Axisymmetry, ScanOrientation};
use crate::prelude::*;

replies! {
/// A profile that was fitted to a scan, with the residual of the scan.
pub struct ProfileFitReply omits Option {
    /// The profile, for `/simulate` and `/contacts`.
    pub profile: Profile,
    /// The radius of curvature on the axis, m; `null` where the surface is flat there to within its error.
    pub radius_of_curvature: Estimate,
    /// The axis, m.
    pub centre: Axis2,
    /// The slopes of the plane that was subtracted, pure numbers.
    pub tilt: Axis2,
    /// Which way up the scan is: `peak_up` or `peak_down`.
    pub orientation: ScanOrientation,
    /// Measured heights less the profile.
    pub residual: ScanResidual,
    /// The points that were fitted, as heights of the gap above the axis; at most 4000 of them, evenly thinned.
    pub raw: ColumnPair,
    /// The points that were left out as outliers, thinned in the same way.
    pub left_out: ColumnPair,
    /// The fitted profile, as the table of `profile`.
    pub used: ColumnPair,
    /// The least g′(x)/x over its mean, a pure number: 1 for a ball, 0 where g is about to fall or, at a flat end,
    /// constant.
    pub g_margin: f64,
    /// Whether the scan was tested for a body that is not of revolution: `tested` of a map; `assumed` of a line, which
    /// knows one section alone.
    pub axisymmetry: Axisymmetry,
    /// A body that is not of revolution, where the residual shows one: its profile is for `/simulate` and `/contacts`.
    pub suggested: Option<SuggestedProfile>,
    /// The contact under `load`.
    pub contact: Option<ContactEstimate>,
    /// Warnings about the scan.
    pub warnings: Vec<Warning>,
}

/// A value and its standard error, both in the unit of the quantity; `null` where it is not known.
pub struct Estimate: Copy {
    /// The value, in the unit of the quantity.
    pub value: Option<f64>,
    /// Its standard error, in the unit of the quantity.
    pub standard_error: Option<f64>,
}

/// Two components in the plane of the scan; a line has no y.
pub struct Axis2: Copy omits Option {
    /// Along x, in the unit of the quantity.
    pub x: f64,
    /// Along y, in the unit of the quantity.
    pub y: Option<f64>,
}

/// Measured heights less the profile, in a few numbers.
pub struct ScanResidual: Copy {
    /// Root mean square of the points that were fitted, m: noise and roughness.
    pub rms: f64,
    /// Distance along the scan at which the correlation of the residual falls to 1/e, m.
    pub correlation_length: f64,
    /// Number of points that were left out, including fill values of the instrument.
    pub outliers: usize,
    /// Whether neighbouring residuals are independent, as of white noise; `null` if no two points are neighbours.
    pub random: Option<bool>,
}

/// A body that is not of revolution, by its principal curvatures.
pub struct SuggestedProfile {
    /// An `ellipsoid`, or a `cylinder` whose length is the extent of the map along its axis.
    pub profile: Profile,
    /// The direction of the larger radius, or of the axis of the cylinder, degrees from the x axis of the scan.
    pub angle: f64,
    /// The principal radii of curvature, m, the smaller first; the larger is `null` for a cylinder.
    pub radii: [Estimate; 2],
}

/// Heights over radii.
pub struct ColumnPair {
    /// Radii, m, increasing.
    pub radius: Vec<f64>,
    /// Heights above the axis, m.
    pub height: Vec<f64>,
}

/// The contact as the scan alone determines it.
pub struct ContactEstimate: Copy {
    /// Indentation, m.
    pub indentation: Estimate,
    /// Contact radius, m.
    pub contact_radius: Estimate,
    /// Normal force, N.
    pub normal_force: Estimate,
    /// Largest pressure, Pa.
    pub max_pressure: Estimate,
}
}
