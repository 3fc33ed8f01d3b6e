//! A scan becomes a profile.
//!
//! The heights z(x, y) of an instrument have noise, outliers, a tilt, an axis that is not where the scan begins, and
//! sometimes the wrong way up. The contact needs f(r) whose g rises, and g is made of slopes: 1 nm of noise between
//! neighbouring points of a ball makes it fall. So f is fitted: a curve of piecewise constant curvature (`curve`), by
//! penalised least squares (`normal_equations`, `smoothing`, `local_penalty`), about the axis that fits best (`start`,
//! `axis`, `fit`), without outliers (`noise`), among the curves whose g rises (`programme`). Standard errors follow
//! from the covariance (F + penalty)^-1 s^2 of the curvatures (Nychka 1988: it contains the bias of the penalty, where
//! that goes with the radius), s^2 being that of the noise times its inflation by correlation, by the delta method
//! (`contact`).
//!
//! Lengths are in m throughout.

mod axis;
mod contact;
mod correlated_noise;
mod curve;
mod diagnosis;
mod edges;
mod error;
mod fit;
mod local_penalty;
mod missing;
mod noise;
mod normal_equations;
mod programme;
mod result;
mod smoothing;
mod start;

pub use contact::ContactEstimate;
pub use diagnosis::{Diagnosis, Paraboloid};
pub use error::Error;
pub use smoothing::Smoothing;

use curve::Curve;
use fit::{Scaled, Sought};
use nalgebra::DMatrix;
use stickslip_mechanics::profile::Profile;

/// Points that a fit needs.
pub const FEWEST_POINTS: usize = 12;
/// Points of the columns of a fit that are drawn.
pub const DRAWN_POINTS: usize = 4_000;
/// Half the width of a scan, m.
const EXTENT: std::ops::Range<f64> = 1e-9..1e3;
/// Range of the heights over half the width.
const LEAST_RISE: f64 = 1e-12;
const MOST_RISE: f64 = 1e3;

/// Which way the heights count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Orientation {
    /// The body is highest on its axis.
    PeakUp,
    /// The body is lowest on its axis: heights are those of a gap.
    PeakDown,
}

/// Heights at places, m.
#[derive(Clone, Debug, PartialEq)]
pub struct Scan {
    points: Vec<[f64; 3]>,
    plane: bool,
    fill_values: usize,
}

impl Scan {
    /// A scan along a line through the axis, of places and heights; points whose numbers are not finite are left out,
    /// and those whose height is a fill value. An infinite height counts as one.
    #[must_use]
    pub fn line(points: impl IntoIterator<Item = [f64; 2]>) -> Scan {
        let mut scan = Scan::measured(points.into_iter().map(|[x, z]| [x, 0.0, z]));
        scan.points.sort_by(|a, b| a[0].total_cmp(&b[0]));
        scan
    }

    /// A scan of an area, of places x, y and heights, of which as many are left out as of a line.
    #[must_use]
    pub fn area(points: impl IntoIterator<Item = [f64; 3]>) -> Scan {
        let mut scan = Scan::measured(points);
        // Points on one line parallel to x determine one coordinate of the axis alone.
        scan.plane = scan.points.iter().any(|point| (point[1] - scan.points[0][1]).abs() > 0.0);
        scan
    }

    fn measured(points: impl IntoIterator<Item = [f64; 3]>) -> Scan {
        let mut fill_values = 0;
        let mut finite = |point: &[f64; 3]| {
            fill_values += usize::from(point[2].is_infinite());
            point.iter().all(|value| value.is_finite())
        };
        let mut points: Vec<[f64; 3]> = points.into_iter().filter(|point| finite(point)).collect();
        let (fills, all) = (missing::fill_values(&points), points.len());
        points.retain(|point| fills.iter().all(|fill| fill.to_bits() != point[2].to_bits()));
        fill_values += all - points.len();
        Scan { points, plane: false, fill_values }
    }
}

/// How a scan is fitted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Which way up it is; `None` derives it from its curvature.
    pub orientation: Option<Orientation>,
    /// The axis, m; `None` looks for it.
    pub centre: Option<[f64; 2]>,
    /// Whether a tilt is taken off where the scan shows one.
    pub level: bool,
    /// How smooth the profile is.
    pub smoothing: Smoothing,
}

impl Default for Options {
    fn default() -> Options {
        Options { orientation: None, centre: None, level: true, smoothing: Smoothing::Auto }
    }
}

/// A value with its standard error, in one unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The value.
    pub value: f64,
    /// Its standard error.
    pub standard_error: f64,
}

/// Points for a drawing: radius and height of the gap, m.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Column {
    /// Radii, m, increasing.
    pub radius: Vec<f64>,
    /// Heights, m.
    pub height: Vec<f64>,
}

/// Standard errors at the radii of a table.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StandardErrors {
    /// Of the indentation at which a contact has this radius, m.
    pub indentation: Vec<f64>,
    /// The largest of the pressure in a contact of this radius, over E*.
    pub pressure: Vec<f64>,
}

