//! What one client may have of what all share.

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::fmt;
use std::sync::Arc;

use bytesize::ByteSize;
use parking_lot::Mutex;
use prometheus::{IntCounterVec, Opts};

use super::Client;
use crate::metrics::OWN_NAME;

/// Requests in progress of one client by default.
pub const REQUESTS_PER_CLIENT: usize = super::REQUESTS / 2;
/// Clients that may listen to events of contacts at a time.
pub const STREAMS: usize = 1_000;
/// Event streams of one client by default: fewer than there are for jobs or contacts.
pub const STREAMS_PER_CLIENT: usize = 200;
/// Contacts of one tenant by default.
pub const CONTACTS_PER_TENANT: usize = 100_000;
/// The divisor of the bytes of work that gives those of the bodies of one client that are arriving, by default.
pub const BODY_SHARE: usize = 4;
/// Bytes of one tenant in the store by default.
pub const STORE_BYTES_PER_TENANT: usize = 16 * 1024 * 1024 * 1024;

/// Declares the quotas: what is counted, its member of [`QuotaLimits`], the name of its setting and its default.
macro_rules! quotas {
    ($($(#[doc = $doc:literal])* $quota:ident, $member:ident, $name:literal, $default:expr;)*) => {
        /// What is counted.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum Quota { $($(#[doc = $doc])* $quota,)* }

        impl Quota {
            /// All of them.
            pub const ALL: &[Quota] = &[$(Quota::$quota),*];

            /// Its name: that of its setting, without the dashes in front.
            pub const fn name(self) -> &'static str {
                match self { $(Quota::$quota => $name,)* }
            }
        }

        /// How much a client may have.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub struct QuotaLimits { $($(#[doc = $doc])* pub $member: usize,)* }

        impl QuotaLimits {
            /// The limit of a quota.
            pub fn of(&self, quota: Quota) -> usize {
                match quota { $(Quota::$quota => self.$member,)* }
            }
        }

        impl Default for QuotaLimits {
            fn default() -> Self {
                QuotaLimits { $($member: $default,)* }
            }
        }
    };
}

quotas! {
    /// Requests that arrive, wait or are served.
    Requests, requests, "max-requests-per-client", REQUESTS_PER_CLIENT;
    /// Streams of events.
    Streams, streams, "max-streams-per-client", STREAMS_PER_CLIENT;
    /// Contacts of a tenant in the store.
    Contacts, contacts, "max-contacts-per-tenant", CONTACTS_PER_TENANT;
    /// Bytes of a tenant in the store.
    StoreBytes, store_bytes, "max-store-bytes-per-tenant", STORE_BYTES_PER_TENANT;
    /// Bytes of memory for bodies that are arriving.
    BodyBytes, body_bytes, "max-body-bytes-per-client", super::BYTES / BODY_SHARE;
}

/// A quota that is used up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct QuotaExceeded {
    /// Which.
    pub quota: Quota,
    /// How much it allows.
    pub limit: usize,
}

impl fmt::Display for QuotaExceeded {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (name, limit) = (self.quota.name(), self.limit);
        let bytes = ByteSize::b(limit as u64);
        match self.quota {
            Quota::Requests => write!(f, "you have {limit} requests in progress, as many as `{name}` allows"),
            Quota::Streams => write!(f, "you follow {limit} streams of events, as many as `{name}` allows"),
            Quota::Contacts => write!(f, "you have {limit} contacts, as many as `{name}` allows: delete some"),
            Quota::BodyBytes => write!(
                f,
                "the bodies that are arriving from you would take more than the {bytes} that `{name}` allows: send \
                 fewer at a time"
            ),
            Quota::StoreBytes => write!(
                f,
                "your contacts would take more than the {bytes} in the store that `{name}` allows: delete some, or \
                 make fewer moves"
            ),
        }
    }
}

/// The quotas of all clients. Clones share it.
#[derive(Clone, Debug)]
pub struct Quotas {
    /// The most that a client may have of each.
    pub limits: QuotaLimits,
    /// How many requests were beyond each quota.
    pub refused: IntCounterVec,
    // Locked for a moment, and never across an await.
    used: Arc<Mutex<HashMap<(Quota, Client), usize>>>,
}

/// A client's share of what a quota counts, until dropped.
#[derive(Debug)]
pub struct Share {
    quotas: Quotas,
    of: (Quota, Client),
    amount: usize,
}

impl Quotas {
    /// Nothing is used.
    ///
    /// # Panics
    /// Never: the name of the metric is one that is allowed.
    pub fn new(limits: QuotaLimits) -> Quotas {
        let options = Opts::new("stickslip_quota_refused_total", "Requests refused by a quota of the client.");
        let refused = IntCounterVec::new(options, &["quota"]).expect(OWN_NAME);
        for quota in Quota::ALL {
            let _ = refused.with_label_values(&[quota.name()]);
        }
        Quotas { limits, used: Arc::default(), refused }
    }

    /// A share of nothing yet. The server itself has no quotas.
    pub fn no_share(&self, quota: Quota, client: Client) -> Share {
        Share { quotas: self.clone(), of: (quota, client), amount: 0 }
    }

    /// The refusal of what is beyond a quota whose count is kept elsewhere.
    pub fn exceeded(&self, quota: Quota) -> QuotaExceeded {
        self.refused.with_label_values(&[quota.name()]).inc();
        QuotaExceeded { quota, limit: self.limits.of(quota) }
    }
}

impl Share {
    /// Grows or shrinks the share.
    ///
    /// # Errors
    /// [`QuotaExceeded`] if the client would have more than it may; the share is unchanged then.
    pub fn resize(&mut self, amount: usize) -> Result<(), QuotaExceeded> {
        let (quota, client) = &self.of;
        let mut used = self.quotas.used.lock();
        let entry = used.entry(self.of.clone());
        let others = match &entry {
            Entry::Occupied(count) => count.get() - self.amount,
            Entry::Vacant(_) => 0,
        };
        let all = others.saturating_add(amount);
        if amount > self.amount && all > self.quotas.limits.of(*quota) && *client != Client::Server {
            drop(used);
            return Err(self.quotas.exceeded(*quota));
        }
        match entry {
            Entry::Occupied(count) if all == 0 => drop(count.remove()),
            Entry::Vacant(_) if all == 0 => {}
            entry => drop(entry.insert_entry(all)),
        }
        self.amount = amount;
        Ok(())
    }
}

impl Drop for Share {
    fn drop(&mut self) {
        // Giving back is never refused.
        let _ = self.resize(0);
    }
}
