//! The configuration file: TOML, with the names of the flags as keys.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use clap::{Arg, Command};
use toml::{Table, Value};

use super::error::{SettingsError, unknown_setting};
use super::{all_settings, masked};

pub struct ConfigValues {
    pub path: PathBuf,
    // As on the command line.
    values: BTreeMap<String, String>,
}

impl ConfigValues {
    /// Reads a file. Every key must be known and have one value; the parser of the command line validates the values
    /// later.
    pub fn read(path: &Path, command: &Command) -> Result<ConfigValues, SettingsError> {
        let place = path.display();
        let text = std::fs::read_to_string(path)
            .map_err(|error| SettingsError::Invalid(format!("cannot read the configuration file {place}: {error}")))?;
        let table: Table = text.parse().map_err(|error: toml::de::Error| {
            let before = error.span().and_then(|span| text.get(..span.start)).unwrap_or_default();
            let line = before.matches('\n').count() + 1;
            SettingsError::Invalid(format!("{place}, line {line}: {}", masked(error.message())))
        })?;
        let known = || all_settings(command).filter(|arg| arg.get_id() != "config");
        let mut values = BTreeMap::new();
        for (key, value) in &table {
            let written = || format!("{place}: {} = {}", masked(key), masked(&value.to_string()));
            let Some(arg) = known().find(|arg| arg.get_long() == Some(key)) else {
                return Err(unknown_setting(key, &written(), known().filter_map(Arg::get_long)));
            };
            let value = plain(value, arg).map_err(|why| SettingsError::Invalid(format!("{}: {why}", written())))?;
            values.insert(key.clone(), value);
        }
        Ok(ConfigValues { path: path.to_owned(), values })
    }

    pub fn get(&self, key: &str) -> Option<&str> {
        self.values.get(key).map(String::as_str)
    }
}

/// A value as on the command line.
fn plain(value: &Value, arg: &Arg) -> Result<String, String> {
    match (value, arg.get_value_delimiter()) {
        (Value::String(text), _) => Ok(text.clone()),
        (Value::Integer(_) | Value::Float(_) | Value::Boolean(_) | Value::Datetime(_), _) => Ok(value.to_string()),
        (Value::Array(elements), Some(delimiter)) => {
            let one = |element| match element {
                &Value::Array(_) | &Value::Table(_) => Err("expected a list of plain values".to_owned()),
                other => plain(other, arg),
            };
            let elements: Vec<String> = elements.iter().map(one).collect::<Result<_, _>>()?;
            if elements.iter().any(|element| element.contains(delimiter)) {
                return Err(format!("no value of the list may hold a `{delimiter}`"));
            }
            Ok(elements.join(&delimiter.to_string()))
        }
        (Value::Array(_) | Value::Table(_), _) => Err("expected one plain value".to_owned()),
    }
}
