//! `stickslip sweep`: a sweep without a server.

use std::io::{self, IsTerminal as _, Write as _};
use std::path::PathBuf;

use clap::{Args, ValueEnum};
use stickslip::admission::Stop;
use stickslip::api::Problem;
use stickslip::api::formats::{Format, tables};
use stickslip::simulation::{Sweep as Plan, SweepResult, Workers};
use stickslip_wire::{self as wire, SweepRequest};

use super::simulate::{json, read};

/// Characters of the bar.
const BAR: usize = 40;

/// Run the body of POST /sweep from a file and print the table.
#[derive(Args)]
pub struct Sweep {
    /// The file, or - for standard input.
    file: PathBuf,
    /// How to print it.
    #[arg(long, value_enum, default_value_t = Written::Csv)]
    format: Written,
    /// How many threads to use; left out, as many as there are cores.
    #[arg(long)]
    threads: Option<usize>,
}

/// A format by its name.
#[derive(Clone, Copy, ValueEnum)]
enum Written {
    Columns,
    Rows,
    Csv,
    Ndjson,
    Arrow,
}

impl Sweep {
    /// Computes and prints; shows on a terminal how far it has come.
    pub fn run(&self) -> Result<(), String> {
        let body = read(&self.file)?;
        let refused = |problem: Problem| json(&problem.document("command line"));
        let plan = wire::read::<SweepRequest>(&body).and_then(Plan::plan).map_err(|error| refused(error.into()))?;
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let threads = self.threads.unwrap_or(cores).max(1);
        let workers = Workers::new(threads).map_err(|why| format!("no threads for the sweep: {why}"))?;
        let (points, outputs) = (plan.points(), plan.numbers(1));
        let (mut result, mut done) = (SweepResult::default(), 0);
        while done < points {
            let slice = plan.slice(done..points, &workers, threads, &Stop::default(), None);
            result.append(slice.map_err(|failure| refused(failure.into()))?);
            done = result.values.len() / outputs;
            show(done, points);
        }
        if result.failed > 0 {
            eprintln!("{} of {points} points have no answer; the first: {}", result.failed, json(&result.failures[0]));
        }
        let format = match self.format {
            Written::Columns => Format::Columns,
            Written::Rows => Format::Rows,
            Written::Csv => Format::Csv,
            Written::Ndjson => Format::Ndjson,
            Written::Arrow => Format::Arrow,
        };
        let mut out = io::BufWriter::new(io::stdout().lock());
        let mut blocks = tables::sweep(plan.checked(), result).blocks(format);
        match blocks.try_for_each(|block| out.write_all(&block.map_err(io::Error::other)?)).and_then(|()| out.flush()) {
            // A reader that has seen enough, such as `head`, is no failure.
            Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(format!("cannot write: {error}")),
            _ => Ok(()),
        }
    }
}

/// The bar on standard error, if somebody can see it there.
fn show(done: usize, points: usize) {
    let mut err = io::stderr().lock();
    if err.is_terminal() {
        let full = BAR * done / points.max(1);
        let (bar, end) = ("=".repeat(full), if done == points { "\n" } else { "" });
        // Nobody is told of a bar that cannot be shown.
        let _ = write!(err, "\r[{bar:BAR$}] {done} of {points}{end}").and_then(|()| err.flush());
    }
}
