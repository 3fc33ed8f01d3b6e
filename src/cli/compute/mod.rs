//! The commands of computations: `stickslip NAME FILE` with the formats and columns of HTTP. Some take flags beside,
//! from which they make the body of their request.

mod cycle;
mod fit;
mod profile;
mod protocol;

use std::io::{IsTerminal as _, stdout};
use std::path::{Path, PathBuf};

use axum::http::HeaderMap;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::error::{Error, ErrorKind};
use clap::{Arg, ArgMatches, Args, Command, FromArgMatches, Subcommand, arg, value_parser};
use serde::Serialize;
use serde::de::DeserializeOwned;
use utoipa::IntoParams;
use utoipa::openapi::path::Parameter;

use super::command_error::CommandError;
use super::io::{json, parsed, print, read, say, write};
use super::summary::summary;
use crate::api::{self, Problem, QueryParams, QueryReader};
use stickslip_compute::Flag;
use stickslip_compute::computations::{About, DisplayOptions, compute, entries};
use stickslip_compute::formats::Format;

/// A computation, and the flags that it is called with.
pub struct Compute {
    about: About,
    matches: ArgMatches,
}

/// Takes a part out of a reply in JSON.
type ReplyPart = fn(&[u8]) -> Result<String, String>;

/// The request that the flags and the file make.
#[derive(Default)]
struct Body {
    text: Vec<u8>,
    /// The format if the command line does not name one.
    format: Option<Format>,
    /// Takes the part to print out of the reply.
    only: Option<ReplyPart>,
    /// How a measured file was interpreted.
    reading: Vec<String>,
}

impl Body {
    /// A file that is the body.
    fn given(file: Option<&Path>) -> Result<Body, CommandError> {
        Ok(Body { text: read(file.unwrap_or(Path::new("-")))?, ..Body::default() })
    }

    /// A file that is a body, or otherwise one that `made` makes a body of, with how it was interpreted.
    fn of_file<R: Serialize>(
        file: Option<&Path>,
        made: impl FnOnce(&[u8], &Path) -> Result<(R, Vec<String>), CommandError>,
    ) -> Result<Body, CommandError> {
        let file = file.unwrap_or(Path::new("-"));
        let text = read(file)?;
        if text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&text).trim_ascii_start().starts_with(b"{") {
            return Ok(Body { text, ..Body::default() });
        }
        let (request, reading) = made(&text, file)?;
        Ok(Body { text: json(&request).into_bytes(), reading, ..Body::default() })
    }
}

/// Parses one of some values, by their names.
fn one_of<V: Clone + Send + Sync>(
    values: &'static [V],
    name: fn(V) -> &'static str,
) -> impl TypedValueParser<Value = V> {
    let names = values.iter().cloned().map(name);
    let found = move |chosen: String| values.iter().find(|value| name((*value).clone()) == chosen).cloned();
    PossibleValuesParser::new(names).try_map(move |chosen| found(chosen).ok_or("not allowed"))
}

/// The parameters of a query of the service as flags.
struct QueryFlags<Q>(Result<Q, Problem>);

