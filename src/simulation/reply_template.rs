//! The members of a reply before anything is computed: which numbers it will have.

use stickslip_wire::simulate::Simulation;
use stickslip_wire::{
    Accuracy, ContactSummary, Peak, Plan, Protocol, Regime, Residual, Sampling, SimulateReply, SolverKind, State,
    Steps, Stress,
};

/// A reply with a zero for each number that the simulation will compute, and one peak in place of however many there
/// will be.
pub(super) fn reply_template(simulation: &Simulation) -> SimulateReply {
    let steps = if simulation.steps == Steps::All { simulation.plan.length() } else { 1 };
    let peak = Peak { radius: 0.0, shear: None };
    let residual = Residual { centre: None, peaks: vec![peak], max: None, min: None, mean: None, relative: None };
    let protocol = matches!(simulation.plan, Plan::EqualPeaks(_))
        .then(|| Protocol { displacement: vec![0.0; simulation.plan.length()], cutoff_radius: 0.0 });
    SimulateReply {
        contact: FIGURES,
        steps: vec![STATE; steps],
        stress: simulation.stress.as_ref().map(stress),
        residual: simulation.residual.then_some(residual),
        // No output of a sweep.
        subsurface: None,
        protocol,
        accuracy: Accuracy {
            solver: SolverKind::Exact,
            reason: String::new(),
            force_error: 0.0,
            stress_error: 0.0,
            subsurface_error: None,
            compute_time: 0.0,
        },
        warnings: Vec::new(),
    }
}

fn stress(sampling: &Sampling) -> Stress {
    let (length, fields) = (sampling.length(), &sampling.fields);
    let column = |wanted: bool| wanted.then(|| vec![None; length]);
    Stress {
        radius: vec![0.0; length],
        pressure: column(fields.pressure),
        shear: column(fields.shear),
        slip: column(fields.slip),
        displacement: column(fields.displacement),
    }
}

const FIGURES: ContactSummary = ContactSummary {
    e_star: 0.0,
    g_star: 0.0,
    indentation: 0.0,
    contact_radius: 0.0,
    normal_force: 0.0,
    max_pressure: None,
    semi_axes: None,
    gross_slip_displacement: 0.0,
    gross_slip_force: 0.0,
};

const STATE: State = State {
    displacement: 0.0,
    force: 0.0,
    indentation: 0.0,
    normal_force: 0.0,
    contact_radius: 0.0,
    stick_radius: 0.0,
    regime: Regime::Stick,
    dissipated_energy: 0.0,
    elastic_energy: 0.0,
    memory_depth: 0,
};
