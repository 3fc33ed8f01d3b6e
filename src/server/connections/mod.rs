//! ConnectionLimits: who may come in, how long a client may keep the server waiting, and who has to make room.
//!
//! So many connections are open at a time (`limiter.rs`). A client that sends nothing, or takes nothing of a reply, is timed
//! by what the connection is doing (`activity.rs`), which the socket and the service note as they go. When all are taken, those
//! that have been waiting longest for their clients are closed to make room, those of the client with the most
//! connections first; connections that are being served are never closed. Where nobody can go, a few spare connections
//! still answer for the health of the server, and refuse everything else with a document.

mod activity;
mod bodies;
mod limiter;
mod service;
mod smuggling;
mod socket;

use std::time::Duration;

pub(crate) use activity::ConnectionActivity;
pub use bodies::SlowBody;
pub(crate) use limiter::{Admission, ConnectionPermit};
pub use limiter::{ConnectionCounts, ConnectionLimiter};
pub use service::{Refusal, Service};
pub(crate) use socket::Socket;

/// ConnectionLimits at a time unless told otherwise.
pub const MOST: usize = 4096;

/// How many connections there are, and how long they may take.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ConnectionLimits {
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

impl ConnectionLimits {
    /// The shortest of the times that are measured by the connection.
    pub(crate) fn shortest(&self) -> Duration {
        self.head.min(self.idle).min(self.stall)
    }
}

impl Default for ConnectionLimits {
    fn default() -> Self {
        ConnectionLimits {
            most: MOST,
            per_client: MOST / 2,
            head: Duration::from_secs(10),
            body: Duration::from_secs(30),
            idle: Duration::from_secs(60),
            stall: Duration::from_secs(30),
        }
    }
}
