//! Errors of measured profiles: the error of the curve between their points, and the noise of their heights.

use super::shape::Shape;
use super::{InterpolationError, Profile};

impl Profile {
    /// The interpolation error of tables in a contact of this radius, m; zero for other profiles.
    #[must_use]
    pub fn interpolation_error(&self, radius: f64) -> InterpolationError {
        Shape::interpolation_error(self, radius)
    }

    /// An estimate of the noise of g, m, that a table's heights bring to a contact of this radius, m, and how many times their
    /// own noise that is; the noisiest part of a sum. `None` without a table.
    #[must_use]
    pub fn noise(&self, radius: f64) -> Option<(f64, f64)> {
        Shape::noise(self, radius)
    }
}
