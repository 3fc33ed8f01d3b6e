//! Flat punch with a rounded edge, f = (r - b)^2/(2R) for r > b: g = (x/R)(t - b phi), phi = atan(t/b), t = sqrt(x^2 -
//! b^2).
//!
//! gamma = dg/dt = (t/(R x))(2t - b phi), int x dg = (3 x^2 (t - b phi) + t^3)/(6R) (Schubert 1942; Ciavarella 1999).
//! All stays positive through t - b phi = b (u - atan u), u = t/b.

use super::shape::{Falls, KernelOrder, ShapeFacts};
use super::smooth_coordinate::{self, Nodes, SmoothCoordinate, flat_core};
use super::{DoubleDouble, Error, Moments, Ring, Span, StressRadius, range};
use crate::numerics::angle::{angles, tangent_less_angle};

/// A flat punch with a rounded edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoundedPunch {
    flat_radius: f64,
    edge_radius: f64,
}

impl RoundedPunch {
    /// Flat up to the radius b, then a parabola of curvature radius R, both in m.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] by [`range::FLAT_RADIUS`] and [`range::EDGE_RADIUS`].
    pub fn new(flat_radius: f64, edge_radius: f64) -> Result<RoundedPunch, Error> {
        Ok(RoundedPunch {
            flat_radius: range::FLAT_RADIUS.check(flat_radius)?,
            edge_radius: range::EDGE_RADIUS.check(edge_radius)?,
        })
    }

    /// t - b phi.
    fn excess(&self, t: f64) -> f64 {
        self.flat_radius * tangent_less_angle(t / self.flat_radius)
    }

    fn load_at(&self, t: f64) -> f64 {
        let b = self.flat_radius;
        (3.0 * (b * b + t * t) * self.excess(t) + t * t * t) / (6.0 * self.edge_radius)
    }
}

impl SmoothCoordinate for RoundedPunch {
    fn kink_radius(&self) -> f64 {
        self.flat_radius
    }

    fn level_at(&self, t: f64) -> f64 {
        self.radius_at(t) * self.excess(t) / self.edge_radius
    }

    fn slope_at(&self, t: f64) -> f64 {
        t * (t + self.excess(t)) / (self.radius_at(t) * self.edge_radius)
    }

    fn bend_at(&self, t: f64) -> f64 {
        // t gamma' - gamma = (t^2/(R x)) (1 - (t - b phi) t/x^2), in which the bracket is above zero.
        let (x, excess) = (self.radius_at(t), self.excess(t));
        t * t * (1.0 - excess * t / (x * x)) / (x * self.edge_radius)
    }

    fn upper_bound(&self, level: f64) -> f64 {
        // t - b phi is above t - b pi/2; for t < b it is above t^3/(6 b^2).
        let (b, area) = (self.flat_radius, level * self.edge_radius);
        let quarter = std::f64::consts::FRAC_PI_4 * b;
        let far = quarter + (quarter * quarter + area).sqrt();
        let near = (6.0 * b * area).cbrt();
        if near < b { near.min(far) } else { far }
    }

    fn slopes_at<const N: usize>(&self, t: [f64; N]) -> Option<[f64; N]> {
        let b = self.flat_radius;
        let (_, lacking) = angles(t.map(|t| t / b));
        Some(std::array::from_fn(|index| {
            let t = t[index];
            t * (t + b * lacking[index]) / ((b * b + t * t).sqrt() * self.edge_radius)
        }))
    }

    fn rises_at<const N: usize>(&self, nodes: &Nodes<N>, top: f64) -> [f64; N] {
        let (b, curvature) = (self.flat_radius, self.edge_radius.recip());
        let tangents = nodes.tangents(b, top);
        let (_, lacking) = angles(tangents);
        // What the angle falls short of dt/b is of third order.
        let step = |index: usize| tangents[index] * nodes.t[index] * (top / b) + b * lacking[index];
        let steps: [f64; N] = std::array::from_fn(|index| curvature * step(index));
        nodes.rises((self.radius_at(top), curvature * self.excess(top)), &steps)
    }

    fn solve(&self, level: f64) -> f64 {
        let b = self.flat_radius;
        let height = level * self.edge_radius / (b * b);
        // sqrt(1 + u^2) (u - atan(u)) = height, whose u this is to 1.1e-3.
        let v = (3.0 * height).cbrt();
        let [p, q, r, s] = [1.580_546_5, 0.601_012_3, 0.187_413_4, 1.588_477];
        let ratio = if v < 1.0 {
            (1.0 + v * (p + v * (q + v * r))) / (1.0 + v * (s + v * 3.0 * r))
        } else {
            let w = v.recip();
            v * (w * (w * (w + p) + q) + r) / (w * (w + s) + 3.0 * r)
        };
        let near = smooth_coordinate::near_root(v * ratio.sqrt(), |u| {
            let (x, excess) = ((1.0 + u * u).sqrt(), tangent_less_angle(u));
            let slope = (u + excess) / x;
            [x * excess - height, u * slope, slope + u * (1.0 - excess * u / (x * x)) / x]
        });
        near.map_or_else(|| smooth_coordinate::solve(self, level), |u| b * u)
    }
}

flat_core!(RoundedPunch {
    fn falls(&self, inner: f64, outer: f64) -> Falls {
        let (low, high) = (smooth_coordinate::t_of(self, inner), smooth_coordinate::t_of(self, outer));
        // dq/dt = (t gamma' - gamma)/t^2 <= 1/(R x), and the int dt/sqrt(t^2 - t_r^2) that goes with it is
        // arcosh(t/t_r).
        let width = ((outer - inner) * (outer + inner)).sqrt();
        let rise = width * ((width + high) / low).ln() / (self.edge_radius * inner);
        let least = if low > 0.0 { self.slope(outer) / outer - rise } else { f64::NEG_INFINITY };
        // With u = t/b, R dq/d(u^2) = (1 + u phi)/(2 u (1 + u^2)^(3/2)) > 0, whose logarithm has the slope (phi + u/(1
        // + u^2))/(1 + u phi)
        // - 1/u - 3 u/(1 + u^2) < 0, since u phi + u^2/(1 + u^2) < 1 + u phi.
        Falls { least, concavely: inner >= self.flat_radius }
    }

    fn surface_slope(&self, r: f64) -> f64 {
        (r - self.flat_radius).max(0.0) / self.edge_radius
    }

    fn facts(&self) -> ShapeFacts {
        ShapeFacts { curvature_radius: Some(self.edge_radius), ..ShapeFacts::default() }
    }
});
