//! The limit of friction at a constant load as a shape: what a contact is pressed into sideways.
//!
//! With |tau| <= tau_0 + mu p a spring at x slips where its displacement reaches B(x) = m (d - g(x)) + q sqrt(a^2 -
//! x^2), m = mu E*/G* and q = 2 tau_0/G* (Bowden & Tabor's law under the Abel transform). B falls from the centre to
//! the edge. So tangential motion at a constant load is that of a contact with mu = 1 and E* = G*, whose shape is
//!
//! g_B(x) = B(0) - B(x) = m g(x) + q (a - sqrt(a^2 - x^2)),
//!
//! and whose indentation is B(0): the fall of B is a level, and its cells are what moves, forces, energies and stresses
//! are made of. The root has a branch point at the edge; each cell is at most half as wide in x^2 as the edge is far
//! away, down to 1e-15 of the radius, in sqrt(a^2 - x^2).

use std::sync::Arc;

use super::{InterpolationError, Profile};
use crate::cells::shape::{End, EndKind, Kink, Kinks, Powers, Shape};
use crate::cells::stages::Stages;
use crate::cells::{Cell, Cells};
use crate::numerics::chebyshev::{TWENTY_FOUR, counted};
use crate::numerics::double_double::DoubleDouble;

/// The width of a cell over the distance of the edge, in squares, by which twenty-four points leave 1e-18: of a series
/// in squares, and of one in all powers.
const WIDTH: f64 = 0.5;
const WIDTH_OF_ALL_POWERS: f64 = 0.25;
/// The distance from the edge over a^2, in squares, of which one cell is made: an excess of 1e-15 of the limit.
const LAST: f64 = 1e-30;
/// The share of the largest term up to which the last terms of a series are left out.
const NEGLIGIBLE: f64 = 1e-17;

/// The limit of friction of one contact.
#[derive(Clone, Debug, PartialEq)]
pub struct LimitShape {
    profile: Arc<Profile>,
    /// m, and q.
    scale: f64,
    root: f64,
    end: End,
    kinks: Kinks,
    stages: Stages,
}

/// Where the shape is not analytic, or a cell of the profile ends.
struct Stretch<'a> {
    from: DoubleDouble,
    kink: f64,
    powers: Powers,
    cell: Option<&'a Cell>,
}

impl LimitShape {
    /// The limit of a contact whose edge is at the square `edge`, m^2, on a vertical edge of the profile if it is
    /// `upright`; `cells` are those of the profile.
    pub(crate) fn new(
        profile: Arc<Profile>,
        cells: &Cells,
        (edge, upright): (DoubleDouble, bool),
        (scale, root): (f64, f64),
    ) -> LimitShape {
        let radius = edge.value().sqrt();
        let mut stretches = vec![Stretch { from: DoubleDouble::ZERO, kink: 0.0, powers: Powers::Odd, cell: None }];
        for cell in cells.cells.iter().filter(|cell| scale > 0.0 && cell.square < edge) {
            if stretches.len() == 1 && cell.square == DoubleDouble::ZERO {
                stretches.clear();
            }
            let powers = cell.begins_as();
            stretches.push(Stretch { from: cell.square, kink: cell.kink, powers, cell: Some(cell) });
        }
        let mut made = Vec::new();
        for (index, stretch) in stretches.iter().enumerate() {
            let to = stretches.get(index + 1).map_or(edge, |next| next.from);
            stretch.divide((to, edge), (scale, root), &mut made);
        }
        let own = profile.shape().map_or_else(|| Kinks::from([]), Shape::kinks);
        let mut kinks: Vec<Kink> = own.iter().copied().filter(|kink| scale > 0.0 && kink.at.square < edge).collect();
        for kink in &mut kinks {
            kink.powers = kink.powers.and(Powers::Odd);
        }
        if kinks.first().is_none_or(|first| first.at.radius > 0.0) {
            kinks.insert(0, Kink::new(0.0, Powers::Odd));
        }
        let kind = if upright { EndKind::Edge } else { EndKind::Unknown };
        let stages = Stages::whole(Cells::new(made, Some(edge)).with_all_digits());
        LimitShape { profile, scale, root, end: End { radius, kind }, kinks: kinks.into(), stages }
    }

    /// B(0) - B(a), m, of a contact that ends at no vertical edge.
    pub(crate) fn depth(&self) -> DoubleDouble {
        self.stages.everything().map_or(DoubleDouble::ZERO, |cells| cells.top.level)
    }

    /// The interpolation error of the profile's table, as it is in the limit.
    pub(super) fn interpolation_error(&self, radius: f64) -> InterpolationError {
        let InterpolationError { load, level, kernel } = self.profile.interpolation_error(radius);
        InterpolationError { load: self.scale * load, level: self.scale * level, kernel: self.scale * kernel }
    }

    /// How many times larger the parts of g are than g.
    pub(super) fn cancellation(&self, radius: f64) -> f64 {
        self.profile.cancellation(radius)
    }
}

impl Stretch<'_> {
    /// Its cells up to the square `to`, m^2.
    fn divide(&self, (to, edge): (DoubleDouble, DoubleDouble), (scale, root): (f64, f64), made: &mut Vec<Cell>) {
        let (mut square, mut powers) = (self.from, self.powers);
        loop {
            let (whole, left) = ((to - square).value(), (edge - square).value());
            if whole <= 0.0 {
                return;
            }
            if whole >= left && left <= LAST * edge.value() {
                // sqrt(a^2 - x^2) falls to zero by a parabola here.
                made.push(Cell::new(self.kink, square, left.sqrt(), &[2.0 * root], Powers::Odd));
                return;
            }
            let most = if powers == Powers::Odd { WIDTH } else { WIDTH_OF_ALL_POWERS } * left;
            let width = if whole <= most { whole } else { most.min(0.5 * whole) };
            made.push(fitted(self.kink, square, width, powers, |t| {
                let above = square + DoubleDouble::square_of(t);
                let own = self.cell.map_or(0.0, |cell| cell.slope_over_radius(cell.zeta(above)) * t);
                scale * own + root * t / (left - t * t).sqrt()
            }));
            square = square + DoubleDouble::from(width);
            powers = Powers::Odd;
        }
    }
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
        let a = self.end.radius;
        let own = if self.scale > 0.0 { self.scale * self.profile.level(x) } else { 0.0 };
        own + self.root * x * x / (a + ((a - x) * (a + x)).max(0.0).sqrt())
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
