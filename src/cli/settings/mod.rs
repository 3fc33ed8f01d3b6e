//! Settings: every one may come as a flag, from the environment or from a file, under the same name.
//!
//! A setting is an argument with a long flag and a variable `STICKSLIP_…`, of a command that takes [`ConfigFile`]; nothing
//! else has to be said of it. A flag goes before the environment, that before the file, and that before the default: the
//! file's values are put in the place of the defaults, and the arguments are parsed anew. The sources are read one after the
//! other, so that a refusal can say which of them is to blame.

mod file;
mod mask;
mod refusal;
mod show;

use std::ffi::OsString;
use std::path::PathBuf;

use clap::{Arg, ArgMatches, Args, Command, CommandFactory, FromArgMatches};

use file::ConfigValues;
pub use mask::shown;
use refusal::Origin;
pub use refusal::Refusal;

/// What the names of all variables begin with.
const PREFIX: &str = "STICKSLIP_";
/// Variables that Kubernetes gives every container beside a service of this name.
const NOT_OURS: [&str; 2] = ["STICKSLIP_SERVICE_", "STICKSLIP_PORT"];

/// Makes the settings of a command readable from a file.
#[derive(Args)]
pub struct ConfigFile {
    /// A TOML file with settings, by the names of their flags. None is read unless it is named.
    #[arg(long, value_name = "FILE", env = "STICKSLIP_CONFIG")]
    config: Option<PathBuf>,
}

/// The settings in force, to be printed.
pub struct Settings {
    /// The command that they are of.
    command: Command,
    matches: ArgMatches,
    file: Option<ConfigValues>,
}

/// Reads the command line with all that stands behind it.
///
/// # Errors
/// [`Refusal`]: the help that was asked for, or a line that says what is wrong.
pub fn read<T: CommandFactory + FromArgMatches>(arguments: Vec<OsString>) -> Result<(T, Settings), Refusal> {
    let mut command = T::command();
    let parse = |command: &Command, origin: Origin<'_>| {
        command.clone().try_get_matches_from(&arguments).map_err(|error| refusal::line(error, command, &origin))
    };
    parse(&without_environment(command.clone()), Origin::Flag)?;
    let mut matches = parse(&command, Origin::Environment)?;
    let mut file = None;
    if known(asked(&command, &matches)).any(|setting| setting.get_id() == "config") {
        no_unknown_variables(&command)?;
        if let Some(path) = own(&matches).get_one::<PathBuf>("config") {
            let values = ConfigValues::read(path, &command)?;
            let name = matches.subcommand_name().map(str::to_owned);
            command = match name {
                Some(name) => command.mut_subcommand(name, |own| with_defaults(own, &values)),
                None => with_defaults(command, &values),
            };
            matches = parse(&command, Origin::File(&values))?;
            file = Some(values);
        }
    }
    let read = T::from_arg_matches(&matches).map_err(|error| refusal::line(error, &command, &Origin::Flag))?;
    let settings = Settings { command: asked(&command, &matches).clone(), matches: own(&matches).clone(), file };
    Ok((read, settings))
}

/// The arguments of a command that are settings.
fn known(command: &Command) -> impl Iterator<Item = &Arg> {
    command.get_arguments().filter(|arg| arg.get_long().is_some() && arg.get_env().is_some())
}

/// The command that was asked for: a subcommand, or the one at the top.
fn asked<'a>(command: &'a Command, matches: &ArgMatches) -> &'a Command {
    matches.subcommand_name().and_then(|name| command.find_subcommand(name)).unwrap_or(command)
}

/// The arguments of the command that was asked for.
fn own(matches: &ArgMatches) -> &ArgMatches {
    matches.subcommand().map_or(matches, |(_, own)| own)
}

fn without_environment(command: Command) -> Command {
    command.mut_args(|arg| arg.env(None::<&'static str>)).mut_subcommands(without_environment)
}

fn with_defaults(command: Command, values: &ConfigValues) -> Command {
    command.mut_args(|arg| match arg.get_long().and_then(|long| values.get(long)) {
        Some(value) if arg.get_env().is_some() => arg.default_value(value.to_owned()),
        _ => arg,
    })
}

/// Every setting there is, of whatever command.
fn everywhere(command: &Command) -> impl Iterator<Item = &Arg> {
    known(command).chain(command.get_subcommands().flat_map(known))
}

/// A misspelt variable would otherwise do nothing, silently.
fn no_unknown_variables(command: &Command) -> Result<(), Refusal> {
    let ours = |name: &str| name.starts_with(PREFIX) && !NOT_OURS.iter().any(|other| name.starts_with(other));
    for (name, value) in std::env::vars_os() {
        let (name, value) = (name.to_string_lossy(), value.to_string_lossy());
        let known: Vec<_> = everywhere(command).filter_map(|arg| arg.get_env()?.to_str()).collect();
        if ours(&name) && !known.contains(&&*name) {
            return Err(refusal::unknown(&format!("{name}={}", shown(&value)), known.into_iter()));
        }
    }
    Ok(())
}
