//! Steady cycles of a contact that is moved back and forth again and again.
//!
//! At constant load the loop of a steady cycle is made of two branches, each the first loading curve at twice its size
//! (Masing 1926). Over the level y the first loading to the displacement U0 slips the ring d* < y < d, d* = d - U0/m,
//! m = mu E*/G*, and carries F0 = 2 mu E* int X dy over that ring. With h = d - y and the moments of the ring,
//!
//! - the work of a cycle is eight mu m times the area between the load curve and its chord:
//!   D = 8 mu m E* (depth int h dx - int h^2 dx), all of it of the ring, so that small cycles keep their digits;
//! - the elastic energy is largest at the turning points, E = G* m^2 (depth^2 x* + int h^2 dx), x* = X(d*);
//! - beyond gross slip the indenter slides the rest of the way, with 4 mu F_N (U0 - u_max) more work.
//!
//! A machine spring in series with the contact moves the ends of the branches alone. Where the load oscillates too the
//! cycle is stepped ([`Oscillation`]). Where the bodies have memory, each spring of the contact has a loop of its own
//! ([`TimedCycle`]).

mod best_load;
mod harmonics;
mod lap;
mod masing_loop;
mod mass_motion;
mod oscillating;
mod response;
mod steady_motion;
mod timed;

pub use best_load::{BestLoad, best_load, work_under_load};
pub use harmonics::{Harmonic, Harmonics};
pub use lap::OscillatingCycle;
pub use oscillating::{OscillatingLoad, Oscillation};
pub use response::{Resonator, Response};
pub use timed::TimedCycle;

use std::f64::consts::PI;

use crate::contact::Contact;
use crate::contact::first_loading::FirstLoading;
use crate::contact::normal::{depth_for, load, whole};
use crate::contact::state::Regime;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::gauss::TWENTY_POINTS;
use crate::numerics::roots::within;
use crate::path::curved_path::PathPoint;
use crate::profile::{Moments, Ring};
use crate::range::error::Error;

/// The quantity prescribed as a cosine over a cycle: at the machine, if there is one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Drive {
    /// Amplitude U0 of the displacement, m.
    Displacement(f64),
    /// Amplitude F0 of the tangential force, N; below mu F_N.
    Force(f64),
}

/// A steady cycle at the present load of a contact, whatever its history.
#[derive(Clone, Debug)]
pub struct SteadyCycle<'a> {
    contact: &'a Contact,
    /// Compliance of the machine, m/N.
    compliance: f64,
    force_driven: bool,
    displacement: f64,
    force: f64,
    /// The ring that slips.
    ring: Ring,
    moments: Moments,
    /// How far the contact slides as a whole, m.
    slide: f64,
}

