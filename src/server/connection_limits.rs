//! Limits of connections and of the bytes on them.

use std::time::Duration;

/// How long clients may take to read their last replies when the server stops, after the time for their requests.
pub const GRACE: Duration = Duration::from_millis(500);
/// What the rest of a stop may take after that: the chunks of jobs, the last traces, the store, the log.
pub const LAST: Duration = Duration::from_secs(1);
/// Bytes of the head of a request: its first line and its headers.
pub const HEAD: usize = 32 * 1024;
/// Bytes that a connection reads ahead, and bytes that it buffers for writing.
pub const BUFFER: usize = 40 * 1024;
/// Bytes of a body that nobody wants and that are read all the same, so that the client can read the answer and send
/// its next request. Beyond that the connection is closed.
pub const DISCARDED: usize = 64 * 1024 * 1024;
/// How long they may take to arrive.
pub const DISCARD_TIME: Duration = Duration::from_secs(2);
/// Bytes of a reply that are handed to the socket at a time.
pub const PIECE: usize = 16 * 1024;
/// Spare connections beyond the limit, for a short time each: they answer health checks, and refuse other requests with
/// a document rather than by closing the connection.
pub const SPARE_CONNECTIONS: usize = 128;
/// How long a spare connection has for the head of its request.
pub const SPARE_TIME: Duration = Duration::from_secs(2);
/// A connection that has waited for its client for less than this is not closed to make room for another.
pub const LEAST_WAIT: Duration = Duration::from_secs(1);
/// Bytes that a client must read of a reply within the time for a stall, otherwise it counts as stalled.
pub const LEAST_PROGRESS: usize = 64 * 1024;
/// How long a client may take to read a reply that holds a place of memory, so that its bytes have a least rate.
pub const LARGE_REPLY_TIME: Duration = Duration::from_secs(600);
/// Bytes that the socket takes beyond what is on its way, and again once half of them are: as many as a client must
/// read within the time for a stall, so that none that does is taken for one that reads nothing.
pub const UNSENT: u32 = 128 * 1024;
/// How long half a head may still take once the server stops.
pub const LAST_HEAD: Duration = Duration::from_secs(1);
