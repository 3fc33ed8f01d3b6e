//! Friction and stiffness from measured loops.

use stickslip_measured::loops::{self, Error, Known, LoopFit, Noise, Note, Parameter, Record, Start};
use stickslip_mechanics as mechanics;
use stickslip_plot::in_unit;
use stickslip_wire::fit::{
    FitEstimate, FitParameter, FitReply, FitResidual, FitUnits, FittedLoop, LoopStart, MeasuredLoop, NoiseLevels,
    OmittedParameter, ParameterSensitivity, SignRuns,
};
use stickslip_wire::{Effective, FitRequest, Material, Profile};

use crate::computations::prelude::*;
use crate::simulation::refused_at;

/// Fits what is free to measured loops, which are in SI units.
///
/// # Errors
/// [`Failure`], which says what the loops lack, that the contact cannot be made, or that the work was ended.
pub fn fit_loops(request: FitRequest, setup: FrictionSetup, stop: &dyn Stop) -> Result<FitReply, Failure> {
    let FitRequest { contact: definition, loops, units, free, known, noise } = request;
    let (known, noise) = (known.unwrap_or_default(), noise.unwrap_or_default());
    let limit = setup.friction.limit;
    let (preload, has_friction) = (setup.preload, limit.coefficient > 0.0 || limit.shear_strength > 0.0);
    let task = loops::Task {
        contact: contact(setup, "/contact")?,
        records: loops.into_iter().map(record).collect(),
        free: free.iter().flatten().map(|name| of(*name)).collect(),
        known: known
            .iter()
            .map(|(name, known)| Known {
                parameter: of(name),
                value: known.value,
                standard_error: known.standard_error.unwrap_or(0.0),
            })
            .collect(),
        noise: Noise { force: noise.force, displacement: noise.displacement },
    };
    let fit = loops::fit(&task, &|| stop.check().is_ok()).map_err(|error| match (error, stop.check()) {
        (Error::Interrupted, Err(interrupted)) => Failure::interrupted(interrupted, "/loops"),
        (Error::Refused(error), _) => refused_at("/contact", preload)(error),
        (error, _) => {
            let free = free.as_deref().unwrap_or(&[]);
            Failure::at(place(&error, free, units.unwrap_or_default(), has_friction), error)
        }
    })?;
    Ok(reply(fit, definition))
}

/// Both lists have the same order.
fn of(name: FitParameter) -> Parameter {
    Parameter::ALL[name as usize]
}

fn name(parameter: Parameter) -> FitParameter {
    FitParameter::ALL[parameter as usize]
}

fn record(measured: MeasuredLoop) -> Record {
    let MeasuredLoop { displacement, force, time, normal_force, start, weight } = measured;
    let start = start.map(|start| match start {
        LoopStart::Steady => Start::Steady,
        LoopStart::Virgin => Start::Virgin,
    });
    Record { displacement, force, time, normal_force, start, weight: weight.unwrap_or(1.0) }
}

/// The JSON pointer to what an error is about.
fn place(error: &Error, free: &[FitParameter], units: FitUnits, has_friction: bool) -> String {
    let of_record = |record: usize, member: &str| format!("/loops/{record}/{member}");
    let of_unit = |is_given: bool, record: usize, member: &str| {
        if is_given { format!("/units/{member}") } else { of_record(record, member) }
    };
    let position = |parameter: Parameter| free.iter().position(|name| of(*name) == parameter);
    match *error {
        Error::TooFewPoints { record }
        | Error::ConstantForce { record }
        | Error::Rectified { record }
        | Error::WrongWay { record, .. } => of_record(record, "force"),
        Error::SingleBranch { record } | Error::ConstantDisplacement { record } => of_record(record, "displacement"),
        Error::ForceUnit { record, .. } => of_unit(units.force.is_some(), record, "force"),
        Error::StiffnessUnit { record, .. } => of_unit(units.displacement.is_some(), record, "displacement"),
        Error::NoTime { record, .. } => of_record(record, "time"),
        Error::Inseparable { parameter, .. } | Error::NotOfProfile { parameter } => {
            let elsewhere = match parameter {
                Parameter::ShearStrength => "/contact/shear_strength",
                _ => "/free",
            };
            position(parameter).map_or_else(|| elsewhere.to_owned(), |index| format!("/free/{index}"))
        }
        Error::NoContact { .. } if has_friction => "/contact/preload".to_owned(),
        Error::NoContact { .. } => "/contact/friction".to_owned(),
        Error::NoSolution | Error::Refused(_) | Error::Interrupted => "/loops".to_owned(),
    }
}

