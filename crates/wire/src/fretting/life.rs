//! Curves from the value of a criterion to a number of cycles.

use stickslip_mechanics::fatigue::{self, LifeCurve};

use crate::prelude::*;

choices! {
/// The life of a criterion with strains: an S-N curve, or the strain-life curve of the criterion.
pub enum StrainLife: Copy {
    /// Cycles = `cycles` · (value/`reference`)^(−`exponent`) (Basquin 1910).
    "s_n" => SN(SnCurve),
    /// For `swt`: value = (σf'²/E) (2N)^(2b) + σf' εf' (2N)^(b + c); for `fatemi_socie`: value = (τf'/G) (2N)^b + γf'
    /// (2N)^c.
    "strain_life" => StrainLife(StrainLifeCurve),
}
}

requests! {
/// The life of a criterion: an S-N curve.
pub struct StressLife: Copy {
    /// Cycles = `cycles` · (value/`reference`)^(−`exponent`) (Basquin 1910).
    pub s_n: SnCurve,
}

/// An S-N curve of the values of a criterion.
pub struct SnCurve: Copy {
    /// A value, in the unit of the criterion.
    pub reference: f64 = range::LIFE_REFERENCE,
    /// Number of cycles that the material withstands at `reference`, a pure number.
    pub cycles: f64 = range::LIFE_CYCLES,
    /// The exponent k, a pure number: the number of cycles falls as value^(−k).
    pub exponent: f64 = range::LIFE_EXPONENT,
}

/// The constants of Basquin, Coffin and Manson: of normal stress and strain for `swt`, of shear stress and shear strain
/// for `fatemi_socie`.
pub struct StrainLifeCurve: Copy {
    /// Fatigue strength coefficient, Pa: σf' or, of shear stress, τf'.
    pub strength: f64 = range::FATIGUE_STRENGTH,
    /// Fatigue strength exponent b, a pure number.
    pub strength_exponent: f64 = range::FATIGUE_EXPONENT,
    /// Fatigue ductility coefficient, a pure number: εf' or, of shear strain, γf'.
    pub ductility: f64 = range::FATIGUE_DUCTILITY,
    /// Fatigue ductility exponent c, a pure number.
    pub ductility_exponent: f64 = range::FATIGUE_EXPONENT,
}
}

impl StressLife {
    /// The curve, unless its members are out of their limits.
    pub(super) fn curve(self) -> Option<LifeCurve> {
        self.s_n.checked()
    }
}

impl StrainLife {
    /// The same, where `of_strain` makes the curve of the criterion.
    pub(super) fn curve(
        self,
        of_strain: impl Fn(&fatigue::StrainLife) -> Result<LifeCurve, Error>,
    ) -> Option<LifeCurve> {
        match self {
            StrainLife::SN(curve) => curve.checked(),
            StrainLife::StrainLife(StrainLifeCurve { strength, strength_exponent, ductility, ductility_exponent }) => {
                of_strain(&fatigue::StrainLife { strength, strength_exponent, ductility, ductility_exponent }).ok()
            }
        }
    }
}

impl SnCurve {
    fn checked(self) -> Option<LifeCurve> {
        LifeCurve::of_stress(self.reference, self.cycles, self.exponent).ok()
    }
}
