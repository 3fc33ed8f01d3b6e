//! `/contacts/{id}/history`: the moves that a contact has made.

use stickslip_plot::{Axis, Colour, Plot};
use stickslip_wire::{Cycle, HistoryPage, ObservedForce, State};

use super::move_series::{self, ITEM_BYTES, MoveSeries, MovesQuery, curve};
use super::prelude::*;
use crate::admission::Reservation;
use crate::api::query_parameters::flag;
use stickslip_compute::computations::{columns_of_some_states, state_columns};
use stickslip_compute::formats::{Cells, Column, Table};

parameters! {
    /// What a history has of each move.
    pub struct HistoryQuery {
        /// Whether to add to each move the cycle that it closed. This also reads the moves before the page, once.
        cycles: bool = flag(), or true;
        ..formats(&Format::ALL, "")
    }
}

/// Get the history of a contact
///
/// Moves with the states after them and the cycles that they closed, oldest first: a page, the newest, or all of them.
#[utoipa::path(
    get, path = "/contacts/{id}/history", tag = "contacts", params(ContactPath, MovesQuery, HistoryQuery),
    responses((status = 200, description = "A page of moves", body = HistoryPage,
        headers(
            ("ETag" = String, description = "The version of this page, in quotes"),
            ("Link" = String, description = "The URL of the next page (`rel=\"next\"`), if there is one"))))
)]
pub async fn get_history(
    ContactPath { app, id, context }: ContactPath,
    headers: HeaderMap,
    CheckedQuery((moves, query)): CheckedQuery<(MovesQuery, HistoryQuery)>,
) -> Result<Response, Problem> {
    let HistoryQuery { cycles, format } = query;
    let shown = History { cycles, names_makers: app.sessions.names_makers() };
    move_series::reply(app, context, id, &headers, moves, format?, shown).await
}

/// Moves with the states after them.
#[derive(Clone)]
struct History {
    /// Whether the cycles that they closed are marked.
    cycles: bool,
    names_makers: bool,
}

impl MoveSeries for History {
    type Page = HistoryPage;

    const NAME: &'static str = "history";

    fn bytes(&self, moves: usize) -> usize {
        moves * ITEM_BYTES
    }

    fn parameters(&self) -> String {
        if self.cycles { String::new() } else { "&cycles=false".to_owned() }
    }

    async fn page(
        &self,
        app: &App,
        id: Uuid,
        _: u64,
        mut moves: HistoryPage,
        format: Format,
        memory: &mut Reservation,
    ) -> Result<HistoryPage, Problem> {
        match self.cycles {
            _ if format.is_plot() => {}
            true => app.sessions.mark_cycles(id, &mut moves, memory).await?,
            false => app.sessions.mark_centres(id, &mut moves).await?,
        }
        Ok(moves)
    }

    /// Displacement and force, or of a contact that is twisted angle and torque, and friction work over the moves.
    fn plot(page: &HistoryPage) -> Plot {
        let panel = |name, unit, colour, of: fn(&State) -> Option<f64>| {
            let points = page.items.iter().filter_map(|item| Some((item.sequence as f64, of(&item.state)?)));
            curve(name, unit, colour, points)
        };
        let first = if page.items.last().is_some_and(|item| item.state.twist.is_some()) {
            let twist = panel("twist", "rad", Colour::Blue, |state| state.twist);
            [twist, panel("torque", "N·m", Colour::Blue, |state| state.torque)]
        } else {
            let displacement = panel("displacement", "m", Colour::Blue, |state| state.displacement);
            [displacement, panel("force", "N", Colour::Blue, |state| state.force)]
        };
        let work = panel("friction work", "J", Colour::Red, |state| Some(state.dissipated_energy));
        Plot::new(
            format!("History{}", move_series::shown(page.items.iter().map(|item| item.sequence))),
            Axis { name: "move", unit: None },
            first.into_iter().chain([work]).collect(),
        )
    }

    /// The states with their numbers and times, the cycles that they closed, and who made them.
    fn table<'a>(&self, page: &'a HistoryPage) -> Table<'a> {
        let items = &page.items;
        let cycle = |name, unit, of: fn(&Cycle) -> Option<f64>| {
            Column::floats(name, unit, move |row| items[row].cycle.as_ref().and_then(of))
        };
        let observed = |name, of: fn(&ObservedForce) -> f64| {
            Column::floats(name, "N", move |row| items[row].observation.as_ref().map(of))
        };
        let cycle_from = |row: usize| items[row].cycle.as_ref().map(|cycle| cycle.from);
        let mut columns = vec![
            Column::counts("sequence", |row| items[row].sequence),
            Column::new("at", Some("UTC"), Cells::Times(Box::new(|row| Some(items[row].at)))),
        ];
        columns.extend(state_columns(|row| &items[row].state));
        columns.extend([
            Column::new("cycle_from", Some("1"), Cells::Counts(Box::new(cycle_from))),
            cycle("cycle_displacement_amplitude", "m", |cycle| Some(cycle.displacement_amplitude)),
            cycle("cycle_force_amplitude", "N", |cycle| Some(cycle.force_amplitude)),
            cycle("cycle_dissipated_energy", "J", |cycle| Some(cycle.dissipated_energy)),
            cycle("cycle_secant_stiffness", "N/m", |cycle| cycle.secant_stiffness),
            cycle("cycle_sliding_ratio", "1", |cycle| cycle.sliding_ratio),
            observed("observed_force", |observed| observed.force),
            observed("predicted_force", |observed| observed.predicted),
            observed("innovation", |observed| observed.innovation),
        ]);
        let first = items.first().map(|item| &item.state);
        columns.extend(columns_of_some_states(first, true, |row| &items[row].state));
        if self.names_makers {
            columns.push(Column::new("by", Some(""), Cells::Words(Box::new(|row| items[row].by.as_deref()))));
        }
        Table::flat(items.len(), columns)
    }
}
