//! What the server takes, apart from what [`stickslip_wire::limits`] says about documents.

use std::ops::RangeInclusive;
use std::time::Duration;

/// Bytes of a body.
pub const BODY: usize = 8 * 1024 * 1024;
/// Bytes of a body that is too large which are read and thrown away, so that the client gets to read the answer.
pub const DRAIN: usize = 8 * BODY;
/// Bytes that a byte of a long body may become while it is parsed: a point of a table is a few digits, and a series then.
pub const EXPANSION: usize = 100;
/// Bytes of an item in a list of contacts.
pub const SUMMARY: usize = 2_048;
/// Bytes of an item of a history.
pub const HISTORY_ITEM: usize = 1_536;
/// Items of a page.
pub const PAGE: RangeInclusive<usize> = 1..=1_000;
/// Items of a page if the client does not say.
pub const DEFAULT_PAGE: usize = 100;
/// Radii in a query: with all digits, they fit into the head of a request.
pub const QUERY_RADII: RangeInclusive<usize> = 1..=1_000;
/// Characters of an idempotency key.
pub const KEY_LENGTH: usize = 255;
/// Characters of a request identifier that a client may choose.
pub const REQUEST_ID_LENGTH: usize = 128;
/// When to try again after an overload.
pub const RETRY_AFTER: Duration = Duration::from_secs(1);
/// How long open connections may take to finish once the server has been told to stop.
pub const GRACE: Duration = Duration::from_secs(3);
/// How often a comment tells that a stream without events is alive.
pub const KEEP_ALIVE: Duration = Duration::from_secs(15);
/// Bytes of the head of a request: its first line and its headers.
pub const HEAD: usize = 32 * 1024;
/// Bytes that a connection reads ahead, and as many that it has to write.
pub const BUFFER: usize = 40 * 1024;
/// Bytes of a reply that are handed on at a time.
pub const PIECE: usize = 16 * 1024;
/// Connections beyond all others, for a short time each: to be asked whether the server is well, and to refuse the rest
/// with a document rather than a closed door.
pub const SPARE_CONNECTIONS: usize = 128;
/// How long such a connection has for the head of its request.
pub const SPARE_TIME: Duration = Duration::from_secs(2);
/// A connection that has been waiting for its client for less than this is not closed to make room for another.
pub const SHORTEST_VISIT: Duration = Duration::from_secs(1);
/// Bytes that a client must take of a reply within the time for a stall, as a sign of life.
pub const PROGRESS: usize = 64 * 1024;
