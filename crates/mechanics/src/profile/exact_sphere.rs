//! Exact sphere, f = R - sqrt(R^2 - r^2): g(x) = x artanh(x/R), int x dg = ((R^2 + x^2) artanh(x/R) - x R)/2 (Segedin
//! 1957).
//!
//! With x = R tanh(sigma): g = R sigma tanh(sigma), all of it smooth for |Im sigma| < pi/2. For the kernel let C =
//! sqrt(R^2 - x^2), D = sqrt(R^2 - r^2), q = x/C = sinh(sigma) and sinh(s) = sqrt(x^2 - r^2)/C; then cosh(s) = D/C and
//! K = int (R/D + asinh(q)/(q cosh s)) ds, of which only the second term needs a quadrature, at any r and up to x = R.
//! Well below the equator, short series serve: [`shallow_sphere`], [`slope_series`](super::slope_series).

use super::shallow_sphere::{self, LIMIT};
use super::shape::{End, Falls, KernelOrder, Shape, ShapeFacts};
use super::smooth_path::{self, SmoothTip};
use super::{DoubleDouble, Error, Kink, Moments, Ring, Span, StressRadius, range, slope_series};
use crate::cells::Powers;
use crate::numerics::gauss::{Singular, along_strip};
use crate::numerics::roots::{distance_below, increasing};

/// A sphere, not its osculating paraboloid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExactSphere {
    radius: f64,
}

/// A radius x in the coordinate sigma.
#[derive(Clone, Copy)]
struct SpherePlace {
    x: f64,
    /// sqrt(R^2 - x^2), m.
    height: f64,
    sigma: f64,
}

impl ExactSphere {
    /// The sphere of radius R, m.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] by [`range::RADIUS`].
    pub fn new(radius: f64) -> Result<ExactSphere, Error> {
        Ok(ExactSphere { radius: range::RADIUS.check(radius)? })
    }

    /// x/R, below one even where rounding has x = R, so that levels stay finite.
    fn share(&self, radius: f64) -> f64 {
        (radius / self.radius).min(1.0 - 0.5 * f64::EPSILON)
    }

    /// artanh(x/R). Beside the equator R - x has digits that x/R has lost.
    fn sigma_at(&self, radius: f64) -> f64 {
        let share = self.share(radius);
        if share < 0.5 {
            return share.atanh();
        }
        0.5 * ((self.radius + radius) / self.gap_to_equator(radius)).ln()
    }

    /// R - x, kept off zero where rounding has x = R, so that levels stay finite.
    fn gap_to_equator(&self, radius: f64) -> f64 {
        (self.radius - radius).max(0.5 * f64::EPSILON * self.radius)
    }

    /// R^2 less a square, kept off zero where rounding has x = R.
    fn height_square(&self, square: DoubleDouble) -> f64 {
        let whole = self.radius * self.radius;
        (DoubleDouble::square_of(self.radius) - square).value().max(1e-30 * whole)
    }

    /// (x/R)^2 of a square, where series serve best.
    fn shallow(&self, square: f64) -> Option<f64> {
        Some(square / (self.radius * self.radius)).filter(|s| *s < LIMIT)
    }

    /// The coefficients of g'(a xi) in powers of xi; `None` where they are too many.
    pub(super) fn slope_series(&self, a: f64) -> Option<Vec<f64>> {
        let u = a / self.radius;
        let (mut series, mut power) = (Vec::new(), u);
        // By artanh(u) + u/(1 - u^2), up to a share of it that rounding loses.
        while power > 0.02 * f64::EPSILON * u {
            if series.len() >= slope_series::MOST_POWERS {
                return None;
            }
            series.extend([0.0, power + power / (series.len() + 1) as f64]);
            power *= u * u;
        }
        Some(series)
    }

    fn place(&self, radius: f64, square: DoubleDouble) -> SpherePlace {
        let height = self.height_square(square).sqrt();
        SpherePlace { x: radius, height, sigma: (radius / height).asinh() }
    }

    fn ends(&self, span: &Span) -> (SpherePlace, SpherePlace, f64) {
        let inner = self.place(span.inner_radius, span.inner);
        let outer = self.place(span.outer_radius, span.outer);
        let turn = (self.radius * span.width() / (inner.height * outer.height)).asinh();
        (inner, outer, turn.min(outer.sigma))
    }

