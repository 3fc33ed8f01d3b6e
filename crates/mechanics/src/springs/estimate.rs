//! Error estimates of the spring foundation: fewer springs, the exact normal contact, and second differences.
//!
//! Each of these alone may miss an error by accident. A displacement u that is known at the springs, and bends by s in
//! a cell dx, is off by no more than s dx^2/8 in its integral, and in a stress at r by that times the derivative of
//! 1/sqrt(x^2 - r^2): the second differences between the springs bound both. Where more than a bend falls into a cell,
//! springs of another number differ. With so few springs that every radius is near the centre or the edge, none of
//! these says anything, and friction alone bounds the error.

use std::f64::consts::PI;

use super::super::accuracy::ErrorEstimate;
use super::{Move, Normal, Springs};

/// Radii at which stresses are compared.
const COMPARED: usize = 64;
/// How near to a kink of the displacement, in cells, the estimate of the stress is meant to hold.
const NEAREST: f64 = 2.0;

impl Springs {
    /// The errors by the discretisation: the largest of several estimates. The one of the stress is for radii some
    /// cells (of twice the largest contact radius over the number of springs) away from the kinks of the displacement,
    /// the centre, the edge and whatever singular radius the profile has: nearer, a stress is smeared over a cell.
    /// Where no radius is that far from the centre, the edge and the singular radii, it is a bound for all radii but
    /// the nearest to a singular one.
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
        let figures = self.normal.summary();
        let edge = self.contact_radius();
        let relative = |error: f64, unit: f64| if unit > 0.0 { error / unit } else { 0.0 };
        let pressure = figures.unit_pressure();
        let bends = self.bends();
        let misplaced = 2.0 * self.virgin.initial.g_star * self.misplaced;
        let differences = self.coarser.iter().map(|coarse| (self.force() - coarse.force()).abs());
        let normal = self.virgin.friction * (self.normal_force() - figures.normal_force).abs();
        let force = differences.fold(normal.max(self.force_bound(&bends)), f64::max) + misplaced * edge;
        let stress = if self.resolves_a_radius(edge) {
            let radii = self.off_kinks(edge, NEAREST * self.spacing).take_while(|_| keep_going());
            radii.map(|at| self.stress_doubt(at, &bends)).fold(0.0, f64::max)
        } else {
            self.friction_bound(edge)
        };
        let stress = stress + misplaced / (PI * (2.0 * NEAREST * edge * self.spacing).sqrt());
        ErrorEstimate {
            path_error: 0.0,
            force_error: relative(force, figures.gross_slip_force) + f64::EPSILON,
            stress_error: relative(stress, self.virgin.friction * pressure) + f64::EPSILON,
        }
    }

    /// Whether some radius is so far from the centre, the edge and the singular radii that estimates are meant for it.
    fn resolves_a_radius(&self, edge: f64) -> bool {
        let near = NEAREST * self.spacing;
        self.off_kinks(edge, near).any(|radius| radius > near && edge - radius > near)
    }

    /// Bound on the error of the shear stress, Pa, at any radius: its own magnitude and that of the true one. Over y =
    /// g(x) the true displacement has slopes of one at the most (see `slip_history`), and none below the level that
    /// the path cannot have reached, the least indentation less |U|/m; so |tau| is no more than mu times the pressure
    /// that was added beyond that level.
    fn friction_bound(&self, edge: f64) -> f64 {
        if self.farthest <= 0.0 {
            return 0.0;
        }
        let scale = self.virgin.scale();
        let held = if scale > 0.0 { (self.shallowest - self.farthest / scale).max(0.0) } else { 0.0 };
        let mut core = self.normal.clone();
        let kept = core.apply(&Move { normal: Some(Normal::Indentation(held)), ..Move::default() }).is_ok();
        self.off_kinks(edge, 0.0)
            .map(|radius| {
                let inner = if kept { core.pressure(radius) } else { 0.0 };
                self.shear(radius).abs() + self.virgin.friction * (self.normal.pressure(radius) - inner)
            })
            .fold(0.0, f64::max)
    }

    /// Radii over the contact, but for those as `near` to where the profile has a singular stress, m.
    fn off_kinks(&self, edge: f64, near: f64) -> impl Iterator<Item = f64> {
        let singular = self.virgin.profile.singular_radii();
        (0..COMPARED)
            .map(move |index| edge * (index as f64 + 0.5) / COMPARED as f64)
            .filter(move |radius| singular.iter().all(|at| (radius - at).abs() > near))
    }

    /// Magnitudes of the second differences of the displacement, m, at each spring and just outside: (radius, weight,
    /// bend).
    fn bends(&self) -> Vec<(f64, f64, f64)> {
        let springs: Vec<_> = self.in_contact().copied().collect();
        let carried = |index: usize| springs.get(index).map_or(0.0, |spring| spring.carried);
        // A vertical edge ends with a cell, and there is nothing beyond it.
        let open = self.rim_depth() <= 0.0;
        let count = if open { springs.len() + 1 } else { springs.len().saturating_sub(1) };
        (0..count)
            .map(|index| {
                let Some(spring) = self.springs.get(index) else {
                    return (self.contact_radius(), 2.0, carried(index - 1).abs());
                };
                // Across the centre the row is its own mirror image.
                let inner = match index {
                    0 if spring.radius > 0.0 => carried(0),
                    0 => carried(1),
                    _ => carried(index - 1),
                };
                (spring.radius, spring.weight, (inner - 2.0 * carried(index) + carried(index + 1)).abs())
            })
            .collect()
    }

    /// Bound on the error of the force by the second differences, N.
    fn force_bound(&self, bends: &[(f64, f64, f64)]) -> f64 {
        let sum: f64 = bends.iter().map(|(_, weight, bend)| weight * bend).sum();
        self.stiffness() * sum / 8.0
    }

    /// Estimated error of the shear stress at a radius, m, in Pa.
    fn stress_doubt(&self, radius: f64, bends: &[(f64, f64, f64)]) -> f64 {
        let nearest = radius + NEAREST * self.spacing;
        let sum: f64 = bends
            .iter()
            .filter(|(at, ..)| *at > radius - self.spacing)
            .map(|(at, _, bend)| {
                let at = at.max(nearest);
                let square = (at - radius) * (at + radius);
                bend * at / (square * square.sqrt())
            })
            .sum();
        let open = self.virgin.initial.g_star / PI * self.spacing * sum / 8.0;
        let normal = self.virgin.friction * (self.pressure(radius) - self.normal.pressure(radius)).abs();
        let shear = self.shear(radius);
        let differences = self.coarser.iter().map(|coarse| (shear - coarse.shear(radius)).abs());
        differences.fold(open.max(normal), f64::max)
    }

    /// Error of the displacement, m, under a prescribed force: the change that a force within its error bound makes.
    pub(super) fn misplacement(&self, displacement: f64, keep_going: &dyn Fn() -> bool) -> f64 {
        let moved = displacement - self.displacement;
        let scale = self.virgin.scale();
        let mut after = self.clone();
        after.coarser.clear();
        after.advance(self.indentation, displacement);
        let error = after.force_bound(&after.bends());
        let force = after.force();
        // At most up to gross slip.
        let room = |sign: f64| {
            self.in_contact()
                .map(|spring| scale * (self.indentation - spring.level) - sign * spring.carried)
                .fold(0.0, f64::max)
        };
        let change = |target: f64, sign: f64| {
            self.displacement_for(target, keep_going).map_or(sign * room(sign), |found| found - self.displacement)
        };
        (change(force + error, 1.0) - moved).abs().max((change(force - error, -1.0) - moved).abs())
    }
}
