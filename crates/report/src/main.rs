//! The tool `stickslip-report`: speed against error of the solvers, and the figures of the documentation.
//!
//! [`benchmark`] measures speed against error, with a reference solver of its own; [`rings`] does so for motion in the
//! plane. [`figures`] draws the figures of Kraft & Pohrt (2016) and others. [`report`] has what they share.

mod benchmark;
mod figures;
mod report;
mod rings;

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;

/// Speed against error of the solvers, and figures.
#[derive(Parser)]
#[command(version, about)]
enum Tool {
    /// Measure speed against error of each solver on this machine.
    Speed(benchmark::Speed),
    /// Draw the figures of the paper, of protocols, of steady cycles and others, as SVG.
    Figures {
        /// The folder to write them to.
        #[arg(long)]
        out: PathBuf,
    },
    /// Measure speed against error of rings in the plane, and what a turn of an ellipse loses.
    Rings {
        /// The folder to write rings.md to.
        #[arg(long)]
        out: PathBuf,
    },
}

fn main() -> ExitCode {
    let done = match Tool::parse() {
        Tool::Speed(speed) => speed.run(),
        Tool::Figures { out } => figures::write(&out),
        Tool::Rings { out } => rings::write(&out),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}
