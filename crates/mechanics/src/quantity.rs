//! The quantities that the mechanics can find out of range, each with its public name.

use std::fmt;

/// Declares [`Quantity`] from one table: variant, public name, description.
macro_rules! quantities {
    ($($variant:ident = $name:literal, $doc:literal;)*) => {
        /// What a number measures.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Quantity {
            $(#[doc = $doc] $variant,)*
        }

        impl Quantity {
            /// The name of the quantity in messages.
            ///
            /// ```
            /// use stickslip_mechanics::range::{self, Quantity};
            ///
            /// assert_eq!(range::FRICTION.quantity, Quantity::Friction);
            /// assert_eq!(Quantity::Friction.name(), "friction");
            /// ```
            #[must_use]
            pub fn name(self) -> &'static str {
                match self {
                    $(Quantity::$variant => $name,)*
                }
            }
        }
    };
}

quantities! {
    Radius = "radius", "Radius of a body.";
    FlatRadius = "flat_radius", "Radius of a flat end.";
    EdgeRadius = "edge_radius", "Curvature radius of a rounded edge.";
    TipRadius = "tip_radius", "Radius up to which the tip of a cone is rounded.";
    Slope = "slope", "Slope dz/dr of a cone.";
    Exponent = "exponent", "Exponent of a power law.";
    Coefficient = "coefficient", "Coefficient of a power law.";
    TablePoints = "points of the table", "Number of points of a tabulated profile.";
    TableRadius = "r", "Radius in a table.";
    TableHeight = "z", "Height in a table.";
    IndentationError = "indentation_error", "Standard error of an indentation of a table.";
    PressureError = "pressure_error", "Standard error of a pressure of a table, over E*.";
    Asperities = "number of asperities", "Number of asperities in a set.";
    Gap = "gap", "Gap of an asperity.";
    CurvePoints = "points of the load curve", "Number of points of a load curve.";
    RadiusRatio = "ratio of the radii", "Ratio of the radii of curvature of an ellipsoid.";
    Parts = "number of parts", "Number of profiles in a sum.";
    YoungsModulus = "youngs_modulus", "Young's modulus of a body.";
    PoissonRatio = "poisson_ratio", "Poisson's ratio of a body.";
    EStar = "e_star", "Reduced modulus E*.";
    GStar = "g_star", "Reduced shear modulus G*.";
    Friction = "friction", "Coulomb's coefficient of friction.";
    NormalForce = "normal_force", "Normal force.";
    ContactRadius = "contact_radius", "Contact radius.";
    Indentation = "indentation", "Indentation.";
    Displacement = "displacement", "Tangential displacement of the indenter.";
    Force = "force", "Tangential force.";
    Place = "place", "Coordinate of a place below the surface.";
    BulkStress = "bulk stress", "Component of a uniform stress.";
    MachineStiffness = "stiffness", "Stiffness of a machine in series with the contact.";
    Phase = "phase", "Phase of the normal load of a cycle.";
    FatigueWeight = "weight", "Weight of a normal or hydrostatic stress in a fatigue criterion.";
    YieldStress = "yield_stress", "Yield stress.";
    SpringCount = "count", "Number of springs of the foundation.";
    CutoffRadius = "cutoff_radius", "Radius from which on the peaks of a protocol are equal.";
    ProtocolTarget = "target", "Shear stress that a protocol may leave, relative to mu times the pressure.";
    AmplitudeError = "amplitude_error", "Relative error of the displacements of a protocol.";
    FrictionError = "friction_error", "Relative error of the coefficient of friction.";
    Number = "number", "A number whose quantity is not known yet.";
}

impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
