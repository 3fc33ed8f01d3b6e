//! A program that others use, on the same scene: a Python script that is told the scene and then, line by line, how fine to be.
//!
//! It answers each line with forces, stresses and the processor time that it took by its own clock, so that neither its start nor the
//! talk with it is counted.

use std::io::{self, BufRead as _, BufReader, Write as _};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

use serde::Deserialize;
use serde_json::{Value, json};

use super::timing::Timed;

/// The peers: name, and script.
pub(super) const SCRIPTS: [(&str, &str); 2] = [
    ("numpy", include_str!("../../external/numpy_springs.py")),
    ("aspher", include_str!("../../external/aspher_grid.py")),
];

/// A peer that has been told the scene.
pub(super) struct Peer {
    pub(super) name: &'static str,
    pub(super) version: String,
    /// The grids that it is to be run on, if it has its own idea of them.
    pub(super) counts: Option<Vec<usize>>,
    child: Child,
    tells: ChildStdin,
    says: BufReader<ChildStdout>,
}

/// What it says first.
#[derive(Deserialize)]
struct Greeting {
    version: Option<String>,
    counts: Option<Vec<usize>>,
    refused: Option<String>,
}

/// What it says to a line.
#[derive(Deserialize)]
#[serde(untagged)]
enum Answer {
    Run { seconds: f64, forces: Vec<f64>, shears: Vec<f64> },
    Failed { failed: String },
}

impl Peer {
    /// Starts it; the inner error is why it does not take part.
    pub(super) fn start(
        python: &Path,
        &(name, script): &(&'static str, &str),
        scene: &Value,
    ) -> io::Result<Result<Peer, String>> {
        let mut command = Command::new(python);
        command.args(["-c", script]).stdin(Stdio::piped()).stdout(Stdio::piped());
        let cannot =
            |error: io::Error| io::Error::new(error.kind(), format!("{} does not run: {error}", python.display()));
        let mut child = command.spawn().map_err(cannot)?;
        let (Some(tells), Some(says)) = (child.stdin.take(), child.stdout.take()) else {
            return Err(io::Error::other("a peer without pipes"));
        };
        let mut peer = Peer { name, version: String::new(), counts: None, child, tells, says: BufReader::new(says) };
        let greeting: Greeting = peer.ask(scene)?;
        peer.version = greeting.version.unwrap_or_default();
        peer.counts = greeting.counts;
        Ok(greeting.refused.map_or(Ok(peer), Err))
    }

    /// One run on so many springs, or points along a side of its grid.
    pub(super) fn run(&mut self, count: usize) -> io::Result<Timed> {
        match self.ask(&json!({"count": count}))? {
            Answer::Run { seconds, forces, shears } => Ok(Timed { forces, shears, seconds }),
            Answer::Failed { failed } => Err(io::Error::other(failed)),
        }
    }

    fn ask<T: for<'de> Deserialize<'de>>(&mut self, line: &Value) -> io::Result<T> {
        writeln!(self.tells, "{line}")?;
        self.tells.flush()?;
        let mut answer = String::new();
        self.says.read_line(&mut answer)?;
        serde_json::from_str(&answer)
            .map_err(|error| io::Error::other(format!("the peer {} said what it should not: {error}", self.name)))
    }
}

impl Drop for Peer {
    fn drop(&mut self) {
        // It may have ended already.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
