//! Tangential displacement of the surface, and how far it has slipped under the indenter.
//!
//! u(r) = (2/pi) int_0^min(r, a) u_x(x)/sqrt(r^2 - x^2) dx (Popov & Hess 2015). Over a piece w is straight in g, so that two
//! integrals a ring give it: int dx/sqrt(r^2 - x^2) and int (y_outer - g)/sqrt(r^2 - x^2) dx. Under the indenter the slip
//! U - u(r) is summed from w - W, as stored, so that it is nought to the last bit where nothing has ever slipped.

use std::f64::consts::FRAC_2_PI;

use super::contact::Contact;
use super::double_double::DoubleDouble;
use super::profile::{Point, StressRadius};

impl Contact {
    /// Tangential displacement u(r) of the surface, m, at a radius (m) of at least nought, inside the contact or outside.
    #[must_use]
    pub fn surface_displacement(&self, radius: f64) -> f64 {
        let shift = self.memory.shift().value();
        let carried = self.spread(radius);
        self.scale()
            * if radius > 0.0 {
                carried + shift * FRAC_2_PI * arc_to(self.memory.edge(), &StressRadius::new(radius))
            } else {
                carried + shift
            }
    }

    /// Slip U - u(r), m, since the virgin contact; `None` outside the contact. Where the contact grew later, a ring's value
    /// includes what the indenter moved before it touched.
    #[must_use]
    pub fn slip(&self, radius: f64) -> Option<f64> {
        let edge = self.memory.edge();
        let touched = edge.level.value() > 0.0 && radius <= edge.radius;
        touched.then(|| {
            if self.friction <= 0.0 {
                // The surface stays behind altogether, and the memory is not told of the displacement.
                return self.displacement().value() + 0.0;
            }
            let started = (self.memory.position() - self.memory.shift()).value();
            self.scale() * (started - self.spread(radius)) + 0.0
        })
    }

    /// (2/pi) int_0^min(r, a) (w - W)/sqrt(r^2 - x^2) dx, as the pieces have it: w less its shift, m.
    fn spread(&self, radius: f64) -> f64 {
        let Some(core) = self.memory.pieces().first() else { return 0.0 };
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
        for (ring, line) in self.memory.rings() {
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
