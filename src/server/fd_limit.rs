//! The limit of open files: a connection counts as one.

use rustix::process::{Resource, getrlimit, setrlimit};

use crate::server::connection_limits::SPARE_CONNECTIONS;

/// Files besides connections: the store, the log, the runtime, libraries.
const OTHERS: usize = 128;

/// Raises the limit for this many connections as far as the process may; returns how many it allows.
pub fn room_for(connections: usize) -> usize {
    let besides = (SPARE_CONNECTIONS + OTHERS) as u64;
    let wanted = (connections as u64).saturating_add(besides);
    let mut limit = getrlimit(Resource::Nofile);
    if limit.current.is_some_and(|current| current < wanted) {
        let raised = limit.maximum.map_or(wanted, |maximum| maximum.min(wanted));
        let asked = rustix::process::Rlimit { current: Some(raised), maximum: limit.maximum };
        if setrlimit(Resource::Nofile, asked).is_ok() {
            limit.current = Some(raised);
        }
    }
    // Of a low limit they leave a quarter.
    let left = |current: u64| current.saturating_sub(besides).max(current / 4).max(1);
    let room = limit.current.map_or(u64::MAX, left);
    connections.min(usize::try_from(room).unwrap_or(usize::MAX))
}
