//! Access control: keys, their roles and tenants, independent of HTTP.
//!
//! Only the SHA-256 hash of a key is kept. A slow hash protects passwords, which can be guessed; a key is 256 random
//! bits, which cannot, and it is hashed for every request.

mod entry;

use std::collections::{HashMap, HashSet};
use std::str::FromStr;
use std::sync::Arc;

use jiff::Timestamp;
use sha2::{Digest as _, Sha256};

use crate::tenant::Tenant;

pub use entry::{InvalidEntry, NewKey, new_key};

/// Bytes of a key that a client may present. A shorter one could be guessed.
const KEY_LENGTH: std::ops::RangeInclusive<usize> = 32..=256;

/// SHA-256 of a key.
type Hash = [u8; 32];

/// What a key allows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Create, move, fork and delete contacts, and all that [`Role::Read`] allows.
    Write,
    /// Read contacts, and run simulations that are not stored.
    Read,
    /// Read the metrics of the service, and nothing else.
    Metrics,
}

impl Role {
    /// All roles.
    pub const ALL: [Role; 3] = [Role::Write, Role::Read, Role::Metrics];

    /// Its name in a file of keys.
    pub fn name(self) -> &'static str {
        match self {
            Role::Write => "write",
            Role::Read => "read",
            Role::Metrics => "metrics",
        }
    }
}

impl FromStr for Role {
    type Err = String;

    fn from_str(text: &str) -> Result<Role, String> {
        let role = Role::ALL.into_iter().find(|role| role.name() == text);
        role.ok_or_else(|| "expected one or more of the roles write, read, metrics, joined by +".to_owned())
    }
}

/// The holder of a key.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Holder {
    /// The name of the key, for the log.
    pub name: Arc<str>,
    /// What it allows.
    pub roles: Vec<Role>,
    /// Whose contacts it shows.
    pub tenant: Tenant,
    /// Until when the key counts, if it ends.
    pub expires_at: Option<Timestamp>,
    hash: Hash,
}

impl Holder {
    /// Whether the key allows what a role is for.
    #[must_use]
    pub fn allows(&self, role: Role) -> bool {
        self.roles.contains(&role) || (role == Role::Read && self.roles.contains(&Role::Write))
    }

    /// Whether the key has ended.
    #[must_use]
    pub fn has_expired(&self) -> bool {
        self.expires_at.is_some_and(|expires_at| expires_at <= Timestamp::now())
    }
}

/// All known keys, by their hashes. The time of a lookup depends on hashes alone, which are no secrets: nobody finds
/// the key to one.
#[derive(Debug, Default)]
pub struct Keys {
    holders: HashMap<Hash, Arc<Holder>>,
    names: HashSet<Arc<str>>,
}

impl Keys {
    /// Adds the keys of a text: entries `name:roles:tenant:sha256:hash` or `name:roles:tenant:sha256:hash:expires_at`,
    /// one per line or separated by commas. Roles are joined by `+`, the tenant may be empty, and `#` begins a note.
    ///
    /// # Errors
    /// [`InvalidEntry`] with the line and the reason. It shows nothing of a key.
    pub fn add(&mut self, text: &str) -> Result<(), InvalidEntry> {
        for (index, line) in text.lines().enumerate() {
            let content = line.split('#').next().unwrap_or_default();
            for entry in content.split(',').map(str::trim).filter(|entry| !entry.is_empty()) {
                let wrong = |why: &str| InvalidEntry { line: index + 1, why: why.to_owned() };
                let holder = entry::parse(entry).map_err(|why| wrong(&why))?;
                if self.names.contains(&holder.name) {
                    return Err(wrong("another key has this name"));
                }
                if self.holders.contains_key(&holder.hash) {
                    return Err(wrong("the same key has two entries"));
                }
                self.names.insert(Arc::clone(&holder.name));
                self.holders.insert(holder.hash, Arc::new(holder));
            }
        }
        Ok(())
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.holders.len()
    }

    /// The holder of the presented key, if it is known.
    pub fn holder(&self, presented: &[u8]) -> Option<&Arc<Holder>> {
        if !KEY_LENGTH.contains(&presented.len()) {
            return None;
        }
        self.holders.get(&Hash::from(Sha256::digest(presented)))
    }

    /// Whether this very key still counts: it is known, allows what it did, and has not ended.
    #[must_use]
    pub fn holds(&self, holder: &Holder) -> bool {
        self.holders.get(&holder.hash).is_some_and(|known| **known == *holder) && !holder.has_expired()
    }
}
