//! `stickslip report`: speed against error, measured here.

use std::path::PathBuf;
use std::time::Duration;

use clap::Args;
use stickslip_report::benchmark::{self, NAMES, Options};

/// Where to write, and how much to measure.
#[derive(Args)]
pub struct Report {
    /// The folder to write report.md, report.csv, report.json and the charts to.
    #[arg(long)]
    out: PathBuf,
    /// Springs up to a million, more repetitions, and no bound on the time: for the night.
    #[arg(long)]
    full: bool,
    /// Scenes by name, commas between; all if left out.
    #[arg(long, value_delimiter = ',')]
    scenes: Vec<String>,
    /// The largest number of springs, instead of 10 000, or of a million with --full.
    #[arg(long)]
    largest: Option<usize>,
    /// How many seconds all of it may take, or nearly, instead of 110, or of as many as it takes with --full.
    #[arg(long, value_name = "SECONDS")]
    budget: Option<u32>,
    /// Run the scripts of benches/peers beside our solvers, with this Python; see docs/speed-and-accuracy.md.
    #[arg(long, value_name = "PYTHON")]
    peers: Option<PathBuf>,
}

/// How long the short run may take, s: two minutes with what is on its way when they end.
const BUDGET: u32 = 110;

impl Report {
    /// Measures and writes.
    pub fn run(self) -> Result<(), String> {
        let all = || NAMES.iter().map(|name| (*name).to_owned()).collect();
        let options = Options {
            scenes: if self.scenes.is_empty() { all() } else { self.scenes },
            largest: self.largest.unwrap_or(if self.full { 1_000_000 } else { 10_000 }),
            patience: Duration::from_millis(if self.full { 5_000 } else { 200 }),
            budget: self.budget.or((!self.full).then_some(BUDGET)).map(|seconds| Duration::from_secs(seconds.into())),
            compiler: env!("BUILD_COMPILER"),
            peers: self.peers,
        };
        let written = benchmark::measure(&options).and_then(|measured| benchmark::write(&self.out, &measured));
        written.map_err(|error| format!("cannot report to {}: {error}", self.out.display()))
    }
}
