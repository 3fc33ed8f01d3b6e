//! Keys: `stickslip key new` makes one, and the service reads its own.

use clap::{Subcommand, ValueEnum};
use stickslip::access::{Keys, Role, new_key};

use super::print;
use super::settings::shown;

/// What tells an entry from the path of a file.
const ENTRY: &str = ":sha256:";

/// What can be done with keys.
#[derive(Subcommand)]
pub enum Key {
    /// Make a key: prints it, once and for all, and the entry that makes it known to a service.
    New {
        /// Whose key it is, or what for.
        #[arg(long)]
        name: String,
        /// What it allows; several with commas between them.
        #[arg(long, value_enum, required = true, value_delimiter = ',')]
        role: Vec<RoleName>,
        /// Whose contacts it shows; left out, those of the tenant without a name.
        #[arg(long, default_value = "")]
        tenant: String,
    },
}

/// A role, as it is written.
#[derive(Clone, Copy, ValueEnum)]
pub enum RoleName {
    /// Make, move, fork and delete contacts, and all that `read` allows.
    Write,
    /// Look at contacts, and simulate.
    Read,
    /// Read the metrics, and nothing else.
    Metrics,
}

/// Does it.
pub fn key(key: Key) -> Result<(), String> {
    let Key::New { name, role, tenant } = key;
    let roles: Vec<Role> = role
        .into_iter()
        .map(|role| match role {
            RoleName::Write => Role::Write,
            RoleName::Read => Role::Read,
            RoleName::Metrics => Role::Metrics,
        })
        .collect();
    let new = new_key(&name, &roles, &tenant)?;
    print(format_args!("key   {}\nentry {}", new.key, new.entry))
}

/// The keys of a setting: entries, or files with entries. None if the setting is not there; no entry at all is an error, so
/// that an empty file does not open the service to everybody.
pub fn known(setting: &[String]) -> Result<Option<Keys>, String> {
    if setting.is_empty() {
        return Ok(None);
    }
    let mut keys = Keys::default();
    for part in setting {
        if part.contains(ENTRY) {
            keys.add(part).map_err(|wrong| format!("--keys: {}", wrong.why))?;
        } else {
            let file = shown(part);
            let text = std::fs::read_to_string(part)
                .map_err(|error| format!("--keys {file}: neither a file that can be read nor an entry: {error}"))?;
            keys.add(&text).map_err(|wrong| format!("--keys {file}: {wrong}"))?;
        }
    }
    if keys.count() == 0 {
        return Err("--keys: there is no key in it".to_owned());
    }
    Ok(Some(keys))
}
