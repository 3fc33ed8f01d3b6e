//! The shape of the indenter, as the few functions that the solver needs.
//!
//! By the method of dimensionality reduction a profile z = f(r) is known through g(x) = x int_0^x f'(r)/sqrt(x^2 - r^2)
//! dr. A *level* y is a value of g, a *radius* x its inverse X(y); a level beyond the last radius (a vertical edge)
//! keeps that radius. Normal contact, slip history and stresses read a profile through rings between two levels, so no
//! other module depends on the family.
//!
//! A family is a struct with a checked constructor and its `shape::Shape`, and an entry of
//! [`for_each_family!`](crate::for_each_family), from which the JSON documents and their checks follow.
//! `ARCHITECTURE.md` has the recipe for another one. Contacts that are known by their load curve alone have
//! `curve_family::CurveFamily` instead.

mod asperities;
mod celled;
mod cone;
mod curve_family;
mod distant_rings;
mod ellipsoid;
mod exact_sphere;
#[macro_use]
mod families;
mod flat_punch;
mod load_curve;
mod open_gaps;
mod polynomial;
mod power_law;
mod ring_sum;
mod rounded_cone;
mod rounded_punch;
mod shallow_sphere;
mod shape;
mod slope_series;
mod smooth_interval;
mod smooth_path;
mod sphere;
mod sum;
mod tabulated;
mod truncated_cone;
mod truncated_sphere;

pub use crate::cells::ring::{Moments, Point, Ring, StressRadius};
pub use asperities::Asperities;
pub use ellipsoid::{Direction, Ellipsoid};
pub use load_curve::LoadCurve;
pub(super) use ring_sum::{InwardSum, RingSum};
pub use sum::Sum;
pub use tabulated::{InterpolationError, Tabulated};

use super::error::Error;
use super::{Elasticity, Preload, range};
use crate::cells::Cells;
use crate::cells::grid::Kink;
use crate::cells::span::Span;
use crate::numerics::double_double::DoubleDouble;
use asperities::Count;
use shape::{End, Falls, KernelOrder, Shape, ShapeFacts};
use tabulated::Reach;

