//! `stickslip sweep`: a sweep without a server.

use std::io;
use std::path::PathBuf;

use clap::Args;
use clap::builder::PossibleValuesParser;
use stickslip_wire::{PrepareAnew, SweepRequest};

use super::command_error::CommandError;
use super::io::{json, read, survive_file_size_limit, write};
use super::progress;
use stickslip_compute::documents::Parse as _;
use stickslip_compute::formats::Format;
use stickslip_compute::simulation::{Sweep as Plan, SweepResult};
use stickslip_compute::{Flag, Refusal};

/// The sweep, and how to run it.
#[derive(Args)]
pub struct Sweep {
    /// File with the body of POST /sweep, or - for standard input.
    file: PathBuf,
    /// Format of the table.
    #[arg(long, value_parser = PossibleValuesParser::new(Format::TABLES.map(Format::name)), default_value = "csv")]
    format: String,
    /// Print the JSON document instead of the table, and faults as JSON.
    #[arg(long, conflicts_with = "format")]
    json: bool,
    /// Number of threads [default: the number of cores].
    #[arg(long)]
    threads: Option<usize>,
}

impl Sweep {
    /// Computes and prints the table, with progress on a terminal.
    pub fn run(&self) -> Result<(), String> {
        survive_file_size_limit()?;
        self.printed().map_err(|error| error.message(self.json))
    }

    fn printed(&self) -> Result<(), CommandError> {
        let plan = SweepRequest::read(&read(&self.file)?).and_then(|sweep| Plan::plan(sweep, &PrepareAnew));
        let plan = plan.map_err(Refusal::from)?;
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let threads = self.threads.unwrap_or(cores).max(1);
        let points = plan.points();
        let (mut result, mut done) = (SweepResult::default(), 0);
        let bar = progress::bar(points as u64, "{human_pos} of {human_len} points");
        while done < points {
            let slice = plan.slice(done..points, vec![(); threads], &Flag::default(), None);
            result.append(slice.map_err(Refusal::from)?);
            done = plan.points_of(&result);
            bar.set_position(done as u64);
        }
        bar.finish_and_clear();
        if result.failed > 0 {
            eprintln!("{} of {points} points failed; the first: {}", result.failed, json(&result.failures[0]));
        }
        let format = if self.json { "columns" } else { &self.format };
        let format = Format::named(format, &Format::TABLES).unwrap_or(Format::Csv);
        let mut blocks = result.blocks(plan.checked(), format);
        Ok(write(|out| blocks.try_for_each(|block| out.write_all(&block.map_err(io::Error::other)?)))?)
    }
}
