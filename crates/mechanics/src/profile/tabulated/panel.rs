//! One stretch of a table between two knots, as Chebyshev series in t = sqrt(x^2 - k^2), k the knot beneath.
//!
//! Stored are q = g'/x and its primitive P = int t q dt: g' is analytic in t, though not in x, and q keeps
//! gamma = dg/dt = t q exact as t goes to zero.

use std::sync::OnceLock;

use super::super::smooth_coordinate::{self, SmoothCoordinate};
use super::panel_integrals::PanelIntegrals;
use super::{DoubleDouble, Moments, Span, panel_powers};
use crate::numerics::chebyshev::{self, TWENTY_FOUR, divided_difference};
use crate::numerics::gauss;
use crate::numerics::roots::within;

/// The part of P below which its terms do not count where an error is estimated that is larger.
const NEGLIGIBLE: f64 = 1e-14;

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
    /// g and int x dg where it begins.
    pub(super) level: f64,
    pub(super) load: f64,
    /// Coefficients of q and, for u from -1 on, of P.
    slope: Box<[f64]>,
    primitive: Box<[f64]>,
    /// Made when first asked for.
    powers: OnceLock<Box<[f64]>>,
    /// Made when a ring first ends here.
    integrals: OnceLock<PanelIntegrals>,
    /// How many terms of P are more than [`NEGLIGIBLE`].
    terms: usize,
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
        let mut primitive = Vec::with_capacity(slope.len() + 2);
        primitive.push(0.0);
        let (mut order, mut before, mut this) = (0.0, 2.0 * product(0), product(1));
        for k in 1..=slope.len() + 1 {
            order += 1.0;
            let next = product(k + 1);
            primitive.push(0.5 * half * (before - next) / order);
            (before, this) = (this, next);
        }
        let square = DoubleDouble::square_of(base) + DoubleDouble::square_of(low);
        let size = primitive.iter().fold(0.0_f64, |size, a| size.max(a.abs()));
        let terms = primitive.iter().rposition(|a| a.abs() > NEGLIGIBLE * size).map_or(0, |last| last + 1);
        KernelPanel {
            base,
            singularity,
            low,
            high,
            radius: square.value().sqrt(),
            square,
            level: 0.0,
            load: 0.0,
            powers: OnceLock::new(),
            slope: slope.into(),
            primitive: primitive.into(),
            integrals: OnceLock::new(),
            terms,
        }
    }

    /// Coefficients of q in powers of t over its upper end, for the kernel; none if they do not serve.
    pub(super) fn powers(&self) -> &[f64] {
        self.powers.get_or_init(|| panel_powers::powers(&self.slope, self.low, self.high))
    }

    /// Its integrals up to any place.
    pub(super) fn integrals(&self) -> &PanelIntegrals {
        self.integrals.get_or_init(|| {
            let width = (self.high - self.low) * (self.high + self.low) / (self.radius + self.end().1);
            let rise = |t| self.rise_at(self.low, t, t - self.low);
            PanelIntegrals::new(self.base, (self.low, self.high), (width, self.depth()), rise)
        })
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
        let t = |s: f64| (self.low * self.low + s).sqrt();
        let mut s = (all * (rise / self.integrals().depth)).min(all);
        let slope = 0.5 * self.slope_over_radius(t(s));
        let mut last = s;
        for _ in 0..8 {
            let step = (rise - self.rise_by_powers(t(s), s)) / slope;
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
        let [value] = chebyshev::values(&self.slope, [self.place(t)]);
        value
    }

    /// A bound of |dq/dt|: that of a Chebyshev polynomial of the order k is k^2 at most.
    pub(super) fn steepest(&self) -> f64 {
        let orders = self.slope.iter().enumerate().map(|(order, a)| (order * order) as f64 * a.abs());
        orders.sum::<f64>() * 2.0 / (self.high - self.low)
    }

    /// Its moments and its depth, m.
    pub(super) fn totals(&self) -> (Moments, f64) {
        let odd = self.primitive.iter().skip(1).step_by(2);
        let depth = 2.0 * odd.sum::<f64>();
        let singular = gauss::Singular { below: self.singularity, above: f64::INFINITY };
        let rule = singular.panel(self.high, self.high - self.low);
        let moments = match rule.points() {
            _ if rule.width < self.high - self.low => smooth_coordinate::moments(self, &self.span(None)),
            8 => self.moments_by(&gauss::EIGHT_POINTS),
            12 => self.moments_by(&gauss::TWELVE_POINTS),
            _ => self.moments_by(&gauss::TWENTY_POINTS),
        };
        (moments, depth)
    }

    /// The moments by a rule whose points all of it can be left to. The rises are differences of P, good to round-off
    /// of the depth.
    fn moments_by<const N: usize>(&self, rule: &[(f64, f64); N]) -> Moments {
        let (width, top) = (self.high - self.low, self.primitive.iter().sum::<f64>());
        let levels = chebyshev::values(&self.primitive, rule.map(|(share, _)| 1.0 - 2.0 * share));
        let (mut first, mut second) = (0.0, 0.0);
        for (&(share, weight), level) in rule.iter().zip(levels) {
            let t = self.high - width * share;
            let (rise, stretch) = (top - level, if self.base > 0.0 { t / self.radius_at(t) } else { 1.0 });
            let area = width * weight * rise * stretch;
            first += area;
            second += area * rise;
        }
        Moments { width: width * (self.high + self.low) / (self.radius + self.end().1), first, second }
    }

    /// The square of the radius where it ends, and that radius.
    pub(super) fn end(&self) -> (DoubleDouble, f64) {
        let square = DoubleDouble::square_of(self.base) + DoubleDouble::square_of(self.high);
        (square, square.value().sqrt())
    }

    /// g from the beginning to the end.
    pub(super) fn depth(&self) -> f64 {
        self.rise_at(self.low, self.high, self.high - self.low)
    }

    /// All of it, up to the very square where the next one begins, if there is one: its own end is rounded, and
    /// 1/sqrt(r^2 - x^2) would turn a gap of one unit in the last place beneath r into 1e-8 of a displacement.
    pub(super) fn span(&self, next: Option<&KernelPanel>) -> Span {
        let (outer, outer_radius) = next.map_or_else(|| self.end(), |next| (next.square, next.radius));
        let gap = (outer - self.square).value();
        Span { inner: self.square, outer, inner_radius: self.radius, outer_radius, gap, edge: 0.0 }
    }

    /// The t of a radius that lies in it.
    pub(super) fn t_of(&self, square: DoubleDouble) -> f64 {
        (square - DoubleDouble::square_of(self.base)).value().max(0.0).sqrt().clamp(self.low, self.high)
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
