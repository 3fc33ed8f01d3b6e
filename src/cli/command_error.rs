//! Why a command has no result: in words, and as the document that the service would send.

use std::io::{self, IsTerminal as _};
use std::path::Path;

use stickslip_measured::import::ImportError;
use stickslip_wire::{Code, Rejection};

use super::io::json;
use stickslip_compute::Refusal;

pub struct CommandError {
    /// What is printed in place of the refusal, unless JSON is asked for.
    text: Option<String>,
    refusal: Refusal,
}

impl CommandError {
    /// What is wrong with a file of an instrument.
    pub fn of_file(file: &Path, error: ImportError) -> CommandError {
        CommandError { text: Some(format!("{}: {error}", file.display())), refusal: error.into() }
    }

    /// The message of the error: two lines or more for readers on a terminal, otherwise the document that the service
    /// would send.
    pub fn message(self, as_json: bool) -> String {
        if let Some(text) = self.text.filter(|_| !as_json) {
            return text;
        }
        let document = self.refusal.document("command line");
        if as_json || !io::stderr().is_terminal() {
            return json(&document);
        }
        let places = document.errors.iter().map(|fault| format!("\n{}: {}", fault.pointer, fault.detail));
        let detail = if document.errors.is_empty() { &document.detail } else { "" };
        format!("{}: {detail}", document.title).trim_end().to_owned() + &places.collect::<String>()
    }
}

impl From<String> for CommandError {
    fn from(text: String) -> CommandError {
        CommandError { refusal: Refusal::new(Code::InvalidInput, &text), text: Some(text) }
    }
}

impl From<Refusal> for CommandError {
    fn from(refusal: Refusal) -> CommandError {
        CommandError { text: None, refusal }
    }
}

impl From<Rejection> for CommandError {
    fn from(rejection: Rejection) -> CommandError {
        Refusal::from(rejection).into()
    }
}
