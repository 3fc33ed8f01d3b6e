//! The quantities that the mechanics can find out of range, each with its public name and, where it accepts numbers of
//! it, the range of these, for checks and documents alike.

use std::fmt;

/// A quantity's name, unit and closed interval, bounds included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// The measured quantity.
    pub quantity: Quantity,
    /// SI unit, empty for a pure number.
    pub unit: &'static str,
    /// The smallest value accepted.
    pub min: f64,
    /// The largest value accepted.
    pub max: f64,
}

/// Declares [`Quantity`] and the [`Range`]s from one table: variant, public name, constant with its range and unit,
/// description.
macro_rules! quantities {
    ($(
        $variant:ident = $name:literal $(, $RANGE:ident: $min:literal to $max:literal $unit:literal)?, $doc:literal;
    )*) => {
        /// The quantity that a number measures.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Quantity {
            $(#[doc = $doc] $variant,)*
            /// A parameter of a family of profiles, by its name.
            Parameter(&'static str),
        }

        $($(
            #[doc = $doc]
            pub const $RANGE: Range = Range { quantity: Quantity::$variant, unit: $unit, min: $min, max: $max };
        )?)*

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
                    Quantity::Parameter(name) => name,
                }
            }
        }
    };
}

quantities! {
    Radius = "radius", RADIUS: 1e-15 to 1e9 "m", "Any radius of a body or a contact.";
    Length = "length", LENGTH: 1e-15 to 1e9 "m", "A length of a shape: a radius of curvature, of a flat, of a tip.";
    Slope = "slope", SLOPE: 1e-9 to 1e9 "", "Slope dz/dr of a cone.";
    Exponent = "exponent", EXPONENT: 0.1 to 1000.0 "", "Exponent of a power law.";
    Coefficient = "coefficient", COEFFICIENT: 1e-280 to 1e280 "m^(1-n)",
        "Coefficient of a power law; its unit, m^(1 - n), depends on the exponent.";
    TablePoints = "points of the table", TABLE_POINTS: 3.0 to 10_000.0 "",
        "How many points a tabulated profile may have.";
    TableRadius = "r", TABLE_RADIUS: 0.0 to 1e9 "m", "A radius in a table.";
    TableHeight = "z", TABLE_HEIGHT: -1e9 to 1e9 "m", "A height in a table.";
    IndentationError = "indentation_error", INDENTATION_ERROR: 0.0 to 1e9 "m",
        "The standard error of an indentation of a table.";
    PressureError = "pressure_error", PRESSURE_ERROR: 0.0 to 1e9 "",
        "The standard error of a pressure of a table, over E*.";
    Asperities = "number of asperities", ASPERITIES: 1.0 to 1e6 "", "How many asperities a set may have.";
    Gap = "gap", GAP: -1e9 to 1e9 "m", "The gap of an asperity above any plane.";
    CurvePoints = "points of the load curve", CURVE_POINTS: 3.0 to 100_000.0 "",
        "How many points a load curve may have.";
    RadiusRatio = "ratio of the radii", RADIUS_RATIO: 1.0 to 1e6 "",
        "The larger of the two radii of curvature of an ellipsoid over the smaller.";
    Parts = "number of parts", PARTS: 1.0 to 16.0 "",
        "How many profiles a sum may have, sums within it counted by their parts.";
    YoungsModulus = "youngs_modulus", YOUNGS_MODULUS: 1e-3 to 1e18 "Pa", "Young's modulus of a body.";
    PoissonRatio = "poisson_ratio", POISSON_RATIO: -0.99 to 0.5 "",
        "Poisson's ratio of a body; auxetic bodies are allowed.";
    Resistivity = "resistivity", RESISTIVITY: 1e-12 to 1e20 "Ω·m", "Electrical resistivity of a body.";
    Conductivity = "conductivity", CONDUCTIVITY: 1e-6 to 1e6 "W/(m·K)", "Thermal conductivity of a body.";
    EStar = "e_star", E_STAR: 1e-3 to 1e18 "Pa", "The reduced modulus E*.";
    GStar = "g_star", G_STAR: 1e-3 to 1e18 "Pa", "The reduced shear modulus G*.";
    ShearModulus = "shear_modulus", SHEAR_MODULUS: 1e-3 to 1e18 "Pa",
        "The shear modulus of two bodies in series, 1/G = 1/G₁ + 1/G₂.";
    Friction = "friction", FRICTION: 0.0 to 100.0 "",
        "Coulomb's coefficient of friction; zero means no tangential force at all.";
    ShearStrength = "shear_strength", SHEAR_STRENGTH: 0.0 to 1e18 "Pa",
        "The shear strength of an interface, in addition to friction times pressure.";
    Adhesion = "adhesion", ADHESION: 1e-12 to 1e3 "J/m²", "The work of adhesion of an interface.";
    NormalForce = "normal_force", NORMAL_FORCE: 0.0 to 1e18 "N", "A normal force that presses the bodies together.";
    ContactRadius = "contact_radius", CONTACT_RADIUS: 0.0 to 1e9 "m",
        "The contact radius, prescribed or as it follows from a load; zero is a contact just touching.";
    Indentation = "indentation", INDENTATION: -1e9 to 1e9 "m",
        "The indentation that a move may ask for; below zero the bodies are apart.";
    Displacement = "displacement", DISPLACEMENT: -1e9 to 1e9 "m", "The tangential displacement of the indenter.";
    Force = "force", FORCE: -1e20 to 1e20 "N", "A tangential force.";
    Twist = "twist", TWIST: -1e6 to 1e6 "rad", "An angle of twist.";
    Torque = "torque", TORQUE: -1e20 to 1e20 "N·m", "A torque.";
    Place = "place", PLACE: -1e9 to 1e9 "m", "A coordinate of a place below the surface.";
    BulkStress = "bulk stress", BULK_STRESS: -1e20 to 1e20 "Pa", "A component of a uniform stress.";
    StressPerForce = "stress_per_force", STRESS_PER_FORCE: -1e30 to 1e30 "Pa/N",
        "A stress of a body along x over the tangential force that it comes with.";
    MachineStiffness = "stiffness", MACHINE_STIFFNESS: 1e-9 to 1e30 "N/m",
        "The stiffness of a machine in series with the contact.";
    Phase = "phase", PHASE: -1e9 to 1e9 "rad",
        "Phase of the normal load of a cycle, or between the axes of an ellipse.";
    FatigueWeight = "weight", FATIGUE_WEIGHT: 0.0 to 100.0 "",
        "The weight of a normal or hydrostatic stress in a fatigue criterion.";
    YieldStress = "yield_stress", YIELD_STRESS: 1e-3 to 1e18 "Pa", "The yield stress of a fatigue criterion.";
    LifeReference = "reference", LIFE_REFERENCE: 1e-300 to 1e30 "",
        "The value of a criterion, in its unit, at a point of an S-N curve.";
    LifeCycles = "cycles", LIFE_CYCLES: 1.0 to 1e12 "", "The cycles at a point of an S-N curve.";
    LifeExponent = "exponent", LIFE_EXPONENT: 0.1 to 1000.0 "", "The exponent k of an S-N curve, N ~ value^(-k).";
    FatigueStrength = "strength", FATIGUE_STRENGTH: 1e-3 to 1e18 "Pa", "A fatigue strength coefficient.";
    FatigueDuctility = "ductility", FATIGUE_DUCTILITY: 0.0 to 1e3 "",
        "A fatigue ductility coefficient; zero for a curve without plastic strain.";
    FatigueExponent = "fatigue exponent", FATIGUE_EXPONENT: -10.0 to -1e-3 "",
        "The exponent of a fatigue strength or ductility; lives end, so it is negative.";
    CriticalLength = "length", CRITICAL_LENGTH: 1e-9 to 1.0 "m", "A critical distance of a material.";
    SpringCount = "count", SPRING_COUNT: 2.0 to 1e6 "", "How many springs the foundation may have.";
    RingTolerance = "tolerance", RING_TOLERANCE: 1e-300 to 1e300 "",
        "What the error of a path by rings is to stay below, over mu F_N.";
    PronyTerms = "number of terms", PRONY_TERMS: 1.0 to 16.0 "", "How many terms a Prony series may have.";
    PronyRatio = "ratio", PRONY_RATIO: 1e-9 to 1.0 "",
        "By how much of the instantaneous modulus a term of a Prony series relaxes.";
    PronyTime = "time", PRONY_TIME: 1e-12 to 1e15 "s", "The relaxation time of a term of a Prony series.";
    Duration = "duration", DURATION: 0.0 to 1e15 "s", "How long a move takes.";
    Turns = "turns", TURNS: -1e9 to 1e9 "", "A place on an ellipse, in turns from its beginning.";
    Sliders = "count", "How many sliders stand for a contact.";
    SliderError = "error", "The error of a set of sliders, of the force or of the work of a cycle.";
    RollingRatio = "ratio", "The tangential force of rolling over mu F_N.";
    RollingCreep = "creep", "The creep of rolling.";
    RingCount = "count", RING_COUNT: 4.0 to 160.0 "", "How many rings a contact may have that is moved in the plane.";
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
