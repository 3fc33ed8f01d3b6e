//! The shape of the indenter, as the few functions that the solver asks of it.
//!
//! By the method of dimensionality reduction a profile z = f(r) is known through g(x) = x int_0^x f'(r)/sqrt(x^2 - r^2) dr.
//! A *level* y is a value of g, a *radius* x its inverse X(y); a level beyond the last radius (a vertical edge) keeps that
//! radius. All that follows — normal contact, memory, stresses — reads a profile through rings between two levels, so no
//! other module knows which family it deals with.

mod sphere;

pub use sphere::Sphere;

use super::double::Double;

/// A closed set of families: one variant a file.
#[derive(Clone, Debug, PartialEq)]
pub enum Profile {
    /// Hertz's parabola.
    Sphere(Sphere),
}

/// A level, with the radius that belongs to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// y = g(x), m, with twice the digits.
    pub level: Double,
    /// x = X(y), m.
    pub radius: f64,
    /// x^2, m^2, as exact as the family can give it: stresses have a cusp at x that turns an error e into sqrt(e).
    pub square: Double,
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
    pub square: Double,
}

impl At {
    /// The radius r, m.
    #[must_use]
    pub fn radius(radius: f64) -> At {
        At { radius, square: Double::square_of(radius) }
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
        match self {
            Profile::Sphere(sphere) => sphere.level(radius),
        }
    }

    /// X(y), m, for a level y >= 0, m; X(0) is the radius of a flat core.
    #[must_use]
    pub fn radius(&self, level: f64) -> f64 {
        match self {
            Profile::Sphere(sphere) => sphere.radius(level),
        }
    }

    /// The level with its radius and that radius's square.
    #[must_use]
    pub fn point(&self, level: Double) -> Point {
        match self {
            Profile::Sphere(sphere) => sphere.point(level),
        }
    }

    /// The integrals over a ring, each to round-off of itself however thin the ring is.
    #[must_use]
    pub fn moments(&self, ring: &Ring) -> Moments {
        match self {
            Profile::Sphere(sphere) => sphere.moments(ring),
        }
    }

    /// int dy / sqrt(X(y)^2 - r^2) over the levels of the ring whose radius is above r (pure number): the ring's share of a
    /// stress. For a smooth profile this is K(r, x_outer) - K(r, max(r, x_inner)), K(r, c) = int_r^c g'(x)/sqrt(x^2 - r^2) dx.
    #[must_use]
    pub fn kernel(&self, at: &At, ring: &Ring) -> f64 {
        match self {
            Profile::Sphere(sphere) => sphere.kernel(at, ring),
        }
    }

    /// The derivative of [`Profile::kernel`] with respect to r^2, 1/m^2, taken from the right where r is the inner radius.
    #[must_use]
    pub fn kernel_slope(&self, at: &At, ring: &Ring) -> f64 {
        match self {
            Profile::Sphere(sphere) => sphere.kernel_slope(at, ring),
        }
    }

    /// Whether the kernel up to any radius falls with r, so that pressure does too. It lets the search for the peaks of the
    /// shear stress skip what can hold none; `false` is always safe.
    #[must_use]
    pub fn kernel_falls(&self) -> bool {
        match self {
            Profile::Sphere(_) => true,
        }
    }

    /// The indentation d, m, at which int_0^d X(y) dy = F_N/(2 E*) = `load`, m^2.
    #[must_use]
    pub fn indentation_for(&self, load: f64) -> f64 {
        match self {
            Profile::Sphere(sphere) => sphere.indentation_for(load),
        }
    }
}
