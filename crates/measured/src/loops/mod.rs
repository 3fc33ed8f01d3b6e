//! A measured loop of force over displacement becomes friction, stiffness and compliance of the machine.
//!
//! The forward model is the exact contact at constant load behind a machine spring, of any profile (`loading_curve`,
//! `model`). Its parameters are fitted by least squares (Levenberg-Marquardt with the exact Jacobian, whose gradients
//! are carried through the turning points; `least_squares`) after outliers have been found (Huber 1964; `fit`). Turning
//! points lie between the samples of the record (`reversals`, `turns`, `record`): their places are parameters of the
//! fit, of which the samples about them are what is known (`prepare`). Noise of the displacement moves each sample to
//! the nearest point of the curve (`fit`). A drift that is sought is taken off before turns are sought. Intervals are
//! those of the profile likelihood, since the linear ones are wrong by a factor of two for a loop in partial slip
//! (`intervals`).
//!
//! A loop that stays in partial slip does not distinguish the compliance of the machine from that of the contact, and a
//! fit that ignores the machine looks as good as one that does not. So a compliance that is neither sought nor known
//! widens all intervals by all that it could be.
//!
//! What was not free is tested all the same: the score of each parameter that was left out, and what it would shift
//! (`omitted`). Without a list of what is sought, the records decide (`search`).
//!
//! Forces in steps do not average out where the contact slides: what that may shift is added (`quantised`).
//!
//! SI units throughout.

mod error;
mod fit;
mod gaps;
mod identifiable;
mod intervals;
mod least_squares;
mod loading_curve;
mod model;
mod omitted;
mod outcome;
mod parameter;
mod prepare;
mod quantised;
mod randomness;
mod record;
mod result;
mod reversals;
mod sampled_curve;
mod search;
mod sense;
mod start;
#[cfg(test)]
mod tests;
mod turns;
mod velocity;

pub use error::Error;
pub use parameter::Parameter;
pub use result::{Curve, Estimate, Note, Omitted, Residual, Runs, Sensitivity};

use omitted::SIGNIFICANT;
use outcome::{LeftOver, Uncertainty, fitted_contact, left_over};
use prepare::prepare;
use search::Search;
use stickslip_mechanics::Contact;

/// Points that a record needs.
pub const FEWEST_POINTS: usize = 8;
/// Points of a record that are used: of more, every second, third and so on, and the turning points.
pub const MOST_POINTS: usize = 4_000;
/// Turning points, in all records, up to which each has a place of its own, unless a record repeats its cycle.
pub const MOST_REFINED_TURNS: usize = 64;
/// Turning points of a record that repeats its cycle beyond which those of either side share their place.
const FEW_TURNS: usize = 8;
/// A residual of this share of the force is rounding.
const ROUNDING: f64 = 1e-9;
/// A residual below so many times the noise that was told may be that of the approximations for noise of displacements.
const LEAST_EXCESS: f64 = 1.1;
/// A record with fewer of its points on sticking branches slides nearly always.
const FEW_STICKING: f64 = 0.1;

/// How a record begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Start {
    /// Within a cycle that has been run through before.
    Steady,
    /// With the first move of a contact at rest.
    Virgin,
}

/// One record of a bench, at constant load.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    /// Displacement of the machine, m.
    pub displacement: Vec<f64>,
    /// Tangential force, N; positive where it belongs to a positive displacement.
    pub force: Vec<f64>,
    /// Times, s, where a drift is sought.
    pub time: Option<Vec<f64>>,
    /// Normal force, N; that of the contact where it is left out.
    pub normal_force: Option<f64>,
    /// How it begins; steady where it is left out.
    pub start: Option<Start>,
    /// By how much it counts; above zero.
    pub weight: f64,
}

/// A parameter that is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Known {
    /// Which.
    pub parameter: Parameter,
    /// Its value.
    pub value: f64,
    /// Its standard error; zero where it is held.
    pub standard_error: f64,
}

/// Standard deviations of the noise, where they are known.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Noise {
    /// Of the force, N.
    pub force: Option<f64>,
    /// Of the displacement, m.
    pub displacement: Option<f64>,
}

