//! `stickslip report`: speed against error, measured here.

use std::path::PathBuf;
use std::time::Duration;

use clap::Args;
use stickslip::report::{self, NAMES, Options};

/// Where to write, and how much to measure.
#[derive(Args)]
pub struct Report {
    /// The folder to write report.md, report.csv and report.json to.
    #[arg(long)]
    out: PathBuf,
    /// Springs up to a million, and more repetitions: takes hours.
    #[arg(long)]
    full: bool,
    /// Scenes by name, commas between; all if left out.
    #[arg(long, value_delimiter = ',')]
    scenes: Vec<String>,
    /// The largest number of springs, instead of 10 000, or of a million with --full.
    #[arg(long)]
    largest: Option<usize>,
}

impl Report {
    /// Measures and writes.
    pub fn run(self) -> Result<(), String> {
        let all = || NAMES.iter().map(|name| (*name).to_owned()).collect();
        let options = Options {
            scenes: if self.scenes.is_empty() { all() } else { self.scenes },
            largest: self.largest.unwrap_or(if self.full { 1_000_000 } else { 10_000 }),
            patience: Duration::from_millis(if self.full { 10_000 } else { 200 }),
        };
        let written = report::measure(&options).and_then(|rows| report::write(&self.out, &rows));
        written.map_err(|error| format!("cannot report to {}: {error}", self.out.display()))
    }
}
