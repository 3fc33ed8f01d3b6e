//! The places of a cell at which g, or the load, has risen by so much.

use super::{Cell, Part};
use crate::numerics::gauss::TWELVE_POINTS;
use crate::numerics::roots::within;

/// Two ends whose squares differ by more than this share of the outer one have a difference with all its digits.
const APART: f64 = 0.2;

impl Cell {
    /// The rise of g, m, from b up to zeta, and gamma there, side by side.
    fn rise_and_gamma(&self, zeta: f64) -> (f64, f64) {
        let u = zeta / self.high;
        let (mut rise, mut gamma) = (0.0, 0.0);
        if self.odd {
            let square = u * u;
            for (a, b) in self.integrals.iter().zip(&self.powers).skip(1).step_by(2).rev() {
                rise = rise * square + a;
                gamma = gamma * square + b;
            }
            return (zeta * u * rise, u * gamma);
        }
        for (a, b) in self.integrals.iter().zip(&self.powers).rev() {
            rise = rise * u + a;
            gamma = gamma * u + b;
        }
        (zeta * rise, gamma)
    }

    /// zeta, m, where g has risen by this much, m, from b on.
    pub(crate) fn zeta_of(&self, rise: f64) -> f64 {
        let share = root((rise / self.depth).min(1.0), self.order);
        within([0.0, self.high], share * self.high, |zeta| {
            let (reached, gamma) = self.rise_and_gamma(zeta);
            (reached - rise, gamma)
        })
    }

    /// The difference of the squares, m^2, between two places at these squares above b^2 that the rise `depth`, m,
    /// separates; by the rise alone where the squares are `rounded`.
    pub(crate) fn gap(&self, low: f64, high: f64, depth: f64, rounded: bool) -> f64 {
        let (plain, top) = (high - low, high.sqrt());
        // The squares of a contact may be so small that they are zero.
        if (plain > APART * high && !rounded) || top <= 0.0 {
            return plain;
        }
        let steep = self.gamma(top);
        if steep <= 0.0 {
            return plain;
        }
        let start = if plain > 1e-10 * high { plain / (top + low.sqrt()) } else { (depth / steep).min(0.5 * top) };
        let mut flat = false;
        let drop = within([0.0, top], start, |drop| {
            let low = (top - drop).max(0.0);
            let steep = self.gamma(low);
            flat |= steep <= 0.0;
            (self.rise(Part { low, high: top, drop }) - depth, steep)
        });
        if flat { plain } else { drop * (top + top - drop) }
    }

    /// int x dg, m^2, from b up to zeta, m.
    pub(crate) fn load_to(&self, zeta: f64) -> f64 {
        let places = TWELVE_POINTS.map(|(share, _)| zeta * share);
        let gammas = self.gammas(places);
        let term = |lane: usize| TWELVE_POINTS[lane].1 * gammas[lane] * self.radius_at(places[lane]);
        zeta * (0..TWELVE_POINTS.len()).map(term).sum::<f64>()
    }

    /// zeta, m, where int x dg from b on is this much, m^2, of the `whole` of the cell.
    pub(crate) fn zeta_of_load(&self, load: f64, whole: f64) -> f64 {
        let order = if self.radius > 0.0 { self.order } else { self.order + 1 };
        let share = root((load / whole).min(1.0), order);
        within([0.0, self.high], share * self.high, |zeta| {
            (self.load_to(zeta) - load, self.radius_at(zeta) * self.gamma(zeta))
        })
    }
}

/// The root of this order.
fn root(share: f64, order: i32) -> f64 {
    match order {
        1 => share,
        2 => share.sqrt(),
        3 => share.cbrt(),
        _ => share.powf(f64::from(order).recip()),
    }
}
