//! What must hold for any body of `POST /cycle`.

use std::f64::consts::PI;

use stickslip_compute::Nanoseconds;
use stickslip_compute::computations::Cycle;
use stickslip_mechanics::cycle::Drive;
use stickslip_wire::cycle::CycleTask;
use stickslip_wire::{CycleReply, SteadyCycle};

use super::answered::answered;
use super::harness::Outcome;

/// The largest estimated cost of a body that is run.
const MAX_COST: Nanoseconds = 150_000_000;
/// The allowed error of the work in the first harmonic beyond the estimate, relative to the work of the amplitudes.
const WORK: f64 = 1e-10;
/// Contact radii, m, and normal forces, N, below which products of a few of them lose their digits.
const SMALLEST: f64 = 1e-90;

/// # Panics
/// If a law does not hold for the answer to a body.
pub fn examine(body: &[u8]) -> Outcome {
    answered::<Cycle>(body, MAX_COST, |(.., task), reply| laws(&task, reply))
}

fn laws(task: &CycleTask, reply: &CycleReply) {
    assert_eq!(reply.cycles.len(), task.drives().len(), "a cycle for each amplitude");
    for (cycle, drive) in reply.cycles.iter().zip(task.drives()) {
        columns(task, cycle);
        signs(cycle);
        let contact = &reply.contact;
        let pressed = contact.normal_force > SMALLEST && contact.contact_radius > SMALLEST;
        if task.normal.is_none() && pressed {
            work_of_harmonics(cycle, drive, reply.accuracy.force_error);
        }
    }
}

/// Each cycle has all that was asked for, in columns of equal length.
fn columns(task: &CycleTask, cycle: &SteadyCycle) {
    assert_eq!(cycle.machine_amplitude.is_some(), task.stiffness.is_some(), "{cycle:?}");
    let orders = cycle.harmonics.iter().flatten().map(|harmonic| harmonic.order);
    assert!(orders.eq(1..=task.harmonics), "{cycle:?}");
    assert_eq!(cycle.friction_work.is_some(), task.density.is_some(), "{cycle:?}");
    if let Some(work) = &cycle.friction_work {
        assert_eq!(
            (work.radius.as_ref().map_or(0, Vec::len), work.density.len()),
            (task.radii(), task.radii()),
            "{cycle:?}"
        );
        assert!(work.density.iter().flatten().all(|density| *density >= 0.0), "{cycle:?}");
    }
}

/// All numbers are finite, and none is negative that cannot be.
fn signs(cycle: &SteadyCycle) {
    let SteadyCycle { displacement_amplitude, force_amplitude, dissipated_energy, max_elastic_energy, .. } = cycle;
    let SteadyCycle { secant_stiffness, tangent_stiffness, stick_radius, .. } = cycle;
    let [displacement_amplitude, force_amplitude] =
        [displacement_amplitude, force_amplitude].map(|amplitude| amplitude.as_ref().unwrap());
    let numbers = [displacement_amplitude, force_amplitude, dissipated_energy, max_elastic_energy];
    let numbers = numbers.into_iter().chain([secant_stiffness, tangent_stiffness, stick_radius]);
    let optional = [&cycle.machine_amplitude, &cycle.loss_factor, &cycle.sliding_ratio];
    for number in numbers.chain(optional.into_iter().flatten()) {
        assert!(*number >= 0.0 && number.is_finite(), "{number:e}: {cycle:?}");
    }
    assert!(cycle.sliding_ratio.is_none_or(|ratio| ratio <= 1.0), "{cycle:?}");
    let mut amplitudes = cycle.harmonics.iter().flatten().flat_map(|harmonic| [harmonic.in_phase, harmonic.quadrature]);
    assert!(amplitudes.all(f64::is_finite), "{cycle:?}");
}

/// D = oint F dU, with the drive as the cosine and `error` of the answer's amplitude.
fn work_of_harmonics(cycle: &SteadyCycle, drive: Drive, error: f64) {
    let Some(first) = cycle.harmonics.as_ref().and_then(|harmonics| harmonics.first()) else { return };
    let (work, unit) = match drive {
        Drive::Displacement(amplitude) => {
            (-PI * amplitude * first.quadrature, amplitude * cycle.force_amplitude.unwrap())
        }
        Drive::Force(amplitude) => {
            (PI * amplitude * first.quadrature, amplitude * cycle.displacement_amplitude.unwrap())
        }
    };
    let off = (work - cycle.dissipated_energy).abs();
    assert!(off <= 4.0 * PI * (WORK + error) * unit, "{off:e} of {unit:e}: {cycle:?}");
}
