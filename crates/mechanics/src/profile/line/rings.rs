//! The integrals of a line contact over a ring of levels, each to round-off of itself however thin the ring is.
//!
//! With y(s) the level, dX = X(s) - X(inner) and h = y(outer) - y: int h dX = int dX dy and int h^2 dX = 2 int h dX dy,
//! all of whose factors are positive. The rule of twelve points serves panels that are no longer than their distance
//! from s = 0, where a cylinder has a logarithm, or than b, beside whose i b a pad has one.

use std::f64::consts::{FRAC_2_PI, PI};

use super::{LineContact, Specimen};
use crate::numerics::gauss::{EIGHT_POINTS, TWELVE_POINTS, integral};
use crate::profile::Moments;

impl LineContact {
    /// The moments of the ring from s = `inner` to `outer`, m, over which the level rises by `depth`, m.
    pub(super) fn ring_moments(&self, inner: f64, outer: f64, depth: f64) -> Moments {
        if outer <= inner {
            return Moments::default();
        }
        if let Specimen::Cylinder { radius } = self.specimen
            && inner < 0.5 * outer
        {
            return self.of_cylinder(radius, inner, outer);
        }
        // Panels from the outer end inward, the innermost of which is no longer than b.
        let b = self.flat_half_width();
        let mut ends = vec![outer];
        while let Some(&end) = ends.last()
            && end > 2.0 * inner.max(0.5 * b)
        {
            ends.push(0.5 * end);
        }
        ends.push(inner);
        if ends.len() == 2 {
            return self.of_panel(inner, outer, depth);
        }
        let panels = ends.windows(2).rev();
        panels.fold(Moments::default(), |sum, panel| {
            let [high, low] = [panel[0], panel[1]];
            let depth = self.rise_over(low, high - low);
            Moments::stack(sum, self.of_panel(low, high, depth), depth)
        })
    }

    fn of_panel(&self, inner: f64, outer: f64, depth: f64) -> Moments {
        let (width, b) = (outer - inner, self.flat_half_width());
        let square = b * b + inner * inner;
        // ln(t/t(inner)); X - X(inner) is the unit times it over ln(l/t).
        let log = self.log_at(inner);
        let unit = 0.25 * PI * self.length / log;
        let widened = |step: f64| 0.5 * (step * (2.0 * inner + step) / square).ln_1p();
        let mut moments = Moments { width: unit * widened(width) / self.log_at(outer), ..Moments::default() };
        for &(share, weight) in self.rule(inner, width) {
            let (step, rest) = (width * share, width * (1.0 - share));
            let (s, widened) = (inner + step, widened(step));
            // The logarithm of X cancels that of the level.
            let term = width * weight * FRAC_2_PI * self.gamma(s) * unit * widened;
            let left = match self.specimen {
                Specimen::Cylinder { radius } => {
                    let twice = step * (inner + s) * (2.0 * log + 1.0) - 2.0 * s * s * widened;
                    depth - 0.25 * twice / radius
                }
                // The shorter of the two ways keeps its digits.
                Specimen::RoundedPad { .. } if share < 0.5 => depth - self.rise_over(inner, step),
                Specimen::RoundedPad { .. } => self.rise_over(s, rest),
            };
            moments.first += term;
            moments.second += 2.0 * left * term;
        }
        moments
    }

    /// By how much the level of a pad rises over a step from s, m, within a panel.
    fn rise_over(&self, s: f64, step: f64) -> f64 {
        integral(self.rule(s, step), step, |step| self.rise(s + step))
    }

    /// The rule of a step from s, m, within a panel: eight points are as good as twelve where nothing singular is near.
    fn rule(&self, s: f64, step: f64) -> &'static [(f64, f64)] {
        if step > 0.4 * self.width_at(s) { &TWELVE_POINTS } else { &EIGHT_POINTS }
    }

    /// In closed form, where the ring is thick: int X dy = (L/2) G, int G dy = (G^2/pi)(ln(l/t) + 1/4).
    fn of_cylinder(&self, radius: f64, inner: f64, outer: f64) -> Moments {
        let whole = |s: f64| {
            if s <= 0.0 {
                return Moments::default();
            }
            let (load, log) = (0.25 * PI * s * s / radius, self.log_at(s));
            Moments {
                width: self.curve_radius(s),
                first: 0.5 * self.length * load,
                second: self.length * load * load * (log + 0.25) / PI,
            }
        };
        let ([low, high], depth) = ([inner, outer].map(whole), self.level_to(outer) - self.level_to(inner));
        Moments {
            width: high.width - low.width,
            first: high.first - low.first - depth * low.width,
            second: high.second - low.second - depth * (2.0 * low.first + depth * low.width),
        }
    }
}
