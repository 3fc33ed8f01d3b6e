//! Tangential displacement of the surface, and how far it has slipped under the indenter.
//!
//! u(r) = (2/pi) int_0^min(r, a) u_x(x)/sqrt(r^2 - x^2) dx (Popov & Hess 2015). Over a piece w is straight in g, so
//! that two integrals a ring give it: int dx/sqrt(r^2 - x^2) and int (y_outer - g)/sqrt(r^2 - x^2) dx. Under the
//! indenter the slip U - u(r) is summed from w - W, as stored, so that it is zero to the last bit where nothing has
//! ever slipped.

use std::f64::consts::FRAC_2_PI;

use super::profile::{Point, StressRadius};
use super::{Contact, DoubleDouble};

impl Contact {
    /// Tangential displacement u(r) of the surface, m, at a radius (m) of at least zero, inside the contact or outside.
    ///
    /// ```
    #[doc = include_str!("example.txt")]
    /// contact.apply(&slide(0.001))?;
    /// // The stuck core moves with the indenter; far away the surface stays.
    /// assert!((contact.surface_displacement(0.0) - 0.001).abs() < 1e-17);
    /// assert!(contact.surface_displacement(10.0) < 1e-4);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn surface_displacement(&self, radius: f64) -> f64 {
        let shift = self.history.shift().value();
        let carried = self.relative_displacement(radius);
        self.scale()
            * if radius > 0.0 {
                carried + shift * FRAC_2_PI * arc_to(self.history.edge(), &StressRadius::new(radius))
            } else {
                carried + shift
            }
    }

    /// Slip U - u(r), m, since the virgin contact; `None` outside the contact. Where the contact grew later, a ring's
    /// value includes what the indenter moved before it touched.
    ///
    /// ```
    #[doc = include_str!("example.txt")]
    /// contact.apply(&slide(0.001))?;
    /// assert_eq!(contact.slip(0.0), Some(0.0));
    /// assert!(contact.slip(0.099).unwrap() > 0.0 && contact.slip(0.2).is_none());
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn slip(&self, radius: f64) -> Option<f64> {
        let edge = self.history.edge();
        let touched = edge.level.value() > 0.0 && radius <= edge.radius;
        touched.then(|| {
            if self.friction <= 0.0 {
                // The surface does not move at all, and the slip history does not follow the displacement.
                return self.displacement.value() + 0.0;
            }
            let started = (self.history.position() - self.history.shift()).value();
            self.scale() * (started - self.relative_displacement(radius)) + 0.0
        })
    }

    /// (2/pi) int_0^min(r, a) (w - W)/sqrt(r^2 - x^2) dx, m, of the stored w - W, without the shift.
    fn relative_displacement(&self, radius: f64) -> f64 {
        let Some(core) = self.history.pieces().first() else { return 0.0 };
        let at_core = core.line.at(DoubleDouble::ZERO).value();
        if radius <= 0.0 {
            return at_core;
        }
        let at = StressRadius::new(radius);
        let mut sum = 0.0;
        if core.inner.radius > 0.0 {
            // A flat core belongs to no ring.
            sum += at_core * arc_to(&core.inner, &at);
        }
        for (ring, line) in self.history.rings() {
            if (at.square - ring.inner.square).value() > 0.0 {
                let outer = line.at(ring.outer.level).value();
                sum += outer * self.profile.arc(&at, &ring)
                    - line.slope.value() * self.profile.displacement_integral(&at, &ring);
            }
        }
        FRAC_2_PI * sum
    }
}

/// int_0^min(r, x) dt/sqrt(r^2 - t^2) up to the radius x of a point, from the squares, which are exact where x is not.
fn arc_to(point: &Point, at: &StressRadius) -> f64 {
    let beyond = (at.square - point.square).value();
    if beyond > 0.0 { point.radius.atan2(beyond.sqrt()) } else { std::f64::consts::FRAC_PI_2 }
}
