//! Why a scan yields no profile, in words of the bench.

use super::FEWEST_POINTS;

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
        "the surface does not fall away from a peak about any axis: is it a hollow, or is `orientation` the wrong way \
         up?"
    )]
    Hollow,
    /// The curve follows the noise so closely that no rising profile is near it.
    #[error(
        "a curve this fine follows the noise, and its profile would not rise: give fewer `knots`, or leave `smoothing` \
         out"
    )]
    Rough,
    /// The axis given is not in the scan.
    #[error("the scan has no points near this axis: the nearest is {} away, the farthest \
        {}", micrometres(*nearest), micrometres(*farthest))]
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
    #[error("the scan does not reach the edge of the contact: {} of about \
        {}", micrometres(*reach), micrometres(*needed))]
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
