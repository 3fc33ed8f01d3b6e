//! A path straight in two quantities, of which a force makes it a curve in displacement and indentation.

use crate::contact::Contact;
use crate::numerics::double_double::DoubleDouble;

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
    /// Whether the load stays as it is, so that one straight move leads to the end.
    pub(super) fn has_constant_load(&self) -> bool {
        matches!(self.normal, NormalPath::Indentation { from, to } if from == to)
    }
}

impl Contact {
    /// Where the contact is.
    pub(crate) fn path_point(&self) -> PathPoint {
        let indentation = self.history.edge().level;
        PathPoint { indentation, normal_force: self.normal_force, displacement: self.displacement }
    }
}
