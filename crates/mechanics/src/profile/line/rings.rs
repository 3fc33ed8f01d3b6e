//! The integrals of a line contact over a ring of levels, each to round-off of itself however thin the ring is.
//!
//! With y(s) the level, dX = X(s) - X(inner) and h = y(outer) - y: int h dX = int dX dy and int h^2 dX = 2 int h dX dy,
//! all of whose factors are positive. The rule of twenty points, and the integrals of the polynomial through them,
//! serve panels that are no longer than their distance from s = 0, where a cylinder has a logarithm, or than b, beside
//! whose i b a pad has one.

use std::f64::consts::{FRAC_2_PI, PI};

use super::{LineContact, Specimen};
use crate::numerics::gauss::{TWENTY_POINTS, to_the_end};
use crate::profile::Moments;

/// The weights of the integrals from each point of the rule to the end of a panel.
static TO_THE_END: [[f64; 20]; 20] = to_the_end(&TWENTY_POINTS);

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
            // The level knows the depth of a thin ring better than its ends do.
            let (moments, rise) = self.of_panel(inner, outer);
            let share = depth / rise;
            return Moments { first: share * moments.first, second: share * share * moments.second, ..moments };
        }
        let panels = ends.windows(2).rev();
        panels.fold(Moments::default(), |sum, panel| {
            let (moments, rise) = self.of_panel(panel[1], panel[0]);
            Moments::stack(sum, moments, rise)
        })
    }

    /// The moments of a panel, and by how much the level rises over it, m.
    fn of_panel(&self, inner: f64, outer: f64) -> (Moments, f64) {
        let (width, b) = (outer - inner, self.flat_half_width());
        let square = b * b + inner * inner;
        // ln(t/t(inner)); X - X(inner) is the unit times it over ln(l/t).
        let log = self.log_at(inner);
        let unit = 0.25 * PI * self.length / log;
        let widened = |step: f64| 0.5 * (step * (2.0 * inner + step) / square).ln_1p();
        let (mut rises, mut terms) = ([0.0; 20], [0.0; 20]);
        for (index, (share, weight)) in TWENTY_POINTS.into_iter().enumerate() {
            let step = width * share;
            let (gamma, widened) = (FRAC_2_PI * width * self.gamma(inner + step), widened(step));
            rises[index] = gamma * (log - widened);
            // The logarithm of X cancels that of the level.
            terms[index] = weight * gamma * unit * widened;
        }
        let mut moments = Moments { width: unit * widened(width) / self.log_at(outer), ..Moments::default() };
        for (left, term) in TO_THE_END.iter().zip(terms) {
            moments.first += term;
            moments.second += 2.0 * term * left.iter().zip(rises).map(|(weight, rise)| weight * rise).sum::<f64>();
        }
        (moments, TWENTY_POINTS.iter().zip(rises).map(|((_, weight), rise)| weight * rise).sum())
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
