//! One criterion at one place of a cycle, and what a measure is where the stress is infinite.

use super::rating::Found;
use super::{Criterion, Cycle, Measure, Rated, Study};
use crate::Error;
use crate::subsurface::Side;

/// A criterion at one place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Refined {
    /// Its value, with plane and instant.
    pub value: Rated,
    /// Instants of the move that took most.
    pub instants: usize,
    /// The estimated error over the value: above the tolerance if [`MAX_INSTANTS`](super::MAX_INSTANTS) were not
    /// enough.
    pub change: f64,
}

impl Cycle {
    /// A criterion at one place, m, to a `tolerance` relative to it, such as
    /// [`DEFAULT_REFINEMENT`](super::DEFAULT_REFINEMENT).
    ///
    /// # Errors
    /// As [`Study::new`], and [`Error::Interrupted`].
    pub fn refined(
        &self,
        criterion: &Criterion,
        body: (Side, f64),
        place: [f64; 3],
        tolerance: f64,
        keep_going: &dyn Fn() -> bool,
    ) -> Result<Refined, Error> {
        let mut study = Study::new(self, body, None, vec![Measure::Stress(*criterion)], tolerance, keep_going)?;
        study.sample(&place, true)?;
        let (found, instants) = study.rate(&place)?;
        let value = study.rated(&found[0]);
        let change = if value.error > 0.0 { value.error / value.value.abs() } else { 0.0 };
        Ok(Refined { value, instants, change })
    }

    /// A measure where the stress is infinite: infinite too, unless it needs slip and there is none.
    pub(super) fn infinite(&self, measure: &Measure, place: &[f64; 3]) -> Found {
        let radius = place[0].hypot(place[1]);
        let slips = (0..self.moves()).filter_map(|step| self.state(step, 1.0).0.slip(radius));
        let (low, high) =
            slips.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), slip| (low.min(slip), high.max(slip)));
        let value = if measure.of_surface() && high <= low { 0.0 } else { f64::INFINITY };
        Found { value, error: 0.0, plane: None, at: None }
    }
}
