//! Profile given by a table: the smooth curve of [`spline`] through its points, so f'' jumps at the knots and g is a
//! sum of rounded punches (Schubert 1942) of strength half the jump. It is not summed that way: between two knots g is
//! analytic in t = sqrt(x^2 - k^2), and one short series there replaces the thousand terms.
//!
//! f'(0) = 0: a sharp tip would come from the noise of the first two points, with a log-infinite pressure; to model
//! one, add a cone. With n equal steps the interpolation error of g falls as n^(-5/2), measured for f = cosh r - 1 up
//! to r = 1.5: 3e-5 of g at n = 30, 1e-6 at 120 (`tests/physics/tables.rs`). Only radii below the last of the table,
//! and below the first at which g falls, exist: but for the part of a sum, whose g may fall as long as that of the sum
//! does not.

mod build;
mod interpolation_error;
mod noise;
mod spline;
mod stated_error;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use crate::cells::Cells;
use crate::cells::shape::{End, EndKind, Kink, Kinks, Powers, Shape};
use crate::cells::stages::Stages;
use crate::range;
use crate::range::error::{Error, TableFault};
pub use interpolation_error::InterpolationError;
use interpolation_error::TableGap;
use spline::SplineKnot;

/// A tabulated profile.
#[derive(Clone, Debug, PartialEq)]
pub struct Tabulated {
    radii: Vec<f64>,
    heights: Vec<f64>,
    /// Estimate of the noise of the heights, m.
    noise: f64,
    /// The error up to each radius, where it was given.
    stated_errors: Vec<InterpolationError>,
    /// Its gaps, with the interpolation error of each; empty without points.
    gaps: Vec<TableGap>,
    stages: Stages,
    kinks: Kinks,
    /// The last radius, m.
    end: f64,
    /// The first radius at which g falls, if it does, m.
    falls: Option<f64>,
}

impl Tabulated {
    /// The profile through the points (r, z), m. `radii` begin at zero and increase; an offset of z does not matter.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] by [`range::TABLE_POINTS`], [`range::TABLE_RADIUS`] and [`range::TABLE_HEIGHT`],
    /// [`Error::Table`] for radii or heights that are not a table, [`Error::NotConvexEnough`] if g falls from the
    /// centre on.
    pub fn new(radii: &[f64], heights: &[f64]) -> Result<Tabulated, Error> {
        Tabulated::new_while(radii, heights, &|| true)
    }

    /// The same while `keep_going` returns true, which is asked every few points.
    ///
    /// # Errors
    /// As [`Tabulated::new`], [`Error::Interrupted`] if it did not.
    pub fn new_while(radii: &[f64], heights: &[f64], keep_going: &dyn Fn() -> bool) -> Result<Tabulated, Error> {
        Tabulated::through(radii, heights, false, keep_going)
    }

    /// The part of a sum through the points (r, z), m, whose g may fall: for example the deviation of a body from a
    /// sphere. On its own, g has no inverse from there on, and contacts end there.
    ///
    /// # Errors
    /// As [`Tabulated::new`], but for a g that falls.
    pub fn part(radii: &[f64], heights: &[f64]) -> Result<Tabulated, Error> {
        Tabulated::part_while(radii, heights, &|| true)
    }

    /// The same while `keep_going` returns true, which is asked every few points.
    ///
    /// # Errors
    /// As [`Tabulated::part`], [`Error::Interrupted`] if it did not.
    pub fn part_while(radii: &[f64], heights: &[f64], keep_going: &dyn Fn() -> bool) -> Result<Tabulated, Error> {
        Tabulated::through(radii, heights, true, keep_going)
    }

    fn through(radii: &[f64], heights: &[f64], whole: bool, keep_going: &dyn Fn() -> bool) -> Result<Tabulated, Error> {
        range::TABLE_POINTS.check(radii.len() as f64)?;
        if radii.len() != heights.len() {
            return Err(Error::Table { fault: TableFault::LengthsDiffer, index: radii.len().min(heights.len()) });
        }
        for (&radius, &height) in radii.iter().zip(heights) {
            range::TABLE_RADIUS.check(radius)?;
            range::TABLE_HEIGHT.check(height)?;
        }
        if radii[0] > 0.0 {
            return Err(Error::Table { fault: TableFault::FirstRadiusNotZero, index: 0 });
        }
        if let Some(index) = radii.windows(2).position(|pair| pair[1] <= pair[0]) {
            return Err(Error::Table { fault: TableFault::RadiusNotRising, index: index + 1 });
        }
        range::RADIUS.check(radii[1])?;
        let table = Tabulated::from_knots(spline::knots(radii, heights), whole, keep_going)?;
        Ok(Tabulated {
            radii: radii.to_vec(),
            heights: heights.to_vec(),
            noise: noise::of_heights(radii, heights),
            gaps: interpolation_error::gaps(radii, heights),
            ..table
        })
    }

