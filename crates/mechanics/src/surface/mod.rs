//! What the surface carries, how far it moves and slips: the stresses, displacements and extrema of a contact.
//!
//! A line contact answers by its face, the round contact that has the same stresses over r as it has over x.

mod extrema;
pub(crate) mod line_surface;
pub(crate) mod shear_stress;
mod surface_displacement;
