//! Cone with a rounded tip, f' = T min(r/b, 1): inside b the paraboloid of curvature radius b/T; outside, with
//! t = sqrt(x^2 - b^2) and phi = atan(t/b), g = T x (b/(x + t) + phi).
//!
//! There gamma = dg/dt = T (t/x) (2b/(x + t) + phi) (Ciavarella 1999; Popov & Heß 2015). f' bends but does not jump at
//! b, so all stresses are finite.

use super::families::{endless, family};
use super::{Family, Parameter, Profile, range};
use crate::cells::shape::{Kink, Kinks, Powers, Shape, above};

/// Its declaration.
pub(super) static FAMILY: Family = Family {
    name: "rounded_cone",
    title: "Cone with a rounded tip",
    about: "A cone with a rounded tip.",
    parameters: &[
        Parameter::new("slope", "Slope dz/dr", "Slope dz/dr of the cone, a pure number.", range::SLOPE, 0.05),
        Parameter::new(
            "tip_radius",
            "Radius of the tip",
            "Radius up to which the tip is a parabola, m.",
            range::LENGTH,
            5e-5,
        ),
    ],
    indentation: 1e-5,
    make: |p| RoundedCone::new(p[0], p[1]).map(Profile::RoundedCone),
};

family! {
    /// A cone whose tip is a paraboloid.
    RoundedCone { slope, tip_radius }
    /// The cone of slope T, parabolic up to the radius b, m, where both slopes agree.
}

impl Shape for RoundedCone {
    fn kinks(&self) -> Kinks {
        Kinks::from([Kink::new(0.0, Powers::Odd), Kink::new(self.tip_radius, Powers::All(1))])
    }

    fn level(&self, x: f64) -> f64 {
        let (slope, b) = (self.slope, self.tip_radius);
        if x <= b {
            return slope * x * (x / b);
        }
        let t = ((x - b) * (x + b)).sqrt();
        slope * x * (b / (x + t) + t.atan2(b))
    }

    fn gamma(&self, base: f64, t: f64) -> f64 {
        let (slope, b) = (self.slope, self.tip_radius);
        if base < b {
            return 2.0 * slope / b * t;
        }
        above(b, base, t, |t| {
            let x = b.hypot(t);
            slope * (t / x) * (2.0 * b / (x + t) + t.atan2(b))
        })
    }

    fn surface_slope(&self, r: f64) -> f64 {
        self.slope * (r / self.tip_radius).min(1.0)
    }

    endless!();
}
