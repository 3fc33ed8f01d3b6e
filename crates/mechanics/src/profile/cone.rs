//! Cone f = T r: g(x) = (pi/2) T x, K(r, c) = (pi/2) T arcosh(c/r) (Love 1939; Sneddon 1965).
//!
//! Pressure and shear are log-infinite at the tip.

use std::f64::consts::FRAC_PI_2;

use super::families::{endless, family};
use super::{Family, Parameter, Profile, range};
use crate::cells::shape::{Kink, Kinks, Powers, Shape};

/// Its declaration.
pub(super) static FAMILY: Family = Family {
    name: "cone",
    title: "Cone",
    about: "A cone.",
    parameters: &[Parameter::new("slope", "Slope dz/dr", "Slope dz/dr, a pure number.", range::SLOPE, 0.05)],
    indentation: 1e-5,
    make: |p| Cone::new(p[0]).map(Profile::Cone),
};

family! {
    /// A cone.
    Cone { slope }
    /// The cone of slope T = dz/dr.
}

impl Shape for Cone {
    fn kinks(&self) -> Kinks {
        Kinks::from([Kink::new(0.0, Powers::All(0))])
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

    endless!();
}
