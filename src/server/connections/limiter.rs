//! Who is connected.

use std::cmp::Reverse;
use std::collections::HashMap;
use std::net::{IpAddr, Ipv6Addr};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use tokio::task::AbortHandle;
use tokio::time::Instant;

use super::{ConnectionActivity, ConnectionLimits};
use crate::server::limits::{SHORTEST_VISIT, SPARE_CONNECTIONS};

/// Room is made for this share of all connections at a time, so that looking for it costs little for each.
const SHARE: usize = 16;
/// How long nobody is looked for after nobody was found.
const PAUSE: Duration = Duration::from_millis(100);

/// All connections. Clones are handles on the same.
#[derive(Clone, Debug)]
pub struct ConnectionLimiter {
    limits: ConnectionLimits,
    // A std mutex: held for a moment when a connection opens or closes, and never across an await.
    table: Arc<Mutex<Table>>,
}

#[derive(Debug, Default)]
struct Table {
    next: u64,
    connections: HashMap<u64, Connection>,
    /// ConnectionLimits by client.
    clients: HashMap<IpAddr, usize>,
    spare: usize,
    refused: u64,
    closed: u64,
    looked_in_vain: Option<Instant>,
}

#[derive(Debug)]
struct Connection {
    client: IpAddr,
    activity: Arc<ConnectionActivity>,
    // None until its task has been started.
    task: Option<AbortHandle>,
}

/// How many connections there are and have been.
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

/// What somebody who knocks is told.
pub enum Admission {
    /// Come in.
    ConnectionPermit(ConnectionPermit),
    /// Only to be told that there is no room, or that the server is well.
    Spare(ConnectionPermit),
    /// Not even that.
    Refused,
}

/// A connection that is counted until this is dropped.
pub struct ConnectionPermit {
    limiter: ConnectionLimiter,
    // None for a spare one.
    number: Option<u64>,
    /// What it is doing.
    pub activity: Arc<ConnectionActivity>,
}

impl ConnectionLimiter {
    /// Nobody is connected yet.
    #[must_use]
    pub fn new(limits: ConnectionLimits) -> ConnectionLimiter {
        ConnectionLimiter { limits, table: Arc::default() }
    }

    /// The limits.
    #[must_use]
    pub fn limits(&self) -> &ConnectionLimits {
        &self.limits
    }

    /// How many connections there are and have been.
    #[must_use]
    pub fn counts(&self) -> ConnectionCounts {
        let table = self.table();
        ConnectionCounts {
            open: table.connections.len(),
            spare: table.spare,
            refused: table.refused,
            closed: table.closed,
        }
    }

    fn table(&self) -> MutexGuard<'_, Table> {
        self.table.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Somebody has connected from an address.
    pub(crate) fn admit(&self, address: IpAddr) -> Admission {
        let (client, activity) = (client(address), Arc::new(ConnectionActivity::new()));
        let mut table = self.table();
        if table.connections.len() >= self.limits.most {
            table.make_room(self.limits.most.div_ceil(SHARE));
        }
        let mine = table.clients.get(&client).copied().unwrap_or(0);
        let permit = |number| ConnectionPermit { limiter: self.clone(), number, activity: Arc::clone(&activity) };
        if table.connections.len() < self.limits.most && mine < self.limits.per_client {
            let number = table.next;
            table.next += 1;
            table.clients.insert(client, mine + 1);
            table.connections.insert(number, Connection { client, activity: Arc::clone(&activity), task: None });
            Admission::ConnectionPermit(permit(Some(number)))
        } else if table.spare < SPARE_CONNECTIONS {
            table.spare += 1;
            Admission::Spare(permit(None))
        } else {
            table.refused += 1;
            Admission::Refused
        }
    }

    /// The task that serves a connection: what has to be ended to close it.
    pub(crate) fn started(&self, number: Option<u64>, task: AbortHandle) {
        let mut table = self.table();
        // It may have ended already.
        if let Some(connection) = number.and_then(|number| table.connections.get_mut(&number)) {
            connection.task = Some(task);
        }
    }

    /// Closes every connection.
    pub(crate) fn close_all(&self) {
        for task in self.table().connections.values().filter_map(|connection| connection.task.as_ref()) {
            task.abort();
        }
    }
}

impl Table {
    /// Closes so many connections at the most that wait for their clients: of those with the most connections first, and
    /// of these the one that has been waiting longest.
    fn make_room(&mut self, most: usize) {
        let now = Instant::now();
        if self.looked_in_vain.is_some_and(|last| now < last + PAUSE) {
            return;
        }
        let mut waiting: Vec<_> = self
            .connections
            .iter()
            .filter_map(|(number, connection)| Some((*number, connection.client, connection.activity.waiting_since()?)))
            .filter(|(.., since)| now.duration_since(*since) >= SHORTEST_VISIT)
            .collect();
        waiting.sort_by_key(|(_, client, since)| (Reverse(self.clients.get(client).copied()), *since));
        let mut found = false;
        for (number, ..) in waiting.into_iter().take(most) {
            // Its permit is given away now; the task only has to end.
            if self.connections.get(&number).is_some_and(|connection| connection.activity.close())
                && let Some(connection) = self.leave(number)
            {
                found = true;
                self.closed += 1;
                if let Some(task) = connection.task {
                    task.abort();
                }
            }
        }
        self.looked_in_vain = (!found).then_some(now);
    }

    fn leave(&mut self, number: u64) -> Option<Connection> {
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

    /// Its number, if it may have to make room.
    pub fn number(&self) -> Option<u64> {
        self.number
    }
}

impl Drop for ConnectionPermit {
    fn drop(&mut self) {
        let mut table = self.limiter.table();
        match self.number {
            Some(number) => drop(table.leave(number)),
            None => table.spare -= 1,
        }
    }
}

/// A client by its address: of the newer addresses it has a whole network.
fn client(address: IpAddr) -> IpAddr {
    match address.to_canonical() {
        IpAddr::V6(address) => {
            let [a, b, c, d, ..] = address.segments();
            Ipv6Addr::new(a, b, c, d, 0, 0, 0, 0).into()
        }
        address => address,
    }
}
