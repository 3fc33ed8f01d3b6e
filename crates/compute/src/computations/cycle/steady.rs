//! Steady cycles of a contact at its present load, one for each amplitude.

use std::f64::consts::TAU;

use stickslip_mechanics::cycle::{self, OscillatingCycle, OscillatingLoad, Oscillation};
use stickslip_mechanics::{self as mechanics, Error, Move, Normal, Tangential};
use stickslip_wire::cycle::CycleTask;
use stickslip_wire::{CycleReply, FrictionWork, Harmonic, SteadyCycle};

use super::studies::{best_load, resonance};
use crate::computations::prelude::*;
use crate::simulation::{sampled, warnings_at};

/// Radii between two checks of the flag: each time the contact is copied and turned.
const RADII_PER_CHECK: usize = 512;

const REASON: &str = "a steady cycle at constant load follows from the load curve alone";
const REASON_STEPPED: &str =
    "a cycle under a load that oscillates is stepped with the exact slip history, to the tolerance";

/// The steady cycles of a contact at its present load, which has no history.
///
/// # Errors
/// [`Failure`] for a force of μ F_N or more, or if the work was ended.
pub fn steady_cycles(
    contact: &Contact,
    task: &CycleTask,
    timer: Timer<'_>,
    stop: &dyn Stop,
) -> Result<CycleReply, Failure> {
    if task.density.is_some() {
        needs_stress_field(contact, "/work_density")?;
    }
    let sampled = |sampling| sampled(contact, sampling, contact.contact_radius(), "/work_density");
    let places = task.density.as_ref().map(sampled).transpose()?;
    // Compliance of the machine, m/N or rad/(N m).
    let compliance = task.stiffness.map_or(0.0, f64::recip);
    let twisting = task.twists().then(|| contact.twisting()).transpose();
    let twisting = twisting.map_err(|error| Failure::at(task.place_of(0), error))?;
    let mut cycles = Vec::with_capacity(task.drives().len());
    // The largest cycle shows the error of the forces.
    let (mut largest, mut error) = (0.0_f64, 0.0_f64);
    for (index, drive) in task.drives().enumerate() {
        stop.check()?;
        let row = if let Some((load, tolerance)) = task.normal {
            let swing = Oscillation { drive, load, compliance };
            let found = swing.steady(contact, tolerance, task.harmonics, &|| stop.check().is_ok());
            let found = found.map_err(|error| {
                let place = place_of_refused(&error, &load, task, index);
                Failure::at(place, error).unless_interrupted(stop, &task.place_of(index))
            })?;
            error = error.max(found.error);
            stepped(found, task)
        } else {
            let found = cycle::SteadyCycle::driven(twisting.as_ref().unwrap_or(contact), drive, compliance)
                .map_err(|error| match error {
                    Error::ForceExceedsFriction { target, limit, .. } if task.twists() => {
                        Error::TorqueExceedsFriction { target, limit }
                    }
                    other => other,
                })
                .map_err(|error| Failure::at(task.place_of(index), error))?;
            let [shifts, twists] = [!task.twists(), task.twists()];
            let harmonics = (task.harmonics > 0).then(|| found.harmonics(task.harmonics));
            error = harmonics.as_ref().map_or(error, |found| error.max(found.error));
            SteadyCycle {
                displacement_amplitude: shifts.then(|| found.displacement_amplitude()),
                force_amplitude: shifts.then(|| found.force_amplitude()),
                twist_amplitude: twists.then(|| found.displacement_amplitude()),
                torque_amplitude: twists.then(|| found.force_amplitude()),
                machine_amplitude: task.stiffness.map(|_| found.machine_amplitude()),
                dissipated_energy: found.dissipated_energy(),
                max_elastic_energy: found.max_elastic_energy(),
                secant_stiffness: found.secant_stiffness(),
                tangent_stiffness: found.tangent_stiffness(),
                loss_factor: found.loss_factor().and_then(finite),
                sliding_ratio: found.sliding_ratio().and_then(finite),
                friction_energy: has_bulk(contact).then(|| found.friction_energy()),
                stick_radius: if twists { contact.radius_of_twist(found.stick_radius()) } else { found.stick_radius() },
                regime: found.regime().into(),
                harmonics: harmonics.map(|found| found.harmonics.into_iter().map(Harmonic::from).collect()),
                friction_work: places.as_ref().map(|places| friction_work(&found, places, stop)).transpose()?,
                best_load: match task.best_load {
                    Some(study) => best_load(contact, (drive, compliance), study, stop)?,
                    None => None,
                },
                ..SteadyCycle::default()
            }
        };
        largest = largest.max(row.amplitude());
        cycles.push(row);
    }
    let (reason, missed) = match task.normal {
        Some((_, tolerance)) => (REASON_STEPPED, excess_error(error, tolerance, 1)),
        None => (REASON, None),
    };
    let mut turned = contact.clone();
    let target = if task.twists() { Tangential::Twist(largest) } else { Tangential::Displacement(largest) };
    let step = Move { tangential: Some(target), ..Move::default() };
    // A displacement within its range is always reached.
    let estimated = turned.apply(&step).map_or(contact, |()| &turned);
    // Those of what is moved: twist couples with nothing.
    let moved = if task.twists() { estimated } else { contact };
    let mut warnings = warnings_at(moved, contact.contact_radius(), contact.indentation(), missed);
    let mut frequency_response = None;
    if let Some((asked, tolerance)) = &task.response {
        let (found, warning) = resonance(contact, asked, *tolerance, stop)?;
        warnings.extend(warning);
        frequency_response = Some(found);
    }
    // At the end: it states the time that all of this took.
    let mut accuracy = accuracy(estimated, timer, reason);
    accuracy.force_error = accuracy.force_error.max(error);
    let gross_slip_torque = twisting.map(|twisting| twisting.normal_force());
    let summary = mechanics::ContactSummary { gross_slip_torque, ..contact.summary() };
    Ok(CycleReply { contact: summary.into(), cycles, frequency_response, accuracy, warnings })
}

