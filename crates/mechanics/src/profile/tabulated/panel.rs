//! One stretch of a table between two knots, as Chebyshev series in t = sqrt(x^2 - k^2), k the knot beneath.
//!
//! Stored are q = g'/x and its primitive P = int t q dt: g' is analytic in t, though not in x, and q keeps
//! gamma = dg/dt = t q exact as t goes to zero.

use std::sync::OnceLock;

use super::super::shape::KernelOrder;
use super::super::smooth_coordinate::{self, SmoothCoordinate};
use super::{DoubleDouble, Moments, Span, StressRadius, panel_powers};
use crate::numerics::chebyshev::{self, TWENTY_FOUR, divided_difference};
use crate::numerics::gauss::{self, EIGHT_POINTS, TWELVE_POINTS, TWENTY_POINTS};
use crate::numerics::roots::within;

/// A stretch of radii.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct KernelPanel {
    /// k, m.
    pub(super) base: f64,
    /// Distance in t, along the imaginary axis, at which g is singular, m.
    singularity: f64,
    /// t where it begins and where it ends, m.
    pub(super) low: f64,
    pub(super) high: f64,
    /// x where it begins and x^2.
    pub(super) radius: f64,
    pub(super) square: DoubleDouble,
    /// W, how much its radius grows, and H, how much g does, m.
    width: f64,
    pub(super) depth: f64,
    /// g, int x dg and the kernel at the centre, int dg/x, where it begins.
    pub(super) level: f64,
    pub(super) load: f64,
    pub(super) centre: f64,
    /// How many points of Gauss's rule do for an integral over it; `None` where none does.
    points: Option<usize>,
    /// Coefficients of q and, for u from -1 on, of P.
    slope: Box<[f64]>,
    primitive: Box<[f64]>,
    /// Made when first asked for.
    powers: OnceLock<Box<[f64]>>,
}

impl KernelPanel {
    /// The panel on low..high in t above the knot `base`, by the series of q there.
    pub(super) fn new((base, singularity): (f64, f64), (low, high): (f64, f64), slope: Vec<f64>) -> KernelPanel {
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
        // t q in the same terms, t = middle + half u and 2 u T_k = T_(k+1) + T_(k-1), then its primitive.
        let term = |k: usize| slope.get(k).copied().unwrap_or(0.0);
        let product = |k: usize| match k {
            0 => middle * term(0) + 0.5 * half * term(1),
            1 => middle * term(1) + half * (term(0) + 0.5 * term(2)),
            _ => middle * term(k) + 0.5 * half * (term(k - 1) + term(k + 1)),
        };
        let product: Vec<f64> = (0..=slope.len()).map(product).collect();
        let primitive = chebyshev::primitive(&product, half);
        let square = DoubleDouble::square_of(base) + DoubleDouble::square_of(low);
        let odd = primitive.iter().skip(1).step_by(2);
        let radius = square.value().sqrt();
        let end = (DoubleDouble::square_of(base) + DoubleDouble::square_of(high)).value().sqrt();
        KernelPanel {
            base,
            singularity,
            low,
            high,
            radius,
            square,
            width: (high - low) * (high + low) / (radius + end),
            depth: 2.0 * odd.sum::<f64>(),
            level: 0.0,
            load: 0.0,
            centre: 0.0,
            points: points(base, (low, high), primitive.len()),
            powers: OnceLock::new(),
            slope: slope.into(),
            primitive: primitive.into(),
        }
    }

    /// Coefficients of gamma over its upper end in powers of t over that, for the kernel; none if they do not serve.
    pub(super) fn powers(&self) -> &[f64] {
        self.powers.get_or_init(|| panel_powers::powers(&self.slope, self.low, self.high))
    }

    /// The rise of g, m, from its beginning up to t, `s` further in the square of the radius, by the powers of q.
    pub(super) fn rise_by_powers(&self, t: f64, s: f64) -> f64 {
        panel_powers::rise(self.powers(), (self.low, self.high), t, s)
    }

    /// How much further, in the square of the radius, g has risen by `rise`, m; `None` without powers of q, and where
    /// that takes a search.
    ///
    /// Newton's step with q/2 where g would be if it rose with x^2, and further steps with the same slope: the error of
    /// each is that of the one before times the relative change of q on the way, which the steps tell.
    pub(super) fn distance(&self, rise: f64) -> Option<f64> {
        if self.powers().is_empty() {
            return None;
        }
        let all = (self.high - self.low) * (self.high + self.low);
        let mut s = (all * (rise / self.depth)).min(all);
        let slope = 0.5 * self.slope_over_radius(self.t_at(s));
        let mut last = s;
        for _ in 0..8 {
            let step = (rise - self.rise_by_powers(self.t_at(s), s)) / slope;
            s += step;
            let size = step.abs();
            // Also where one of them is no number.
            if !(s > 0.0 && s <= 1.000_001 * all && size <= 0.25 * last) {
                return None;
            }
            if size * (size / last) <= 1e-17 * s || size <= 3e-16 * s {
                return Some(s.min(all));
            }
            last = size;
        }
        None
    }

