//! The part of a simulation that a table or a picture shows: states, stresses, or extrema of the shear stress.

use stickslip_report::plot::{Axis, Colour, Curve, Panel, Plot};
use stickslip_wire::simulate::Simulation;
use stickslip_wire::{Fault, Field, SimulateReply, State, Stress};

use super::{Choice, Shown, residual, stress};
use crate::formats::{Cells, Column, Table};

/// Which part is shown.
pub const SHOW: Choice = Choice {
    name: "show",
    description: "Which part of the document a format other than `columns` shows: the states along the path (`steps`), \
                  the stresses over the radius (`stress`), or the extrema of the shear stress (`residual`).",
    words: &["steps", "stress", "residual"],
};

/// What is asked for, in the order in which it is shown if the query names nothing.
fn part(shown: &Shown, has_residual: bool, has_stress: bool) -> &'static str {
    shown.choice.unwrap_or(match (has_residual, has_stress) {
        (true, _) => "residual",
        (false, true) => "stress",
        (false, false) => "steps",
    })
}

/// Refuses a part that the request does not ask for.
///
/// # Errors
/// The [`Fault`].
pub fn check(task: &Simulation, shown: &Shown) -> Result<(), Fault> {
    let part = part(shown, task.residual, task.stress.is_some());
    let is_asked = match part {
        "residual" => task.residual,
        "stress" => task.stress.is_some(),
        _ => true,
    };
    let fault = || Fault { pointer: "/show".to_owned(), detail: format!("the body does not ask for `{part}`") };
    if is_asked { Ok(()) } else { Err(fault()) }
}

/// A row for each state, radius or extremum.
pub fn table<'a>(reply: &'a SimulateReply, shown: &Shown) -> Option<Table<'a>> {
    match part(shown, reply.residual.is_some(), reply.stress.is_some()) {
        "residual" => reply.residual.as_ref().map(residual::table),
        "stress" => reply.stress.as_ref().map(|stress| stress::table(&stress.radius, fields(stress))),
        _ => Some(states(&reply.steps)),
    }
}

fn fields(stress: &Stress) -> [&stress::Values; 4] {
    [&stress.pressure, &stress.shear, &stress.slip, &stress.displacement]
}

/// A row for each state, with the columns of a history.
fn states(steps: &[State]) -> Table<'_> {
    let state = |name, unit, of: fn(&State) -> f64| Column::floats(name, unit, move |row| of(&steps[row]));
    let columns = vec![
        state("displacement", "m", |state| state.displacement),
        state("force", "N", |state| state.force),
        state("indentation", "m", |state| state.indentation),
        state("normal_force", "N", |state| state.normal_force),
        state("contact_radius", "m", |state| state.contact_radius),
        state("stick_radius", "m", |state| state.stick_radius),
        Column::new("regime", Some(""), Cells::Words(Box::new(|row| steps[row].regime.name()))),
        state("dissipated_energy", "J", |state| state.dissipated_energy),
        state("elastic_energy", "J", |state| state.elastic_energy),
        Column::counts("memory_depth", |row| steps[row].memory_depth as u64),
    ];
    Table::flat(steps.len(), columns)
}

/// Force over displacement, the stresses over the radius, or the extrema.
pub fn plot(reply: &SimulateReply, shown: &Shown) -> Option<Plot> {
    match part(shown, reply.residual.is_some(), reply.stress.is_some()) {
        "residual" => {
            let between = reply.stress.as_ref().map_or_else(Vec::new, |stress| points(stress, &stress.shear));
            let title = "Residual stress at the end of the path".to_owned();
            reply.residual.as_ref().map(|found| residual::plot(title, found, between))
        }
        "stress" => reply.stress.as_ref().map(stresses),
        _ => Some(loop_of(&reply.steps)),
    }
}

fn points(stress: &Stress, values: &stress::Values) -> Vec<(f64, f64)> {
    let values = values.iter().flatten().map(|value| value.unwrap_or(f64::NAN));
    stress.radius.iter().copied().zip(values).collect()
}

/// A panel for each unit.
fn stresses(stress: &Stress) -> Plot {
    let panel = |name, unit| {
        let colours = [Colour::Grey, Colour::Blue, Colour::Red, Colour::Blue];
        let drawn = Field::ALL.into_iter().zip(fields(stress)).zip(colours);
        let curves: Vec<Curve> = drawn
            .filter(|((field, values), _)| stress::unit(*field) == unit && values.is_some())
            .map(|((field, values), colour)| Curve {
                name: field.name(),
                points: points(stress, values),
                colour,
                silent: false,
                dots: false,
            })
            .collect();
        (!curves.is_empty()).then_some(Panel { y: Axis { name, unit: Some(unit) }, curves })
    };
    Plot {
        title: "Stresses at the end of the path".to_owned(),
        x: Axis { name: "radius r", unit: Some("m") },
        panels: [panel("stress", "Pa"), panel("displacement", "m")].into_iter().flatten().collect(),
        bands: Vec::new(),
    }
}

fn loop_of(steps: &[State]) -> Plot {
    let points: Vec<_> = steps.iter().map(|state| (state.displacement, state.force)).collect();
    let curve = |dots| Curve { name: "", points: points.clone(), colour: Colour::Blue, silent: true, dots };
    Plot {
        title: "States along the path".to_owned(),
        x: Axis { name: "displacement U", unit: Some("m") },
        panels: vec![Panel {
            y: Axis { name: "tangential force F", unit: Some("N") },
            curves: vec![curve(false), curve(true)],
        }],
        bands: Vec::new(),
    }
}
