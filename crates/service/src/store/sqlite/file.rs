//! Opening the file: created completely or not at all, used by one process at a time, and not modified if it is
//! damaged.

use std::ffi::OsString;
use std::fs::{File, OpenOptions, Permissions, TryLockError};
use std::io::{self, ErrorKind};
use std::os::unix::fs::{FileExt as _, OpenOptionsExt as _, PermissionsExt as _};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use jiff::Timestamp;
use rusqlite::config::DbConfig;
use rusqlite::{Connection, OpenFlags};

use crate::store::schema::SchemaError;

use super::fault::is_full;
use super::open_files::OpenFiles;
use super::readers::{Readers, open_reader};
use super::schema::{self, APPLICATION, IN_USE, MIGRATIONS};
use super::{BUSY, wal_check};

/// What every SQLite file begins with.
const MAGIC: &[u8] = b"SQLite format 3\0";
/// Where the header has the mark of this program.
pub(super) const MARK: u64 = 68;
/// Who may read and write the files: their owner alone. SQLite gives the files beside a database the same mode.
const PRIVATE: u32 = 0o600;
/// Up to this size a file is read whole before it is trusted, which takes a fraction of a second.
const SMALL: u64 = 32 * 1024 * 1024;
/// Pages of the write-ahead log (16 MiB) at which its content moves to the file.
const CHECKPOINT_PAGES: i32 = 4_000;
/// Bytes of the write-ahead log that are kept on the disk to be overwritten.
const LOG_BYTES: i64 = 64 * 1024 * 1024;
/// KiB of pages that the writer caches; SQLite wants the number negative.
const CACHE: i32 = -65_536;
/// Statements that the writer keeps prepared.
const STATEMENTS: usize = 64;

/// A database at the newest version of the tables, and the lock that keeps other processes of ours away. The lock is to
/// outlive the connection: closing any handle of the file ends the locks that SQLite holds on it.
pub(super) struct Opened {
    pub(super) database: Connection,
    pub(super) lock: Arc<File>,
    pub(super) files: Arc<OpenFiles>,
}

pub(super) enum Access {
    Writable(Opened),
    /// There is no room to write.
    Full {
        why: String,
        readers: Readers,
    },
}

/// Why a file cannot be written to.
enum Refusal {
    Unusable(String),
    Full(String),
}

/// Opens the database at a path, or makes one.
pub(super) fn open(path: &Path) -> Result<Access, String> {
    let lock = match OpenOptions::new().read(true).write(true).open(path) {
        Ok(file) => {
            lock(&file)?;
            if length(&file)? == 0 { create(path)? } else { file }
        }
        Err(error) if error.kind() == ErrorKind::NotFound => create(path)?,
        Err(error) if error.kind() == ErrorKind::IsADirectory => return Err("it is a folder".to_owned()),
        Err(error) => return Err(error.to_string()),
    };
    let lock = Arc::new(lock);
    inspect(path, &lock)?;
    let shared_memory = beside(path, "-shm");
    let (log, had_log, had_shared_memory) =
        (beside(path, "-wal"), beside(path, "-wal").exists(), shared_memory.exists());
    let connected = connect(path).and_then(|database| {
        let files = OpenFiles::written(Arc::clone(&lock), [path, &log, &shared_memory]);
        Ok((database, Arc::new(files.map_err(|error| Refusal::Unusable(error.to_string()))?)))
    });
    match connected {
        Ok((database, files)) => Ok(Access::Writable(Opened { database, lock, files })),
        Err(refusal) => {
            // Removes the files that SQLite has created beside a refused file.
            for (file, had) in [(log, had_log), (shared_memory, had_shared_memory)] {
                if !had
                    && let Err(error) = std::fs::remove_file(&file)
                    && error.kind() != ErrorKind::NotFound
                {
                    tracing::debug!(%error, file = %file.display(), "could not be removed");
                }
            }
            match refusal {
                Refusal::Unusable(why) => Err(why),
                Refusal::Full(why) => open_full(path, lock).map(|readers| Access::Full { why, readers }),
            }
        }
    }
}

