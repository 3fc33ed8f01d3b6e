//! The tables of a contact's stress, history and loop, and of a sweep.

use std::sync::Arc;

use serde_json::Number;

use crate::simulation::SweepResult;
use stickslip_measured::scan::DRAWN_POINTS;
use stickslip_wire::cycle::CycleTask;
use stickslip_wire::fit::FittedLoop;
use stickslip_wire::sweep::{CheckedSweep, indices};
use stickslip_wire::{
    Cycle, CyclePage, CycleReply, Field, FitReply, FrettingReply, Harmonic, HistoryPage, LoopPage, ObservedForce,
    ProfileFitReply, State, SteadyCycle, StressReply, Subsurface, subsurface,
};

use super::table::{Cells, Column, Table};

/// A table whose JSON document differs from its columns.
fn flat(rows: usize, columns: Vec<Column<'_>>) -> Table<'_> {
    Table::new(rows, columns, ["{".to_owned(), "}".to_owned()])
}

/// The stresses over the radius.
#[must_use]
pub fn stress(reply: &StressReply) -> Table<'_> {
    let mut columns = vec![Column::floats("radius", "m", |row| reply.radius[row])];
    for field in Field::ALL {
        let (unit, values) = match field {
            Field::Pressure => ("Pa", &reply.pressure),
            Field::Shear => ("Pa", &reply.shear),
            Field::Slip => ("m", &reply.slip),
            Field::Displacement => ("m", &reply.displacement),
        };
        if let Some(values) = values {
            let value = |row: usize| values[row].unwrap_or(f64::NAN);
            columns.push(Column::floats(field.name(), unit, value));
        }
    }
    flat(reply.radius.len(), columns)
}

/// The stress below the surface: a row for each place.
#[must_use]
pub fn subsurface(reply: &Subsurface) -> Table<'_> {
    let mut columns = vec![
        Column::floats("x", "m", |row| reply.x[row]),
        Column::floats("y", "m", |row| reply.y[row]),
        Column::floats("z", "m", |row| reply.z[row]),
    ];
    for (name, values) in subsurface::COLUMNS.into_iter().zip(reply.columns()) {
        if let Some(values) = values {
            columns.push(Column::floats(name, "Pa", |row| values[row].unwrap_or(f64::NAN)));
        }
    }
    flat(reply.x.len(), columns)
}

/// Fatigue criteria: a row for each place.
#[must_use]
pub fn fretting(reply: &FrettingReply) -> Table<'_> {
    let mut columns = vec![
        Column::floats("x", "m", |row| reply.x[row]),
        Column::floats("y", "m", |row| reply.y[row]),
        Column::floats("z", "m", |row| reply.z[row]),
    ];
    for (name, unit, rating) in reply.ratings() {
        columns.push(Column::floats(name, unit, |row| rating.values[row].unwrap_or(f64::NAN)));
    }
    flat(reply.x.len(), columns)
}

/// Rows of a fitted scan, at most.
pub const SCAN_ROWS: usize = 3 * DRAWN_POINTS;

/// The points of a scan and of the profile that was fitted to it.
#[must_use]
pub fn profile_fit(reply: &ProfileFitReply) -> Table<'_> {
    let parts = [("fitted", &reply.raw), ("left_out", &reply.left_out), ("profile", &reply.used)];
    let of = move |mut row: usize| {
        for (name, columns) in parts {
            if row < columns.radius.len() {
                return (name, columns.radius[row], columns.height[row]);
            }
            row -= columns.radius.len();
        }
        ("", f64::NAN, f64::NAN)
    };
    let columns = vec![
        Column::new("part", Some(""), Cells::Words(Box::new(move |row| of(row).0))),
        Column::floats("radius", "m", move |row| of(row).1),
        Column::floats("height", "m", move |row| of(row).2),
    ];
    flat(parts.iter().map(|(_, columns)| columns.radius.len()).sum(), columns)
}

