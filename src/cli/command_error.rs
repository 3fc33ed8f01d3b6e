//! Why a command has no result: in words, and as the document that the service would send.

use std::path::Path;

use stickslip_measured::import::ImportError;
use stickslip_wire::{Code, Rejection};

use super::io::{fault, problem};
use stickslip_compute::Refusal;

pub struct CommandError {
    /// What is printed unless JSON is asked for.
    text: String,
    /// What is printed with `--json`.
    refusal: Refusal,
}

impl CommandError {
    /// What is wrong with a file of an instrument.
    pub fn of_file(file: &Path, error: ImportError) -> CommandError {
        CommandError { text: format!("{}: {error}", file.display()), refusal: error.into() }
    }

    pub fn message(self, as_json: bool) -> String {
        if as_json { fault(self.refusal, true) } else { self.text }
    }
}

impl From<String> for CommandError {
    fn from(text: String) -> CommandError {
        CommandError { refusal: Refusal::new(Code::InvalidInput, &text), text }
    }
}

impl From<&str> for CommandError {
    fn from(text: &str) -> CommandError {
        text.to_owned().into()
    }
}

impl From<Refusal> for CommandError {
    fn from(refusal: Refusal) -> CommandError {
        CommandError { text: problem(refusal.clone()), refusal }
    }
}

impl From<Rejection> for CommandError {
    fn from(rejection: Rejection) -> CommandError {
        Refusal::from(rejection).into()
    }
}
