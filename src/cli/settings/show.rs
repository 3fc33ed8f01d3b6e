//! Prints the settings as a file of variables, for a service manager or a container: those that are set with their
//! sources, and the defaults as comments.

use std::fmt::{self, Display, Formatter};

use clap::Arg;
use clap::parser::ValueSource;

use super::{Settings, masked, settings_of};

impl Display for Settings {
    fn fmt(&self, out: &mut Formatter<'_>) -> fmt::Result {
        write!(out, "# a flag comes before the environment, and that before the default")?;
        for arg in settings_of(&self.command) {
            let name = arg.get_env().unwrap_or_default().to_string_lossy();
            match (self.value(arg), self.source(arg)) {
                (None, _) => write!(out, "\n# {name} is not set")?,
                (Some(value), None) => write!(out, "\n# default: {name}={value}")?,
                (Some(value), Some(source)) => write!(out, "\n# {source}:\n{name}={value}")?,
            }
        }
        Ok(())
    }
}

impl Settings {
    /// The value as in the environment, masked.
    fn value(&self, arg: &Arg) -> Option<String> {
        let values = self.matches.get_raw(arg.get_id().as_str())?.map(|raw| masked(&raw.to_string_lossy()));
        Some(values.collect::<Vec<_>>().join(","))
    }

    /// Whether a setting has its default, as no source has it.
    pub fn is_default(&self, key: &str) -> bool {
        let mut settings = settings_of(&self.command).filter(|arg| arg.get_long() == Some(key));
        settings.next().is_some_and(|arg| self.source(arg).is_none())
    }

    fn source(&self, arg: &Arg) -> Option<&'static str> {
        match self.matches.value_source(arg.get_id().as_str()) {
            Some(ValueSource::CommandLine) => Some("by a flag"),
            Some(ValueSource::EnvVariable) => Some("by the environment"),
            _ => None,
        }
    }
}
