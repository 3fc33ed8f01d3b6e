//! What is wrong with a file, and where.

use std::fmt;

use super::units::UnknownUnit;

/// What is wrong with a file, and where.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ImportError {
    /// The line (the row of a spreadsheet), from 1 on, if one is at fault.
    pub line: Option<usize>,
    /// The column in it, from 1 on, if one is at fault.
    pub column: Option<usize>,
    /// What is wrong with it.
    pub fault: String,
    /// The text that was taken for a unit and is not a unit of the quantity needed, if that is the fault.
    pub unknown_unit: Option<String>,
}

impl ImportError {
    pub(super) fn of_file(fault: impl Into<String>) -> ImportError {
        ImportError { line: None, column: None, fault: fault.into(), unknown_unit: None }
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
        ImportError { line, column, fault, unknown_unit: Some(unknown.text) }
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
