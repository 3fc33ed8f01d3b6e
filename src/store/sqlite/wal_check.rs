//! Distinguishes a file that has been cut off from one whose last pages are still in the write-ahead log.
//!
//! A crash may come while pages move from the log to the file, so that a file shorter than its header says can be
//! sound: as long as the log has the pages that are missing.

use std::collections::HashSet;
use std::fs::File;
use std::io::{self, BufReader, ErrorKind, Read as _};
use std::path::Path;

/// Bytes at the beginning of a log, and of each frame in it.
const LOG_HEADER: usize = 32;
const FRAME_HEADER: usize = 24;
/// Where SQLite keeps its locks; the page there is never written.
const LOCKS: u64 = 0x4000_0000;

/// Refuses a file of `length` bytes with pages that are neither in it nor in the log.
pub(super) fn check(header: &[u8], length: u64, log: &Path) -> Result<(), String> {
    let page_size = match field(header, 16) >> 16 {
        1 => 65_536,
        size if size.is_power_of_two() && size >= 512 => u64::from(size),
        _ => return Err("it is damaged: its header names no page size".to_owned()),
    };
    let (logged_size, logged) = match pages(log, page_size) {
        Ok(found) => found,
        Err(error) if error.kind() == ErrorKind::NotFound => (None, HashSet::new()),
        Err(error) => return Err(format!("{} cannot be read: {error}", log.display())),
    };
    let size = u64::from(logged_size.unwrap_or(field(header, 28)));
    let whole = length / page_size;
    let missing = (whole + 1..=size).find(|page| !logged.contains(page) && *page != LOCKS / page_size + 1);
    match missing {
        Some(page) => Err(format!("it is cut off: it has {whole} of {size} pages, and page {page} is missing")),
        None => Ok(()),
    }
}

/// How many pages the database has by the last commit in the log, and which of them the log holds.
fn pages(log: &Path, page_size: u64) -> io::Result<(Option<u32>, HashSet<u64>)> {
    let mut log = BufReader::new(File::open(log)?);
    let mut header = [0; LOG_HEADER];
    let (mut size, mut committed, mut open) = (None, HashSet::new(), Vec::new());
    if !filled(&mut log, &mut header)? {
        return Ok((None, committed));
    }
    let salts = &header[16..24];
    let mut frame = [0; FRAME_HEADER];
    // A frame with other salts is left from an earlier round of the log.
    while filled(&mut log, &mut frame)? && frame[8..16] == *salts {
        open.push(u64::from(field(&frame, 0)));
        if field(&frame, 4) > 0 {
            size = Some(field(&frame, 4));
            committed.extend(open.drain(..));
        }
        log.seek_relative(i64::try_from(page_size).map_err(io::Error::other)?)?;
    }
    Ok((size, committed))
}

/// Whether there were enough bytes to fill the buffer.
fn filled(log: &mut BufReader<File>, buffer: &mut [u8]) -> io::Result<bool> {
    match log.read_exact(buffer) {
        Ok(()) => Ok(true),
        Err(error) if error.kind() == ErrorKind::UnexpectedEof => Ok(false),
        Err(error) => Err(error),
    }
}

/// A field of the header of an SQLite file.
pub(super) fn field(header: &[u8], offset: usize) -> u32 {
    header[offset..offset + 4].iter().fold(0, |value, byte| value << 8 | u32::from(*byte))
}
