//! A g that is a polynomial in x without a negative coefficient: a sum of parabolas, cones and whole powers.
//!
//! Differences are taken by divided differences, sums of positive terms. g is convex, so that Newton's steps from above
//! come down on X(y); the rule of eight points integrates h^2 exactly, up to a degree of seven for g.

use super::power_law::root;
use super::{Moments, Profile, Ring, Span};
use crate::numerics::gauss::{EIGHT_POINTS, first_and_second};
use crate::numerics::roots::{descend, distance_below};

/// The largest degree.
const MOST: usize = 7;
/// Differences of squares above this, over the outer one, are those of the levels to round-off; and what two steps of
/// Newton's make so.
const PLAIN: f64 = 0.2;
const NEARLY: f64 = 1e-6;

/// g = sum of c_k x^k from k = 1 on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Polynomial {
    /// c_1 and so on, m^(1-k); zero beyond the degree.
    coefficients: [f64; MOST],
    degree: usize,
}

impl Polynomial {
    /// The sum of the g of `parts`, if each is such a polynomial.
    pub(super) fn of(parts: &[Profile]) -> Option<Polynomial> {
        let mut sum = Polynomial { coefficients: [0.0; MOST], degree: 0 };
        for part in parts {
            let slopes = match part {
                Profile::Sphere(_) | Profile::Cone(_) | Profile::PowerLaw(_) => part.slope_series(1.0)?,
                _ => return None,
            };
            sum.degree = sum.degree.max(slopes.len());
            for (k, slope) in slopes.into_iter().enumerate() {
                *sum.coefficients.get_mut(k)? += slope / (k + 1) as f64;
            }
        }
        Some(sum)
    }

    /// Q and Q' at x, g being x Q.
    fn quotient(&self, x: f64) -> (f64, f64) {
        self.coefficients[..self.degree]
            .iter()
            .rev()
            .fold((0.0, 0.0), |(value, slope), coefficient| (value * x + coefficient, slope * x + value))
    }

    /// g, m.
    pub(super) fn level(&self, x: f64) -> f64 {
        x * self.quotient(x).0
    }

    /// g'.
    pub(super) fn slope(&self, x: f64) -> f64 {
        let (value, slope) = self.quotient(x);
        value + x * slope
    }

    /// X(y), m, from the least radius at which one of the terms is y.
    pub(super) fn radius(&self, level: f64) -> f64 {
        let terms = (1..).zip(&self.coefficients[..self.degree]).filter(|(_, coefficient)| **coefficient > 0.0);
        let above = terms.map(|(order, coefficient)| root(level / coefficient, order)).fold(f64::INFINITY, f64::min);
        descend(above, |x| {
            let (value, slope) = self.quotient(x);
            (x * value - level, value + x * slope)
        })
    }

    /// The rises from radii that lie `below` the outer one.
    fn rises<const N: usize>(&self, outer: f64, below: [f64; N]) -> [f64; N] {
        let (mut value, mut differences) = (0.0, [0.0; N]);
        for coefficient in self.coefficients[..self.degree].iter().rev() {
            for (difference, below) in differences.iter_mut().zip(below) {
                *difference = *difference * (outer - below) + value;
            }
            value = value * outer + coefficient;
        }
        std::array::from_fn(|index| below[index] * (value + (outer - below[index]) * differences[index]))
    }

    /// g over a span, to round-off of itself.
    pub(super) fn rise(&self, span: &Span) -> f64 {
        self.rises(span.outer_radius, [span.width()])[0]
    }

    /// Difference of the squares of the radii over a ring of this depth.
    pub(super) fn gap(&self, ring: &Ring, depth: f64) -> f64 {
        let (outer, plain) = (ring.outer.radius, (ring.outer.square - ring.inner.square).value());
        let square = ring.outer.square.value();
        if plain > PLAIN * square {
            return plain;
        }
        let near = plain > NEARLY * square;
        let start = if near { plain / (ring.inner.radius + outer) } else { depth / self.slope(outer) };
        let fall = |width: f64| (self.rises(outer, [width])[0], self.slope(outer - width));
        let width = distance_below(start.min(0.5 * outer), outer, depth, fall);
        width * (2.0 * outer - width)
    }

    /// The moments over a span.
    pub(super) fn moments(&self, span: &Span) -> Moments {
        let width = span.width();
        let h = self.rises(span.outer_radius, EIGHT_POINTS.map(|(u, _)| width * u));
        let (first, second) = first_and_second(&EIGHT_POINTS, h);
        Moments { width, first: width * first, second: width * second }
    }
}
