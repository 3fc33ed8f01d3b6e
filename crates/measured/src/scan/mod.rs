//! A scan becomes a profile.
//!
//! The heights z(x, y) of an instrument have noise, outliers, a tilt, an axis that is not where the scan begins, and sometimes the
//! wrong way up. The contact needs f(r) whose g rises, and g is made of slopes: 1 nm of noise between neighbouring points of a
//! ball makes it fall. So f is fitted: a curve of piecewise constant curvature (`curve`), by penalised least squares
//! (`normal_equations`, `smoothing`), about the axis that fits best (`start`, `fit`), without outliers (`noise`), among the curves whose g
//! rises (`programme`). Standard errors follow from the covariance (F + penalty)^-1 s^2 of the curvatures (Nychka 1988: it contains the
//! bias of the penalty on average), s^2 being that of the noise times its inflation by correlation, by the delta method (`contact`).
//!
//! Lengths are in m throughout.

mod contact;
mod curve;
mod fit;
mod noise;
mod normal_equations;
mod programme;
mod smoothing;
mod start;

pub use contact::ContactEstimate;
pub use smoothing::Smoothing;

use curve::Curve;
use fit::{Fitted, Scaled, Sought};
use stickslip_mechanics::profile::{Profile, Tabulated};

use crate::linear::{Symmetric, dot};

/// Points that a fit needs.
pub const FEWEST_POINTS: usize = 12;
/// Points of the columns of a fit that are drawn.
pub const DRAWN_POINTS: usize = 4_000;
/// Parabolas added to a curve whose table does not rise, as shares of its mean curvature.
const LIFTS: [f64; 8] = [0.0, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1];
/// Half the width of a scan, m.
const EXTENT: std::ops::Range<f64> = 1e-9..1e3;
/// Range of the heights over half the width.
const LEAST_RISE: f64 = 1e-12;
const MOST_RISE: f64 = 1e3;
/// Intervals between neighbouring points of the table.
const TABLE_STEP: f64 = 0.5;

/// Why a scan yields no profile.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// Too few points with a height are left.
    #[error("{used} points with a height can be used: at least {FEWEST_POINTS} are needed")]
    TooFewPoints {
        /// How many there are.
        used: usize,
    },
    /// All points are at one place, or all have one height.
    #[error("all points have the same {what}: nothing can be fitted")]
    NoExtent {
        /// Place or height.
        what: &'static str,
    },
    /// The scan is too large or too small for an instrument.
    #[error("the scan is {} wide: from 2 nm to 2 km can be fitted; check `units`", micrometres(*width))]
    Extent {
        /// Its width, m.
        width: f64,
    },
    /// The heights are out of proportion.
    #[error("the scan is {} wide and {} high: check `units`", micrometres(*width), micrometres(*height))]
    Steep {
        /// Its width, m.
        width: f64,
        /// The range of its heights, m.
        height: f64,
    },
    /// No axis about which the surface falls away to all sides.
    #[error(
        "about no axis does the surface fall away from a peak: is it a hollow, or the other way up than `orientation` says?"
    )]
    Hollow,
    /// The axis given is not in the scan.
    #[error("the scan has no points near this axis: the nearest is {} away, the farthest {}", micrometres(*nearest), micrometres(*farthest))]
    AxisOutside {
        /// Distance of the nearest point, m.
        nearest: f64,
        /// Distance of the farthest, m.
        farthest: f64,
    },
    /// The equations have no solution: points lie at too few radii.
    #[error("the points lie at too few distances from the axis to determine a profile")]
    Scattered,
    /// The contact under the load would be larger than the scan.
    #[error("the scan does not reach the edge of the contact: {} of about {}", micrometres(*reach), micrometres(*needed))]
    TooShort {
        /// Radius that the scan reaches, m.
        reach: f64,
        /// Radius of the contact if the shape goes on as it ends, m.
        needed: f64,
    },
    /// The mechanics refuses the load.
    #[error(transparent)]
    Refused(#[from] stickslip_mechanics::Error),
    /// The work was ended.
    #[error("stopped")]
    Interrupted,
}

