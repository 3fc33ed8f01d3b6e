//! Moments of rings of a table that cross a knot: the parts at both ends by [`PanelIntegrals`](super::panel_integrals), the whole panels
//! between by the tree of their sums.

use super::super::{DoubleDouble, Moments, Ring};
use super::{Tabulated, near_kernel};

impl Tabulated {
    /// The moments of a ring; `None` of one that lies in one panel or meets the end of the table, and where a part is too thin for its
    /// series to resolve.
    pub(super) fn moments_across(&self, ring: &Ring) -> Option<Moments> {
        let (inner, outer) = (self.by_radius.holding(ring.inner.radius), self.by_radius.ending_at(ring.outer.radius));
        if inner >= outer || ring.outer.level > DoubleDouble::from(self.end.1) {
            return None;
        }
        let (bottom, next, top) = (&self.panels[inner], &self.panels[inner + 1], &self.panels[outer]);
        if top.powers.is_empty() {
            return None;
        }
        let part = ring.inner.radius > bottom.radius;
        let (mut sum, between) = self.tree.run(if part { inner + 1 } else { inner }, outer);
        if part {
            let width = (next.square - ring.inner.square).value().max(0.0) / (next.radius + ring.inner.radius);
            let below = bottom.integrals.above(bottom.place(bottom.t_of(ring.inner.square)), width);
            sum = Moments::stack(below, sum, between);
        }
        let beyond = (ring.outer.square - top.square).value().max(0.0);
        let t = top.t_of(ring.outer.square);
        let rise = near_kernel::rise(top, t, beyond);
        let above = top.integrals.below(top.place(t), beyond / (ring.outer.radius + top.radius), rise);
        sum = Moments::stack(sum, above, rise);
        (top.integrals.resolve(&sum) && (!part || bottom.integrals.resolve(&sum))).then_some(sum)
    }
}
