//! Flat punch with a rounded edge, f = (r - b)^2/(2R) for r > b: g = (x/R)(t - b phi), phi = atan(t/b), t = sqrt(x^2 -
//! b^2).
//!
//! gamma = dg/dt = (t/(R x))(2t - b phi) (Schubert 1942; Ciavarella 1999). All stays positive through t - b phi = b (u
//! - atan u), u = t/b.

use super::families::{endless, family};
use super::{Family, Parameter, Profile, range};
use crate::cells::shape::{Kink, Kinks, Powers, Shape, above};
use crate::numerics::angle::angles;

/// Its declaration.
pub(super) static FAMILY: Family = Family {
    name: "rounded_punch",
    title: "Punch with a rounded edge",
    about: "A flat punch with a rounded edge.",
    parameters: &[
        Parameter::new("flat_radius", "Radius of the flat", "Radius of the flat end, m.", range::LENGTH, 5e-5),
        Parameter::new("edge_radius", "Radius of the edge", "Radius of curvature of the edge, m.", range::LENGTH, 5e-3),
    ],
    indentation: 3e-6,
    make: |p| RoundedPunch::new(p[0], p[1]).map(Profile::RoundedPunch),
};

family! {
    /// A flat punch with a rounded edge.
    RoundedPunch { flat_radius, edge_radius }
    /// Flat up to the radius b, then a parabola of curvature radius R, both in m.
}

impl RoundedPunch {
    /// t - b phi, m.
    fn beyond_angle(&self, t: f64) -> f64 {
        let (_, [difference]) = angles([t / self.flat_radius]);
        self.flat_radius * difference
    }
}

impl Shape for RoundedPunch {
    fn kinks(&self) -> Kinks {
        Kinks::from([Kink::new(self.flat_radius, Powers::All(2))])
    }

    fn level(&self, x: f64) -> f64 {
        let b = self.flat_radius;
        if x > b { x / self.edge_radius * self.beyond_angle(((x - b) * (x + b)).sqrt()) } else { 0.0 }
    }

    fn gamma(&self, base: f64, t: f64) -> f64 {
        let b = self.flat_radius;
        above(b, base, t, |t| t / (b.hypot(t) * self.edge_radius) * (t + self.beyond_angle(t)))
    }

    fn surface_slope(&self, r: f64) -> f64 {
        (r - self.flat_radius).max(0.0) / self.edge_radius
    }

    endless!();

    fn curvature_radius(&self) -> Option<f64> {
        Some(self.edge_radius)
    }
}
