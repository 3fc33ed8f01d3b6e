//! `deploy/stickslip.service`: systemd understands it, and it gives the service no more than it needs.

use std::process::Command;

use crate::python::{file, succeed};

/// The unit as it is, but with a program that exists.
fn unit(folder: &std::path::Path) -> std::path::PathBuf {
    let text = std::fs::read_to_string(file("deploy/stickslip.service")).unwrap();
    let installed = "/usr/local/bin/stickslip ";
    assert_eq!(text.matches(installed).count(), 1);
    let unit = folder.join("stickslip.service");
    std::fs::write(&unit, text.replace(installed, &format!("{} ", env!("CARGO_BIN_EXE_stickslip")))).unwrap();
    unit
}

fn settings(text: &str) -> Vec<(&str, &str)> {
    let lines = text.lines().filter(|line| !line.starts_with(['#', '[']) && !line.is_empty());
    lines.map(|line| line.split_once('=').unwrap_or_else(|| panic!("{line}"))).collect()
}

#[test]
fn the_unit_runs_the_service_without_rights() {
    let text = std::fs::read_to_string(file("deploy/stickslip.service")).unwrap();
    let sections: Vec<&str> = text.lines().filter(|line| line.starts_with('[')).collect();
    assert_eq!(sections, ["[Unit]", "[Service]", "[Install]"]);
    let settings = settings(&text);
    let has = |name: &str, value: &str| settings.contains(&(name, value));
    for (name, value) in [
        ("User", "stickslip"),
        ("NoNewPrivileges", "yes"),
        ("CapabilityBoundingSet", ""),
        ("ProtectSystem", "strict"),
        ("StateDirectory", "stickslip"),
        ("ExecReload", "/bin/kill -HUP $MAINPID"),
    ] {
        assert!(has(name, value), "{name}={value}");
    }
    // The page of operation installs what the unit names.
    let page = std::fs::read_to_string(file("docs/operation.md")).unwrap();
    for named in ["/usr/local/bin", "/etc/stickslip/environment", "/etc/systemd/system/", "useradd --system"] {
        assert!(page.contains(named), "{named}");
    }
}

#[test]
fn systemd_accepts_the_unit_and_finds_it_hardened() {
    let here = Command::new("systemd-analyze").arg("--version").output();
    if here.is_err() {
        eprintln!("systemd-analyze is not installed: the unit has been read, not verified");
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let unit = unit(folder.path());
    let mut verify = Command::new("systemd-analyze");
    let verified = verify.args(["verify", "--man=no"]).arg(&unit).output().unwrap();
    let said = String::from_utf8_lossy(&verified.stderr);
    // It reads the units of the system too, which are not ours to judge.
    assert!(verified.status.success() && !said.contains("stickslip.service"), "{said}");
    // From 0, closed, to 10, open: 2.0 as a threshold, in tenths.
    let mut judge = Command::new("systemd-analyze");
    judge.args(["security", "--offline=true", "--no-pager", "--threshold=20"]).arg(&unit);
    succeed(&mut judge, "it is installed");
}