/// A profile from a scan.
#[derive(Clone, Debug)]
pub struct ScanFit {
    /// Radii and heights of the table, m: `Tabulated::new` accepts them.
    pub table: Column,
    /// The standard errors at its radii: `Tabulated::with_standard_errors` accepts them.
    pub standard_errors: StandardErrors,
    /// The radius of curvature on the axis, m; `None` where the surface is flat there, or hollow.
    pub radius_of_curvature: Option<Estimate>,
    /// The axis, m.
    pub centre: [f64; 2],
    /// The slopes along x and y of the plane that was taken off.
    pub tilt: [f64; 2],
    /// Which way up the scan is.
    pub orientation: Orientation,
    /// Root mean square of the residual, m.
    pub rms: f64,
    /// How far the residual is correlated along the scan, m: to 1/e.
    pub correlation_length: f64,
    /// How many points have a height.
    pub used: usize,
    /// How many further ones have a fill value of the instrument in its place.
    pub fill_values: usize,
    /// How far the scan reaches to both sides of the axis, over half its extent.
    pub overlap: f64,
    /// How many of them were left out.
    pub outliers: usize,
    /// The points that were fitted, thinned to [`DRAWN_POINTS`].
    pub raw: Column,
    /// The points that were left out, thinned alike.
    pub left_out: Column,
    /// The least g'(x)/x, over its mean: 1 for a ball, 0 where g is about to fall or, at a flat end, constant.
    pub g_margin: f64,
    /// Whether g would have fallen in the fit, had it not been kept from it.
    pub constrained: bool,
    /// Another axis that the scan does not exclude, m, about which the profile is another one: the errors hold both.
    pub other_axis: Option<[f64; 2]>,
    /// The step of heights that a converter has rounded, m, if it is not small beside the residual.
    pub height_step: Option<f64>,
    /// What the residual says of the noise and of the body.
    pub diagnosis: Diagnosis,
    profile: Profile,
    curve: Curve,
    /// Covariance of the curvatures, 1/m^2.
    covariance: DMatrix<f64>,
}

impl ScanFit {
    /// Fits a scan. `keep_going` is asked now and then, and ends the work with `false`.
    ///
    /// # Errors
    /// [`Error`], which says what the scan lacks.
    pub fn new(scan: &Scan, options: &Options, keep_going: &dyn Fn() -> bool) -> Result<ScanFit, Error> {
        let (scaled, units) = scaled(scan, options.orientation)?;
        let axis = options.centre.map(|centre| units.place(centre, scan.plane));
        if let Some([x, y]) = axis {
            let distances = scaled.points.iter().map(|point| (point[0] - x).hypot(point[1] - y));
            let (nearest, farthest) =
                distances.fold((f64::INFINITY, 0.0), |(a, b), r| (f64::min(a, r), f64::max(b, r)));
            if nearest > 0.5 * farthest {
                let [nearest, farthest] = [nearest, farthest].map(|distance| distance * units.length);
                return Err(Error::AxisOutside { nearest, farthest });
            }
        }
        let sought = Sought { axis, tilt: options.level, smoothing: options.smoothing };
        let (fitted, other) = axis::fit(&scaled, &sought, keep_going)?;
        // A number of intervals that was asked for is kept, or refused.
        let smooths = !matches!(options.smoothing, Smoothing::Knots(_));
        result::finished(scan, (&fitted, other.as_ref()), (&scaled, &units), smooths)
    }

    /// The profile.
    #[must_use]
    pub fn profile(&self) -> &Profile {
        &self.profile
    }
}

/// What the numbers of a scaled scan are in.
struct Units {
    middle: [f64; 2],
    length: f64,
    height: f64,
    orientation: Orientation,
}

impl Units {
    fn place(&self, centre: [f64; 2], plane: bool) -> [f64; 2] {
        let [x, y] = [0, 1].map(|axis| (centre[axis] - self.middle[axis]) / self.length);
        [x, if plane { y } else { 0.0 }]
    }
}

/// The scan in units of its own, with the gap opening upward.
fn scaled(scan: &Scan, orientation: Option<Orientation>) -> Result<(Scaled, Units), Error> {
    let points = &scan.points;
    if points.len() < FEWEST_POINTS {
        return Err(Error::TooFewPoints { used: points.len() });
    }
    let bounds = [0, 1, 2].map(|axis| {
        let values = points.iter().map(|point| point[axis]);
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)))
    });
    let middle = bounds.map(|(low, high)| 0.5 * (low + high));
    let length = 0.5 * (bounds[0].1 - bounds[0].0).max(bounds[1].1 - bounds[1].0);
    if length <= 0.0 {
        return Err(Error::NoExtent { what: "place" });
    }
    if !EXTENT.contains(&length) {
        return Err(Error::Extent { width: 2.0 * length });
    }
    let place = |point: &[f64; 3]| [(point[0] - middle[0]) / length, (point[1] - middle[1]) / length];
    let mut placed: Vec<[f64; 3]> = points.iter().map(|point| [place(point)[0], place(point)[1], point[2]]).collect();
    // The range of the medians: an instrument's mark of a missing height must not be the unit of all others.
    let of_surface = start::of_surface(&placed);
    let surface: Vec<[f64; 3]> =
        placed.iter().zip(&of_surface).filter(|(_, of_surface)| **of_surface).map(|(point, _)| *point).collect();
    let thinned = start::medians(&surface, scan.plane);
    let (low, high) = thinned
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), point| (low.min(point[2]), high.max(point[2])));
    let height = high - low;
    if height <= LEAST_RISE * length {
        return Err(Error::NoExtent { what: "height" });
    }
    if height > MOST_RISE * length {
        return Err(Error::Steep { width: 2.0 * length, height });
    }
    let opens = |up: f64| if up > 0.0 { Orientation::PeakDown } else { Orientation::PeakUp };
    let orientation = orientation.unwrap_or_else(|| opens(start::curvature(&thinned, scan.plane)));
    let sign = if orientation == Orientation::PeakDown { 1.0 } else { -1.0 };
    placed.iter_mut().for_each(|point| point[2] = sign * (point[2] - low) / height);
    let units = Units { middle: [middle[0], middle[1]], length, height, orientation };
    Ok((Scaled { points: placed, plane: scan.plane, of_surface, height }, units))
}
