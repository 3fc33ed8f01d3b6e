//! The limit of friction and a shear strength: |tau| <= tau_0 + mu p (Bowden & Tabor).
//!
//! Under the Abel transform B(x) = m (d - g(x)) + q sqrt(a^2 - x^2), m = mu E*/G* and q = 2 tau_0/G*. The root has a
//! branch point at the edge; each cell is at most half as wide in x^2 as the edge is far away, down to 1e-15 of the
//! radius, in sqrt(a^2 - x^2).

use std::sync::Arc;

use super::Profile;
use super::limit_shape::{LimitShape, Stretch, fitted, kinks};
use crate::cells::shape::Powers;
use crate::cells::{Cell, Cells};
use crate::numerics::double_double::DoubleDouble;

/// The width of a cell over the distance of the edge, in squares, by which twenty-four points leave 1e-18: of a series
/// in squares, and of one in all powers.
const WIDTH: f64 = 0.5;
const WIDTH_OF_ALL_POWERS: f64 = 0.25;
/// The distance from the edge over a^2, in squares, of which one cell is made: an excess of 1e-15 of the limit.
const LAST: f64 = 1e-30;

/// The law of a contact at its load.
pub(crate) struct Strength<'a> {
    /// The cells of the profile.
    pub(crate) cells: &'a Cells,
    /// The square of the contact radius, m^2, and whether it is that of a vertical edge.
    pub(crate) edge: DoubleDouble,
    pub(crate) upright: bool,
    /// m.
    pub(crate) scale: f64,
    /// q, which is -B'(x)/x times sqrt(a^2 - x^2), of the strength.
    pub(crate) root: f64,
}

impl Strength<'_> {
    /// The limit.
    pub(crate) fn limit(&self, profile: &Arc<Profile>) -> LimitShape {
        let cells = self.cells.cells.iter().filter(|cell| self.scale > 0.0 && cell.square < self.edge);
        let mut stretches: Vec<Stretch<'_>> = cells.map(|cell| Stretch::of(cell, 0.0)).collect();
        if stretches.first().is_none_or(|first| first.from > DoubleDouble::ZERO) {
            stretches.insert(0, Stretch { from: DoubleDouble::ZERO, kink: 0.0, powers: Powers::Odd, cell: None });
        }
        let mut made = Vec::new();
        for (index, stretch) in stretches.iter().enumerate() {
            let to = stretches.get(index + 1).map_or(self.edge, |next| next.from);
            self.divide(stretch, to, &mut made);
        }
        let end = if self.scale > 0.0 { self.edge } else { DoubleDouble::ZERO };
        let kinks = kinks(profile, [DoubleDouble::ZERO, end], |square| square);
        let cells = Cells::new(made, Some(self.edge)).with_all_digits();
        LimitShape::new((profile, self.scale), cells, (self.edge.value().sqrt(), self.upright), kinks)
    }

    /// The cells of a stretch up to the square `to`, m^2.
    fn divide(&self, stretch: &Stretch<'_>, to: DoubleDouble, made: &mut Vec<Cell>) {
        let (mut square, mut powers) = (stretch.from, stretch.powers);
        loop {
            let (whole, left) = ((to - square).value(), (self.edge - square).value());
            if whole <= 0.0 {
                return;
            }
            if whole >= left && left <= LAST * self.edge.value() {
                // sqrt(a^2 - x^2) falls to zero by a parabola here.
                made.push(Cell::new(stretch.kink, square, left.sqrt(), &[2.0 * self.root], Powers::Odd));
                return;
            }
            let most = if powers == Powers::Odd { WIDTH } else { WIDTH_OF_ALL_POWERS } * left;
            let width = if whole <= most { whole } else { most.min(0.5 * whole) };
            made.push(fitted(stretch.kink, square, width, powers, |t| {
                let above = square + DoubleDouble::square_of(t);
                let own = stretch.cell.map_or(0.0, |cell| cell.slope_over_radius(cell.zeta(above)) * t);
                self.scale * own + self.root * t / (left - t * t).sqrt()
            }));
            square = square + DoubleDouble::from(width);
            powers = Powers::Odd;
        }
    }
}
