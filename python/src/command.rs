//! The command `stickslip`.

use std::ffi::OsString;

use pyo3::prelude::*;

/// Runs the command line, of which the first argument is the program, and returns its exit code.
///
/// Signals go to the command: `serve` stops at an interrupt, and other commands end at once.
#[pyfunction]
pub fn main(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
    py.detach(|| stickslip::cli::run(arguments))
}