    /// x_outer - x and g_outer - g where sigma is smaller by `turn`.
    fn below(&self, outer: SpherePlace, turn: f64) -> (f64, f64) {
        let sigma = outer.sigma - turn;
        let dx = outer.height * turn.sinh() / sigma.cosh();
        (dx, turn * outer.x + sigma * dx)
    }

    /// The sigma of a level.
    fn sigma(&self, level: f64) -> f64 {
        if level <= 0.0 {
            return 0.0;
        }
        let y = level / self.radius;
        let guess = if y < 1.0 { y.sqrt() * (1.0 + y / 6.0) } else { y + 0.2 };
        increasing(guess, |s| (s * s.tanh() - y, s.tanh() + s / s.cosh().powi(2)))
    }
}

/// (s - tanh s)/s.
fn shortfall(s: f64) -> f64 {
    let u = s * s;
    if u < 4e-3 {
        u * (1.0 / 3.0 - u * (2.0 / 15.0 - u * (17.0 / 315.0 - u * (62.0 / 2835.0 - u * (1382.0 / 155_925.0)))))
    } else {
        (s - s.tanh()) / s
    }
}

impl SmoothTip for ExactSphere {
    fn slope_at(&self, t: f64) -> f64 {
        self.slope(t)
    }

    fn bend_at(&self, t: f64) -> f64 {
        let u = self.share(t);
        let square = u * u;
        if square > 0.1 {
            let rest = 1.0 - square;
            return 2.0 * u / (rest * rest) - u / rest - u.atanh();
        }
        // sum over k of (4 k (k + 1)/(2k + 1)) u^(2k+1).
        let sum =
            (1..=16).rev().map(f64::from).fold(0.0, |sum, k| square * (sum + 4.0 * k * (k + 1.0) / (2.0 * k + 1.0)));
        u * sum
    }

    fn ceiling(&self) -> f64 {
        self.radius
    }
}

impl Shape for ExactSphere {
    fn level(&self, radius: f64) -> f64 {
        radius * self.sigma_at(radius)
    }

    fn slope(&self, radius: f64) -> f64 {
        let rest = self.gap_to_equator(radius) / self.radius * (1.0 + radius / self.radius);
        self.sigma_at(radius) + self.share(radius) / rest
    }

    fn square(&self, level: DoubleDouble) -> DoubleDouble {
        if level.value() < LIMIT * self.radius {
            return shallow_sphere::exact_square(self.radius, level);
        }
        let sigma = self.sigma(level.value());
        if sigma > 1.0 {
            // By R^2 - x^2 = (R/cosh(sigma))^2: beside the equator the level depends on that difference, of which a
            // rounded x has few digits.
            let height = self.radius / sigma.cosh();
            return DoubleDouble::square_of(self.radius) - DoubleDouble::square_of(height);
        }
        // R y tanh(sigma)/sigma: where a << R the factor is so near to one that its rounding does not count.
        let factor = DoubleDouble::from(1.0) - DoubleDouble::from(shortfall(sigma.max(f64::MIN_POSITIVE)));
        level * self.radius * factor
    }

    fn load(&self, radius: f64) -> f64 {
        let sigma = self.sigma_at(radius);
        0.5 * (self.radius * self.radius * sigma * shortfall(sigma.max(f64::MIN_POSITIVE)) + radius * radius * sigma)
    }

    fn indentation_for(&self, load: f64) -> f64 {
        if load <= 0.0 {
            return 0.0;
        }
        let target = 2.0 * load / self.radius / self.radius;
        let guess = (0.75 * target).cbrt().min(0.5 * target + 1.0);
        let sigma = increasing(guess, |s| {
            let tanh = s.tanh();
            (s * shortfall(s) + tanh * tanh * s - target, 2.0 * tanh * (s / s.cosh().powi(2) + tanh))
        });
        self.radius * sigma * sigma.tanh()
    }

    fn rise(&self, span: &Span) -> f64 {
        if let Some(outer) = self.shallow(span.outer.value()) {
            return self.radius * shallow_sphere::rise(outer, span.gap / (self.radius * self.radius));
        }
        let (inner, outer, turn) = self.ends(span);
        turn * outer.x + inner.sigma * span.width()
    }