    /// Whether the terms of q beyond the first cannot make it fall below zero.
    pub(super) fn surely_rises(&self) -> bool {
        self.slope.split_first().is_some_and(|(first, rest)| rest.iter().map(|a| a.abs()).sum::<f64>() < *first)
    }

    /// t as a place from -1 to 1.
    pub(super) fn place(&self, t: f64) -> f64 {
        ((t - self.low) - (self.high - t)) / (self.high - self.low)
    }

    /// q at t.
    pub(super) fn slope_over_radius(&self, t: f64) -> f64 {
        let [value] = self.slopes_over_radius([t]);
        value
    }

    /// q at several t side by side.
    pub(super) fn slopes_over_radius<const N: usize>(&self, t: [f64; N]) -> [f64; N] {
        chebyshev::values(&self.slope, t.map(|t| self.place(t)))
    }

    /// A bound of |dq/dt|: that of a Chebyshev polynomial of the order k is k^2 at most.
    pub(super) fn steepest(&self) -> f64 {
        let orders = self.slope.iter().enumerate().map(|(order, a)| (order * order) as f64 * a.abs());
        orders.sum::<f64>() * 2.0 / (self.high - self.low)
    }

    /// Its moments, and what it adds to the kernel at the centre, int q dx.
    pub(super) fn totals(&self) -> (Moments, f64) {
        let span = self.span(None);
        let moments = self.moments_by_rule((self.low, self.high), (self.width, self.depth), &[]);
        let centre = match self.points {
            Some(8) => self.centre_by(&EIGHT_POINTS),
            Some(12) => self.centre_by(&TWELVE_POINTS),
            Some(_) => self.centre_by(&TWENTY_POINTS),
            None => smooth_coordinate::kernel(self, KernelOrder::Value, &StressRadius::new(0.0), &span),
        };
        (moments.unwrap_or_else(|| smooth_coordinate::moments(self, &span)), centre)
    }

    /// The moments from where it begins up to t, `width` further in the radius and `rise` in g, m; `None` without a
    /// rule for the panel.
    ///
    /// They err by a few units in the last place of W H and W H^2: see [`KernelPanel::resolves`].
    pub(super) fn moments_below(&self, t: f64, width: f64, rise: f64) -> Option<Moments> {
        self.moments_by_rule((self.low, t), (width, rise), self.powers_from_knot())
    }

    /// The moments from t up to where it ends, `width` further in the radius, m, likewise.
    pub(super) fn moments_above(&self, t: f64, width: f64) -> Option<Moments> {
        self.moments_by_rule((t, self.high), (width, self.depth), self.powers_from_knot())
    }

    /// [`KernelPanel::powers`] where it begins at its knot.
    fn powers_from_knot(&self) -> &[f64] {
        if self.low > 0.0 { &[] } else { self.powers() }
    }

    /// The moments between two places of t, a width in the radius apart, with how much g has risen up to the second, m,
    /// by powers or else by its series.
    fn moments_by_rule(&self, ends: (f64, f64), outer: (f64, f64), powers: &[f64]) -> Option<Moments> {
        Some(match self.points? {
            8 => self.moments_by(&EIGHT_POINTS, ends, outer, powers),
            12 => self.moments_by(&TWELVE_POINTS, ends, outer, powers),
            _ => self.moments_by(&TWENTY_POINTS, ends, outer, powers),
        })
    }

    /// Whether the errors of the moments of a part are round-off of those of a ring, as they are for one that holds a
    /// whole panel of this size beside it.
    pub(super) fn resolves(&self, ring: &Moments) -> bool {
        let area = self.width * self.depth;
        ring.first >= area && ring.second >= area * self.depth
    }

    /// t/x.
    fn stretch(&self, t: f64) -> f64 {
        if self.base > 0.0 { t / self.radius_at(t) } else { 1.0 }
    }

    /// The moments by a rule whose points all of it can be left to. The rises are differences, good to round-off of the
    /// depth.
    fn moments_by<const N: usize>(
        &self,
        rule: &[(f64, f64); N],
        (low, high): (f64, f64),
        (width, top): (f64, f64),
        powers: &[f64],
    ) -> Moments {
        let places = rule.map(|(share, _)| high - (high - low) * share);
        let levels = if powers.is_empty() {
            chebyshev::values(&self.primitive, places.map(|t| self.place(t)))
        } else {
            panel_powers::rises_from_knot(powers, self.high, places)
        };
        let (rises, stretches) = (levels.map(|level| top - level), places.map(|t| self.stretch(t)));
        let areas: [f64; N] = std::array::from_fn(|index| rule[index].1 * rises[index] * stretches[index]);
        let first = areas.iter().sum::<f64>();
        let second = areas.iter().zip(rises).map(|(area, rise)| area * rise).sum::<f64>();
        Moments { width, first: (high - low) * first, second: (high - low) * second }
    }

