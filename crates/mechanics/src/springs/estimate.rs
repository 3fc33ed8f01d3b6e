//! The error of the spring foundation, measured against the exact contact that makes the same moves.

use super::Springs;
use crate::contact::accuracy::ErrorEstimate;

/// Radii at even distances at which stresses are compared, and kinks of the displacement beside which they are.
const COMPARED: usize = 128;
const KINKS: usize = 32;
/// Distances from a kink, in cells: a stress is smeared over a cell there, and errs the most.
const BESIDE: [f64; 9] = [-2.0, -1.0, -0.5, -0.1, 0.0, 0.1, 0.5, 1.0, 2.0];
/// Distance from a singular radius of the profile, in cells, from which on the error of the stress is stated.
const NEAREST: f64 = 2.0;
/// The contact radius, in cells, up to which it is stated for all radii.
const FEW: f64 = 5.0;

impl Springs {
    /// The errors by the discretisation. The one of the force holds for all states so far: it is the largest, over the
    /// largest friction limit among them, or that of the present state over its own limit, if that is more. The one of
    /// the stress is the largest over the present contact, beside the kinks of the displacement too, but for radii
    /// within some cells (of twice the largest contact radius over the number of springs) of a singular radius of the
    /// profile.
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
        let present = relative(self.force_error(self.force(), self.normal_force()), summary.gross_slip_force);
        let radii = self.compared_radii();
        let expected = self.exact.shears(&radii);
        let errors = radii.iter().zip(expected).take_while(|_| keep_going());
        let errors = errors.map(|(&radius, expected)| (self.shear(radius) - expected).abs());
        let stress = errors.filter(|error| error.is_finite()).fold(0.0, f64::max);
        ErrorEstimate {
            path_error: 0.0,
            force_error: present.max(relative(self.largest_force_error, self.largest_limit)),
            stress_error: relative(stress, self.exact.friction * summary.unit_pressure()),
        }
    }

    /// The error of the tangential force, N, or of the friction limit by that of the normal force, if that is more.
    fn force_error(&self, force: f64, normal_force: f64) -> f64 {
        let normal = self.exact.friction * (normal_force - self.exact.normal_force()).abs();
        (force - self.exact.force()).abs().max(normal)
    }

    /// Takes the state with these forces, N, into the error of all states so far.
    pub(super) fn note_error(&mut self, force: f64, normal_force: f64) {
        self.largest_limit = self.largest_limit.max(self.exact.friction * self.exact.normal_force());
        self.largest_force_error = self.largest_force_error.max(self.force_error(force, normal_force));
    }

    /// Radii over the contact, m, and beside its kinks, but for those near a singular radius.
    fn compared_radii(&self) -> Vec<f64> {
        let edge = self.contact_radius();
        // So few springs leave no radius that is far from all.
        let near = if edge > FEW * self.spacing { NEAREST * self.spacing } else { 0.0 };
        let singular = self.exact.indenter.singular_radii();
        let mut kinks: Vec<f64> = self.exact.history.rings().map(|(ring, _)| ring.inner.radius).collect();
        kinks.push(edge);
        let even = (0..COMPARED).map(|index| edge * (index as f64 + 0.5) / COMPARED as f64);
        let some = kinks.iter().step_by(kinks.len().div_ceil(KINKS));
        let beside = some.flat_map(|kink| BESIDE.map(|cells| kink + cells * self.spacing));
        let resolved =
            |radius: &f64| (0.0..edge).contains(radius) && singular.iter().all(|place| (radius - place).abs() > near);
        // Between few springs a stress has a cusp at each.
        let springs = self.in_contact().map(|spring| spring.radius).take(COMPARED);
        even.chain(beside).chain(springs).filter(resolved).collect()
    }
}
