//! Reads files again when they have changed, and at once on SIGHUP.

use std::os::unix::fs::MetadataExt as _;
use std::path::{Path, PathBuf};
use std::time::Duration;

use tokio::signal::unix::Signal;
use tokio::time::sleep;

/// How often the files are looked at.
const INTERVAL: Duration = Duration::from_secs(1);

/// Calls `read` whenever one of the files has changed, and with each signal.
pub async fn reload_on_change(files: Vec<PathBuf>, mut signal: Signal, read: impl Fn()) {
    let stamps = || files.iter().map(|file| stamp(file)).collect::<Vec<_>>();
    let mut known = stamps();
    loop {
        let asked = tokio::select! {
            _ = signal.recv() => true,
            () = sleep(INTERVAL) => false,
        };
        let now = stamps();
        if asked || now != known {
            known = now;
            read();
        }
    }
}

/// The metadata that changes with a file, whether it is written to or replaced.
fn stamp(file: &Path) -> Option<[i64; 4]> {
    let data = std::fs::metadata(file).ok()?;
    Some([data.ino().cast_signed(), data.size().cast_signed(), data.ctime(), data.ctime_nsec()])
}
