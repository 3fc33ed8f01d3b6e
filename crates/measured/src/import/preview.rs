//! What was taken for what in a file.

use super::sheet::Sheet;

/// Columns that are listed one by one; a wider table is a matrix.
const MOST_COLUMNS: usize = 32;
/// Lines of the header that are shown, and characters of each.
const SHOWN: [usize; 2] = [20, 200];

/// How a file was read.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Preview {
    /// The encoding, by its name in the standard of the web.
    pub encoding: &'static str,
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
    /// Every how manyth row, and column of a matrix, was kept.
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
    /// The symbol of its unit, if it was used.
    pub unit: Option<&'static str>,
    /// Whether neither the file nor a hint names that unit.
    pub is_assumed: bool,
}

impl Preview {
    /// That of a table in which nothing was used yet.
    pub(super) fn of(sheet: &Sheet, encoding: &'static str) -> Preview {
        let columns = if sheet.width() > MOST_COLUMNS { 0 } else { sheet.width() };
        Preview {
            encoding,
            separator: sheet.separator,
            has_decimal_commas: sheet.has_decimal_commas,
            rows: sheet.lines.len(),
            header: sheet.header.iter().take(SHOWN[0]).map(|line| line.chars().take(SHOWN[1]).collect()).collect(),
            columns: (0..columns)
                .map(|column| ColumnUse { name: sheet.name(column), ..ColumnUse::default() })
                .collect(),
            thinned: 1,
            reading: vec![format!("{encoding}, {}.", sheet.format())],
        }
    }

    /// Notes what a column was taken for.
    pub(super) fn take(&mut self, column: usize, quantity: &'static str, unit: &'static str, is_assumed: bool) {
        if let Some(used) = self.columns.get_mut(column) {
            (used.quantity, used.unit, used.is_assumed) = (Some(quantity), Some(unit), is_assumed);
        }
    }
}
