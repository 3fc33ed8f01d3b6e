//! The limit law: how stiff a spring is, and how far it can be carried before it slips.
//!
//! A half-space is pointwise in x under the Abel transform, so that a contact is a row of springs along x with a
//! stiffness k(x) dx and a limit of deflection B(x) each. The slip history is exact for every law whose slip is an
//! outer annulus of one sign, and whose B falls with x and either stays or changes by the same amount everywhere: it is
//! then w over the *level*, which is by how much B has fallen from that of the centre. Over the level the displacement
//! is made of straight pieces with slopes from -1 to 1, whatever the law, and all that a history asks of a law is which
//! springs there are up to a level, and integrals of k and k B over the levels of a ring. That is what a curve is, so
//! that a law at constant load is a virtual curve.
//!
//! [`Coulomb`] is the law of mu times the pressure: k = 2 G* and B = m (d - g(x)) (Ciavarella 1998; Jäger 1998). In
//! units of m its level is g itself, the same under every load, so that its history outlives a change of the load.

use crate::cells::ring::{Moments, Point, Ring};
use crate::indenter::Indenter;
use crate::numerics::double_double::DoubleDouble;

/// What a slip history asks of a law. Lengths of deflection are scaled, so that slopes are -1 to 1, and stiffnesses are
/// over that of a unit of length, so that they are lengths or powers of lengths.
pub(crate) trait Limit {
    /// The springs up to a level: `radius` is their stiffness, int k dx, and `square` the square of the place, m^2.
    fn point(&self, level: DoubleDouble) -> Point;

    /// The springs whose limit is the largest: where gross slip ends.
    fn centre(&self) -> Point;

    /// int k dx, int h k dx and int h^2 k dx over the springs of a ring, h the level of its outer end less that of the
    /// spring.
    fn moments(&self, ring: &Ring) -> Moments;
}

/// |tau| <= mu p.
#[derive(Clone, Copy)]
pub(crate) struct Coulomb<'a>(pub(crate) &'a Indenter);

impl Limit for Coulomb<'_> {
    #[inline]
    fn point(&self, level: DoubleDouble) -> Point {
        self.0.point(level)
    }

    fn centre(&self) -> Point {
        *self.0.flat()
    }

    #[inline]
    fn moments(&self, ring: &Ring) -> Moments {
        self.0.moments(ring)
    }
}
