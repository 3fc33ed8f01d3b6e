//! The face of a flat pad with rounded edges: G = (1/R) [t^2/2 arccos(b/t) - (b/2) sqrt(t^2 - b^2)] in the place of g.
//!
//! Over s = sqrt(t^2 - b^2), dG/ds = (s/R) arctan(s/b) (Ciavarella, Hills & Monno 1998).

use crate::cells::shape::{End, Kink, Kinks, Powers, Shape, above};
use crate::cells::stages::Stages;

/// G of a pad that is flat up to b, with edges of the radius R, as a body of revolution has g.
#[derive(Clone, Debug, PartialEq)]
pub struct PadFace {
    flat_half_width: f64,
    edge_radius: f64,
    stages: Stages,
}

impl PadFace {
    pub(super) fn new(flat_half_width: f64, edge_radius: f64) -> PadFace {
        PadFace { flat_half_width, edge_radius, stages: Stages::new() }
    }
}

impl Shape for PadFace {
    fn kinks(&self) -> Kinks {
        Kinks::from([Kink::new(self.flat_half_width, Powers::All(2))])
    }

    fn level(&self, x: f64) -> f64 {
        let b = self.flat_half_width;
        if x <= b {
            return 0.0;
        }
        let s = ((x - b) * (x + b)).sqrt();
        0.5 * (x * x * s.atan2(b) - b * s) / self.edge_radius
    }

    fn gamma(&self, base: f64, t: f64) -> f64 {
        let b = self.flat_half_width;
        above(b, base, t, |s| s / self.edge_radius * s.atan2(b))
    }

    /// That of a body of revolution with this g is not known, and not asked for.
    fn surface_slope(&self, _r: f64) -> f64 {
        f64::NAN
    }

    fn stages(&self) -> &Stages {
        &self.stages
    }

    fn end(&self) -> Option<End> {
        None
    }
}
