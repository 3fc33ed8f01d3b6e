//! Families that are known by their load curve alone: X(y) = F_N'(y)/(2 E*), and no surface.
//!
//! The slip history asks for X and its integrals over rings of levels, which every contact has whose tangential
//! compliance is proportional to its normal one, point by point of the load curve (Ciavarella 1998; Jaeger 1998). Such
//! a family is to the rest of the mechanics the body of revolution with the same curve, g the inverse of X, but for
//! what needs a surface: its kernels and slopes are NaN, and whoever asks for a stress checks
//! [`Profile::check_stress_field`](super::Profile) first.

use super::ring_nodes::{DepthNode, RingNodes};
use super::{DoubleDouble, InterpolationError, Moments, Ring};

/// Panels of the angle for the sums over a ring, at the least, and for each wave.
const PANELS: usize = 512;
const PANELS_A_WAVE: usize = 16;

/// The functions of a load curve.
pub(super) trait CurveFamily {
    /// X(y), m.
    fn radius_at(&self, level: DoubleDouble) -> f64;

    /// X'(y) (pure number).
    fn rate(&self, level: f64) -> f64;

    /// The level, m, from which on X is no less than `radius`, m.
    fn level_of(&self, radius: f64) -> f64;

    /// The integrals over a ring, each to round-off of itself.
    fn moments_of(&self, ring: &Ring) -> Moments;

    /// The indentation, m, at which int X dy is `load`, m^2.
    fn indentation_of(&self, load: f64) -> f64;

    /// X above every radius of the curve, m, if it ends.
    fn end(&self) -> Option<f64> {
        None
    }

    /// The interpolation error in a contact of this radius, m.
    fn curve_error(&self, _radius: f64) -> InterpolationError {
        InterpolationError::default()
    }

    /// Nodes at even steps of the angle whose cosine is 1 - 2 h/depth, each with the width between its neighbours'
    /// midpoints.
    fn nodes_at(&self, ring: &Ring, panels: usize) -> Vec<DepthNode> {
        let depth = |half_steps: usize| {
            let sine = (std::f64::consts::FRAC_PI_4 * half_steps as f64 / panels as f64).sin();
            ring.depth * sine * sine
        };
        let radius = |depth: f64| self.radius_at(ring.outer.level - DoubleDouble::from(depth));
        let mut outer = ring.outer.radius;
        let node = |index: usize| {
            let inner = radius(depth(2 * index + 2));
            let width = outer - inner;
            outer = inner;
            DepthNode { weight: width, depth: depth(2 * index + 1) }
        };
        (0..panels).map(node).collect()
    }

    /// The nodes of a quadrature over the radii of a ring for waves up to cos(`turns` th).
    fn ring_nodes(&self, ring: &Ring, turns: usize) -> RingNodes {
        let panels = PANELS.max(PANELS_A_WAVE * turns);
        RingNodes::Compared(self.nodes_at(ring, panels), self.nodes_at(ring, 2 * panels))
    }
}
