//! Whether the files of the database are still those that were opened, with what this process has written to them.
//! SQLite goes on writing beside a file that has been replaced, removed or overwritten, and no later start finds what
//! it wrote.

use std::fs::{self, File, Metadata};
use std::io;
use std::os::unix::fs::{FileExt as _, MetadataExt as _};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use parking_lot::Mutex;
use rusqlite::{Error, ffi};

use super::file::MARK;
use super::schema::IN_USE;
use super::wal_check::field;

/// Bytes of the header of a database.
const HEADER: usize = 100;
/// Where the header counts changes.
const COUNTER: usize = 24;

/// The files of a database.
#[derive(Default)]
pub(super) struct OpenFiles {
    /// Paths with the device and inode of the file that has been opened there; the database comes first.
    paths: Vec<(PathBuf, (u64, u64))>,
    /// The database itself, where this process writes to it.
    written: Option<Written>,
    /// Whether the last look at them found other files.
    are_lost: AtomicBool,
}

struct Written {
    // Also the lock: closing any handle of the file ends the locks that SQLite holds on it.
    file: Arc<File>,
    /// How many changes its header counted when it was last looked at, and its length.
    last: Mutex<(u32, u64)>,
}

impl OpenFiles {
    /// The files that are at these paths now.
    pub(super) fn at<'a>(paths: impl IntoIterator<Item = &'a Path>) -> io::Result<OpenFiles> {
        let open = paths.into_iter().map(|path| Ok((path.to_owned(), identity(&fs::metadata(path)?))));
        Ok(OpenFiles { paths: open.collect::<io::Result<_>>()?, ..OpenFiles::default() })
    }

    /// The same where this process alone writes to the database, of which `file` is a handle.
    pub(super) fn written<'a>(file: Arc<File>, paths: impl IntoIterator<Item = &'a Path>) -> io::Result<OpenFiles> {
        let written = Written { last: Mutex::default(), file };
        Ok(OpenFiles { written: Some(written), ..OpenFiles::at(paths)? })
    }

    /// Fails as SQLite does by itself where it has no write-ahead log, if one of them is another file now or gone, or
    /// if the database has been overwritten.
    pub(super) fn check(&self) -> rusqlite::Result<()> {
        let is_open =
            |(path, open): &&(PathBuf, (u64, u64))| fs::metadata(path).is_ok_and(|now| identity(&now) == *open);
        match self.paths.iter().find(|file| !is_open(file)) {
            Some((path, _)) => self.noted(Err(moved(path, "replaced or removed"))),
            None => self.check_content(),
        }
    }

    /// Fails if the database has been overwritten: while pages move from the log to the file it never shrinks, counts
    /// no fewer changes, and stays marked as in use.
    pub(super) fn check_content(&self) -> rusqlite::Result<()> {
        let Some(Written { file, last }) = &self.written else { return self.noted(Ok(())) };
        let now = beginning(file).ok().filter(|(header, _)| field(header, MARK as usize).cast_signed() == IN_USE);
        let mut last = last.lock();
        let now = now.map(|(header, length)| (field(&header, COUNTER), length));
        match now.filter(|now| now.0 >= last.0 && now.1 >= last.1) {
            Some(now) => {
                *last = now;
                self.noted(Ok(()))
            }
            None => {
                let path = self.paths.first().map_or(Path::new(""), |(path, _)| path);
                self.noted(Err(moved(path, "overwritten")))
            }
        }
    }

    /// Whether the last look found the files that were opened.
    pub(super) fn are_ours(&self) -> bool {
        !self.are_lost.load(Ordering::Relaxed)
    }

    fn noted(&self, looked: rusqlite::Result<()>) -> rusqlite::Result<()> {
        self.are_lost.store(looked.is_err(), Ordering::Relaxed);
        looked
    }
}

fn moved(path: &Path, how: &str) -> Error {
    let what = format!("{} has been {how} since it was opened", path.display());
    Error::SqliteFailure(ffi::Error::new(ffi::SQLITE_READONLY_DBMOVED), Some(what))
}

fn beginning(file: &File) -> io::Result<([u8; HEADER], u64)> {
    let mut header = [0; HEADER];
    file.read_exact_at(&mut header, 0)?;
    Ok((header, file.metadata()?.len()))
}

fn identity(file: &Metadata) -> (u64, u64) {
    (file.dev(), file.ino())
}
