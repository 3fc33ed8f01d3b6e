//! A copy of the file, made while others write to it; and looking at it without writing.

use std::fs::{self, File};
use std::io::{self, ErrorKind};
use std::os::unix::fs::FileExt as _;
use std::path::Path;
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::Duration;

use rusqlite::Connection;

use super::file::{MARK, beside, check_mark, lock, open_private, sync_folder};
use super::readers::open_reader;
use super::schema::{self, APPLICATION, IN_USE};
use super::wal_check;

/// How often the size of a copy is looked at.
const POLL: Duration = Duration::from_millis(100);

/// A read-only connection to a store of a version that this program supports.
pub(super) fn open_read_only(path: &Path) -> Result<Connection, String> {
    // SQLite would say no more than that it cannot open it.
    fs::metadata(path).map_err(|error| error.to_string())?;
    if fs::symlink_metadata(beside(path, "-wal")).is_err() && mark(path).is_ok_and(|mark| mark == IN_USE) {
        check_mark(IN_USE, path, false)?;
    }
    wal_check::check_log(&beside(path, "-wal"))?;
    let describe = |error: rusqlite::Error| error.to_string();
    let database = open_reader(path, false).map_err(describe)?;
    let application: i32 = database.pragma_query_value(None, "application_id", |row| row.get(0)).map_err(describe)?;
    check_mark(application, path, true)?;
    schema::check(&database).map_err(|error| error.to_string())?;
    Ok(database)
}

/// The mark in the header of a file, read without SQLite, which would make a log. No process of ours has the file open
/// where there is no log: closing it here ends no lock.
fn mark(path: &Path) -> io::Result<i32> {
    let mut mark = [0; 4];
    File::open(path)?.read_exact_at(&mut mark, MARK)?;
    Ok(i32::from_be_bytes(mark))
}

/// Copies the store at a path to a file that is not there yet: one state of it, whatever is written meanwhile. The copy
/// gets its name when it is complete and on the disk. Returns its bytes. Calls `progress` meanwhile with its bytes so
/// far and those of the store.
pub(in crate::store) fn backup(path: &Path, copy: &Path, progress: impl FnMut(u64, u64) + Send) -> Result<u64, String> {
    let describe = |error: io::Error| format!("{}: {error}", copy.display());
    if fs::symlink_metadata(copy).is_ok() {
        return Err(format!("{} already exists, and is not overwritten", copy.display()));
    }
    let database = open_read_only(path)?;
    let partial = beside(copy, ".new");
    // The remains of an interrupted copy are overwritten; the lock distinguishes them from a copy under way.
    let file = open_private(&partial).map_err(describe)?;
    lock(&file).map_err(|why| format!("{}: {why}", partial.display()))?;
    let whole = fs::metadata(path).map_or(0, |found| found.len());
    let copied = watched(&file, whole, progress, || copied(&database, &file, &partial)).and_then(|bytes| {
        publish(&partial, copy).map_err(describe)?;
        Ok(bytes)
    });
    if copied.is_err() {
        // Best effort: what stays is overwritten by the next attempt.
        let _ = fs::remove_file(&partial);
    }
    copied
}

/// The result of `work`, during which `progress` receives the length of a file now and then.
fn watched<T>(file: &File, whole: u64, mut progress: impl FnMut(u64, u64) + Send, work: impl FnOnce() -> T) -> T {
    thread::scope(|scope| {
        let (working, ended) = mpsc::channel::<()>();
        scope.spawn(move || {
            while ended.recv_timeout(POLL) == Err(RecvTimeoutError::Timeout) {
                progress(file.metadata().map_or(0, |found| found.len()), whole);
            }
        });
        let result = work();
        drop(working);
        result
    })
}

fn copied(database: &Connection, file: &File, partial: &Path) -> Result<u64, String> {
    let describe = |error: io::Error| format!("{}: {error}", partial.display());
    file.set_len(0).map_err(describe)?;
    let name = partial.to_str().ok_or("the name of the copy must be UTF-8")?;
    database.execute("VACUUM INTO ?1", [name]).map_err(|error| error.to_string())?;
    // The copy of a file in use is whole, and in nobody's use.
    file.write_all_at(&APPLICATION.to_be_bytes(), MARK).map_err(describe)?;
    file.sync_all().map_err(describe)?;
    Ok(file.metadata().map_err(describe)?.len())
}

/// Gives the copy its name, unless a file of that name has been made meanwhile.
fn publish(partial: &Path, copy: &Path) -> io::Result<()> {
    match fs::hard_link(partial, copy) {
        Ok(()) => fs::remove_file(partial)?,
        Err(error) if error.kind() == ErrorKind::AlreadyExists => return Err(error),
        // Not every file system has a second name for a file.
        Err(_) if fs::symlink_metadata(copy).is_err() => fs::rename(partial, copy)?,
        Err(error) => return Err(error),
    }
    sync_folder(copy)
}
