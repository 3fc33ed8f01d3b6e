//! The shape of the indenter, as the few functions that the solver asks of it.
//!
//! By the method of dimensionality reduction a profile z = f(r) is known through g(x) = x int_0^x f'(r)/sqrt(x^2 - r^2) dr.
//! A *level* y is a value of g, a *radius* x its inverse X(y); a level beyond the last radius (a vertical edge) keeps that
//! radius. All that follows — normal contact, memory, stresses — reads a profile through rings between two levels, so no
//! other module knows which family it deals with.

mod angle;
mod chart;
mod cone;
#[cfg(test)]
pub(crate) mod count;
mod exact_sphere;
mod flat_punch;
pub(super) mod gauss;
mod many;
mod measured;
mod power_law;
mod roots;
mod rounded_cone;
mod rounded_punch;
mod seams;
mod shape;
mod span;
mod sphere;
mod sum;
mod tabulated;
mod truncated_cone;
mod truncated_sphere;
mod zone;

pub use cone::Cone;
pub use exact_sphere::ExactSphere;
pub use flat_punch::FlatPunch;
pub use power_law::PowerLaw;
pub use rounded_cone::RoundedCone;
pub use rounded_punch::RoundedPunch;
pub use sphere::Sphere;
pub use sum::Sum;
pub use tabulated::{Doubt, Tabulated};
pub use truncated_cone::TruncatedCone;
pub use truncated_sphere::TruncatedSphere;

use super::double_double::DoubleDouble;
use super::error::Error;
use shape::Shape;
use span::Span;

/// A closed set of families: one variant a file.
#[derive(Clone, Debug, PartialEq)]
pub enum Profile {
    /// Hertz's parabola.
    Sphere(Sphere),
    /// The sphere itself.
    ExactSphere(ExactSphere),
    /// Cone.
    Cone(Cone),
    /// Height as a power of the radius.
    PowerLaw(PowerLaw),
    /// Cylinder with a sharp edge.
    FlatPunch(FlatPunch),
    /// Cone with a flat end.
    TruncatedCone(TruncatedCone),
    /// Paraboloid with a flat end.
    TruncatedSphere(TruncatedSphere),
    /// Cylinder with a rounded edge.
    RoundedPunch(RoundedPunch),
    /// Cone with a rounded tip.
    RoundedCone(RoundedCone),
    /// A table of heights.
    Tabulated(Tabulated),
    /// Several profiles added up.
    Sum(Sum),
}

/// Evaluates an expression for whichever family it is.
macro_rules! each {
    ($profile:expr, $shape:ident => $value:expr) => {
        match $profile {
            Profile::Sphere($shape) => $value,
            Profile::ExactSphere($shape) => $value,
            Profile::Cone($shape) => $value,
            Profile::PowerLaw($shape) => $value,
            Profile::FlatPunch($shape) => $value,
            Profile::TruncatedCone($shape) => $value,
            Profile::TruncatedSphere($shape) => $value,
            Profile::RoundedPunch($shape) => $value,
            Profile::RoundedCone($shape) => $value,
            Profile::Tabulated($shape) => $value,
            Profile::Sum($shape) => $value,
        }
    };
}

/// A level, with the radius that belongs to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// y = g(x), m, with twice the digits.
    pub level: DoubleDouble,
    /// x = X(y), m.
    pub radius: f64,
    /// x^2, m^2, as exact as the family can give it: stresses have a cusp at x that turns an error e into sqrt(e).
    pub square: DoubleDouble,
}

/// The part of the contact between two levels, `inner` the nearer to the centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ring {
    /// The lower level.
    pub inner: Point,
    /// The upper level.
    pub outer: Point,
    /// Difference of the levels, m, exact even where they nearly agree.
    pub depth: f64,
}

/// Integrals over the radii of a ring, with h(x) = y_outer - g(x) >= 0.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Moments {
    /// int dx, m.
    pub width: f64,
    /// int h dx, m^2.
    pub first: f64,
    /// int h^2 dx, m^3.
    pub second: f64,
}

/// A radius at which a stress is asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct At {
    /// r, m.
    pub radius: f64,
    /// r^2, m^2, exact.
    pub square: DoubleDouble,
}

impl At {
    /// The radius r, m.
    #[must_use]
    pub fn radius(radius: f64) -> At {
        At { radius, square: DoubleDouble::square_of(radius) }
    }

    /// The radius of `point`, to all the digits of its square.
    #[must_use]
    pub fn point(point: &Point) -> At {
        At { radius: point.radius, square: point.square }
    }
}

