//! Prints the settings as a configuration file, with the source of each.

use std::fmt::{self, Display, Formatter};

use clap::parser::ValueSource;
use clap::{Arg, ArgAction};
use toml::Value;

use super::{Settings, masked, settings_of};

/// The source of a setting that no source has.
const DEFAULT: &str = "default";

impl Display for Settings {
    fn fmt(&self, out: &mut Formatter<'_>) -> fmt::Result {
        write!(out, "# flag before environment before file before default")?;
        for arg in settings_of(&self.command).filter(|arg| arg.get_id() != "config") {
            let key = arg.get_long().unwrap_or_default();
            match self.value(arg) {
                Some(value) => write!(out, "\n{key} = {value} # {}", self.source(arg))?,
                None => write!(out, "\n# {key} is not set")?,
            }
        }
        Ok(())
    }
}

impl Settings {
    /// The value as TOML, masked.
    fn value(&self, arg: &Arg) -> Option<String> {
        let mut values = self.matches.get_raw(arg.get_id().as_str())?.map(|raw| masked(&raw.to_string_lossy()));
        if arg.get_value_delimiter().is_some() {
            return Some(Value::Array(values.map(Value::String).collect()).to_string());
        }
        let value = values.next()?;
        let logical = matches!(arg.get_action(), ArgAction::SetTrue) || value.parse::<bool>().is_ok();
        let bare = logical || value.parse::<i64>().is_ok();
        Some(if bare { value } else { Value::String(value).to_string() })
    }

    /// Whether a setting has its default, as no source has it.
    pub fn is_default(&self, key: &str) -> bool {
        let mut settings = settings_of(&self.command).filter(|arg| arg.get_long() == Some(key));
        settings.next().is_some_and(|arg| self.source(arg) == DEFAULT)
    }

    fn source(&self, arg: &Arg) -> String {
        match (self.matches.value_source(arg.get_id().as_str()), &self.file) {
            (Some(ValueSource::CommandLine), _) => "flag".to_owned(),
            (Some(ValueSource::EnvVariable), _) => {
                format!("environment {}", arg.get_env().unwrap_or_default().to_string_lossy())
            }
            (_, Some(file)) if arg.get_long().is_some_and(|key| file.get(key).is_some()) => {
                format!("file {}", masked(&file.path.to_string_lossy()))
            }
            _ => DEFAULT.to_owned(),
        }
    }
}
