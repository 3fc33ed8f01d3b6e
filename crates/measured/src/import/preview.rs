//! What was taken for what in a file.

use super::label::Mention;
use super::number::{Mark, unquoted};
use super::sheet::{LineKind, Sheet, columns};
use super::source::Source;
use super::units::Unit;

/// Columns that are listed one by one; a wider table is a matrix.
const MOST_COLUMNS: usize = 1000;
/// Lines of each kind that are shown cell by cell, their cells, and characters of each.
const OF_KIND: usize = 4;
const OF_CELL: [usize; 2] = [16, 40];
/// Lines that are listed as not used.
const MOST_UNUSED: usize = 100;
/// Lines of the header that are shown, and characters of each.
const SHOWN: [usize; 2] = [20, 200];

/// How a file was read.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Preview {
    /// The encoding, by its name in the standard of the web, or the kind of a spreadsheet.
    pub encoding: String,
    /// What separates the columns: `semicolon`, `tab`, `pipe`, `white_space`, `comma`, or another sign itself.
    pub separator: String,
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
    /// What each line is: kinds that there are, how many lines are of it, and the first.
    pub lines: Vec<(LineKind, usize, usize)>,
    /// What is in the file and not in what was read.
    pub unused: Vec<Unused>,
    /// What neither the file nor the client says, in sentences.
    pub assumed: Vec<String>,
    /// The mapping that repeats this reading without guessing anything.
    pub mapping: String,
    /// The first lines of each kind, cell by cell.
    pub table: Vec<ShownLine>,
}

/// A line of the file, cell by cell.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ShownLine {
    /// Its number, from 1 on.
    pub line: usize,
    /// What it is.
    pub kind: LineKind,
    /// Its cells, at the beginning.
    pub cells: Vec<String>,
}

/// A part of a file that is not in what was read.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Unused {
    /// Its line, from 1 on, if it is one.
    pub line: Option<usize>,
    /// Its column, from 1 on, if it is one.
    pub column: Option<usize>,
    /// What stands there, at the beginning.
    pub text: String,
    /// Why it is not used.
    pub reason: String,
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
    pub(super) fn of(sheet: &Sheet<'_>, source: &Source<'_>) -> Preview {
        let columns = if sheet.width > MOST_COLUMNS { 0 } else { sheet.width };
        let shown = |(_, line): &(usize, &str)| line.chars().take(SHOWN[1]).collect();
        Preview {
            encoding: source.encoding.clone(),
            separator: sheet.table.separator.name(),
            has_decimal_commas: false,
            rows: sheet.len(),
            header: sheet.header.iter().take(SHOWN[0]).map(shown).collect(),
            columns: (0..columns)
                .map(|column| ColumnUse { name: sheet.name(column).map(str::to_owned), ..ColumnUse::default() })
                .collect(),
            thinned: 1,
            ..Preview::default()
        }
    }

    /// Notes what each line is, and what of the file was not used; `entries` are the columns of the mapping.
    pub(super) fn account(&mut self, sheet: &Sheet<'_>, source: &Source<'_>, entries: Vec<String>) {
        let number = |line: usize| sheet.table.number(line);
        for kind in LineKind::ALL {
            let of_kind = |line: &usize| sheet.kinds[*line] == kind;
            let count = (0..sheet.kinds.len()).filter(of_kind).count();
            let first = (0..sheet.kinds.len()).find(of_kind).map(number);
            self.lines.extend(first.map(|first| (kind, count, first)));
        }
        let mut seen: Vec<(LineKind, usize)> = Vec::new();
        for (line, kind) in sheet.kinds.iter().enumerate() {
            let at = seen.iter().position(|(one, _)| one == kind).unwrap_or_else(|| {
                seen.push((*kind, 0));
                seen.len() - 1
            });
            seen[at].1 += 1;
            if seen[at].1 <= OF_KIND {
                let shown = |cell: &&str| unquoted(cell).chars().take(OF_CELL[1]).collect();
                let cells = sheet.table.split(line).iter().take(OF_CELL[0]).map(shown).collect();
                self.table.push(ShownLine { line: number(line), kind: *kind, cells });
            }
        }
        let (blank, first) = sheet.table.blank;
        self.lines.extend((blank > 0 && source.sheet.is_none()).then_some((LineKind::Blank, blank, first)));
        let left_out = |line: &usize| sheet.kinds[*line] != LineKind::Data;
        self.rows_left_out.extend((0..sheet.kinds.len()).filter(left_out).map(number));
        self.rows_left_out.sort_unstable();
        for (line, kind) in sheet.kinds.iter().enumerate() {
            if self.unused.len() == MOST_UNUSED {
                break;
            }
            let reason = match kind {
                LineKind::Remark => "a remark",
                LineKind::Figure => "a figure of many rows",
                LineKind::SecondTable => "a part of another table",
                LineKind::Zeros => "zeros at the end",
                _ => continue,
            };
            let text = sheet.table.line(line).chars().take(SHOWN[1]).collect();
            self.unused.push(Unused { line: Some(number(line)), column: None, text, reason: reason.to_owned() });
        }
        for (column, used) in self.columns.iter().enumerate().filter(|(_, used)| used.quantity.is_none()) {
            let (text, reason) = (used.name.clone().unwrap_or_default(), used.left_out.clone().unwrap_or_default());
            self.unused.push(Unused { line: None, column: Some(column + 1), text, reason });
        }
        for (kind, what) in
            [(LineKind::SecondTable, "another table, which is not read"), (LineKind::Figure, "figures of many rows")]
        {
            if let Some((_, count, first)) = self.lines.iter().find(|(one, ..)| *one == kind) {
                let lines = if *count == 1 { "1 line, at".to_owned() } else { format!("{count} lines, the first at") };
                self.reading.push(format!("{lines} line {first}: {what}."));
            }
        }
        let mark = if self.has_decimal_commas { "comma" } else { "point" };
        let last = sheet.len().checked_sub(1).map_or(0, |row| sheet.line(row));
        let mut entries = entries;
        entries.push(format!("first_line:{}", sheet.line(0)));
        entries.push(format!("last_line:{last}"));
        match &source.sheet {
            Some((_, number, count)) if *count > 1 => entries.push(format!("sheet:{number}")),
            Some(_) => {}
            None => entries.push(format!("separator:{}", self.separator)),
        }
        entries.push(format!("decimal:{mark}"));
        self.mapping = entries.join(";");
    }

    /// Notes rows of zeros at the end, which nobody measured.
    pub(super) fn say_zeros(&mut self, count: usize, first: usize) {
        if count > 0 {
            let what = format!(
                "{count} rows of zeros at the end, the first at line {first}, are an array that was not filled, and \
                 left out"
            );
            self.assumed.push(format!("{what}: `last_line` in `mapping` keeps them."));
            self.reading.push(format!("{what}."));
        }
    }

    /// Notes how the numbers are written, before all other sentences.
    pub(super) fn written(&mut self, sheet: &Sheet<'_>, mark: Mark) {
        let has_decimal_commas = mark == Mark::Comma;
        self.has_decimal_commas = has_decimal_commas;
        let mark = if has_decimal_commas { "decimal commas" } else { "decimal points" };
        let (width, separator) = (&sheet.width, sheet.table.separator);
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
