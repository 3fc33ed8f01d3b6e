//! Resource use of this process, as the system reports it.

use std::fs;

use rustix::time::{ClockId, clock_gettime};

/// Processor time since the start, s.
#[must_use]
pub fn processor_seconds() -> f64 {
    let time = clock_gettime(ClockId::ProcessCPUTime);
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}

/// What is in use, by the names and descriptions of metrics. What the system does not report is left out.
pub fn gauges() -> impl Iterator<Item = (&'static str, &'static str, u64)> {
    let read = |name: &str| fs::read_to_string(format!("/proc/self/{name}")).unwrap_or_default();
    let (status, limits) = (read("status"), read("limits"));
    let resident_bytes = number(&status, "VmRSS:").map(|kilobytes| kilobytes * 1024);
    // The folder is itself open while it is read.
    let open = fs::read_dir("/proc/self/fd").ok().map(|all| all.count().saturating_sub(1) as u64);
    let gauges = [
        ("process_resident_memory_bytes", "Memory in use.", resident_bytes),
        ("process_threads", "Threads.", number(&status, "Threads:")),
        ("process_open_fds", "Open files and sockets.", open),
        ("process_max_fds", "How many may be open.", number(&limits, "Max open files")),
    ];
    gauges.into_iter().filter_map(|(name, help, value)| Some((name, help, value?)))
}

/// The first number behind a name at the beginning of a line.
fn number(text: &str, name: &str) -> Option<u64> {
    text.lines().find_map(|line| line.strip_prefix(name))?.split_whitespace().next()?.parse().ok()
}

#[cfg(test)]
mod tests {
    #[test]
    fn a_process_sees_itself() {
        let [(.., memory), (.., threads), (.., open), (.., most)] = super::gauges().collect::<Vec<_>>()[..] else {
            panic!("all are reported here");
        };
        assert!((1 << 20..1 << 40).contains(&memory) && threads >= 1, "{memory} {threads}");
        assert!(3 <= open && open <= most, "{open} {most}");
        // In ticks of 10 ms, after the name, which may have spaces.
        let stat = std::fs::read_to_string("/proc/self/stat").unwrap();
        let after: Vec<&str> = stat.rsplit(')').next().unwrap().split_whitespace().collect();
        let ticks: f64 = after[11..13].iter().map(|count| count.parse::<f64>().unwrap()).sum();
        let used = super::processor_seconds();
        assert!(used > 0.0 && (used - 0.01 * ticks).abs() < 1.0, "{used} s, {ticks} ticks");
    }
}
