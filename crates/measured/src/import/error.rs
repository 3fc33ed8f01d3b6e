//! What is wrong with a file, and where.

use std::fmt;

use super::units::UnknownUnit;

/// What is wrong with a file, and where.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ImportError {
    /// The line (the row of a spreadsheet), from 1 on, if one is at fault.
    pub line: Option<usize>,
    /// The column in it, from 1 on, if one is at fault.
    pub column: Option<usize>,
    /// What is wrong with it.
    pub fault: String,
    /// The text that was taken for a unit and is not a unit of the quantity needed, if that is the fault.
    pub unknown_unit: Option<String>,
    /// What the file may mean, where that is the fault: each with the mapping that chooses it.
    pub candidates: Vec<Candidate>,
    /// Whether the work was ended from outside.
    pub is_stopped: bool,
}

/// One of several things that a file may mean.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Candidate {
    /// What would be chosen: `load`, `displacement`, `table`, ...
    pub quantity: &'static str,
    /// The number of its column, from 1 on, if it is one.
    pub column: Option<usize>,
    /// Its name in the file.
    pub name: String,
    /// Its first values, as the file has them.
    pub values: Vec<String>,
    /// The mapping with which this one is read.
    pub mapping: String,
}

impl ImportError {
    pub(super) fn of_file(fault: impl Into<String>) -> ImportError {
        ImportError { fault: fault.into(), ..ImportError::default() }
    }

    pub(super) fn at_line(line: usize, fault: impl Into<String>) -> ImportError {
        ImportError { line: Some(line), ..ImportError::of_file(fault) }
    }

    pub(super) fn at(line: usize, column: usize, fault: impl Into<String>) -> ImportError {
        ImportError { column: Some(column), ..ImportError::at_line(line, fault) }
    }

    /// A unit that is named and not known; `advice` says how to name it beside the file.
    pub(super) fn unit(line: Option<usize>, column: Option<usize>, unknown: UnknownUnit, advice: &str) -> ImportError {
        let fault = format!("{unknown}: {advice}");
        ImportError { line, column, unknown_unit: Some(unknown.text), ..ImportError::of_file(fault) }
    }

    /// Several things that the file may mean.
    pub(super) fn ambiguous(fault: impl Into<String>, candidates: Vec<Candidate>) -> ImportError {
        ImportError { candidates, ..ImportError::of_file(fault) }
    }

    /// The work was ended by a client that left, or by its time limit.
    pub(super) fn stopped() -> ImportError {
        ImportError { is_stopped: true, ..ImportError::of_file("stopped") }
    }
}

impl fmt::Display for ImportError {
    fn fmt(&self, text: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.line, self.column) {
            (Some(line), Some(column)) => write!(text, "line {line}, column {column}: {}", self.fault),
            (Some(line), None) => write!(text, "line {line} {}", self.fault),
            _ => text.write_str(&self.fault),
        }
    }
}

impl std::error::Error for ImportError {}
