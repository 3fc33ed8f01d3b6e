//! Worn sphere, f' = r/R for r > b: g = x t/R, t = sqrt(x^2 - b^2).
//!
//! gamma = dg/dt = (b^2 + 2 t^2)/(R x) (Ejike 1981; Popov & Heß 2015). f' jumps at b: pressure and shear are
//! log-infinite there.

use super::families::{endless, family};
use super::{Family, Parameter, Profile, range};
use crate::cells::shape::{Kink, Kinks, Powers, Shape, above};

/// Its declaration.
pub(super) static FAMILY: Family = Family {
    name: "truncated_sphere",
    title: "Truncated (worn) sphere",
    about: "A truncated sphere.",
    parameters: &[
        Parameter::new("radius", "Radius R", "Radius of curvature R, m.", range::LENGTH, 0.01),
        Parameter::new("flat_radius", "Radius of the flat", "Radius of the flat end, m.", range::LENGTH, 5e-5),
    ],
    indentation: 3e-6,
    make: |p| TruncatedSphere::new(p[0], p[1]).map(Profile::TruncatedSphere),
};

family! {
    /// A paraboloid with a flat end.
    TruncatedSphere { radius, flat_radius }
    /// The paraboloid of curvature radius R, m, worn flat up to the radius b, m.
}

impl Shape for TruncatedSphere {
    fn kinks(&self) -> Kinks {
        Kinks::from([Kink::new(self.flat_radius, Powers::All(0))])
    }

    fn level(&self, x: f64) -> f64 {
        let b = self.flat_radius;
        if x > b { x * ((x - b) * (x + b)).sqrt() / self.radius } else { 0.0 }
    }

    fn gamma(&self, base: f64, t: f64) -> f64 {
        let b = self.flat_radius;
        above(b, base, t, |t| (b * b + 2.0 * t * t) / (b.hypot(t) * self.radius))
    }

    fn surface_slope(&self, r: f64) -> f64 {
        if r > self.flat_radius { r / self.radius } else { 0.0 }
    }

    endless!();

    fn curvature_radius(&self) -> Option<f64> {
        Some(self.radius)
    }
}
