//! The reference that errors are measured against: the displacement as straight pieces, in double-double arithmetic.
//!
//! At a level y = g(x) the foundation has the displacement w(y) = u_x/m. A straight move that adds dW to the rigid
//! displacement and ends at the indentation d changes it to w + dW, clamped to +-(d - y). Here that rule is applied to
//! every piece at every move: all corners are shifted, those beyond the bound are moved onto it, and a corner is added
//! where a piece crosses it. Nothing is shared with the engine but the arithmetic: no piece is skipped because theory
//! says that it sticks, nothing is stored relative to anything, no sum is kept from one move to the next. Force and
//! stress come from closed forms of [`Shape`], in 31 digits.

use stickslip_mechanics::DoubleDouble;

use super::scenes::{DEPTH, E_STAR, FRICTION, G_STAR, Scene};
use super::shape::{Shape, pi};

/// A corner of w(y).
#[derive(Clone, Copy)]
struct Corner {
    level: DoubleDouble,
    radius: DoubleDouble,
    w: DoubleDouble,
    /// +1 or -1 on the bound of that sign, 0 within.
    bound: i8,
}

impl Corner {
    fn new(shape: &Shape, level: DoubleDouble) -> Corner {
        Corner { level, radius: shape.radius(level), w: DoubleDouble::ZERO, bound: 0 }
    }
}

/// The contact of a scene.
pub(super) struct Reference<'a> {
    shape: &'a Shape,
    /// m = mu E*/G*.
    scale: DoubleDouble,
    indentation: DoubleDouble,
    displacement: DoubleDouble,
    /// From the centre to the edge.
    corners: Vec<Corner>,
}

impl<'a> Reference<'a> {
    /// The contact of a scene after its path, and a value of it after each move.
    pub(super) fn follow(scene: &'a Scene, value: impl Fn(&Reference<'a>) -> f64) -> (Reference<'a>, Vec<f64>) {
        let (shape, indentation) = (&scene.shape, DoubleDouble::from(DEPTH));
        let mut reference = Reference {
            scale: (DoubleDouble::from(E_STAR) * FRICTION).over(DoubleDouble::from(G_STAR)),
            corners: [DoubleDouble::ZERO, indentation].map(|level| Corner::new(shape, level)).into(),
            displacement: DoubleDouble::ZERO,
            shape,
            indentation,
        };
        let step = |&(depth, displacement): &(f64, f64)| {
            reference.advance(depth, displacement);
            value(&reference)
        };
        let values = scene.path.iter().map(step).collect();
        (reference, values)
    }

    /// Moves straight to an indentation, m, above zero and a displacement, m.
    fn advance(&mut self, indentation: f64, displacement: f64) {
        let (indentation, displacement) = (DoubleDouble::from(indentation), DoubleDouble::from(displacement));
        let shift = (displacement - self.displacement).over(self.scale);
        let mut trial: Vec<Corner> = self.corners.iter().map(|at| Corner { w: at.w + shift, ..*at }).collect();
        if indentation > self.indentation {
            // A point that comes into contact on the way is displaced by less the later that is, at the new edge by
            // nothing.
            trial.push(Corner::new(self.shape, indentation));
        } else if indentation < self.indentation {
            let cut = trial.iter().position(|at| at.level >= indentation).unwrap_or(trial.len() - 1).max(1);
            // On the straight piece between two corners.
            let (inner, outer) = (trial[cut - 1], trial[cut]);
            let w = inner.w + (outer.w - inner.w) * (indentation - inner.level).over(outer.level - inner.level);
            trial.truncate(cut);
            trial.push(Corner { w, ..Corner::new(self.shape, indentation) });
        }
        self.indentation = indentation;
        self.displacement = displacement;
        self.corners = without_inner_corners(&self.clamped(&trial));
    }

    /// All corners within their bounds, with a new one wherever a piece crosses its bound.
    fn clamped(&self, trial: &[Corner]) -> Vec<Corner> {
        let mut all: Vec<Corner> = Vec::with_capacity(trial.len() + 2);
        let excess = |at: &Corner, sign: f64| at.w.signed(sign) - (self.indentation - at.level);
        let before = std::iter::once(None).chain(trial.iter().map(Some));
        for (at, inner) in trial.iter().zip(before) {
            for (sign, inner) in [1.0, -1.0].into_iter().filter_map(|sign| Some((sign, inner?))) {
                let (before, after) = (excess(inner, sign), excess(at, sign));
                if before < DoubleDouble::ZERO && after > DoubleDouble::ZERO {
                    let part = (-before).over(after - before);
                    let level = inner.level + (at.level - inner.level) * part;
                    let w = (self.indentation - level).signed(sign);
                    all.push(Corner { w, bound: sign as i8, ..Corner::new(self.shape, level) });
                }
            }
            let bound = self.indentation - at.level;
            let slipped = at.w.abs() >= bound;
            let sign = if at.w < DoubleDouble::ZERO { -1.0 } else { 1.0 };
            let w = if slipped { bound.signed(sign) } else { at.w };
            all.push(Corner { w, bound: if slipped { sign as i8 } else { 0 }, ..*at });
        }
        all
    }

    fn pieces(&self) -> impl Iterator<Item = (&Corner, &Corner, DoubleDouble)> {
        let straight = self.corners.windows(2).map(|pair| (&pair[0], &pair[1]));
        straight.filter(|(inner, outer)| outer.level > inner.level).map(|(inner, outer)| {
            let slope = (outer.w - inner.w).over(outer.level - inner.level);
            (inner, outer, slope)
        })
    }

    /// Tangential force, N: 2 mu E* int w dx, and w = alpha + beta g on each piece.
    pub(super) fn force(&self) -> f64 {
        let sum = self.pieces().fold(DoubleDouble::ZERO, |sum, (inner, outer, slope)| {
            let width = outer.radius - inner.radius;
            let grown = self.shape.integral(outer.radius) - self.shape.integral(inner.radius);
            sum + (inner.w - slope * inner.level) * width + slope * grown
        });
        (sum * E_STAR * FRICTION * 2.0).value()
    }

    /// Shear stress, Pa, at a radius, m, above zero.
    pub(super) fn shear(&self, radius: f64) -> f64 {
        let mut inner_kernel = None;
        let sum = self.pieces().fold(DoubleDouble::ZERO, |sum, (inner, outer, slope)| {
            let low = inner_kernel.unwrap_or_else(|| self.shape.kernel(radius, inner.radius));
            let high = self.shape.kernel(radius, outer.radius);
            inner_kernel = Some(high);
            sum - slope * (high - low)
        });
        (sum * E_STAR * FRICTION).over(pi()).value()
    }

    /// Radii, m, where the displacement has a kink, strictly inside the contact.
    pub(super) fn kinks(&self) -> Vec<f64> {
        let inside = self.corners.iter().skip(1).take(self.corners.len().saturating_sub(2));
        inside.map(|at| at.radius.value()).collect()
    }
}

/// Drops the corners inside a slip ring, where w is straight already.
fn without_inner_corners(corners: &[Corner]) -> Vec<Corner> {
    let inside = |index: usize| {
        let near = (corners.get(index.wrapping_sub(1)), corners.get(index), corners.get(index + 1));
        matches!(near, (Some(a), Some(b), Some(c)) if b.bound != 0 && a.bound == b.bound && c.bound == b.bound)
    };
    (0..corners.len()).filter(|&index| !inside(index)).map(|index| corners[index]).collect()
}
