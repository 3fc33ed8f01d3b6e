//! Exact sphere, f = R - sqrt(R^2 - r^2): g(x) = x artanh(x/R) (Segedin 1957).
//!
//! Contacts end at nine tenths of the radius: beyond, elasticity of small strains says little, and a radius beside the
//! equator, where the sphere is vertical, has few digits for its level.

use super::families::family;
use super::{Family, Parameter, Profile, range};
use crate::cells::shape::{End, EndKind, Kink, Kinks, Powers, Shape};
use crate::cells::stages::Stages;

/// Where contacts end, over the radius.
const END: f64 = 0.9;

/// Its declaration.
pub(super) static FAMILY: Family = Family {
    name: "exact_sphere",
    title: "Exact sphere",
    about: "A sphere without approximation.",
    parameters: &[Parameter::new(
        "radius",
        "Radius R",
        "Radius R, m; the contact radius stays below 0.9 of it.",
        range::LENGTH,
        0.01,
    )],
    indentation: 1e-4,
    make: |p| ExactSphere::new(p[0]).map(Profile::ExactSphere),
};

family! {
    /// A sphere, not its osculating paraboloid.
    ExactSphere { radius }
    /// The sphere of radius R, m.
}

impl Shape for ExactSphere {
    fn kinks(&self) -> Kinks {
        Kinks::from([Kink::new(0.0, Powers::Odd)])
    }

    fn level(&self, x: f64) -> f64 {
        x * (x / self.radius).atanh()
    }

    fn gamma(&self, base: f64, t: f64) -> f64 {
        let x = base.hypot(t);
        let share = x / self.radius;
        if x > 0.0 { (share.atanh() + share / ((1.0 - share) * (1.0 + share))) * (t / x) } else { 0.0 }
    }

    fn surface_slope(&self, r: f64) -> f64 {
        r / ((self.radius - r) * (self.radius + r)).sqrt()
    }

    fn stages(&self) -> &Stages {
        &self.stages
    }

    fn end(&self) -> Option<End> {
        Some(End { radius: END * self.radius, kind: EndKind::Unknown })
    }

    fn curvature_radius(&self) -> Option<f64> {
        Some(self.radius)
    }
}
