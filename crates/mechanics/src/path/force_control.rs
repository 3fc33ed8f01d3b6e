//! Force control: the displacement that gives a tangential force at a given indentation.
//!
//! While nothing slips the force is linear in the displacement. From there it grows as the slip ring spreads inward
//! through the pieces, outermost first: a piece of slope beta that slips towards s gains (1 + s beta) int X dy. So the
//! piece in which the wanted force is met is found by adding, and the radius within it by the inverse of int X dy:
//! measured from the nearer end, so that neither a tiny change of force nor the last 1e-15 before the limit mu F_N
//! loses its digits.

use crate::contact::Contact;
use crate::contact::normal::{depth_for, load};
use crate::numerics::double_double::DoubleDouble;
use crate::profile::{Point, Ring};

/// The stack brought to a new edge, before the slip ring grows towards `sign`.
struct SlipFront {
    edge: Point,
    sign: f64,
    /// Pieces that are still whole or cut at the edge; the rings beyond them slip.
    held: usize,
    /// int w dx that is still to be gained, m^2.
    missing: f64,
    /// Distance of the wanted magnitude from the friction limit, m^2.
    room: f64,
}

impl Contact {
    /// The displacement U, m, of [`Contact::position_for`]; the present one where friction holds nothing, because then
    /// every displacement has the force zero.
    pub(crate) fn displacement_for(&self, indentation: DoubleDouble, normal_force: f64, target: f64) -> DoubleDouble {
        if self.friction * normal_force <= 0.0 {
            return self.displacement;
        }
        self.unscaled(self.position_for(indentation, normal_force, target))
    }

    /// The scaled displacement W, m, at which the contact carries the tangential force `target`, N, once it has moved
    /// straight to `indentation` and the `normal_force`, N, that belongs to it. Friction must be able to hold the
    /// target.
    fn position_for(&self, indentation: DoubleDouble, normal_force: f64, target: f64) -> DoubleDouble {
        let wanted = target / self.force_unit();
        // Just below the limit the low digits of the product decide how much still sticks.
        let room = (DoubleDouble::from(normal_force) * self.friction - DoubleDouble::from(target.abs())).value()
            / self.force_unit();
        let edge = self.indenter.point(indentation);
        let history = &self.history;
        let position = history.position();
        if !history.in_contact() || indentation > history.edge().level {
            let from = if history.in_contact() { *history.edge() } else { self.indenter.point(DoubleDouble::ZERO) };
            let touched = Ring::between(from, edge);
            let stiffness = from.radius + self.indenter.moments(&touched).first / touched.depth;
            let change = (wanted - history.force()) / stiffness;
            if change.abs() <= touched.depth {
                return position + DoubleDouble::from(change);
            }
            let sign = change.signum();
            let missing = (change.abs() - touched.depth) * stiffness;
            self.slip_to(&SlipFront { edge, sign, held: history.pieces().len(), missing, room }, wanted)
        } else {
            let held = history.pieces().partition_point(|piece| piece.inner.level < indentation);
            let neutral = held.checked_sub(1).map_or(DoubleDouble::ZERO, |top| {
                let line = &history.pieces()[top].line;
                history.force_below(top) - line.slope * load(&self.indenter, &self.cut(top, held, &edge))
            });
            let change = (DoubleDouble::from(wanted) - neutral).value();
            let front = SlipFront { edge, sign: change.signum(), held, missing: change.abs(), room };
            self.slip_to(&front, wanted)
        }
    }

    /// 2 G* m: tangential force, N, over int_0^a w dx, m^2.
    pub(crate) fn force_unit(&self) -> f64 {
        2.0 * self.elasticity.g_star() * self.scale()
    }

    /// The ring of piece `index` of the first `held`, of which the outermost may end at a new edge.
    fn cut(&self, index: usize, held: usize, edge: &Point) -> Ring {
        let ring = self.history.ring(index);
        if index + 1 == held && edge.level < ring.outer.level { Ring::between(ring.inner, *edge) } else { ring }
    }

    fn slip_to(&self, front: &SlipFront, wanted: f64) -> DoubleDouble {
        let history = &self.history;
        let &SlipFront { edge, sign, held, mut missing, room } = front;
        let reference = history.position() - history.shift();
        for index in (0..held).rev() {
            let ring = self.cut(index, held, &edge);
            let line = &history.pieces()[index].line;
            let closing = 1.0 + sign * line.slope.value();
            let gain = closing * load(&self.indenter, &ring);
            if gain < missing && index > 0 {
                missing -= gain;
                continue;
            }
            let level = if missing <= 0.5 * gain {
                ring.outer.level - DoubleDouble::from(depth_for(&self.indenter, &ring, false, missing / closing))
            } else {
                // Towards the far limit slip reaches the centre at mu F_N; for pieces further out the force inside them
                // is summed.
                let spare =
                    if index == 0 && sign * wanted > 0.0 { room } else { self.spare_below(index, &edge, sign, wanted) };
                ring.inner.level + DoubleDouble::from(depth_for(&self.indenter, &ring, true, spare / closing))
            };
            // There the stuck value w - W meets the bound sign (d - y) - W.
            return reference + (edge.level - level) * sign - line.at(level);
        }
        // Nothing was held before: all that has been touched slips.
        reference + history.shift() + edge.level * sign
    }

    /// By how much int w dx would pass `wanted` if slip reached the inner end of piece `index`, m^2.
    fn spare_below(&self, index: usize, edge: &Point, sign: f64, wanted: f64) -> f64 {
        let beyond = Ring::between(self.history.pieces()[index].inner, *edge);
        let full = self.history.force_below(index) * sign + DoubleDouble::from(load(&self.indenter, &beyond));
        (full - DoubleDouble::from(sign * wanted)).value()
    }
}
