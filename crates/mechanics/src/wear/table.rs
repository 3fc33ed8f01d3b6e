//! The limiting shape as a table, for computations that follow.
//!
//! The limit itself has a g that jumps from d - U0/m to d at c and is constant up to b. A table would round its way
//! about that constant, and a contact needs a g that rises. So the table has a smooth rise in place of the jump:
//! between c and b, with xi = (x - c)/(b - c), g = d - (U0/m) [(1 - xi)^n - k xi], where k is such that the surface
//! meets the unworn one at b as before. The largest exponent n is taken under which the g of the table does not fall.
//! The rise begins as far inside c as keeps the normal force, by the same formulas with a slightly larger amplitude.

use std::f64::consts::FRAC_2_PI;

use super::{WornContact, unworn_heights};
use crate::cells::shape::Shape;
use crate::contact::normal;
use crate::indenter::Indenter;
use crate::numerics::gauss::{TWENTY_POINTS, integral};
use crate::profile::{Profile, Tabulated};

/// Points of each half of a stretch between two places at which they crowd: c, b, and tip and rims of the unworn shape.
const HALF: usize = 128;
/// The power by which the distances from such a place grow.
const GROWTH: i32 = 2;
/// Knots of a table that has worn which are kept at most.
const MOST_KNOTS: usize = 4_000;
/// The most points of a stretch and knots together.
const MOST_POINTS: usize = 10_000;
/// How far the table goes on beyond the worn part, in its radius.
const REACH: f64 = 2.0;
/// Points closer together than this, in the worn radius, have slopes of rounding.
const LEAST_DISTANCE: f64 = 1e-8;
/// The exponents n, the shape nearest to the limit first.
const EXPONENTS: [i32; 6] = [512, 256, 128, 64, 32, 16];
/// (1 - xi)^n is integrated in panels over which it falls by about e^-6, until nothing is left.
const PANELS: usize = 6;
const PANEL_DECAY: f64 = 6.0;
/// The rise of g ends where (1 - xi)^n is about e^-3.
const RISE: f64 = 3.0;

/// A table of the limiting shape.
#[derive(Clone, Debug, PartialEq)]
pub struct WornTable {
    /// Radii, m.
    pub radii: Vec<f64>,
    /// Heights, m.
    pub heights: Vec<f64>,
    /// Error of the normal force of the table at the indentation of the contact, relative to that of the limit.
    pub normal_force_error: f64,
    /// The width about the stick radius within which g rises, where that of the limit jumps, m.
    pub rise_width: f64,
}