/// The enum of all families and `each!`, which evaluates an expression for whichever family a profile is of.
macro_rules! profile {
    ($dollar:tt $(
        $(#[$about:meta])* $module:ident::$Family:ident,
        $(#[$about_document:meta])* $Document:ident { $($(#[$about_parameter:meta])* $parameter:ident: $RANGE:ident,)+ }
    )+) => {
        $(pub use $module::$Family;)+

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
            $($(#[$about])* $Family($Family),)+
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
        }

        macro_rules! each {
            ($dollar profile:expr, $dollar shape:ident => $dollar value:expr) => {
                match $dollar profile {
                    $(Profile::$Family($dollar shape) => $dollar value,)+
                    Profile::Tabulated($dollar shape) => $dollar value,
                    Profile::Sum($dollar shape) => $dollar value,
                    Profile::Asperities(Asperities(Count::One($dollar shape))) => $dollar value,
                    Profile::Asperities(Asperities(Count::Many($dollar shape))) => $dollar value,
                    Profile::LoadCurve($dollar shape) => $dollar value,
                    Profile::Ellipsoid(Ellipsoid { ball: $dollar shape, .. }) => $dollar value,
                }
            };
        }
    };
}
for_each_family!(profile $);

// Below the macro that it dispatches by.
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

    /// Prepares what a contact with this preload needs, while `keep_going` returns true: of a table whose slope never
    /// falls, the part that the contact reaches. Without it that is prepared when it is first needed.
    ///
    /// # Errors
    /// [`Error::Interrupted`] once `keep_going` has returned false.
    ///
    /// ```
    #[doc = include_str!("../example.txt")]
    /// assert!(setup.profile.prepare_for(&setup.preload, &setup.elasticity, &|| true).is_ok());
    /// # Ok::<(), Error>(())
    /// ```
    pub fn prepare_for(
        &self,
        preload: &Preload,
        elasticity: &Elasticity,
        keep_going: &dyn Fn() -> bool,
    ) -> Result<(), Error> {
        let Profile::Tabulated(table) = self else { return Ok(()) };
        let reach = match *preload {
            Preload::NormalForce(force) => Reach::Load(force / (2.0 * elasticity.e_star())),
            Preload::Indentation(depth) => Reach::Level(depth),
            Preload::ContactRadius(radius) => Reach::Radius(radius),
        };
        table.build_up_to(reach, keep_going)
    }

    /// g(x), m, for a radius x >= 0, m.
    #[must_use]
    pub fn level(&self, radius: f64) -> f64 {
        Shape::level(self, radius)
    }

    /// g'(x) (pure number), infinite where f' jumps.
    #[must_use]
    pub fn slope(&self, radius: f64) -> f64 {
        Shape::slope(self, radius)
    }

    /// dg/dt (pure number) at several t = sqrt(x^2 - b^2), m, above a kink b = `base`, m, or above zero.
    pub(super) fn slopes_above<const N: usize>(&self, base: f64, t: [f64; N]) -> [f64; N] {
        Shape::slopes(self, base, t)
    }

    /// The largest radius below `radius`, m, at which g is not analytic; zero, the tip, if there is none.
    pub(super) fn kink_below(&self, radius: f64) -> f64 {
        Shape::kink_below(self, radius)
    }

    /// X(y), m, for a level y >= 0, m; X(0) is the radius of a flat core. Beyond the end of the profile it stays at
    /// [`Profile::limit_radius`].
    #[must_use]
    pub fn radius(&self, level: f64) -> f64 {
        Shape::square(self, level.into()).value().sqrt()
    }

    /// The level with its radius and that radius's square.
    #[must_use]
    #[inline]
    pub fn point(&self, level: DoubleDouble) -> Point {
        // A move on a sphere is so short that a call counts.
        let square = if let Profile::Sphere(sphere) = self { sphere.square(level) } else { Shape::square(self, level) };
        Point { level, radius: square.value().sqrt(), square }
    }

    /// The indentation d, m, at which int_0^d X(y) dy = F_N/(2 E*) = `load`, m^2.
    #[must_use]
    pub fn indentation_for(&self, load: f64) -> f64 {
        Shape::indentation_for(self, load)
    }

    /// The radius, m, that every contact must stay below: where the exact sphere is vertical, where a table ends or its
    /// g falls. A punch's edge is no such limit.
    #[must_use]
    pub fn limit_radius(&self) -> Option<f64> {
        self.facts().limit.map(|end| end.radius)
    }

    /// The radius, m, of a vertical edge, which the contact keeps under every higher load.
    #[must_use]
    pub fn rim_radius(&self) -> Option<f64> {
        self.facts().rim
    }

    /// Checks a contact radius and returns it.
    ///
    /// # Errors
    /// If it is not below [`Profile::limit_radius`]: [`Error::NotConvexEnough`] where g falls from there on,
    /// [`Error::BeyondProfile`] where the profile ends.
    pub fn check_radius(&self, radius: f64) -> Result<f64, Error> {
        match self.facts().limit {
            Some(End { radius: limit, falls: true }) if radius >= limit => {
                Err(Error::NotConvexEnough { radius: limit })
            }
            Some(End { radius: limit, falls: false }) if radius >= limit => Err(Error::BeyondProfile { radius, limit }),
            _ => Ok(radius),
        }
    }

    /// How many times larger than g at the radius `x`, m, the parts are that it is the sum of: what their rounding
    /// grows by.
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
        Shape::surface_slope(self, r)
    }

    /// The radius of curvature, m, where the shape is given by one: the smallest of a sum.
    #[must_use]
    pub fn curvature_radius(&self) -> Option<f64> {
        self.facts().curvature_radius
    }

    /// Whether the kernel up to any radius falls with r, so that pressure does too. It lets the search for the peaks of
    /// the shear stress skip intervals without any; `false` is always safe.
    ///
    /// K(r, c) = int g'(x)/x dv, v = sqrt(x^2 - r^2), over 0 to sqrt(c^2 - r^2): it falls wherever g'/x does not rise.
    #[must_use]
    pub fn kernel_falls(&self) -> bool {
        self.facts().kernel_falls
    }

    /// What is known of the kernel up to c = `outer`, m, from r = `inner`, m, on. With q = g'/x as a function of x^2
    /// and v = sqrt(c^2 - r^2), -2 v dK/d(r^2) is q(c^2) - 2 v int q'(r^2 + t^2) dt over t up to v: above zero the
    /// kernel falls there.
    ///
    /// Where q neither falls nor bends upward, dK/d(r^2) falls all the way from `inner` to c, since its derivative with
    /// respect to r^2 is int q'' dt - q'(c^2)/(2 v) - q(c^2)/(4 v^3).
    pub(super) fn falls(&self, inner: f64, outer: f64) -> Falls {
        Shape::falls(self, inner, outer)
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
        let Profile::Sum(sum) = self else { return self.facts().singular.into_iter().collect() };
        let mut radii: Vec<f64> = sum.parts().iter().flat_map(Profile::singular_radii).collect();
        radii.sort_by(f64::total_cmp);
        radii.dedup_by(|a, b| a.to_bits() == b.to_bits());
        radii
    }

    /// The radii, m, above zero and below `radius` at which g is not analytic, increasing: ends of a flat, knots of a
    /// table. Stresses are log-infinite there, or their derivatives are.
    #[must_use]
    pub fn knots_below(&self, radius: f64) -> Vec<f64> {
        let below = |knot: f64| Some(Shape::kink_below(self, knot)).filter(|&next| next > 0.0 && next < knot);
        let mut knots: Vec<f64> = std::iter::successors(below(radius), |&knot| below(knot)).collect();
        knots.reverse();
        knots
    }

    /// Whether stresses are analytic in r^2 at the centre if the surface slips there.
    #[must_use]
    pub fn smooth_centre(&self) -> bool {
        self.facts().smooth_centre
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

/// Implements [`Shape`] for [`Profile`] by the family's own methods.
macro_rules! dispatch {
    ($($method:ident($($argument:ident: $Type:ty),*) -> $Result:ty;)+) => {
        impl Shape for Profile {
            fn slopes<const N: usize>(&self, base: f64, t: [f64; N]) -> [f64; N] {
                each!(self, shape => Shape::slopes(shape, base, t))
            }
            fn celled(&self, radius: f64) -> Option<&Cells> {
                each!(self, shape => Shape::celled(shape, radius))
            }
            $(fn $method(&self, $($argument: $Type),*) -> $Result {
                each!(self, shape => Shape::$method(shape, $($argument),*))
            })+
        }
    };
}
dispatch! {
    level(radius: f64) -> f64;
    slope(radius: f64) -> f64;
    surface_slope(r: f64) -> f64;
    facts() -> ShapeFacts;
    kinks() -> Vec<Kink>;
    kink_below(radius: f64) -> f64;
    square(level: DoubleDouble) -> DoubleDouble;
    load(radius: f64) -> f64;
    indentation_for(load: f64) -> f64;
    rise(span: &Span) -> f64;
    gap(ring: &Ring, depth: f64) -> f64;
    moments(span: &Span, top: f64) -> Moments;
    kernel(order: KernelOrder, at: &StressRadius, span: &Span) -> f64;
    falls(inner: f64, outer: f64) -> Falls;
}
