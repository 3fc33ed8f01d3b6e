//! `stickslip report`: speed against error of the solvers.

use std::path::PathBuf;
use std::time::Duration;

use clap::Args;
use stickslip_report::benchmark::{self, NAMES, Options};

use super::progress;

/// Where to write the report, and how much to measure.
#[derive(Args)]
pub struct Report {
    /// The folder to write report.md, report.csv, report.json and the charts to.
    #[arg(long)]
    out: PathBuf,
    /// Springs up to a million, more repetitions, and no limit of time: takes a night.
    #[arg(long)]
    full: bool,
    /// Scenes by name, separated by commas [default: all].
    #[arg(long, value_delimiter = ',')]
    scenes: Vec<String>,
    /// Largest number of springs [default: 10000, with --full 1000000].
    #[arg(long)]
    largest: Option<usize>,
    /// About how many seconds it may take [default: 110, with --full no limit].
    #[arg(long, value_name = "SECONDS")]
    budget: Option<u32>,
    /// Also run the solvers of crates/report/external, with this Python; see docs/speed-and-accuracy.md.
    #[arg(long, alias = "peers", value_name = "PYTHON")]
    external: Option<PathBuf>,
}

/// Time of the short run, s: two minutes with the runs that are under way at its end.
const BUDGET: u32 = 110;

impl Report {
    /// Measures, and writes the report, with progress on a terminal.
    pub fn run(self) -> Result<(), String> {
        let all = || NAMES.iter().map(|name| (*name).to_owned()).collect();
        let options = Options {
            scenes: if self.scenes.is_empty() { all() } else { self.scenes },
            max_springs: self.largest.unwrap_or(if self.full { 1_000_000 } else { 10_000 }),
            repetition_time: Duration::from_millis(if self.full { 5_000 } else { 200 }),
            budget: self.budget.or((!self.full).then_some(BUDGET)).map(|seconds| Duration::from_secs(seconds.into())),
            compiler: env!("BUILD_COMPILER"),
            python: self.external,
        };
        let bar = progress::bar(options.scenes.len() as u64, "scenes");
        let show = |scene: &str| {
            bar.set_message(scene.to_owned());
            bar.inc(1);
        };
        let measured = benchmark::measure(&options, show);
        bar.finish_and_clear();
        let written = measured.and_then(|measured| benchmark::write(&self.out, &measured));
        written.map_err(|error| format!("cannot report to {}: {error}", self.out.display()))
    }
}
