//! What is particular to measured profiles: how far their points leave g open, and the noise of their heights.

use super::{Doubt, Profile};

impl Profile {
    /// What the interpolation of tables leaves open in a contact of this radius, m; nought for everything else.
    #[must_use]
    pub fn doubt(&self, radius: f64) -> Doubt {
        match self {
            Profile::Tabulated(table) => table.doubt(radius),
            Profile::Sum(sum) => {
                sum.parts().iter().map(|part| part.doubt(radius)).fold(Doubt::default(), |all, part| all.and(part))
            }
            _ => Doubt::default(),
        }
    }

    /// An estimate of the noise of g, m, that a table's heights bring to a contact of this radius, m, and how many times their
    /// own noise that is. `None` for what is no table.
    #[must_use]
    pub fn noise(&self, radius: f64) -> Option<(f64, f64)> {
        match self {
            Profile::Tabulated(table) => {
                let amplification = table.noise_amplification(radius);
                Some((table.noise() * amplification, amplification))
            }
            Profile::Sum(sum) => {
                let noises = sum.parts().iter().filter_map(|part| part.noise(radius));
                noises.reduce(|one, other| if one.0 > other.0 { one } else { other })
            }
            _ => None,
        }
    }
}
