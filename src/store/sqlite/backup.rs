//! A copy of the file, made while others write to it; and looking at it without writing.

use std::fs::{self, File, OpenOptions};
use std::io::{self, ErrorKind};
use std::path::Path;

use rusqlite::Connection;

use super::file::{beside, lock, sync_folder};
use super::readers::open_reader;
use super::schema::{self, APPLICATION};

/// A connection that only reads, to a store that this program knows.
pub(super) fn open_read_only(path: &Path) -> Result<Connection, String> {
    // SQLite would say no more than that it cannot open it.
    fs::metadata(path).map_err(|error| error.to_string())?;
    let said = |error: rusqlite::Error| error.to_string();
    let database = open_reader(path).map_err(said)?;
    let application: i32 = database.pragma_query_value(None, "application_id", |row| row.get(0)).map_err(said)?;
    if application != APPLICATION {
        return Err("it is an SQLite database of another application".to_owned());
    }
    schema::check(&database).map_err(|error| error.to_string())?;
    Ok(database)
}

/// Copies the store at a path to a file that is not there yet: one state of it, whatever is written meanwhile. The copy gets
/// its name when it is whole and on the disk. Says how many bytes it has.
pub(super) fn backup(path: &Path, copy: &Path) -> Result<u64, String> {
    let said = |error: io::Error| format!("{}: {error}", copy.display());
    if fs::symlink_metadata(copy).is_ok() {
        return Err(format!("{} is there already, and is left as it is", copy.display()));
    }
    let database = open_read_only(path)?;
    let young = beside(copy, ".new");
    // What a copy that was cut off has left is written over; the lock tells it from one under way.
    let file = OpenOptions::new().read(true).write(true).create(true).truncate(false).open(&young).map_err(said)?;
    lock(&file).map_err(|why| format!("{}: {why}", young.display()))?;
    let copied = copied(&database, &file, &young).and_then(|bytes| {
        publish(&young, copy).map_err(said)?;
        Ok(bytes)
    });
    if copied.is_err() {
        // Best effort: what stays is written over by the next attempt.
        let _ = fs::remove_file(&young);
    }
    copied
}

fn copied(database: &Connection, file: &File, young: &Path) -> Result<u64, String> {
    let said = |error: io::Error| format!("{}: {error}", young.display());
    file.set_len(0).map_err(said)?;
    let name = young.to_str().ok_or("the name of the copy must be UTF-8")?;
    database.execute("VACUUM INTO ?1", [name]).map_err(|error| error.to_string())?;
    file.sync_all().map_err(said)?;
    Ok(file.metadata().map_err(said)?.len())
}

/// Gives the copy its name, which nobody else must have taken meanwhile.
fn publish(young: &Path, copy: &Path) -> io::Result<()> {
    match fs::hard_link(young, copy) {
        Ok(()) => fs::remove_file(young)?,
        Err(error) if error.kind() == ErrorKind::AlreadyExists => return Err(error),
        // Not every file system has a second name for a file.
        Err(_) if fs::symlink_metadata(copy).is_err() => fs::rename(young, copy)?,
        Err(error) => return Err(error),
    }
    sync_folder(copy)
}
