//! The error of a table whose heights were fitted, as the fit states it.

use super::{InterpolationError, Tabulated};
use crate::range;
use crate::range::error::{Error, TableFault};

impl Tabulated {
    /// The same table with standard errors at its points, which take the place of what its heights say of interpolation
    /// and noise: of the indentation g at which a contact has the radius of the point, m, and the largest one of the
    /// pressure in that contact, over E*.
    ///
    /// Up to a given level int X dy errs by int |error of g| dx at most.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] by [`range::INDENTATION_ERROR`] and [`range::PRESSURE_ERROR`], [`Error::Table`] where the
    /// lengths differ.
    pub fn with_standard_errors(mut self, indentation: &[f64], pressure: &[f64]) -> Result<Tabulated, Error> {
        let count = self.radii.len();
        if indentation.len() != count || pressure.len() != count {
            let index = indentation.len().min(pressure.len()).min(count);
            return Err(Error::Table { fault: TableFault::LengthsDiffer, index });
        }
        for (&indentation, &pressure) in indentation.iter().zip(pressure) {
            range::INDENTATION_ERROR.check(indentation)?;
            range::PRESSURE_ERROR.check(pressure)?;
        }
        let (mut area, mut level, mut kernel) = (0.0, 0.0f64, 0.0f64);
        self.stated_errors = (0..count)
            .map(|index| {
                level = level.max(indentation[index]);
                kernel = kernel.max(std::f64::consts::PI * pressure[index]);
                if index > 0 {
                    let mean = 0.5 * (indentation[index - 1] + indentation[index]);
                    area += (self.radii[index] - self.radii[index - 1]) * mean;
                }
                InterpolationError { load: area, level, kernel }
            })
            .collect();
        Ok(self)
    }

    /// The error that was given, up to this radius, m; `None` if none was.
    pub(super) fn stated_error(&self, radius: f64) -> Option<InterpolationError> {
        let last = self.stated_errors.len().checked_sub(1)?;
        let index = self.radii.partition_point(|point| *point < radius).min(last);
        Some(self.stated_errors[index])
    }
}
