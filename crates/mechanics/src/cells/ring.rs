//! The arguments of the functions of a profile: levels, rings between two of them, and radii of stress.

use std::cmp::Ordering;

use crate::numerics::double_double::DoubleDouble;

/// A level, with the radius that belongs to it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Point {
    /// y = g(x), m, with twice the digits.
    pub level: DoubleDouble,
    /// x = X(y), m.
    pub radius: f64,
    /// x^2, m^2, as exact as the family can give it: stresses have a cusp at x that turns an error e into sqrt(e).
    pub square: DoubleDouble,
}

/// The part of the contact between two levels, `inner` the nearer to the centre.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
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

/// A radius at which a stress is evaluated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StressRadius {
    /// r, m.
    pub radius: f64,
    /// r^2, m^2, exact.
    pub square: DoubleDouble,
}

impl StressRadius {
    /// The radius r, m.
    #[must_use]
    pub fn new(radius: f64) -> StressRadius {
        StressRadius { radius, square: DoubleDouble::square_of(radius) }
    }

    /// The radii r, m.
    pub(crate) fn of_all(radii: &[f64]) -> Vec<StressRadius> {
        radii.iter().map(|&radius| StressRadius::new(radius)).collect()
    }

    /// The indices of radii from the smallest on: neighbours share what is near to them.
    pub(crate) fn rising(radii: &[StressRadius]) -> Vec<usize> {
        let mut order: Vec<usize> = (0..radii.len()).collect();
        // In an annulus that is thin enough all squares begin with the same digits.
        order.sort_by(|&a, &b| radii[a].square.partial_cmp(&radii[b].square).unwrap_or(Ordering::Equal));
        order
    }

    /// The radius of `point`, to all the digits of its square.
    #[must_use]
    pub fn of_point(point: &Point) -> StressRadius {
        StressRadius { radius: point.radius, square: point.square }
    }
}

impl Point {
    /// A level with its radius, m, and the square of that.
    pub(crate) fn new(level: DoubleDouble, radius: f64) -> Point {
        Point { level, radius, square: DoubleDouble::square_of(radius) }
    }
}

impl Ring {
    /// The ring between two points of one profile.
    #[must_use]
    pub fn between(inner: Point, outer: Point) -> Ring {
        Ring { inner, outer, depth: (outer.level - inner.level).value() }
    }
}
