//! Integrals over an interval of radii without a kink inside.
//!
//! Beside a kink at k, g is smooth not in x but in t = sqrt(x^2 - k^2), so every integral here runs over t (k = 0: t =
//! x). The one thing asked of a profile is its rise from a radius up to the interval's outer end, to round-off of
//! itself: then h = y_outer - g is a sum of positive terms and nothing cancels, however thin the ring.

use std::f64::consts::FRAC_PI_2;

use super::{DoubleDouble, Moments, Span, StressRadius};
use crate::numerics::gauss::{QuadraturePanel, Singular};

/// The power up to which no panel needs a longer rule than the singularities ask for.
const PARABOLA: f64 = 2.0;

/// A stretch of radii in the coordinate t of the kink beneath it.
#[derive(Clone, Copy)]
pub(super) struct SmoothInterval {
    /// The kink's radius k, m.
    pub(super) base: f64,
    /// t at the outer end, m.
    pub(super) high: f64,
    /// Difference of t over the interval, m, exact.
    pub(super) drop: f64,
    /// Where g, as a function of t, is singular.
    pub(super) singular: Singular,
    /// g changes no faster than x to this power.
    pub(super) power: f64,
    /// t at the inner end, m.
    pub(super) low: f64,
    /// Sum of the radii at both ends, m.
    radii: f64,
    /// Difference of their squares, m^2.
    gap: f64,
}

/// A point of an interval, t below its top by `dt`.
#[derive(Clone, Copy)]
pub(super) struct Node {
    pub(super) t: f64,
    pub(super) dt: f64,
}

/// How fast an integrand changes along its path.
struct Change {
    /// At a distance s below the top ln t falls by rate + bend s per s, at the most near enough to the top.
    rate: f64,
    bend: f64,
    /// How many factors of the integrand change like g.
    factors: f64,
    /// At s from where t would be zero ln t changes by no more than the larger of 1/s and this.
    least: f64,
}

impl SmoothInterval {
    /// `span` above a kink at `base`. `singularity` is the distance in t to the next singularity beneath the kink,
    /// along the imaginary axis; g is analytic up to the radius `ceiling`.
    pub(super) fn new(span: &Span, base: f64, singularity: f64, ceiling: f64, power: f64) -> SmoothInterval {
        let (low, high) = span.excess(DoubleDouble::square_of(base));
        let (low, high) = (low.max(0.0).sqrt(), high.max(0.0).sqrt());
        let drop = if span.gap > 0.0 { span.gap / (low + high) } else { 0.0 };
        // Far beyond the ceiling there is no contact, only steps of a search that has left the range: any finite value
        // will do.
        let above = ((ceiling - base) * (ceiling + base)).sqrt();
        let above = if above > 0.99 * high { above } else { f64::INFINITY };
        let singular = Singular { below: singularity, above };
        SmoothInterval {
            base,
            high,
            drop,
            singular,
            power,
            low,
            radii: span.inner_radius + span.outer_radius,
            gap: span.gap,
        }
    }

    /// dx/dt = t/x.
    fn stretch(&self, t: f64) -> f64 {
        if self.base > 0.0 { t / (self.base * self.base + t * t).sqrt() } else { 1.0 }
    }

    /// Visits panel after panel from `top` down over `length`, in t or in an angle that t follows.
    /// `t_at` is t at a distance from the top.
    fn sweep(
        &self,
        (singular, top, length): (Singular, f64, f64),
        change: Change,
        t_at: impl Fn(f64) -> f64,
        mut visit: impl FnMut(f64, f64),
    ) {
        let (rate, bend) = (self.power * change.rate, self.power * change.bend);
        // x^2, by which a power has fallen: above a kink t falls sooner.
        let square = |done: f64| self.base * self.base + t_at(done).powi(2);
        let mut done = 0.0;
        while done < length {
            let (high, left) = (top - done, length - done);
            if high <= 1e-14 * top {
                // So low that any rule will do; `done` would soon stop growing.
                QuadraturePanel::coarse(left).visit(|below, weight| visit(done + below, weight));
                break;
            }
            let mut panel = singular.panel(high, left);
            // Panels that the singularities alone shape suffice for a parabola, and where a power counts no longer.
            if self.power > PARABOLA && self.power * (square(0.0) / square(done)).ln() < 80.0 {
                if self.power > 10.0 {
                    // A steep power is followed by no more than a factor e^5 at a time.
                    let steep = rate + bend * done;
                    // By the hypotenuse: below 1e-154 m the square of `steep` would overflow, and the loop would not
                    // advance.
                    let width = 10.0 / (steep + steep.hypot((10.0 * bend).sqrt()));
                    if width > 0.0 && width < panel.width {
                        panel = QuadraturePanel::fine(width);
                    }
                }
                panel = panel.following(change.factors * self.power * panel.width * high.recip().max(change.least));
            }
            panel.visit(|below, weight| visit(done + below, weight));
            done += panel.width;
        }
    }

