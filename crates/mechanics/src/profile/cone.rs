//! Cone f = T r: g(x) = (pi/2) T x, K(r, c) = (pi/2) T arcosh(c/r) (Love 1939; Sneddon 1965).
//!
//! Pressure and shear are log-infinite at the tip.

use std::f64::consts::FRAC_PI_2;

use super::{Error, range};
use crate::cells::shape::{Kink, Powers, Shape};
use crate::cells::stages::Stages;

/// A cone.
#[derive(Clone, Debug, PartialEq)]
pub struct Cone {
    slope: f64,
    stages: Stages,
}

impl Cone {
    /// The cone of slope T = dz/dr.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] by [`range::SLOPE`].
    pub fn new(slope: f64) -> Result<Cone, Error> {
        Ok(Cone { slope: range::SLOPE.check(slope)?, stages: Stages::new() })
    }
}

impl Shape for Cone {
    fn kinks(&self) -> Vec<Kink> {
        vec![Kink { radius: 0.0, powers: Powers::All(0) }]
    }

    fn level(&self, x: f64) -> f64 {
        FRAC_PI_2 * self.slope * x
    }

    fn gamma(&self, base: f64, t: f64) -> f64 {
        let slope = FRAC_PI_2 * self.slope;
        if base > 0.0 { slope * (t / base.hypot(t)) } else { slope }
    }

    fn surface_slope(&self, _r: f64) -> f64 {
        self.slope
    }

    fn stages(&self) -> Option<&Stages> {
        Some(&self.stages)
    }
}