/// A length of the bench: in micrometres, with three digits.
fn micrometres(length: f64) -> String {
    let value = length * 1e6;
    let digits = (2.0 - value.abs().log10().floor()).clamp(0.0, 6.0) as usize;
    if value.abs() >= 1e6 || value.abs() < 1e-3 { format!("{length:.2e} m") } else { format!("{value:.digits$} um") }
}

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
}

impl Scan {
    /// A scan along a line through the axis, of places and heights; points whose numbers are not finite are left out.
    #[must_use]
    pub fn line(points: impl IntoIterator<Item = [f64; 2]>) -> Scan {
        let mut points: Vec<[f64; 3]> = finite(points.into_iter().map(|[x, z]| [x, 0.0, z]));
        points.sort_by(|a, b| a[0].total_cmp(&b[0]));
        Scan { points, plane: false }
    }

    /// A scan of an area, of places x, y and heights; points whose numbers are not finite are left out.
    #[must_use]
    pub fn area(points: impl IntoIterator<Item = [f64; 3]>) -> Scan {
        let points = finite(points);
        // Points on one line parallel to x determine one coordinate of the axis alone.
        let plane = points.iter().any(|point| (point[1] - points[0][1]).abs() > 0.0);
        Scan { points, plane }
    }
}

fn finite(points: impl IntoIterator<Item = [f64; 3]>) -> Vec<[f64; 3]> {
    points.into_iter().filter(|point| point.iter().all(|value| value.is_finite())).collect()
}

/// How a scan is fitted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Which way up it is; `None` goes by its curvature.
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

/// A profile from a scan.
#[derive(Clone, Debug)]
pub struct ScanFit {
    /// Radii and heights of the table, m: `Tabulated::new` accepts them.
    pub table: Column,
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
    profile: Profile,
    curve: Curve,
    /// Covariance of the curvatures, 1/m^2.
    covariance: Symmetric,
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
        let fitted = fit::fit(&scaled, &sought, keep_going)?;
        finished(scan, &fitted, &scaled, &units)
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
    let thinned = start::medians(&placed, scan.plane);
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
    Ok((Scaled { points: placed, plane: scan.plane, height }, units))
}

/// The fit in m, with its table.
fn finished(scan: &Scan, fitted: &Fitted, scaled: &Scaled, units: &Units) -> Result<ScanFit, Error> {
    let Fitted { equations, solution, parabola, .. } = fitted;
    let unknowns = programme::constrained(equations, solution, *parabola);
    let unknowns = unknowns.unwrap_or_else(|| solution.unknowns.clone());
    let constrained = unknowns != solution.unknowns;
    let bend = units.height / (units.length * units.length);
    let curve = equations.curve(&unknowns, *parabola);
    let curvatures: Vec<f64> = curve.curvatures.iter().map(|curvature| curvature * bend).collect();
    let width = curve.width * units.length;
    let reach = width * curvatures.len() as f64;
    let mean = 2.0 * (curve.height(curve.end()) - curve.offset) / curve.end().powi(2) * bend;
    if mean * reach * reach <= 0.0 {
        return Err(Error::Hollow);
    }
    let (table, profile, curve) = table(width, &curvatures, mean)?;
    let intervals = curvatures.len();
    let variance = fitted.variance * fitted.inflation * bend * bend;
    let systematic = equations.systematic(solution);
    let mut covariance = Symmetric::zero(intervals);
    for row in 0..intervals {
        for column in 0..=row {
            let off: f64 = systematic.iter().map(|off| off[row] * off[column]).sum();
            covariance.add(row, column, variance * solution.inverse.at(row, column) + bend * bend * off);
        }
    }
    let apex = Estimate { value: curvatures[0], standard_error: covariance.at(0, 0).sqrt() };
    let radius_of_curvature = (apex.value > 0.0 && apex.value * apex.value > covariance.at(0, 0))
        .then(|| Estimate { value: 1.0 / apex.value, standard_error: apex.standard_error / (apex.value * apex.value) });
    let (raw, left_out) = drawn(fitted, scaled, units);
    let residuals: Vec<f64> =
        fitted.residuals.iter().zip(&fitted.kept).filter(|(_, kept)| **kept).map(|(e, _)| *e).collect();
    let sign = if units.orientation == Orientation::PeakDown { 1.0 } else { -1.0 };
    Ok(ScanFit {
        table,
        radius_of_curvature,
        centre: [0, 1].map(|axis| units.middle[axis] + fitted.axis[axis] * units.length),
        tilt: fitted.tilt.map(|tilt| sign * tilt * units.height / units.length),
        orientation: units.orientation,
        rms: (dot(&residuals, &residuals) / residuals.len() as f64).sqrt() * units.height,
        correlation_length: noise::correlation_lag(&residuals) * step(scan),
        used: fitted.kept.len(),
        outliers: fitted.kept.iter().filter(|kept| !**kept).count(),
        raw,
        left_out,
        g_margin: g_margin(&curve),
        constrained,
        profile,
        curve,
        covariance,
    })
}

