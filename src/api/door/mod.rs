//! Connections: who may come in, how long a client may keep the server waiting, and who has to make room.
//!
//! So many connections are open at a time (`registry.rs`). A client that sends nothing, or takes nothing of a reply, is timed
//! by what the connection is doing (`activity.rs`), which the socket and the service note as they go. When all are taken, those
//! that have been waiting longest for their clients are closed to make room, those of the client with the most
//! connections first; connections that are being served are never closed. Where nobody can go, a few spare connections
//! still answer for the health of the server, and refuse everything else with a document.

mod activity;
mod bodies;
mod head;
mod registry;
mod service;
mod socket;

use std::time::Duration;

pub(super) use activity::Activity;
pub use bodies::SlowBody;
pub use registry::{Door, Figures};
pub(super) use registry::{Entry, Seat};
pub(super) use service::{Refusal, Service};
pub(super) use socket::Socket;

/// Connections at a time unless told otherwise.
pub const MOST: usize = 4096;

/// How many connections there are, and how long they may take.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Connections {
    /// How many at a time.
    pub most: usize,
    /// How many of one client, by its address. Behind a proxy all clients have one address.
    pub per_client: usize,
    /// From the first byte of a request to the end of its head; and from the connection to there.
    pub head: Duration,
    /// From there to the end of the body.
    pub body: Duration,
    /// From a reply to the next request.
    pub idle: Duration,
    /// How long a client may take nothing of its reply.
    pub stall: Duration,
}

impl Connections {
    /// The shortest of the times that are measured by the connection.
    pub(super) fn shortest(&self) -> Duration {
        self.head.min(self.idle).min(self.stall)
    }
}

impl Default for Connections {
    fn default() -> Self {
        Connections {
            most: MOST,
            per_client: MOST / 2,
            head: Duration::from_secs(10),
            body: Duration::from_secs(30),
            idle: Duration::from_secs(60),
            stall: Duration::from_secs(30),
        }
    }
}
