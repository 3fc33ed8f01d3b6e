//! The interface that the exact solver and the spring foundation share.

use stickslip_mechanics::protocol::{self, EqualPeaks};
use stickslip_mechanics::{Contact, ContactSummary, Error, ErrorEstimate, Move, Residual, Springs, State};
use stickslip_wire::SolverKind;

/// A contact that can be moved and whose fields can be read.
pub trait Solver {
    /// Its name in replies.
    const KIND: SolverKind;

    /// The summary of the definition.
    fn summary(&self) -> ContactSummary;
    /// Makes a move, unless `go_on` ends it; a refused one changes nothing. The tolerance holds where no exact solution
    /// exists.
    ///
    /// # Errors
    /// What the mechanics has no answer to, and [`Error::Interrupted`].
    fn apply(&mut self, step: &Move, tolerance: f64, go_on: &dyn Fn() -> bool) -> Result<(), Error>;
    /// The state after the last move.
    fn state(&self) -> State;
    /// Pieces of the slip history.
    fn depth(&self) -> usize;
    /// Normal pressure at each of the radii (m), Pa.
    fn pressures(&self, radii: &[f64]) -> Vec<f64>;
    /// Shear stress at each of the radii (m), Pa.
    fn shears(&self, radii: &[f64]) -> Vec<f64>;
    /// Slip under the indenter at each of the radii (m), m; none outside the contact.
    fn slips(&self, radii: &[f64]) -> Vec<Option<f64>>;
    /// Tangential displacement of the surface at each of the radii (m), m.
    fn surface_displacements(&self, radii: &[f64]) -> Vec<f64>;
    /// The exact contact, on which the moves of a path may depend; springs have it as it was before their first move.
    fn exact(&self) -> &Contact;
    /// The path of equal peaks for the exact contact; an error for a cut-off radius that it does not allow.
    fn equal_peaks(&self, reversals: usize, cutoff_radius: Option<f64>) -> Result<EqualPeaks, Error> {
        protocol::equal_peaks(self.exact(), reversals, cutoff_radius)
    }
    /// Contact radius a, m.
    fn contact_radius(&self) -> f64;
    /// Tangential displacement of the indenter, m.
    fn displacement(&self) -> f64;
    /// Displacement of gross slip on first loading, m, at the present load.
    fn gross_slip_displacement(&self) -> f64;
    /// The extrema of the shear stress, if `go_on` has not ended the search for them.
    fn residual(&self, go_on: &dyn Fn() -> bool) -> Option<Residual>;
    /// mu p_max at the present load, Pa, or mu times the mean pressure where p_max is infinite.
    fn unit_shear(&self) -> f64;
    /// Estimated errors of force and stress, relative to μ F_N and μ p_max.
    fn accuracy(&self) -> ErrorEstimate;
    /// Error that curved moves have left in the force, relative to μ F_N.
    fn path_error(&self) -> f64;
    /// The contact whose stress below the surface is known.
    fn in_depth(&self) -> Option<&Contact>;
}

impl Solver for Contact {
    const KIND: SolverKind = SolverKind::Exact;

    fn summary(&self) -> ContactSummary {
        self.initial_summary()
    }

    fn apply(&mut self, step: &Move, tolerance: f64, go_on: &dyn Fn() -> bool) -> Result<(), Error> {
        self.apply_while(step, tolerance, go_on)
    }

    fn state(&self) -> State {
        self.state()
    }

    fn depth(&self) -> usize {
        self.memory_depth()
    }

    fn pressures(&self, radii: &[f64]) -> Vec<f64> {
        self.pressures(radii)
    }

    fn shears(&self, radii: &[f64]) -> Vec<f64> {
        self.shears(radii)
    }

    fn slips(&self, radii: &[f64]) -> Vec<Option<f64>> {
        self.slips(radii)
    }

    fn surface_displacements(&self, radii: &[f64]) -> Vec<f64> {
        self.surface_displacements(radii)
    }

    fn exact(&self) -> &Contact {
        self
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

    fn unit_shear(&self) -> f64 {
        Contact::summary(self).unit_shear()
    }

    fn accuracy(&self) -> ErrorEstimate {
        self.accuracy()
    }

    fn path_error(&self) -> f64 {
        self.path_error()
    }

    fn in_depth(&self) -> Option<&Contact> {
        Some(self)
    }
}

impl Solver for Springs {
    const KIND: SolverKind = SolverKind::Springs;

    fn summary(&self) -> ContactSummary {
        self.initial_summary()
    }

    fn apply(&mut self, step: &Move, _tolerance: f64, _go_on: &dyn Fn() -> bool) -> Result<(), Error> {
        self.apply(step)
    }

    fn state(&self) -> State {
        self.state()
    }

    fn depth(&self) -> usize {
        0
    }

    fn pressures(&self, radii: &[f64]) -> Vec<f64> {
        radii.iter().map(|&radius| self.pressure(radius)).collect()
    }

    fn shears(&self, radii: &[f64]) -> Vec<f64> {
        radii.iter().map(|&radius| self.shear(radius)).collect()
    }

    fn slips(&self, radii: &[f64]) -> Vec<Option<f64>> {
        radii.iter().map(|&radius| self.slip(radius)).collect()
    }

    fn surface_displacements(&self, radii: &[f64]) -> Vec<f64> {
        radii.iter().map(|&radius| self.surface_displacement(radius)).collect()
    }

    fn exact(&self) -> &Contact {
        self.virgin()
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
        go_on().then(|| self.residual())
    }

    fn unit_shear(&self) -> f64 {
        // Their load does not change.
        self.initial_summary().unit_shear()
    }

    fn accuracy(&self) -> ErrorEstimate {
        self.accuracy()
    }

    fn path_error(&self) -> f64 {
        // No move of theirs is curved.
        0.0
    }

    fn in_depth(&self) -> Option<&Contact> {
        None
    }
}
