//! `/contacts/{id}/loop`: the tangential force over the displacement, or the torque over the angle of twist,
//! along the moves of a contact.

use stickslip_plot::{Axis, Colour, Plot};
use stickslip_wire::{HistoryPage, LoopPage, ObservedForce, limits};

use super::move_series::{self, ITEM_BYTES, MoveSeries, MovesQuery};
use super::prelude::*;
use crate::admission::Reservation;
use crate::sessions::{bytes_of_trace, trace};
use stickslip_compute::formats::{Column, Table};

/// Points for each move in a picture, at least.
const DRAWN_POINTS: usize = 32;

parameters! {
    /// How a loop is traced.
    pub struct LoopQuery {
        /// Points for each move, evenly spaced in the quantity that the move prescribes. With 1 they are the recorded
        /// states; with more, the moves are repeated in small steps on a copy of the contact. A picture has at least
        /// 32.
        points_per_move: usize = count(&limits::LOOP_POINTS), or 1;
        ..formats(&Format::ALL, "")
    }
}

/// Get the hysteresis loop of a contact
///
/// Tangential force and displacement along moves, or torque and angle of twist, oldest first: a page, the newest, or
/// all of them.
#[utoipa::path(
    get, path = "/contacts/{id}/loop", tag = "contacts", params(ContactPath, MovesQuery, LoopQuery),
    responses((status = 200, description = "A page of the loop", body = LoopPage,
        headers(
            ("ETag" = String, description = "The version of this page, in quotes"),
            ("Link" = String, description = "The URL of the next page (`rel=\"next\"`), if there is one"))))
)]
pub async fn get_loop(
    ContactPath { app, id, context }: ContactPath,
    headers: HeaderMap,
    CheckedQuery((moves, query)): CheckedQuery<(MovesQuery, LoopQuery)>,
) -> Result<Response, Problem> {
    let LoopQuery { points_per_move, format } = query;
    let format = format?;
    // A straight line between recorded states would not be the loop.
    let points_per_move = if format.is_plot() { points_per_move.max(DRAWN_POINTS) } else { points_per_move };
    move_series::reply(app, context, id, &headers, moves, format, Loop { points_per_move }).await
}

/// Force and displacement along moves.
#[derive(Clone)]
struct Loop {
    points_per_move: usize,
}

impl MoveSeries for Loop {
    type Page = LoopPage;

    const NAME: &'static str = "loop";

    fn bytes(&self, moves: usize) -> usize {
        moves * ITEM_BYTES + bytes_of_trace(moves * self.points_per_move)
    }

    fn parameters(&self) -> String {
        if self.points_per_move == 1 { String::new() } else { format!("&points_per_move={}", self.points_per_move) }
    }

    async fn page(
        &self,
        app: &App,
        id: Uuid,
        after: u64,
        moves: HistoryPage,
        _: Format,
        memory: &mut Reservation,
    ) -> Result<LoopPage, Problem> {
        let page = trace(&app.sessions, id, after, &moves.items, self.points_per_move, memory).await?;
        Ok(LoopPage { next: moves.next, ..page })
    }

    fn plot(page: &LoopPage) -> Plot {
        let twists = !page.twist.is_empty();
        let (x, y) = if twists { (&page.twist, &page.torque) } else { (&page.displacement, &page.force) };
        let points = x.iter().zip(y).filter_map(|(x, y)| (*x).zip(*y));
        let moves = move_series::shown(page.sequence.iter().copied().filter(|number| *number > 0));
        Plot::new(
            format!("Hysteresis loop{moves}"),
            if twists { Axis::of("angle of twist ω", "rad") } else { Axis::of("displacement U", "m") },
            vec![if twists {
                move_series::curve("torque M", "N·m", Colour::Blue, points)
            } else {
                move_series::curve("tangential force F", "N", Colour::Blue, points)
            }],
        )
    }

    fn table<'a>(&self, page: &'a LoopPage) -> Table<'a> {
        let observed = |name, of: fn(&ObservedForce) -> f64| {
            let at = |row: usize| {
                let observed = page.observed_force(row).zip(page.force[row]);
                observed.map(|(force, predicted)| ObservedForce::new(force, predicted, None))
            };
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
            Column::floats("twist", "rad", |row| page.twist.get(row).copied().flatten()),
            Column::floats("torque", "N·m", |row| page.torque.get(row).copied().flatten()),
        ];
        Table::flat(page.sequence.len(), columns)
    }
}