/// What is to be fitted.
#[derive(Clone, Debug)]
pub struct Task {
    /// The contact as it is thought to be, with its load.
    pub contact: Contact,
    /// At least one.
    pub records: Vec<Record>,
    /// What is sought, none twice; if there is none, what the records can tell.
    pub free: Vec<Parameter>,
    /// What is known better than the definition says, none twice. One with a standard error takes part in the fit.
    pub known: Vec<Known>,
    /// The noise of the instruments.
    pub noise: Noise,
}

/// The fit.
#[derive(Clone, Debug)]
pub struct LoopFit {
    /// What was sought: as given, or what the records can tell.
    pub free: Vec<Parameter>,
    /// In the order of `free`, then what is known with a standard error.
    pub estimates: Vec<Estimate>,
    /// Of the estimates with each other; `None` where one of them is not determined.
    pub correlations: Vec<Vec<Option<f64>>>,
    /// What the data determine, by name, and what only in combination.
    pub identifiable: Vec<String>,
    /// The parameters that were not free, with the score test of each.
    pub omitted: Vec<Omitted>,
    /// What small errors of the bench would do to the estimates.
    pub sensitivity: Vec<Sensitivity>,
    /// What is left.
    pub residual: Residual,
    /// Standard deviations of force, N, and displacement, m: as given, or as estimated.
    pub noise: [f64; 2],
    /// Root mean square of the residual over the noise of each point.
    pub excess: f64,
    /// One a record.
    pub curves: Vec<Curve>,
    /// What to know of it.
    pub notes: Vec<Note>,
    /// The fitted contact.
    pub contact: Contact,
}

