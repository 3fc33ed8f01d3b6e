//! Columns of numbers in a text, with the lines before them.

use std::borrow::Cow;
use std::fmt;

use super::units::is_symbol;

/// Lines before the numbers; a text with more has none.
const MOST_HEADER: usize = 10_000;
/// Lines above the numbers that may name the columns.
const NAMING: usize = 100;

/// Marks of a missing number, in lower case.
const MISSING: [&str; 13] =
    ["", "nan", "null", "bad", "---", "nodata", "n/a", "na", "#n/a", "*****", "missing", "void", "invalid"];

/// The mark with a blank in it.
const NO_DATA: &str = "no data";
/// Why a single column is no scan and no loop.
const ONE_COLUMN: &str = "1 columns: a scan has x and z or x, y and z, and a loop displacement and force";

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
    /// The numbers row by row; `None` is a missing one.
    cells: Vec<Option<f64>>,
    /// How many columns there are.
    width: usize,
    /// The line of each row, from 1 on.
    pub(super) lines: Vec<usize>,
    /// What separates the numbers of the first row: `semicolon`, `tab`, `white_space` or `comma`.
    pub(super) separator: &'static str,
    /// Whether numbers have decimal commas.
    pub(super) has_decimal_commas: bool,
}

impl Sheet {
    /// The table in a text.
    pub(super) fn parse(text: &str) -> Result<Sheet, ImportError> {
        let mut sheet = Sheet {
            header: Vec::new(),
            cells: Vec::new(),
            width: 0,
            lines: Vec::new(),
            separator: "",
            has_decimal_commas: false,
        };
        let mut has_column = false;
        // What keeps the first line that begins with a number from being a row of them.
        let mut spoilt = None;
        // What stands before a line with a number sign alone is a header, whatever numbers it has.
        let begin = text.lines().position(|line| line.trim() == "#").map_or(0, |index| index + 1);
        for (index, line) in text.lines().enumerate() {
            let line = line.trim_matches([' ', '\r', '\u{feff}']);
            let is_comment = line.starts_with(['#', '%']);
            if line.trim().is_empty() || (is_comment && sheet.width > 0) {
                continue;
            }
            let cells = Cells::of(line);
            let numbers = if is_comment || index < begin { Err(0) } else { cells.numbers() };
            match numbers {
                // Before the numbers, a number alone is a count or a size.
                Ok(row) if row.len() > 1 && (sheet.width == 0 || row.len() == sheet.width) => {
                    if sheet.width == 0 {
                        (sheet.width, sheet.separator) = (row.len(), cells.separator);
                    }
                    sheet.has_decimal_commas |= cells.has_decimal_commas;
                    sheet.cells.extend(row);
                    sheet.lines.push(index + 1);
                }
                Ok(row) if sheet.width > 0 => {
                    let fault = format!("has {} columns, and the first {}", row.len(), sheet.width);
                    return Err(ImportError { line: Some(index + 1), column: None, fault });
                }
                _ if sheet.width == 0 => {
                    has_column |= numbers.is_ok();
                    if let (None, Err(column @ 1..)) = (&spoilt, &numbers) {
                        spoilt = Some(cells.fault(index + 1, *column));
                    }
                    if sheet.header.len() == MOST_HEADER {
                        break;
                    }
                    sheet.header.push(line.trim_start_matches(['#', '%']).to_owned());
                }
                // A mark of the end, after the numbers.
                _ if line == "#" => {}
                Ok(_) => {}
                Err(column) => return Err(cells.fault(index + 1, column)),
            }
        }
        match (sheet.width, spoilt) {
            (0, Some(error)) => Err(error),
            (0, None) if has_column => Err(ImportError::of_file(ONE_COLUMN)),
            (0, None) => Err(ImportError::of_file("there are no rows of numbers")),
            _ => Ok(sheet),
        }
    }

    /// How many columns there are.
    pub(super) fn width(&self) -> usize {
        self.width
    }

    /// The rows.
    pub(super) fn rows(&self) -> impl Iterator<Item = &[Option<f64>]> {
        self.cells.chunks_exact(self.width.max(1))
    }

    /// The rows, with the line of each.
    pub(super) fn numbered(&self) -> impl Iterator<Item = (usize, &[Option<f64>])> {
        self.lines.iter().copied().zip(self.rows())
    }

