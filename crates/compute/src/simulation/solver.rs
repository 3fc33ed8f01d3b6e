//! The interface that the exact solver and the spring foundation share.

use stickslip_mechanics::protocol::{self, EqualPeaks};
use stickslip_mechanics::{Error, ErrorEstimate, Move, Residual, Springs, State};

use crate::prelude::*;

/// Radii between two questions whether to go on.
const RADII_AT_ONCE: usize = 352;
/// Terms between them where each radius adds up all.
const TERMS_AT_ONCE: usize = 1 << 17;

/// Radii at which so many terms each take as long as that.
fn radii_of_terms(terms: usize) -> usize {
    (TERMS_AT_ONCE / terms.max(1)).clamp(1, RADII_AT_ONCE)
}

/// A contact that can be moved and whose fields can be read. What a solver does not define is that of its exact
/// contact.
pub trait Solver {
    /// Its name in replies.
    const KIND: SolverKind = SolverKind::Exact;

    /// The exact contact, on which the moves of a path may depend; springs have it as it was before their first move.
    fn exact(&self) -> &Contact;

    /// Makes a move, unless `go_on` ends it; a refused one changes nothing. The tolerance holds where no exact solution
    /// exists.
    ///
    /// # Errors
    /// What the mechanics has no answer to, and [`Error::Interrupted`].
    fn apply(&mut self, step: &Move, tolerance: f64, go_on: &dyn Fn() -> bool) -> Result<(), Error>;

    /// The state after the last move.
    fn state(&self) -> State {
        self.exact().state()
    }

    /// Pieces of the slip history.
    fn depth(&self) -> usize {
        self.exact().memory_depth()
    }

    /// How many radii a field is computed at between two questions whether to go on, which takes some milliseconds.
    /// The rings of a round contact are summed by a tree, which is built once for all of them.
    fn radii_at_once(&self) -> usize {
        if self.exact().profile().line().is_some() { radii_of_terms(self.depth()).max(64) } else { RADII_AT_ONCE }
    }

    /// A field at each of the radii, m: a stress, Pa, or a displacement, m. Not a number for the slip outside the
    /// contact.
    fn field(&self, field: Field, radii: &[f64]) -> Vec<f64> {
        let contact = self.exact();
        match field {
            Field::Pressure => contact.pressures(radii),
            Field::Shear => contact.shears(radii),
            Field::Slip => contact.slips(radii).into_iter().map(|slip| slip.unwrap_or(f64::NAN)).collect(),
            Field::Displacement => contact.surface_displacements(radii),
            Field::Hoop => contact.hoops(radii),
        }
    }

    /// The path of equal peaks for the exact contact; an error for a cut-off radius that it does not allow.
    fn equal_peaks(&self, reversals: usize, cutoff_radius: Option<f64>) -> Result<EqualPeaks, Error> {
        protocol::equal_peaks(self.exact(), reversals, cutoff_radius)
    }

    /// Contact radius a, m.
    fn contact_radius(&self) -> f64 {
        self.exact().contact_radius()
    }

    /// Tangential displacement of the indenter, m.
    fn displacement(&self) -> f64 {
        self.exact().displacement()
    }

    /// Displacement of gross slip on first loading, m, at the present load.
    fn gross_slip_displacement(&self) -> f64 {
        self.exact().gross_slip_displacement()
    }

    /// The extrema of the shear stress, if `go_on` has not ended the search for them.
    fn residual(&self, go_on: &dyn Fn() -> bool) -> Option<Residual> {
        self.exact().residual_while(go_on)
    }

    /// Estimated errors of force and stress, relative to μ F_N and μ p_max; of no use once `go_on` has ended it.
    fn accuracy(&self, _go_on: &dyn Fn() -> bool) -> ErrorEstimate {
        self.exact().accuracy()
    }

    /// Error that curved moves have left in the force, relative to μ F_N.
    fn path_error(&self) -> f64 {
        self.exact().path_error()
    }
}

impl Solver for Contact {
    fn exact(&self) -> &Contact {
        self
    }

    fn apply(&mut self, step: &Move, tolerance: f64, go_on: &dyn Fn() -> bool) -> Result<(), Error> {
        self.apply_while(step, tolerance, go_on)
    }
}

impl Solver for Springs {
    const KIND: SolverKind = SolverKind::Springs;

    fn exact(&self) -> &Contact {
        self.virgin()
    }

    fn apply(&mut self, step: &Move, _tolerance: f64, go_on: &dyn Fn() -> bool) -> Result<(), Error> {
        self.apply_while(step, go_on)
    }

    fn state(&self) -> State {
        self.state()
    }

    fn depth(&self) -> usize {
        0
    }

    fn radii_at_once(&self) -> usize {
        radii_of_terms(self.state().memory_depth)
    }

    fn field(&self, field: Field, radii: &[f64]) -> Vec<f64> {
        let at = |&radius: &f64| match field {
            Field::Pressure => self.pressure(radius),
            Field::Shear => self.shear(radius),
            Field::Slip => self.slip(radius).unwrap_or(f64::NAN),
            Field::Displacement => self.surface_displacement(radius),
            // Springs follow no twist.
            Field::Hoop => 0.0,
        };
        radii.iter().map(at).collect()
    }

    fn contact_radius(&self) -> f64 {
        self.contact_radius()
    }

    fn displacement(&self) -> f64 {
        self.displacement()
    }

    fn gross_slip_displacement(&self) -> f64 {
        self.gross_slip_displacement()
    }

    fn residual(&self, go_on: &dyn Fn() -> bool) -> Option<Residual> {
        self.residual_while(go_on)
    }

    fn accuracy(&self, go_on: &dyn Fn() -> bool) -> ErrorEstimate {
        self.accuracy_while(go_on)
    }

    fn path_error(&self) -> f64 {
        // No move of theirs is curved.
        0.0
    }
}