/// The member that a cycle under a load that oscillates is refused for: the drive, or the load.
fn place_of_refused(error: &Error, load: &OscillatingLoad, task: &CycleTask, index: usize) -> String {
    match (error, load.amplitude) {
        (Error::ForceExceedsFriction { .. }, _) => task.place_of(index),
        (_, Normal::NormalForce(_)) => "/normal/normal_force".to_owned(),
        (_, Normal::Indentation(_)) => "/normal/indentation".to_owned(),
    }
}

/// The row of a cycle that is the sum of states: under a load that oscillates, or of bodies with memory.
pub(super) fn stepped(cycle: OscillatingCycle, task: &CycleTask) -> SteadyCycle {
    let moves = cycle.displacement_amplitude > 0.0;
    let stored = cycle.max_elastic_energy;
    let lost = cycle.dissipated_energy + cycle.viscous_work.unwrap_or(0.0);
    let loss = if stored > 0.0 { lost / (TAU * stored) } else { f64::NAN };
    let secant = cycle.force_amplitude / cycle.displacement_amplitude;
    SteadyCycle {
        displacement_amplitude: Some(cycle.displacement_amplitude),
        force_amplitude: Some(cycle.force_amplitude),
        machine_amplitude: task.stiffness.map(|_| cycle.machine_amplitude),
        dissipated_energy: cycle.dissipated_energy,
        viscous_work: cycle.viscous_work,
        max_elastic_energy: stored,
        secant_stiffness: if moves { secant } else { cycle.tangent_stiffness },
        tangent_stiffness: cycle.tangent_stiffness,
        loss_factor: finite(if moves { loss } else { 0.0 }),
        sliding_ratio: if moves { cycle.sliding_ratio.and_then(finite) } else { Some(0.0) },
        stick_radius: cycle.stick_radius,
        regime: cycle.regime.into(),
        harmonics: (task.harmonics > 0).then(|| cycle.harmonics.into_iter().map(Harmonic::from).collect()),
        ..SteadyCycle::default()
    }
}

fn has_bulk(contact: &Contact) -> bool {
    contact.profile().line().is_some_and(|line| line.bulk().is_some())
}

fn friction_work(
    cycle: &cycle::SteadyCycle<'_>,
    (radii, line): &(Vec<f64>, bool),
    stop: &dyn Stop,
) -> Result<FrictionWork, Failure> {
    let mut density = Vec::with_capacity(radii.len());
    for some in radii.chunks(RADII_PER_CHECK) {
        stop.check()?;
        density.extend(cycle.friction_work(some).into_iter().map(finite));
    }
    let (radius, x) = if *line { (None, Some(radii.clone())) } else { (Some(radii.clone()), None) };
    Ok(FrictionWork { radius, x, density })
}
