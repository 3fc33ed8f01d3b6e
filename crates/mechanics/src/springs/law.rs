//! What springs obey: their stiffness, how far each may be bent, and how its body relaxes.

use super::row::Row;
use super::twist::TwistLaw;
use crate::indenter::Indenter;
use crate::viscoelastic::prony::{ELASTIC, Prony};

/// Friction by Coulomb's law between bodies with a memory: a spring carries at most mu times the pressure of its place.
#[derive(Clone, Copy)]
pub(crate) struct CoulombLaw<'a> {
    pub(crate) indenter: &'a Indenter,
    pub(crate) prony: &'a Prony,
    /// 2 E* and 2 G*, Pa.
    pub(crate) stiffness: [f64; 2],
    pub(crate) friction: f64,
}

/// A limit law. In units of its stiffness, a spring has a room, m or rad, which times a scale is its bound.
#[derive(Clone, Copy)]
pub(crate) enum SpringLaw<'a> {
    /// The room is the deflection w - s_z under the pressure.
    Coulomb(CoulombLaw<'a>),
    /// The room is the bound.
    Twist(TwistLaw<'a>),
}

impl SpringLaw<'_> {
    pub(super) fn indenter(&self) -> &Indenter {
        match self {
            SpringLaw::Coulomb(law) => law.indenter,
            SpringLaw::Twist(law) => law.indenter,
        }
    }

    /// The memory of the bodies, without terms if they are elastic.
    pub(super) fn prony(&self) -> &Prony {
        match self {
            SpringLaw::Coulomb(law) => law.prony,
            SpringLaw::Twist(_) => &ELASTIC,
        }
    }

    /// A bound over its room.
    pub(crate) fn scale(&self) -> f64 {
        match self {
            SpringLaw::Coulomb(law) => law.friction * law.stiffness[0] / law.stiffness[1],
            SpringLaw::Twist(_) => 1.0,
        }
    }

    /// The normal stiffness of a spring over its other one.
    pub(super) fn normal_unit(&self) -> f64 {
        match self {
            SpringLaw::Coulomb(law) => law.stiffness[0] / law.stiffness[1],
            SpringLaw::Twist(_) => 0.0,
        }
    }

    /// The stiffness of a spring, N/m or N m, in the middle of a cell: 2 G* dx, or 16 G x^2 dx.
    pub(super) fn weight(&self, width: f64, index: usize) -> f64 {
        match self {
            SpringLaw::Coulomb(law) => law.stiffness[1] * width,
            SpringLaw::Twist(law) => {
                let [inner, outer] = [index, index + 1].map(|end| end as f64 * width);
                16.0 * law.shear_modulus * width * (outer * outer + outer * inner + inner * inner) / 3.0
            }
        }
    }

    /// The normal and the other stiffness of a contact of this radius, m, which does not slip.
    pub(crate) fn stiffness(&self, radius: f64) -> [f64; 2] {
        match self {
            SpringLaw::Coulomb(law) => law.stiffness.map(|stiffness| stiffness * radius),
            SpringLaw::Twist(law) => [0.0, 16.0 / 3.0 * law.shear_modulus * radius * radius * radius],
        }
    }

    /// The rooms of springs at their indentation.
    pub(super) fn rooms(&self, row: &Row) -> Vec<f64> {
        match self {
            SpringLaw::Coulomb(law) => row.rooms_by_memory(law.prony),
            SpringLaw::Twist(law) => {
                let mut bounds = vec![0.0; row.len()];
                law.change_bounds(&row.levels, row.width, &mut bounds, [0.0, row.indentation]);
                bounds
            }
        }
    }
}