/// The points of measured loops, with what was fitted to them.
#[must_use]
pub fn loop_fit(reply: &FitReply) -> Table<'_> {
    let at = |mut row: usize| {
        let mut loops = reply.curve.iter().enumerate();
        loops.find_map(|(index, curve)| match row.checked_sub(curve.force.len()) {
            None => Some((index, curve, row)),
            Some(rest) => {
                row = rest;
                None
            }
        })
    };
    let value = |name, unit, of: fn(&FittedLoop, usize) -> f64| {
        Column::floats(name, unit, move |row| at(row).map_or(f64::NAN, |(_, curve, point)| of(curve, point)))
    };
    let columns = vec![
        Column::counts("loop", move |row| at(row).map_or(0, |(index, ..)| index as u64)),
        value("displacement", "m", |curve, point| curve.displacement[point]),
        value("measured", "N", |curve, point| curve.measured[point]),
        value("fitted", "N", |curve, point| curve.force[point]),
        value("residual", "N", |curve, point| curve.measured[point] - curve.force[point]),
        Column::counts("used", move |row| at(row).map_or(0, |(_, curve, point)| u64::from(curve.used[point]))),
    ];
    flat(reply.curve.iter().map(|curve| curve.force.len()).sum(), columns)
}

/// A page of a history: the states with their numbers and times, and who made them if `names_makers`.
#[must_use]
pub fn history(page: &HistoryPage, names_makers: bool) -> Table<'_> {
    let items = &page.items;
    let state = |name, unit, of: fn(&State) -> f64| Column::floats(name, unit, move |row| of(&items[row].state));
    let cycle = |name, unit, of: fn(&Cycle) -> Option<f64>| {
        let value = move |row: usize| items[row].cycle.as_ref().and_then(of).unwrap_or(f64::NAN);
        Column::floats(name, unit, value)
    };
    let observed = |name, of: fn(&ObservedForce) -> f64| {
        Column::floats(name, "N", move |row| items[row].observation.as_ref().map_or(f64::NAN, of))
    };
    let mut columns = vec![
        Column::counts("sequence", |row| items[row].sequence),
        Column::new("at", Some("UTC"), Cells::Times(Box::new(|row| items[row].at))),
        state("displacement", "m", |state| state.displacement),
        state("force", "N", |state| state.force),
        state("indentation", "m", |state| state.indentation),
        state("normal_force", "N", |state| state.normal_force),
        state("contact_radius", "m", |state| state.contact_radius),
        state("stick_radius", "m", |state| state.stick_radius),
        Column::new("regime", Some(""), Cells::Words(Box::new(|row| items[row].state.regime.name()))),
        state("dissipated_energy", "J", |state| state.dissipated_energy),
        state("elastic_energy", "J", |state| state.elastic_energy),
        Column::counts("memory_depth", |row| items[row].state.memory_depth as u64),
        Column::new(
            "cycle_from",
            Some("1"),
            Cells::SomeCounts(Box::new(|row| items[row].cycle.as_ref().map(|cycle| cycle.from))),
        ),
        cycle("cycle_displacement_amplitude", "m", |cycle| Some(cycle.displacement_amplitude)),
        cycle("cycle_force_amplitude", "N", |cycle| Some(cycle.force_amplitude)),
        cycle("cycle_dissipated_energy", "J", |cycle| Some(cycle.dissipated_energy)),
        cycle("cycle_secant_stiffness", "N/m", |cycle| cycle.secant_stiffness),
        cycle("cycle_sliding_ratio", "1", |cycle| cycle.sliding_ratio),
        observed("observed_force", |observed| observed.force),
        observed("predicted_force", |observed| observed.predicted),
        observed("innovation", |observed| observed.innovation),
    ];
    if names_makers {
        columns.push(Column::new("by", Some(""), Cells::SomeNames(Box::new(|row| items[row].by.as_deref()))));
    }
    flat(items.len(), columns)
}

/// A page of a hysteresis loop.
#[must_use]
pub fn hysteresis_loop(page: &LoopPage) -> Table<'_> {
    let observed = |name, of: fn(&ObservedForce) -> f64| {
        let at = |row: usize| page.observed_force(row).map(|force| ObservedForce::new(force, page.force[row], None));
        Column::floats(name, "N", move |row| at(row).as_ref().map_or(f64::NAN, of))
    };
    let columns = vec![
        Column::counts("sequence", |row| page.sequence[row]),
        Column::floats("part", "1", |row| page.part[row]),
        Column::floats("displacement", "m", |row| page.displacement[row]),
        Column::floats("force", "N", |row| page.force[row]),
        observed("observed_force", |observed| observed.force),
        observed("predicted_force", |observed| observed.predicted),
        observed("innovation", |observed| observed.innovation),
    ];
    flat(page.sequence.len(), columns)
}

