//! Power law f = c r^n: g = B x^n with B = kappa c, kappa = sqrt(pi) Gamma(n/2 + 1)/Gamma((n + 1)/2), int x dg = n B
//! x^(n+1)/(n + 1).
//!
//! K(r, c) = n B I_(n-1) with I_m = int x^m dx/sqrt(x^2 - r^2): for whole n by a recursion
//! ([`slope_series`](super::slope_series)) of positive terms (Galin 1946; Sneddon 1965); else over x = r cosh s; from
//! 1e8 r on, where x^2 - r^2 is x^2 to round-off, in closed form.

use super::shape::{Falls, KernelOrder, Shape, ShapeFacts};
use super::smooth_path::{self, SmoothTip};
use super::{DoubleDouble, Error, Kink, Moments, Ring, Span, StressRadius, range, slope_series};
use crate::cells::Powers;
use crate::numerics::gauss::{EIGHT_POINTS, Singular, first_and_second};
use crate::numerics::logarithm::{exp_m1, ln_1p};

/// The largest exponent for which the recursion is quicker than a quadrature.
const MOST_TERMS: u16 = 24;
/// The largest exponent n of which eight points of Gauss integrate the square of a rise, a polynomial of degree 2 n,
/// exactly.
const MOST_FOR_EIGHT: u16 = 7;
/// Where exponents get a square with twice the digits, differences of squares over that of the edge are good down to
/// this.
const RESOLVED: f64 = 1e-12;
/// The width over the outer radius up to which the moments are summed as binomial series, and times the exponent.
const SERIES: (f64, f64) = (0.3, 1.5);
/// Terms of them: more than any takes.
const MOST_OF_SERIES: i32 = 60;
/// Exponents up to half of this get a square with twice the digits.
const MOST_HALVES: i32 = 16;
/// Beyond this many r the r under the root is negligible.
const FAR: f64 = 1e8;
/// The largest exponent of which a series of few terms is made.
const STEEPEST: f64 = 16.0;

/// A body of revolution whose height is a power of the radius.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PowerLaw {
    exponent: f64,
    /// c, m^(1-n).
    coefficient: f64,
    /// B = kappa c, m^(1-n).
    scale: f64,
    /// n where it is whole and small.
    order: Option<u16>,
    /// 2n where it is whole and small.
    halves: Option<i32>,
}

impl PowerLaw {
    /// f = c r^n of exponent n and coefficient c, m^(1-n).
    ///
    /// # Errors
    /// [`Error::OutOfRange`] by [`range::EXPONENT`] and [`range::COEFFICIENT`].
    pub fn new(exponent: f64, coefficient: f64) -> Result<PowerLaw, Error> {
        let (exponent, coefficient) = (range::EXPONENT.check(exponent)?, range::COEFFICIENT.check(coefficient)?);
        let scale = kappa(exponent) * coefficient;
        let order = (1..=MOST_TERMS).find(|&n| f64::from(n).to_bits() == exponent.to_bits());
        let halves = (1..=MOST_HALVES).find(|&m| (0.5 * f64::from(m)).to_bits() == exponent.to_bits());
        Ok(PowerLaw { exponent, coefficient, scale, order, halves })
    }

    /// x^n for a whole n by products, else by logarithms.
    fn raised(x: f64, exponent: f64, order: Option<u16>) -> f64 {
        let Some(order) = order else { return x.powf(exponent) };
        let (mut power, mut square, mut rest) = (1.0, x, order);
        while rest > 0 {
            if rest % 2 > 0 {
                power *= square;
            }
            square *= square;
            rest /= 2;
        }
        power
    }

    /// X, m, of a level, m.
    fn radius(&self, level: f64) -> f64 {
        let power = level / self.scale;
        self.order.map_or_else(|| power.powf(self.exponent.recip()), |order| root(power, order))
    }

    /// (x_outer^n - x^n)/(x_outer - x) of a whole n: a sum of positive terms.
    fn chord(order: u16, outer: f64, x: f64) -> f64 {
        let (mut sum, mut power) = (1.0, 1.0);
        for _ in 1..order {
            power *= outer;
            sum = sum * x + power;
        }
        sum
    }

