//! The command line: what can be asked for, and who does it.

mod healthcheck;
mod key;
mod overload;
mod protocol;
mod report;
mod serve;
mod settings;
mod simulate;
mod sweep;
mod upkeep;

use std::fmt::Display;
use std::io::{self, Write as _};
use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Parser, Subcommand};
use stickslip::api;
use stickslip_report::figures;

use healthcheck::Healthcheck;
use key::Key;
use protocol::Protocol;
use report::Report;
use serve::Serve;
use settings::{Refusal, Settings};
use sweep::Sweep;
use upkeep::{Backup, Check};

/// Frictional contact with memory, exactly: a service, and the same on the command line.
#[derive(Parser)]
#[command(version, about, args_conflicts_with_subcommands = true)]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
    #[command(flatten)]
    serve: Serve,
}

#[derive(Subcommand)]
enum Command {
    /// Serve HTTP; the same as no command at all.
    Serve(Serve),
    /// Print the settings that `serve` would run with, and where each comes from; secrets are masked.
    Config(Serve),
    /// Run the body of POST /simulate from a file and print the reply.
    Simulate {
        /// The file, or - for standard input.
        file: PathBuf,
    },
    /// Find a path that leaves little shear stress, and print the reply of POST /protocols.
    Protocol(Protocol),
    /// Run the body of POST /sweep from a file and print the table.
    Sweep(Sweep),
    /// Print the OpenAPI document.
    Openapi,
    /// Ask a running service whether it is well; for container health checks.
    Healthcheck(Healthcheck),
    /// Keys for those who may use a service.
    #[command(subcommand)]
    Key(Key),
    /// Copy the store to a file, while the service runs or not.
    Backup(Backup),
    /// Look whether a store is sound: make every contact again from its moves, and compare. Nothing is written.
    Check(Check),
    /// Measure what each solver costs and how wrong it is, on this machine.
    Report(Report),
    /// Draw the figures of the paper, as SVG and CSV.
    Figures {
        /// The folder to write them to.
        #[arg(long)]
        out: PathBuf,
    },
}

/// The exit code of a command that was not understood.
const NOT_UNDERSTOOD: u8 = 2;

/// Does what the command line asks for.
pub fn run() -> ExitCode {
    let (cli, settings) = match settings::read::<Cli>(std::env::args_os().collect()) {
        Ok(read) => read,
        Err(Refusal::Asked(help)) => help.exit(),
        Err(Refusal::Wrong(line)) => {
            eprintln!("{line}");
            return ExitCode::from(NOT_UNDERSTOOD);
        }
    };
    match cli.command.unwrap_or(Command::Serve(cli.serve)).run(&settings) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}

impl Command {
    fn run(self, settings: &Settings) -> Result<(), String> {
        match self {
            Command::Serve(options) => serve::serve(options),
            Command::Config(_) => print(settings),
            Command::Simulate { file } => simulate::simulate(&file),
            Command::Protocol(protocol) => protocol.run(),
            Command::Sweep(sweep) => sweep.run(),
            Command::Openapi => print(api::document().trim_end()),
            Command::Healthcheck(options) => healthcheck::healthcheck(&options),
            Command::Key(key) => key::key(key),
            Command::Backup(backup) => backup.run(),
            Command::Check(check) => check.run(),
            Command::Report(report) => report.run(),
            Command::Figures { out } => {
                figures::write(&out).map_err(|error| format!("cannot write figures to {}: {error}", out.display()))
            }
        }
    }
}

/// A line on standard output.
fn print(text: impl Display) -> Result<(), String> {
    match writeln!(io::stdout(), "{text}") {
        // A reader that has seen enough, such as `head`, is no failure.
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(format!("cannot write: {error}")),
        _ => Ok(()),
    }
}
