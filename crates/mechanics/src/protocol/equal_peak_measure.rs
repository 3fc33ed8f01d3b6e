//! s(x) = int g'(t)^2/t dt from a cut-off radius to the edge of the contact, and its inverse.
//!
//! Between two kinks k of the profile, g' is analytic in t = sqrt(x^2 - k^2), so that bisected panels of eight Gauss
//! points reach round-off. Down to the tip the variable is ln x, octave by octave until nothing is added: for g ~ x^n
//! with n near one, s comes from all of them.

use crate::numerics::gauss::{self, EIGHT_POINTS};
use crate::numerics::roots::within;
use crate::profile::Profile;

/// Tolerance of halving a panel, relative to the sum so far; the halves are then good to round-off.
const TOLERANCE: f64 = 1e-12;
/// How often a panel may be halved.
const HALVINGS: u32 = 60;
/// Below this radius, m, g is a power of x.
const TIP: f64 = 1e-100;

/// s between two radii.
pub(super) struct EqualPeakMeasure<'a> {
    profile: &'a Profile,
    /// From the edge inwards.
    leaves: Vec<Leaf>,
    /// The integral over all leaves.
    sum: f64,
    /// The rest of the integral, down to the tip.
    rest: f64,
}

/// A stretch over which one panel is enough.
#[derive(Clone, Copy)]
struct Leaf {
    along: Along,
    low: f64,
    high: f64,
    /// The integral from `high` to the edge.
    above: f64,
}

/// The variable of integration.
#[derive(Clone, Copy)]
enum Along {
    /// ln x.
    Octaves,
    /// sqrt(x^2 - k^2), k this kink, m.
    Kink(f64),
}

impl Along {
    fn radius(self, variable: f64) -> f64 {
        match self {
            Along::Octaves => variable.exp(),
            Along::Kink(kink) => kink.hypot(variable),
        }
    }
}

impl<'a> EqualPeakMeasure<'a> {
    /// `None` if s is not finite, or zero: a flat has no peaks.
    pub(super) fn new(profile: &'a Profile, inner: f64, outer: f64) -> Option<EqualPeakMeasure<'a>> {
        let mut spread = EqualPeakMeasure { profile, leaves: Vec::new(), sum: 0.0, rest: 0.0 };
        let mut top = outer;
        while top > inner {
            let kink = profile.kink_below(top);
            if kink > 0.0 {
                let low = kink.max(inner);
                let variable = |radius: f64| ((radius - kink) * (radius + kink)).sqrt();
                spread.add(Along::Kink(kink), variable(low), variable(top));
                top = low;
            } else {
                spread.descend(inner, top);
                top = inner;
            }
        }
        let whole = spread.sum + spread.rest;
        (whole > 0.0 && whole.is_finite()).then_some(spread)
    }

    /// From `top`, below which there is no kink, down to `inner` or to the tip.
    fn descend(&mut self, inner: f64, top: f64) {
        let bottom = inner.max(TIP).ln();
        let mut high = top.ln();
        while high > bottom {
            let low = (high - std::f64::consts::LN_2).max(bottom);
            let before = self.sum;
            self.add(Along::Octaves, low, high);
            high = low;
            if self.sum - before <= f64::EPSILON * f64::EPSILON * self.sum {
                break;
            }
        }
        if inner <= 0.0 {
            // int g'^2 dx/x of a power of x.
            let (slope, below) = (self.profile.slope(high.exp()).powi(2), self.profile.slope(0.5 * high.exp()).powi(2));
            let power = (slope / below).log2();
            let rest = if slope > 0.0 { slope / power.max(0.0) } else { 0.0 };
            self.rest = if below > 0.0 { rest } else { 0.0 };
        }
    }

    fn density(&self, along: Along, variable: f64) -> f64 {
        let radius = along.radius(variable);
        let slope = self.profile.slope(radius);
        match along {
            Along::Octaves => slope * slope,
            Along::Kink(_) => slope * slope * (variable / radius) / radius,
        }
    }

    fn area(&self, along: Along, low: f64, high: f64) -> f64 {
        gauss::integral(&EIGHT_POINTS, high - low, |below| self.density(along, high - below))
    }

    fn add(&mut self, along: Along, low: f64, high: f64) {
        let whole = self.area(along, low, high);
        self.halve(along, (low, high), whole, HALVINGS);
    }

    fn halve(&mut self, along: Along, (low, high): (f64, f64), whole: f64, left: u32) {
        let middle = 0.5 * (low + high);
        let (lower, upper) = (self.area(along, low, middle), self.area(along, middle, high));
        let both = lower + upper;
        // Written so that a NaN ends it too.
        let coarse = (both - whole).abs() > TOLERANCE * (self.sum + both);
        if coarse && left > 0 && both.is_finite() {
            self.halve(along, (middle, high), upper, left - 1);
            self.halve(along, (low, middle), lower, left - 1);
            return;
        }
        for (low, high, area) in [(middle, high, upper), (low, middle, lower)] {
            self.leaves.push(Leaf { along, low, high, above: self.sum });
            self.sum += area;
        }
    }

    /// The radius, m, at a fraction of s from the inner end; zero in what is left at the tip, where the level is too.
    pub(super) fn radius(&self, fraction: f64) -> f64 {
        let wanted = (1.0 - fraction) * (self.sum + self.rest);
        if wanted >= self.sum && self.rest > 0.0 {
            return 0.0;
        }
        let index = self.leaves.partition_point(|leaf| leaf.above <= wanted).max(1) - 1;
        let Leaf { along, low, high, above } = self.leaves[index];
        let below = self.leaves.get(index + 1).map_or(self.sum, |next| next.above);
        let wanted = wanted - above;
        let share = if below > above { wanted / (below - above) } else { 0.0 };
        let start = high - share.clamp(0.0, 1.0) * (high - low);
        let missing = |at: f64| (wanted - self.area(along, at, high), self.density(along, at));
        along.radius(within([low, high], start, missing))
    }
}