    /// int h dx and int h^2 dx over x_outer y and x_outer y^2, y the outer level, of a whole n up to
    /// [`MOST_FOR_EIGHT`].
    fn whole_moments(order: u16, share: f64) -> (f64, f64) {
        let (below, mut chords) = (EIGHT_POINTS.map(|(u, _)| share * u), [1.0; EIGHT_POINTS.len()]);
        for _ in 1..order {
            for (chord, below) in chords.iter_mut().zip(below) {
                *chord = *chord * (1.0 - below) + 1.0;
            }
        }
        let rises = std::array::from_fn(|index| below[index] * chords[index]);
        let (first, second) = first_and_second(&EIGHT_POINTS, rises);
        (share * first, share * second)
    }

    /// The same of any n from one on, by the series of 1 - (1 - b)^n in b; its square is twice it less that of 2 n. The
    /// terms alternate at first, up to e^(2 n share) of the sum.
    fn series_moments(n: f64, share: f64) -> (f64, f64) {
        let (mut once, mut twice) = (n * share, 2.0 * n * share);
        let (mut first, mut second) = (0.5 * once, 0.0);
        for k in 2..MOST_OF_SERIES {
            let k = f64::from(k);
            let step = share / k;
            once *= step * (k - 1.0 - n);
            twice *= step * (k - 1.0 - 2.0 * n);
            let (add, add_square) = (once / (k + 1.0), (2.0 * once - twice) / (k + 1.0));
            first += add;
            second += add_square;
            if add.abs() <= 1e-17 * first && add_square.abs() <= 1e-17 * second {
                break;
            }
        }
        (share * first, share * second)
    }

    /// ln(x_outer/x_inner) of a span.
    fn decades(span: &Span) -> f64 {
        let share = span.width() / span.outer_radius;
        if share < 0.5 { -(-share).ln_1p() } else { (span.outer_radius / span.inner_radius).ln() }
    }

    /// n B int x^(n-2) dx over a span: the kernel where r does not count.
    fn far(&self, span: &Span) -> f64 {
        let (power, decades) = (self.exponent - 1.0, Self::decades(span));
        let share = if power.abs() < 1e-300 { decades } else { -(-power * decades).exp_m1() / power };
        self.slope(span.outer_radius) * share
    }

    /// The coefficients of g'(a xi) in powers of xi, where n is whole.
    pub(super) fn slope_series(&self, a: f64) -> Option<Vec<f64>> {
        let mut series = vec![0.0; usize::from(self.order?)];
        *series.last_mut()? = self.slope(a);
        Some(series)
    }

    /// The slope at r = 0 of the kernel up to a radius: (n/2) B x^(n-3)/(n - 3), where that integral exists.
    fn kernel_slope_at_tip(&self, x: f64) -> f64 {
        let n = self.exponent;
        if x <= 0.0 {
            0.0
        } else if n > 3.0 {
            0.5 * self.slope(x) / (x * x * (n - 3.0))
        } else if self.order == Some(2) {
            -0.5 * self.slope(x) / (x * x)
        } else if n > 2.0 {
            f64::INFINITY
        } else {
            f64::NEG_INFINITY
        }
    }
}

/// The root of this order.
pub(super) fn root(power: f64, order: u16) -> f64 {
    match order {
        1 => power,
        2 => power.sqrt(),
        3 => power.cbrt(),
        4 => power.sqrt().sqrt(),
        _ => power.powf(f64::from(order).recip()),
    }
}

/// sqrt(pi) Gamma(n/2 + 1)/Gamma((n + 1)/2), by (z + 1/4)-centred ratio Gamma(z + 1/2)/Gamma(z) at large z and back by
/// Gamma(z + 1) = z Gamma(z): kappa(n) = kappa(n + 2) (n + 1)/(n + 2).
fn kappa(exponent: f64) -> f64 {
    let mut n = exponent;
    // Twenty-five roundings of the product would move every level by some units in the last place.
    let mut share = DoubleDouble::from(1.0);
    while n < 50.0 {
        share = share * DoubleDouble::from(n + 1.0).over(DoubleDouble::from(n + 2.0));
        n += 2.0;
    }
    // Gamma(z + 1/2)/Gamma(z), z = (n + 1)/2, by Tricomi and Erdelyi's series (1951) in w = z - 1/4, which holds even
    // powers alone.
    let w = 0.5 * n + 0.25;
    let u = 1.0 / (w * w);
    let series =
        1.0 + u * (1.0 / 64.0 + u * (-19.0 / 8192.0 + u * (631.0 / 524_288.0 + u * (-174_317.0 / 134_217_728.0))));
    share.value() * (std::f64::consts::PI * w).sqrt() * series
}