impl WornContact<'_> {
    /// The limiting shape as a table that contacts of any load can be computed with; `None` where there is none: the
    /// profile ends in a vertical edge, nothing wears, or so little that no table of it has a g that rises. It is
    /// `None` too once `keep_going` has returned false.
    #[must_use]
    pub fn table_while(&self, keep_going: &dyn Fn() -> bool) -> Option<WornTable> {
        if self.contact.indenter.rim_radius().is_some() || !self.wears() {
            return None;
        }
        let (first, exponent) =
            EXPONENTS.iter().find_map(|&exponent| Some((self.smooth(exponent, keep_going)?, exponent)))?;
        let error = |force: f64| (force / self.normal_force() - 1.0).abs();
        // The rise adds to the normal force what lies below it; it takes from it where it begins inside c.
        let inward = (first.1 - self.normal_force()) / (2.0 * self.contact.elasticity.e_star() * self.step);
        let begins = self.contact.indenter.level((self.stick.radius - inward).max(0.0));
        let amplitude = self.contact.scale() * (self.edge().level.value() - begins);
        let moved = WornContact::new(self.contact, amplitude).ok();
        let moved = moved.and_then(|moved| moved.smooth(exponent, keep_going));
        let ((table, force), inward) = match moved {
            Some(moved) if error(moved.1) < error(first.1) => (moved, inward),
            _ => (first, 0.0),
        };
        let rise = RISE / f64::from(exponent) * (self.worn.radius - self.stick.radius);
        Some(WornTable { normal_force_error: error(force), rise_width: rise.max(inward), ..table })
    }

    /// The table with this exponent, without its errors, and its normal force at the indentation of the contact, N;
    /// `None` if its g falls.
    fn smooth(&self, exponent: i32, keep_going: &dyn Fn() -> bool) -> Option<(WornTable, f64)> {
        let radii = self.table_radii();
        let unworn = unworn_heights(&self.contact.indenter, &radii);
        let is_worn = |radius: f64| radius > self.stick.radius && radius < self.worn.radius;
        let worn: Vec<f64> = radii.iter().copied().filter(|&radius| is_worn(radius)).collect();
        let limit = self.worn_heights(&worn);
        let slope = self.decay(self.worn.radius, exponent) / self.line(self.worn.radius);
        let below = |radius: f64| self.step * FRAC_2_PI * (self.decay(radius, exponent) - slope * self.line(radius));
        let mut worn = worn.iter().zip(&limit).map(|(&radius, limit)| limit - below(radius));
        let height = |(&radius, &unworn): (&f64, &f64)| {
            if is_worn(radius) { worn.next().map_or(unworn, |worn| worn.max(unworn)) } else { unworn }
        };
        let heights: Vec<f64> = radii.iter().zip(&unworn).map(height).collect();
        let table = Tabulated::new_while(&radii, &heights, keep_going).ok()?;
        table.end().filter(|end| end.radius > self.worn.radius)?;
        let table = Indenter::new(Profile::Tabulated(table));
        let force = normal::force(&table, &self.contact.elasticity, &table.point(self.edge().level));
        Some((WornTable { radii, heights, normal_force_error: 0.0, rise_width: 0.0 }, force))
    }

    /// int s dx/sqrt(r^2 - x^2) between two radii up to r, m, of a function s of xi, by t^2 = r^2 - x^2.
    fn smoothed(&self, radius: f64, [inner, outer]: [f64; 2], s: impl Fn(f64) -> f64) -> f64 {
        let below = |place: f64| ((radius - place) * (radius + place)).max(0.0).sqrt();
        let (low, high) = (below(outer), below(inner));
        let width = self.worn.radius - self.stick.radius;
        integral(&TWENTY_POINTS, high - low, |part| {
            let t = low + part;
            let x = ((radius - t) * (radius + t)).sqrt();
            s(((x - self.stick.radius) / width).clamp(0.0, 1.0)) / x
        })
    }

    /// int_c^r (1 - xi)^n dx/sqrt(r^2 - x^2).
    fn decay(&self, radius: f64, exponent: i32) -> f64 {
        let (stick, width) = (self.stick.radius, self.worn.radius - self.stick.radius);
        let share = |index: usize| (index as f64 * PANEL_DECAY / f64::from(exponent)).min(1.0);
        let end = |index: usize| radius.min(stick + width * share(index));
        (0..PANELS)
            .map(|index| self.smoothed(radius, [end(index), end(index + 1)], |xi| (1.0 - xi).powi(exponent)))
            .sum()
    }

    /// int_c^r xi dx/sqrt(r^2 - x^2).
    fn line(&self, radius: f64) -> f64 {
        self.smoothed(radius, [self.stick.radius, radius], |xi| xi)
    }

    /// The radii of the table, m.
    fn table_radii(&self) -> Vec<f64> {
        let profile = &self.contact.indenter;
        let (stick, worn) = (self.stick.radius, self.worn.radius);
        let end = self.reach(REACH);
        let singular = profile.singular_radii();
        let mut places = singular.clone();
        places.extend([0.0, stick, worn, end]);
        places.retain(|&place| place <= end);
        places.sort_by(f64::total_cmp);
        let knots = profile.knots_below(end);
        let mut radii = places.clone();
        radii.extend(knots.iter().step_by(knots.len().div_ceil(MOST_KNOTS).max(1)));
        let half_count = HALF.min((MOST_POINTS - MOST_KNOTS) / (3 * places.len()));
        for pair in places.windows(2) {
            let half = 0.5 * (pair[1] - pair[0]);
            // At a smooth centre nothing is to be resolved.
            let growth = if pair[0] > 0.0 || singular.contains(&0.0) { GROWTH } else { 1 };
            for share in (1..=half_count).map(|index| index as f64 / half_count as f64) {
                radii.extend([pair[0] + half * share.powi(growth), pair[1] - half * share.powi(GROWTH)]);
            }
        }
        radii.sort_by(f64::total_cmp);
        let mut kept: Vec<f64> = Vec::with_capacity(radii.len());
        for radius in radii {
            if kept.last().is_none_or(|last| radius - last > LEAST_DISTANCE * worn) {
                kept.push(radius);
            }
        }
        kept
    }
}
