//! Paths for line contacts: those of the round contact that has the same stresses over the half-width, in which the
//! tangential force stands for the displacement.
//!
//! The slip history of a line contact over G = P/E* is that of its face over g; what moves it is Q/(mu E*) in place of
//! W. So a path of displacements of the face is a path of forces F_x = E* L U, and an end without displacement is one
//! without force; a path that is to end at the displacement zero is one of these but for its last move.

use std::borrow::Cow;

use super::{AmplitudeLaw, Design, EvaluationRange, FirstMove, PathEnd, PathStart, design};
use crate::contact::Contact;
use crate::contact::state::{Move, Regime, Tangential};
use crate::profile::LineContact;
use crate::range::error::Error;

impl Contact {
    /// The face at the present load, as if it had never been moved.
    pub(super) fn virgin_face(&self) -> Contact {
        self.face().map_or_else(|| self.clone(), Cow::into_owned).without_history()
    }

    /// The displacements, m, that lead this contact through the forces of a path of its face from gross slip on, and
    /// the contact after them.
    pub(super) fn by_forces(&self, line: &LineContact, path: &[f64]) -> Result<(Vec<f64>, Contact), Error> {
        if line.bulk().is_some() {
            return Err(Error::LineContact("a path for a stick zone that a bulk stress moves"));
        }
        let mut contact = self.clone();
        let limit = contact.summary().gross_slip_force;
        let mut displacements = Vec::with_capacity(path.len());
        for target in path {
            let force = self.elasticity.e_star() * line.length() * target;
            // A force by rounding below the limit would leave a core of nothing stuck.
            let to = if force.abs() < limit * (1.0 - 1e-12) {
                Tangential::Force(force)
            } else {
                Tangential::Displacement(self.gross_slip_displacement().copysign(force))
            };
            contact.apply(&Move { tangential: Some(to), ..Move::default() })?;
            displacements.push(contact.displacement());
        }
        Ok((displacements, contact))
    }

    /// The displacement, m, of the face that stands for a displacement, m, of the virgin line contact.
    fn face_displacement(&self, line: &LineContact, displacement: f64) -> Result<f64, Error> {
        let mut contact = self.without_history();
        contact.apply(&Move { tangential: Some(Tangential::Displacement(displacement)), ..Move::default() })?;
        if contact.state().regime == Regime::GrossSlip {
            return Ok(self.virgin_face().gross_slip_displacement().copysign(displacement));
        }
        Ok(contact.force() / (self.elasticity.e_star() * line.length()))
    }
}

/// [`design`] for a line contact. It begins with gross slip unless a displacement is given.
pub(super) fn design_line(
    contact: &Contact,
    line: &LineContact,
    (start, kind, reversals): (PathStart, AmplitudeLaw, usize),
    end: PathEnd,
    keep_going: &dyn Fn() -> bool,
) -> Result<Design, Error> {
    let face_end = match end {
        PathEnd::Free => PathEnd::Free,
        PathEnd::ForceZero | PathEnd::DisplacementZero => PathEnd::DisplacementZero,
    };
    let face = contact.virgin_face();
    let first = match start {
        PathStart::Here => face.gross_slip_displacement(),
        PathStart::Displacement(first) => contact.face_displacement(line, first)?,
    };
    let found = design(&face, PathStart::Displacement(first), kind, reversals, face_end, keep_going)?;
    let (mut displacements, mut contact) = contact.by_forces(line, &found.displacements)?;
    if end == PathEnd::DisplacementZero {
        // The best path without a force at its end, whose last move goes on to the displacement zero.
        let to = Some(Tangential::Displacement(0.0));
        contact.apply(&Move { tangential: to, ..Move::default() })?;
        displacements.pop();
        displacements.push(0.0);
    }
    let first_move = if matches!(start, PathStart::Here) { FirstMove::GrossSlip } else { found.first_move };
    let residual = contact.residual_while(keep_going).ok_or(Error::Interrupted)?;
    let largest = EvaluationRange::of(&contact).largest(&contact, &residual);
    Ok(Design { displacements, first_move, contact, residual, largest, ..found })
}