/// The closed cycles.
#[must_use]
pub fn cycles(page: &CyclePage) -> Table<'_> {
    let items = &page.items;
    let value = |name, unit, of: fn(&Cycle) -> f64| Column::floats(name, unit, move |row| of(&items[row]));
    let columns = vec![
        Column::counts("from", |row| items[row].from),
        Column::counts("to", |row| items[row].to),
        value("displacement_amplitude", "m", |cycle| cycle.displacement_amplitude),
        value("force_amplitude", "N", |cycle| cycle.force_amplitude),
        value("dissipated_energy", "J", |cycle| cycle.dissipated_energy),
        value("secant_stiffness", "N/m", |cycle| cycle.secant_stiffness.unwrap_or(f64::NAN)),
        value("sliding_ratio", "1", |cycle| cycle.sliding_ratio.unwrap_or(f64::NAN)),
    ];
    flat(items.len(), columns)
}

/// Steady cycles: a row for each amplitude.
#[must_use]
pub fn cycle<'a>(reply: &'a CycleReply, task: &CycleTask) -> Table<'a> {
    let cycles = &reply.cycles;
    let column = |name, unit, of: fn(&SteadyCycle) -> f64| Column::floats(name, unit, move |row| of(&cycles[row]));
    let maybe = |number: Option<f64>| number.unwrap_or(f64::NAN);
    let mut columns = vec![
        column("displacement_amplitude", "m", |cycle| cycle.displacement_amplitude),
        column("force_amplitude", "N", |cycle| cycle.force_amplitude),
        column("dissipated_energy", "J", |cycle| cycle.dissipated_energy),
        column("max_elastic_energy", "J", |cycle| cycle.max_elastic_energy),
        column("secant_stiffness", "N/m", |cycle| cycle.secant_stiffness),
        column("tangent_stiffness", "N/m", |cycle| cycle.tangent_stiffness),
        Column::floats("loss_factor", "1", move |row| maybe(cycles[row].loss_factor)),
        Column::floats("sliding_ratio", "1", move |row| maybe(cycles[row].sliding_ratio)),
        column("stick_radius", "m", |cycle| cycle.stick_radius),
        Column::new("regime", Some(""), Cells::Words(Box::new(|row| cycles[row].regime.name()))),
    ];
    if task.stiffness.is_some() {
        let amplitude = Column::floats("machine_amplitude", "m", move |row| maybe(cycles[row].machine_amplitude));
        columns.insert(2, amplitude);
    }
    if task.map.is_some() {
        let load = Column::floats("normal_force", "N", move |row| maybe(cycles[row].normal_force));
        let limit = move |row: usize| maybe(cycles[row].gross_slip_displacement);
        columns.splice(0..0, [load, Column::floats("gross_slip_displacement", "m", limit)]);
    }
    let unit = if task.is_force_driven() { "m" } else { "N" };
    for index in 0..task.harmonics {
        let part = |of: fn(&Harmonic) -> f64| {
            move |row: usize| maybe(cycles[row].harmonics.as_deref().and_then(|all| all.get(index)).map(of))
        };
        let order = index + 1;
        columns.push(Column::floats(&format!("in_phase_{order}"), unit, part(|harmonic| harmonic.in_phase)));
        columns.push(Column::floats(&format!("quadrature_{order}"), unit, part(|harmonic| harmonic.quadrature)));
    }
    flat(cycles.len(), columns)
}

/// The table of a sweep: a row for each point, with the values of its axes and its outputs.
#[must_use]
pub fn sweep(sweep: &CheckedSweep, SweepResult { values, failed, failures }: SweepResult) -> Table<'static> {
    let (axes, values) = (Arc::new(sweep.axes.clone()), Arc::new(values));
    let (request, count) = (&sweep.request, sweep.outputs.len());
    let mut columns = Vec::with_capacity(axes.len() + count);
    for (index, axis) in request.axes.iter().enumerate() {
        let axes = Arc::clone(&axes);
        let value = move |row| indices(&axes, row).nth(index).map(|(axis, index)| axis.number(index));
        columns.push(Column::new(axis.column(), None, Cells::Numbers(Box::new(value))));
    }
    for (index, output) in request.outputs.iter().enumerate() {
        let values = Arc::clone(&values);
        let value = move |row| values.get(row * count + index).and_then(|value| Number::from_f64(*value));
        columns.push(Column::new(output.column(), None, Cells::Numbers(Box::new(value))));
    }
    let failures = serde_json::to_string(&failures).unwrap_or_else(|_| "[]".to_owned());
    let before = format!("{{\"points\":{},\"columns\":{{", sweep.points);
    Table::new(sweep.points, columns, [before, format!("}},\"failed\":{failed},\"failures\":{failures}}}")])
}
