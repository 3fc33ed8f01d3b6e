//! The shape of the indenter, as the few functions that the solver needs.
//!
//! By the method of dimensionality reduction a profile z = f(r) is known through g(x) = x int_0^x f'(r)/sqrt(x^2 - r^2)
//! dr. A *level* y is a value of g, a *radius* x its inverse X(y); a level beyond the last radius (a vertical edge)
//! keeps that radius. Normal contact, slip history and stresses read a profile through rings between two levels, so no
//! other module depends on the family.
//!
//! A family is one file, with its declaration ([`Family`]), a struct with a checked constructor and its `shape::Shape`,
//! and an entry of `families!` below; documents, form, tests and benchmarks go through [`families`]. `ARCHITECTURE.md`
//! has the recipe for another one. Contacts that are known by their load curve alone have `curve_family::CurveFamily`
//! instead.

mod asperities;
mod curve_family;
mod ellipsoid;
mod families;
mod line;
mod load_curve;
mod open_gaps;
mod ring_sum;
mod sum;
mod tabulated;
#[cfg(test)]
mod tests;

pub use crate::cells::ring::{Moments, Point, Ring, StressRadius};
pub use asperities::Asperities;
pub use ellipsoid::{Direction, Ellipsoid};
pub use families::{Family, Parameter};
pub use line::{LineBulk, LineContact, PadFace, WIDEST};
pub use load_curve::LoadCurve;
pub(super) use ring_sum::{InwardSum, RingSum};
pub use sum::Sum;
pub use tabulated::{InterpolationError, Tabulated};

