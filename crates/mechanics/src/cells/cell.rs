//! A stretch of x^2 above its own inner end b, in the coordinate zeta = sqrt(x^2 - b^2), with a power series
//!
//! gamma(zeta) = dg/dzeta = sum of a_j u^j, u = zeta/h, 0 <= zeta <= h.
//!
//! If b is a kink of g, all powers count: a_0 is a jump of f', a_1 one of f'', and so on. If it is only a point of the
//! grid, g'/x is analytic in x^2 and only odd powers count. The coefficients come from a Chebyshev series over 0..h, or
//! over the squares. T_j(2u - 1) has coefficients up to 5.83^j, and the series falls like rho^-j, rho the sum of the
//! half-axes of the largest ellipse about the cell without a singularity, so that the magnitudes of the terms add up to
//! little more than gamma itself.

mod inverse;

use std::sync::LazyLock;

use super::ring::{Moments, StressRadius};
use super::shape::Powers;
use super::span::Span;
use crate::numerics::chebyshev::TWENTY_FOUR;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::gauss::{EIGHT_POINTS, TWELVE_POINTS, TWENTY_POINTS};
use crate::numerics::multipole::Multipole;

/// The most terms of a Chebyshev series.
const POINTS: usize = 24;
/// The share of a cell's width up to which eight points integrate the square of a rise.
const NARROW: f64 = 0.25;

/// The coefficients of T_k(2u - 1) in powers of u, a row for each order.
static SHIFTED: LazyLock<[[f64; POINTS]; POINTS]> = LazyLock::new(|| {
    let mut rows = [[0.0; POINTS]; POINTS];
    (rows[0][0], rows[1][0], rows[1][1]) = (1.0, -1.0, 2.0);
    for order in 2..POINTS {
        for power in 0..=order {
            let below = if power > 0 { rows[order - 1][power - 1] } else { 0.0 };
            rows[order][power] = 2.0 * (2.0 * below - rows[order - 1][power]) - rows[order - 2][power];
        }
    }
    rows
});

/// A cell.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Cell {
    /// The kink beneath it, m; zero, the centre, if there is none.
    pub(crate) kink: f64,
    /// b^2, m^2, and b, m.
    pub(crate) square: DoubleDouble,
    pub(crate) radius: f64,
    /// h, m, and how much the radius grows, m.
    pub(crate) high: f64,
    pub(crate) width: f64,
    /// How much g grows, m.
    pub(crate) depth: f64,
    /// g, m, int x dg, m^2, and the kernel at the centre, int dg/x, at b.
    pub(crate) level: DoubleDouble,
    pub(crate) load: DoubleDouble,
    pub(crate) centre: f64,
    /// The most that its kernel is, where it stands for a tip that is less sharp; infinite elsewhere.
    pub(super) most: f64,
    /// a_j, and a_j/(j + 1), of which only odd ones may count.
    powers: Box<[f64]>,
    integrals: Box<[f64]>,
    odd: bool,
    /// p in gamma ~ zeta^(p - 1) at b.
    order: i32,
}

/// A part of a cell, between two values of zeta, m, with their difference.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Part {
    pub(crate) low: f64,
    pub(crate) high: f64,
    pub(crate) drop: f64,
}

impl Cell {
    /// The cell of width `high` above the square `square`, by the Chebyshev series over 0..1 of gamma over the least
    /// power of u, in u or in its square.
    pub(crate) fn new(kink: f64, square: DoubleDouble, high: f64, series: &[f64], kind: Powers) -> Cell {
        let mut plain = [0.0; POINTS];
        for (order, (a, row)) in series.iter().zip(SHIFTED.iter()).enumerate() {
            for (sum, c) in plain.iter_mut().zip(&row[..=order]) {
                *sum += a * c;
            }
        }
        let (first, step) = if let Powers::All(power) = kind { (power, 1) } else { (1, 2) };
        let count = series.len().max(1);
        let mut powers = vec![0.0; first + step * (count - 1) + 1];
        for (index, c) in plain[..count].iter().enumerate() {
            powers[first + step * index] = *c;
        }
        Cell::of(kink, square, high, powers, step == 2, first)
    }

    /// The cell in place of a tip, up to this radius, m, by its powers, whose kernel is at most so much.
    pub(crate) fn tip(radius: f64, powers: &[f64], most: f64) -> Cell {
        Cell { most, ..Cell::of(0.0, DoubleDouble::ZERO, radius, powers.to_vec(), false, powers.len() - 1) }
    }

