//! The table of the families, from which the enum, its dispatch and the JSON documents follow.

/// The table of the families whose parameters are plain numbers: calls the macro `$callback` with all entries.
///
/// An entry is a description, `module::Family`, the description and the name of its JSON document, and the parameters
/// in the order of the constructor: a description with the unit, the name and the constant of [`range`](crate::range)
/// that bounds it. The `type` in JSON is the name of the family in snake case. The families made of other things, such
/// as [`Tabulated`](crate::profile::Tabulated) and [`Sum`](crate::profile::Sum), are not in the table.
#[macro_export]
macro_rules! for_each_family {
    ($callback:ident) => {
        $callback! {
            /// Hertz's parabola z = r²/(2R), the shape that is meant by a sphere in contact mechanics.
            sphere::Sphere,
            /// A sphere in Hertz's approximation.
            SphereProfile {
                /// Radius of curvature R of the gap, m; for two spheres 1/R = 1/R₁ + 1/R₂.
                radius: RADIUS,
            }
            /// The sphere itself, z = R − √(R² − r²).
            exact_sphere::ExactSphere,
            /// A sphere without approximation.
            ExactSphereProfile {
                /// Radius R, m; the contact radius stays below it.
                radius: RADIUS,
            }
            /// A cone, z = slope · r. Pressure and shear stress are infinite at its tip.
            cone::Cone,
            /// A cone.
            ConeProfile {
                /// Slope dz/dr, a pure number.
                slope: SLOPE,
            }
            /// A power of the radius, z = coefficient · r^exponent.
            power_law::PowerLaw,
            /// A power law.
            PowerLawProfile {
                /// Exponent n, a pure number.
                exponent: EXPONENT,
                /// Coefficient, m^(1−n).
                coefficient: COEFFICIENT,
            }
            /// A cylinder with a sharp edge, where pressure and shear stress are infinite.
            flat_punch::FlatPunch,
            /// A flat punch.
            FlatPunchProfile {
                /// Radius of the punch, m.
                radius: RADIUS,
            }
            /// A cone with a flat end. Pressure and shear stress are infinite at the rim of the flat.
            truncated_cone::TruncatedCone,
            /// A truncated cone.
            TruncatedConeProfile {
                /// Slope dz/dr outside the flat, a pure number.
                slope: SLOPE,
                /// Radius of the flat end, m.
                flat_radius: FLAT_RADIUS,
            }
            /// A worn sphere: a parabola with a flat end, at whose rim pressure and shear stress are infinite.
            truncated_sphere::TruncatedSphere,
            /// A truncated sphere.
            TruncatedSphereProfile {
                /// Radius of curvature R, m.
                radius: RADIUS,
                /// Radius of the flat end, m.
                flat_radius: FLAT_RADIUS,
            }
            /// A flat end with a rounded edge, z = (r − flat_radius)²/(2 · edge_radius) outside the flat.
            rounded_punch::RoundedPunch,
            /// A flat punch with a rounded edge.
            RoundedPunchProfile {
                /// Radius of the flat end, m.
                flat_radius: FLAT_RADIUS,
                /// Radius of curvature of the edge, m.
                edge_radius: EDGE_RADIUS,
            }
            /// A cone whose tip is a parabola up to `tip_radius`.
            rounded_cone::RoundedCone,
            /// A cone with a rounded tip.
            RoundedConeProfile {
                /// Slope dz/dr of the cone, a pure number.
                slope: SLOPE,
                /// Radius up to which the tip is a parabola, m.
                tip_radius: TIP_RADIUS,
            }
        }
    };
}
