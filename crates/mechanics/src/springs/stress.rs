//! Stresses, surface displacement and slip of the spring foundation.

use super::{Spring, Springs};
use crate::surface::shear_stress::{Peak, Residual};

/// The largest number of radii of the search for extrema.
const SCAN: usize = 2000;

/// ```
#[doc = include_str!("../example.txt")]
/// let mut springs = Springs::new(setup, 1000, 0.1)?;
/// assert_eq!((springs.slip(0.05), springs.slip(0.2)), (Some(0.0), None));
/// springs.apply(&slide(1.0))?;
/// contact.apply(&slide(1.0))?;
/// assert!((springs.shear(0.03) / contact.shear(0.03) - 1.0).abs() < 1e-3);
/// # Ok::<(), Error>(())
/// ```
impl Springs {
    /// Pressure, Pa, at a radius, m.
    #[must_use]
    pub fn pressure(&self, radius: f64) -> f64 {
        self.virgin.elasticity.e_star()
            * self.stress(radius, self.rim_depth(), |spring| self.indentation - spring.level)
    }

    /// Shear stress, Pa, at a radius, m.
    #[must_use]
    pub fn shear(&self, radius: f64) -> f64 {
        let room = self.virgin.scale() * self.rim_depth();
        let last = self.in_contact().last().map_or(0.0, |spring| spring.carried);
        self.virgin.elasticity.g_star() * self.stress(radius, last.clamp(-room, room), |spring| spring.carried)
    }

    /// How deep a vertical edge is pressed in, m; zero for a profile without one, but for rounding.
    pub(super) fn rim_depth(&self) -> f64 {
        // Elsewhere a rounded remainder would make the stress infinite.
        if !self.virgin.indenter.is_upright(&self.virgin.indenter.point(self.indentation.into())) {
            return 0.0;
        }
        (self.indentation - self.virgin.indenter.level(self.contact_radius())).max(0.0)
    }

    fn stress(&self, radius: f64, at_edge: f64, displacement: impl Fn(&Spring) -> f64) -> f64 {
        let nodes = self.in_contact().map(|spring| (spring.radius, displacement(spring)));
        if self.indentation > 0.0 { from_displacements(nodes, self.contact_radius(), at_edge, radius) } else { 0.0 }
    }

    /// Tangential displacement of the surface, m, at a radius, m: each spring moves its own cell.
    #[must_use]
    pub fn surface_displacement(&self, radius: f64) -> f64 {
        let half = 0.5 * self.spacing;
        let Some(centre) = self.in_contact().next() else { return 0.0 };
        if radius <= half {
            return centre.carried;
        }
        let angle = |x: f64| (x / radius).clamp(0.0, 1.0).asin();
        let edge = self.contact_radius();
        let share = |spring: &Spring| angle((spring.radius + half).min(edge)) - angle(spring.radius - half);
        let sum: f64 = self.in_contact().map(|spring| spring.carried * share(spring)).sum();
        std::f64::consts::FRAC_2_PI * sum
    }

    /// Slip under the indenter, m, at a radius, m; none outside the contact.
    #[must_use]
    pub fn slip(&self, radius: f64) -> Option<f64> {
        let touched = self.indentation > 0.0 && radius <= self.contact_radius();
        touched.then(|| self.displacement - self.surface_displacement(radius))
    }

    /// The extrema of the shear stress, as far as the springs resolve them, while `keep_going` returns true, which is
    /// asked at each radius that is compared. `None` if it returned false.
    pub fn residual_while(&self, keep_going: &dyn Fn() -> bool) -> Option<Residual> {
        let count = self.in_contact().count();
        let stride = count.div_ceil(SCAN).max(1);
        let sample =
            |spring: &Spring| keep_going().then(|| Peak { radius: spring.radius, shear: self.shear(spring.radius) });
        let samples: Vec<Peak> = self.in_contact().step_by(stride).map(sample).collect::<Option<_>>()?;
        let peaks: Vec<Peak> = samples
            .windows(3)
            .filter(|near| (near[1].shear - near[0].shear) * (near[2].shear - near[1].shear) < 0.0)
            .map(|near| near[1])
            .collect();
        Some(Residual::of(self.shear(0.0), peaks, self.shear(self.contact_radius()).abs()))
    }
}

/// -(1/pi) int_r^a u'(x)/sqrt(x^2 - r^2) dx + u(a)/(pi sqrt(a^2 - r^2)) of the displacement drawn straight from spring
/// to spring and on to `at_edge`; level from the centre to the first spring beyond it.
pub(super) fn from_displacements(nodes: impl Iterator<Item = (f64, f64)>, edge: f64, at_edge: f64, radius: f64) -> f64 {
    if radius > edge {
        return 0.0;
    }
    let root = |x: f64| ((x - radius) * (x + radius)).max(0.0).sqrt();
    let mut sum = if at_edge.abs() > 0.0 { at_edge / root(edge) } else { 0.0 };
    let mut inner: Option<(f64, f64)> = None;
    for (x, u) in nodes.chain([(edge, at_edge)]) {
        if let Some((x0, u0)) = inner
            && x > radius
            && x > x0
            && x0 > 0.0
        {
            let from = x0.max(radius);
            sum -= (u - u0) / (x - x0) * ((x + root(x)) / (from + root(from))).ln();
        }
        inner = Some((x, u));
    }
    sum / std::f64::consts::PI
}
