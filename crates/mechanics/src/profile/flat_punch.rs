//! Flat punch of radius b: X(y) = b for every level, so that all of a ring lies at the vertical edge, where its kernel
//! is depth/sqrt(b^2 - r^2) (Boussinesq 1885).

use super::families::family;
use super::{Family, Parameter, Profile, range};
use crate::cells::shape::{End, EndKind, Kinks, Shape};
use crate::cells::stages::Stages;

/// Its declaration.
pub(super) static FAMILY: Family = Family {
    name: "flat_punch",
    title: "Flat punch",
    about: "A flat punch.",
    parameters: &[Parameter::new("radius", "Radius R", "Radius of the punch, m.", range::LENGTH, 1e-3)],
    indentation: 1e-6,
    make: |p| FlatPunch::new(p[0]).map(Profile::FlatPunch),
};

family! {
    /// A cylinder pressed in with its flat end.
    FlatPunch { radius }
    /// The punch of radius b, m.
}

impl Shape for FlatPunch {
    fn kinks(&self) -> Kinks {
        Kinks::from([])
    }

    fn level(&self, _x: f64) -> f64 {
        0.0
    }

    fn gamma(&self, _base: f64, _t: f64) -> f64 {
        0.0
    }

    fn surface_slope(&self, _r: f64) -> f64 {
        0.0
    }

    fn stages(&self) -> &Stages {
        &self.stages
    }

    fn end(&self) -> Option<End> {
        Some(End { radius: self.radius, kind: EndKind::Edge })
    }
}