    /// The cells of each line of the header that has as many as there are columns, the line above the numbers first:
    /// what stands further up is more likely a comment.
    pub(super) fn names(&self) -> impl Iterator<Item = Vec<String>> {
        self.header
            .iter()
            .rev()
            .take(NAMING)
            .map(|line| Cells::of_names(line))
            .filter(|names| names.len() == self.width())
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
        let separator = match self.separator {
            "semicolon" => "semicolons",
            "tab" => "tabulators",
            "comma" => "commas",
            _ => "white space",
        };
        format!("{} rows of {} columns, separated by {separator}, {point}", self.lines.len(), self.width)
    }
}

/// A line, split.
struct Cells<'a> {
    fields: Vec<Cow<'a, str>>,
    separator: &'static str,
    has_decimal_commas: bool,
}

impl<'a> Cells<'a> {
    /// The cells of a line of numbers.
    fn of(line: &'a str) -> Cells<'a> {
        if let Some(joined) = without_blanks(line) {
            let Cells { fields, separator, has_decimal_commas } = Cells::of(&joined);
            let fields = fields.into_iter().map(|field| Cow::Owned(field.into_owned())).collect();
            return Cells { fields, separator, has_decimal_commas };
        }
        let (fields, separator): (Vec<&str>, _) = if line.contains(';') {
            (line.split(';').collect(), "semicolon")
        } else if line.contains('\t') {
            (line.split('\t').collect(), "tab")
        } else {
            let words: Vec<&str> = line.split_whitespace().collect();
            if words.len() < 2 || words.iter().any(|word| word.ends_with(',') || word.starts_with(',')) {
                let fields = line.split(',').map(|field| Cow::Borrowed(trimmed(field))).collect();
                return Cells { fields, separator: "comma", has_decimal_commas: false };
            }
            (words, "white_space")
        };
        let has_decimal_commas = fields.iter().any(|field| field.contains(','));
        let pointed = |field: &'a str| match trimmed(field) {
            field if field.contains(',') => Cow::Owned(field.replace(',', ".")),
            field => Cow::Borrowed(field),
        };
        Cells { fields: fields.into_iter().map(pointed).collect(), separator, has_decimal_commas }
    }

    /// The cells of a line of names.
    fn of_names(line: &str) -> Vec<String> {
        let separator = [';', '\t', ','].into_iter().find(|separator| line.contains(*separator));
        match separator {
            Some(separator) => line.split(separator).map(|name| trimmed(name).to_owned()).collect(),
            None => words_with_units(line),
        }
    }

    /// What is wrong with the cell of this index, in this line from 1 on.
    fn fault(&self, line: usize, column: usize) -> ImportError {
        let cell = self.fields.get(column).map_or("", Cow::as_ref);
        ImportError::at(line, column + 1, format!("`{cell:.40}` is not a number"))
    }

    /// The numbers of the cells, or the index of the first that is none. A line of marks alone has none.
    fn numbers(&self) -> Result<Vec<Option<f64>>, usize> {
        let value = |(index, field): (usize, &Cow<'_, str>)| match field.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(Some(value)),
            _ if MISSING.contains(&field.to_lowercase().as_str()) => Ok(None),
            _ => match field.replace('−', "-").parse::<f64>() {
                Ok(value) if value.is_finite() => Ok(Some(value)),
                _ => Err(index),
            },
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

fn trimmed(cell: &str) -> &str {
    cell.trim().trim_matches('"')
}

/// A line whose marks of missing numbers have no blank in them any more, if it has such marks, in whatever case.
fn without_blanks(line: &str) -> Option<String> {
    let find = |text: &str| {
        let is_mark = |place: &usize| {
            let mark = text.as_bytes().get(*place..*place + NO_DATA.len());
            mark.is_some_and(|mark| mark.eq_ignore_ascii_case(NO_DATA.as_bytes()))
        };
        text.match_indices(['n', 'N']).map(|(place, _)| place).find(is_mark)
    };
    let (mut joined, mut rest) = (String::new(), line);
    while let Some(place) = find(rest) {
        joined.push_str(&rest[..place]);
        joined.push_str("nodata");
        rest = &rest[place + NO_DATA.len()..];
    }
    (!joined.is_empty()).then(|| joined + rest)
}
