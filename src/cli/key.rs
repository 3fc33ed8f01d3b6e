//! `stickslip key new` makes a key; `serve` reads the keys of its setting.

use std::fs::{self, OpenOptions};
use std::io::Write as _;
use std::os::unix::fs::OpenOptionsExt as _;
use std::path::{Path, PathBuf};

use clap::Subcommand;
use jiff::Timestamp;

use super::io::print;
use super::settings::masked;
use crate::access::{Keys, Role, new_key};

/// Distinguishes an entry from the path of a file.
const ENTRY: &str = ":sha256:";

/// Commands about keys.
#[derive(Subcommand)]
pub enum Key {
    /// Make a key, and print it with its entry for --keys of the service. The key is shown only this once.
    New {
        /// Name of the owner or the purpose.
        #[arg(long)]
        name: String,
        /// Roles of the key: `write`, `read`, `metrics`, or several as in `read+metrics`.
        #[arg(long, required = true, value_parser = roles)]
        role: Vec<Vec<Role>>,
        /// Tenant whose contacts it can access [default: the tenant without a name].
        #[arg(long, default_value = "")]
        tenant: String,
        /// When the key expires, such as 2027-01-31T12:00:00Z [default: never].
        #[arg(long)]
        expires_at: Option<Timestamp>,
        /// A note after the entry: what the key is for.
        #[arg(long, value_parser = note)]
        note: Option<String>,
    },
}

/// Parses what one argument says of the roles.
fn roles(text: &str) -> Result<Vec<Role>, String> {
    text.split(['+', ',']).map(str::parse).collect()
}

/// A note must not look like another entry, in a file or in a variable.
fn note(text: &str) -> Result<String, String> {
    let sound = !text.contains(|letter: char| letter.is_control() || letter == ',');
    if sound { Ok(text.to_owned()) } else { Err("a note must be one line without commas".to_owned()) }
}

pub fn key(key: Key) -> Result<(), String> {
    let Key::New { name, role, tenant, expires_at, note } = key;
    let new = new_key(&name, &role.concat(), &tenant, expires_at)?;
    let note = note.map(|note| format!(" # {note}")).unwrap_or_default();
    print(format_args!("key   {}\nentry {}{note}", new.key, new.entry))
}

/// Makes a file with the entry of a new key, for its owner alone, and prints the key; a file that exists stays as it
/// is.
pub fn make_first_key(file: &Path) -> Result<(), String> {
    if fs::symlink_metadata(file).is_ok() {
        return Ok(());
    }
    // Of an operator who is alone.
    let new = new_key("first", &[Role::Write, Role::Metrics], "", None)?;
    let name = masked(&file.to_string_lossy());
    let write = || {
        let mut entries = OpenOptions::new().write(true).create_new(true).mode(0o600).open(file)?;
        let written = writeln!(entries, "{} # made at the first start", new.entry).and_then(|()| entries.sync_all());
        // Half an entry would end the next start.
        written.inspect_err(|_| drop(fs::remove_file(file)))
    };
    write().map_err(|error| format!("--first-key {name}: cannot create the file: {error}"))?;
    print(format_args!("key {}\nis the first key, shown this once; its entry is in {name}", new.key))
}

/// The files of a setting.
pub fn key_files(setting: &[String]) -> impl Iterator<Item = PathBuf> {
    setting.iter().filter(|part| !part.contains(ENTRY)).map(PathBuf::from)
}

/// The keys of a setting: entries, or files with entries. `None` without the setting. A setting without an entry is an
/// error, so that an empty file does not open the service to everybody.
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
        return Err("--keys: no key was found".to_owned());
    }
    Ok(Some(keys))
}