impl SmoothTip for PowerLaw {
    fn slope_at(&self, t: f64) -> f64 {
        self.slope(t)
    }

    fn slope_below(&self, t: f64, outer: f64, drop: f64) -> f64 {
        if drop < 0.5 * outer {
            self.slope(outer) * ((self.exponent - 1.0) * (-drop / outer).ln_1p()).exp()
        } else {
            self.slope(t)
        }
    }

    fn bend_at(&self, t: f64) -> f64 {
        (self.exponent - 2.0) * self.slope(t)
    }

    fn bend_below(&self, t: f64, outer: f64, drop: f64) -> f64 {
        (self.exponent - 2.0) * self.slope_below(t, outer, drop)
    }

    fn power(&self) -> f64 {
        self.exponent
    }
}

impl Shape for PowerLaw {
    fn level(&self, radius: f64) -> f64 {
        self.scale * Self::raised(radius, self.exponent, self.order)
    }

    fn slope(&self, radius: f64) -> f64 {
        self.exponent * self.scale * Self::raised(radius, self.exponent - 1.0, self.order.map(|order| order - 1))
    }

    fn slopes<const N: usize>(&self, base: f64, t: [f64; N]) -> [f64; N] {
        let x = if base > 0.0 { t.map(|t| (base * base + t * t).sqrt()) } else { t };
        let share = |index: usize| if base > 0.0 { t[index] / x[index] } else { 1.0 };
        if self.order.is_some() {
            // Products leave a series of whole powers fewer terms of rounding.
            return std::array::from_fn(|index| self.slope(x[index]) * share(index));
        }
        // By the powers of radii over the least of them, which a logarithm side by side is good for.
        let least = x.iter().copied().fold(f64::INFINITY, f64::min).max(f64::MIN_POSITIVE);
        let power = self.exponent - 1.0;
        let growth = exp_m1(ln_1p(x.map(|x| (x / least - 1.0).max(0.0))).map(|logarithm| power * logarithm));
        let slope = self.slope(least);
        std::array::from_fn(|index| (slope + slope * growth[index]) * share(index))
    }

    fn square(&self, level: DoubleDouble) -> DoubleDouble {
        let square = DoubleDouble::square_of(self.radius(level.value()));
        let Some(halves) = self.halves.filter(|_| square.value() > 0.0) else { return square };
        // x^n as a power of x^2, of x, or of its root.
        let (base, times) = match halves % 4 {
            0 => (square, halves / 4),
            2 => (square.sqrt(), halves / 2),
            _ => (square.sqrt().sqrt(), halves),
        };
        let reached = (1..times).fold(base, |power, _| power * base) * self.scale;
        square + square * (2.0 / self.exponent * (level - reached).value() / level.value())
    }

    fn load(&self, radius: f64) -> f64 {
        self.exponent / (self.exponent + 1.0) * self.level(radius) * radius
    }

    fn indentation_for(&self, load: f64) -> f64 {
        if load <= 0.0 {
            return 0.0;
        }
        let share = (self.exponent + 1.0) / self.exponent;
        let radius = (share * load / self.scale).powf((self.exponent + 1.0).recip());
        share * load / radius
    }

    fn rise(&self, span: &Span) -> f64 {
        if let Some(order) = self.order {
            return self.scale * span.width() * Self::chord(order, span.outer_radius, span.inner_radius);
        }
        -self.level(span.outer_radius) * (-self.exponent * Self::decades(span)).exp_m1()
    }

    fn gap(&self, ring: &Ring, depth: f64) -> f64 {
        let plain = (ring.outer.square - ring.inner.square).value();
        let resolved = if self.halves.is_some() { RESOLVED } else { 0.2 };
        if plain > resolved * ring.outer.square.value() {
            return plain;
        }
        let (inner, outer) = (ring.inner.level.value(), ring.outer.level.value());
        // A low inner level is lost in the depth, and what the inner radius lacks is lost in a high one.
        let decades =
            if inner < 0.5 * outer { (outer / inner).ln() } else { -(-depth / outer).ln_1p() } / self.exponent;
        let width = -ring.outer.radius * (-decades).exp_m1();
        width * (2.0 * ring.outer.radius - width)
    }

