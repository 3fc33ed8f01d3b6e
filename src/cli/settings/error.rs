//! What is wrong with the settings, in one line: the key, its value, and what is allowed.

use std::error::Error as _;
use std::ffi::OsString;

use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{Arg, Command};
use strsim::levenshtein;

use super::masked;

/// Why there is no command to run.
pub enum SettingsError {
    /// The help or the version was asked for.
    Help(clap::Error),
    /// A line about what is wrong.
    Invalid(String),
}

/// The error for an unknown setting: its name, how it was written, and the names that there are.
pub fn unknown_setting<'a>(name: &str, written: &str, known: impl Iterator<Item = &'a str>) -> SettingsError {
    let mut known: Vec<&str> = known.collect();
    known.sort_unstable();
    known.dedup();
    let near = known.iter().map(|known| (levenshtein(name, known), known)).min();
    let advice = match near.filter(|(distance, _)| *distance <= name.len() / 3) {
        Some((_, near)) => format!("is it {near}?"),
        None => format!("expected one of {}", known.join(", ")),
    };
    SettingsError::Invalid(format!("{written}: unknown setting, {advice}"))
}

/// The error of the parser of arguments.
pub fn from_clap(error: clap::Error, command: &Command, arguments: &[OsString]) -> SettingsError {
    if !error.use_stderr() {
        return SettingsError::Help(error);
    }
    let text = |kind| match error.get(kind) {
        Some(ContextValue::String(text)) => Some(text.as_str()),
        _ => None,
    };
    let name = text(ContextKind::InvalidArg).unwrap_or_default();
    // Of any command.
    let mut all = command.get_subcommands().chain([command]).flat_map(Command::get_arguments);
    let mut arg = || all.find(|arg| arg.get_long().is_some() && arg.get_long() == long(name));
    let why = match (error.kind(), arg()) {
        (ErrorKind::UnknownArgument, _) => {
            // Of the command that the arguments name, right or wrong otherwise.
            let names = arguments.iter().skip(1);
            let invoked = names.fold(command, |command, name| command.find_subcommand(name).unwrap_or(command));
            let known = invoked.get_arguments().filter_map(|arg| arg.get_long().map(|long| format!("--{long}")));
            let known: Vec<String> = known.collect();
            return unknown_setting(name, &masked(name), known.iter().map(String::as_str));
        }
        (ErrorKind::InvalidValue | ErrorKind::ValueValidation, Some(arg)) => {
            let value = text(ContextKind::InvalidValue).unwrap_or_default();
            let name = written(arg, value, arguments);
            let why = match (error.source(), value) {
                (Some(source), _) => masked(&source.to_string()),
                (None, "") => "a value is missing".to_owned(),
                (None, _) => "not allowed".to_owned(),
            };
            format!("{name}: {why}; expected: {}", expected(arg, &error))
        }
        // An error of the command line: the first paragraph says what is wrong, the others how to get help.
        _ => first_paragraph(&error.to_string()),
    };
    SettingsError::Invalid(why)
}

/// The setting and its value as their source writes them: the first that has one.
fn written(arg: &Arg, value: &str, arguments: &[OsString]) -> String {
    let (name, value) = (arg.get_long().unwrap_or_default(), masked(value));
    let is_flag = arguments.iter().any(|argument| argument.to_str().and_then(long) == Some(name));
    let variable = arg.get_env().filter(|variable| std::env::var_os(variable).is_some());
    match variable.filter(|_| !is_flag) {
        Some(variable) => format!("{}={value}", variable.to_string_lossy()),
        None => format!("--{name} {value}"),
    }
}

/// The allowed values: the possible ones, otherwise the help text.
fn expected(arg: &Arg, error: &clap::Error) -> String {
    match error.get(ContextKind::ValidValue) {
        Some(ContextValue::Strings(possible)) if !possible.is_empty() => possible.join(" or "),
        _ => first_paragraph(&arg.get_help().map(ToString::to_string).unwrap_or_default()),
    }
}

fn first_paragraph(text: &str) -> String {
    let paragraph = text.split("\n\n").next().unwrap_or_default().trim_start_matches("error: ");
    masked(&paragraph.split_whitespace().collect::<Vec<_>>().join(" "))
}

/// The name within `--name <VALUE>` or `--name[=<VALUE>]`.
fn long(arg: &str) -> Option<&str> {
    arg.strip_prefix("--")?.split([' ', '=', '[']).next()
}
