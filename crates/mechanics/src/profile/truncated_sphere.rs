//! Worn sphere, f' = r/R for r > b: g = x t/R, t = sqrt(x^2 - b^2).
//!
//! gamma = dg/dt = (b^2 + 2 t^2)/(R x) (Ejike 1981; Popov & Heß 2015). f' jumps at b: pressure and shear are
//! log-infinite there.

use super::{Error, Family, Parameter, Profile, range};
use crate::cells::shape::{End, Kink, Kinks, Powers, Shape, above};
use crate::cells::stages::Stages;

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
    /// [`Error::OutOfRange`] with the name of the parameter.
    pub fn new(radius: f64, flat_radius: f64) -> Result<TruncatedSphere, Error> {
        let [curvature_radius, flat_radius] = FAMILY.check([radius, flat_radius])?;
        Ok(TruncatedSphere { curvature_radius, flat_radius, stages: Stages::new() })
    }
}

impl Shape for TruncatedSphere {
    fn kinks(&self) -> Kinks {
        Kinks::from([Kink::new(self.flat_radius, Powers::All(0))])
    }

    fn level(&self, x: f64) -> f64 {
        let b = self.flat_radius;
        if x > b { x * ((x - b) * (x + b)).sqrt() / self.curvature_radius } else { 0.0 }
    }

    fn gamma(&self, base: f64, t: f64) -> f64 {
        let b = self.flat_radius;
        above(b, base, t, |t| (b * b + 2.0 * t * t) / (b.hypot(t) * self.curvature_radius))
    }

    fn surface_slope(&self, r: f64) -> f64 {
        if r > self.flat_radius { r / self.curvature_radius } else { 0.0 }
    }

    fn stages(&self) -> &Stages {
        &self.stages
    }

    fn end(&self) -> Option<End> {
        None
    }

    fn curvature_radius(&self) -> Option<f64> {
        Some(self.curvature_radius)
    }
}
