//! The largest memory use of the process, as it follows from its limits.

use crate::admission::{Capacity, STREAMS};

use crate::server::connection_limits::SPARE_CONNECTIONS;
use crate::server::connections::ConnectionLimits;

const KIB: u64 = 1024;

/// The program, its libraries, its threads, the caches of the store, and what the allocator keeps between them.
pub const PROGRAM: u64 = 128 * KIB * KIB;
/// A connection: what it has read and not served, what it has to write, and its task.
pub const CONNECTION: u64 = 128 * KIB;
/// What a connection by TLS takes besides: a record received, a record read, and what is to be sent.
pub const TLS: u64 = 64 * KIB;
/// A request that is small enough not to be counted among the work.
pub const REQUEST: u64 = 64 * KIB;
/// A client that listens to events: a page of the history.
pub const STREAM: u64 = 64 * KIB;

/// The bound, bytes.
pub fn memory(connections: &ConnectionLimits, capacity: &Capacity, cache: u64, with_tls: bool) -> u64 {
    let connection = CONNECTION + if with_tls { TLS } else { 0 };
    let requests = capacity.requests.saturating_add(capacity.queue) as u64;
    PROGRAM
        .saturating_add(cache)
        .saturating_add(capacity.reservable_bytes() as u64)
        .saturating_add(capacity.state_bytes() as u64)
        .saturating_add(connection.saturating_mul(connections.most.saturating_add(SPARE_CONNECTIONS) as u64))
        .saturating_add(REQUEST.saturating_mul(requests))
        .saturating_add(STREAM * STREAMS as u64)
}