/// Readers of a file beside which there is no room.
fn open_full(path: &Path, lock: Arc<File>) -> Result<Readers, String> {
    // Without changes in a log the file is all there is; else its shared memory is there too.
    let immutable = length_at(&beside(path, "-wal")) == 0;
    let describe = |error: &dyn std::fmt::Display| error.to_string();
    let database = open_reader(path, immutable).map_err(|error| describe(&error))?;
    schema::check(&database).map_err(|error| describe(&error))?;
    let files = Arc::new(OpenFiles::at([path]).map_err(|error| describe(&error))?);
    Ok(Readers::new(path.to_owned(), files, Some(lock), immutable))
}

/// Makes a database under another name and renames it when it is whole, so that no crash leaves half of one.
fn create(path: &Path) -> Result<File, String> {
    let log = beside(path, "-wal");
    if std::fs::metadata(&log).is_ok_and(|log| log.len() > 0) {
        return Err(format!("the file is missing, but its log {} exists: put the file back beside it", log.display()));
    }
    let partial = beside(path, ".new");
    let made = make(path, &partial);
    if made.is_err() && length_at(path) == 0 {
        // Best effort: what stays is overwritten by the next start.
        let _ = std::fs::remove_file(&partial);
    }
    made
}

fn make(path: &Path, partial: &Path) -> Result<File, String> {
    let describe = |error: &dyn std::fmt::Display| format!("it cannot be created: {error}");
    let file = open_private(partial).map_err(|error| describe(&error))?;
    lock(&file)?;
    if length_at(path) > 0 {
        return Err("another process has just created it".to_owned());
    }
    file.set_len(0).map_err(|error| describe(&error))?;
    let mut database = Connection::open_with_flags(partial, write_flags()).map_err(|error| describe(&error))?;
    schema::migrate(&mut database, MIGRATIONS).map_err(|error| describe(&error))?;
    database.close().map_err(|(_, error)| describe(&error))?;
    std::fs::rename(partial, path).and_then(|()| sync_folder(path)).map_err(|error| describe(&error))?;
    tracing::warn!(path = %path.display(), "there was no store at this path: an empty one has been made");
    Ok(file)
}

/// Checks the file without SQLite, which would create files beside it.
fn inspect(path: &Path, file: &File) -> Result<(), String> {
    let mut header = [0; 100];
    let length = length(file)?;
    let read = file.read_exact_at(&mut header, 0);
    if read.is_err() || !header.starts_with(MAGIC) {
        return Err("it is not an SQLite database, or is cut off".to_owned());
    }
    let log = beside(path, "-wal");
    check_mark(wal_check::field(&header, MARK as usize).cast_signed(), path, std::fs::symlink_metadata(&log).is_ok())?;
    schema::known(wal_check::field(&header, 60).cast_signed())?;
    wal_check::check(&header, length, &log)
}

/// Refuses the mark of another application, and that of a file in use that has lost its log.
pub(super) fn check_mark(mark: i32, path: &Path, has_log: bool) -> Result<(), String> {
    match mark {
        APPLICATION => Ok(()),
        IN_USE if has_log => Ok(()),
        IN_USE => Err(format!(
            "it was not closed, and its log {0} is missing, which may have its last changes: put the log back; to \
             accept the file as it is, make an empty {0}",
            beside(path, "-wal").display()
        )),
        _ => Err("it is an SQLite database of another application".to_owned()),
    }
}

