//! Hertz's parabola f = r^2/(2R), the paper's sphere: g(x) = x^2/R (Hertz 1881).
//!
//! Its integrals over rings have closed forms, for speed alone: `cells/parabola.rs`.

use super::families::endless;
use super::{Error, Family, Parameter, Profile, range};
use crate::cells::parabola::Parabola;
use crate::cells::shape::{Kink, Kinks, Powers, Shape};
use crate::cells::stages::Stages;

/// Its declaration.
pub(super) static FAMILY: Family = Family {
    name: "sphere",
    title: "Sphere (Hertz’s parabola)",
    about: "A sphere in Hertz's approximation.",
    parameters: &[Parameter::new(
        "radius",
        "Radius R",
        "Radius of curvature R of the gap, m; for two spheres 1/R = 1/R₁ + 1/R₂.",
        range::LENGTH,
        0.01,
    )],
    indentation: 3e-6,
    make: |p| Sphere::new(p[0]).map(Profile::Sphere),
};

/// A paraboloid of revolution.
#[derive(Clone, Debug, PartialEq)]
pub struct Sphere {
    pub(super) parabola: Parabola,
    stages: Stages,
}

impl Sphere {
    /// The paraboloid with curvature radius R, m, at its tip.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] with the name of the parameter.
    pub fn new(radius: f64) -> Result<Sphere, Error> {
        FAMILY.check([radius]).map(|[radius]| Sphere::of_curvature(radius))
    }

    /// The same where R follows from other, checked numbers.
    pub(super) fn of_curvature(radius: f64) -> Sphere {
        Sphere { parabola: Parabola { curvature_radius: radius }, stages: Stages::new() }
    }

    /// Curvature radius R, m.
    #[must_use]
    pub fn curvature_radius(&self) -> f64 {
        self.parabola.curvature_radius
    }
}

impl Shape for Sphere {
    fn kinks(&self) -> Kinks {
        Kinks::from([Kink::new(0.0, Powers::Odd)])
    }

    fn level(&self, x: f64) -> f64 {
        x * x / self.parabola.curvature_radius
    }

    fn gamma(&self, _base: f64, t: f64) -> f64 {
        // g'/x is the same everywhere.
        2.0 * t / self.parabola.curvature_radius
    }

    fn surface_slope(&self, r: f64) -> f64 {
        r / self.parabola.curvature_radius
    }

    endless!();

    fn curvature_radius(&self) -> Option<f64> {
        Some(self.parabola.curvature_radius)
    }
}
