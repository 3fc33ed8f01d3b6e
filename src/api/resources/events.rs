//! `/contacts/{id}/events`: each new state of a session, as it comes.

use axum::response::sse::{Event, KeepAlive, Sse};
use futures::{Stream, StreamExt as _};
use utoipa::IntoParams;

use crate::store::StreamEvent;
use stickslip_wire::{EndEvent, StateEvent};

use crate::api::extract::{ContactId, LastEventId};
use crate::api::limits::KEEP_ALIVE;
use crate::api::openapi::ContactPath;
use crate::api::problem::Problem;
use crate::api::query::Params;
use crate::api::state::TenantApp;

/// Where to go on.
#[derive(IntoParams)]
#[into_params(parameter_in = Header)]
#[expect(dead_code, reason = "described here, read by `LastEventId`")]
pub struct Seen {
    /// The sequence of the last event that has been seen. The events begin with the next, none left out; without it, they
    /// begin with the present state.
    #[param(rename = "Last-Event-ID", nullable = false)]
    last_event_id: Option<u64>,
}

/// Follow a contact
///
/// Server-sent events: an event `state` for each move, whose `id` is the sequence, in order and without a gap. A browser's
/// `EventSource` resumes by itself where it was cut off. The last event is `end` (its data an `EndEvent`), when the contact
/// is deleted or has expired, or the server stops; comments keep an idle connection open.
#[utoipa::path(
    get, path = "/contacts/{id}/events", tag = "contacts", params(ContactPath, Seen),
    responses((status = 200, description = "The states; the schema is that of one event",
        content_type = "text/event-stream", body = StateEvent))
)]
pub async fn events(
    TenantApp(app): TenantApp,
    ContactId(id): ContactId,
    LastEventId(after): LastEventId,
    params: Params,
) -> Result<Sse<impl Stream<Item = Result<Event, axum::Error>>>, Problem> {
    params.none()?;
    let events = app.sessions.events(id, after).await?.map(|event| match event {
        StreamEvent::State(state) => Event::default().id(state.sequence.to_string()).event("state").json_data(state),
        // Without an identifier, so that a client that comes back goes on where it was.
        StreamEvent::End(reason) => Event::default().event("end").json_data(EndEvent { reason }),
    });
    Ok(Sse::new(events).keep_alive(KeepAlive::new().interval(KEEP_ALIVE)))
}