/// The table of a curve, and the profile that it makes. The mechanics draws a curve of its own through the points: where g hardly
/// rises, that of the table may fall, and a small parabola lifts it.
fn table(width: f64, curvatures: &[f64], mean: f64) -> Result<(Column, Profile, Curve), Error> {
    let mut refused = Error::Hollow;
    for lift in LIFTS {
        let curve = Curve::new(width, curvatures.iter().map(|curvature| curvature + lift * mean).collect(), 0.0);
        let radius: Vec<f64> = (0..=2 * curvatures.len()).map(|index| index as f64 * TABLE_STEP * width).collect();
        let height: Vec<f64> = radius.iter().map(|&r| curve.height(r)).collect();
        let end = radius[radius.len() - 1];
        match Tabulated::new(&radius, &height).map(Profile::Tabulated) {
            Ok(profile) if profile.check_radius(end * (1.0 - 1e-9)).is_ok() => {
                return Ok((Column { radius, height }, profile, curve));
            }
            Ok(_)
            | Err(stickslip_mechanics::Error::NotConvexEnough { .. } | stickslip_mechanics::Error::Table { .. }) => {}
            Err(error) => refused = error.into(),
        }
    }
    Err(refused)
}

/// The least g'(x)/x over the mean.
fn g_margin(curve: &Curve) -> f64 {
    let (count, end) = (4 * curve.curvatures.len(), curve.end());
    let ratios = (1..=count).map(|index| {
        let x = end * index as f64 / count as f64;
        (x, curve.g_slope(x) / x)
    });
    let (least, sum, all) = ratios
        .fold((f64::INFINITY, 0.0, 0.0), |(least, sum, all), (x, ratio)| (least.min(ratio), sum + ratio * x, all + x));
    (least * all / sum).max(0.0)
}

/// The median distance of neighbouring points, m.
fn step(scan: &Scan) -> f64 {
    let mut steps: Vec<f64> =
        scan.points.windows(2).map(|pair| (pair[1][0] - pair[0][0]).hypot(pair[1][1] - pair[0][1])).collect();
    let middle = steps.len() / 2;
    *steps.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// The points as the curve sees them, fitted and left out.
fn drawn(fitted: &Fitted, scaled: &Scaled, units: &Units) -> (Column, Column) {
    let column = |wanted: bool| {
        let mut chosen: Vec<[f64; 2]> = scaled
            .points
            .iter()
            .zip(fitted.residuals.iter().zip(&fitted.kept))
            .filter(|(_, (_, kept))| **kept == wanted)
            .map(|(point, (residual, _))| {
                let r = (point[0] - fitted.axis[0]).hypot(point[1] - fitted.axis[1]);
                [r * units.length, (fitted.curve.height(r) - fitted.curve.offset + residual) * units.height]
            })
            .collect();
        chosen.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let stride = chosen.len().div_ceil(DRAWN_POINTS).max(1);
        let kept: Vec<&[f64; 2]> = chosen.iter().step_by(stride).collect();
        Column {
            radius: kept.iter().map(|point| point[0]).collect(),
            height: kept.iter().map(|point| point[1]).collect(),
        }
    };
    (column(true), column(false))
}
