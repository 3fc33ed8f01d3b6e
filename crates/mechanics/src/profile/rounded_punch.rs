//! Flat punch with a rounded edge, f = (r - b)^2/(2R) for r > b: g = (x/R)(t - b phi), phi = atan(t/b), t = sqrt(x^2 -
//! b^2).
//!
//! gamma = dg/dt = (t/(R x))(2t - b phi) (Schubert 1942; Ciavarella 1999). All stays positive through t - b phi = b (u
//! - atan u), u = t/b.

use super::celled::by_cells;
use super::shape::{Falls, ShapeFacts};
use super::{Error, range};
use crate::cells::Powers;
use crate::cells::grid::{Kink, above};
use crate::cells::stages::Stages;
use crate::numerics::angle::angles;

/// A flat punch with a rounded edge.
#[derive(Clone, Debug, PartialEq)]
pub struct RoundedPunch {
    flat_radius: f64,
    edge_radius: f64,
    stages: Stages,
}

impl RoundedPunch {
    /// Flat up to the radius b, then a parabola of curvature radius R, both in m.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] by [`range::FLAT_RADIUS`] and [`range::EDGE_RADIUS`].
    pub fn new(flat_radius: f64, edge_radius: f64) -> Result<RoundedPunch, Error> {
        let (flat_radius, edge_radius) =
            (range::FLAT_RADIUS.check(flat_radius)?, range::EDGE_RADIUS.check(edge_radius)?);
        Ok(RoundedPunch { flat_radius, edge_radius, stages: Stages::new() })
    }
}

by_cells!(RoundedPunch {
    fn kinks(&self) -> Vec<Kink> {
        vec![Kink { radius: self.flat_radius, powers: Powers::All(2) }]
    }

    fn slopes<const N: usize>(&self, base: f64, t: [f64; N]) -> [f64; N] {
        let b = self.flat_radius;
        above(b, base, t, |t| {
            let (_, lacking) = angles(t.map(|t| t / b));
            std::array::from_fn(|lane| {
                let t = t[lane];
                t * (t + b * lacking[lane]) / ((b * b + t * t).sqrt() * self.edge_radius)
            })
        })
    }

    fn falls(&self, inner: f64, outer: f64) -> Falls {
        let t_of = |x: f64| ((x - self.flat_radius) * (x + self.flat_radius)).max(0.0).sqrt();
        let (low, high) = (t_of(inner), t_of(outer));
        // dq/dt = (t gamma' - gamma)/t^2 <= 1/(R x), and the int dt/sqrt(t^2 - t_r^2) that goes with it is
        // arcosh(t/t_r).
        let width = ((outer - inner) * (outer + inner)).sqrt();
        let rise = width * ((width + high) / low).ln() / (self.edge_radius * inner);
        let least = if low > 0.0 { self.slope(outer) / outer - rise } else { f64::NEG_INFINITY };
        // With u = t/b, R dq/d(u^2) = (1 + u phi)/(2 u (1 + u^2)^(3/2)) > 0, whose logarithm has the slope (phi + u/(1
        // + u^2))/(1 + u phi) - 1/u - 3 u/(1 + u^2) < 0, since u phi + u^2/(1 + u^2) < 1 + u phi.
        Falls { least, concavely: inner >= self.flat_radius }
    }

    fn surface_slope(&self, r: f64) -> f64 {
        (r - self.flat_radius).max(0.0) / self.edge_radius
    }

    fn facts(&self) -> ShapeFacts {
        ShapeFacts { curvature_radius: Some(self.edge_radius), ..ShapeFacts::default() }
    }
});
