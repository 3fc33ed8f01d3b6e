//! Columns of numbers in a text, with the lines before them.

use super::units::is_symbol;
use std::fmt;

/// Marks of a missing number, in lower case.
const MISSING: [&str; 13] =
    ["", "nan", "null", "bad", "---", "nodata", "n/a", "na", "#n/a", "*****", "missing", "void", "invalid"];

/// What is wrong with a file, and where.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ImportError {
    /// The line, from 1 on, if one is at fault.
    pub line: Option<usize>,
    /// The column of numbers in it, from 1 on, if one is at fault.
    pub column: Option<usize>,
    /// What is wrong with it.
    pub fault: String,
}

impl ImportError {
    pub(super) fn of_file(fault: impl Into<String>) -> ImportError {
        ImportError { line: None, column: None, fault: fault.into() }
    }

    pub(super) fn at(line: usize, column: usize, fault: impl Into<String>) -> ImportError {
        ImportError { line: Some(line), column: Some(column), fault: fault.into() }
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

/// A table of numbers.
pub(super) struct Sheet {
    /// The lines before the numbers, without the marks of a comment.
    pub(super) header: Vec<String>,
    /// Rows of as many numbers each; `None` is a missing one.
    pub(super) rows: Vec<Vec<Option<f64>>>,
    /// The line of each row, from 1 on.
    pub(super) lines: Vec<usize>,
    /// How the first row separates its numbers, in words.
    pub(super) separator: &'static str,
    /// Whether numbers have decimal commas.
    pub(super) has_decimal_commas: bool,
}

impl Sheet {
    /// The table in a text.
    pub(super) fn parse(text: &str) -> Result<Sheet, ImportError> {
        let (header, rows, lines) = (Vec::new(), Vec::new(), Vec::new());
        let mut sheet = Sheet { header, rows, lines, separator: "", has_decimal_commas: false };
        // What stands before a line with a number sign alone is a header, whatever numbers it has.
        let begin = text.lines().position(|line| line.trim() == "#").map_or(0, |index| index + 1);
        for (index, line) in text.lines().enumerate() {
            let line = line.trim_matches([' ', '\r', '\u{feff}']);
            let is_comment = line.starts_with(['#', '%']);
            if line.trim().is_empty() || (is_comment && !sheet.rows.is_empty()) {
                continue;
            }
            let cells = Cells::of(line);
            let numbers = if is_comment || index < begin { Err(0) } else { cells.numbers() };
            match numbers {
                Ok(row) if sheet.rows.is_empty() || row.len() == sheet.width() => {
                    if sheet.rows.is_empty() {
                        sheet.separator = cells.separator;
                    }
                    sheet.has_decimal_commas |= cells.has_decimal_commas;
                    sheet.rows.push(row);
                    sheet.lines.push(index + 1);
                }
                Ok(row) => {
                    let fault = format!("has {} columns, and the first {}", row.len(), sheet.width());
                    return Err(ImportError { line: Some(index + 1), column: None, fault });
                }
                Err(_) if sheet.rows.is_empty() => sheet.header.push(line.trim_start_matches(['#', '%']).to_owned()),
                // A mark of the end, after the numbers.
                Err(_) if line == "#" => {}
                Err(column) => {
                    let cell = cells.fields.get(column).map_or("", String::as_str);
                    let fault = format!("is not a row of numbers: column {} has `{cell:.40}`", column + 1);
                    return Err(ImportError { line: Some(index + 1), column: None, fault });
                }
            }
        }
        if sheet.rows.is_empty() { Err(ImportError::of_file("there are no rows of numbers")) } else { Ok(sheet) }
    }

    /// How many columns there are.
    pub(super) fn width(&self) -> usize {
        self.rows.first().map_or(0, Vec::len)
    }

    /// The cells of each line of the header that has as many as there are columns, the line above the numbers first:
    /// what stands further up is more likely a comment.
    pub(super) fn names(&self) -> impl Iterator<Item = Vec<String>> {
        self.header.iter().rev().map(|line| Cells::of_names(line)).filter(|names| names.len() == self.width())
    }

    /// The name of a column in the header, as it stands there.
    pub(super) fn name(&self, column: usize) -> Option<String> {
        self.names().find_map(|names| names.get(column).filter(|name| !name.is_empty() && !is_symbol(name)).cloned())
    }

    /// What a unit is called in any line of the header that names the columns.
    pub(super) fn unit<U>(&self, column: usize, named: impl Fn(&str) -> Option<U>) -> Option<U> {
        self.names().find_map(|names| named(names.get(column)?))
    }

    /// How the numbers are written, in words.
    pub(super) fn format(&self) -> String {
        let point = if self.has_decimal_commas { "decimal commas" } else { "decimal points" };
        format!("{} rows of {} columns, {}, {point}", self.rows.len(), self.width(), self.separator)
    }
}

/// A line, split.
struct Cells {
    fields: Vec<String>,
    separator: &'static str,
    has_decimal_commas: bool,
}

impl Cells {
    /// The cells of a line of numbers.
    fn of(line: &str) -> Cells {
        // The one mark of a missing number that has a blank in it.
        let lower = line.to_ascii_lowercase();
        let joined = if lower.contains("no data") { lower.replace("no data", "nodata") } else { line.to_owned() };
        let words: Vec<&str> = joined.split_whitespace().collect();
        let is_spaced = words.len() > 1 && words.iter().all(|word| !word.ends_with(',') && !word.starts_with(','));
        let (fields, separator): (Vec<&str>, _) = if joined.contains(';') {
            (joined.split(';').collect(), "separated by semicolons")
        } else if joined.contains('\t') {
            (joined.split('\t').collect(), "separated by tabulators")
        } else if is_spaced {
            (words, "separated by white space")
        } else {
            return Cells {
                fields: joined.split(',').map(trimmed).collect(),
                separator: "separated by commas",
                has_decimal_commas: false,
            };
        };
        let has_decimal_commas = fields.iter().any(|field| field.contains(','));
        let fields = fields.into_iter().map(|field| trimmed(field).replace(',', ".")).collect();
        Cells { fields, separator, has_decimal_commas }
    }

    /// The cells of a line of names.
    fn of_names(line: &str) -> Vec<String> {
        let separator = [';', '\t', ','].into_iter().find(|separator| line.contains(*separator));
        match separator {
            Some(separator) => line.split(separator).map(trimmed).collect(),
            None => words_with_units(line),
        }
    }

    /// The numbers of the cells, or the index of the first that is none. A line of marks alone has none.
    fn numbers(&self) -> Result<Vec<Option<f64>>, usize> {
        let value = |(index, field): (usize, &String)| {
            if MISSING.contains(&field.to_lowercase().as_str()) {
                return Ok(None);
            }
            let number = field.replace('−', "-").parse().ok().filter(|value: &f64| value.is_finite());
            number.map(Some).ok_or(index)
        };
        let row: Vec<Option<f64>> = self.fields.iter().enumerate().map(value).collect::<Result<_, _>>()?;
        if row.iter().any(Option::is_some) { Ok(row) } else { Err(0) }
    }
}

/// The words of a line; a unit in brackets belongs to the word before it.
fn words_with_units(line: &str) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for word in line.split_whitespace() {
        match names.last_mut() {
            Some(name) if word.starts_with(['[', '(', '/']) => *name = format!("{name} {word}"),
            _ => names.push(word.to_owned()),
        }
    }
    names
}

fn trimmed(cell: &str) -> String {
    cell.trim().trim_matches('"').to_owned()
}
