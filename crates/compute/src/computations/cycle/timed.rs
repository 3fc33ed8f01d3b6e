//! The steady cycles of bodies with memory, for each frequency and amplitude; their plots.

use stickslip_mechanics::Preload;
use stickslip_mechanics::cycle::{Drive, OscillatingCycle, TimedCycle};
use stickslip_wire::cycle::CycleTask;
use stickslip_wire::{CycleReply, SteadyCycle};

use super::steady::stepped;
use crate::computations::prelude::*;
use crate::simulation::warnings_at;

const REASON: &str = "in steady cycles each spring of bodies with memory has a loop of its own, and they are summed";
/// Colours of the curves of amplitudes, one after the other.
const COLOURS: [Colour; 5] = [Colour::Blue, Colour::Red, Colour::Sky, Colour::Orange, Colour::Green];

/// The steady cycles of a contact whose bodies have relaxed under its preload, frequency by frequency.
///
/// # Errors
/// [`Failure`] for a preload that the relaxed contact does not reach, or if the work was ended.
pub fn cycles(
    contact: &Contact,
    task: &CycleTask,
    held: Preload,
    timer: Timer<'_>,
    stop: &dyn Stop,
) -> Result<CycleReply, Failure> {
    let relaxed = contact.relaxed(held).map_err(simulation::refused_at("/contact", held))?;
    let mut cycles = Vec::with_capacity(task.rows());
    let mut error = 0.0_f64;
    for &frequency in &task.frequencies {
        for (index, drive) in task.drives().enumerate() {
            let found = cycle(contact, &relaxed, (drive, frequency), task.harmonics, stop);
            let found = found.map_err(|error| Failure::at(task.place_of(index), error).unless_interrupted(stop, ""))?;
            error = error.max(found.error);
            let row = stepped(found, task);
            cycles.push(SteadyCycle {
                frequency: Some(frequency),
                normal_force: Some(relaxed.normal_force()),
                gross_slip_displacement: Some(relaxed.gross_slip_displacement()),
                ..row
            });
        }
    }
    let warnings = warnings_at(contact, relaxed.contact_radius(), relaxed.indentation(), None);
    let mut accuracy = accuracy(&relaxed, timer, REASON);
    (accuracy.solver, accuracy.force_error) = (SolverKind::Springs, accuracy.force_error.max(error));
    Ok(CycleReply { contact: contact.summary().into(), cycles, frequency_response: None, accuracy, warnings })
}

fn cycle(
    contact: &Contact,
    relaxed: &Contact,
    (drive, frequency): (Drive, f64),
    harmonics: usize,
    stop: &dyn Stop,
) -> Result<OscillatingCycle, stickslip_mechanics::Error> {
    let (Drive::Displacement(amplitude) | Drive::Force(amplitude)) = drive;
    TimedCycle { amplitude, frequency }.steady(contact, relaxed, harmonics, &|| stop.check().is_ok())
}

/// Loss factor and secant stiffness over the frequency, a curve for each amplitude; the loop, if there is one cycle.
pub fn plot(contact: &Contact, reply: &CycleReply, task: &CycleTask, held: Preload) -> Plot {
    if let ([only], Ok(relaxed)) = (&reply.cycles[..], contact.relaxed(held)) {
        return steady_loop(contact, &relaxed, only);
    }
    let amplitudes = task.drives().len().max(1);
    let panel = |y, of: fn(&SteadyCycle) -> f64| {
        let curve = |index: usize| {
            let rows = reply.cycles.iter().skip(index).step_by(amplitudes);
            let mut points: Vec<_> =
                rows.map(|cycle| (cycle.frequency.unwrap_or(f64::NAN).log10(), of(cycle))).collect();
            points.sort_by(|one, other| one.0.total_cmp(&other.0));
            let name = match reply.cycles.get(index) {
                Some(cycle) if amplitudes > 1 && amplitudes <= COLOURS.len() => {
                    format!("U₀ = {:.3e} m", cycle.amplitude())
                }
                _ => String::new(),
            };
            Curve::line(name, COLOURS[index % COLOURS.len()], points)
        };
        Panel { y, curves: (0..amplitudes).map(curve).collect() }
    };
    let loss = panel(Axis { name: "loss factor", unit: None }, |cycle| cycle.loss_factor.unwrap_or(f64::NAN));
    let stiffness = panel(Axis::of("secant stiffness", "N/m"), |cycle| cycle.secant_stiffness);
    let x = Axis { name: "log₁₀(frequency / Hz)", unit: None };
    Plot::new("Steady cycles of bodies with memory", x, vec![loss, stiffness])
}

/// The loop of one steady cycle.
fn steady_loop(contact: &Contact, relaxed: &Contact, only: &SteadyCycle) -> Plot {
    let (amplitude, frequency) = (only.amplitude(), only.frequency.unwrap_or(f64::NAN));
    let points = TimedCycle { amplitude, frequency }.points(contact, relaxed).unwrap_or_default();
    let work = only.dissipated_energy + only.viscous_work.unwrap_or(0.0);
    let curves = vec![Curve::line("", Colour::Blue, points)];
    Plot::new(
        format!("Steady cycle of {work:.4e} J"),
        Axis::of("displacement U", "m"),
        vec![Panel { y: Axis::of("tangential force F", "N"), curves }],
    )
}
