//! Paths that are curves in displacement and indentation: one straight in two quantities, of which one is a force, is
//! followed as a [`CurvedMove`].

use crate::contact::Contact;
use crate::numerics::double_double::DoubleDouble;
use crate::profile::Ring;

/// A curve over a parameter from 0 to 1, on which the indentation rises or falls all the way.
pub(crate) trait CurvedPath {
    /// Normal force, N, at a part of the path.
    fn normal_force(&self, contact: &Contact, part: f64) -> f64;

    /// The point at a part of the path that a contact reaches from its present state.
    fn point(&self, contact: &Contact, part: f64) -> PathPoint;

    /// Change of the indentation with the part, m; `None` on a path straight in two quantities.
    fn rate(&self, _part: f64) -> Option<f64> {
        None
    }

    /// int (w - w0) dx, m^2, and its error, of a newly touched ring that does not slip while the scaled displacement
    /// advances by `advance`, m, on a path straight in two quantities; `None` where it is straight in W and d too.
    fn gain(&self, _contact: &Contact, _ring: &Ring, _advance: f64) -> Option<(f64, f64)> {
        None
    }
}

/// How the tangential target is reached: straight from one value to the other.
#[derive(Clone, Copy, Debug)]
pub(crate) enum TangentialPath {
    Displacement { from: DoubleDouble, to: DoubleDouble },
    Force { from: f64, to: f64 },
}

/// How the normal target is reached.
#[derive(Clone, Copy, Debug)]
pub(crate) enum NormalPath {
    Indentation { from: DoubleDouble, to: DoubleDouble },
    Force { from: f64, to: f64 },
}

/// A path straight in two quantities, over a parameter from 0 to 1.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CurvedMove {
    pub(crate) tangential: TangentialPath,
    pub(crate) normal: NormalPath,
}

/// A point of the curve.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PathPoint {
    /// d, m.
    pub(crate) indentation: DoubleDouble,
    /// F_N, N, that belongs to it.
    pub(crate) normal_force: f64,
    /// U, m.
    pub(crate) displacement: DoubleDouble,
}

impl CurvedMove {
    /// Whether one straight move leads to the end: in displacement and indentation, or as the load stays as it is.
    pub(super) fn is_straight(&self) -> bool {
        match self.normal {
            NormalPath::Indentation { from, to } => {
                from == to || matches!(self.tangential, TangentialPath::Displacement { .. })
            }
            NormalPath::Force { .. } => false,
        }
    }
}

impl Contact {
    /// Where the contact is.
    pub(crate) fn path_point(&self) -> PathPoint {
        let indentation = self.history.edge().level;
        PathPoint { indentation, normal_force: self.normal_force, displacement: self.displacement }
    }
}