use crate::cells::Cells;
use crate::cells::falls::Falls;
use crate::cells::shape::{End, EndKind, Powers, Reach, Shape};
use crate::cells::span::Span;
use crate::error::Error;
use crate::numerics::double_double::DoubleDouble;
use crate::range;
use asperities::Count;
use curve_family::CurveFamily;

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
        ///
        /// ```
        /// use stickslip_mechanics::profile::{Profile, Ring, Sphere, StressRadius};
        ///
        /// // A sphere of radius 10 mm pressed in by 1 µm: the contact radius is sqrt(R d).
        /// let sphere = Profile::Sphere(Sphere::new(0.01)?);
        /// assert!((sphere.radius(1e-6) - 1e-4).abs() < 1e-18);
        /// // Pressure is E*/pi times the kernel of the whole contact, (2/R) sqrt(a^2 - r^2).
        /// let whole = Ring::between(sphere.point(0.0.into()), sphere.point(1e-6.into()));
        /// assert!((sphere.kernel(&StressRadius::new(6e-5), &whole) - 0.016).abs() < 1e-16);
        /// # Ok::<(), stickslip_mechanics::Error>(())
        /// ```
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
        }

        impl Profile {
            /// It as a body of revolution; that of the same load curve where a ball has it, none where none has.
            pub(crate) fn shape(&self) -> Option<&dyn Shape> {
                match self {
                    $(Profile::$Family(shape) => Some(shape),)+
                    Profile::Tabulated(table) => Some(table),
                    Profile::Sum(sum) => Some(sum),
                    Profile::PadFace(face) => Some(face),
                    Profile::Asperities(Asperities(Count::One(ball))) | Profile::Ellipsoid(Ellipsoid { ball, .. }) => {
                        Some(ball)
                    }
                    Profile::Asperities(Asperities(Count::Many(_))) | Profile::LoadCurve(_) | Profile::Line(_) => None,
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

mod ring_integrals;

impl Profile {
    /// Whether the contact has a surface that stresses are known on. Without one it is known by its load curve alone:
    /// the kernels, slopes and stresses of such a profile are those of a body of revolution with the same curve, or
    /// NaN.
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

    /// The parabola that it is, or whose load curve it has.
    #[inline]
    fn ball(&self) -> Option<&Sphere> {
        match self {
            Profile::Sphere(ball)
            | Profile::Asperities(Asperities(Count::One(ball)))
            | Profile::Ellipsoid(Ellipsoid { ball, .. }) => Some(ball),
            _ => None,
        }
    }

    /// The load curve by which alone the contact is known, if it is and no ball has it.
    fn curve(&self) -> Option<&dyn CurveFamily> {
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

    /// The body of revolution whose stresses over r are those of the contact, and its edge for that of the contact.
    pub(super) fn face(&self, edge: &Point) -> (&Profile, Point) {
        match self.line() {
            Some(line) if edge.level.value() >= 0.0 => (line.face(), line.face_point(edge.level)),
            line => (line.map_or(self, LineContact::face), *edge),
        }
    }

    /// The contact radius, m, of a contact with this edge; of a line contact the half-width.
    pub(super) fn edge_radius(&self, edge: &Point) -> f64 {
        match self.line() {
            Some(line) if edge.level.value() >= 0.0 => line.half_width(edge.level.value()),
            _ => edge.radius,
        }
    }

    /// The contact radius, m, at a level, m; of a line contact the half-width, where [`Profile::radius`] is F_N'/(2
    /// E*).
    #[must_use]
    pub fn contact_radius(&self, level: f64) -> f64 {
        self.line().map_or_else(|| self.radius(level), |line| line.half_width(level))
    }

    /// The level, m, of a contact radius, m; of a half-width, for a line contact.
    #[must_use]
    pub fn level_at_edge(&self, contact_radius: f64) -> f64 {
        self.line().map_or_else(|| self.level(contact_radius), |line| line.level_of_width(contact_radius))
    }

    /// Its cells that reach beyond something, where it has any.
    pub(crate) fn cells(&self, reach: Reach) -> Option<&Cells> {
        self.shape()?.cells_while(reach, &|| true)
    }

    /// g(x), m, for a radius x >= 0, m.
    #[must_use]
    pub fn level(&self, radius: f64) -> f64 {
        if let Some(curve) = self.curve() {
            return curve.level_of(radius);
        }
        let closed = |shape: &dyn Shape| shape.level(radius.min(shape.end_radius()));
        self.shape().map_or(f64::NAN, closed)
    }

    /// g'(x) (pure number), infinite where f' jumps.
    #[must_use]
    pub fn slope(&self, radius: f64) -> f64 {
        match self.curve() {
            Some(curve) => curve.rate(curve.level_of(radius)).recip(),
            None => self.cells(Reach::Radius(radius)).map_or(f64::NAN, |cells| cells.slope(radius)),
        }
    }

    /// The largest radius below `radius`, m, at which g is not analytic; zero, the tip, if there is none.
    pub(super) fn kink_below(&self, radius: f64) -> f64 {
        self.cells(Reach::Radius(radius)).map_or(0.0, |cells| cells.kink_below(radius))
    }

    /// X(y), m, for a level y >= 0, m; X(0) is the radius of a flat core. Beyond the end of the profile it stays at
    /// [`Profile::limit_radius`].
    #[must_use]
    pub fn radius(&self, level: f64) -> f64 {
        self.point(level.into()).radius
    }

    /// The level with its radius and that radius's square.
    #[must_use]
    #[inline]
    pub fn point(&self, level: DoubleDouble) -> Point {
        // A move on a sphere is so short that a call counts.
        if let Profile::Sphere(ball) = self { ball.point(level) } else { self.point_of_any(level) }
    }

    #[inline(never)]
    fn point_of_any(&self, level: DoubleDouble) -> Point {
        if let Some(ball) = self.ball() {
            return ball.point(level);
        }
        let square = match self.curve() {
            Some(curve) => DoubleDouble::square_of(curve.radius_at(level)),
            None if level.value() <= 0.0 => DoubleDouble::square_of(self.flat_radius()),
            None => self.cells(Reach::Level(level.value())).map_or(DoubleDouble::ZERO, |cells| cells.square(level)),
        };
        Point { level, radius: square.value().sqrt(), square }
    }

    /// Where the surface leaves the plane, m.
    fn flat_radius(&self) -> f64 {
        match self {
            Profile::Tabulated(table) => table.flat_radius(),
            _ => self.shape().map_or(0.0, |shape| {
                let end = shape.end().map_or(0.0, |end| end.radius);
                shape.kinks().first().map_or(end, |kink| kink.radius)
            }),
        }
    }

    /// The indentation d, m, at which int_0^d X(y) dy = F_N/(2 E*) = `load`, m^2.
    #[must_use]
    pub fn indentation_for(&self, load: f64) -> f64 {
        match (self.curve(), self.ball()) {
            (Some(curve), _) => curve.indentation_of(load),
            (_, Some(ball)) => ball.indentation_for(load),
            _ => self.cells(Reach::Load(load)).map_or(f64::NAN, |cells| cells.indentation_for(load)),
        }
    }

    /// Where contacts end.
    fn end(&self) -> Option<End> {
        let unknown = |radius| End { radius, kind: EndKind::Unknown };
        self.curve().map_or_else(|| self.shape()?.end(), |curve| curve.end().map(unknown))
    }

    /// The radius, m, that every contact must stay below: where a table ends or its g falls, nine tenths of an exact
    /// sphere. A punch's edge is no such limit.
    #[must_use]
    pub fn limit_radius(&self) -> Option<f64> {
        self.end().filter(|end| end.kind != EndKind::Edge).map(|end| end.radius)
    }

    /// The radius, m, of a vertical edge, which the contact keeps under every higher load.
    #[must_use]
    pub fn rim_radius(&self) -> Option<f64> {
        self.end().filter(|end| end.kind == EndKind::Edge).map(|end| end.radius)
    }

    /// Checks a contact radius and returns it.
    ///
    /// # Errors
    /// If it is not below [`Profile::limit_radius`]: [`Error::NotConvexEnough`] where g falls from there on,
    /// [`Error::BeyondProfile`] where the profile ends; [`Error::BeyondReferenceLength`] for the half-width of a line
    /// contact from [`WIDEST`] of its reference length on.
    pub fn check_radius(&self, radius: f64) -> Result<f64, Error> {
        if let Some(limit) = self.line().map(|line| WIDEST * line.reference_length()) {
            let beyond = Err(Error::BeyondReferenceLength { half_width: radius, limit });
            return if radius < limit { Ok(radius) } else { beyond };
        }
        match self.end() {
            Some(End { radius: limit, kind: EndKind::Fall }) if radius >= limit => {
                Err(Error::NotConvexEnough { radius: limit })
            }
            Some(End { radius: limit, kind: EndKind::Unknown }) if radius >= limit => {
                Err(Error::BeyondProfile { radius, limit })
            }
            _ => Ok(radius),
        }
    }

    /// How many times larger than g at the radius `x`, m, the parts are that it is the sum of: the factor by which
    /// rounding grows.
    #[must_use]
    pub fn cancellation(&self, x: f64) -> f64 {
        if let Profile::Sum(sum) = self { sum.cancellation(x) } else { 1.0 }
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
        self.shape().filter(|_| self.has_stress_field()).map_or(f64::NAN, |shape| shape.surface_slope(r))
    }

    /// The radius of curvature, m, where the shape is given by one: the smallest of a sum.
    #[must_use]
    pub fn curvature_radius(&self) -> Option<f64> {
        self.line().map_or_else(|| self.shape()?.curvature_radius(), |line| Some(line.curvature_radius()))
    }

    /// Bounds on the kernel up to c = `outer`, m, from r = `inner`, m, on.
    pub(super) fn falls(&self, inner: f64, outer: f64) -> Falls {
        self.cells(Reach::Radius(outer)).map_or(Falls::UNKNOWN, |cells| cells.falls(inner, outer))
    }

    /// The radii, m, increasing, at which pressure and shear are infinite once the contact has grown over them: the tip
    /// of a cone, a rim where the slope jumps. The vertical edge of a punch is not among them.
    ///
    /// ```
    /// use stickslip_mechanics::profile::{Profile, TruncatedCone};
    ///
    /// let cone = Profile::TruncatedCone(TruncatedCone::new(0.1, 5e-5)?);
    /// assert_eq!(cone.singular_radii(), [5e-5]);
    /// # Ok::<(), stickslip_mechanics::Error>(())
    /// ```
    #[must_use]
    pub fn singular_radii(&self) -> Vec<f64> {
        match self {
            Profile::Tabulated(_) => Vec::new(),
            _ => self.shape().map_or_else(Vec::new, |shape| {
                shape.kinks().iter().filter(|kink| kink.powers.singular()).map(|kink| kink.radius).collect()
            }),
        }
    }

    /// The radii, m, above zero and below `radius` at which g is not analytic, increasing: ends of a flat, knots of a
    /// table. Stresses are log-infinite there, or their derivatives are.
    #[must_use]
    pub fn knots_below(&self, radius: f64) -> Vec<f64> {
        self.cells(Reach::Radius(radius)).map_or_else(Vec::new, |cells| cells.kinks_below(radius).to_vec())
    }

    /// Whether stresses are analytic in r^2 at the centre if the surface slips there.
    #[must_use]
    pub fn smooth_centre(&self) -> bool {
        let smooth = |powers| powers == Powers::Odd;
        self.shape()
            .is_some_and(|shape| shape.kinks().first().is_none_or(|kink| kink.radius > 0.0 || smooth(kink.powers)))
    }

    /// The interpolation error of tables in a contact of this radius, m; zero for other profiles.
    #[must_use]
    pub fn interpolation_error(&self, radius: f64) -> InterpolationError {
        match self {
            Profile::Tabulated(table) => table.interpolation_error(radius),
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
