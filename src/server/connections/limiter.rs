//! Admits connections up to the limits, and closes those that wait longest for their clients when all places are taken.

use std::cmp::Reverse;
use std::collections::HashMap;
use std::net::IpAddr;
use std::sync::Arc;
use std::time::Duration;

use ipnet::IpNet;
use parking_lot::Mutex;
use tokio::task::AbortHandle;
use tokio::time::Instant;

use super::{ConnectionActivity, ConnectionLimits, is_trusted};
use crate::admission::Client;
use crate::server::connection_limits::{LEAST_WAIT, SPARE_CONNECTIONS};

/// The divisor of all connections that gives the number freed at a time, so that the search costs little for each.
const FREED_SHARE: usize = 16;
/// How long a search that found nothing is not repeated.
const SEARCH_PAUSE: Duration = Duration::from_millis(100);

/// All connections of the server. Clones share it.
#[derive(Clone, Debug)]
pub struct ConnectionLimiter {
    /// The limits of connections.
    pub limits: ConnectionLimits,
    /// The proxies that are trusted. Their clients are many: the bound of one does not hold for them.
    pub proxies: Arc<[IpNet]>,
    // Locked for a moment when a connection opens or closes, and never across an await.
    table: Arc<Mutex<Table>>,
}

#[derive(Debug, Default)]
struct Table {
    next: u64,
    connections: HashMap<u64, Connection>,
    clients: HashMap<Client, usize>,
    /// Without the number of open ones, which is that of `connections`.
    counts: ConnectionCounts,
    /// When a search last found nothing to close.
    searched_at: Option<Instant>,
}

#[derive(Debug)]
struct Connection {
    client: Client,
    activity: Arc<ConnectionActivity>,
    // None until its task has started.
    task: Option<AbortHandle>,
}

/// Counts of connections.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ConnectionCounts {
    /// Open, without the spare ones.
    pub open: usize,
    /// Spare ones in use.
    pub spare: usize,
    /// Refused so far: closed at once, as nothing was free.
    pub refused: u64,
    /// Closed so far to make room.
    pub closed: u64,
}

/// A connection that is counted until this is dropped. A spare one is answered for the health of the server alone;
/// every other request is refused.
pub struct ConnectionPermit {
    limiter: ConnectionLimiter,
    /// Its number; none for a spare one, which is never closed to make room.
    pub number: Option<u64>,
    /// What it is doing.
    pub activity: Arc<ConnectionActivity>,
}

impl ConnectionLimiter {
    /// A limiter without connections. The bound of a client does not hold for `proxies`.
    pub fn new(limits: ConnectionLimits, proxies: Arc<[IpNet]>) -> ConnectionLimiter {
        ConnectionLimiter { limits, proxies, table: Arc::default() }
    }

    /// Counts of connections.
    pub fn counts(&self) -> ConnectionCounts {
        let table = self.table.lock();
        ConnectionCounts { open: table.connections.len(), ..table.counts }
    }

    /// Decides on a connection from `address`; without a permit it is closed at once.
    pub(crate) fn admit(&self, address: IpAddr) -> Option<ConnectionPermit> {
        let (client, activity) = (Client::of_address(address), Arc::new(ConnectionActivity::new()));
        let bounded = !is_trusted(&self.proxies, address.to_canonical());
        let mut table = self.table.lock();
        if table.connections.len() >= self.limits.most {
            table.make_room(self.limits.most.div_ceil(FREED_SHARE));
        }
        let mine = table.clients.get(&client).copied().unwrap_or(0);
        let permit = |number| ConnectionPermit { limiter: self.clone(), number, activity: Arc::clone(&activity) };
        if table.connections.len() < self.limits.most && (mine < self.limits.per_client || !bounded) {
            let number = table.next;
            table.next += 1;
            table.clients.insert(client.clone(), mine + 1);
            let activity = Arc::clone(&activity);
            table.connections.insert(number, Connection { client, activity, task: None });
            Some(permit(Some(number)))
        } else if table.counts.spare < SPARE_CONNECTIONS {
            table.counts.spare += 1;
            Some(permit(None))
        } else {
            table.counts.refused += 1;
            None
        }
    }

    /// Registers the task that serves a connection, which is aborted to close it.
    pub(crate) fn started(&self, number: Option<u64>, task: AbortHandle) {
        let mut table = self.table.lock();
        // It may have ended already.
        if let Some(connection) = number.and_then(|number| table.connections.get_mut(&number)) {
            connection.task = Some(task);
        }
    }

    pub(crate) fn close_all(&self) {
        for task in self.table.lock().connections.values().filter_map(|connection| connection.task.as_ref()) {
            task.abort();
        }
    }
}

impl Table {
    /// Closes at most `most` connections that wait for their clients: those of the clients with the most connections
    /// first, and of these the ones that have waited longest.
    fn make_room(&mut self, most: usize) {
        let now = Instant::now();
        if self.searched_at.is_some_and(|last| now < last + SEARCH_PAUSE) {
            return;
        }
        let waiting = self.connections.iter().filter_map(|(number, connection)| {
            let since = connection.activity.waiting_since()?;
            let others = self.clients.get(&connection.client).copied();
            (now.duration_since(since) >= LEAST_WAIT).then_some((Reverse(others), since, *number))
        });
        let mut waiting: Vec<_> = waiting.collect();
        waiting.sort();
        let mut found = false;
        for (.., number) in waiting.into_iter().take(most) {
            // Its place is free from now on; the task only has to end.
            if self.connections.get(&number).is_some_and(|connection| connection.activity.try_close())
                && let Some(connection) = self.remove(number)
            {
                found = true;
                self.counts.closed += 1;
                if let Some(task) = connection.task {
                    task.abort();
                }
            }
        }
        self.searched_at = (!found).then_some(now);
    }

    fn remove(&mut self, number: u64) -> Option<Connection> {
        let connection = self.connections.remove(&number)?;
        if let Some(count) = self.clients.get_mut(&connection.client) {
            *count -= 1;
            if *count == 0 {
                self.clients.remove(&connection.client);
            }
        }
        Some(connection)
    }
}

impl ConnectionPermit {
    /// Whether it is a spare one.
    pub fn is_spare(&self) -> bool {
        self.number.is_none()
    }
}

impl Drop for ConnectionPermit {
    fn drop(&mut self) {
        let mut table = self.limiter.table.lock();
        match self.number {
            Some(number) => drop(table.remove(number)),
            None => table.counts.spare -= 1,
        }
    }
}
