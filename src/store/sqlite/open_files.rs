//! Whether the files of the database are still those that were opened. SQLite goes on writing to a file that has been
//! replaced or removed, and no later start finds what it wrote.

use std::fs::{self, Metadata};
use std::io;
use std::os::unix::fs::MetadataExt as _;
use std::path::{Path, PathBuf};

use rusqlite::{Error, ffi};

/// Paths with the device and inode of the file that has been opened there.
#[derive(Default)]
pub(super) struct OpenFiles(Vec<(PathBuf, (u64, u64))>);

impl OpenFiles {
    /// The files that are at these paths now.
    pub(super) fn at<'a>(paths: impl IntoIterator<Item = &'a Path>) -> io::Result<OpenFiles> {
        let open = paths.into_iter().map(|path| Ok((path.to_owned(), identity(&fs::metadata(path)?))));
        open.collect::<io::Result<_>>().map(OpenFiles)
    }

    /// Fails as SQLite does by itself where it has no write-ahead log, if one of them is another file now or gone.
    pub(super) fn check(&self) -> rusqlite::Result<()> {
        let is_open =
            |(path, open): &&(PathBuf, (u64, u64))| fs::metadata(path).is_ok_and(|now| identity(&now) == *open);
        match self.0.iter().find(|file| !is_open(file)) {
            None => Ok(()),
            Some((path, _)) => {
                let what = format!("{} has been replaced or removed since it was opened", path.display());
                Err(Error::SqliteFailure(ffi::Error::new(ffi::SQLITE_READONLY_DBMOVED), Some(what)))
            }
        }
    }
}

fn identity(file: &Metadata) -> (u64, u64) {
    (file.dev(), file.ino())
}
