//! What was taken for what in a file.

use super::label::Mention;
use super::sheet::{Sheet, columns};
use super::source::Source;
use super::units::Unit;

/// Columns that are listed one by one; a wider table is a matrix.
const MOST_COLUMNS: usize = 1000;
/// Lines of the header that are shown, and characters of each.
const SHOWN: [usize; 2] = [20, 200];

/// How a file was read.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Preview {
    /// The encoding, by its name in the standard of the web, or the kind of a spreadsheet.
    pub encoding: String,
    /// What separates the columns: `semicolon`, `tab`, `white_space` or `comma`.
    pub separator: &'static str,
    /// Whether numbers have decimal commas.
    pub has_decimal_commas: bool,
    /// Rows of numbers.
    pub rows: usize,
    /// The first lines before the numbers.
    pub header: Vec<String>,
    /// The columns; none of a matrix.
    pub columns: Vec<ColumnUse>,
    /// Lines with text that are not in what was read: headers, remarks, and rows that lack a number without which they
    /// mean nothing.
    pub rows_left_out: Vec<usize>,
    /// The stride: of a matrix one row and one column in so many are kept.
    pub thinned: usize,
    /// The same and more in sentences.
    pub reading: Vec<String>,
}

/// A column, and what it was taken for.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ColumnUse {
    /// Its name in the header.
    pub name: Option<String>,
    /// What it was taken for: `x`, `y`, `z`, `displacement`, `force`, `time` or `normal_force`; none if it was not
    /// used.
    pub quantity: Option<&'static str>,
    /// The unit in which the file has it, as it is written there or by its symbol, if it was used.
    pub unit: Option<String>,
    /// Whether neither the file nor a hint names that unit.
    pub is_assumed: bool,
    /// Why it was left out, if it was not used.
    pub left_out: Option<String>,
}

/// The unit of a column: as it is written, and whether anything names it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ColumnUnit {
    pub(super) unit: Unit,
    pub(super) text: String,
    pub(super) is_assumed: bool,
}

impl Preview {
    /// That of a table in which nothing was used yet.
    pub(super) fn of(sheet: &Sheet<'_>, source: &Source) -> Preview {
        let columns = if sheet.width > MOST_COLUMNS { 0 } else { sheet.width };
        let shown = |(_, line): &(usize, &str)| line.chars().take(SHOWN[1]).collect();
        Preview {
            encoding: source.encoding.clone(),
            separator: sheet.separator.name(),
            has_decimal_commas: false,
            rows: sheet.len(),
            header: sheet.header.iter().take(SHOWN[0]).map(shown).collect(),
            columns: (0..columns)
                .map(|column| ColumnUse { name: sheet.name(column).map(str::to_owned), ..ColumnUse::default() })
                .collect(),
            rows_left_out: sheet.left_out.clone(),
            thinned: 1,
            reading: Vec::new(),
        }
    }

    /// Notes how the numbers are written, before all other sentences.
    pub(super) fn written(&mut self, sheet: &Sheet<'_>, has_decimal_commas: bool) {
        self.has_decimal_commas = has_decimal_commas;
        let mark = if has_decimal_commas { "decimal commas" } else { "decimal points" };
        let Sheet { width, separator, .. } = sheet;
        let rows = sheet.len();
        let written = match self.encoding.as_str() {
            "xlsx" | "ods" => String::new(),
            _ => format!(", separated by {}, {mark}", separator.plural()),
        };
        let rows = if rows == 1 { "1 row".to_owned() } else { format!("{rows} rows") };
        self.reading.insert(0, format!("{}, {rows} of {}{written}.", self.encoding, columns(*width)));
    }

    /// Notes what a column was taken for.
    pub(super) fn take(&mut self, column: usize, quantity: &'static str, unit: &ColumnUnit) {
        if let Some(used) = self.columns.get_mut(column) {
            used.quantity = Some(quantity);
            used.unit = Some(unit.text.clone());
            used.is_assumed = unit.is_assumed;
            used.left_out = None;
        }
    }

    /// Notes why a column is left out.
    pub(super) fn leave_out(&mut self, column: usize, reason: impl Into<String>) {
        if let Some(used) = self.columns.get_mut(column) {
            used.left_out = Some(reason.into());
        }
    }

    /// Notes rows that are left out, and says why.
    pub(super) fn leave_out_rows(&mut self, lines: &[usize], reason: &str) {
        if lines.is_empty() {
            return;
        }
        self.rows_left_out.extend(lines);
        self.rows_left_out.sort_unstable();
        let rows = if lines.len() == 1 { "1 row is".to_owned() } else { format!("{} rows are", lines.len()) };
        self.reading.push(format!("{rows} left out, the first at line {}: {reason}.", lines[0]));
    }
}

/// What a header says of the unit of a column, in words, where it is of no use.
pub(super) fn said_of(unit: &Mention) -> Option<String> {
    match unit {
        Mention::Absent => None,
        Mention::Known(unit, text) => Some(format!("`{text}` is a unit of {}", unit.dimension.noun())),
        Mention::Unknown(text) => Some(format!("`{text}` is not known as a unit")),
    }
}
