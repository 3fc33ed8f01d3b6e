//! Connections: how many are admitted, how long a client may take, and which are closed to make room.
//!
//! The limiter (`limiter.rs`) admits a bounded number. A client that sends nothing, or reads nothing of a reply, is
//! timed by what its connection is doing (`activity.rs`), as the socket and the service record it. When all places are
//! taken, connections that have waited longest for their clients are closed, those of the client with the most
//! connections first; connections that are being served are never closed. If none can be closed, a few spare
//! connections still answer for the health of the server, and refuse everything else with a document.

mod activity;
mod bodies;
mod limiter;
mod own_hosts;
mod proxies;
mod service;
mod socket;

use std::time::Duration;

pub(crate) use activity::{ConnectionActivity, Late};
pub(crate) use limiter::ConnectionPermit;
pub use limiter::{ConnectionCounts, ConnectionLimiter};
pub use own_hosts::OwnHosts;
pub(crate) use proxies::is_trusted;
pub use proxies::network;
pub use service::{Answer, Arrival, Refusal, Service};
pub(crate) use socket::Socket;

/// Connections at a time by default.
pub const DEFAULT_CONNECTIONS: usize = 4096;

/// The limits of connections, in number and in time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ConnectionLimits {
    /// Connections at a time.
    pub most: usize,
    /// Connections of one client, by its address. Behind a proxy all clients have one address.
    pub per_client: usize,
    /// From the first byte of a request to the end of its head; and from the connection to there.
    pub head: Duration,
    /// From there to the end of the body.
    pub body: Duration,
    /// From a reply to the next request.
    pub idle: Duration,
    /// How long a client may take nothing of its reply.
    pub stall: Duration,
    /// How long requests may take to be done once the server stops.
    pub drain: Duration,
}

impl ConnectionLimits {
    /// The shortest of the times that [`ConnectionActivity`] measures.
    pub(crate) fn shortest(&self) -> Duration {
        self.head.min(self.stall).min(self.idle)
    }
}

impl Default for ConnectionLimits {
    fn default() -> Self {
        ConnectionLimits {
            most: DEFAULT_CONNECTIONS,
            per_client: DEFAULT_CONNECTIONS / 2,
            head: Duration::from_secs(10),
            body: Duration::from_secs(30),
            idle: Duration::from_secs(60),
            stall: Duration::from_secs(30),
            drain: Duration::from_secs(8),
        }
    }
}
