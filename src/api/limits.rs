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
/// How often a comment tells that a stream without events is alive.
pub const KEEP_ALIVE: Duration = Duration::from_secs(15);
