//! The command line: parses it and runs one command.

mod backup;
mod check;
mod cycle;
mod fit;
mod fretting;
mod healthcheck;
mod io;
mod key;
mod limits;
mod profile;
mod progress;
mod protocol;
mod reload;
mod report;
mod scan_table;
mod serve;
mod settings;
mod subsurface;
mod sweep;
mod table;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Parser, Subcommand};
use stickslip::admission::Stop;
use stickslip::{api, simulation};
use stickslip_report::figures;
use stickslip_wire::{self as wire, SimulateRequest};

use backup::Backup;
use check::Check;
use cycle::Cycle;
use fit::Fit;
use fretting::Fretting;
use healthcheck::Healthcheck;
use io::{json, print, problem, read};
use key::Key;
use profile::Profile;
use protocol::Protocol;
use report::Report;
use serve::Serve;
use settings::{Settings, SettingsError};
use subsurface::Subsurface;
use sweep::Sweep;

/// Simulate the frictional contact of two elastic bodies exactly: as a service, or from the command line.
#[derive(Parser)]
#[command(version = env!("BUILD_VERSION"), about, args_conflicts_with_subcommands = true)]
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
    /// Print the settings of `serve` with the source of each; secrets are masked.
    Config(Serve),
    /// Run the body of POST /simulate from a file and print the reply.
    Simulate {
        /// The file, or - for standard input.
        file: PathBuf,
    },
    /// Find a protocol that leaves little shear stress, and print the reply of POST /protocols.
    Protocol(Protocol),
    /// Run the body of POST /cycle from a file and print the reply, or a fretting map.
    Cycle(Cycle),
    /// Run the body of POST /simulate from a file and print the stress below the surface that it asks for.
    Subsurface(Subsurface),
    /// Run the body of POST /fretting from a file and print the reply.
    Fretting(Fretting),
    /// Fit a profile to a scan of heights and print it, with what the scan says of the contact.
    Profile(Profile),
    /// Fit friction and stiffness to a measured loop of force over displacement, and print what it determines.
    Fit(Fit),
    /// Run the body of POST /sweep from a file and print the table.
    Sweep(Sweep),
    /// Print the OpenAPI document.
    Openapi,
    /// Check that a running service is healthy, for containers.
    Healthcheck(Healthcheck),
    /// Make API keys.
    #[command(subcommand)]
    Key(Key),
    /// Copy the store to a file, while the service runs or not.
    Backup(Backup),
    /// Verify a store: replay the moves of every contact, and compare the states. Nothing is written.
    Check(Check),
    /// Measure speed against error of each solver on this machine.
    Report(Report),
    /// Draw the figures of the paper, of protocols and of steady cycles, as SVG and CSV.
    Figures {
        /// The folder to write them to.
        #[arg(long)]
        out: PathBuf,
    },
}

/// The exit code of an invalid command line or setting.
const USAGE_ERROR: u8 = 2;

/// Runs the command that the command line names.
pub fn run() -> ExitCode {
    let (cli, settings) = match settings::read::<Cli>(std::env::args_os().collect()) {
        Ok(read) => read,
        Err(SettingsError::Help(help)) => help.exit(),
        Err(SettingsError::Invalid(line)) => {
            eprintln!("{line}");
            return ExitCode::from(USAGE_ERROR);
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
            Command::Simulate { file } => simulate(&file),
            Command::Protocol(protocol) => protocol.run(),
            Command::Cycle(cycle) => cycle.run(),
            Command::Subsurface(subsurface) => subsurface.run(),
            Command::Fretting(fretting) => fretting.run(),
            Command::Profile(profile) => profile.run(),
            Command::Fit(fit) => fit.run(),
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

/// Reads the body of `POST /simulate` and prints the reply.
fn simulate(file: &Path) -> Result<(), String> {
    let simulation = wire::read::<SimulateRequest>(&read(file)?).map_err(problem)?;
    print(json(&simulation::simulate(&simulation, &Stop::default()).map_err(problem)?))
}
