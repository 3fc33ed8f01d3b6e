//! How steep and how curved a profile is, for warnings alone.

use super::profile::{
    ConeProfile, ExactSphereProfile, PowerLawProfile, Profile, RoundedConeProfile, RoundedPunchProfile, SphereProfile,
    SumProfile, TabulatedProfile, TruncatedConeProfile, TruncatedSphereProfile,
};

impl Profile {
    /// The radius of curvature, m, where the shape is given by one: the smallest of a sum.
    #[must_use]
    pub fn curvature_radius(&self) -> Option<f64> {
        match self {
            Profile::Sphere(SphereProfile { radius })
            | Profile::ExactSphere(ExactSphereProfile { radius })
            | Profile::TruncatedSphere(TruncatedSphereProfile { radius, .. }) => Some(*radius),
            Profile::RoundedPunch(RoundedPunchProfile { edge_radius, .. }) => Some(*edge_radius),
            Profile::Sum(SumProfile { parts }) => parts.iter().filter_map(Profile::curvature_radius).reduce(f64::min),
            _ => None,
        }
    }

    /// dz/dr of the surface at a radius, m, of a checked profile: a pure number; of a table, that of its chord there.
    #[must_use]
    pub fn slope(&self, r: f64) -> f64 {
        match self {
            Profile::Sphere(SphereProfile { radius }) => r / radius,
            Profile::ExactSphere(ExactSphereProfile { radius }) => r / ((radius - r) * (radius + r)).max(0.0).sqrt(),
            Profile::Cone(ConeProfile { slope }) => *slope,
            Profile::PowerLaw(PowerLawProfile { exponent, coefficient }) => {
                exponent * coefficient * r.powf(exponent - 1.0)
            }
            Profile::FlatPunch(_) => 0.0,
            Profile::TruncatedCone(TruncatedConeProfile { slope, flat_radius }) => {
                if r > *flat_radius {
                    *slope
                } else {
                    0.0
                }
            }
            Profile::TruncatedSphere(TruncatedSphereProfile { radius, flat_radius }) => {
                if r > *flat_radius {
                    r / radius
                } else {
                    0.0
                }
            }
            Profile::RoundedPunch(RoundedPunchProfile { flat_radius, edge_radius }) => {
                (r - flat_radius).max(0.0) / edge_radius
            }
            Profile::RoundedCone(RoundedConeProfile { slope, tip_radius }) => slope * (r / tip_radius).min(1.0),
            Profile::Tabulated(TabulatedProfile { r: radii, z }) => {
                let index = radii.partition_point(|point| *point < r).clamp(1, radii.len() - 1);
                (z[index] - z[index - 1]) / (radii[index] - radii[index - 1])
            }
            Profile::Sum(SumProfile { parts }) => parts.iter().map(|part| part.slope(r)).sum(),
        }
    }
}
