//! Worn sphere, f' = r/R for r > b: g = x t/R, t = sqrt(x^2 - b^2).
//!
//! gamma = dg/dt = (b^2 + 2 t^2)/(R x) (Ejike 1981; Popov & Hess 2015). f' jumps at b: pressure and shear are
//! log-infinite there.

use super::celled::by_cells;
use super::shape::ShapeFacts;
use super::{Error, range};
use crate::cells::Powers;
use crate::cells::grid::{Kink, above};
use crate::cells::stages::Stages;

/// A paraboloid with a flat end.
#[derive(Clone, Debug, PartialEq)]
pub struct TruncatedSphere {
    curvature_radius: f64,
    flat_radius: f64,
    stages: Stages,
}

impl TruncatedSphere {
    /// The paraboloid of curvature radius R, m, worn flat up to the radius b, m.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] by [`range::RADIUS`] and [`range::FLAT_RADIUS`].
    pub fn new(radius: f64, flat_radius: f64) -> Result<TruncatedSphere, Error> {
        let (curvature_radius, flat_radius) = (range::RADIUS.check(radius)?, range::FLAT_RADIUS.check(flat_radius)?);
        Ok(TruncatedSphere { curvature_radius, flat_radius, stages: Stages::new() })
    }
}

by_cells!(TruncatedSphere {
    fn kinks(&self) -> Vec<Kink> {
        vec![Kink { radius: self.flat_radius, powers: Powers::All(0) }]
    }

    fn slopes<const N: usize>(&self, base: f64, t: [f64; N]) -> [f64; N] {
        let b = self.flat_radius;
        above(b, base, t, |t| t.map(|t| (b * b + 2.0 * t * t) / ((b * b + t * t).sqrt() * self.curvature_radius)))
    }

    fn facts(&self) -> ShapeFacts {
        ShapeFacts {
            curvature_radius: Some(self.curvature_radius),
            singular: Some(self.flat_radius),
            falls_from: Some(self.flat_radius),
            ..ShapeFacts::default()
        }
    }

    fn surface_slope(&self, r: f64) -> f64 {
        if r > self.flat_radius { r / self.curvature_radius } else { 0.0 }
    }
});
