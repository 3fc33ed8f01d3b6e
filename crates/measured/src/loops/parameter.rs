//! The quantities that a fit determines: their names, units, and which of them the loops of a profile can tell from
//! each other.

use stickslip_mechanics::{Contact, Profile};

use super::Error;

/// A quantity of the bench that a fit can determine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Parameter {
    /// Coulomb's coefficient of friction mu.
    Friction,
    /// The reduced shear modulus G*, Pa.
    GStar,
    /// The reduced modulus E*, Pa; of a sphere alone.
    EStar,
    /// The radius of a sphere, m.
    Radius,
    /// Compliance of the machine in series with the contact, m/N; at least zero.
    MachineCompliance,
    /// The displacement that is measured where the contact has none, m.
    DisplacementOffset,
    /// The force that is measured where the contact has none, N.
    ForceOffset,
    /// The velocity at which the measured displacement runs away from that of the machine, m/s.
    Drift,
    /// The time by which the measured force follows the measured displacement, s.
    Delay,
    /// The rate at which the gain of the force drifts, over the gain at time zero, 1/s.
    GainDrift,
    /// The shear strength tau_0 of the interface, Pa; at least zero.
    ShearStrength,
}

impl Parameter {
    /// All of them.
    pub const ALL: [Parameter; 11] = [
        Parameter::Friction,
        Parameter::GStar,
        Parameter::EStar,
        Parameter::Radius,
        Parameter::MachineCompliance,
        Parameter::DisplacementOffset,
        Parameter::ForceOffset,
        Parameter::Drift,
        Parameter::Delay,
        Parameter::GainDrift,
        Parameter::ShearStrength,
    ];

    /// Its name in requests and replies.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Parameter::Friction => "friction",
            Parameter::GStar => "g_star",
            Parameter::EStar => "e_star",
            Parameter::Radius => "radius",
            Parameter::MachineCompliance => "machine_compliance",
            Parameter::DisplacementOffset => "displacement_offset",
            Parameter::ForceOffset => "force_offset",
            Parameter::Drift => "drift",
            Parameter::Delay => "delay",
            Parameter::GainDrift => "gain_drift",
            Parameter::ShearStrength => "shear_strength",
        }
    }

    /// Whether only times determine it.
    #[must_use]
    pub fn needs_time(self) -> bool {
        matches!(self, Parameter::Drift | Parameter::Delay | Parameter::GainDrift)
    }

    /// Whether it is above zero, so that the search is for its logarithm.
    pub(super) fn positive(self) -> bool {
        self.power_of_stiffness() != 0
            || matches!(self, Parameter::Friction | Parameter::MachineCompliance | Parameter::ShearStrength)
    }

    /// Three times the power with which the initial stiffness of a sphere at a given load, 2 G* a, goes with it.
    pub(super) fn power_of_stiffness(self) -> i32 {
        match self {
            Parameter::GStar => 3,
            Parameter::Radius => 1,
            Parameter::EStar => -1,
            _ => 0,
        }
    }

    /// Its value in the definition of a contact; zero of what belongs to the bench.
    pub(super) fn of(self, contact: &Contact) -> f64 {
        match (self, contact.profile()) {
            (Parameter::Friction, _) => contact.friction(),
            (Parameter::ShearStrength, _) => contact.shear_strength(),
            (Parameter::GStar, _) => contact.elasticity().g_star(),
            (Parameter::EStar, _) => contact.elasticity().e_star(),
            (Parameter::Radius, Profile::Sphere(sphere)) => sphere.curvature_radius(),
            _ => 0.0,
        }
    }
}

/// What the loops of a profile say about its moduli and its size: at a given load they depend on the stiffness 2 G* a
/// alone.
pub(super) fn combination(profile: &Profile) -> &'static str {
    match profile {
        Profile::Sphere(_) => "g_star * (radius/e_star)^(1/3)",
        Profile::Cone(_) => "g_star / (slope * e_star)^(1/2)",
        Profile::PowerLaw(_) => "g_star / (coefficient * e_star)^(1/(exponent + 1))",
        Profile::FlatPunch(_) => "g_star * radius",
        _ => "g_star * contact_radius",
    }
}

/// Whether a profile has a parameter that loops can determine.
pub(super) fn is_of(parameter: Parameter, profile: &Profile) -> bool {
    match parameter {
        Parameter::EStar | Parameter::Radius => matches!(profile, Profile::Sphere(_)),
        Parameter::GStar => !matches!(profile, Profile::Ellipsoid(_) | Profile::Line(_)),
        Parameter::ShearStrength => profile.has_stress_field() && !matches!(profile, Profile::Line(_)),
        _ => true,
    }
}

/// Checks that free parameters belong to the contact, and that no two of them have the same effect.
///
/// # Errors
/// [`Error::NotOfProfile`] and [`Error::Inseparable`].
pub(super) fn check(
    free: &[Parameter],
    with_prior: impl Fn(Parameter) -> bool,
    profile: &Profile,
) -> Result<(), Error> {
    if let Some(&parameter) = free.iter().find(|&&parameter| !is_of(parameter, profile)) {
        return Err(Error::NotOfProfile { parameter });
    }
    let mut unknown = free.iter().filter(|&&one| one.power_of_stiffness() != 0 && !with_prior(one));
    match (unknown.next(), unknown.next()) {
        (Some(&with), Some(&parameter)) => {
            Err(Error::Inseparable { parameter, with, combination: combination(profile).to_owned() })
        }
        _ => Ok(()),
    }
}
