//! Metrics of the process, as Prometheus names them everywhere; what the system does not tell is left out.

use std::fs;

use prometheus::{Counter, IntGauge, Registry};
use rustix::param::{clock_ticks_per_second, page_size};
use rustix::process::{Resource, getrlimit};

/// Puts what Linux tells of this process on a page.
///
/// # Errors
/// A name that the page has already.
pub fn register(page: &Registry) -> prometheus::Result<()> {
    let gauge = |name: &str, help: &str, value: Option<u64>| {
        let Some(value) = value else { return Ok(()) };
        let gauge = IntGauge::new(name, help)?;
        gauge.set(i64::try_from(value).unwrap_or(i64::MAX));
        page.register(Box::new(gauge))
    };
    let open = fs::read_dir("/proc/self/fd").ok().map(|entries| entries.count() as u64);
    gauge("process_open_fds", "Number of open file descriptors.", open)?;
    gauge("process_max_fds", "Maximum number of open file descriptors.", getrlimit(Resource::Nofile).current)?;
    let Some(stat) = fs::read_to_string("/proc/self/stat").ok().and_then(|text| Stat::parse(&text)) else {
        return Ok(());
    };
    let ticks = clock_ticks_per_second();
    let cpu = Counter::new("process_cpu_seconds_total", "Total user and system CPU time spent in seconds.")?;
    cpu.inc_by(stat.cpu as f64 / ticks as f64);
    page.register(Box::new(cpu))?;
    gauge("process_threads", "Number of OS threads in the process.", Some(stat.threads))?;
    gauge("process_virtual_memory_bytes", "Virtual memory size in bytes.", Some(stat.virtual_memory))?;
    let resident = stat.resident_pages.saturating_mul(page_size() as u64);
    gauge("process_resident_memory_bytes", "Resident memory size in bytes.", Some(resident))?;
    let boot = fs::read_to_string("/proc/stat").ok().and_then(|text| {
        text.lines().find_map(|line| line.strip_prefix("btime ")).and_then(|time| time.trim().parse::<u64>().ok())
    });
    let start = boot.map(|boot| boot + stat.start / ticks.max(1));
    gauge("process_start_time_seconds", "Start time of the process since unix epoch in seconds.", start)
}

/// What `/proc/self/stat` tells (proc_pid_stat(5)).
#[derive(Debug, PartialEq, Eq)]
struct Stat {
    /// Time on processors, in ticks.
    cpu: u64,
    threads: u64,
    /// Start after the boot, in ticks.
    start: u64,
    /// Bytes.
    virtual_memory: u64,
    resident_pages: u64,
}

impl Stat {
    fn parse(text: &str) -> Option<Stat> {
        // The name of the program stands in parentheses, and may have spaces and parentheses itself. The next field is
        // the third.
        let fields: Vec<&str> = text.rsplit_once(')')?.1.split_ascii_whitespace().collect();
        let field = |number: usize| fields.get(number - 3)?.parse::<u64>().ok();
        Some(Stat {
            cpu: field(14)?.saturating_add(field(15)?),
            threads: field(20)?,
            start: field(22)?,
            virtual_memory: field(23)?,
            resident_pages: field(24)?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::Stat;

    #[test]
    fn fields_are_counted_after_the_name_whatever_it_is() {
        let rest = "S 1 2 3 4 -1 5 6 7 8 9 250 50 1 2 20 0 17 0 4711 987654321 321 18446744073709551615 1 1";
        let expected = Stat { cpu: 300, threads: 17, start: 4711, virtual_memory: 987_654_321, resident_pages: 321 };
        for name in ["stickslip", "a b", "a) R 1 (b"] {
            assert_eq!(Stat::parse(&format!("42 ({name}) {rest}")).as_ref(), Some(&expected), "{name}");
        }
        assert_eq!(Stat::parse("42 (stickslip) S 1"), None);
    }
}