    fn of(kink: f64, square: DoubleDouble, high: f64, powers: Vec<f64>, odd: bool, first: usize) -> Cell {
        let integrals: Box<[f64]> = powers.iter().enumerate().map(|(j, a)| a / (j + 1) as f64).collect();
        let radius = square.value().sqrt();
        let end = (square + DoubleDouble::square_of(high)).value().sqrt();
        let mut cell = Cell {
            kink,
            square,
            radius,
            high,
            width: high * high / (radius + end),
            depth: 0.0,
            level: DoubleDouble::ZERO,
            load: DoubleDouble::ZERO,
            centre: 0.0,
            most: f64::INFINITY,
            powers: powers.into(),
            integrals,
            odd,
            order: first as i32 + 1,
        };
        cell.depth = cell.rise(cell.whole());
        cell
    }

    /// All of it.
    pub(crate) fn whole(&self) -> Part {
        Part { low: 0.0, high: self.high, drop: self.high }
    }

    /// The square of the radius where it ends, m^2.
    pub(crate) fn end(&self) -> DoubleDouble {
        self.square + DoubleDouble::square_of(self.high)
    }

    /// zeta, m, of a square of a radius, m^2.
    pub(crate) fn zeta(&self, square: DoubleDouble) -> f64 {
        (square - self.square).value().max(0.0).sqrt().min(self.high)
    }

    /// The part of it that a span is, which lies inside it.
    pub(crate) fn part(&self, span: &Span) -> Part {
        let (below, above) = span.excess(self.square);
        let (low, high) = (below.max(0.0).sqrt(), above.max(0.0).sqrt());
        let gap = if below >= 0.0 { span.gap } else { above.max(0.0) };
        Part { low, high, drop: if gap > 0.0 { gap / (low + high) } else { 0.0 } }
    }

    /// x, m.
    pub(crate) fn radius_at(&self, zeta: f64) -> f64 {
        (self.square.value() + zeta * zeta).sqrt()
    }

    /// gamma at several places side by side.
    pub(crate) fn gammas<const N: usize>(&self, zeta: [f64; N]) -> [f64; N] {
        let u = zeta.map(|zeta| zeta / self.high);
        let mut sums = [0.0; N];
        if self.odd {
            let squares = u.map(|u| u * u);
            for a in self.powers.iter().skip(1).step_by(2).rev() {
                for lane in 0..N {
                    sums[lane] = sums[lane] * squares[lane] + a;
                }
            }
            for lane in 0..N {
                sums[lane] *= u[lane];
            }
        } else {
            for a in self.powers.iter().rev() {
                for lane in 0..N {
                    sums[lane] = sums[lane] * u[lane] + a;
                }
            }
        }
        sums
    }

    /// gamma at zeta.
    pub(crate) fn gamma(&self, zeta: f64) -> f64 {
        let [gamma] = self.gammas([zeta]);
        gamma
    }

    /// g'(x)/x at zeta: infinite where f' jumps.
    pub(crate) fn slope_over_radius(&self, zeta: f64) -> f64 {
        if zeta > 0.0 {
            self.gamma(zeta) / zeta
        } else if self.powers[0].abs() > 0.0 {
            f64::INFINITY
        } else {
            self.powers.get(1).map_or(0.0, |a| a / self.high)
        }
    }

    /// The rises of g, m, from several places up to `high`, each this far below it: divided differences, so that each
    /// is good to round-off of itself.
    fn rises<const N: usize>(&self, low: [f64; N], high: f64, drop: [f64; N]) -> [f64; N] {
        let inverse = self.high.recip();
        let top = high * inverse;
        let (mut value, mut differences) = (0.0, [0.0; N]);
        if self.odd {
            let (square, squares) = (top * top, low.map(|low| (low * inverse) * (low * inverse)));
            for a in self.integrals.iter().skip(1).step_by(2).rev() {
                for lane in 0..N {
                    differences[lane] = differences[lane] * squares[lane] + value;
                }
                value = value * square + a;
            }
            return std::array::from_fn(|lane| {
                drop[lane] * (high + low[lane]) * inverse * (value + squares[lane] * differences[lane])
            });
        }
        let places = low.map(|low| low * inverse);
        for a in self.integrals.iter().rev() {
            for lane in 0..N {
                differences[lane] = differences[lane] * places[lane] + value;
            }
            value = value * top + a;
        }
        std::array::from_fn(|lane| drop[lane] * (value + places[lane] * differences[lane]))
    }

    /// The rise of g over a part, m.
    pub(crate) fn rise(&self, part: Part) -> f64 {
        let [rise] = self.rises([part.low], part.high, [part.drop]);
        rise
    }

    /// The rise of g, m, from b up to zeta.
    pub(crate) fn rise_to(&self, zeta: f64) -> f64 {
        self.rise(Part { low: 0.0, high: zeta, drop: zeta })
    }

