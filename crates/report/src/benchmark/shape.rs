//! The shapes of the scenes for the reference: closed forms and power series, in double-double arithmetic.
//!
//! Independent of the profiles of the engine: only the arithmetic is shared.

use stickslip_mechanics::DoubleDouble;

/// Terms of the series of the exact sphere: with a/R up to 0.15 the first left out is below 1e-35.
const TERMS: usize = 22;
/// The most steps of Newton's method, far more than it needs.
const MAX_STEPS: usize = 60;

/// A shape by its g(x), for x from zero to the edge.
#[derive(Clone, Debug)]
pub(super) enum Shape {
    /// g = sum of c_k x^(2k), k from the first number on: coefficients in order.
    Even(usize, Vec<DoubleDouble>),
    /// g = s x.
    Cone(DoubleDouble),
}

/// pi to 32 digits.
pub(super) fn pi() -> DoubleDouble {
    DoubleDouble::sum(std::f64::consts::PI, 1.224_646_799_147_353_2e-16)
}

fn whole(number: usize) -> DoubleDouble {
    DoubleDouble::from(number as f64)
}

impl Shape {
    /// f = r^2/2R: g = x^2/R.
    pub(super) fn parabola(radius: f64) -> Shape {
        Shape::Even(1, vec![DoubleDouble::from(1.0).over(DoubleDouble::from(radius))])
    }

    /// f = c r^4: g = (8/3) c x^4.
    pub(super) fn fourth_power(coefficient: f64) -> Shape {
        Shape::Even(2, vec![(DoubleDouble::from(coefficient) * 8.0).over(DoubleDouble::from(3.0))])
    }

    /// f = R - sqrt(R^2 - r^2): g = x artanh(x/R).
    pub(super) fn sphere(radius: f64) -> Shape {
        let radius = DoubleDouble::from(radius);
        let mut power = radius;
        let mut terms = Vec::with_capacity(TERMS);
        for k in 1..=TERMS {
            terms.push(DoubleDouble::from(1.0).over(power * whole(2 * k - 1)));
            power = power * radius * radius;
        }
        Shape::Even(1, terms)
    }

    /// f = T r: g = (pi/2) T x.
    pub(super) fn cone(slope: f64) -> Shape {
        Shape::Cone(pi() * (0.5 * slope))
    }

    /// g(x), m.
    pub(super) fn level(&self, x: DoubleDouble) -> DoubleDouble {
        match self {
            Shape::Cone(slope) => *slope * x,
            Shape::Even(..) => self.even_series(x, |_| DoubleDouble::from(1.0)),
        }
    }

    /// int_0^x g dx, m^2.
    pub(super) fn integral(&self, x: DoubleDouble) -> DoubleDouble {
        match self {
            Shape::Cone(slope) => *slope * x * x * 0.5,
            Shape::Even(..) => self.even_series(x, |k| DoubleDouble::from(1.0).over(whole(2 * k + 1))) * x,
        }
    }

    /// g'(x), a pure number.
    fn slope(&self, x: DoubleDouble) -> DoubleDouble {
        match self {
            Shape::Cone(slope) => *slope,
            Shape::Even(..) => self.even_series(x, |k| whole(2 * k)).over(x),
        }
    }

    /// The sum of f(k) c_k x^(2k).
    fn even_series(&self, x: DoubleDouble, factor: impl Fn(usize) -> DoubleDouble) -> DoubleDouble {
        let Shape::Even(first, terms) = self else { return DoubleDouble::ZERO };
        let square = x * x;
        let summed = terms
            .iter()
            .enumerate()
            .rev()
            .fold(DoubleDouble::ZERO, |sum, (at, c)| sum * square + *c * factor(first + at));
        (0..*first).fold(summed, |value, _| value * square)
    }

    /// The x of a level, m.
    pub(super) fn radius(&self, level: DoubleDouble) -> DoubleDouble {
        if level.value() <= 0.0 {
            return DoubleDouble::ZERO;
        }
        match self {
            Shape::Cone(slope) => level.over(*slope),
            Shape::Even(first, terms) => {
                // g is convex and not below its first term, so that Newton's method converges from above.
                let mut x = DoubleDouble::from((level.value() / terms[0].value()).powf(0.5 / *first as f64));
                for _ in 0..MAX_STEPS {
                    let step = (self.level(x) - level).over(self.slope(x));
                    x = x - step;
                    if step.value().abs() <= 1e-20 * x.value() {
                        break;
                    }
                }
                x
            }
        }
    }