    fn gap(&self, ring: &Ring, depth: f64) -> f64 {
        let plain = (ring.outer.square - ring.inner.square).value();
        if plain > 0.5 * ring.outer.square.value() {
            return plain;
        }
        let level = ring.outer.level.value();
        if level < LIMIT * self.radius {
            return self.radius * self.radius * shallow_sphere::gap_of(level / self.radius, depth / self.radius);
        }
        let outer = self.place(ring.outer.radius, ring.outer.square);
        let steepness = |sigma: f64| self.radius * (sigma.tanh() + sigma / sigma.cosh().powi(2));
        let start = (depth / steepness(outer.sigma)).min(0.5 * outer.sigma);
        let fall = |turn: f64| (self.below(outer, turn).1, steepness(outer.sigma - turn));
        let turn = distance_below(start, outer.sigma, depth, fall);
        let width = self.below(outer, turn).0;
        width * (2.0 * outer.x - width)
    }

    fn facts(&self) -> ShapeFacts {
        // Within 1e-12 of R, X no longer determines the level.
        let end = End { radius: self.radius * (1.0 - 1e-12), falls: false };
        let facts = ShapeFacts { ceiling: self.radius, curvature_radius: Some(self.radius), ..ShapeFacts::default() };
        facts.ending(Some(end))
    }

    fn moments(&self, span: &Span, _top: f64) -> Moments {
        if self.shallow(span.outer.value()).is_some() {
            let Moments { width, first, second } =
                shallow_sphere::moments(span.outer_radius / self.radius, span.width() / self.radius);
            let area = self.radius * self.radius;
            return Moments { width: width * self.radius, first: first * area, second: second * area * self.radius };
        }
        let (_, outer, length) = self.ends(span);
        // Poles of the fourth order at i pi/2: keep a margin.
        let singular = Singular { below: 1.1, above: f64::INFINITY };
        let (mut done, mut first, mut second) = (0.0, 0.0, 0.0);
        while done < length {
            let panel = singular.panel(outer.sigma - done, length - done);
            panel.visit(|below, weight| {
                let turn = done + below;
                let (_, h) = self.below(outer, turn);
                let area = weight * h * self.radius / (outer.sigma - turn).cosh().powi(2);
                first += area;
                second += area * h;
            });
            done += panel.width;
        }
        Moments { width: span.width(), first, second }
    }

    fn kernel(&self, order: KernelOrder, at: &StressRadius, span: &Span) -> f64 {
        let (inner, outer) = span.excess(at.square);
        if outer <= 0.0 {
            return 0.0;
        }
        let shallow = self.shallow(span.outer.value()).and_then(|_| self.slope_series(span.outer_radius));
        if let Some(series) = shallow {
            return slope_series::kernel(&series, order, at, span);
        }
        if order == KernelOrder::Slope {
            // At the tip gamma/t is 2/R to the last digit below 1e-9 R.
            let tip = StressRadius::new(1e-9 * span.outer_radius);
            let at = if at.radius > 0.0 || span.inner_radius > 0.0 { at } else { &tip };
            return smooth_path::kernel(self, order, at, span);
        }
        let height = self.height_square(at.square).sqrt();
        let square_outer = self.height_square(span.outer);
        let (v_low, gap) = if inner > 0.0 { (inner.sqrt(), span.gap) } else { (0.0, outer) };
        let step = gap / (v_low + outer.sqrt());
        let length = (step / (v_low + height)).ln_1p() + 0.5 * (gap / square_outer).ln_1p();
        let top = (outer / square_outer).sqrt().asinh();
        let (square, stretch) = (at.square.value() / (height * height), self.radius / height);
        // Inward from the outer end, where asinh(q)/(q cosh s) is least: the panels must not end early, so from s = low
        // on.
        let low = (top - length).max(0.0);
        let curved = along_strip(length, 1.0, f64::INFINITY, |s| {
            let s = low + s;
            let q = (square + (stretch * s.sinh()).powi(2)).sqrt();
            let angle = if q > 1e-8 { q.asinh() / q } else { 1.0 };
            angle / s.cosh()
        });
        stretch * length + curved
    }

    fn kinks(&self) -> Vec<Kink> {
        vec![Kink { radius: 0.0, powers: Powers::Odd }]
    }

    fn falls(&self, inner: f64, outer: f64) -> Falls {
        // dq/d(x^2) = (x g'' - g')/(2 x^3) only grows.
        let (share, slope) = (self.share(outer), self.slope(outer));
        let rest = (1.0 - share) * (1.0 + share);
        let steepest = 2.0 * share / (rest * rest) - slope;
        let gap = (1.0 - inner / outer) * (1.0 + inner / outer);
        Falls { least: (slope - gap * steepest) / outer, concavely: false }
    }

    fn surface_slope(&self, r: f64) -> f64 {
        r / ((self.radius - r) * (self.radius + r)).max(0.0).sqrt()
    }
}
