//! The tool `stickslip-report`: `cargo run --release -p stickslip-report -- speed --out FOLDER`, `figures`,
//! `rings` or `losses`.

use std::path::PathBuf;
use std::process::{Command, ExitCode};
use std::time::Duration;

use clap::{Args, Parser};
use stickslip_report::benchmark::{self, NAMES, Options};
use stickslip_report::{figures, rings};

/// Speed against error of the solvers, and figures.
#[derive(Parser)]
#[command(version, about)]
enum Tool {
    /// Measure speed against error of each solver on this machine.
    Speed(Speed),
    /// Draw the figures of the paper, of protocols and of steady cycles, as SVG and CSV.
    Figures {
        /// The folder to write them to.
        #[arg(long)]
        out: PathBuf,
    },
    /// Measure speed against error of rings in the plane.
    Rings {
        /// The folder to write rings.md to.
        #[arg(long)]
        out: PathBuf,
    },
    /// Print what a turn of an ellipse loses, over the amplitude, the ratio of the radii and the phase.
    Losses,
}

/// Where to write the report, and how much to measure.
#[derive(Args)]
struct Speed {
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
    #[arg(long, value_name = "PYTHON")]
    external: Option<PathBuf>,
}

/// Time of the short run, s: two minutes with the runs that are under way at its end.
const BUDGET: u32 = 110;

fn main() -> ExitCode {
    let done = match Tool::parse() {
        Tool::Speed(speed) => speed.run(),
        Tool::Figures { out } => {
            figures::write(&out).map_err(|error| format!("cannot write figures to {}: {error}", out.display()))
        }
        Tool::Rings { out } => {
            rings::write(&out).map_err(|error| format!("cannot report to {}: {error}", out.display()))
        }
        Tool::Losses => rings::losses().map(|table| print!("{table}")).map_err(|error| error.to_string()),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}

/// The version of the compiler, which Cargo calls by this name too.
fn compiler() -> String {
    let output = Command::new("rustc").arg("--version").output();
    let version = output.ok().and_then(|output| String::from_utf8(output.stdout).ok());
    // "rustc 1.95.0 (…)": the number alone.
    let number = version.as_deref().and_then(|line| line.split_whitespace().nth(1));
    number.unwrap_or("unknown").to_owned()
}

impl Speed {
    /// Measures, and writes the report, with each scene named as it begins.
    fn run(self) -> Result<(), String> {
        let all = || NAMES.iter().map(|name| (*name).to_owned()).collect();
        let options = Options {
            scenes: if self.scenes.is_empty() { all() } else { self.scenes },
            max_springs: self.largest.unwrap_or(if self.full { 1_000_000 } else { 10_000 }),
            repetition_time: Duration::from_millis(if self.full { 5_000 } else { 200 }),
            budget: self.budget.or((!self.full).then_some(BUDGET)).map(|seconds| Duration::from_secs(seconds.into())),
            compiler: compiler(),
            python: self.external,
        };
        let measured = benchmark::measure(&options, |scene| eprintln!("{scene}"));
        let written = measured.and_then(|measured| benchmark::write(&self.out, &measured));
        written.map_err(|error| format!("cannot report to {}: {error}", self.out.display()))
    }
}
