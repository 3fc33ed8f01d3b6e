//! Why a command has no result: in words, and as the document that the service would send.

use std::path::Path;

use stickslip_measured::import::ImportError;
use stickslip_wire::{Code, Rejection};

use super::io::{fault, problem};
use crate::api::Problem;

pub struct Refusal {
    /// What is printed unless JSON is asked for.
    text: String,
    /// What is printed with `--json`.
    problem: Problem,
}

impl Refusal {
    /// What is wrong with a file of an instrument.
    pub fn of_file(file: &Path, error: ImportError) -> Refusal {
        Refusal { text: format!("{}: {error}", file.display()), problem: error.into() }
    }

    pub fn message(self, as_json: bool) -> String {
        if as_json { fault(self.problem, true) } else { self.text }
    }
}

impl From<String> for Refusal {
    fn from(text: String) -> Refusal {
        Refusal { problem: Problem::new(Code::InvalidInput, &text), text }
    }
}

impl From<&str> for Refusal {
    fn from(text: &str) -> Refusal {
        text.to_owned().into()
    }
}

impl From<Problem> for Refusal {
    fn from(refused: Problem) -> Refusal {
        Refusal { text: problem(refused.clone()), problem: refused }
    }
}

impl From<Rejection> for Refusal {
    fn from(rejection: Rejection) -> Refusal {
        Problem::from(rejection).into()
    }
}