impl Ring {
    /// The ring between two points of one profile.
    #[must_use]
    pub fn between(inner: Point, outer: Point) -> Ring {
        Ring { inner, outer, depth: (outer.level - inner.level).value() }
    }
}

impl Profile {
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

    /// The largest radius below `radius`, m, at which g is not analytic; nought, the tip, if there is none.
    pub(super) fn kink_below(&self, radius: f64) -> f64 {
        Shape::kink_below(self, radius)
    }

    /// X(y), m, for a level y >= 0, m; X(0) is the radius of a flat core. Beyond the end of the profile it stays at
    /// [`Profile::limit_radius`].
    #[must_use]
    pub fn radius(&self, level: f64) -> f64 {
        Shape::radius(self, level)
    }

    /// The level with its radius and that radius's square.
    #[must_use]
    pub fn point(&self, level: DoubleDouble) -> Point {
        let square = Shape::square(self, level);
        Point { level, radius: square.value().sqrt(), square }
    }

    /// The integrals over a ring, each to round-off of itself however thin the ring is.
    #[must_use]
    pub fn moments(&self, ring: &Ring) -> Moments {
        #[cfg(test)]
        count::add(|calls| &mut calls.moments);
        each!(self, shape => {
            let span = shape.span(ring);
            Moments::stack(shape.moments(&span), Moments::default(), span.edge)
        })
    }

    /// int dy / sqrt(X(y)^2 - r^2) over the levels of the ring whose radius is above r (pure number): the ring's share of a
    /// stress. For a smooth profile this is K(r, x_outer) - K(r, max(r, x_inner)), K(r, c) = int_r^c g'(x)/sqrt(x^2 - r^2) dx.
    /// Infinite at the tip of a cone, where f' jumps, and at a vertical edge; never NaN.
    #[must_use]
    pub fn kernel(&self, at: &At, ring: &Ring) -> f64 {
        #[cfg(test)]
        count::add(|calls| &mut calls.kernel);
        each!(self, shape => {
            let span = shape.span(ring);
            let face = shape.kernel(at, &span);
            if span.edge > 0.0 { face + edge(at, &span) } else { face }
        })
    }

    /// The derivative of [`Profile::kernel`] with respect to r^2, 1/m^2, taken from the right where r is the inner radius.
    #[must_use]
    pub fn kernel_slope(&self, at: &At, ring: &Ring) -> f64 {
        #[cfg(test)]
        count::add(|calls| &mut calls.kernel_slope);
        each!(self, shape => {
            let span = shape.span(ring);
            let face = shape.kernel_slope(at, &span);
            if span.edge > 0.0 { face + edge_slope(at, &span) } else { face }
        })
    }

    /// int (y_outer - g(x)) dx / sqrt(r^2 - x^2) over the radii x of the ring below r, m: the ring's share of the displacement
    /// of the surface at r.
    #[must_use]
    pub fn lift(&self, at: &At, ring: &Ring) -> f64 {
        #[cfg(test)]
        count::add(|calls| &mut calls.lift);
        each!(self, shape => {
            let span = shape.span(ring);
            let face = shape.lift(at, &span);
            if span.edge > 0.0 { face + span.edge * span.arc(at) } else { face }
        })
    }

    /// int dx / sqrt(r^2 - x^2) over the radii x of the ring below r (pure number). What lies inside X(0), a flat core, belongs
    /// to no ring: there it is asin(min(1, X(0)/r)).
    #[must_use]
    pub fn arc(&self, at: &At, ring: &Ring) -> f64 {
        each!(self, shape => shape.span(ring).arc(at))
    }

    /// The indentation d, m, at which int_0^d X(y) dy = F_N/(2 E*) = `load`, m^2.
    #[must_use]
    pub fn indentation_for(&self, load: f64) -> f64 {
        Shape::indentation_for(self, load)
    }

    /// The radius, m, that every contact must stay below: where the exact sphere is vertical, where a table ends or its g falls.
    /// A punch's edge is no such limit.
    #[must_use]
    pub fn limit_radius(&self) -> Option<f64> {
        self.limit().map(|(radius, _)| radius)
    }

    /// The radius, m, of a vertical edge, which the contact keeps under every higher load.
    #[must_use]
    pub fn rim_radius(&self) -> Option<f64> {
        Shape::rim(self).map(|(radius, _)| radius)
    }

