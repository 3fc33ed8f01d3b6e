//! Simulations in the plane: by rings, or by the exact solver where all moves lead along one line.

use stickslip_mechanics::rings::{self, Options, PlanarMove, PlanarTarget, Solution};
use stickslip_mechanics::{Normal, range::Quantity};
use stickslip_wire::Solver;
use stickslip_wire::plane::{PlanarPlan, PlanarReply, PlanarState, PlanarStress, SimulationReply};

use super::run::{coulomb, refused_at, simulate};
use super::stated_accuracy::coupling_bound;
use super::warnings::{FarMove, stress_warning, warnings_at};
use crate::prelude::*;

/// Radii between two checks of the flag.
const RADII_PER_CHECK: usize = 512;

/// Runs a simulation, along a line or in the plane.
///
/// # Errors
/// [`Failure`] if the mechanics has no answer to it, or the client hung up.
pub fn simulate_any(simulation: &Simulation, stop: &dyn Stop) -> Result<SimulationReply, Failure> {
    let Plan::Plane(plane) = &simulation.plan else { return simulate(simulation, stop).map(SimulationReply::Line) };
    let reply = match plane.line {
        Some(direction) => along_line(simulation, plane, direction, stop),
        None => by_rings(simulation, plane, stop),
    };
    reply.map(SimulationReply::Plane)
}

/// By the exact solver, along the line of this direction.
fn along_line(
    simulation: &Simulation,
    plane: &PlanarPlan,
    direction: [f64; 2],
    stop: &dyn Stop,
) -> Result<PlanarReply, Failure> {
    let steps = if plane.steps_per_turn().is_some() { Steps::All } else { simulation.steps };
    let plan = Plan::Moves(plane.along(direction));
    let line = Simulation { plan, steps, ..simulation.clone() };
    let at_ellipse = |failure: Failure| {
        let moved = plane.steps_per_turn().is_some() && failure.pointer.starts_with("/path/moves");
        if moved { Failure { pointer: "/path/ellipse".to_owned(), ..failure } } else { failure }
    };
    let SimulateReply { contact, steps, stress, accuracy, warnings, .. } = simulate(&line, stop).map_err(at_ellipse)?;
    let pair = |size: f64| direction.map(|component| size * component + 0.0);
    let state = |state: &State| PlanarState {
        displacement: pair(state.displacement.unwrap_or_default()),
        force: pair(state.force.unwrap_or_default()),
        indentation: state.indentation,
        normal_force: state.normal_force,
        contact_radius: state.contact_radius,
        stick_radius: state.stick_radius,
        regime: state.regime,
        dissipated_energy: state.dissipated_energy,
        elastic_energy: state.elastic_energy,
        electrical_conductance: state.electrical_conductance,
        thermal_conductance: state.thermal_conductance,
    };
    let mut states: Vec<PlanarState> = steps.iter().map(state).collect();
    as_given(plane, &mut states);
    let losses = turn_losses(plane, states.iter().map(|state| state.dissipated_energy));
    Ok(PlanarReply {
        contact,
        steps: shown(states, simulation.steps),
        stress: stress.map(|stress| turned(stress, direction)),
        turn_losses: losses,
        accuracy,
        warnings,
    })
}

/// Stresses along a line as those of this direction.
fn turned(stress: Stress, direction: [f64; 2]) -> PlanarStress {
    let along = |values: &Option<Vec<Option<f64>>>, component: f64| {
        let scaled =
            |values: &Vec<Option<f64>>| values.iter().map(|value| value.map(|value| value * component)).collect();
        values.as_ref().map(scaled)
    };
    let [x, y] = direction;
    PlanarStress {
        shear_x: along(&stress.shear, x),
        shear_y: along(&stress.shear, y),
        slip_x: along(&stress.slip, x),
        slip_y: along(&stress.slip, y),
        friction_work: None,
        pressure: stress.pressure,
        radius: stress.radius.unwrap_or_default(),
    }
}

fn shown_state(solution: &Solution, state: &rings::PlanarState) -> PlanarState {
    let conductance = solution.pressed().conductance(state.indentation);
    PlanarState {
        electrical_conductance: conductance.electrical,
        thermal_conductance: conductance.thermal,
        ..(*state).into()
    }
}

fn by_rings(simulation: &Simulation, plane: &PlanarPlan, stop: &dyn Stop) -> Result<PlanarReply, Failure> {
    let timer = Timer::start(stop);
    let (count, reason) = match simulation.solver {
        Some(Solver::Rings(rings)) => (Some(rings.count), "as asked for; steps by the tolerance"),
        _ => (None, "the path leaves its first line or turns back within a move: rings and steps by the tolerance"),
    };
    let options = Options { count, tolerance: simulation.tolerance };
    let setup = coulomb(&simulation.setup, "motion in the plane")?;
    let solution = follow_in_plane(&setup, &simulation.plan, plane, &options, stop)?;
    let stress = simulation.stress.as_ref().map(|sampling| stresses(&solution, sampling, stop)).transpose()?;
    let summary = solution.pressed().initial_summary();
    let table = solution.pressed().accuracy();
    let force_error = solution.force_error() + table.force_error;
    let stress_error = solution.stress_error() + table.stress_error;
    let largest = solution.states.iter().map(|state| state.contact_radius).fold(summary.contact_radius, f64::max);
    let indentation = solution.states.iter().map(|state| state.indentation).fold(summary.indentation, f64::max);
    let excess = excess_error(solution.force_error(), simulation.tolerance, 1);
    let mut far = FarMove::default();
    let scale = if summary.indentation > 0.0 { summary.gross_slip_displacement / summary.indentation } else { 0.0 };
    for state in &solution.states {
        let size = state.displacement[0].hypot(state.displacement[1]);
        let gross_slip = scale * state.indentation.max(0.0);
        far.reach_to(size, gross_slip, solution.pressed().indenter(), state.contact_radius);
    }
    let warnings = warnings_at(solution.pressed(), largest, indentation, excess)
        .into_iter()
        .chain(stress_warning(simulation.stress.is_some(), stress_error))
        .chain(far.warning())
        .collect();
    let mut states: Vec<PlanarState> = solution.states.iter().map(|state| shown_state(&solution, state)).collect();
    as_given(plane, &mut states);
    let losses = turn_losses(plane, states.iter().map(|state| state.dissipated_energy));
    stop.check()?;
    Ok(PlanarReply {
        contact: summary.into(),
        steps: shown(states, simulation.steps),
        stress,
        turn_losses: losses,
        accuracy: Accuracy {
            solver: SolverKind::Rings,
            reason: reason.to_owned(),
            force_error,
            stress_error,
            coupling_bound: coupling_bound(solution.pressed()),
            work_error: Some(solution.work_error),
            count: Some(solution.count),
            steps: Some(solution.steps),
            compute_time: timer.elapsed().as_secs_f64(),
            ..Accuracy::default()
        },
        warnings,
    })
}

