//! `stickslip completions` and `stickslip man`: the command line as shells and manuals want it.

use std::path::Path;

use clap::CommandFactory as _;
use clap_complete::Shell;

use super::Cli;
use super::io::write;

const NAME: &str = "stickslip";

pub fn completions(shell: Shell) -> Result<(), String> {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Cli::command(), NAME, &mut script);
    write(|out| out.write_all(&script))
}

/// Writes a page for the program and for each command.
pub fn man(folder: &Path) -> Result<(), String> {
    let written =
        std::fs::create_dir_all(folder).and_then(|()| clap_mangen::generate_to(Cli::command().name(NAME), folder));
    written.map_err(|error| format!("cannot write the pages to {}: {error}", folder.display()))
}
