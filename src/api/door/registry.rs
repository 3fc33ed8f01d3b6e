//! Who is connected.

use std::cmp::Reverse;
use std::collections::HashMap;
use std::net::{IpAddr, Ipv6Addr};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use tokio::task::AbortHandle;
use tokio::time::Instant;

use super::{Activity, Connections};
use crate::api::limits::{SHORTEST_VISIT, SPARE_CONNECTIONS};

/// Room is made for this share of all connections at a time, so that looking for it costs little for each.
const SHARE: usize = 16;
/// How long nobody is looked for after nobody was found.
const PAUSE: Duration = Duration::from_millis(100);

/// All connections. Clones are handles on the same.
#[derive(Clone, Debug)]
pub struct Door {
    limits: Connections,
    // A std mutex: held for a moment when a connection opens or closes, and never across an await.
    inside: Arc<Mutex<Inside>>,
}

#[derive(Debug, Default)]
struct Inside {
    next: u64,
    guests: HashMap<u64, Guest>,
    /// Connections by client.
    clients: HashMap<IpAddr, usize>,
    spare: usize,
    refused: u64,
    closed: u64,
    looked_in_vain: Option<Instant>,
}

#[derive(Debug)]
struct Guest {
    client: IpAddr,
    activity: Arc<Activity>,
    // None until its task has been started.
    task: Option<AbortHandle>,
}

/// How many connections there are and have been.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Figures {
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
pub enum Entry {
    /// Come in.
    Seat(Seat),
    /// Only to be told that there is no room, or that the server is well.
    Spare(Seat),
    /// Not even that.
    Refused,
}

/// A connection that is counted until this is dropped.
pub struct Seat {
    door: Door,
    // None for a spare one.
    number: Option<u64>,
    /// What it is doing.
    pub activity: Arc<Activity>,
}

impl Door {
    /// Nobody is connected yet.
    #[must_use]
    pub fn new(limits: Connections) -> Door {
        Door { limits, inside: Arc::default() }
    }

    /// The limits.
    #[must_use]
    pub fn limits(&self) -> &Connections {
        &self.limits
    }

    /// How many connections there are and have been.
    #[must_use]
    pub fn figures(&self) -> Figures {
        let inside = self.inside();
        Figures { open: inside.guests.len(), spare: inside.spare, refused: inside.refused, closed: inside.closed }
    }

    fn inside(&self) -> MutexGuard<'_, Inside> {
        self.inside.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Somebody has connected from an address.
    pub(in crate::api) fn knock(&self, address: IpAddr) -> Entry {
        let (client, activity) = (client(address), Arc::new(Activity::new()));
        let mut inside = self.inside();
        if inside.guests.len() >= self.limits.most {
            inside.make_room(self.limits.most.div_ceil(SHARE));
        }
        let mine = inside.clients.get(&client).copied().unwrap_or(0);
        let seat = |number| Seat { door: self.clone(), number, activity: Arc::clone(&activity) };
        if inside.guests.len() < self.limits.most && mine < self.limits.per_client {
            let number = inside.next;
            inside.next += 1;
            inside.clients.insert(client, mine + 1);
            inside.guests.insert(number, Guest { client, activity: Arc::clone(&activity), task: None });
            Entry::Seat(seat(Some(number)))
        } else if inside.spare < SPARE_CONNECTIONS {
            inside.spare += 1;
            Entry::Spare(seat(None))
        } else {
            inside.refused += 1;
            Entry::Refused
        }
    }

    /// The task that serves a connection: what has to be ended to close it.
    pub(in crate::api) fn started(&self, number: Option<u64>, task: AbortHandle) {
        let mut inside = self.inside();
        // It may have ended already.
        if let Some(guest) = number.and_then(|number| inside.guests.get_mut(&number)) {
            guest.task = Some(task);
        }
    }

    /// Closes every connection.
    pub(in crate::api) fn close_all(&self) {
        for task in self.inside().guests.values().filter_map(|guest| guest.task.as_ref()) {
            task.abort();
        }
    }
}

impl Inside {
    /// Closes so many connections at the most that wait for their clients: of those with the most connections first, and
    /// of these the one that has been waiting longest.
    fn make_room(&mut self, most: usize) {
        let now = Instant::now();
        if self.looked_in_vain.is_some_and(|last| now < last + PAUSE) {
            return;
        }
        let mut waiting: Vec<_> = self
            .guests
            .iter()
            .filter_map(|(number, guest)| Some((*number, guest.client, guest.activity.waiting_since()?)))
            .filter(|(.., since)| now.duration_since(*since) >= SHORTEST_VISIT)
            .collect();
        waiting.sort_by_key(|(_, client, since)| (Reverse(self.clients.get(client).copied()), *since));
        let mut found = false;
        for (number, ..) in waiting.into_iter().take(most) {
            // Its seat is given away now; the task only has to end.
            if self.guests.get(&number).is_some_and(|guest| guest.activity.close())
                && let Some(guest) = self.leave(number)
            {
                found = true;
                self.closed += 1;
                if let Some(task) = guest.task {
                    task.abort();
                }
            }
        }
        self.looked_in_vain = (!found).then_some(now);
    }

    fn leave(&mut self, number: u64) -> Option<Guest> {
        let guest = self.guests.remove(&number)?;
        if let Some(count) = self.clients.get_mut(&guest.client) {
            *count -= 1;
            if *count == 0 {
                self.clients.remove(&guest.client);
            }
        }
        Some(guest)
    }
}

impl Seat {
    /// Whether it is a spare one.
    pub fn is_spare(&self) -> bool {
        self.number.is_none()
    }

    /// Its number, if it may have to make room.
    pub fn number(&self) -> Option<u64> {
        self.number
    }
}

impl Drop for Seat {
    fn drop(&mut self) {
        let mut inside = self.door.inside();
        match self.number {
            Some(number) => drop(inside.leave(number)),
            None => inside.spare -= 1,
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