    /// int dx, int h dx and int h^2 dx over a part that is `width` wide in the radius, m, h the rise up to its outer
    /// end.
    pub(crate) fn moments(&self, part: Part, width: f64) -> Moments {
        if part.drop <= NARROW * self.high {
            self.moments_by(&EIGHT_POINTS, part, width)
        } else {
            self.moments_by(&TWELVE_POINTS, part, width)
        }
    }

    fn moments_by<const N: usize>(&self, rule: &[(f64, f64); N], part: Part, width: f64) -> Moments {
        let drop = rule.map(|(share, _)| part.drop * share);
        let low = drop.map(|drop| (part.high - drop).max(0.0));
        let rises = self.rises(low, part.high, drop);
        let (mut first, mut second) = (0.0, 0.0);
        for lane in 0..N {
            let area = rule[lane].1 * rises[lane] * self.stretch(low[lane]);
            first += area;
            second += area * rises[lane];
        }
        Moments { width, first: part.drop * first, second: part.drop * second }
    }

    /// dx/dzeta.
    fn stretch(&self, zeta: f64) -> f64 {
        if self.radius > 0.0 { zeta / self.radius_at(zeta) } else { 1.0 }
    }

    /// Adds the sources dg over x^2 of a part to a multipole above whose lower end the part begins at `start`, m^2.
    pub(crate) fn add_sources(&self, sources: &mut Multipole, start: f64, part: Part, weight: f64) {
        let beyond = TWENTY_POINTS.map(|(share, _)| part.drop * (1.0 - share));
        let gammas = self.gammas(beyond.map(|beyond| part.low + beyond));
        sources.add_sources(
            &beyond.map(|beyond| start + beyond * (part.low + part.low + beyond)),
            &std::array::from_fn(|lane| weight * part.drop * TWENTY_POINTS[lane].1 * gammas[lane]),
        );
    }

    /// int h dx/sqrt(r^2 - x^2), m, over what a span, which lies inside the cell, has below r, h the rise up to its
    /// outer end: over the angle whose sine is zeta/tau, tau^2 = r^2 - b^2.
    pub(crate) fn displacement_integral(&self, at: &StressRadius, span: &Span) -> f64 {
        let (inner, outer) = span.excess(at.square);
        if inner >= 0.0 || span.gap <= 0.0 {
            return 0.0;
        }
        let part = self.part(span);
        let tau_square = (at.square - self.square).value();
        let (w_low, w_top) = ((-inner).sqrt(), (-outer).max(0.0).sqrt());
        let (top, missing, gap) = if outer > 0.0 {
            let tau = tau_square.sqrt();
            (tau, outer / (part.high + tau), -inner)
        } else {
            (part.high, 0.0, span.gap)
        };
        let angle = (gap * tau_square / (top * w_low + part.low * w_top)).atan2(w_low * w_top + part.low * top);
        let drops = TWENTY_POINTS.map(|(share, _)| {
            let turn = angle * share;
            let half = (0.5 * turn).sin();
            2.0 * top * half * half + w_top * turn.sin()
        });
        let places = drops.map(|drop| (top - drop).max(0.0));
        let rises = self.rises(places, part.high, drops.map(|drop| missing + drop));
        let term = |lane: usize| TWENTY_POINTS[lane].1 * rises[lane] * self.stretch(places[lane]);
        angle * (0..TWENTY_POINTS.len()).map(term).sum::<f64>()
    }

    /// Whether the terms of g'/x beyond the first cannot make it fall below zero.
    pub(crate) fn surely_rises(&self) -> bool {
        self.powers.get(1).is_some_and(|first| {
            self.powers[0] >= 0.0
                && self.powers[2..].iter().map(|a| if *a < 0.0 { -a } else { 0.0 }).sum::<f64>() < *first
        })
    }

    /// Values of zeta, m, increasing, between which g'/x cannot hide a fall.
    pub(crate) fn slope_check_places(&self) -> Vec<f64> {
        let mut places = TWENTY_FOUR.places(0.0, self.high).to_vec();
        places.extend([0.0, self.high]);
        places.sort_by(f64::total_cmp);
        places
    }

    /// Whether f' jumps at b.
    pub(crate) fn jumps(&self) -> bool {
        self.powers[0].abs() > 0.0
    }

    /// a_j.
    pub(super) fn powers(&self) -> &[f64] {
        &self.powers
    }

    /// What g is a series of from b on, together with an odd function of zeta.
    pub(crate) fn begins_as(&self) -> Powers {
        if self.odd { Powers::Odd } else { Powers::All((self.order - 1).min(1) as usize) }
    }

    /// Whether the series takes only odd powers.
    pub(crate) fn odd(&self) -> bool {
        self.odd
    }
}