fn reply(fit: LoopFit, definition: ContactDefinition) -> FitReply {
    let names: Vec<FitParameter> = fit.estimates.iter().map(|estimate| name(estimate.parameter)).collect();
    let correlations = |row: &Vec<Option<f64>>| names.iter().copied().zip(row.iter().copied()).collect();
    let correlations = names.iter().copied().zip(fit.correlations.iter().map(correlations)).collect();
    let estimate = |&loops::Estimate { value, standard_error, interval, at_bound, .. }: &loops::Estimate| FitEstimate {
        value,
        standard_error,
        interval,
        at_bound,
    };
    let loops::Residual { rms, largest, outliers, runs: loops::Runs { count, expected, random } } = fit.residual;
    let [force, displacement] = fit.noise;
    let shifts = |shifts: &[(Parameter, f64)]| {
        // A shift that a computer cannot hold is none that a loop determines.
        let finite = shifts.iter().filter(|(_, shift)| shift.is_finite());
        finite.map(|(parameter, shift)| (name(*parameter), *shift)).collect()
    };
    let omitted = |one: &loops::Omitted| OmittedParameter {
        name: name(one.parameter),
        value: one.value.filter(|value| value.is_finite()),
        z: one.z.filter(|z| z.is_finite()),
        shifts: shifts(&one.shifts),
    };
    let sensitivity = |one: &loops::Sensitivity| ParameterSensitivity {
        name: name(one.parameter),
        change: one.change.filter(|change| change.is_finite()),
        shifts: shifts(&one.shifts),
    };
    let warnings = fit.notes.iter().map(|note| warning(*note, &fit)).collect();
    FitReply {
        free: fit.free.iter().copied().map(name).collect(),
        omitted: fit.omitted.iter().map(omitted).collect(),
        sensitivity: fit.sensitivity.iter().map(sensitivity).collect(),
        warnings,
        estimates: names.iter().copied().zip(fit.estimates.iter().map(estimate)).collect(),
        correlations,
        contact: fitted(definition, &fit, &names),
        identifiable: fit.identifiable,
        residual: FitResidual { rms, largest, outliers, runs: SignRuns { count, expected, random } },
        noise: NoiseLevels { force, displacement },
        curve: fit
            .curves
            .into_iter()
            .map(|curve| FittedLoop {
                displacement: curve.displacement,
                force: curve.fitted,
                measured: curve.measured,
                used: curve.used,
            })
            .collect(),
    }
}

/// The definition with what was fitted in the place of what it had.
fn fitted(definition: ContactDefinition, fit: &LoopFit, names: &[FitParameter]) -> ContactDefinition {
    let has = |name: FitParameter| names.contains(&name);
    let elasticity = fit.contact.elasticity();
    // Those of the bodies, where they are known, stay the constants of the stress below the surface.
    let bodies = definition.material.bodies().map(<[_]>::to_vec);
    let moduli = Effective { e_star: elasticity.e_star(), g_star: elasticity.g_star(), shear_modulus: None, bodies };
    let is_modulus_fitted = has(FitParameter::GStar) || has(FitParameter::EStar);
    let profile = match fit.contact.profile() {
        mechanics::Profile::Sphere(sphere) if has(FitParameter::Radius) => Profile::sphere(sphere.curvature_radius()),
        _ => definition.profile,
    };
    ContactDefinition {
        profile,
        material: if is_modulus_fitted { Material::Effective(moduli) } else { definition.material },
        friction: if has(FitParameter::Friction) { fit.contact.friction() } else { definition.friction },
        shear_strength: match has(FitParameter::ShearStrength) {
            true => Some(fit.contact.shear_strength()),
            false => definition.shear_strength,
        },
        adhesion: definition.adhesion,
        preload: definition.preload,
        bulk: definition.bulk,
        prony: None,
    }
}

fn warning(note: Note, fit: &LoopFit) -> Warning {
    let (code, message) = match note {
        Note::OmittedParameter => return Warning::new("omitted_parameter", omitted_parameters(fit)),
        Note::NoiseExceeded => {
            let message = format!(
                "the residual is {:.3} times the noise of the request: either that noise is too small, or the contact \
                 or the bench is another one. The standard errors are too small",
                fit.excess
            );
            return Warning::new("noise_exceeded", message);
        }
        Note::PartialSlipOnly => return Warning::new("partial_slip_only", partial_slip(fit)),
        Note::DisplacementQuantised => (
            "quantised",
            "the displacements come in steps that are not small beside the noise of the force: their rounding does not \
             average out at the turning points. Intervals are widened by the shift that it may cause",
        ),
        Note::TurnInGap => (
            "turn_in_gap",
            "points are missing about a turning point: its place follows from the forces after it alone. Send cycles \
             without gaps",
        ),
        Note::MachineComplianceUnknown => (
            "machine_compliance_unknown",
            "the compliance of the machine is taken as zero: a soft machine makes friction and stiffness wrong, and \
             the fit looks perfect all the same. Give it as `known`, or free it where the loop reaches gross slip",
        ),
        Note::BeyondGrossSlip => (
            "beyond_gross_slip",
            "most of the loop is gross slip: it determines the friction, but only few points determine the stiffness",
        ),
        Note::FirstBranchUnknown => (
            "first_branch_unknown",
            "how a record begins, or where its displacement is zero, is not known: it is taken as part of a steady \
             cycle centred on its middle. Give `start`; a steady cycle does not determine `displacement_offset`",
        ),
        Note::Quantised => (
            "quantised",
            "the forces come in steps that are not small beside their noise: where the contact slides, their rounding \
             does not average out. Standard errors and intervals are widened by the shift that it may cause",
        ),
        Note::TurnsAsSampled => (
            "turns_as_sampled",
            "a record has more turning points than can be fitted, and they do not repeat: they are placed at sampled \
             points, and the intervals leave out the error of this. Send fewer cycles",
        ),
        Note::NotCoulomb => (
            "not_coulomb",
            "the residual is not noise: the contact has another friction law, shape or load, or a load that is not \
             constant, points are missing about a turning point, or the bench has another error. The standard errors \
             are too small",
        ),
        Note::NotConverged => (
            "not_converged",
            "the search for the best values did not converge: values and intervals are those where it stopped. Free \
             fewer parameters, or give known values",
        ),
    };
    Warning::new(code, message)
}

