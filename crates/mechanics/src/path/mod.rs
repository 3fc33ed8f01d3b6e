//! How a contact moves: straight moves in one step, moves that are straight in a force by chords, and the displacement
//! that a force belongs to.

mod curve_panel;
pub(crate) mod curved_move;
pub(crate) mod curved_path;
mod force_control;
mod moves;
