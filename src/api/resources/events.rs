//! `/contacts/{id}/events`: each new state of a contact, as a server-sent event.

use axum::response::sse::{Event, KeepAlive, Sse};
use futures::{Stream, StreamExt as _};

use super::prelude::*;
use crate::api::path_and_headers::LastEventId;
use crate::api::query_parameters::move_number;
use crate::sessions::{self, SessionError};
use crate::store::StreamEvent;
use stickslip_wire::{EndEvent, StateEvent};

parameters! {
    /// When a stream of events ends by itself.
    pub struct EventsQuery {
        /// End the stream after this number of events. Without it the stream lasts as long as the contact.
        limit: usize = count(&PAGE);
        /// As the header `Last-Event-ID`, for a client that cannot send it, such as a new `EventSource`.
        last_event_id: u64 = move_number();
    }
}

/// Watch a contact
///
/// Server-sent events: an event `state` for each move, whose `id` is the sequence, in order and without a gap. A
/// browser's `EventSource` resumes by itself after an interruption. The last event is `end` (its data an `EndEvent`),
/// when the contact is deleted or expires, or the server stops. With `limit` the stream ends after that number of
/// states, for clients that read a reply whole. Comments keep an idle connection open.
#[utoipa::path(
    get, path = "/contacts/{id}/events", tag = "contacts", params(ContactPath, LastEventId, EventsQuery),
    responses((status = 200, description = "The events",
        content_type = "text/event-stream", body = StateEvent))
)]
pub async fn watch_contact(
    ContactPath { app, id, .. }: ContactPath,
    LastEventId { sequence }: LastEventId,
    CheckedQuery(query): CheckedQuery<EventsQuery>,
) -> Result<Sse<impl Stream<Item = Result<Event, axum::Error>>>, Problem> {
    // The header is that of a client that has come back, and knows more.
    let after = sequence.or(query.last_event_id);
    let events = match sessions::events(&app.sessions, id, after).await {
        // Of a store that was put back to an earlier state. What the client knows is no more: it begins anew.
        Err(SessionError::Ahead { .. }) => sessions::events(&app.sessions, id, None).await?,
        events => events?,
    };
    let events = events.map(|happening| match happening {
        StreamEvent::State(state) => {
            Ok(Event::default().id(state.sequence.to_string()).event("state").data(&state.json))
        }
        // Without an identifier, so that a client that reconnects continues where it was.
        StreamEvent::End(reason) => Event::default().event("end").json_data(EndEvent { reason }),
    });
    let events = events.take(query.limit.unwrap_or(usize::MAX));
    Ok(Sse::new(events).keep_alive(KeepAlive::default()))
}
