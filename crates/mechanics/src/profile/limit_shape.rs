//! The limit of slip at a constant load as a shape: what a contact is pressed into along the surface.
//!
//! A spring at x slips where its deflection reaches B(x), which falls from the centre to the edge. So motion along the
//! surface at a constant load is that of a contact with mu = 1 whose shape is B(0) - B(x), and whose indentation is
//! B(0): the fall of B is a level, and its cells are what moves, forces, energies and stresses are made of. A law is a
//! file that makes these cells of those of the profile: [`strength_limit`](super::strength_limit),
//! [`twist_limit`](super::twist_limit).

use std::sync::Arc;

use super::{InterpolationError, Profile};
use crate::cells::ring::StressRadius;
use crate::cells::shape::{End, EndKind, Kink, Kinks, Powers, Shape};
use crate::cells::stages::Stages;
use crate::cells::{Cell, Cells};
use crate::numerics::chebyshev::{TWENTY_FOUR, counted};
use crate::numerics::double_double::DoubleDouble;

/// The share of the largest term up to which the last terms of a series are left out.
const NEGLIGIBLE: f64 = 1e-17;

/// The limit of slip of one contact.
#[derive(Clone, Debug, PartialEq)]
pub struct LimitShape {
    profile: Arc<Profile>,
    /// What the limit has of g; zero where its errors are not those of the profile, scaled.
    scale: f64,
    end: End,
    kinks: Kinks,
    stages: Stages,
}

/// Where a limit is not analytic, or a cell of the profile ends.
pub(super) struct Stretch<'a> {
    pub(super) from: DoubleDouble,
    pub(super) kink: f64,
    pub(super) powers: Powers,
    pub(super) cell: Option<&'a Cell>,
}

impl<'a> Stretch<'a> {
    /// From where a cell begins, above its kink or above `least`, m.
    pub(super) fn of(cell: &'a Cell, least: f64) -> Stretch<'a> {
        Stretch { from: cell.square, kink: cell.kink.max(least), powers: cell.begins_as(), cell: Some(cell) }
    }
}

impl LimitShape {
    /// Of the cells of a limit, that ends at a vertical edge if it is `upright`; `kinks` begin at a core or the centre.
    pub(super) fn new(
        (profile, scale): (&Arc<Profile>, f64),
        cells: Cells,
        (radius, upright): (f64, bool),
        kinks: Kinks,
    ) -> LimitShape {
        let kind = if upright { EndKind::Edge } else { EndKind::Unknown };
        let profile = Arc::clone(profile);
        LimitShape { profile, scale, end: End { radius, kind }, kinks, stages: Stages::whole(cells) }
    }

    /// B(0) - B(a) of a contact that ends at no vertical edge.
    pub(crate) fn depth(&self) -> DoubleDouble {
        self.stages.everything().map_or(DoubleDouble::ZERO, |cells| cells.top.level)
    }

    /// The interpolation error of the profile's table, as it is in the limit.
    pub(super) fn interpolation_error(&self, radius: f64) -> InterpolationError {
        if self.scale <= 0.0 {
            return InterpolationError::default();
        }
        let InterpolationError { load, level, kernel } = self.profile.interpolation_error(radius);
        InterpolationError { load: self.scale * load, level: self.scale * level, kernel: self.scale * kernel }
    }

    /// How many times larger the parts of g are than g.
    pub(super) fn cancellation(&self, radius: f64) -> f64 {
        if self.scale > 0.0 { self.profile.cancellation(radius) } else { 1.0 }
    }
}

/// The kinks of a profile between two squares, m^2, behind one where the limit begins, all at the places to which `to`
/// leads their squares.
pub(super) fn kinks(
    profile: &Profile,
    [begin, edge]: [DoubleDouble; 2],
    to: impl Fn(DoubleDouble) -> DoubleDouble,
) -> Kinks {
    let at = |square: DoubleDouble| StressRadius { radius: to(square).value().sqrt(), square: to(square) };
    let own = profile.shape().map_or_else(|| Kinks::from([]), Shape::kinks);
    let placed = |kink: &Kink| Kink { at: at(kink.at.square), powers: kink.powers.and(Powers::Odd) };
    let first = own.iter().find(|kink| kink.at.square == begin && begin < edge);
    let first = first.map_or(Kink { at: at(begin), powers: Powers::Odd }, placed);
    let inside = own.iter().filter(|kink| kink.at.square > begin && kink.at.square < edge);
    [first].into_iter().chain(inside.map(placed)).collect()
}

/// The cell above a square, m^2, that is so wide in squares, of gamma over t.
pub(super) fn fitted(kink: f64, square: DoubleDouble, width: f64, powers: Powers, gamma: impl Fn(f64) -> f64) -> Cell {
    let high = width.sqrt();
    let power = match powers {
        Powers::All(power) => Some(power as i32),
        _ => None,
    };
    let values = TWENTY_FOUR.places(0.0, 1.0).map(|place| {
        let u = if power.is_some() { place } else { place.sqrt() };
        gamma(high * u) / power.map_or(u, |power| u.powi(power))
    });
    let terms = TWENTY_FOUR.terms(&values);
    Cell::new(kink, square, high, counted(&terms, NEGLIGIBLE), powers)
}

impl Shape for LimitShape {
    fn kinks(&self) -> Kinks {
        Arc::clone(&self.kinks)
    }

    fn level(&self, x: f64) -> f64 {
        self.stages.everything().map_or(0.0, |cells| cells.level(x))
    }

    fn gamma(&self, base: f64, t: f64) -> f64 {
        self.stages.everything().map_or(0.0, |cells| cells.gamma(base, t))
    }

    fn surface_slope(&self, r: f64) -> f64 {
        self.profile.surface_slope(r)
    }

    fn stages(&self) -> &Stages {
        &self.stages
    }

    fn end(&self) -> Option<End> {
        Some(self.end)
    }
}