impl<'a> SteadyCycle<'a> {
    /// The cycle of a displacement amplitude, m.
    ///
    /// ```
    #[doc = include_str!("../example.txt")]
    /// use stickslip_mechanics::cycle::SteadyCycle;
    ///
    /// let cycle = SteadyCycle::of(&contact, 0.00375);
    /// // Mindlin & Deresiewicz (1953), half-way to gross slip: F0 = mu F_N (1 - (1 - U0/u_max)^(3/2)).
    /// assert!((cycle.force_amplitude() - 2000.0 * (1.0 - 0.5_f64.powf(1.5))).abs() < 1e-9);
    /// assert!(cycle.dissipated_energy() > 0.0 && cycle.sliding_ratio().unwrap() < 0.2);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn of(contact: &'a Contact, amplitude: f64) -> SteadyCycle<'a> {
        let contact = contact.tangential().unwrap_or(contact);
        let amplitude = amplitude.abs();
        let edge = contact.history.edge().level;
        if edge.value() <= 0.0 || contact.friction <= 0.0 {
            return SteadyCycle::new(contact, DoubleDouble::ZERO, amplitude);
        }
        let depth = contact.scaled(DoubleDouble::from(amplitude));
        if depth < edge {
            let cycle = SteadyCycle::new(contact, depth, 0.0);
            return SteadyCycle { displacement: amplitude, ..cycle };
        }
        let slide = contact.unscaled(depth - edge).value();
        let cycle = SteadyCycle::new(contact, edge, slide);
        SteadyCycle { displacement: amplitude, force: contact.friction * contact.normal_force, ..cycle }
    }

    /// The cycle of a drive, through a machine of this compliance, m/N; zero for none.
    ///
    /// # Errors
    /// [`Error::ForceExceedsFriction`] for a force of mu F_N and more, which no steady cycle has.
    ///
    /// ```
    #[doc = include_str!("../example.txt")]
    /// use stickslip_mechanics::cycle::{Drive, SteadyCycle};
    ///
    /// let cycle = SteadyCycle::driven(&contact, Drive::Displacement(0.004), 1e-7)?;
    /// // What the machine moves is taken by the contact and by the machine itself.
    /// assert!((cycle.machine_amplitude() - 0.004).abs() < 1e-16);
    /// assert!(cycle.displacement_amplitude() < 0.004);
    /// # Ok::<(), Error>(())
    /// ```
    pub fn driven(contact: &'a Contact, drive: Drive, compliance: f64) -> Result<SteadyCycle<'a>, Error> {
        let contact = contact.tangential().unwrap_or(contact);
        let edge = contact.history.edge().level;
        let limit = contact.friction * contact.normal_force;
        let cycle = match drive {
            Drive::Displacement(amplitude) if compliance <= 0.0 => SteadyCycle::of(contact, amplitude),
            Drive::Displacement(amplitude) => {
                let slide = amplitude.abs() - contact.unscaled(edge).value().max(0.0) - compliance * limit;
                if slide >= 0.0 || limit <= 0.0 {
                    let cycle = SteadyCycle::new(contact, if limit > 0.0 { edge } else { DoubleDouble::ZERO }, slide);
                    SteadyCycle { force: limit, ..cycle }
                } else {
                    SteadyCycle::new(contact, SteadyCycle::taken(contact, amplitude.abs(), compliance), 0.0)
                }
            }
            Drive::Force(amplitude) if amplitude.abs() >= limit && amplitude.abs() > 0.0 => {
                return Err(Error::ForceExceedsFriction { target: amplitude, limit, part: 1.0 });
            }
            // Every displacement has the force zero.
            Drive::Force(_) if limit <= 0.0 => SteadyCycle::of(contact, 0.0),
            Drive::Force(amplitude) => {
                let all = whole(&contact.indenter, contact.history.edge());
                let unit = 2.0 * contact.friction * contact.elasticity.e_star();
                let room = (DoubleDouble::from(contact.normal_force) * contact.friction
                    - DoubleDouble::from(amplitude.abs()))
                .value();
                // From the nearer end, so that neither a small force nor one just below the limit loses its digits.
                let depth = if amplitude.abs() <= room {
                    DoubleDouble::from(depth_for(&contact.indenter, &all, false, amplitude.abs() / unit))
                } else {
                    edge - DoubleDouble::from(depth_for(&contact.indenter, &all, true, room / unit))
                };
                SteadyCycle { force: amplitude.abs(), ..SteadyCycle::new(contact, depth, 0.0) }
            }
        };
        Ok(SteadyCycle { compliance, force_driven: matches!(drive, Drive::Force(_)), ..cycle })
    }

    fn new(contact: &'a Contact, depth: DoubleDouble, slide: f64) -> SteadyCycle<'a> {
        let edge = *contact.history.edge();
        let ring = if edge.level.value() > 0.0 { FirstLoading(contact).slipped(depth) } else { Ring::default() };
        let moments = if ring.depth > 0.0 { contact.indenter.moments(&ring) } else { Moments::default() };
        SteadyCycle {
            contact,
            compliance: 0.0,
            force_driven: false,
            displacement: contact.unscaled(depth).value() + slide,
            force: contact.force_unit() * load(&contact.indenter, &ring),
            ring,
            moments,
            slide,
        }
    }

    /// The depth of the ring that slips where the machine moves by `amplitude`, m, and the contact does not slide.
    fn taken(contact: &Contact, amplitude: f64, compliance: f64) -> DoubleDouble {
        let edge = *contact.history.edge();
        let (own, machine) = (contact.scale(), compliance * contact.force_unit());
        let beyond = |depth: f64| {
            let ring = FirstLoading(contact).slipped(DoubleDouble::from(depth));
            let moved = own * depth + machine * load(&contact.indenter, &ring);
            (moved - amplitude, own + machine * ring.inner.radius)
        };
        let start = amplitude / (own + machine * edge.radius);
        DoubleDouble::from(within([0.0, edge.level.value()], start, beyond))
    }

    /// Amplitude of the displacement of the indenter, m.
    #[must_use]
    pub fn displacement_amplitude(&self) -> f64 {
        self.displacement
    }

    /// Amplitude of the tangential force, N.
    #[must_use]
    pub fn force_amplitude(&self) -> f64 {
        self.force
    }

    /// Amplitude of the displacement at the machine, m.
    #[must_use]
    pub fn machine_amplitude(&self) -> f64 {
        self.displacement + self.compliance * self.force
    }

    /// Friction work of a cycle, J.
    #[must_use]
    pub fn dissipated_energy(&self) -> f64 {
        let Moments { first, second, .. } = self.moments;
        let limit = self.contact.friction * self.contact.normal_force;
        let factor = 4.0 * self.contact.scale() * self.contact.force_unit();
        factor * (self.ring.depth * first - second).max(0.0) + 4.0 * limit * self.slide
    }

    /// All that friction dissipates in a cycle, J: [`SteadyCycle::dissipated_energy`], unless a bulk stress does work
    /// too.
    ///
    /// Then it is the integral of [`SteadyCycle::friction_work`] on both sides of the stuck zone, over an angle in
    /// which the roots at their ends are smooth.
    #[must_use]
    pub fn friction_energy(&self) -> f64 {
        let Some(line) = self.contact.eccentric() else { return self.dissipated_energy() };
        let (edge, stuck) = (self.contact.contact_radius(), self.stick_radius());
        let centre = self.contact.zone_centre(line, stuck);
        let side = |from: f64, to: f64| {
            let angles = TWENTY_POINTS.map(|(share, weight)| (PI * share, PI * weight));
            let places = angles.map(|(angle, _)| from + (to - from) * (0.5 * angle).sin().powi(2));
            let terms = self.friction_work(&places).into_iter().zip(angles);
            0.5 * (to - from) * terms.map(|(work, (angle, weight))| weight * angle.sin() * work).sum::<f64>()
        };
        line.length() * (side(-edge, centre - stuck) + side(centre + stuck, edge))
    }

    /// The largest elastic energy of the tangential deformation in a cycle, J.
    #[must_use]
    pub fn max_elastic_energy(&self) -> f64 {
        let stored = self.ring.depth * self.ring.depth * self.ring.inner.radius + self.moments.second;
        0.5 * self.contact.scale() * self.contact.force_unit() * stored
    }

    /// Force amplitude over displacement amplitude at the contact, N/m; the tangent stiffness where both vanish.
    #[must_use]
    pub fn secant_stiffness(&self) -> f64 {
        if self.displacement > 0.0 { self.force / self.displacement } else { self.tangent_stiffness() }
    }

    /// Stiffness of the contact just after a reversal, 2 G* a, N/m; zero without friction.
    #[must_use]
    pub fn tangent_stiffness(&self) -> f64 {
        if self.contact.friction > 0.0 {
            2.0 * self.contact.elasticity.g_star() * self.contact.stiffness_radius()
        } else {
            0.0
        }
    }

    /// D/(2 pi E), E the largest elastic energy; zero at the amplitude zero, `None` where nothing is stored.
    #[must_use]
    pub fn loss_factor(&self) -> Option<f64> {
        let stored = self.max_elastic_energy();
        if stored > 0.0 {
            return Some(self.dissipated_energy() / (std::f64::consts::TAU * stored));
        }
        (self.displacement <= 0.0).then_some(0.0)
    }

    /// Displacement at zero force over the amplitude, at the contact; `None` where there is no force at all.
    #[must_use]
    pub fn sliding_ratio(&self) -> Option<f64> {
        if self.displacement <= 0.0 {
            return Some(0.0);
        }
        if self.force <= 0.0 {
            return None;
        }
        // The branch from the upper end has lost F0 where its ring carries F0/2: beyond half the depth by what the
        // inner half of the ring carries less than the outer.
        let profile = &self.contact.indenter;
        let middle = profile.point(self.ring.inner.level + DoubleDouble::from(self.ring.depth).halved());
        let (low, high) = (Ring::between(self.ring.inner, middle), Ring::between(middle, self.ring.outer));
        let inner = profile.moments(&low);
        let lack = inner.width * high.depth + profile.moments(&high).first - inner.first;
        let early = depth_for(profile, &high, true, 0.5 * lack);
        Some(((2.0 * early * self.contact.scale() + self.slide) / self.displacement).clamp(0.0, 1.0))
    }

    /// Radius of the part that never slips, m.
    #[must_use]
    pub fn stick_radius(&self) -> f64 {
        if self.regime() == Regime::GrossSlip { 0.0 } else { self.contact.indenter.edge_radius(&self.ring.inner) }
    }

    /// Which parts slip.
    #[must_use]
    pub fn regime(&self) -> Regime {
        let edge = self.contact.history.edge();
        if edge.level.value() < 0.0 {
            Regime::Separated
        } else if self.displacement <= 0.0 {
            Regime::Stick
        } else if self.slide > 0.0 || self.ring.inner.level.value() <= 0.0 || self.contact.friction <= 0.0 {
            Regime::GrossSlip
        } else if self.ring.inner.radius < edge.radius {
            Regime::PartialSlip
        } else {
            Regime::Stick
        }
    }

    /// Friction work of a cycle per area, J/m^2, at each of `radii`, m: mu p(r) times the slip accumulated at r, four
    /// times the slip at the turning points. Zero outside the contact, infinite where the pressure is.
    ///
    /// ```
    #[doc = include_str!("../example.txt")]
    /// use stickslip_mechanics::cycle::SteadyCycle;
    ///
    /// let cycle = SteadyCycle::of(&contact, 0.00375);
    /// let density = cycle.friction_work(&[0.0, 0.09, 0.2]);
    /// assert_eq!((density[0], density[2]), (0.0, 0.0));
    /// assert!(density[1] > 0.0);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn friction_work(&self, radii: &[f64]) -> Vec<f64> {
        let contact = self.contact;
        let edge = contact.history.edge().level;
        if edge.value() <= 0.0 || contact.friction <= 0.0 {
            return vec![0.0; radii.len()];
        }
        let indentation = edge;
        let mut turned = contact.without_history();
        let displacement = DoubleDouble::from(self.displacement);
        turned.advance(&PathPoint { indentation, normal_force: contact.normal_force, displacement });
        let work = |(slip, pressure): (Option<f64>, f64)| {
            let slip = slip.unwrap_or(0.0).max(0.0);
            if slip > 0.0 { 4.0 * contact.friction * pressure * slip } else { 0.0 }
        };
        turned.slips(radii).into_iter().zip(contact.pressures(radii)).map(work).collect()
    }
}
