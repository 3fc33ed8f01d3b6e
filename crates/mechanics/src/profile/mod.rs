//! The shape of the indenter, as the few functions that the solver needs.
//!
//! By the method of dimensionality reduction a profile z = f(r) is known through g(x) = x int_0^x f'(r)/sqrt(x^2 - r^2)
//! dr. A *level* y is a value of g, a *radius* x its inverse X(y); a level beyond the last radius (a vertical edge)
//! keeps that radius. A profile is a document: what a contact asks of it is resolved once, in an
//! [`Indenter`](crate::Indenter).
//!
//! A family is one file, with its declaration ([`Family`]), a struct with a checked constructor and its `shape::Shape`,
//! and an entry of `families!` below; documents, form, tests and benchmarks go through [`families`]. `ARCHITECTURE.md`
//! has the recipe for another one. Contacts that are known by their load curve alone have `curve_family::CurveFamily`
//! instead.

mod asperities;
mod curve_family;
mod ellipsoid;
mod families;
mod limit_shape;
mod line;
mod load_curve;
mod open_gaps;
mod strength_limit;
mod sum;
mod tabulated;
#[cfg(test)]
mod tests;
mod twist_limit;

pub use crate::cells::ring::{Moments, Point, Ring, StressRadius};
pub use asperities::Asperities;
pub use ellipsoid::{Direction, Ellipsoid};
pub use families::{Family, Parameter};
pub use limit_shape::LimitShape;
pub use line::{LineBulk, LineContact, PadFace, WIDEST};
pub use load_curve::LoadCurve;
pub(crate) use strength_limit::Strength;
pub use sum::Sum;
pub use tabulated::{InterpolationError, Tabulated};
pub(crate) use twist_limit::{MOST_CELLS, Twisted, complete};

use crate::cells::Cells;
use crate::cells::parabola::Parabola;
use crate::cells::shape::{Reach, Shape};
use crate::range;
use crate::range::error::Error;
use asperities::Count;
pub(crate) use curve_family::CurveFamily;

/// Declares the modules of the families, the enum of all profiles, and [`families`].
macro_rules! families {
    ($($module:ident::$Family:ident,)+) => {
        $(mod $module; pub use $module::$Family;)+

        /// The families whose parameters are plain numbers. The `type` in JSON of each is the name of its file.
        ///
        /// ```
        /// use stickslip_mechanics::profile::families;
        ///
        /// let family = families().iter().find(|family| family.name == "truncated_cone").unwrap();
        /// assert_eq!(family.parameters[1].name, "flat_radius");
        /// let error = (family.make)(&[0.1, 0.0]).unwrap_err().to_string();
        /// assert_eq!(error, "flat_radius = 0 is out of range: allowed is 1e-15 to 1e9 m");
        /// ```
        #[must_use]
        pub fn families() -> &'static [&'static Family] {
            static ALL: &[&Family] = &[$(&$module::FAMILY,)+];
            ALL
        }

        /// A profile of one of the families: a closed set.
        #[derive(Clone, Debug, PartialEq)]
        pub enum Profile {
            $(#[doc = concat!("See [`", stringify!($Family), "`].")] $Family($Family),)+
            /// A measured profile, through whose points a smooth curve is drawn that keeps their monotony and
            /// convexity.
            Tabulated(Tabulated),
            /// Several profiles added up, z = Σ zᵢ.
            Sum(Sum),
            /// Hertzian asperities on one rigid motion.
            Asperities(Asperities),
            /// A load curve, measured or computed elsewhere.
            LoadCurve(LoadCurve),
            /// Hertz's ellipse of contact.
            Ellipsoid(Ellipsoid),
            /// A contact along a line, in plane strain.
            Line(LineContact),
            /// What the pressure of a pad along a line follows from, as a body of revolution.
            PadFace(PadFace),
            /// The limit of slip of a contact at one load.
            Limit(LimitShape),
        }

        impl Profile {
            /// It as a body of revolution, if it is one.
            pub(crate) fn shape(&self) -> Option<&dyn Shape> {
                match self {
                    $(Profile::$Family(shape) => Some(shape),)+
                    Profile::Tabulated(table) => Some(table),
                    Profile::Sum(sum) => Some(sum),
                    Profile::PadFace(face) => Some(face),
                    Profile::Limit(limit) => Some(limit),
                    Profile::Asperities(_) | Profile::Ellipsoid(_) | Profile::LoadCurve(_) | Profile::Line(_) => None,
                }
            }
        }
    };
}
families! {
    sphere::Sphere,
    exact_sphere::ExactSphere,
    cone::Cone,
    power_law::PowerLaw,
    flat_punch::FlatPunch,
    truncated_cone::TruncatedCone,
    truncated_sphere::TruncatedSphere,
    rounded_punch::RoundedPunch,
    rounded_cone::RoundedCone,
}

impl Profile {
    /// Whether the contact has a surface that stresses are known on. Without one it is known by its load curve alone,
    /// and kernels and stresses are NaN.
    #[must_use]
    pub fn has_stress_field(&self) -> bool {
        self.check_stress_field().is_ok()
    }

