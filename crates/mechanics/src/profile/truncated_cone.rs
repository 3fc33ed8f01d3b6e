//! Cone with a flat end, f' = T for r > b: g = T x phi, phi = arccos(b/x) = atan(t/b), t = sqrt(x^2 - b^2).
//!
//! gamma = dg/dt = T (phi t + b)/x (Shtaerman 1949; Popov & Hess 2015). f' jumps at b: pressure and shear are
//! log-infinite there.

use super::{Error, range};
use crate::cells::shape::{Kink, Powers, Shape, above};
use crate::cells::stages::Stages;

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

impl Shape for TruncatedCone {
    fn kinks(&self) -> Vec<Kink> {
        vec![Kink { radius: self.flat_radius, powers: Powers::All(0) }]
    }

    fn level(&self, x: f64) -> f64 {
        let b = self.flat_radius;
        if x > b { self.slope * x * ((x - b) * (x + b)).sqrt().atan2(b) } else { 0.0 }
    }

    fn gamma(&self, base: f64, t: f64) -> f64 {
        let b = self.flat_radius;
        above(b, base, t, |t| self.slope * (t * t.atan2(b) + b) / b.hypot(t))
    }

    fn surface_slope(&self, r: f64) -> f64 {
        if r > self.flat_radius { self.slope } else { 0.0 }
    }

    fn stages(&self) -> Option<&Stages> {
        Some(&self.stages)
    }
}