impl<Q: QueryParams + IntoParams> Args for QueryFlags<Q> {
    fn augment_args(command: Command) -> Command {
        command.args(Q::into_params(|| None).into_iter().map(|Parameter { name, description, .. }| {
            let help = description.unwrap_or_default();
            let (long, value) = (name.replace('_', "-"), name.to_uppercase());
            Arg::new(name).long(long).value_name(value).help(help.trim_end_matches('.').to_owned())
        }))
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl<Q: QueryParams + IntoParams> FromArgMatches for QueryFlags<Q> {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, Error> {
        let value = |name: String| matches.get_one::<String>(&name).cloned().map(|value| (name, value));
        let given = Q::into_params(|| None).into_iter().filter_map(|parameter| value(parameter.name)).collect();
        Ok(QueryFlags(QueryReader::read(given, &HeaderMap::new())))
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

/// Flags of a computation besides those that all have.
trait Flags: Args {
    /// The body of the request.
    fn body(self, file: Option<&Path>) -> Result<Body, CommandError>;
}

/// How flags are added to a command, and read.
type FlagsOf = (fn(Command) -> Command, fn(&ArgMatches, Option<&Path>) -> Result<Body, CommandError>);

fn flags(name: &str) -> FlagsOf {
    fn of<F: Flags>() -> FlagsOf {
        (F::augment_args, |matches, file| F::from_arg_matches(matches).map_err(|error| error.to_string())?.body(file))
    }
    match name {
        "cycle" => of::<cycle::CycleFlags>(),
        "protocol" => of::<protocol::ProtocolFlags>(),
        "profile" => of::<profile::ProfileFlags>(),
        "fit" => of::<fit::FitFlags>(),
        _ => (|command| command, |_, file| Body::given(file)),
    }
}

/// Commands whose computation has another name in the API or in Python, by which they are found too.
const ALIASES: [(&str, &str); 2] = [("protocol", "protocols"), ("profile", "fit-profile")];

fn command(about: &About) -> Command {
    let formats = about.formats.iter().map(|format| format.name()).collect::<Vec<_>>();
    let format = format!("The format [default: {}]. {}", about.printed.name(), about.shows);
    let mut command = Command::new(about.name).args([
        arg!(file: <FILE> "File with the body of the request, or - for standard input")
            .value_parser(value_parser!(PathBuf)),
        arg!(--format <FORMAT>).help(format.trim_end().to_owned()).value_parser(PossibleValuesParser::new(formats)),
        arg!(--json "Print the JSON document instead of a summary, and faults as JSON, even on a terminal")
            .conflicts_with("format"),
    ]);
    if let Some(choice) = about.choice {
        let words = PossibleValuesParser::new(choice.words.iter().copied());
        command = command.arg(
            Arg::new(choice.name).long(choice.name).value_name("NAME").value_parser(words).help(choice.description),
        );
    }
    // After the flags, whose own description would take its place.
    let long = format!("{}\n\n{}", about.title, about.description);
    let aliases = ALIASES.iter().filter(|(name, _)| *name == about.name).map(|(_, alias)| *alias);
    flags(about.name).0(command).about(about.title).long_about(long).visible_aliases(aliases)
}

impl Subcommand for Compute {
    fn augment_subcommands(parent: Command) -> Command {
        parent.subcommands(entries().iter().map(|entry| command(&entry.about)))
    }

    fn augment_subcommands_for_update(parent: Command) -> Command {
        Self::augment_subcommands(parent)
    }

    fn has_subcommand(name: &str) -> bool {
        entries().iter().any(|entry| entry.about.name == name)
    }
}

impl FromArgMatches for Compute {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Compute, Error> {
        let found = matches.subcommand().and_then(|(name, matches)| {
            let entry = entries().into_iter().find(|entry| entry.about.name == name)?;
            Some(Compute { about: entry.about, matches: matches.clone() })
        });
        found.ok_or_else(|| Error::new(ErrorKind::MissingSubcommand))
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

impl Compute {
    pub fn run(&self) -> Result<(), String> {
        let Compute { about, matches } = self;
        let wants_json = matches.get_flag("json");
        let word = |name: &str| matches.get_one::<String>(name);
        let file = matches.get_one::<PathBuf>("file").map(PathBuf::as_path);
        let body = flags(about.name).1(matches, file).map_err(|error| error.message(wants_json))?;
        let named = word("format").and_then(|name| Format::named(name, about.formats));
        let format = if wants_json { Format::Columns } else { named.or(body.format).unwrap_or(about.printed) };
        let choice = about.choice.and_then(|choice| {
            let chosen = word(choice.name)?;
            choice.words.iter().copied().find(|known| known == chosen)
        });
        let shown = DisplayOptions { format, choice, indented: true };
        let reply = compute(about.name, &body.text, shown, &Flag::default());
        // A program that asked for JSON gets the problem document of a fault alone.
        if reply.is_ok() || !wants_json {
            say(file.unwrap_or(Path::new("-")), &body.reading);
        }
        let reply = reply.map_err(|error| CommandError::from(error).message(wants_json))?;
        // A document is a wall of numbers to somebody who reads it on a terminal and has not asked for it.
        let is_read = !wants_json && named.is_none() && stdout().is_terminal();
        match (body.only, format) {
            (Some(only), _) => print(only(&reply)?),
            (None, Format::Columns) if is_read => {
                let path = about.route.map_or("", |route| route.path);
                print(summary(&parsed(&reply)?, path, &parsed(api::document().as_bytes())?))
            }
            (None, Format::Columns) => print(String::from_utf8_lossy(&reply)),
            (None, _) => write(|out| out.write_all(&reply)),
        }
    }
}

/// A member of a reply, as its document is written.
fn member<T: Serialize + DeserializeOwned>(reply: &[u8], name: &str) -> Result<String, String> {
    let mut reply = serde_json::from_slice::<serde_json::Value>(reply).map_err(|error| error.to_string())?;
    let member: T = serde_json::from_value(reply[name].take()).map_err(|error| error.to_string())?;
    Ok(json(&member))
}