    /// int gamma dt.
    pub(super) fn rise(&self, gamma: impl Fn(f64) -> f64) -> f64 {
        let mut sum = 0.0;
        let change = Change { rate: self.high.recip(), bend: 0.0, factors: 1.0, least: 0.0 };
        let t_at = |dt: f64| self.high - dt;
        self.sweep((self.singular, self.high, self.drop), change, t_at, |dt, weight| {
            sum += weight * gamma((self.high - dt).max(0.0));
        });
        sum
    }

    /// int dx, int h dx and int h^2 dx with h the rise from x to the top of the interval.
    pub(super) fn moments(&self, rise: impl Fn(Node) -> f64) -> Moments {
        if self.gap <= 0.0 {
            return Moments::default();
        }
        let (mut first, mut second) = (0.0, 0.0);
        let change = Change { rate: self.high.recip(), bend: 0.0, factors: 2.0, least: 0.0 };
        let t_at = |dt: f64| self.high - dt;
        self.sweep((self.singular, self.high, self.drop), change, t_at, |dt, weight| {
            let t = (self.high - dt).max(0.0);
            let h = rise(Node { t, dt });
            let area = weight * h * self.stretch(t);
            first += area;
            second += area * h;
        });
        Moments { width: self.gap / self.radii, first, second }
    }

    /// int (above + rise) dx / sqrt(r^2 - x^2) over the part of the interval below r, with t = tau sin(theta), tau^2 =
    /// r^2 - k^2.
    pub(super) fn displacement_integral(
        &self,
        span: &Span,
        at: &StressRadius,
        above: f64,
        rise: impl Fn(Node) -> f64,
    ) -> f64 {
        let (inner, outer) = span.excess(at.square);
        if inner >= 0.0 || self.gap <= 0.0 {
            return 0.0;
        }
        let low = self.low;
        let tau_square = (at.square - DoubleDouble::square_of(self.base)).value();
        let (w_low, w_top) = ((-inner).sqrt(), (-outer).max(0.0).sqrt());
        let (top, missing, gap) = if outer > 0.0 {
            let tau = tau_square.sqrt();
            (tau, outer / (self.high + tau), -inner)
        } else {
            (self.high, 0.0, self.gap)
        };
        let angle = (gap * tau_square / (top * w_low + low * w_top)).atan2(w_low * w_top + low * top);
        let tau = tau_square.sqrt();
        // A singularity on the axis of t lies beyond the top in theta, or beside pi/2, where it counts as half as far.
        let beyond = self.singular.above / tau;
        let beyond = if beyond < 1.0 { beyond.asin() } else { FRAC_PI_2 + 0.5 * beyond.acosh().min(3.0) };
        let singular = Singular { below: (self.singular.below / tau).asinh(), above: beyond };
        let mut total = 0.0;
        // A power of the sine is a sum of waves no shorter than that power has them.
        let change = Change { rate: w_top / top, bend: 1.0, factors: 1.0, least: 1.0 };
        let t_at = |turn: f64| top * turn.cos() - w_top * turn.sin();
        self.sweep((singular, top.atan2(w_top), angle), change, t_at, |turn, weight| {
            let half = (0.5 * turn).sin();
            let dt = 2.0 * top * half * half + w_top * turn.sin();
            let t = (top - dt).max(0.0);
            total += weight * (above + rise(Node { t, dt: missing + dt })) * self.stretch(t);
        });
        total
    }
}
