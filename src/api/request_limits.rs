//! Limits of the server that several modules share. What a document may hold is in [`stickslip_wire::limits`].

use std::ops::RangeInclusive;
use std::time::Duration;

/// Characters of a request identifier that a client may choose.
pub const REQUEST_ID_LENGTH: usize = 128;
/// Bytes of a body that is a document.
pub const BODY_LIMIT: usize = 8 * 1024 * 1024;
/// Bytes of a file of an instrument: a map of 1024 x 1024 heights of 15 characters.
pub const FILE_LIMIT: usize = 16 * 1024 * 1024;
/// When to try again after an overload.
pub const RETRY_AFTER: Duration = Duration::from_secs(1);
/// Items of a page.
pub const PAGE: RangeInclusive<usize> = 1..=1_000;
/// Items of a page if the client does not say.
pub const DEFAULT_PAGE: usize = 100;
