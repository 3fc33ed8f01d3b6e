//! The memory that this process may have, as Linux tells it.

use std::fs;
use std::path::{Component, Path, PathBuf};

/// Where control groups are mounted, and the controller of the memory where it has a hierarchy of its own (cgroups
/// version 1), with the file of the limit in each.
const HIERARCHIES: [(&str, &str, &str); 2] =
    [("", "sys/fs/cgroup", "memory.max"), ("memory", "sys/fs/cgroup/memory", "memory.limit_in_bytes")];

/// The memory that this process may have, bytes: that of the machine, or less where its control group (cgroup), or one
/// around it, has a limit; none if the system does not say.
pub fn available() -> Option<u64> {
    available_below(Path::new("/"))
}

fn available_below(root: &Path) -> Option<u64> {
    let read = |path: PathBuf| fs::read_to_string(root.join(path)).ok();
    let machine = read("proc/meminfo".into()).and_then(|text| {
        let kib = text.lines().find_map(|line| line.strip_prefix("MemTotal:"))?;
        kib.trim().strip_suffix("kB")?.trim_end().parse::<u64>().ok()?.checked_mul(1024)
    });
    let groups = read("proc/self/cgroup".into()).unwrap_or_default();
    // `ID:CONTROLLERS:PATH`. The path is that of the host where a container sees no other; its own group is then the
    // root of what is mounted.
    let limits = groups.lines().filter_map(|line| {
        let (controllers, path) = line.split_once(':')?.1.split_once(':')?;
        let (_, mount, file) = HIERARCHIES.iter().find(|(of, ..)| controllers.split(',').any(|name| name == *of))?;
        let inner: PathBuf = Path::new(path).components().filter(|part| matches!(part, Component::Normal(_))).collect();
        let limit = |group: &Path| read(Path::new(mount).join(group).join(file))?.trim().parse::<u64>().ok();
        inner.ancestors().filter_map(limit).min()
    });
    limits.chain(machine).min()
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::available_below;

    /// What is available where these files have these contents.
    fn with(files: &[(&str, &str)]) -> Option<u64> {
        let root = tempfile::tempdir().unwrap();
        for (path, text) in files {
            let path = root.path().join(path);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, text).unwrap();
        }
        available_below(root.path())
    }

    const MACHINE: (&str, &str) = ("proc/meminfo", "MemTotal:        8000000 kB\nMemFree:         1 kB\n");
    const ALL: Option<u64> = Some(8_000_000 * 1024);

    #[test]
    fn the_least_limit_counts() {
        assert_eq!(with(&[]), None);
        assert_eq!(with(&[MACHINE]), ALL);
        let group = ("proc/self/cgroup", "0::/a.slice/b.service\n");
        let (outer, inner) = ("sys/fs/cgroup/a.slice/memory.max", "sys/fs/cgroup/a.slice/b.service/memory.max");
        assert_eq!(with(&[MACHINE, group, (outer, "max\n"), (inner, "max\n")]), ALL);
        assert_eq!(with(&[MACHINE, group, (outer, "max\n"), (inner, "1000000\n")]), Some(1_000_000));
        assert_eq!(with(&[MACHINE, group, (outer, "500000\n"), (inner, "1000000\n")]), Some(500_000));
        assert_eq!(with(&[MACHINE, group, (inner, "9000000000000\n")]), ALL);
    }

    #[test]
    fn a_container_sees_its_group_as_the_root() {
        let limit = ("sys/fs/cgroup/memory.max", "2000000\n");
        for path in ["0::/\n", "0::/system.slice/docker-1.scope\n", "0::/../other\n"] {
            assert_eq!(with(&[MACHINE, ("proc/self/cgroup", path), limit]), Some(2_000_000), "{path}");
        }
    }

    #[test]
    fn the_first_version_of_control_groups_has_a_hierarchy_for_memory() {
        let group = ("proc/self/cgroup", "5:cpu,cpuacct:/x\n4:memory:/docker/1\n0::/\n");
        let unlimited = ("sys/fs/cgroup/memory/memory.limit_in_bytes", "9223372036854771712\n");
        assert_eq!(with(&[MACHINE, group, unlimited]), ALL);
        let limit = ("sys/fs/cgroup/memory/docker/1/memory.limit_in_bytes", "3000000\n");
        assert_eq!(with(&[MACHINE, group, unlimited, limit]), Some(3_000_000));
    }
}
