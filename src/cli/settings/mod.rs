//! Settings: each can be a flag, a variable of the environment or an entry of a file, under the same name.
//!
//! A setting is an argument with a long flag and a variable `STICKSLIP_…`, of a command with [`ConfigFile`]; nothing
//! else declares it. A flag precedes the environment, then the file, then the default: the values of the file replace
//! the defaults, and the arguments are parsed again.

mod error;
mod file;
mod mask;
mod show;

use std::ffi::OsString;
use std::path::PathBuf;

use clap::{Arg, ArgMatches, Args, Command, CommandFactory, FromArgMatches};

pub use error::SettingsError;
use file::ConfigValues;
pub use mask::masked;

const PREFIX: &str = "STICKSLIP_";
/// Prefixes of variables that Kubernetes sets for a service of this name.
const FOREIGN_PREFIXES: [&str; 2] = ["STICKSLIP_SERVICE_", "STICKSLIP_PORT"];

/// Makes the settings of a command readable from a file.
#[derive(Args)]
pub struct ConfigFile {
    /// TOML file with settings, by the names of their flags.
    #[arg(long, value_name = "FILE", env = "STICKSLIP_CONFIG")]
    config: Option<PathBuf>,
}

/// The settings of a command, to be printed.
pub struct Settings {
    command: Command,
    matches: ArgMatches,
    file: Option<ConfigValues>,
}

/// Reads the command line, the environment and the configuration file.
///
/// # Errors
/// [`SettingsError`]: the requested help, or a line about what is wrong.
pub fn read<T: CommandFactory + FromArgMatches>(arguments: Vec<OsString>) -> Result<(T, Settings), SettingsError> {
    let mut command = T::command();
    let parse = |command: &Command, file| {
        let matches = command.clone().try_get_matches_from(&arguments);
        matches.map_err(|error| error::from_clap(error, command, &arguments, file))
    };
    let mut matches = parse(&command, None)?;
    let mut file = None;
    if settings_of(requested(&command, &matches)).any(|setting| setting.get_id() == "config") {
        check_variables(&command)?;
        if let Some(path) = requested_matches(&matches).get_one::<PathBuf>("config") {
            let values = ConfigValues::read(path, &command)?;
            let name = matches.subcommand_name().map(str::to_owned);
            command = match name {
                Some(name) => command.mut_subcommand(name, |own| with_defaults(own, &values)),
                None => with_defaults(command, &values),
            };
            matches = parse(&command, Some(&values.path))?;
            file = Some(values);
        }
    }
    let read = T::from_arg_matches(&matches).map_err(|error| error::from_clap(error, &command, &arguments, None))?;
    let settings =
        Settings { command: requested(&command, &matches).clone(), matches: requested_matches(&matches).clone(), file };
    Ok((read, settings))
}

/// The arguments of a command that are settings.
fn settings_of(command: &Command) -> impl Iterator<Item = &Arg> {
    command.get_arguments().filter(|arg| arg.get_long().is_some() && arg.get_env().is_some())
}

/// The requested command: a subcommand, or the top level.
fn requested<'a>(command: &'a Command, matches: &ArgMatches) -> &'a Command {
    matches.subcommand_name().and_then(|name| command.find_subcommand(name)).unwrap_or(command)
}

fn requested_matches(matches: &ArgMatches) -> &ArgMatches {
    matches.subcommand().map_or(matches, |(_, own)| own)
}

fn with_defaults(command: Command, values: &ConfigValues) -> Command {
    command.mut_args(|arg| match arg.get_long().and_then(|long| values.get(long)) {
        Some(value) if arg.get_env().is_some() => arg.default_value(value.to_owned()),
        _ => arg,
    })
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
