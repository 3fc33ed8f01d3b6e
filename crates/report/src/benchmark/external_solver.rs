//! A solver by others on the same scene: a Python script that reads the scene as one line of JSON, then a resolution a
//! line.
//!
//! It replies to each line with forces, stresses and the processor time by its own clock, so that neither its start nor
//! the exchange is counted.

use std::io::{self, BufRead as _, BufReader, Write as _};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

use serde::Deserialize;
use serde_json::{Value, json};

/// The scripts by their names.
pub(super) const SCRIPTS: [(&str, &str); 2] = [
    ("numpy", include_str!("../../external/numpy_springs.py")),
    ("aspher", include_str!("../../external/aspher_grid.py")),
];

/// One run of a solver: forces after each move, N, shear stresses at the end, Pa, and the processor time for both, s.
pub(super) struct SolverRun {
    pub(super) forces: Vec<f64>,
    pub(super) shears: Vec<f64>,
    pub(super) seconds: f64,
}

/// A running script that has read the scene.
pub(super) struct ExternalSolver {
    pub(super) name: &'static str,
    pub(super) version: String,
    /// The resolutions that it asks to be run with, if it names any.
    pub(super) counts: Option<Vec<usize>>,
    child: Child,
    stdin: ChildStdin,
    stdout: BufReader<ChildStdout>,
}

/// Its first line.
#[derive(Deserialize)]
struct Greeting {
    version: Option<String>,
    counts: Option<Vec<usize>>,
    refused: Option<String>,
}

/// Its reply to a request.
#[derive(Deserialize)]
#[serde(untagged)]
enum Reply {
    Run { seconds: f64, forces: Vec<f64>, shears: Vec<f64> },
    Failed { failed: String },
}

impl ExternalSolver {
    /// Starts it; the inner error says why it does not solve this scene.
    pub(super) fn start(
        python: &Path,
        &(name, script): &(&'static str, &str),
        scene: &Value,
    ) -> io::Result<Result<ExternalSolver, String>> {
        let mut command = Command::new(python);
        command.args(["-c", script]).stdin(Stdio::piped()).stdout(Stdio::piped());
        let cannot =
            |error: io::Error| io::Error::new(error.kind(), format!("{} does not run: {error}", python.display()));
        let mut child = command.spawn().map_err(cannot)?;
        let (Some(stdin), Some(stdout)) = (child.stdin.take(), child.stdout.take()) else {
            return Err(io::Error::other("an external solver without pipes"));
        };
        let mut solver =
            ExternalSolver { name, version: String::new(), counts: None, child, stdin, stdout: BufReader::new(stdout) };
        let greeting: Greeting = solver.request(scene)?;
        solver.version = greeting.version.unwrap_or_default();
        solver.counts = greeting.counts;
        Ok(greeting.refused.map_or(Ok(solver), Err))
    }

    /// One run on so many springs, or points along a side of its grid.
    pub(super) fn run(&mut self, count: usize) -> io::Result<SolverRun> {
        match self.request(&json!({"count": count}))? {
            Reply::Run { seconds, forces, shears } => Ok(SolverRun { forces, shears, seconds }),
            Reply::Failed { failed } => Err(io::Error::other(failed)),
        }
    }

    fn request<T: for<'de> Deserialize<'de>>(&mut self, line: &Value) -> io::Result<T> {
        writeln!(self.stdin, "{line}")?;
        self.stdin.flush()?;
        let mut reply = String::new();
        self.stdout.read_line(&mut reply)?;
        serde_json::from_str(&reply)
            .map_err(|error| io::Error::other(format!("{} replied with an invalid document: {error}", self.name)))
    }
}

impl Drop for ExternalSolver {
    fn drop(&mut self) {
        // It may have ended already.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
