//! `stickslip key new` makes a key; `serve` reads the keys of its setting.

use clap::{Subcommand, ValueEnum};
use stickslip::access::{Keys, Role, new_key};

use super::io::print;
use super::settings::masked;

/// Distinguishes an entry from the path of a file.
const ENTRY: &str = ":sha256:";

/// Commands about keys.
#[derive(Subcommand)]
pub enum Key {
    /// Make a key: print it, which happens only once, and its entry for --keys of the service.
    New {
        /// Name of the owner or the purpose.
        #[arg(long)]
        name: String,
        /// Roles of the key, separated by commas.
        #[arg(long, value_enum, required = true, value_delimiter = ',')]
        role: Vec<RoleName>,
        /// Tenant whose contacts it can access [default: the tenant without a name].
        #[arg(long, default_value = "")]
        tenant: String,
    },
}

/// The roles by name.
#[derive(Clone, Copy, ValueEnum)]
pub enum RoleName {
    /// Create, move, fork and delete contacts, and all that `read` allows.
    Write,
    /// Read contacts, and simulate.
    Read,
    /// Read the metrics, and nothing else.
    Metrics,
}

/// Makes a key and prints it.
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

/// The keys of a setting: entries, or files with entries. `None` without the setting. A setting without an entry is an error,
/// so that an empty file does not open the service to everybody.
pub fn read_keys(setting: &[String]) -> Result<Option<Keys>, String> {
    if setting.is_empty() {
        return Ok(None);
    }
    let mut keys = Keys::default();
    for part in setting {
        if part.contains(ENTRY) {
            keys.add(part).map_err(|wrong| format!("--keys: {}", wrong.why))?;
        } else {
            let file = masked(part);
            let text = std::fs::read_to_string(part)
                .map_err(|error| format!("--keys {file}: neither a file that can be read nor an entry: {error}"))?;
            keys.add(&text).map_err(|wrong| format!("--keys {file}: {wrong}"))?;
        }
    }
    if keys.count() == 0 {
        return Err("--keys: no key is given".to_owned());
    }
    Ok(Some(keys))
}
