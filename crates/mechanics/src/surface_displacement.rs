//! Tangential displacement of the surface, and how far it has slipped under the indenter.
//!
//! u(r) = (2/pi) int_0^min(r, a) u_x(x)/sqrt(r^2 - x^2) dx (Popov & Hess 2015). Over a piece w is straight in g, so
//! that two integrals a ring give it: int dx/sqrt(r^2 - x^2) and int (y_outer - g)/sqrt(r^2 - x^2) dx. Under the
//! indenter the slip U - u(r) is summed from w - W, as stored, so that it is zero to the last bit where nothing has
//! ever slipped.

use std::f64::consts::FRAC_2_PI;

use super::profile::{Point, StressRadius};
use crate::contact::Contact;
use crate::numerics::double_double::DoubleDouble;

/// The surface after a move.
///
/// ```
#[doc = include_str!("example.txt")]
/// contact.apply(&slide(0.001))?;
/// // The stuck core moves with the indenter; far away the surface stays.
/// assert!((contact.surface_displacement(0.0) - 0.001).abs() < 1e-17);
/// assert!(contact.surface_displacement(10.0) < 1e-4);
/// assert_eq!(contact.surface_displacements(&[0.05, 0.2])[1], contact.surface_displacement(0.2));
/// assert_eq!(contact.slip(0.0), Some(0.0));
/// assert!(contact.slip(0.099).unwrap() > 0.0 && contact.slip(0.2).is_none());
/// assert_eq!(contact.slips(&[0.05, 0.2]), [contact.slip(0.05), None]);
/// # Ok::<(), Error>(())
/// ```
impl Contact {
    /// Tangential displacement u(r) of the surface, m, at a radius (m) of at least zero, inside the contact or outside.
    #[must_use]
    pub fn surface_displacement(&self, radius: f64) -> f64 {
        self.surface_displacements(&[radius])[0]
    }

    /// [`Contact::surface_displacement`] at each of `radii`, m: faster than one by one.
    #[must_use]
    pub fn surface_displacements(&self, radii: &[f64]) -> Vec<f64> {
        let (edge, shift) = (self.history.edge(), self.history.shift().value());
        if let Some(line) = self.profile.line() {
            let zones: Vec<_> = self.zones(line).collect();
            let middle = self.scale() * (self.core() + shift);
            return radii.iter().map(|&x| middle - self.friction * self.lag(line, &zones, x)).collect();
        }
        // The displacements of the pieces are relative to the indenter.
        let moved = |radius: f64| {
            if radius > 0.0 { shift * FRAC_2_PI * arc_to(edge, &StressRadius::new(radius)) } else { shift }
        };
        let carried = self.relative_displacements(radii);
        radii.iter().zip(carried).map(|(&radius, carried)| self.scale() * (carried + moved(radius))).collect()
    }

    /// Slip U - u(r), m, since the virgin contact; `None` outside the contact. Where the contact grew later, a ring's
    /// value includes what the indenter moved before it touched.
    #[must_use]
    pub fn slip(&self, radius: f64) -> Option<f64> {
        self.slips(&[radius])[0]
    }

    /// [`Contact::slip`] at each of `radii`, m: faster than one by one.
    #[must_use]
    pub fn slips(&self, radii: &[f64]) -> Vec<Option<f64>> {
        let edge = self.history.edge();
        let (pressed, most) = (edge.level.value() > 0.0, self.contact_radius());
        let touched = |radius: &f64| pressed && radius.abs() <= most;
        if self.friction <= 0.0 {
            // The surface does not move at all, and the slip history does not follow the displacement.
            let slip = self.displacement.value() + 0.0;
            return radii.iter().map(|radius| touched(radius).then_some(slip)).collect();
        }
        if let Some(line) = self.profile.line() {
            let zones: Vec<_> = self.zones(line).collect();
            let middle = self.scale() * ((self.history.position() - self.history.shift()).value() - self.core());
            let slip = |x: f64| middle + self.friction * self.lag(line, &zones, x) + 0.0;
            return radii.iter().map(|&x| touched(&x).then(|| slip(x))).collect();
        }
        let inside: Vec<f64> = radii.iter().copied().filter(touched).collect();
        let started = (self.history.position() - self.history.shift()).value();
        let mut carried = self.relative_displacements(&inside).into_iter();
        let slip = |carried: f64| self.scale() * (started - carried) + 0.0;
        radii.iter().map(|radius| touched(radius).then(|| carried.next().map(slip)).flatten()).collect()
    }

