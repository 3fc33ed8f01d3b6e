//! Criteria at a critical distance L below the surface, which the gradient under a contact asks for (Taylor, *The
//! Theory of Critical Distances*, 2007; for fretting Araújo, Susmel, Taylor, Ferro & Mamiya, Int. J. Fatigue 29, 2007).
//!
//! The point method takes the stress at the depth L/2. The line method takes its mean over the depth 2L, instant by
//! instant, and rates the cycle of this mean stress.

use super::{Rated, Study};
use crate::numerics::gauss::{EIGHT_POINTS, by_halves};
use crate::range::error::Error;
use crate::subsurface::{Stress, Subsurface};

/// Halvings of the interval over which a stress is averaged.
const MOST_HALVINGS: u32 = 16;

/// Where below the surface a criterion is evaluated, with the critical distance L, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CriticalDistance {
    /// At L/2.
    Point(f64),
    /// For the mean stress down to 2L.
    Line(f64),
}

impl Study<'_> {
    /// A criterion of stress, by its index, below a place of the surface, m, to the tolerance of this study; the value
    /// is infinite where the stress is.
    ///
    /// # Errors
    /// [`Error::Interrupted`].
    pub fn rate_below(&self, measure: usize, [x, y, _]: [f64; 3], distance: CriticalDistance) -> Result<Rated, Error> {
        let (place, averaged) = match distance {
            CriticalDistance::Point(length) => ([x, y, 0.5 * length], 0.0),
            CriticalDistance::Line(length) => ([x, y, 0.0], 2.0 * length),
        };
        let measures = vec![self.measures[measure]];
        let mut alone = Study::new(self.cycle, self.body, self.bulk, measures, self.tolerance, self.keep_going)?;
        alone.averaged = averaged;
        let found = alone.rate_all(&[place])?.largest[0];
        Ok(found.map_or(Rated { value: f64::INFINITY, error: 0.0, plane: None, at: None }, |largest| largest.rated))
    }
}

/// The mean of the stress from a place of the surface to a depth, m, to within `allowed`, Pa, and its estimated error.
///
/// Over s with z = depth s^2 the roots and poles of the stress at the surface, sqrt(z) and 1/sqrt(z), are smooth.
pub(super) fn mean_over_depth(field: &Subsurface, [x, y, _]: [f64; 3], depth: f64, allowed: f64) -> (Stress, f64) {
    let rule = |[from, to]: [f64; 2]| {
        let at = |(part, weight): &(f64, f64)| {
            let s = from + part * (to - from);
            field.stress([x, y, depth * s * s]) * (2.0 * s * weight * (to - from))
        };
        EIGHT_POINTS.iter().map(at).fold(Stress::default(), |sum, part| sum + part)
    };
    let off = |whole: Stress, sum: Stress| (sum + whole * -1.0).norm();
    let coarse = |[from, to]: [f64; 2], whole, sum| off(whole, sum) > allowed * (to - from);
    by_halves([0.0, 1.0], MOST_HALVINGS, rule, coarse)
        .into_iter()
        .fold((Stress::default(), 0.0), |(mean, error), (whole, sum)| (mean + sum, error + off(whole, sum)))
}