    /// Refuses a stress of a profile without [`Profile::has_stress_field`].
    ///
    /// # Errors
    /// [`Error::NoStressField`] with the type of the profile.
    pub fn check_stress_field(&self) -> Result<(), Error> {
        let profile = match self {
            Profile::Asperities(_) => "asperities",
            Profile::LoadCurve(_) => "load_curve",
            Profile::Ellipsoid(_) => "ellipsoid",
            _ => return Ok(()),
        };
        Err(Error::NoStressField { profile })
    }

    /// Refuses what is defined for round contacts alone, by its name.
    ///
    /// # Errors
    /// [`Error::LineContact`].
    pub fn check_round(&self, what: &'static str) -> Result<(), Error> {
        if self.line().is_some() { Err(Error::LineContact(what)) } else { Ok(()) }
    }

    /// Whether it is a body of revolution that can be added to others.
    fn is_round(&self) -> bool {
        self.line().is_none() && self.has_stress_field()
    }

    /// The parabola that it is, or whose load curve it has.
    pub(crate) fn ball(&self) -> Option<Parabola> {
        match self {
            Profile::Sphere(ball) => Some(ball.parabola),
            Profile::Asperities(Asperities(Count::One(ball))) | Profile::Ellipsoid(Ellipsoid { ball, .. }) => {
                Some(*ball)
            }
            _ => None,
        }
    }

    /// The load curve by which alone the contact is known, if it is and no ball has it.
    pub(crate) fn curve(&self) -> Option<&dyn CurveFamily> {
        match self {
            Profile::Asperities(Asperities(Count::Many(curve))) => Some(curve),
            Profile::LoadCurve(curve) => Some(curve),
            Profile::Line(line) => Some(line),
            _ => None,
        }
    }

    /// It as a contact along a line.
    #[must_use]
    pub fn line(&self) -> Option<&LineContact> {
        if let Profile::Line(line) = self { Some(line) } else { None }
    }

    /// Its cells that reach beyond something, where it has any.
    pub(crate) fn cells(&self, reach: Reach) -> Option<&Cells> {
        self.shape()?.cells_while(reach, &|| true)
    }

    /// g(x), m, of a body of revolution, for a radius x >= 0, m.
    pub(crate) fn level(&self, radius: f64) -> f64 {
        self.shape().map_or(f64::NAN, |shape| shape.level(radius.min(shape.end_radius())))
    }

    /// Its g'(x) (pure number), infinite where f' jumps.
    pub(crate) fn slope(&self, radius: f64) -> f64 {
        self.cells(Reach::Radius(radius)).map_or(f64::NAN, |cells| cells.slope(radius))
    }

    /// How many times larger than g at the radius `x`, m, the parts are that it is the sum of: the factor by which
    /// rounding grows.
    #[must_use]
    pub fn cancellation(&self, x: f64) -> f64 {
        match self {
            Profile::Sum(sum) => sum.cancellation(x),
            Profile::Limit(limit) => limit.cancellation(x),
            _ => 1.0,
        }
    }

    /// dz/dr of the undeformed surface at the radius r, m (pure number); of a table, the slope of its chord there.
    ///
    /// ```
    /// use stickslip_mechanics::profile::{Profile, RoundedCone};
    ///
    /// let cone = Profile::RoundedCone(RoundedCone::new(0.1, 1e-3)?);
    /// assert_eq!([0.0, 5e-4, 2e-3].map(|r| cone.surface_slope(r)), [0.0, 0.05, 0.1]);
    /// # Ok::<(), stickslip_mechanics::Error>(())
    /// ```
    #[must_use]
    pub fn surface_slope(&self, r: f64) -> f64 {
        if let Some(line) = self.line() {
            return line.surface_slope(r);
        }
        self.shape().map_or(f64::NAN, |shape| shape.surface_slope(r))
    }

    /// The radius of curvature, m, where the shape is given by one: the smallest of a sum.
    #[must_use]
    pub fn curvature_radius(&self) -> Option<f64> {
        self.line().map_or_else(|| self.shape()?.curvature_radius(), |line| Some(line.curvature_radius()))
    }

    /// The interpolation error of tables in a contact of this radius, m; zero for other profiles.
    #[must_use]
    pub fn interpolation_error(&self, radius: f64) -> InterpolationError {
        match self {
            Profile::Tabulated(table) => table.interpolation_error(radius),
            Profile::Limit(limit) => limit.interpolation_error(radius),
            Profile::Sum(sum) => {
                let errors = sum.parts().iter().map(|part| part.interpolation_error(radius));
                errors.fold(InterpolationError::default(), InterpolationError::and)
            }
            _ => self.curve().map_or(InterpolationError::default(), |curve| curve.curve_error(radius)),
        }
    }

    /// An estimate of the noise of g, m, that a table's heights bring to a contact of this radius, m, and how many
    /// times their own noise that is; the noisiest part of a sum. `None` without a table.
    #[must_use]
    pub fn noise(&self, radius: f64) -> Option<(f64, f64)> {
        match self {
            Profile::Tabulated(table) => table.noise(radius),
            Profile::Sum(sum) => {
                let noises = sum.parts().iter().filter_map(|part| part.noise(radius));
                noises.reduce(|one, other| if one.0 > other.0 { one } else { other })
            }
            _ => None,
        }
    }
}