    /// (2/pi) int_0^min(r, a) (w - W)/sqrt(r^2 - x^2) dx, m, of the stored w - W, without the shift, at each radius.
    fn relative_displacements(&self, radii: &[f64]) -> Vec<f64> {
        let ends = self.history.pieces().first().zip(self.history.pieces().last());
        let ends = ends.map(|(core, top)| {
            (core.line.at(DoubleDouble::ZERO).value(), top.line.at(self.history.edge().level).value())
        });
        let at_once = ends.and_then(|ends| {
            let rings = self.history.rings().rev().map(|(ring, line)| (ring, line.slope.value()));
            self.profile.displacements(&rings.collect::<Vec<_>>(), ends, &StressRadius::of_all(radii))
        });
        at_once.unwrap_or_else(|| radii.iter().map(|&radius| self.relative_displacement(radius)).collect())
    }

    /// The same at one radius, ring by ring.
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

#[cfg(test)]
mod tests {
    use super::super::profile::{Cone, Sphere, Sum, Tabulated};
    use super::super::{Contact, Elasticity, Move, Preload, Profile, Setup, Tangential};
    use proptest::prelude::*;
    use proptest::test_runner::RngSeed;

    proptest! {
        #![proptest_config(ProptestConfig {
            cases: 48, failure_persistence: None, rng_seed: RngSeed::Fixed(0), ..ProptestConfig::default()
        })]

        #[test]
        fn displacements_at_once_are_those_ring_by_ring(
            steps in prop::collection::vec((0.05..1.0_f64, 0.2..1.0_f64), 3..60),
            turns in prop::collection::vec(-1.0..1.0_f64, 1..12),
            share in 0.2..0.95_f64,
            part in 0..3,
        ) {
            // Uneven steps and slopes that rise by any amount, so that g does too.
            let (mut radii, mut heights, mut slope) = (vec![0.0], vec![0.0], 0.0);
            for (step, bend) in steps {
                let (r, z): (f64, f64) = (radii[radii.len() - 1], heights[heights.len() - 1]);
                slope += bend * step;
                radii.push(r + 1e-3 * step);
                heights.push(z + 1e-6 * slope * step);
            }
            let table = Profile::Tabulated(Tabulated::new(&radii, &heights).unwrap());
            let profile = match part {
                0 => table,
                1 => Profile::Sum(Sum::new(vec![table, Profile::Cone(Cone::new(1e-3).unwrap())]).unwrap()),
                _ => Profile::Sum(Sum::new(vec![Profile::Sphere(Sphere::new(1.0).unwrap()), table]).unwrap()),
            };
            let edge = share * profile.limit_radius().unwrap();
            let elasticity = Elasticity::effective(1e11, 8e10).unwrap();
            let preload = Preload::ContactRadius(edge);
            let mut contact = Contact::new(Setup { profile, elasticity, friction: 0.3, preload }).unwrap();
            let full = contact.gross_slip_displacement();
            for turn in turns {
                let to = Tangential::Displacement(full * turn);
                contact.apply(&Move { tangential: Some(to), ..Move::default() }).unwrap();
            }
            let radii: Vec<f64> = (0..60).map(|index| f64::from(index) * edge / 40.0).collect();
            let at_once = contact.relative_displacements(&radii);
            for (&radius, found) in radii.iter().zip(at_once) {
                let expected = contact.relative_displacement(radius);
                let error = (found - expected).abs() / contact.indentation();
                prop_assert!(error < 2e-14, "at {radius:e} m: {found:e} m instead of {expected:e} m");
            }
        }
    }
}