    /// Gives a contact radius back.
    ///
    /// # Errors
    /// If it is not below [`Profile::limit_radius`]: [`Error::NotConvexEnough`] where g falls from there on,
    /// [`Error::BeyondProfile`] where the profile ends.
    pub fn check_radius(&self, radius: f64) -> Result<f64, Error> {
        match self.limit() {
            Some((limit, falls)) if radius >= limit => Err(if falls {
                Error::NotConvexEnough { radius: limit }
            } else {
                Error::BeyondProfile { radius, limit }
            }),
            _ => Ok(radius),
        }
    }

    /// The limit, and whether it is there because g falls.
    fn limit(&self) -> Option<(f64, bool)> {
        match self {
            Profile::Tabulated(table) => Some(table.limit()),
            Profile::Sum(sum) => sum.limit(),
            _ => self.reach(),
        }
    }

    /// How far, m, g is known, though it may fall before, and whether it ends because it falls.
    fn reach(&self) -> Option<(f64, bool)> {
        match self {
            Profile::ExactSphere(sphere) => Some((sphere.limit(), false)),
            Profile::Tabulated(table) => Some(table.reach()),
            Profile::Sum(sum) => sum.limit(),
            _ => None,
        }
    }

    /// Whether g falls somewhere within its reach.
    fn falls_within(&self) -> bool {
        matches!(self, Profile::Tabulated(table) if table.falls_within())
    }

    /// The radius, m, of a flat core.
    fn foot(&self) -> f64 {
        match self {
            Profile::Tabulated(table) => table.foot(),
            _ => self.radius(0.0),
        }
    }

    /// How many times larger than g at the radius `x`, m, the parts are that it is the sum of: what their rounding grows by.
    #[must_use]
    pub fn cancellation(&self, x: f64) -> f64 {
        match self {
            Profile::Sum(sum) if sum.parts().iter().any(Profile::falls_within) => {
                let grown = |f: &dyn Fn(&Profile) -> f64| {
                    let (sum, sizes) =
                        sum.parts().iter().map(f).fold((0.0, 0.0), |(a, b), part| (a + part, b + part.abs()));
                    if sum > 0.0 { sizes / sum } else { 1.0 }
                };
                grown(&|part| part.level(x)).max(grown(&|part| part.slope(x)))
            }
            _ => 1.0,
        }
    }
}

/// What the levels at a vertical edge add to a kernel.
fn edge(at: &At, span: &Span) -> f64 {
    let square = (span.outer - at.square).value();
    if square < 0.0 { 0.0 } else { span.edge / square.sqrt() }
}

/// What they add to its slope.
fn edge_slope(at: &At, span: &Span) -> f64 {
    let square = (span.outer - at.square).value();
    if square < 0.0 { 0.0 } else { 0.5 * span.edge / square / square.sqrt() }
}

impl Shape for Profile {
    fn level(&self, radius: f64) -> f64 {
        each!(self, shape => Shape::level(shape, radius))
    }

    fn slope(&self, radius: f64) -> f64 {
        each!(self, shape => Shape::slope(shape, radius))
    }

    fn radius(&self, level: f64) -> f64 {
        each!(self, shape => Shape::radius(shape, level))
    }

    fn square(&self, level: DoubleDouble) -> DoubleDouble {
        each!(self, shape => Shape::square(shape, level))
    }

    fn load(&self, radius: f64) -> f64 {
        each!(self, shape => Shape::load(shape, radius))
    }

    fn indentation_for(&self, load: f64) -> f64 {
        each!(self, shape => Shape::indentation_for(shape, load))
    }

    fn rise(&self, span: &Span) -> f64 {
        each!(self, shape => Shape::rise(shape, span))
    }

    fn rim(&self) -> Option<(f64, f64)> {
        each!(self, shape => Shape::rim(shape))
    }

    fn kink_below(&self, radius: f64) -> f64 {
        each!(self, shape => Shape::kink_below(shape, radius))
    }

    fn analytic_tip(&self) -> bool {
        each!(self, shape => Shape::analytic_tip(shape))
    }

    fn ceiling(&self) -> f64 {
        each!(self, shape => Shape::ceiling(shape))
    }

    fn power(&self) -> f64 {
        each!(self, shape => Shape::power(shape))
    }

    fn kernel(&self, at: &At, span: &Span) -> f64 {
        each!(self, shape => Shape::kernel(shape, at, span))
    }

    fn kernel_slope(&self, at: &At, span: &Span) -> f64 {
        each!(self, shape => Shape::kernel_slope(shape, at, span))
    }
}
