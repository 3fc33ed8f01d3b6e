//! The memory that the process may have: that of the machine, or less where its control group (cgroup) has a limit.

use std::fs;
use std::path::{Path, PathBuf};

/// Where the files of control groups are.
const CONTROL_GROUPS: &str = "/sys/fs/cgroup";

/// The memory that this process may have, bytes; none if the system does not say.
#[must_use]
pub fn available() -> Option<u64> {
    let read = |path: &Path| fs::read_to_string(path).ok();
    let groups = read(Path::new("/proc/self/cgroup")).unwrap_or_default();
    let limits: Vec<String> = limit_files(&groups).iter().filter_map(|path| read(path)).collect();
    least(&read(Path::new("/proc/meminfo"))?, limits.iter().map(String::as_str))
}

/// The files that may limit the memory of a process with these control groups (`/proc/self/cgroup`, cgroups(7)): those
/// of its own and of all that these are within, for version 2 and version 1.
fn limit_files(groups: &str) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for line in groups.lines() {
        let mut parts = line.splitn(3, ':').skip(1);
        let (Some(controllers), Some(path)) = (parts.next(), parts.next()) else { continue };
        let (folder, file) = match controllers {
            "" => ("", "memory.max"),
            _ if controllers.split(',').any(|name| name == "memory") => ("memory", "memory.limit_in_bytes"),
            _ => continue,
        };
        let root = Path::new(CONTROL_GROUPS).join(folder);
        let within = Path::new(path.trim_start_matches('/')).ancestors();
        files.extend(within.map(|group| root.join(group).join(file)));
    }
    files
}

/// The least of the memory of the machine (`/proc/meminfo`) and of limits, of which `max` is none.
fn least<'a>(meminfo: &str, limits: impl Iterator<Item = &'a str>) -> Option<u64> {
    let total = meminfo.lines().find_map(|line| line.strip_prefix("MemTotal:"))?;
    let total: u64 = total.trim().strip_suffix("kB")?.trim().parse().ok()?;
    let limits = limits.filter_map(|limit| limit.trim().parse().ok());
    limits.chain([total.saturating_mul(1024)]).min()
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::{least, limit_files};

    const MEMINFO: &str = "MemTotal:        8052464 kB\nMemFree:          401232 kB\nSwapTotal:             0 kB\n";
    const MACHINE: u64 = 8_052_464 * 1024;

    #[test]
    fn a_group_counts_only_where_it_has_less_than_the_machine() {
        // What version 1 shows where there is no limit.
        for unlimited in ["max\n", "9223372036854771712\n", "", "nonsense"] {
            assert_eq!(least(MEMINFO, [unlimited].into_iter()), Some(MACHINE), "{unlimited}");
        }
        assert_eq!(least(MEMINFO, ["max\n", "536870912\n", "1073741824\n"].into_iter()), Some(512 << 20));
        assert_eq!(least(MEMINFO, std::iter::empty()), Some(MACHINE));
        for unknown in ["", "MemTotal: many kB\n", "MemFree: 12 kB\n"] {
            assert_eq!(least(unknown, ["536870912"].into_iter()), None, "{unknown}");
        }
    }

    #[test]
    fn the_limits_of_all_groups_around_a_process_count() {
        let paths = |groups: &str| -> Vec<String> {
            limit_files(groups)
                .iter()
                .map(|path| path.strip_prefix("/sys/fs/cgroup").unwrap().display().to_string())
                .collect()
        };
        assert_eq!(
            paths("0::/system.slice/stickslip.service\n"),
            ["system.slice/stickslip.service/memory.max", "system.slice/memory.max", "memory.max"]
        );
        // In a container of its own name space.
        assert_eq!(paths("0::/\n"), ["memory.max"]);
        assert_eq!(
            paths("12:cpu,cpuacct:/docker/ab\n5:memory:/docker/ab\n1:name=systemd:/docker/ab\n"),
            [
                "memory/docker/ab/memory.limit_in_bytes",
                "memory/docker/memory.limit_in_bytes",
                "memory/memory.limit_in_bytes"
            ]
        );
        assert!(paths("nonsense\n\n").is_empty());
        assert!(Path::new("/proc/meminfo").exists() && super::available().is_some());
    }
}