    /// The profile whose slope is linear between knots, as far as g rises or `whole`.
    fn from_knots(knots: Vec<SplineKnot>, whole: bool, keep_going: &dyn Fn() -> bool) -> Result<Tabulated, Error> {
        let last = knots.len() - 1;
        let built = build::cells(&knots, whole, keep_going);
        if built.stopped {
            return Err(Error::Interrupted);
        }
        let Some(flat_radius) = built.cells.first().map(|cell| cell.radius) else {
            return Err(match built.falls_at {
                Some(radius) => Error::NotConvexEnough { radius },
                None => Error::Table { fault: TableFault::HeightNeverRises, index: last },
            });
        };
        let mut kinks: Vec<Kink> = built.cells.iter().map(|cell| Kink::new(cell.kink, Powers::All(1))).collect();
        kinks.dedup_by(|a, b| a.at.radius.to_bits() == b.at.radius.to_bits());
        if flat_radius <= 0.0 {
            kinks[0].powers = Powers::Odd;
        }
        let cells = Cells::new(built.cells, None);
        let end = cells.top.radius;
        Ok(Tabulated {
            radii: Vec::new(),
            heights: Vec::new(),
            noise: 0.0,
            stated_errors: Vec::new(),
            gaps: Vec::new(),
            stages: Stages::whole(cells),
            kinks: kinks.into(),
            end,
            // A curve that was cut where g falls ends there, however that radius is rounded.
            falls: built.falls_at.map(|radius| if whole { radius.min(end) } else { end }),
        })
    }

    /// Where the cells end, m: as part of a sum g may have fallen before.
    pub(super) fn known_to(&self) -> f64 {
        self.end
    }

    /// Whether g falls before the table ends.
    pub(super) fn falls_within(&self) -> bool {
        self.falls.is_some_and(|at| at < self.known_to())
    }

    /// The interpolation error in a contact of this radius, m.
    pub(super) fn interpolation_error(&self, radius: f64) -> InterpolationError {
        self.stated_error(radius).unwrap_or_else(|| interpolation_error::at(&self.gaps, radius))
    }

    /// An estimate of the noise of g, m, in a contact of this radius, m, and how many times that of the heights it is.
    pub(super) fn noise(&self, radius: f64) -> Option<(f64, f64)> {
        if !self.stated_errors.is_empty() {
            return None;
        }
        let amplification = self.noise_amplification(radius);
        Some((self.noise * amplification, amplification))
    }

    /// Its cells, all of them.
    pub(super) fn all_cells(&self) -> Option<&Cells> {
        self.stages.everything()
    }

    /// Radii, m, increasing, between which g' cannot hide a fall.
    pub(super) fn slope_check_radii(&self) -> impl Iterator<Item = f64> {
        let cells = self.all_cells().into_iter().flat_map(|cells| &cells.cells);
        cells.flat_map(|cell| cell.slope_check_places().into_iter().map(|zeta| cell.radius_at(zeta)))
    }
}

impl Shape for Tabulated {
    fn kinks(&self) -> Kinks {
        Arc::clone(&self.kinks)
    }

    fn level(&self, x: f64) -> f64 {
        self.all_cells().map_or(0.0, |cells| cells.level(x))
    }

    fn gamma(&self, base: f64, t: f64) -> f64 {
        self.all_cells().map_or(0.0, |cells| cells.gamma(base, t))
    }

    fn surface_slope(&self, r: f64) -> f64 {
        let index = self.radii.partition_point(|point| *point < r).clamp(1, self.radii.len() - 1);
        (self.heights[index] - self.heights[index - 1]) / (self.radii[index] - self.radii[index - 1])
    }

    fn stages(&self) -> &Stages {
        &self.stages
    }

    fn end(&self) -> Option<End> {
        let kind = if self.falls.is_some() { EndKind::Fall } else { EndKind::Unknown };
        Some(End { radius: self.falls.unwrap_or(self.end), kind })
    }
}
