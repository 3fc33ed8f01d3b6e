//! The first loading curve of a contact at its present load, whatever its history: by Masing's rules (1926) every
//! branch at constant load is a part of it.
//!
//! A displacement U from rest slips the ring d - U/m < y < d, m = mu E*/G*, and takes F = 2 mu E* int X dy over that
//! ring. Its slope dF/dU = 2 G* X(d - U/m) falls.

use super::Contact;
use super::normal::load;
use crate::numerics::double_double::DoubleDouble;
use crate::profile::Ring;

/// The curve of a contact without a bulk stress.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FirstLoading<'a>(pub(crate) &'a Contact);

impl FirstLoading<'_> {
    /// The displacement of gross slip, m.
    pub(crate) fn gross_slip(&self) -> f64 {
        self.0.unscaled(self.0.history.edge().level).value().max(0.0)
    }

    /// The ring that has slipped after a displacement that is scaled, m.
    pub(crate) fn slipped(&self, scaled: DoubleDouble) -> Ring {
        let edge = *self.0.history.edge();
        let level = edge.level - scaled;
        // The displacement of gross slip is rounded.
        let level = if level.value() < 0.0 { DoubleDouble::ZERO } else { level };
        Ring::between(self.0.indenter.point(level), edge)
    }

    /// The force, N, at a displacement above zero that does not slide, m.
    pub(crate) fn force(&self, displacement: f64) -> f64 {
        let ring = self.slipped(self.0.scaled(DoubleDouble::from(displacement)));
        self.0.force_unit() * load(&self.0.indenter, &ring)
    }

    /// How much the force grows, N, between two displacements, m.
    pub(crate) fn rise(&self, from: f64, to: f64) -> f64 {
        let inner = self.slipped(self.0.scaled(DoubleDouble::from(to))).inner;
        let outer = self.slipped(self.0.scaled(DoubleDouble::from(from))).inner;
        self.0.force_unit() * load(&self.0.indenter, &Ring::between(inner, outer))
    }

    /// The slope, N/m, at a displacement, m.
    pub(crate) fn stiffness(&self, displacement: f64) -> f64 {
        let inner = self.slipped(self.0.scaled(DoubleDouble::from(displacement))).inner;
        2.0 * self.0.elasticity.g_star() * inner.radius
    }

    /// The displacement, m, at which the slope is this, N/m.
    pub(crate) fn displacement_of_stiffness(&self, stiffness: f64) -> f64 {
        let radius = stiffness / (2.0 * self.0.elasticity.g_star());
        let level = DoubleDouble::from(self.0.indenter.level(radius));
        self.0.unscaled(self.0.history.edge().level - level).value()
    }
}
