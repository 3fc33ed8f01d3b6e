//! What one client may have of what all share.

use std::collections::HashMap;
use std::fmt;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use prometheus::{IntCounterVec, Opts};

use super::Client;
use crate::metrics::OWN_NAME;

/// Requests in progress of one client by default.
pub const REQUESTS_PER_CLIENT: usize = super::REQUESTS / 2;
/// Event streams of one client by default: fewer than there are for jobs or contacts.
pub const STREAMS_PER_CLIENT: usize = 200;
/// Contacts of one tenant by default.
pub const CONTACTS_PER_TENANT: usize = 100_000;

/// What is counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Quota {
    /// Requests that arrive, wait or are served.
    Requests,
    /// Streams of events.
    Streams,
    /// Contacts in the store.
    Contacts,
}

impl Quota {
    /// All of them.
    pub const ALL: [Quota; 3] = [Quota::Requests, Quota::Streams, Quota::Contacts];

    /// Its name: that of its setting, without the dashes in front.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Quota::Requests => "max-requests-per-client",
            Quota::Streams => "max-streams-per-client",
            Quota::Contacts => "max-contacts-per-tenant",
        }
    }
}

/// How much a client may have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct QuotaLimits {
    /// Requests in progress.
    pub requests: usize,
    /// Event streams.
    pub streams: usize,
    /// Contacts of its tenant.
    pub contacts: usize,
}

impl Default for QuotaLimits {
    fn default() -> Self {
        QuotaLimits { requests: REQUESTS_PER_CLIENT, streams: STREAMS_PER_CLIENT, contacts: CONTACTS_PER_TENANT }
    }
}

impl QuotaLimits {
    /// The limit of a quota.
    #[must_use]
    pub fn of(&self, quota: Quota) -> usize {
        match quota {
            Quota::Requests => self.requests,
            Quota::Streams => self.streams,
            Quota::Contacts => self.contacts,
        }
    }
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
        match self.quota {
            Quota::Requests => write!(f, "you have {limit} requests in progress, as many as `{name}` allows"),
            Quota::Streams => write!(f, "you follow {limit} streams of events, as many as `{name}` allows"),
            Quota::Contacts => write!(f, "you have {limit} contacts, as many as `{name}` allows: delete some"),
        }
    }
}

/// The quotas of all clients. Clones share it.
#[derive(Clone, Debug)]
pub struct Quotas {
    limits: QuotaLimits,
    // A std mutex: held for a moment, and never across an await.
    used: Arc<Mutex<HashMap<(Quota, Client), usize>>>,
    refused: IntCounterVec,
}

/// One of what a quota counts, until dropped.
#[derive(Debug)]
pub struct Share {
    quotas: Quotas,
    of: (Quota, Client),
}

impl Quotas {
    /// Nothing is used.
    ///
    /// # Panics
    /// Never: the name of the metric is one that is allowed.
    #[must_use]
    pub fn new(limits: QuotaLimits) -> Quotas {
        let options = Opts::new("stickslip_quota_refused_total", "Requests beyond a quota of their client.");
        let refused = IntCounterVec::new(options, &["quota"]).expect(OWN_NAME);
        for quota in Quota::ALL {
            let _ = refused.with_label_values(&[quota.name()]);
        }
        Quotas { limits, used: Arc::default(), refused }
    }

    /// The limits.
    #[must_use]
    pub fn limits(&self) -> &QuotaLimits {
        &self.limits
    }

    /// How many requests were beyond each quota.
    #[must_use]
    pub fn refused(&self) -> &IntCounterVec {
        &self.refused
    }

    /// One more for the client that this task serves. The server itself has no quotas.
    ///
    /// # Errors
    /// [`QuotaExceeded`] if it has as many as it may.
    pub fn share(&self, quota: Quota) -> Result<Share, QuotaExceeded> {
        let of = (quota, Client::current());
        let mut used = self.used();
        let count = used.entry(of.clone()).or_default();
        if *count >= self.limits.of(quota) && of.1 != Client::Server {
            drop(used);
            return Err(self.exceeded(quota));
        }
        *count += 1;
        drop(used);
        Ok(Share { quotas: self.clone(), of })
    }

    /// Checks a count that is kept elsewhere.
    ///
    /// # Errors
    /// [`QuotaExceeded`] if there is no room for one more.
    pub fn check(&self, quota: Quota, count: usize) -> Result<(), QuotaExceeded> {
        if count < self.limits.of(quota) { Ok(()) } else { Err(self.exceeded(quota)) }
    }

    fn exceeded(&self, quota: Quota) -> QuotaExceeded {
        self.refused.with_label_values(&[quota.name()]).inc();
        QuotaExceeded { quota, limit: self.limits.of(quota) }
    }

    fn used(&self) -> MutexGuard<'_, HashMap<(Quota, Client), usize>> {
        self.used.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Drop for Share {
    fn drop(&mut self) {
        let mut used = self.quotas.used();
        if let Some(count) = used.get_mut(&self.of) {
            *count -= 1;
            if *count == 0 {
                used.remove(&self.of);
            }
        }
    }
}
