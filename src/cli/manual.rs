//! `stickslip completions` and `stickslip man`: the command line as shells and manuals want it.

use std::path::PathBuf;

use clap::{Args, CommandFactory as _};
use clap_complete::Shell;

use super::Cli;
use super::io::write;

const NAME: &str = "stickslip";

/// The shell that the script is for.
#[derive(Args)]
pub struct Completions {
    /// The shell.
    shell: Shell,
}

impl Completions {
    pub fn run(&self) -> Result<(), String> {
        let mut script = Vec::new();
        clap_complete::generate(self.shell, &mut Cli::command(), NAME, &mut script);
        write(|out| out.write_all(&script))
    }
}

/// Where the pages go.
#[derive(Args)]
pub struct Man {
    /// The folder to write the pages to.
    folder: PathBuf,
}

impl Man {
    /// Writes a page for the program and for each command.
    pub fn run(&self) -> Result<(), String> {
        let written = std::fs::create_dir_all(&self.folder)
            .and_then(|()| clap_mangen::generate_to(Cli::command().name(NAME), &self.folder));
        written.map_err(|error| format!("cannot write the pages to {}: {error}", self.folder.display()))
    }
}
