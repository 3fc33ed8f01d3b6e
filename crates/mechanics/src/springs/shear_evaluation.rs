//! Three formulas for the shear stress from the displacements of the springs.
//!
//! tau(r) = -(G*/pi) int_r^a u'(x)/sqrt(x^2 - r^2) dx (eq. 19 of Kraft & Pohrt 2016) needs a displacement between the
//! springs too. Drawn straight over x it gives an arcosh per cell. Drawn straight over g(x) it gives the profile's own
//! integral per cell, and is exact but in the cells that hold a kink. Not drawn at all, with the derivative taken as a
//! difference and the integral as a sum, it is the direct discretisation of the formula.

use std::f64::consts::PI;

use super::Springs;
use crate::numerics::double_double::DoubleDouble;
use crate::profile::Ring;

/// The formula for the shear stress between the springs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ShearEvaluation {
    /// The displacement is straight over x from spring to spring, as in [`Springs::shear`].
    Arcosh,
    /// The displacement is straight over g(x) from spring to spring.
    Level,
    /// The plain recipe: differences between neighbours over the root at their midpoint, summed at the radius of each
    /// spring; straight between those radii.
    Differences,
}

impl Springs {
    /// Shear stress, Pa, at each of `radii`, m.
    ///
    /// ```
    #[doc = include_str!("../example.txt")]
    /// use stickslip_mechanics::springs::ShearEvaluation;
    ///
    /// let springs = Springs::new(setup, 1000, 0.1)?;
    /// assert_eq!(springs.shears_by(ShearEvaluation::Level, &[0.05]), [0.0]);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn shears_by(&self, kernel: ShearEvaluation, radii: &[f64]) -> Vec<f64> {
        match kernel {
            ShearEvaluation::Arcosh => radii.iter().map(|&radius| self.shear(radius)).collect(),
            ShearEvaluation::Level => self.shears_over_levels(radii),
            ShearEvaluation::Differences => {
                let nodes: Vec<(f64, f64)> = self.in_contact().map(|spring| (spring.radius, spring.carried)).collect();
                radii.iter().map(|&radius| self.shear_by_differences(&nodes, radius)).collect()
            }
        }
    }

    fn shears_over_levels(&self, radii: &[f64]) -> Vec<f64> {
        // At the level of the indentation nothing is carried, whatever the profile.
        let edge = (self.indentation, 0.0);
        let nodes = self.in_contact().map(|spring| (spring.level, spring.carried)).chain([edge]);
        let nodes: Vec<_> =
            nodes.map(|(level, carried)| (self.virgin.indenter.point(DoubleDouble::from(level)), carried)).collect();
        let rings: Vec<(Ring, f64)> = nodes
            .windows(2)
            .map(|pair| {
                let ring = Ring::between(pair[0].0, pair[1].0);
                let slope = if ring.depth > 0.0 { (pair[0].1 - pair[1].1) / ring.depth } else { 0.0 };
                (ring, slope)
            })
            .collect();
        let unit = self.virgin.elasticity.g_star() / PI;
        self.virgin.indenter.kernel_sums(&rings, radii).into_iter().map(|sum| unit * sum).collect()
    }

    fn shear_by_differences(&self, nodes: &[(f64, f64)], radius: f64) -> f64 {
        if radius > self.contact_radius() {
            return 0.0;
        }
        let outer = nodes.partition_point(|(x, _)| *x <= radius);
        let Some(inner) = outer.checked_sub(1) else { return self.difference_sum(nodes, 0) };
        let part = (radius - nodes[inner].0) / self.spacing;
        (1.0 - part) * self.difference_sum(nodes, inner) + part * self.difference_sum(nodes, outer)
    }

    /// The sum at the radius of spring `index`, over all differences outside it; beyond the last spring nothing is
    /// carried.
    fn difference_sum(&self, nodes: &[(f64, f64)], index: usize) -> f64 {
        let Some(&(radius, _)) = nodes.get(index) else { return 0.0 };
        let next = nodes[index + 1..].iter().map(|(_, carried)| *carried).chain([0.0]);
        let sum: f64 = nodes[index..]
            .iter()
            .zip(next)
            .map(|(&(x, carried), next)| {
                let middle = x + 0.5 * self.spacing;
                (carried - next) / ((middle - radius) * (middle + radius)).sqrt()
            })
            .sum();
        self.virgin.elasticity.g_star() / PI * sum
    }
}
