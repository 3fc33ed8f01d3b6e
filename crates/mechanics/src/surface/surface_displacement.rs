//! Tangential displacement of the surface, and how far it has slipped under the indenter.
//!
//! u(r) = (2/pi) int_0^min(r, a) u_x(x)/sqrt(r^2 - x^2) dx (Popov & Heß 2015). Over a piece w is straight in g, so
//! that it is a weighted sum over the cells of the profile. Under the indenter the slip U - u(r) is summed from w - W,
//! as stored, so that it is zero to the last bit where nothing has ever slipped.

use std::f64::consts::FRAC_2_PI;

use crate::contact::Contact;
use crate::numerics::double_double::DoubleDouble;
use crate::profile::{Point, StressRadius};

/// The surface after a move.
///
/// ```
#[doc = include_str!("../example.txt")]
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
        if let Some(contact) = self.tangential() {
            return contact.surface_displacements(radii);
        }
        let (edge, shift) = (self.history.edge(), self.history.shift().value());
        if let Some(line) = self.indenter.line() {
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
        if let Some(contact) = self.tangential() {
            return contact.slips(radii);
        }
        let edge = self.history.edge();
        let (pressed, most) = (edge.level.value() > 0.0, self.contact_radius());
        let touched = |radius: &f64| pressed && radius.abs() <= most;
        if self.friction <= 0.0 {
            // The surface does not move at all, and the slip history does not follow the displacement.
            let slip = self.displacement.value() + 0.0;
            return radii.iter().map(|radius| touched(radius).then_some(slip)).collect();
        }
        if let Some(line) = self.indenter.line() {
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
        let (Some(core), Some(top)) = (self.history.pieces().first(), self.history.pieces().last()) else {
            return vec![0.0; radii.len()];
        };
        let ends = [(core, DoubleDouble::ZERO), (top, self.history.edge().level)];
        let [centre, edge] = ends.map(|(piece, level)| piece.line.at(level).value());
        let rings: Vec<_> = self.history.rings().rev().map(|(ring, line)| (ring, line.slope.value())).collect();
        self.indenter.displacements(&rings, (centre, edge), &StressRadius::of_all(radii))
    }
}

/// int_0^min(r, x) dt/sqrt(r^2 - t^2) up to the radius x of a point, from the squares, which are exact where x is not.
fn arc_to(point: &Point, at: &StressRadius) -> f64 {
    let beyond = (at.square - point.square).value();
    if beyond > 0.0 { point.radius.atan2(beyond.sqrt()) } else { std::f64::consts::FRAC_PI_2 }
}
