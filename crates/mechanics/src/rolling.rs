//! Steady tractive rolling of a cylinder on a flat of like bodies (Carter 1926).
//!
//! Rolling towards +x under the load P and the tangential force Q = k mu P, both per length, the contact sticks from
//! the leading edge +a on: the shear stress is that of gross slip less a similar ellipse over the stick zone, whose
//! half-width is c = a sqrt(1 - |k|) and whose middle is at a - c,
//!
//! tau(x) = mu p0 [sqrt(1 - x^2/a^2) - (c/a) sqrt(1 - (x - a + c)^2/c^2)],
//!
//! with the sign of k. The creep, the relative difference between the ways of the cylinder's circumference and of the
//! flat, is (mu a/R)(1 - c/a).

use crate::contact::Contact;
use crate::range::Quantity;
use crate::range::error::Error;
use crate::range::unit_prefix::short;

/// What drives the rolling; signed, positive along +x.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Drive {
    /// Q/(mu P), between -1 and 1.
    Ratio(f64),
    /// The creep, below mu a/R in magnitude.
    Creep(f64),
}

/// A cylinder that rolls steadily.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rolling {
    half_width: f64,
    stick_half_width: f64,
    largest_shear: f64,
    ratio: f64,
    creep: f64,
}

impl Rolling {
    /// Of a cylinder under its present load.
    ///
    /// # Errors
    /// [`Error::OnlyCylinder`] for another profile; [`Error::NothingSlides`] without friction or load;
    /// [`Error::OutOfRange`] for a drive at which the whole contact would slip.
    ///
    /// ```
    /// use stickslip_mechanics::profile::{LineContact, Profile};
    /// use stickslip_mechanics::rolling::{Drive, Rolling};
    /// use stickslip_mechanics::{Contact, Elasticity, Preload, Setup};
    ///
    /// let contact = Contact::new(Setup {
    ///     profile: Profile::Line(LineContact::cylinder(0.05, 0.01, None)?),
    ///     elasticity: Elasticity::effective(1.2e11, 1.2e11)?,
    ///     friction: 0.3,
    ///     preload: Preload::NormalForce(1000.0),
    /// })?;
    /// let rolling = Rolling::of(&contact, Drive::Ratio(0.75))?;
    /// let a = contact.contact_radius();
    /// assert!((rolling.creep() / (0.3 * a / 0.05) - 0.5).abs() < 1e-15);
    /// assert_eq!(rolling.stick(), [0.0, a]);
    /// # Ok::<(), stickslip_mechanics::Error>(())
    /// ```
    pub fn of(contact: &Contact, drive: Drive) -> Result<Rolling, Error> {
        let radius = contact.profile().line().and_then(|line| line.cylinder_radius()).ok_or(Error::OnlyCylinder)?;
        let out = |quantity, value, allowed: String| Err(Error::OutOfRange { quantity, value, allowed });
        let half_width = contact.contact_radius();
        if contact.friction() <= 0.0 || contact.indentation() <= 0.0 || half_width <= 0.0 {
            return Err(Error::NothingSlides);
        }
        let largest_creep = contact.friction * half_width / radius;
        let (quantity, value, limit) = match drive {
            Drive::Ratio(ratio) => (Quantity::RollingRatio, ratio, 1.0),
            Drive::Creep(creep) => (Quantity::RollingCreep, creep, largest_creep),
        };
        let part = value / limit;
        if part.is_nan() || part.abs() >= 1.0 {
            let limit = short(limit);
            return out(quantity, value, format!("between -{limit} and {limit}, where the whole contact slips"));
        }
        let stick = match drive {
            Drive::Ratio(_) => (1.0 - part.abs()).sqrt(),
            Drive::Creep(_) => 1.0 - part.abs(),
        };
        // 1 - sqrt(1 - k) and 1 - (1 - e)^2 without a difference of nearly equal numbers.
        let [ratio, creep] = match drive {
            Drive::Ratio(ratio) => [ratio, largest_creep * ratio / (1.0 + stick)],
            Drive::Creep(creep) => [part * (2.0 - part.abs()), creep],
        };
        Ok(Rolling {
            half_width,
            stick_half_width: half_width * stick,
            largest_shear: contact.summary().unit_shear(),
            ratio,
            creep,
        })
    }

    /// Q/(mu P).
    #[must_use]
    pub fn ratio(&self) -> f64 {
        self.ratio
    }

    /// The creep, a pure number; positive with a positive force.
    #[must_use]
    pub fn creep(&self) -> f64 {
        self.creep
    }

    /// Where the stick zone begins and ends, m: it ends at the leading edge.
    #[must_use]
    pub fn stick(&self) -> [f64; 2] {
        [self.half_width - 2.0 * self.stick_half_width, self.half_width]
    }

    /// The shear stress at x, m, Pa, positive with a positive force; zero outside the contact.
    #[must_use]
    pub fn shear(&self, x: f64) -> f64 {
        let ellipse = |half_width: f64, centre: f64| {
            let [left, right] = [half_width - (x - centre), half_width + (x - centre)];
            (left.max(0.0) * right.max(0.0)).sqrt() / self.half_width
        };
        let inner = ellipse(self.stick_half_width, self.half_width - self.stick_half_width);
        self.largest_shear * (ellipse(self.half_width, 0.0) - inner).copysign(self.ratio)
    }
}
