//! `/contacts/{id}/cycles`: the closed cycles of a contact's past.

use stickslip_plot::{Axis, Colour, Drawing, Plot};
use stickslip_wire::{Cycle, CyclePage, limits};

use super::move_series::curve;
use super::prelude::*;
use crate::admission::Deadline;
use stickslip_compute::Stop as _;
use stickslip_compute::formats::{CAPACITY, Column, Table};
use stickslip_compute::simulation::bytes::OBJECT;

parameters! {
    pub struct CyclesQuery {
        /// Largest number of the newest cycles.
        last: usize = count(&limits::CYCLES), or DEFAULT_PAGE;
        ..formats(&Format::ALL, "")
    }
}

/// Get the cycles of a contact
///
/// The newest closed cycles of the displacement of the contact, oldest first.
#[utoipa::path(
    get, path = "/contacts/{id}/cycles", tag = "contacts", params(ContactPath, CyclesQuery),
    responses((status = 200, description = "The newest cycles", body = CyclePage,
        headers(("ETag" = String, description = "The sequence that they belong to, in quotes"))))
)]
pub async fn get_cycles(
    ContactPath { app, id, context }: ContactPath,
    headers: HeaderMap,
    CheckedQuery(query): CheckedQuery<CyclesQuery>,
) -> Result<Response, Problem> {
    let (last, format) = (query.last, query.format?);
    if let Some(unchanged) = computations::unchanged(&app, id, &headers, format).await? {
        return Ok(unchanged);
    }
    context.reserve(last * OBJECT + format.bytes(0, 0)).await?;
    let (sequence, page) = app.sessions.cycles(id, last, &mut context.admission.memory.clone()).await?;
    let write = move |stop: &Deadline| {
        let (plot, table) = (|| Some(Drawing::Plot(plot(&page))), || Some(table(&page)));
        format.write(CAPACITY, &page, &plot, &table, &|| stop.check().is_ok())
    };
    let body = context.run(format.cost(), write).await??;
    let tag = formats::tag(format, &sequence.to_string());
    Ok(reply::tagged(formats::reply(format, body), &tag))
}

/// Amplitudes, friction work and stiffness of the cycles over the moves that closed them.
fn plot(page: &CyclePage) -> Plot {
    let panel = |name, unit, colour, of: fn(&Cycle) -> f64| {
        curve(name, unit, colour, page.items.iter().map(|cycle| (cycle.to as f64, of(cycle))))
    };
    Plot::new(
        if page.items.is_empty() { "No closed cycles" } else { "Closed cycles" },
        Axis { name: "move", unit: None },
        vec![
            panel("amplitude U₀", "m", Colour::Blue, |cycle| cycle.displacement_amplitude),
            panel("amplitude F₀", "N", Colour::Blue, |cycle| cycle.force_amplitude),
            panel("friction work", "J", Colour::Red, |cycle| cycle.dissipated_energy),
            panel("secant stiffness", "N/m", Colour::Blue, |cycle| cycle.secant_stiffness.unwrap_or(f64::NAN)),
        ],
    )
}

fn table(page: &CyclePage) -> Table<'_> {
    let items = &page.items;
    let value = |name, unit, of: fn(&Cycle) -> Option<f64>| Column::floats(name, unit, move |row| of(&items[row]));
    let columns = vec![
        Column::counts("from", |row| items[row].from),
        Column::counts("to", |row| items[row].to),
        value("displacement_amplitude", "m", |cycle| Some(cycle.displacement_amplitude)),
        value("force_amplitude", "N", |cycle| Some(cycle.force_amplitude)),
        value("dissipated_energy", "J", |cycle| Some(cycle.dissipated_energy)),
        value("secant_stiffness", "N/m", |cycle| cycle.secant_stiffness),
        value("sliding_ratio", "1", |cycle| cycle.sliding_ratio),
    ];
    Table::flat(items.len(), columns)
}