    /// int q dx by such a rule.
    fn centre_by<const N: usize>(&self, rule: &[(f64, f64); N]) -> f64 {
        let width = self.high - self.low;
        let slopes = chebyshev::values(&self.slope, rule.map(|(share, _)| 1.0 - 2.0 * share));
        let terms = rule.iter().zip(slopes).map(|((u, weight), q)| weight * q * self.stretch(self.high - width * u));
        width * terms.sum::<f64>()
    }

    /// The square of the radius where it ends, and that radius.
    pub(super) fn end(&self) -> (DoubleDouble, f64) {
        let square = DoubleDouble::square_of(self.base) + DoubleDouble::square_of(self.high);
        (square, square.value().sqrt())
    }

    /// All of it, up to the very square where the next one begins, if there is one: its own end is rounded, and
    /// 1/sqrt(r^2 - x^2) would turn a gap of one unit in the last place beneath r into 1e-8 of a displacement.
    pub(super) fn span(&self, next: Option<&KernelPanel>) -> Span {
        let (outer, outer_radius) = next.map_or_else(|| self.end(), |next| (next.square, next.radius));
        let gap = (outer - self.square).value();
        Span { inner: self.square, outer, inner_radius: self.radius, outer_radius, gap, edge: 0.0, above: None }
    }

    /// The t of a radius that lies in it.
    pub(super) fn t_of(&self, square: DoubleDouble) -> f64 {
        self.t_at((square - self.square).value().max(0.0))
    }

    /// The t where the square of the radius is this much larger than where it begins.
    pub(super) fn t_at(&self, further: f64) -> f64 {
        (self.low * self.low + further).sqrt().clamp(self.low, self.high)
    }

    /// Values of t, increasing, between which q cannot hide a fall.
    pub(super) fn slope_check_places(&self) -> Vec<f64> {
        let mut checked = TWENTY_FOUR.places(self.low, self.high).to_vec();
        checked.extend([self.low, self.high]);
        checked.sort_by(f64::total_cmp);
        checked
    }

    /// int x dg from the beginning to t.
    pub(super) fn load_to(&self, t: f64) -> f64 {
        let mut load = 0.0;
        gauss::QuadraturePanel::fine(t - self.low).visit(|below, weight| {
            let t = t - below;
            load += weight * self.slope_at(t) * self.radius_at(t);
        });
        load
    }

    /// The t at which a rising function of t, given with its slope, is zero: Newton's steps inside a bracket. `share`
    /// is how much of the function's rise over the panel lies below the root, and `power` how it begins where a table
    /// leaves the plane, where a root can be as small as numbers are and no bisection would get there.
    pub(super) fn find(&self, share: f64, power: f64, f: impl Fn(f64) -> (f64, f64)) -> f64 {
        let share = if self.low > 0.0 { share } else { share.powf(power.recip()) };
        within([self.low, self.high], self.low + (self.high - self.low) * share, f)
    }
}

/// How many points of Gauss's rule do for an integral over low..high in t above the knot `base`, by so many terms of P.
fn points(base: f64, (low, high): (f64, f64), terms: usize) -> Option<usize> {
    // t/x is singular at t = +-ik.
    let below = if base > 0.0 { base } else { f64::INFINITY };
    let rule = gauss::Singular { below, above: f64::INFINITY }.panel(high, high - low);
    let least = [(14, 8), (20, 12)].into_iter().find(|(most, _)| terms <= *most).map_or(20, |(_, points)| points);
    (rule.width >= high - low).then_some(rule.points().max(least))
}

impl SmoothCoordinate for KernelPanel {
    fn kink_radius(&self) -> f64 {
        self.base
    }

    fn singularity(&self) -> f64 {
        self.singularity
    }

    fn level_at(&self, t: f64) -> f64 {
        self.level + self.rise_at(self.low, t, t - self.low)
    }

    fn slope_at(&self, t: f64) -> f64 {
        t * self.slope_over_radius(t)
    }

    fn bend_at(&self, t: f64) -> f64 {
        // t gamma' - gamma = t^2 q', by the divided difference of the series at one place.
        let u = self.place(t);
        t * t * divided_difference(&self.slope, u, u) * 2.0 / (self.high - self.low)
    }

    fn rise_at(&self, t: f64, top: f64, dt: f64) -> f64 {
        let difference = divided_difference(&self.primitive, self.place(top), self.place(t));
        dt * difference * 2.0 / (self.high - self.low)
    }

    fn upper_bound(&self, _level: f64) -> f64 {
        self.high
    }

    fn jumps(&self) -> bool {
        false
    }
}