    /// int_r^x g'(t)/sqrt(t^2 - r^2) dt, a pure number; zero for x <= r.
    pub(super) fn kernel(&self, r: f64, x: DoubleDouble) -> DoubleDouble {
        let square = DoubleDouble::square_of(r);
        let excess = x * x - square;
        if excess.value() <= 0.0 {
            return DoubleDouble::ZERO;
        }
        let root = excess.sqrt();
        match self {
            // The logarithm of 1 + (x - r + root)/r is arcosh(x/r).
            Shape::Cone(slope) => *slope * logarithm((x + root).over(DoubleDouble::from(r))),
            Shape::Even(first, terms) => {
                // J_k = int t^(2k-1)/sqrt(t^2 - r^2) dt = (x^(2k-2) root + (2k-2) r^2 J_(k-1))/(2k-1).
                let outer = x * x;
                let (mut integral, mut power, mut sum) =
                    (DoubleDouble::ZERO, DoubleDouble::from(1.0), DoubleDouble::ZERO);
                for k in 1..first + terms.len() {
                    integral = (power * root + square * integral * whole(2 * k - 2)).over(whole(2 * k - 1));
                    power = power * outer;
                    if let Some(at) = k.checked_sub(*first) {
                        sum = sum + terms[at] * integral * whole(2 * k);
                    }
                }
                sum
            }
        }
    }
}

/// ln x for x >= 1: one step of Halley's method from the ordinary logarithm.
fn logarithm(x: DoubleDouble) -> DoubleDouble {
    let start = DoubleDouble::from(x.value().ln());
    let back = exponential(start);
    start + ((x - back) * 2.0).over(x + back)
}

/// e^x: a short series for x/1024, squared ten times.
fn exponential(x: DoubleDouble) -> DoubleDouble {
    let small = x * (1.0 / 1024.0);
    let series =
        (1..=14).rev().fold(DoubleDouble::from(1.0), |sum, k| DoubleDouble::from(1.0) + (sum * small).over(whole(k)));
    (0..10).fold(series, |power, _| power * power)
}

#[cfg(test)]
mod tests {
    use super::{DoubleDouble, Shape, exponential, logarithm, pi};

    #[test]
    fn logarithms_and_exponentials_are_known_to_thirty_digits() {
        // e and ln 2, rounded twice.
        let e = DoubleDouble::sum(std::f64::consts::E, 1.445_646_891_729_250_2e-16);
        assert!((exponential(DoubleDouble::from(1.0)) - e).abs().value() < 1e-28);
        let two = DoubleDouble::sum(std::f64::consts::LN_2, 2.319_046_813_846_299_6e-17);
        assert!((logarithm(DoubleDouble::from(2.0)) - two).abs().value() < 1e-28);
        assert!((logarithm(e) - DoubleDouble::from(1.0)).abs().value() < 1e-28);
    }

    #[test]
    fn a_radius_has_its_level() {
        for shape in [Shape::parabola(0.013), Shape::fourth_power(7e5), Shape::sphere(0.013), Shape::cone(0.07)] {
            for x in [1e-9, 1.3e-4, 1.5e-3] {
                let there = DoubleDouble::from(x);
                let back = shape.radius(shape.level(there));
                assert!((back - there).abs().value() < 1e-29 * x.max(1e-4), "{shape:?} at {x}");
            }
        }
    }

    #[test]
    fn kernels_are_those_of_the_pressures_in_the_books() {
        let (r, a) = (3e-4, DoubleDouble::from(1e-3));
        let root = (a * a - DoubleDouble::square_of(r)).sqrt();
        let hertz = root * 2.0;
        assert!((Shape::parabola(1.0).kernel(r, a) - hertz).abs().value() < 1e-34);
        // Sneddon: arcosh for the cone.
        let cone = pi() * 0.5 * logarithm((a + root).over(DoubleDouble::from(r)));
        assert!((Shape::cone(1.0).kernel(r, a) - cone).abs().value() < 1e-29);
        assert!((cone.value() - std::f64::consts::FRAC_PI_2 * (1e-3 / r).acosh()).abs() < 1e-14);
        // A ball differs from its parabola by the second term, g = x^4/(3 R^3), and less.
        let (ball, radius) = (Shape::sphere(1.0).kernel(r, a).value(), 1e-3_f64);
        let second = 4.0 / 3.0 * (root.value().powi(3) / 3.0 + r * r * root.value());
        assert!((ball - hertz.value() - second).abs() < radius.powi(5));
    }
}
