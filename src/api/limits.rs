//! Limits of the server that several modules share. What a document may hold is in [`stickslip_wire::limits`].

use std::time::Duration;

/// Characters of a request identifier that a client may choose.
pub const REQUEST_ID_LENGTH: usize = 128;
/// Bytes of a body.
pub const BODY_LIMIT: usize = 8 * 1024 * 1024;
/// When to try again after an overload.
pub const RETRY_AFTER: Duration = Duration::from_secs(1);
/// How often a comment keeps a stream without events open.
pub const KEEP_ALIVE: Duration = Duration::from_secs(15);
