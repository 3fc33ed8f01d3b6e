//! Cone with a flat end, f' = T for r > b: g = T x phi, phi = arccos(b/x) = atan(t/b), t = sqrt(x^2 - b^2).
//!
//! gamma = dg/dt = T (phi t + b)/x (Shtaerman 1949; Popov & Hess 2015). f' jumps at b: pressure and shear are
//! log-infinite there.

use super::celled::by_cells;
use super::shape::ShapeFacts;
use super::{Error, range};
use crate::cells::Powers;
use crate::cells::grid::{Kink, above};
use crate::cells::stages::Stages;
use crate::numerics::angle::angles;

/// A truncated cone.
#[derive(Clone, Debug, PartialEq)]
pub struct TruncatedCone {
    slope: f64,
    flat_radius: f64,
    stages: Stages,
}

impl TruncatedCone {
    /// The cone of the given slope T, flat up to the radius b, m.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] by [`range::SLOPE`] and [`range::FLAT_RADIUS`].
    pub fn new(slope: f64, flat_radius: f64) -> Result<TruncatedCone, Error> {
        let (slope, flat_radius) = (range::SLOPE.check(slope)?, range::FLAT_RADIUS.check(flat_radius)?);
        Ok(TruncatedCone { slope, flat_radius, stages: Stages::new() })
    }
}

by_cells!(TruncatedCone {
    fn kinks(&self) -> Vec<Kink> {
        vec![Kink { radius: self.flat_radius, powers: Powers::All(0) }]
    }

    fn slopes<const N: usize>(&self, base: f64, t: [f64; N]) -> [f64; N] {
        let b = self.flat_radius;
        above(b, base, t, |t| {
            let (angle, _) = angles(t.map(|t| t / b));
            std::array::from_fn(|lane| self.slope * (t[lane] * angle[lane] + b) / (b * b + t[lane] * t[lane]).sqrt())
        })
    }

    fn facts(&self) -> ShapeFacts {
        ShapeFacts { singular: Some(self.flat_radius), falls_from: Some(self.flat_radius), ..ShapeFacts::default() }
    }

    fn surface_slope(&self, r: f64) -> f64 {
        if r > self.flat_radius { self.slope } else { 0.0 }
    }
});
