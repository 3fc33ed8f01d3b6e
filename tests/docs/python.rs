//! A virtual environment of Python with pinned packages, under the target directory.

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::sync::OnceLock;

const MISSING: &str = "this test needs Python: `./check` installs it, or on Debian `apt-get install python3-venv`";
const REQUIREMENTS: &str = include_str!("../python/requirements.txt");

/// A file of the repository.
pub fn file(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// A program of the environment.
pub fn program(name: &str) -> Command {
    static FOLDER: OnceLock<PathBuf> = OnceLock::new();
    let programs = FOLDER.get_or_init(environment).join("bin");
    let mut command = Command::new(programs.join(name));
    // Some call others by name.
    let path = std::env::var_os("PATH").unwrap_or_default();
    command.env("PATH", std::env::join_paths([programs].into_iter().chain(std::env::split_paths(&path))).unwrap());
    command.env("PYTHONDONTWRITEBYTECODE", "1").env("PYTHONUTF8", "1").env_remove("PYTHONPATH").stdin(Stdio::null());
    command
}

/// The environment, made if there is none of these versions yet.
fn environment() -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("python");
    let done = folder.join("requirements.txt");
    if std::fs::read_to_string(&done).is_ok_and(|made| made == REQUIREMENTS) {
        return folder;
    }
    // It may be of other versions, or half made.
    let _ = std::fs::remove_dir_all(&folder);
    succeed(Command::new("python3").args(["-m", "venv"]).arg(&folder), MISSING);
    let mut install = Command::new(folder.join("bin/pip"));
    install.args(["install", "--quiet", "--disable-pip-version-check", "--requirement"]);
    succeed(install.arg(file("tests/python/requirements.txt")), "pip is there");
    std::fs::write(&done, REQUIREMENTS).unwrap();
    folder
}

/// The output of a program that must succeed.
pub fn succeed(command: &mut Command, expected: &str) -> String {
    let Output { status, stdout, stderr } = command.output().expect(expected);
    let (said, errors) = (String::from_utf8_lossy(&stdout), String::from_utf8_lossy(&stderr));
    assert!(status.success(), "{command:?}: {status}\n{said}\n{errors}");
    said.into_owned()
}
