//! The error of the spring foundation, measured against the exact contact that makes the same moves.

use super::Springs;
use crate::accuracy::ErrorEstimate;

/// The number of radii at even distances at which stresses are compared, and that of kinks of the slip history with one
/// beside each.
const COMPARED: usize = 128;
/// Distance from a kink of the displacement, in cells, from which on the error of the stress is stated.
const NEAREST: f64 = 2.0;

impl Springs {
    /// The errors by the discretisation. The one of the stress is for radii some cells (of twice the largest contact
    /// radius over the number of springs) away from the kinks of the displacement, the centre, the edge and the
    /// singular radii of the profile: nearer, a stress is smeared over a cell. Where no radius is that far from all of
    /// these, it is for all radii but the nearest to a singular one.
    ///
    /// ```
    #[doc = include_str!("../example.txt")]
    /// let mut springs = Springs::new(setup, 1000, 0.1)?;
    /// springs.apply(&slide(0.002))?;
    /// contact.apply(&slide(0.002))?;
    /// let off = (springs.force() - contact.force()).abs() / 2000.0;
    /// assert!(off <= springs.accuracy().force_error);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn accuracy(&self) -> ErrorEstimate {
        self.accuracy_while(&|| true)
    }

    /// The same, but of no use once `keep_going` has returned false, which is asked at each radius that is compared.
    #[must_use]
    pub fn accuracy_while(&self, keep_going: &dyn Fn() -> bool) -> ErrorEstimate {
        let summary = self.exact.summary();
        let relative = |error: f64, unit: f64| f64::EPSILON + if unit > 0.0 { error / unit } else { 0.0 };
        let normal = self.exact.friction * (self.normal_force() - summary.normal_force).abs();
        let force = (self.force() - self.exact.force()).abs().max(normal);
        let radii = self.compared_radii();
        let expected = self.exact.shears(&radii);
        let errors = radii.iter().zip(expected).take_while(|_| keep_going());
        let errors = errors.map(|(&radius, expected)| (self.shear(radius) - expected).abs());
        let stress = errors.filter(|error| error.is_finite()).fold(0.0, f64::max);
        ErrorEstimate {
            path_error: 0.0,
            force_error: relative(force, summary.gross_slip_force),
            stress_error: relative(stress, self.exact.friction * summary.unit_pressure()),
        }
    }

    /// Radii over the contact, m, but for those near a kink or a singular radius, if there are others;
    /// without, the kinks and
    /// the springs too, where stresses have cusps.
    fn compared_radii(&self) -> Vec<f64> {
        let (edge, near) = (self.contact_radius(), NEAREST * self.spacing);
        let mut kinks: Vec<f64> = self.exact.history.rings().map(|(ring, _)| ring.inner.radius).collect();
        kinks.extend(self.exact.profile.singular_radii());
        kinks.extend([0.0, edge]);
        let even = (0..COMPARED).map(|index| edge * (index as f64 + 0.5) / COMPARED as f64);
        let beside = kinks.iter().take(COMPARED).flat_map(|kink| [kink - 1.01 * near, kink + 1.01 * near]);
        let resolved =
            |radius: &f64| (0.0..edge).contains(radius) && kinks.iter().all(|kink| (radius - kink).abs() > near);
        let radii: Vec<f64> = even.clone().chain(beside).filter(resolved).collect();
        let springs = self.in_contact().map(|spring| spring.radius).take(COMPARED);
        if radii.is_empty() { even.chain(kinks.iter().copied()).chain(springs).collect() } else { radii }
    }
}
