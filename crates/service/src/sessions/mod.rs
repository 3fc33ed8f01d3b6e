//! Living contacts: one writer for each, a cache of states, and a replay of the moves if a state is not cached.
//!
//! Moves of one session wait for its lock in the order of their arrival; sessions do not wait for each other. A move is
//! computed, appended to the store, and only then visible: a read shows a stored state. A client that hangs up while
//! its move is computed leaves no trace; one that hangs up later has its move stored or not, as a client that loses its
//! connection must expect. The consequences of a stored change, in the cache and in the quotas, need no client
//! (`run_to_end`).
//!
//! Other processes may work on the same store. A cached state is always one that the session has been in, so that
//! the moves stored after it lead to the current one: a read applies them first, and a move whose sequence another
//! process has taken applies them and tries again. The store also says what has been deleted or has expired, whatever
//! is cached.
//!
//! A handle works for one tenant ([`Sessions::for_tenant`]) and does not see what belongs to others: their states and
//! locks have other keys, and the tenant of what comes from the store is checked before it is used.

mod apply;
mod changes;
mod check;
mod common;
mod compute;
mod cycles;
mod entries;
mod error;
mod events;
mod expected;
mod expiry;
mod feed;
mod handle;
mod history;
mod loaded;
mod metrics;
mod observations;
mod prelude;
mod published;
mod replay;
mod run_to_end;
mod snapshot;
mod storage_reservation;
mod trace;

pub use check::{CheckEvent, Checked, Finding, check, count_moves};
pub use compute::bytes_of_moves;
pub use entries::CAPACITY;
pub use error::SessionError;
pub use events::events;
pub use expected::{Expected, label_checksum};
pub use expiry::run_expiry_loop;
pub use feed::ContactEvent;
pub use handle::Sessions;
pub use metrics::SessionMetrics;
pub use trace::{bytes_of_trace, trace};
