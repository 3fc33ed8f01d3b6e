//! The command line: parses it and runs one command.

mod backup;
mod check;
mod command_error;
mod compute;
mod demo;
mod fmu;
mod healthcheck;
mod io;
mod key;
mod limits;
mod log_queue;
mod manual;
mod progress;
mod reload;
mod serve;
mod settings;
mod stopping;
mod summary;
mod sweep;

use std::ffi::OsString;
use std::path::PathBuf;

use clap::{Parser, Subcommand};
use clap_complete::Shell;

use crate::api;

use backup::Backup;
use check::Check;
use compute::Compute;
use demo::Demo;
use fmu::Fmu;
use healthcheck::Healthcheck;
use io::print;
use key::Key;
use serve::Serve;
use settings::{Settings, SettingsError};
use sweep::Sweep;

/// Simulate the frictional contact of two elastic bodies exactly, as a service or from the command line.
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
    /// Serve HTTP; the default command if the store exists or is named.
    Serve(Serve),
    /// Serve contacts of every kind to look at, in memory, and open the page in a browser.
    Demo(Demo),
    /// Print the settings of `serve` with the source of each; secrets are masked.
    Config(Serve),
    /// A computation: the body of its request from a file, and its reply.
    #[command(flatten)]
    Compute(Compute),
    /// Run the body of POST /sweep from a file and print the table.
    Sweep(Sweep),
    /// Write a contact as an FMU, for co-simulation by FMI 2.0.
    Fmu(Fmu),
    /// Print the OpenAPI document.
    Openapi,
    /// Check that a running service is healthy, for containers.
    Healthcheck(Healthcheck),
    /// Make API keys.
    #[command(subcommand)]
    Key(Key),
    /// Copy the store to a file; the service may be running.
    Backup(Backup),
    /// Verify a store: replay the moves of every contact, and compare the states. Nothing is written.
    Check(Check),
    /// Print a script for a shell that completes commands and flags.
    Completions {
        /// The shell.
        shell: Shell,
    },
    /// Write the manual pages of all commands.
    Man {
        /// The folder to write the pages to.
        folder: PathBuf,
    },
}

/// The exit code of a command that has failed, and of an invalid command line or setting.
const FAILURE: u8 = 1;
const USAGE_ERROR: u8 = 2;

/// Runs the command that these arguments name, of which the first is the program itself, and returns the exit code of
/// the process.
#[must_use]
pub fn run(arguments: Vec<OsString>) -> u8 {
    let (cli, settings) = match settings::read::<Cli>(arguments) {
        Ok(read) => read,
        Err(SettingsError::Help(help)) => {
            // A reader that closes the pipe early is no error.
            help.print().ok();
            return u8::try_from(help.exit_code()).unwrap_or(FAILURE);
        }
        Err(SettingsError::Invalid(line)) => {
            eprintln!("{line}");
            return USAGE_ERROR;
        }
    };
    let command = match cli.command {
        Some(command) => command,
        None => {
            if let Err(line) = cli.serve.check_implied(&settings) {
                eprintln!("{line}");
                return USAGE_ERROR;
            }
            Command::Serve(cli.serve)
        }
    };
    match command.run(&settings) {
        Ok(()) => 0,
        Err(message) => {
            eprintln!("{message}");
            FAILURE
        }
    }
}

impl Command {
    fn run(self, settings: &Settings) -> Result<(), String> {
        match self {
            Command::Serve(options) => serve::serve(options, None),
            Command::Demo(demo) => serve::serve(Serve::in_memory(demo.listen)?, Some(demo)),
            Command::Config(_) => print(settings),
            Command::Compute(compute) => compute.run(),
            Command::Sweep(sweep) => sweep.run(),
            Command::Fmu(fmu) => fmu.run(),
            Command::Openapi => print(api::document().trim_end()),
            Command::Healthcheck(options) => healthcheck::healthcheck(&options),
            Command::Key(key) => key::key(key),
            Command::Backup(backup) => backup.run(),
            Command::Check(check) => check.run(),
            Command::Completions { shell } => manual::completions(shell),
            Command::Man { folder } => manual::man(&folder),
        }
    }
}
