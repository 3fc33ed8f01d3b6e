//! The part of a simulation that a table or a picture shows: states, stresses, or extrema of the shear stress.

use stickslip_report::plot::{Axis, Colour, Curve, Panel, Plot};
use stickslip_wire::simulate::Simulation;
use stickslip_wire::{Fault, Field, SimulateReply, State, Stress};

use super::{Choice, Shown, residual, stress};
use crate::formats::{Column, Table};

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

/// A row for each state.
fn states(steps: &[State]) -> Table<'_> {
    Table::flat(steps.len(), state_columns(|row| &steps[row]).into())
}

/// The columns of a state by its row.
pub fn state_columns<'a>(state: impl Fn(usize) -> &'a State + Copy + Send + 'a) -> [Column<'a>; 10] {
    let floats = |name, unit, of: fn(&State) -> f64| Column::floats(name, unit, move |row| of(state(row)));
    [
        floats("displacement", "m", |state| state.displacement),
        floats("force", "N", |state| state.force),
        floats("indentation", "m", |state| state.indentation),
        floats("normal_force", "N", |state| state.normal_force),
        floats("contact_radius", "m", |state| state.contact_radius),
        floats("stick_radius", "m", |state| state.stick_radius),
        Column::words("regime", move |row| state(row).regime.name()),
        floats("dissipated_energy", "J", |state| state.dissipated_energy),
        floats("elastic_energy", "J", |state| state.elastic_energy),
        Column::counts("memory_depth", move |row| state(row).memory_depth as u64),
    ]
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
        let of_unit = drawn.filter(|((field, values), _)| stress::unit(*field) == unit && values.is_some());
        let curves: Vec<_> = of_unit
            .map(|((field, values), colour)| Curve::line(field.name(), colour, points(stress, values)))
            .collect();
        (!curves.is_empty()).then_some(Panel { y: Axis::of(name, unit), curves })
    };
    let panels = [panel("stress", "Pa"), panel("displacement", "m")].into_iter().flatten().collect();
    Plot::new("Stresses at the end of the path", Axis::of("radius r", "m"), panels)
}

fn loop_of(steps: &[State]) -> Plot {
    let points = || steps.iter().map(|state| (state.displacement, state.force));
    let curves = vec![Curve::line("", Colour::Blue, points()), Curve::dots("", Colour::Blue, points())];
    let panel = Panel { y: Axis::of("tangential force F", "N"), curves };
    Plot::new("States along the path", Axis::of("displacement U", "m"), vec![panel])
}
