//! The tables of the pages of a contact: its history, loop and closed cycles.

use crate::computations::state_columns;
use crate::formats::{Cells, Column, Table};
use stickslip_wire::{Cycle, CyclePage, HistoryPage, LoopPage, ObservedForce};

/// A page of a history: the states with their numbers and times, and who made them if `names_makers`.
#[must_use]
pub fn history(page: &HistoryPage, names_makers: bool) -> Table<'_> {
    let items = &page.items;
    let cycle = |name, unit, of: fn(&Cycle) -> Option<f64>| {
        Column::floats(name, unit, move |row| items[row].cycle.as_ref().and_then(of))
    };
    let observed = |name, of: fn(&ObservedForce) -> f64| {
        Column::floats(name, "N", move |row| items[row].observation.as_ref().map(of))
    };
    let mut columns = vec![
        Column::counts("sequence", |row| items[row].sequence),
        Column::new("at", Some("UTC"), Cells::Times(Box::new(|row| items[row].at))),
    ];
    columns.extend(state_columns(|row| &items[row].state));
    columns.extend([
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
    ]);
    if names_makers {
        columns.push(Column::new("by", Some(""), Cells::SomeNames(Box::new(|row| items[row].by.as_deref()))));
    }
    Table::flat(items.len(), columns)
}

/// A page of a hysteresis loop.
#[must_use]
pub fn hysteresis_loop(page: &LoopPage) -> Table<'_> {
    let observed = |name, of: fn(&ObservedForce) -> f64| {
        let at = |row: usize| page.observed_force(row).map(|force| ObservedForce::new(force, page.force[row], None));
        Column::floats(name, "N", move |row| at(row).as_ref().map(of))
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
    Table::flat(page.sequence.len(), columns)
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
    Table::flat(items.len(), columns)
}
