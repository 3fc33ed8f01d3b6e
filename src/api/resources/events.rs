//! `/contacts/{id}/events`: each new state of a contact, as a server-sent event.

use axum::response::sse::{Event, KeepAlive, Sse};
use futures::{Stream, StreamExt as _};

use crate::api::limits::KEEP_ALIVE;
use crate::api::params::{ContactPath, LastEventId};
use crate::api::problem::Problem;
use crate::api::query::CheckedQuery;
use crate::api::state::TenantApp;
use crate::store::StreamEvent;
use stickslip_wire::{EndEvent, StateEvent};

/// Watch a contact
///
/// Server-sent events: an event `state` for each move, whose `id` is the sequence, in order and without a gap. A
/// browser's `EventSource` resumes by itself after an interruption. The last event is `end` (its data an `EndEvent`),
/// when the contact is deleted or expires, or the server stops. Comments keep an idle connection open.
#[utoipa::path(
    get, path = "/contacts/{id}/events", tag = "contacts", params(ContactPath, LastEventId),
    responses((status = 200, description = "The states; the schema is that of one event",
        content_type = "text/event-stream", body = StateEvent))
)]
pub async fn watch_contact(
    TenantApp(app): TenantApp,
    ContactPath { id }: ContactPath,
    LastEventId { sequence }: LastEventId,
    _: CheckedQuery<()>,
) -> Result<Sse<impl Stream<Item = Result<Event, axum::Error>>>, Problem> {
    let events = app.sessions.events(id, sequence).await?.map(|happening| match happening {
        StreamEvent::State(state) => Event::default().id(state.sequence.to_string()).event("state").json_data(state),
        // Without an identifier, so that a client that reconnects continues where it was.
        StreamEvent::End(reason) => Event::default().event("end").json_data(EndEvent { reason }),
    });
    Ok(Sse::new(events).keep_alive(KeepAlive::new().interval(KEEP_ALIVE)))
}
