//! `stickslip key new` makes a key; `serve` reads the keys of its setting.

use std::path::PathBuf;

use clap::Subcommand;
use jiff::Timestamp;
use stickslip::access::{Keys, Role, new_key_until};

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
        /// Roles of the key: `write`, `read`, `metrics`, or several as in `read+metrics`.
        #[arg(long, required = true, value_parser = roles)]
        role: Vec<Roles>,
        /// Tenant whose contacts it can access [default: the tenant without a name].
        #[arg(long, default_value = "")]
        tenant: String,
        /// When the key ends, such as 2027-01-31T12:00:00Z [default: never].
        #[arg(long)]
        expires_at: Option<Timestamp>,
        /// What the key is for, as a note behind its entry.
        #[arg(long, value_parser = note)]
        note: Option<String>,
    },
}

/// What one argument says of the roles.
#[derive(Clone)]
pub struct Roles(Vec<Role>);

fn roles(text: &str) -> Result<Roles, String> {
    text.split(['+', ',']).map(str::parse).collect::<Result<_, _>>().map(Roles)
}

/// A note must not look like another entry, in a file or in a variable.
fn note(text: &str) -> Result<String, String> {
    let sound = !text.contains(|letter: char| letter.is_control() || letter == ',');
    if sound { Ok(text.to_owned()) } else { Err("a note is one line without commas".to_owned()) }
}

/// Makes a key and prints it.
pub fn key(key: Key) -> Result<(), String> {
    let Key::New { name, role, tenant, expires_at, note } = key;
    let roles: Vec<Role> = role.into_iter().flat_map(|Roles(roles)| roles).collect();
    let new = new_key_until(&name, &roles, &tenant, expires_at)?;
    let note = note.map(|note| format!(" # {note}")).unwrap_or_default();
    print(format_args!("key   {}\nentry {}{note}", new.key, new.entry))
}

/// The files of a setting.
pub fn key_files(setting: &[String]) -> impl Iterator<Item = PathBuf> {
    setting.iter().filter(|part| !part.contains(ENTRY)).map(PathBuf::from)
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
