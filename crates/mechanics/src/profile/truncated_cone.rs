//! Cone with a flat end, f' = T for r > b: g = T x phi, phi = arccos(b/x) = atan(t/b), t = sqrt(x^2 - b^2).
//!
//! gamma = dg/dt = T (phi t + b)/x (Shtaerman 1949; Popov & Heß 2015). f' jumps at b: pressure and shear are
//! log-infinite there.

use super::families::{endless, family};
use super::{Family, Parameter, Profile, range};
use crate::cells::shape::{Kink, Kinks, Powers, Shape, above};

/// Its declaration.
pub(super) static FAMILY: Family = Family {
    name: "truncated_cone",
    title: "Truncated cone",
    about: "A truncated cone.",
    parameters: &[
        Parameter::new("slope", "Slope dz/dr", "Slope dz/dr outside the flat, a pure number.", range::SLOPE, 0.05),
        Parameter::new("flat_radius", "Radius of the flat", "Radius of the flat end, m.", range::LENGTH, 5e-5),
    ],
    indentation: 1e-5,
    make: |p| TruncatedCone::new(p[0], p[1]).map(Profile::TruncatedCone),
};

family! {
    /// A truncated cone.
    TruncatedCone { slope, flat_radius }
    /// The cone of the given slope T, flat up to the radius b, m.
}

impl Shape for TruncatedCone {
    fn kinks(&self) -> Kinks {
        Kinks::from([Kink::new(self.flat_radius, Powers::All(0))])
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

    endless!();
}
