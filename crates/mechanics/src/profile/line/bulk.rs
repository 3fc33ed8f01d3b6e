//! A stress along x that comes with the tangential force, in one of the bodies below a cylinder.
//!
//! While the load stays, a stroke from the force Q_t to Q leaves the zone |x - e| < c stuck, c = a sqrt(1 - |Q -
//! Q_t|/(f mu P)) as without it and e = +-(R/mu) k |sigma - sigma_t|/f, f = 1 on first loading and 2 after a reversal,
//! k = (1 - nu^2)/E of the body, + for the second one (Nowell & Hills 1987). With sigma = kappa F_x the force of a
//! stroke drops out: e = +-R k kappa F_N (1 - c^2/a^2), so that all zones of a history are one family of nested
//! ellipses. They are nested as long as 2 |e| at c = 0 is no more than a.

use crate::elasticity::{Body, Side};
use crate::range;
use crate::range::error::Error;

/// The stress of a body along x over the tangential force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineBulk {
    /// The body that carries it.
    pub side: Side,
    /// sigma/F_x, Pa/N.
    pub stress_per_force: f64,
    /// Strain along x of the second body less that of the first over F_x, 1/N.
    pub(super) strain_per_force: f64,
}

impl LineBulk {
    /// The stress per force, Pa/N, of a body of these constants; `None` for a rigid one, which it does not strain.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] by [`range::STRESS_PER_FORCE`].
    pub fn new(side: Side, stress_per_force: f64, body: Option<Body>) -> Result<LineBulk, Error> {
        range::STRESS_PER_FORCE.check(stress_per_force)?;
        let compliance = body.map_or(0.0, Body::normal_compliance);
        let sign = if side == Side::Second { 1.0 } else { -1.0 };
        Ok(LineBulk { side, stress_per_force, strain_per_force: sign * compliance * stress_per_force })
    }
}
