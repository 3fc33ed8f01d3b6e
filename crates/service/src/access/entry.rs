//! Entries of a file of keys, and new keys.

use jiff::Timestamp;
use sha2::{Digest as _, Sha256};

use crate::tenant::Tenant;

use super::{Hash, Holder, Role};

/// What every key begins with, so that a leaked key can be recognised.
const PREFIX: &str = "stickslip_";
/// Random bytes of a new key.
const RANDOM: usize = 32;
/// Characters of the name of a key or tenant.
const NAME_LENGTH: usize = 64;

/// An invalid entry of a file of keys.
#[derive(Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: {why}")]
pub struct InvalidEntry {
    /// Its line, from 1.
    pub line: usize,
    /// What is wrong with it.
    pub why: String,
}

/// A newly generated key.
pub struct NewKey {
    /// The key, for its user. It cannot be recovered.
    pub key: String,
    /// The entry for the file of keys of a service.
    pub entry: String,
}

/// Generates a key from the randomness of the system. It counts until `expires_at`, if that is given.
///
/// # Errors
/// The reason in one line.
pub fn new_key(name: &str, roles: &[Role], tenant: &str, expires_at: Option<Timestamp>) -> Result<NewKey, String> {
    let mut random = [0; RANDOM];
    getrandom::fill(&mut random).map_err(|error| format!("the system gives no random numbers: {error}"))?;
    let key = format!("{PREFIX}{}", const_hex::encode(random));
    let roles: Vec<&str> = roles.iter().map(|role| role.name()).collect();
    let hash = const_hex::encode(Sha256::digest(key.as_bytes()));
    let end = expires_at.map(|expires_at| format!(":{expires_at}")).unwrap_or_default();
    let entry = format!("{name}:{}:{tenant}:sha256:{hash}{end}", roles.join("+"));
    parse(&entry)?;
    Ok(NewKey { key, entry })
}

pub(super) fn parse(entry: &str) -> Result<Holder, String> {
    let mut parts = entry.splitn(6, ':');
    let parts: [Option<&str>; 6] = std::array::from_fn(|_| parts.next());
    let [Some(name), Some(roles), Some(tenant), Some("sha256"), Some(hash), end] = parts else {
        let expected =
            "expected name:roles:tenant:sha256:hash, where the tenant may be empty and :expires_at may follow";
        return Err(expected.to_owned());
    };
    if name.is_empty() || !is_name(name) {
        return Err(invalid_name("the name of a key"));
    }
    if !is_name(tenant) {
        return Err(invalid_name("the name of a tenant"));
    }
    let roles = roles.split('+').map(str::parse).collect::<Result<_, _>>()?;
    // The library would take a prefix, too.
    let hash: Option<Hash> =
        const_hex::decode_to_array(hash).ok().filter(|hashed: &Hash| hash.len() == 2 * hashed.len());
    let hash = hash.ok_or("expected the SHA-256 of the key as 64 hexadecimal digits")?;
    let expires_at = end.map(str::parse).transpose();
    let expires_at = expires_at.map_err(|_| "expected the expiry of the key as 2027-01-31T12:00:00Z")?;
    Ok(Holder { name: name.into(), roles, tenant: Tenant::new(tenant), expires_at, hash })
}

fn invalid_name(what: &str) -> String {
    format!("{what} must be at most {NAME_LENGTH} letters, digits, dots, hyphens or underscores")
}

fn is_name(text: &str) -> bool {
    text.len() <= NAME_LENGTH && text.bytes().all(|byte| byte.is_ascii_alphanumeric() || b".-_".contains(&byte))
}
