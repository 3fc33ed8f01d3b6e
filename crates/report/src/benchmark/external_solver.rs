//! A solver by others: a Python script that reads a scene as JSON and writes what it finds.
//!
//! It measures the processor time by its own clock, so that neither its start nor the exchange is counted.

use std::io::Write as _;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use serde_json::Value;

use super::Solution;
use crate::report::Failure;

/// The scripts: their names, texts, and the numbers of springs or of points along one side of a grid to run them with.
pub(super) const SCRIPTS: [(&str, &str, &[usize]); 2] = [
    ("numpy", include_str!("../../external/numpy_springs.py"), &[10, 100, 1000, 10_000]),
    // Finer grids take minutes a run.
    ("aspher", include_str!("../../external/aspher_grid.py"), &[32]),
];

/// The version of a Python.
pub(super) fn version(python: &Path) -> Result<String, Failure> {
    let output = call(python, &["--version"], "")?;
    Ok(String::from_utf8_lossy(&output.stdout).trim().to_owned())
}

/// One run of a script; its last words if it does not solve this scene.
pub(super) fn run(python: &Path, script: &str, scene: &Value) -> Result<Solution, Failure> {
    let output = call(python, &["-c", script], &scene.to_string())?;
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).lines().last().unwrap_or_default().into());
    }
    Ok(serde_json::from_slice(&output.stdout)?)
}

fn call(python: &Path, arguments: &[&str], input: &str) -> Result<Output, Failure> {
    let mut command = Command::new(python);
    command.args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().map_err(|error| format!("{} does not run: {error}", python.display()))?;
    if let Some(mut stdin) = child.stdin.take() {
        // A script that has ended already says why.
        let _ = stdin.write_all(input.as_bytes());
    }
    Ok(child.wait_with_output()?)
}
