//! Programs of npm at pinned versions, under the target directory.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::OnceLock;

use crate::python::{file, succeed};

const MISSING: &str = "this test needs Node.js 20.19 or later with npm: see https://nodejs.org";
const LOCK: &str = include_str!("../node/package-lock.json");

/// Node.js, which finds the installed modules from wherever it runs.
pub fn node() -> Command {
    let mut command = Command::new("node");
    command.env("NODE_PATH", modules()).stdin(Stdio::null());
    command
}

/// An installed program.
pub fn npm_program(name: &str) -> Command {
    let mut command = Command::new(modules().join(".bin").join(name));
    // Neither the name of this machine nor what it lints leaves it.
    command.env("REDOCLY_TELEMETRY", "off").env("REDOCLY_SUPPRESS_UPDATE_NOTICE", "true").stdin(Stdio::null());
    command
}

/// The folder of the installed modules.
pub fn modules() -> PathBuf {
    static FOLDER: OnceLock<PathBuf> = OnceLock::new();
    FOLDER.get_or_init(install).join("node_modules")
}

/// Installs the modules if these versions have not been installed yet.
fn install() -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("node");
    let done = folder.join("installed.json");
    if std::fs::read_to_string(&done).is_ok_and(|installed| installed == LOCK) {
        return folder;
    }
    std::fs::create_dir_all(&folder).unwrap();
    for name in ["package.json", "package-lock.json"] {
        std::fs::copy(file("tests/node").join(name), folder.join(name)).unwrap();
    }
    // None of the packages needs the scripts that it would run at its installation.
    let mut npm = Command::new("npm");
    npm.args(["ci", "--prefer-offline", "--no-audit", "--no-fund", "--ignore-scripts"]).current_dir(&folder);
    succeed(&mut npm, MISSING);
    std::fs::write(&done, LOCK).unwrap();
    folder
}
