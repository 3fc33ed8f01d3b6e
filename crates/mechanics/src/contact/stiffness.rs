//! How stiff a contact is in its present state, which programs with equations of motion of their own ask for.

use super::Contact;
use super::state::{Move, Tangential};
use crate::range::error::Error;

/// A displacement beyond which the part that still sticks is looked at, over that of gross slip.
const PROBE: f64 = 1e-12;

impl Contact {
    /// Normal stiffness, and tangential stiffness of a displacement that goes on towards `direction`, 1 or -1, N/m:
    /// each spring that does not slip adds its own, so that the tangential one is that of a punch as large as the part
    /// that sticks.
    ///
    /// # Errors
    /// As [`Contact::apply`].
    ///
    /// ```
    #[doc = include_str!("../example.txt")]
    /// let (normal, tangential) = contact.stiffness(1.0)?;
    /// // 2 E* a and 2 G* a.
    /// assert!((normal - 2.0 * 3e6 * 0.1).abs() < 1e-6 && (tangential - 2.0 * 2e6 * 0.1).abs() < 1e-6);
    /// # Ok::<(), Error>(())
    /// ```
    pub fn stiffness(&self, direction: f64) -> Result<(f64, f64), Error> {
        let normal = 2.0 * self.elasticity.e_star() * self.contact_radius();
        let probe = direction * PROBE * self.gross_slip_displacement();
        if probe.abs() <= 0.0 {
            return Ok((normal, 0.0));
        }
        let mut moved = self.clone();
        let tangential = Some(Tangential::Displacement(probe));
        moved.apply(&Move { tangential, relative: true, ..Move::default() })?;
        Ok((normal, 2.0 * self.elasticity.g_star() * moved.state().stick_radius))
    }
}
