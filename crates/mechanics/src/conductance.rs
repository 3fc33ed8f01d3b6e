//! The conductance of a contact, which is in proportion to its normal stiffness.
//!
//! The potential of a current between two half-spaces obeys the equations of the normal displacement, so that the
//! conductance of the constriction follows from the load curve alone (Holm 1967; Barber 2003):
//! C = 2 F_N'(d)/(E* (rho_1 + rho_2)) = 4 X(d)/(rho_1 + rho_2), with X = F_N'/(2 E*) the contact radius where the
//! contact is round. Heat flows in the same way, with 1/k in place of rho. Films, and spots that are not large against
//! the mean free path of the carriers, resist besides.

use crate::range;
use crate::range::error::Error;

/// How a body conducts, as far as that is known.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Conduction {
    resistivity: Option<f64>,
    conductivity: Option<f64>,
}

/// The conductances of a contact; none where a body does not say how it conducts.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Conductance {
    /// Electrical conductance, S.
    pub electrical: Option<f64>,
    /// Thermal conductance, W/K.
    pub thermal: Option<f64>,
}

impl Conduction {
    /// Electrical resistivity, ohm m, and thermal conductivity, W/(m K).
    ///
    /// # Errors
    /// [`Error::OutOfRange`] by [`range::RESISTIVITY`] and [`range::CONDUCTIVITY`].
    pub fn new(resistivity: Option<f64>, conductivity: Option<f64>) -> Result<Conduction, Error> {
        Ok(Conduction {
            resistivity: resistivity.map(|value| range::RESISTIVITY.check(value)).transpose()?,
            conductivity: conductivity.map(|value| range::CONDUCTIVITY.check(value)).transpose()?,
        })
    }
}

impl Conductance {
    /// Of a spot of radius 1 m between two bodies.
    pub(crate) fn of_unit_radius([first, second]: [Conduction; 2]) -> Conductance {
        let series = |one: Option<f64>, other: Option<f64>| Some(4.0 / (one? + other?));
        let resistance = |body: Conduction| body.conductivity.map(f64::recip);
        Conductance {
            electrical: series(first.resistivity, second.resistivity),
            thermal: series(resistance(first), resistance(second)),
        }
    }

    pub(crate) fn times(self, radius: f64) -> Conductance {
        let of = |unit: Option<f64>| unit.map(|unit| unit * radius);
        Conductance { electrical: of(self.electrical), thermal: of(self.thermal) }
    }
}