    fn facts(&self) -> ShapeFacts {
        ShapeFacts {
            singular: (self.exponent <= 1.0).then_some(0.0),
            power: self.exponent,
            kernel_falls: self.exponent <= 2.0,
            analytic_tip: self.order.is_some() || self.exponent >= 30.0,
            smooth_centre: self.exponent.to_bits() == 2f64.to_bits(),
            smooth_tip: self.order.is_some_and(|order| order % 2 == 0),
            by_series: self.exponent <= STEEPEST,
            ..ShapeFacts::default()
        }
    }

    fn moments(&self, span: &Span, y: f64) -> Moments {
        let (n, x, width) = (self.exponent, span.outer_radius, span.width());
        if width <= 0.0 {
            return Moments::default();
        }
        let share = width / x;
        let scaled =
            |(first, second): (f64, f64)| Moments { width, first: x * y * first, second: x * y * (y * second) };
        if let Some(order) = self.order.filter(|order| *order <= MOST_FOR_EIGHT) {
            return scaled(Self::whole_moments(order, share));
        }
        if share <= SERIES.0 && n * share <= SERIES.1 && n >= 1.0 {
            return scaled(Self::series_moments(n, share));
        }
        if share <= SERIES.0 && n * share <= 4.0 {
            let (mut first, mut second) = (0.0, 0.0);
            let singular = Singular { below: 0.0, above: f64::INFINITY };
            singular.panel(1.0, share).visit(|below, weight| {
                let h = -(n * (-below).ln_1p()).exp_m1();
                first += weight * h;
                second += weight * h * h;
            });
            return scaled((first, second));
        }
        let (q, q_level) = (1.0 - share, (-n * Self::decades(span)).exp());
        let (once, twice) = (1.0 - q * q_level, 1.0 - q * q_level * q_level);
        scaled(if n < 1.0 {
            // Over the levels, of which X is then a power above one.
            let (depth, once, twice) = (1.0 - q_level, n / (n + 1.0) * once, n / (2.0 * n + 1.0) * twice);
            (once - q * depth, 2.0 * (once - twice) - q * depth * depth)
        } else {
            let (once, twice) = (once / (n + 1.0), twice / (2.0 * n + 1.0));
            (share - once, share - 2.0 * once + twice)
        })
    }

    fn kernel(&self, order: KernelOrder, at: &StressRadius, span: &Span) -> f64 {
        let (inner, outer) = span.excess(at.square);
        if outer <= 0.0 {
            return 0.0;
        }
        if order == KernelOrder::Slope && at.radius <= 0.0 && span.inner_radius <= 0.0 {
            return self.kernel_slope_at_tip(span.outer_radius);
        }
        if let Some(series) = self.slope_series(span.outer_radius) {
            return slope_series::kernel(&series, order, at, span);
        }
        if order == KernelOrder::Slope {
            return smooth_path::kernel(self, order, at, span);
        }
        let far = FAR * at.radius;
        if (inner > 0.0 && span.inner_radius >= far) || at.square.value() <= 0.0 {
            return self.far(span);
        }
        let limit = DoubleDouble::square_of(far);
        let near = span.below(limit, far).map_or(0.0, |span| smooth_path::kernel(self, order, at, &span));
        near + span.above(limit, far).map_or(0.0, |span| self.far(&span))
    }

    fn kinks(&self) -> Vec<Kink> {
        // Of an uneven power no cell begins at the tip.
        let powers = if self.facts().smooth_tip { Powers::Odd } else { Powers::All(0) };
        vec![Kink { radius: 0.0, powers }]
    }

    fn surface_slope(&self, r: f64) -> f64 {
        self.exponent * self.coefficient * r.powf(self.exponent - 1.0)
    }

    fn falls(&self, inner: f64, outer: f64) -> Falls {
        // q is a power of x^2, whose slope is largest at one end.
        let (power, share) = (0.5 * self.exponent - 1.0, inner / outer * (inner / outer));
        let steepest = if power < 1.0 { share.powf(power - 1.0) } else { 1.0 };
        let rise = if power > 0.0 { 2.0 * power * (1.0 - share) * steepest } else { 0.0 };
        // q bends downward where that power is from zero to one.
        let concavely = (2.0..=4.0).contains(&self.exponent);
        Falls { least: self.slope(outer) / outer * (1.0 - rise), concavely }
    }
}