/// The parameters whose score is significant, the most significant first, with what freeing each would change.
fn omitted_parameters(fit: &LoopFit) -> String {
    let mut found: Vec<&loops::Omitted> = fit.omitted.iter().filter(|one| one.is_significant()).collect();
    let size = |one: &loops::Omitted| one.z.map_or(0.0, f64::abs);
    found.sort_by(|a, b| size(b).total_cmp(&size(a)));
    let described = |one: &&loops::Omitted| {
        let shifts = relative(fit, &one.shifts, 0.0);
        let changes = if shifts.is_empty() { String::new() } else { format!(": {shifts}") };
        format!("`{}` (z = {:.1}{changes})", one.parameter.name(), one.z.unwrap_or(0.0))
    };
    let all: Vec<String> = found.iter().map(described).collect();
    let needs_time = found.first().is_some_and(|one| one.parameter.needs_time());
    let times = if needs_time { ", with the `time` of each point" } else { "" };
    let first = found.first().map_or("", |one| one.parameter.name());
    format!(
        "parameters that were not free differ from what the fit assumes: {}. Free `{first}`{times}, or correct the \
         record; free one at a time, as they may stand for each other",
        all.join(", ")
    )
}

/// What partial slip alone does not distinguish, in numbers.
fn partial_slip(fit: &LoopFit) -> String {
    let described = |one: &loops::Sensitivity| {
        let error = match one.parameter {
            Parameter::Delay => "a delay of the force by one sample",
            Parameter::ForceOffset => "a force offset of 1 %",
            Parameter::GainDrift => "a gain that drifts by 1 %",
            _ => return None,
        };
        let shifts = relative(fit, &one.shifts, 5e-4);
        (!shifts.is_empty()).then(|| format!("{error} would change {shifts}"))
    };
    let all: Vec<String> = fit.sensitivity.iter().filter_map(described).collect();
    let effects = if all.is_empty() { String::new() } else { format!("; {}", all.join("; ")) };
    let widened = |estimate: &loops::Estimate| {
        let [low, high] = fit.interval_with_bench(estimate)?;
        let end = |value: f64| match estimate.parameter {
            Parameter::GStar => in_unit(value, "Pa"),
            _ => format!("{value:.3}"),
        };
        let is_stated = matches!(estimate.parameter, Parameter::Friction | Parameter::GStar);
        is_stated.then(|| format!("{} from {} to {}", estimate.parameter.name(), end(low), end(high)))
    };
    let intervals: Vec<String> = fit.estimates.iter().filter_map(widened).collect();
    let allowed = if all.is_empty() || intervals.is_empty() {
        String::new()
    } else {
        format!(
            ". Intervals that allow for all of these, a force that comes late included, not one that comes early: {}",
            intervals.join(", ")
        )
    };
    format!(
        "no loop reaches gross slip: friction and stiffness follow only from the curvature of the branches{effects}\
         {allowed}"
    )
}

/// Shifts of positive estimates as shares of them in percent, those of at least this share.
fn relative(fit: &LoopFit, shifts: &[(Parameter, f64)], least: f64) -> String {
    let share = |(parameter, shift): &(Parameter, f64)| {
        let estimate = fit.estimates.iter().find(|estimate| estimate.parameter == *parameter)?;
        let is_positive = matches!(
            parameter,
            Parameter::Friction | Parameter::GStar | Parameter::MachineCompliance | Parameter::ShearStrength
        );
        let share = shift / estimate.value;
        (is_positive && share.is_finite() && share.abs() >= least)
            .then(|| format!("{} by {:+.2} %", parameter.name(), 100.0 * share))
    };
    shifts.iter().filter_map(share).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::{FitParameter, name, of};

    #[test]
    fn the_names_of_requests_are_those_of_the_fit() {
        for parameter in FitParameter::ALL {
            assert_eq!((of(parameter).name(), name(of(parameter))), (parameter.name(), parameter));
        }
    }
}