/// Follows a path by rings.
///
/// # Errors
/// [`Failure`] if the mechanics has no answer to it, at its move, or the client hung up.
pub fn follow_in_plane(
    setup: &SharedSetup,
    plan: &Plan,
    plane: &PlanarPlan,
    options: &Options,
    stop: &dyn Stop,
) -> Result<Solution, Failure> {
    let go_on = || stop.check().is_ok();
    rings::follow(setup.clone(), &plane.moves, options, &go_on).map_err(|refusal| {
        let rings::Refusal { index, error } = refusal;
        let Some(index) = index else { return refused_at("/contact", setup.preload)(error) };
        let named = quantity(&error).filter(|quantity| names(&plane.moves[index], *quantity));
        let at = plan.place_of(index, named);
        Failure::at(at, error).unless_interrupted(stop, &plan.place_of(index, None))
    })
}

/// Whether a move has a normal target of this quantity.
fn names(step: &PlanarMove, quantity: Quantity) -> bool {
    match step.normal {
        Some(Normal::Indentation(_)) => quantity == Quantity::Indentation,
        Some(Normal::NormalForce(_)) => quantity == Quantity::NormalForce,
        None => false,
    }
}

/// Puts targets that were given in the place of those that have been through the units of a solver. The states are
/// those after the last moves.
fn as_given(plane: &PlanarPlan, states: &mut [PlanarState]) {
    let skipped = plane.moves.len().saturating_sub(states.len());
    let given = |pair: [f64; 2]| pair.map(|component| component + 0.0);
    let mut displacement = Some([0.0; 2]);
    for (index, step) in plane.moves.iter().enumerate() {
        let mut force = None;
        match step.tangential {
            None => {}
            Some(PlanarTarget::Arc(arc)) => displacement = Some(arc.at(1.0)),
            Some(PlanarTarget::Displacement(to)) => displacement = (!step.relative).then_some(to),
            Some(PlanarTarget::Force(to)) => (displacement, force) = (None, (!step.relative).then_some(to)),
        }
        if let Some(state) = index.checked_sub(skipped).and_then(|index| states.get_mut(index)) {
            state.displacement = displacement.map_or(state.displacement, given);
            state.force = force.map_or(state.force, given);
        }
    }
}

fn shown(mut states: Vec<PlanarState>, steps: Steps) -> Vec<PlanarState> {
    if steps == Steps::Last {
        states.drain(..states.len().saturating_sub(1));
    }
    states
}

/// The friction work of each turn from that after each move.
fn turn_losses(plane: &PlanarPlan, dissipated: impl Iterator<Item = f64>) -> Option<Vec<f64>> {
    let at_ends: Vec<f64> = dissipated.step_by(plane.steps_per_turn()?).collect();
    Some(at_ends.windows(2).map(|ends| ends[1] - ends[0]).collect())
}

fn stresses(solution: &Solution, sampling: &StressRequest, stop: &dyn Stop) -> Result<PlanarStress, Failure> {
    let pressed = solution.pressed();
    let radius = sampling.places(false, if pressed.indentation() > 0.0 { pressed.contact_radius() } else { 0.0 });
    let asked = |field: Field| sampling.wants(field);
    let mut stress = PlanarStress::default();
    for radii in radius.chunks(RADII_PER_CHECK) {
        stop.check()?;
        let add = |column: &mut Option<Vec<Option<f64>>>, values: Vec<Option<f64>>| {
            column.get_or_insert_default().extend(values);
        };
        if asked(Field::Pressure) {
            add(&mut stress.pressure, pressed.pressures(radii).into_iter().map(finite).collect());
        }
        if asked(Field::Shear) {
            let shears = solution.shears(radii);
            add(&mut stress.shear_x, shears.iter().map(|shear| finite(shear[0])).collect());
            add(&mut stress.shear_y, shears.iter().map(|shear| finite(shear[1])).collect());
        }
        if asked(Field::Slip) {
            let slips: Vec<Option<[f64; 2]>> = radii.iter().map(|radius| solution.slip(*radius)).collect();
            add(&mut stress.slip_x, slips.iter().map(|slip| slip.map(|slip| slip[0])).collect());
            add(&mut stress.slip_y, slips.iter().map(|slip| slip.map(|slip| slip[1])).collect());
            let work = radii.iter().map(|radius| finite(solution.friction_work(*radius))).collect();
            add(&mut stress.friction_work, work);
        }
    }
    Ok(PlanarStress { radius, ..stress })
}
