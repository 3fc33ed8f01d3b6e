//! Distinguishes a file that has been cut off from one whose last pages are still in the write-ahead log, and a log
//! that a crash has cut off from one that is damaged.
//!
//! A crash may come while pages move from the log to the file, so that a file shorter than its header says can be
//! sound: as long as the log has the pages that are missing. SQLite reads a log up to its first frame with a wrong
//! checksum. A crash leaves such a frame in the last commit at most, because every commit is on the disk before the
//! next one begins: if whole commits follow it, they have been acknowledged, and would be lost.

use std::collections::HashSet;
use std::fs::File;
use std::io::{self, BufReader, ErrorKind, Read};
use std::path::Path;

/// Bytes at the beginning of a log, and of each frame in it.
const LOG_HEADER: usize = 32;
const FRAME_HEADER: usize = 24;
/// Where SQLite keeps its locks; the page there is never written.
const LOCKS: u64 = 0x4000_0000;
/// Attempts to read a log that begins anew meanwhile.
const ATTEMPTS: usize = 100;

/// A running checksum of a log.
type Checksum = (u32, u32);

/// What a log has.
#[derive(Default)]
struct Log {
    /// How many pages the database has by the last commit.
    size: Option<u32>,
    /// Which of them the log holds.
    pages: HashSet<u64>,
    /// Where the first frame with a wrong checksum begins.
    bad: Option<u64>,
    /// Commits that follow that frame, and are not the one that it belongs to.
    lost: u64,
}

/// Refuses a file of `length` bytes with pages that are neither in it nor in the log, and a log that is damaged.
pub(super) fn check(header: &[u8], length: u64, log: &Path) -> Result<(), String> {
    let page_size = page_size(header)?;
    let found = read(log)?;
    damage(&found, log)?;
    let size = u64::from(found.size.unwrap_or(field(header, 28)));
    let whole = length / page_size;
    let missing = (whole + 1..=size).find(|page| !found.pages.contains(page) && *page != LOCKS / page_size + 1);
    match missing {
        Some(page) => Err(format!("it is cut off: it has {whole} of {size} pages, and page {page} is missing")),
        None => Ok(()),
    }
}

/// Refuses a log that is damaged. Others may write to it meanwhile.
pub(super) fn check_log(log: &Path) -> Result<(), String> {
    damage(&read(log)?, log)
}

fn damage(found: &Log, log: &Path) -> Result<(), String> {
    let (Some(bad), 1..) = (found.bad, found.lost) else { return Ok(()) };
    Err(format!(
        "its log {0} is damaged at byte {bad}: {1} acknowledged commits behind that would be lost: put back a backup \
         of both files; to give these commits up, cut the log off: truncate --size={bad} {0}",
        log.display(),
        found.lost
    ))
}

fn page_size(header: &[u8]) -> Result<u64, String> {
    match field(header, 16) >> 16 {
        1 => Ok(65_536),
        size if size.is_power_of_two() && size >= 512 => Ok(u64::from(size)),
        _ => Err("it is damaged: its header names no page size".to_owned()),
    }
}

fn read(log: &Path) -> Result<Log, String> {
    let read = || {
        for _ in 0..ATTEMPTS {
            let mut file = BufReader::new(File::open(log)?);
            let mut header = [0; LOG_HEADER];
            if !filled(&mut file, &mut header)? {
                break;
            }
            let found = frames(&mut file, &header)?;
            let mut now = [0; LOG_HEADER];
            // Else it has begun anew, over the frames that were being read.
            if found.lost == 0 || (filled(&mut File::open(log)?, &mut now)? && now == header) {
                return Ok(found);
            }
        }
        Ok(Log::default())
    };
    read().or_else(|error: io::Error| match error.kind() {
        ErrorKind::NotFound => Ok(Log::default()),
        _ => Err(format!("{} cannot be read: {error}", log.display())),
    })
}

/// Reads the frames of a log with this header.
fn frames(log: &mut impl Read, header: &[u8; LOG_HEADER]) -> io::Result<Log> {
    let (is_big_endian, page_size) = (field(header, 0) & 1 == 1, field(header, 8) as usize);
    let (mut found, mut open, mut sum) = (Log::default(), Vec::new(), stored(&header[24..]));
    if !page_size.is_power_of_two() || !(512..=65_536).contains(&page_size) {
        return Ok(found);
    }
    if sum != checksum((0, 0), &header[..24], is_big_endian) {
        found.bad = Some(0);
    }
    let (mut frame, mut at) = (vec![0; FRAME_HEADER + page_size], LOG_HEADER as u64);
    let mut ends = 0;
    while filled(log, &mut frame)? {
        let next = checksum(checksum(sum, &frame[..8], is_big_endian), &frame[FRAME_HEADER..], is_big_endian);
        // A frame with other salts is left from an earlier round of the log.
        let is_whole = frame[8..16] == header[16..24] && next == stored(&frame[16..]);
        let is_commit = field(&frame, 4) > 0;
        match found.bad {
            None if is_whole => {
                open.push(u64::from(field(&frame, 0)));
                if is_commit {
                    found.size = Some(field(&frame, 4));
                    found.pages.extend(open.drain(..));
                }
            }
            None => {
                found.bad = Some(at);
                // Whatever of it is wrong, it may have ended its commit.
                ends = u64::from(is_commit);
            }
            Some(_) => ends += u64::from(is_whole && is_commit),
        }
        // Each is compared with the one before it, so that one bad frame does not make all that follow bad.
        sum = stored(&frame[16..]);
        at += frame.len() as u64;
    }
    // The first of them may be the end of the last commit, which a crash has torn.
    found.lost = ends.saturating_sub(1);
    Ok(found)
}

/// Whether there were enough bytes to fill the buffer.
fn filled(log: &mut impl Read, buffer: &mut [u8]) -> io::Result<bool> {
    match log.read_exact(buffer) {
        Ok(()) => Ok(true),
        Err(error) if error.kind() == ErrorKind::UnexpectedEof => Ok(false),
        Err(error) => Err(error),
    }
}

/// The checksum of SQLite, Fletcher's in a variant, continued over a multiple of eight bytes.
fn checksum((mut first, mut second): Checksum, bytes: &[u8], is_big_endian: bool) -> Checksum {
    let word = |bytes: &[u8]| if is_big_endian { field(bytes, 0) } else { field(bytes, 0).swap_bytes() };
    for pair in bytes.chunks_exact(8) {
        first = first.wrapping_add(word(&pair[..4])).wrapping_add(second);
        second = second.wrapping_add(word(&pair[4..])).wrapping_add(first);
    }
    (first, second)
}

fn stored(bytes: &[u8]) -> Checksum {
    (field(bytes, 0), field(bytes, 4))
}

/// A field of the header of an SQLite file.
pub(super) fn field(header: &[u8], offset: usize) -> u32 {
    header[offset..offset + 4].iter().fold(0, |value, byte| value << 8 | u32::from(*byte))
}
