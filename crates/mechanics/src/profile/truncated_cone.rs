//! Cone with a flat end, f' = T for r > b: g = T x phi, phi = arccos(b/x) = atan(t/b), t = sqrt(x^2 - b^2).
//!
//! gamma = dg/dt = T (phi t + b)/x, int x dg = (T/2)(x^2 phi + b t) (Shtaerman 1949; Popov & Hess 2015). f' jumps at b:
//! pressure and shear are log-infinite there.

use std::f64::consts::FRAC_PI_2;

use super::shape::{Falls, KernelOrder, ShapeFacts};
use super::smooth_coordinate::{self, Nodes, SmoothCoordinate, flat_core};
use super::{DoubleDouble, Error, Moments, Ring, Span, StressRadius, range};
use crate::numerics::angle::angles;

/// A truncated cone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TruncatedCone {
    slope: f64,
    flat_radius: f64,
}

impl TruncatedCone {
    /// The cone of the given slope T, flat up to the radius b, m.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] by [`range::SLOPE`] and [`range::FLAT_RADIUS`].
    pub fn new(slope: f64, flat_radius: f64) -> Result<TruncatedCone, Error> {
        Ok(TruncatedCone { slope: range::SLOPE.check(slope)?, flat_radius: range::FLAT_RADIUS.check(flat_radius)? })
    }

    /// phi.
    fn angle(&self, t: f64) -> f64 {
        (t / self.flat_radius).atan()
    }

    fn load_at(&self, t: f64) -> f64 {
        let b = self.flat_radius;
        0.5 * self.slope * ((b * b + t * t) * self.angle(t) + b * t)
    }
}

impl SmoothCoordinate for TruncatedCone {
    fn kink_radius(&self) -> f64 {
        self.flat_radius
    }

    fn level_at(&self, t: f64) -> f64 {
        self.slope * self.radius_at(t) * self.angle(t)
    }

    fn slope_at(&self, t: f64) -> f64 {
        let b = self.flat_radius;
        self.slope * (t * self.angle(t) + b) / self.radius_at(t)
    }

    fn bend_at(&self, t: f64) -> f64 {
        // gamma' = T phi b^2/x^3.
        let (b, x) = (self.flat_radius, self.radius_at(t));
        -self.slope * (self.angle(t) * t * t * t / (x * x) + b) / x
    }

    fn upper_bound(&self, level: f64) -> f64 {
        // phi >= t/x.
        level / self.slope
    }

    fn slopes_at<const N: usize>(&self, t: [f64; N]) -> Option<[f64; N]> {
        let b = self.flat_radius;
        let (angle, _) = angles(t.map(|t| t / b));
        Some(std::array::from_fn(|index| {
            let t = t[index];
            self.slope * (t * angle[index] + b) / (b * b + t * t).sqrt()
        }))
    }

    fn rises_at<const N: usize>(&self, nodes: &Nodes<N>, top: f64) -> [f64; N] {
        let (turns, _) = angles(nodes.tangents(self.flat_radius, top));
        nodes.rises((self.radius_at(top), self.slope * self.angle(top)), &turns.map(|turn| self.slope * turn))
    }

    fn solve(&self, level: f64) -> f64 {
        let b = self.flat_radius;
        let height = level / (self.slope * b);
        // sqrt(1 + u^2) atan(u) = height, whose u this is to 1.2e-3.
        let [p, q, r] = [1.424_421, 0.553_947_04, 1.398_492_3];
        let guess = if height < 1.0 {
            height * (1.0 + height * (p + height * q)) / (1.0 + height * (r + height * FRAC_PI_2 * q))
        } else {
            let w = height.recip();
            height * (w * (w + p) + q) / (w * (w + r) + FRAC_PI_2 * q)
        };
        let near = smooth_coordinate::near_root(guess, |u| {
            let (x, phi) = ((1.0 + u * u).sqrt(), u.atan());
            [x * phi - height, (u * phi + 1.0) / x, phi / (x * x * x)]
        });
        near.map_or_else(|| smooth_coordinate::solve(self, level), |u| b * u)
    }
}

flat_core!(TruncatedCone {
    fn falls(&self, inner: f64, outer: f64) -> Falls {
        // g'/x falls from the rim on.
        let least = if inner >= self.flat_radius { self.slope(outer) / outer } else { f64::NEG_INFINITY };
        Falls { least, concavely: false }
    }

    fn facts(&self) -> ShapeFacts {
        ShapeFacts { singular: Some(self.flat_radius), ..ShapeFacts::default() }
    }

    fn surface_slope(&self, r: f64) -> f64 {
        if r > self.flat_radius { self.slope } else { 0.0 }
    }
});
