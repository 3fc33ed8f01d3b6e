//! Elastic constants of known materials, which the page, the Python package and `GET /materials` share.

use crate::prelude::*;

/// The table as JSON text.
pub const MATERIALS: &str = include_str!("materials.json");

replies! {
/// A material with typical elastic constants.
pub struct KnownMaterial {
    /// Its name, with others in brackets.
    pub name: String,
    /// Young's modulus E, Pa.
    pub youngs_modulus: f64,
    /// Poisson's ratio ν, a pure number.
    pub poisson_ratio: f64,
    /// Where the values are from.
    pub source: String,
    /// What such materials have: composition, treatment and direction change the constants.
    pub range: ElasticRange,
}

/// The smallest and the largest elastic constants of a kind of material.
pub struct ElasticRange {
    /// Young's modulus E, Pa.
    pub youngs_modulus: [f64; 2],
    /// Poisson's ratio ν, a pure number.
    pub poisson_ratio: [f64; 2],
}
}

#[cfg(test)]
mod tests {
    use super::*;
    use stickslip_mechanics::Body;

    #[test]
    fn every_material_is_within_its_range_and_makes_a_contact() {
        let known: Vec<KnownMaterial> = serde_json::from_str(MATERIALS).unwrap();
        assert!(known.len() > 20);
        for KnownMaterial { name, youngs_modulus, poisson_ratio, source, range } in known {
            let within = |value: f64, [low, high]: [f64; 2]| low <= value && value <= high;
            assert!(
                within(youngs_modulus, range.youngs_modulus) && within(poisson_ratio, range.poisson_ratio),
                "{name}"
            );
            assert!(!source.is_empty(), "{name}");
            for ratio in range.poisson_ratio {
                assert!(Body::new(youngs_modulus, ratio).is_ok(), "{name}");
            }
        }
    }
}
