//! Settings: each can be a flag or a variable of the environment.
//!
//! A setting is an argument with a long flag and a variable `STICKSLIP_…`; nothing else declares it. A flag
//! precedes the environment, and that the default.

mod error;
mod mask;
mod show;

use std::ffi::OsString;

use clap::{Arg, ArgMatches, Command, CommandFactory, FromArgMatches};

pub use error::SettingsError;
pub use mask::masked;

const PREFIX: &str = "STICKSLIP_";
/// Prefixes of variables that Kubernetes sets for a service of this name.
const FOREIGN_PREFIXES: [&str; 2] = ["STICKSLIP_SERVICE_", "STICKSLIP_PORT"];

/// The settings of a command, to be printed.
pub struct Settings {
    command: Command,
    matches: ArgMatches,
}

/// Reads the command line and the environment.
///
/// # Errors
/// [`SettingsError`]: the requested help, or a line about what is wrong.
pub fn read<T: CommandFactory + FromArgMatches>(arguments: Vec<OsString>) -> Result<(T, Settings), SettingsError> {
    let command = T::command();
    let wrong = |error| error::from_clap(error, &command, &arguments);
    let matches = command.clone().try_get_matches_from(&arguments).map_err(wrong)?;
    let name = matches.subcommand_name().and_then(|name| command.find_subcommand(name));
    let requested = name.unwrap_or(&command).clone();
    if settings_of(&requested).next().is_some() {
        check_variables(&command)?;
    }
    let read = T::from_arg_matches(&matches).map_err(wrong)?;
    let matches = matches.subcommand().map_or(&matches, |(_, own)| own).clone();
    Ok((read, Settings { command: requested, matches }))
}

/// The arguments of a command that are settings.
fn settings_of(command: &Command) -> impl Iterator<Item = &Arg> {
    command.get_arguments().filter(|arg| arg.get_long().is_some() && arg.get_env().is_some())
}

fn all_settings(command: &Command) -> impl Iterator<Item = &Arg> {
    settings_of(command).chain(command.get_subcommands().flat_map(settings_of))
}

/// Fails if a variable has the prefix but names no setting: a misspelt one would be ignored.
fn check_variables(command: &Command) -> Result<(), SettingsError> {
    let ours = |name: &str| name.starts_with(PREFIX) && !FOREIGN_PREFIXES.iter().any(|other| name.starts_with(other));
    for (name, value) in std::env::vars_os() {
        let (name, value) = (name.to_string_lossy(), value.to_string_lossy());
        let known: Vec<_> = all_settings(command).filter_map(|arg| arg.get_env()?.to_str()).collect();
        if ours(&name) && !known.contains(&&*name) {
            return Err(error::unknown_setting(&name, &format!("{name}={}", masked(&value)), known.into_iter()));
        }
    }
    Ok(())
}
