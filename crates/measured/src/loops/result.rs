//! What a fit of loops yields.

use super::Parameter;

/// A parameter with its uncertainty.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// Which.
    pub parameter: Parameter,
    /// Its value, in the SI unit of the parameter.
    pub value: f64,
    /// Standard error; `None` where the data do not determine it.
    pub standard_error: Option<f64>,
    /// Both ends of the interval at 95 %, by profile likelihood; `None` where an end is open.
    pub interval: [Option<f64>; 2],
    /// Whether the value lies at the bound of what is possible.
    pub at_bound: bool,
}

/// How often the residual changes its sign, record by record: as often as noise does?
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Runs {
    /// Runs of one sign.
    pub count: usize,
    /// Runs that noise has on average (Wald & Wolfowitz 1940).
    pub expected: f64,
    /// Whether it looks like noise.
    pub random: bool,
}

/// What the fit leaves of the forces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Residual {
    /// Root of the mean square, N, without outliers.
    pub rms: f64,
    /// Largest magnitude, N, without outliers.
    pub largest: f64,
    /// Share of the points that were left out.
    pub outliers: f64,
    /// Its signs.
    pub runs: Runs,
}

/// A parameter that was not free, and what the data say of it: the result of one further step of the search with it.
#[derive(Clone, Debug, PartialEq)]
pub struct Omitted {
    /// Which.
    pub parameter: Parameter,
    /// What it would be, in its SI unit; `None` where the data do not distinguish it, or its unit needs times.
    pub value: Option<f64>,
    /// By how many of its standard errors it would differ from what it was taken for; `None` where the data do not
    /// distinguish it from what is free.
    pub z: Option<f64>,
    /// By how much each parameter that is sought would change, in its SI unit.
    pub shifts: Vec<(Parameter, f64)>,
}

/// What a small error of the bench would do to the estimates.
#[derive(Clone, Debug, PartialEq)]
pub struct Sensitivity {
    /// Which parameter is not zero, or not what it was taken for.
    pub parameter: Parameter,
    /// By how much, in its SI unit: a delay of one sample, 1 % of the force, of the way, of the compliance of the
    /// contact, or of the gain over the record; `None` where its unit needs times.
    pub change: Option<f64>,
    /// By how much each parameter that is sought changes, in its SI unit.
    pub shifts: Vec<(Parameter, f64)>,
}

/// A record beside its fit, thinned as the fit has used it; one entry a point.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Curve {
    /// As measured, m.
    pub displacement: Vec<f64>,
    /// As measured, N.
    pub measured: Vec<f64>,
    /// The force of the fitted contact on its bench, N.
    pub fitted: Vec<f64>,
    /// Whether the point was used, and not an outlier.
    pub used: Vec<bool>,
    /// Which branch it is on, from zero.
    pub branch: Vec<usize>,
}

/// What a user of the result has to know.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Note {
    /// The compliance of the machine is neither sought nor known: the values take it as zero, the intervals as unknown.
    MachineComplianceUnknown,
    /// No loop reaches gross slip: the friction coefficient is extrapolated.
    PartialSlipOnly,
    /// Nearly all points slide: what they say of the stiffness is little.
    BeyondGrossSlip,
    /// How a record began was not said or cannot be known: it is taken as a part of a steady loop, whose middle is its
    /// zero.
    FirstBranchUnknown,
    /// A record has too many turning points that do not repeat: they are taken where they were sampled, as if that were
    /// exact.
    TurnsAsSampled,
    /// The forces come in steps that are not small beside the noise: standard errors and intervals are the wider.
    Quantised,
    /// As the forces, the displacements.
    DisplacementQuantised,
    /// Points are missing about a turn: where it was is found from what came after.
    TurnInGap,
    /// A parameter that was not free is not what it was taken for: see `omitted`.
    OmittedParameter,
    /// The residual is larger than the noise that was told: see `excess`.
    NoiseExceeded,
    /// The residual is no noise: friction is not Coulomb's, or the contact is another one.
    NotCoulomb,
    /// The search ended before its minimum: values and intervals are those of where it stopped.
    NotConverged,
}
