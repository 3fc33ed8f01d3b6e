//! Why a request has no reply, as the problem document says it.

use stickslip_measured::import::{Candidate, ImportError};
use stickslip_mechanics::Error;
use stickslip_wire::{FileCandidate, ProblemDocument};

use crate::formats::Unwritable;
use crate::prelude::*;

/// A refusal: its kind, what happened, and the place in the request.
#[derive(Clone, Debug)]
pub struct Refusal {
    /// The kind.
    pub code: Code,
    /// What happened.
    pub detail: String,
    /// Each fault of the request with its place.
    pub errors: Vec<Fault>,
    /// What a file may mean, each with the mapping that chooses it.
    pub candidates: Box<[FileCandidate]>,
    /// The cause for the log, which clients do not see.
    pub cause: Option<String>,
}

impl Refusal {
    /// A refusal of this kind, with a text of what happened.
    pub fn new(code: Code, detail: impl Into<String>) -> Refusal {
        Refusal { code, detail: detail.into(), errors: Vec::new(), candidates: Box::default(), cause: None }
    }

    /// A refusal with one place in the request.
    pub fn at(code: Code, pointer: impl Into<String>, detail: impl Into<String>) -> Refusal {
        let (pointer, detail) = (pointer.into(), detail.into());
        let errors = vec![Fault::new(pointer, detail.clone())];
        Refusal { errors, ..Refusal::new(code, detail) }
    }

    /// A fault of this program; the cause is for the log.
    pub fn internal(cause: impl Into<String>) -> Refusal {
        let detail = "a fault of the server, not of the request: its operator finds the cause in the log under the \
                      request_id";
        Refusal { cause: Some(cause.into()), ..Refusal::new(Code::Internal, detail) }
    }

    /// The problem document of the refusal.
    pub fn document(self, request_id: &str) -> ProblemDocument {
        let mapping = self.candidates.first().map(|first| first.mapping.clone());
        let document = ProblemDocument::new(self.code, self.detail, self.errors, request_id);
        ProblemDocument { candidates: self.candidates.into(), mapping, ..document }
    }
}

impl From<Rejection> for Refusal {
    fn from(rejection: Rejection) -> Self {
        let detail = rejection.to_string();
        match rejection {
            Rejection::NotJson(_) => Refusal::new(Code::NotJson, detail),
            Rejection::Invalid(errors) => Refusal { errors, ..Refusal::new(Code::InvalidInput, detail) },
            Rejection::Refused { pointer, error } => Failure::at(pointer, error).into(),
        }
    }
}

impl From<Fault> for Refusal {
    fn from(fault: Fault) -> Self {
        Refusal { errors: vec![fault.clone()], ..Refusal::new(Code::InvalidInput, fault.detail) }
    }
}

impl From<ImportError> for Refusal {
    /// At the line and column of the file, counted from 1.
    fn from(error: ImportError) -> Self {
        let place = |name: &str, number: Option<usize>| number.map_or_else(String::new, |at| format!("/{name}/{at}"));
        let pointer = place("line", error.line) + &place("column", error.column);
        let code = match (&error.unknown_unit, error.candidates.is_empty()) {
            (Some(_), _) => Code::UnknownUnit,
            (None, false) => Code::AmbiguousFile,
            (None, true) => Code::InvalidInput,
        };
        let refusal = Refusal::at(code, pointer, error.to_string());
        let candidate = |Candidate { quantity, column, name, values, mapping }| FileCandidate {
            quantity: String::from(quantity),
            column,
            name,
            values,
            mapping,
        };
        Refusal { candidates: error.candidates.into_iter().map(candidate).collect(), ..refusal }
    }
}

impl From<Unwritable> for Refusal {
    fn from(error: Unwritable) -> Self {
        Refusal::internal(error.to_string())
    }
}

impl From<Failure> for Refusal {
    fn from(failure: Failure) -> Self {
        let (code, detail) = (failure.code(), failure.cause.to_string());
        match failure.cause {
            Cause::Interrupted(Interrupted::Abandoned) | Cause::Lifted => Refusal::new(code, detail),
            Cause::Refused(error) => {
                let mut fault = Fault::new(failure.pointer, detail.clone());
                match error {
                    Error::ForceExceedsFriction { limit, .. } | Error::TorqueExceedsFriction { limit, .. } => {
                        (fault.exclusive_minimum, fault.exclusive_maximum) = (Some(-limit), Some(limit));
                    }
                    Error::BulkTooLarge { largest, .. } => {
                        (fault.minimum, fault.maximum) = (Some(-largest), Some(largest));
                    }
                    _ => {}
                }
                Refusal { errors: vec![fault], ..Refusal::new(code, detail) }
            }
            _ => Refusal::at(code, failure.pointer, detail),
        }
    }
}