/// Fits the parameters of a contact and its bench to measured loops.
///
/// ```
/// use stickslip_measured::loops::{Known, Noise, Parameter, Record, Task, fit};
/// use stickslip_mechanics::{Contact, Elasticity, Move, Preload, Profile, Setup, Sphere, Tangential};
///
/// let ball = |friction| Setup {
///     profile: Profile::Sphere(Sphere::new(0.01).unwrap()),
///     elasticity: Elasticity::effective(1.15e11, 8.5e10).unwrap(),
///     friction,
///     preload: Preload::NormalForce(10.0),
/// };
/// // A loop of a contact with another friction than we think.
/// let mut truth = Contact::new(ball(0.4))?;
/// let (mut displacement, mut force) = (vec![], vec![]);
/// for step in 0..500 {
///     let place = 2.5e-7 * (0.05 * f64::from(step)).sin();
///     truth.apply(&Move { tangential: Some(Tangential::Displacement(place)), ..Move::default() })?;
///     displacement.push(place);
///     force.push(truth.force());
/// }
/// let record = Record { displacement, force, time: None, normal_force: None, start: None, weight: 1.0 };
/// let stiff = Known { parameter: Parameter::MachineCompliance, value: 0.0, standard_error: 0.0 };
/// let task = Task {
///     contact: Contact::new(ball(0.3))?,
///     records: vec![Record { start: Some(stickslip_measured::loops::Start::Virgin), ..record }],
///     free: vec![Parameter::Friction, Parameter::GStar],
///     known: vec![stiff],
///     noise: Noise::default(),
/// };
/// let found = fit(&task, &|| true).unwrap();
/// assert!((found.estimates[0].value - 0.4).abs() < 1e-9);
/// # Ok::<(), stickslip_mechanics::Error>(())
/// ```
///
/// # Errors
/// [`Error`], which says what the records lack; [`Error::Interrupted`] as soon as `proceed` says no.
pub fn fit(task: &Task, proceed: &dyn Fn() -> bool) -> Result<LoopFit, Error> {
    let task = Task { records: task.records.iter().map(record::without_doubles).collect(), ..task.clone() };
    let steps: Vec<Option<f64>> = task.records.iter().map(|record| crate::steps::step(&record.force)).collect();
    let step = steps.iter().flatten().copied().fold(0.0, f64::max);
    // Rounding is noise too.
    let rounded = |noise: f64| if step > noise { noise.hypot(quantised::variance(step).sqrt()) } else { noise };
    let noise = Noise { force: task.noise.force.map(rounded), ..task.noise };
    let (task, Search { data, fitted, preliminary }) = search::fit(task, noise, proceed)?;
    let task = &task;
    let LeftOver { curves, residual, sticking, excess } = left_over(&data, &fitted)?;
    let bench = data.layout.bench(&fitted.values);
    let stiffness = record::stiffness(&task.contact) * bench.g_star / task.contact.elasticity().g_star();
    let roundings = quantised::roundings(&data, &steps, &curves, stiffness);
    let is_quantised = roundings.iter().any(|of| of.force.is_some());
    let displacement_quantised = roundings.iter().any(|of| of.displacement.is_some());
    let compliance = Parameter::MachineCompliance;
    let compliance_unknown =
        !task.free.contains(&compliance) && !task.known.iter().any(|known| known.parameter == compliance);
    let Uncertainty { mut estimates, mut correlations, mut identifiable, tests } =
        Uncertainty::new(task, &data, &fitted, &roundings, proceed)?;
    if compliance_unknown {
        // What a compliance that may be anything leaves open is open.
        let mut wider = prepare(task, true, preliminary)?;
        let free = fit::fit(&mut wider, noise, proceed)?;
        let open = Uncertainty::new(task, &wider, &free, &roundings, proceed)?;
        for (estimate, open) in estimates.iter_mut().zip(&open.estimates) {
            let ([low, high], value) = (open.interval, estimate.value);
            let interval = [low.map(|low| low.min(value)), high.map(|high| high.max(value))];
            *estimate = Estimate { interval, value, at_bound: estimate.at_bound, ..*open };
        }
        (correlations, identifiable) = (open.correlations, open.identifiable);
    }
    let largest_noise = data.records.iter().map(|record| record.noise).fold(0.0, f64::max);
    let force = data.records.iter().map(|record| record.half_force).fold(0.0, f64::max);
    let used = fitted.used().max(1) as f64;
    let most_excess = (1.0 + SIGNIFICANT * (2.0 / used).sqrt()).sqrt().max(LEAST_EXCESS);
    let exceeded = noise.force.is_some() && excess > most_excess;
    let steady_offset = task.free.contains(&Parameter::DisplacementOffset)
        && data.layout.column(Parameter::DisplacementOffset).is_none();
    let omitted_parameter = tests.omitted.iter().any(Omitted::is_significant);
    let notes = [
        (compliance_unknown, Note::MachineComplianceUnknown),
        (!data.records.iter().any(|record| record.slides(bench)), Note::PartialSlipOnly),
        (sticking < FEW_STICKING, Note::BeyondGrossSlip),
        (steady_offset || task.records.iter().any(|record| record.start.is_none()), Note::FirstBranchUnknown),
        (omitted_parameter, Note::OmittedParameter),
        (exceeded, Note::NoiseExceeded),
        // Rounding keeps its sign for long stretches too.
        (!residual.runs.random && residual.rms > ROUNDING * force && !is_quantised, Note::NotCoulomb),
        (is_quantised, Note::Quantised),
        (displacement_quantised, Note::DisplacementQuantised),
        (data.records.iter().any(|record| record.turn_in_gap), Note::TurnInGap),
        (!fitted.converged, Note::NotConverged),
        (data.records.iter().any(|record| record.turns[0].column.is_none()), Note::TurnsAsSampled),
    ];
    Ok(LoopFit {
        free: task.free.clone(),
        estimates,
        correlations,
        identifiable,
        omitted: tests.omitted,
        sensitivity: tests.sensitivity,
        residual,
        noise: [fitted.force_noise, largest_noise * fitted.displacement_share.sqrt()],
        excess,
        curves,
        notes: notes.into_iter().filter_map(|(applies, note)| applies.then_some(note)).collect(),
        // A search that has run away has not found anything.
        contact: fitted_contact(task, &data, &fitted).map_err(|_| Error::NoSolution)?,
    })
}
