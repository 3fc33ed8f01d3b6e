//! Flat punch of radius b: X(y) = b for every level, so a ring has no width and its kernel is that of the vertical
//! edge, depth/sqrt(b^2 - r^2) (Boussinesq 1885). The edge itself is treated in `profile/ring_integrals.rs`; the face
//! is treated here.

use super::shape::{KernelOrder, Shape, ShapeFacts};
use super::{DoubleDouble, Error, Moments, Span, StressRadius, range};

/// A cylinder pressed in with its flat end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlatPunch {
    radius: f64,
}

impl FlatPunch {
    /// The punch of radius b, m.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] by [`range::RADIUS`].
    pub fn new(radius: f64) -> Result<FlatPunch, Error> {
        Ok(FlatPunch { radius: range::RADIUS.check(radius)? })
    }
}

impl Shape for FlatPunch {
    fn level(&self, _radius: f64) -> f64 {
        0.0
    }

    fn slope(&self, _radius: f64) -> f64 {
        0.0
    }

    fn square(&self, _level: DoubleDouble) -> DoubleDouble {
        DoubleDouble::square_of(self.radius)
    }

    fn load(&self, _radius: f64) -> f64 {
        0.0
    }

    fn indentation_for(&self, load: f64) -> f64 {
        load / self.radius
    }

    fn rise(&self, _span: &Span) -> f64 {
        0.0
    }

    fn facts(&self) -> ShapeFacts {
        ShapeFacts { rim: Some(self.radius), by_series: false, ..ShapeFacts::default() }
    }

    fn moments(&self, _span: &Span, _top: f64) -> Moments {
        Moments::default()
    }

    fn kernel(&self, _order: KernelOrder, _at: &StressRadius, _span: &Span) -> f64 {
        0.0
    }

    fn surface_slope(&self, _r: f64) -> f64 {
        0.0
    }
}
