//! Resource use of this process, as the system reports it.

use std::fs;

/// Ticks in a second of processor time, as Linux shows it to all programs.
const TICKS: f64 = 100.0;

/// The resources in use. What the system does not report is left out.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Process {
    /// Bytes of memory in use.
    pub resident_bytes: Option<u64>,
    /// Threads.
    pub threads: Option<u64>,
    /// Processor time since the start, s.
    pub processor_seconds: Option<f64>,
    /// Files and sockets that are open.
    pub open_files: Option<u64>,
    /// How many may be open.
    pub most_open_files: Option<u64>,
}

impl Process {
    /// Reads the present values.
    #[must_use]
    pub fn now() -> Process {
        let read = |name: &str| fs::read_to_string(format!("/proc/self/{name}")).unwrap_or_default();
        let (status, limits, stat) = (read("status"), read("limits"), read("stat"));
        Process {
            resident_bytes: number(&status, "VmRSS:").map(|kilobytes| kilobytes * 1024),
            threads: number(&status, "Threads:"),
            processor_seconds: processor_seconds(&stat),
            // The folder is itself open while it is read.
            open_files: fs::read_dir("/proc/self/fd").ok().map(|all| all.count().saturating_sub(1) as u64),
            most_open_files: number(&limits, "Max open files"),
        }
    }
}

/// The first number behind a name at the beginning of a line.
fn number(text: &str, name: &str) -> Option<u64> {
    text.lines().find_map(|line| line.strip_prefix(name))?.split_whitespace().next()?.parse().ok()
}

/// The fields of `/proc/self/stat` are counted from behind the program's name, which is in parentheses.
fn processor_seconds(stat: &str) -> Option<f64> {
    let mut fields = stat.rsplit_once(')')?.1.split_whitespace().skip(11);
    let (user, system) = (fields.next()?.parse::<f64>().ok()?, fields.next()?.parse::<f64>().ok()?);
    Some((user + system) / TICKS)
}

#[cfg(test)]
mod tests {
    use super::{Process, processor_seconds};

    #[test]
    fn a_process_sees_itself() {
        let now = Process::now();
        assert!(now.resident_bytes.is_some_and(|bytes| (1 << 20..1 << 40).contains(&bytes)), "{now:?}");
        assert!(
            now.open_files.zip(now.most_open_files).is_some_and(|(open, most)| 3 <= open && open <= most),
            "{now:?}"
        );
        assert!(now.threads.is_some_and(|threads| threads >= 1), "{now:?}");
        let stat = "1 (a ) b) S 0 1 1 0 -1 4194560 1 2 3 4 250 150 0 0 20 0 1 0 5 6 7";
        assert_eq!(processor_seconds(stat).map(f64::to_bits), Some(4.0_f64.to_bits()));
    }
}