/// Connects the writer, and brings the tables up to date.
fn connect(path: &Path) -> Result<Connection, Refusal> {
    let describe = |error: rusqlite::Error| match error.sqlite_error_code() {
        Some(rusqlite::ErrorCode::DatabaseCorrupt | rusqlite::ErrorCode::NotADatabase) => {
            Refusal::Unusable(format!("it is damaged: {error}"))
        }
        _ if is_full(&error) => Refusal::Full(error.to_string()),
        _ => Refusal::Unusable(error.to_string()),
    };
    let mut database = Connection::open_with_flags(path, write_flags()).map_err(describe)?;
    // Until it is accepted, nothing moves from the log to the file, not even when the connection is closed.
    database.set_db_config(DbConfig::SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, true).map_err(describe)?;
    database.busy_timeout(BUSY).map_err(describe)?;
    schema::known(schema::version(&database).map_err(describe)?).map_err(Refusal::Unusable)?;
    if length_at(path) + length_at(&beside(path, "-wal")) <= SMALL {
        let verdict: String = database.query_row("PRAGMA quick_check(1)", [], |row| row.get(0)).map_err(describe)?;
        if verdict != "ok" {
            return Err(Refusal::Unusable(format!("it is damaged: {}", verdict.replace('\n', " "))));
        }
    }
    let mode: String = database.query_row("PRAGMA journal_mode = WAL", [], |row| row.get(0)).map_err(describe)?;
    if mode != "wal" {
        return Err(Refusal::Unusable(format!("write-ahead logging is not available there, only {mode}")));
    }
    database.pragma_update(None, "synchronous", "FULL").map_err(describe)?;
    prepare(&database).map_err(describe)?;
    database.pragma_update(None, "cache_size", CACHE).map_err(describe)?;
    database.query_row(&format!("PRAGMA wal_autocheckpoint = {CHECKPOINT_PAGES}"), [], |_| Ok(())).map_err(describe)?;
    database.query_row(&format!("PRAGMA journal_size_limit = {LOG_BYTES}"), [], |_| Ok(())).map_err(describe)?;
    schema::migrate(&mut database, MIGRATIONS).map_err(|error| match error {
        SchemaError::Database(error) => describe(error),
        SchemaError::Version(why) => Refusal::Unusable(why),
    })?;
    schema::mark(&database, IN_USE).map_err(describe)?;
    // The version and the mark must be in the file itself, where the next start looks for them first.
    database.query_row("PRAGMA wal_checkpoint(TRUNCATE)", [], |_| Ok(())).map_err(describe)?;
    database.set_db_config(DbConfig::SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, false).map_err(describe)?;
    Ok(database)
}

/// What the connection of a writer needs, wherever the database is.
pub(super) fn prepare(database: &Connection) -> rusqlite::Result<()> {
    database.set_prepared_statement_cache_capacity(STATEMENTS);
    database.pragma_update(None, "foreign_keys", true)
}

pub(super) fn lock(file: &File) -> Result<(), String> {
    match file.try_lock() {
        Ok(()) => Ok(()),
        Err(TryLockError::WouldBlock) => Err("another process is using it".to_owned()),
        Err(TryLockError::Error(error)) => Err(format!("it cannot be locked: {error}")),
    }
}

/// A file for its owner alone, made if it is not there.
pub(super) fn open_private(path: &Path) -> io::Result<File> {
    let mut options = OpenOptions::new();
    let file = options.read(true).write(true).create(true).truncate(false).mode(PRIVATE).open(path)?;
    // An earlier program may have left it with another mode.
    file.set_permissions(Permissions::from_mode(PRIVATE))?;
    Ok(file)
}

fn write_flags() -> OpenFlags {
    OpenFlags::SQLITE_OPEN_READ_WRITE | OpenFlags::SQLITE_OPEN_NO_MUTEX
}

/// The file beside `path` whose name is longer by `ending`.
pub(super) fn beside(path: &Path, ending: &str) -> PathBuf {
    let mut name = OsString::from(path);
    name.push(ending);
    name.into()
}

fn length(file: &File) -> Result<u64, String> {
    let about = file.metadata().map_err(|error| error.to_string())?;
    if about.is_file() { Ok(about.len()) } else { Err("it is not a file".to_owned()) }
}

/// When a database or its log was last written to.
pub(super) fn last_write(path: &Path) -> Option<Timestamp> {
    let written = |path: &Path| std::fs::metadata(path).and_then(|about| about.modified()).ok();
    let last = written(path).max(written(&beside(path, "-wal")))?;
    Timestamp::try_from(last).ok()
}

pub(super) fn length_at(path: &Path) -> u64 {
    std::fs::metadata(path).map_or(0, |about| about.len())
}

/// Makes a rename durable.
pub(super) fn sync_folder(path: &Path) -> io::Result<()> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    File::open(folder)?.sync_all()
}
