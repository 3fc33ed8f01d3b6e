//! A table of numbers in a text: its separator, its header, its rows.

use super::error::ImportError;
use super::label::{Label, Mention};
use super::lines::{Separator, lines};
use super::names::{Axis, Meaning, axis, meaning};
use super::number::{Evidence, Mark, is_missing, is_no_value, number, shape, unquoted};

/// Lines before the numbers; a text with more has none.
const MOST_HEADER: usize = 10_000;
/// Lines above the numbers that may name the columns.
const NAMING: usize = 100;
/// Lines that are looked at for the separator: the first, and others evenly over the text.
const SAMPLE: usize = 400;
/// Columns of a list with names; wider tables are matrices.
const MOST_NAMED: usize = 1000;
/// Why a single column is no scan and no loop.
const ONE_COLUMN: &str = "a single column: a scan has x and z or x, y and z, and a loop displacement and force";

/// A row: its line from 1 on, and its place in the text.
#[derive(Clone, Copy)]
struct Row {
    line: u32,
    start: u32,
    end: u32,
}

/// A table of numbers.
pub(super) struct Sheet<'a> {
    text: &'a str,
    /// The lines before the numbers with their numbers, without the marks of a comment.
    pub(super) header: Vec<(usize, &'a str)>,
    rows: Vec<Row>,
    /// How many columns there are.
    pub(super) width: usize,
    /// Whether a column holds texts, such as dates or remarks, and no numbers.
    pub(super) is_text: Vec<bool>,
    /// Lines with text that are no rows: headers and remarks.
    pub(super) left_out: Vec<usize>,
    /// What separates the columns.
    pub(super) separator: Separator,
    /// The line that names the columns, and what it says of each.
    names_line: Option<usize>,
    pub(super) labels: Vec<Label>,
    /// The line that names the units of the columns apart from their names.
    units_line: Option<usize>,
    /// Why the names of the columns are not known, if a line names other columns than there are.
    misnamed: Option<ImportError>,
}

/// The numbers of some columns, and whether they have decimal commas.
pub(super) struct Numbers {
    /// Column by column; `None` is a missing number.
    pub(super) columns: Vec<Vec<Option<f64>>>,
    pub(super) has_decimal_commas: bool,
    /// Rows without a number in any of them because they hold other texts.
    pub(super) remarks: Vec<usize>,
}

impl<'a> Sheet<'a> {
    /// The table in a text.
    pub(super) fn parse(text: &'a str) -> Result<Sheet<'a>, ImportError> {
        let all: Vec<Row> = rows_of(text)?;
        // What stands before a line with a number sign alone is the header of Zygo's export, whatever numbers it has.
        let is_zygo = text.trim_start_matches('\u{feff}').starts_with("Zygo");
        let marked = |row: &Row| is_zygo && line_of(text, *row).trim() == "#";
        let begin = all.iter().position(marked).map_or(0, |index| index + 1);
        let Some(found) = Dialect::of(text, &all[begin..]) else {
            return Err(no_table(text, &all));
        };
        let mut sheet = Sheet {
            text,
            header: Vec::new(),
            rows: Vec::new(),
            width: found.width,
            is_text: found.is_text,
            left_out: Vec::new(),
            separator: found.separator,
            names_line: None,
            labels: Vec::new(),
            units_line: None,
            misnamed: None,
        };
        let mut spoilt = Vec::new();
        let mut cells = Vec::new();
        let mut widest = 0;
        for (index, row) in all.iter().enumerate() {
            let line = line_of(text, *row);
            if line.trim().is_empty() {
                continue;
            }
            let is_comment = is_comment(line);
            sheet.separator.split(line, &mut cells);
            let kind = if is_comment || index < begin { RowKind::Text } else { sheet.kind(&cells) };
            let number = row.line as usize;
            match kind {
                RowKind::Numbers => {
                    sheet.check_width(number, &cells)?;
                    widest = widest.max(cells.iter().rposition(|cell| !cell.is_empty()).map_or(0, |last| last + 1));
                    sheet.rows.push(*row);
                }
                RowKind::Missing if !sheet.rows.is_empty() => sheet.rows.push(*row),
                RowKind::Spoilt(_) if !sheet.rows.is_empty() => {
                    sheet.check_width(number, &cells)?;
                    sheet.rows.push(*row);
                }
                _ if sheet.rows.is_empty() => {
                    if let RowKind::Spoilt(column) = kind {
                        spoilt.push((number, column, cells.len(), cells.get(column).copied().unwrap_or("").to_owned()));
                    }
                    if sheet.header.len() == MOST_HEADER {
                        break;
                    }
                    sheet.left_out.push(number);
                    sheet.header.push((number, line.trim_start_matches(['#', '%']).trim()));
                }
                _ => sheet.left_out.push(number),
            }
        }
        if sheet.rows.is_empty() {
            return Err(no_table(text, &all));
        }
        // A separator at the end of each line is no column.
        sheet.width = widest.min(sheet.width).max(1);
        sheet.is_text.truncate(sheet.width);
        if sheet.width < 2 {
            return Err(ImportError::of_file(ONE_COLUMN));
        }
        sheet.name_columns();
        sheet.check_header(&spoilt)?;
        Ok(sheet)
    }

    /// What a line is.
    fn kind(&self, cells: &[&str]) -> RowKind {
        let (mut numbers, mut missing, mut first_text) = (0, 0, None);
        for (column, cell) in cells.iter().enumerate() {
            let is_text_column = self.is_text.get(column).copied().unwrap_or(false);
            if shape(cell).is_some() {
                numbers += usize::from(!is_text_column);
            } else if is_missing(cell) {
                missing += 1;
            } else if !is_text_column && column < self.width {
                first_text = first_text.or(Some(column));
            }
        }
        match (numbers, first_text) {
            (0, Some(_)) => RowKind::Text,
            (0, None) if missing > 0 => RowKind::Missing,
            (0, None) => RowKind::Text,
            // Before the numbers, a number alone is a count or a size.
            (1, None) if cells.len() == 1 && self.width > 1 => {
                if self.rows.is_empty() {
                    RowKind::Text
                } else {
                    RowKind::Numbers
                }
            }
            (_, None) => RowKind::Numbers,
            (_, Some(column)) => RowKind::Spoilt(column),
        }
    }

    fn check_width(&self, line: usize, cells: &[&str]) -> Result<(), ImportError> {
        let surplus = cells.get(self.width..).unwrap_or(&[]);
        // Remarks behind the last column, and last columns of text that are left out.
        let lacking = self.is_text.get(cells.len()..).unwrap_or(&[]);
        if surplus.iter().all(|cell| shape(cell).is_none()) && lacking.iter().all(|is_text| *is_text) {
            return Ok(());
        }
        let others = if self.rows.is_empty() { "most rows have" } else { "the first" };
        Err(ImportError::at_line(line, format!("has {}, and {others} {}", columns(cells.len()), self.width)))
    }

    /// Refuses a line above the numbers that looks like a row of them.
    fn check_header(&self, spoilt: &[(usize, usize, usize, String)]) -> Result<(), ImportError> {
        for (line, column, cells, text) in spoilt {
            // Above the names stand keys with numbers, as in `Samples;41`.
            let has_digits = text.contains(|letter: char| letter.is_ascii_digit());
            let is_above = self.names_line.map_or(!has_digits, |names| *line < names);
            let is_key = *column == 0 && text.starts_with(char::is_alphabetic) && is_above;
            if is_key || *cells < 2 {
                continue;
            }
            return Err(not_a_number(*line, *column, text));
        }
        Ok(())
    }

    /// Finds the lines of the header that name the columns and their units.
    fn name_columns(&mut self) {
        self.labels = (0..self.width).map(|_| Label::of("")).collect();
        if self.width > MOST_NAMED {
            return;
        }
        let mut lines = self.header.iter().rev().take(NAMING).filter_map(|(line, text)| {
            let cells = self.cells_of_names(text)?;
            Some((*line, cells))
        });
        let is_units = |cells: &[String]| {
            let mentions: Vec<Mention> =
                cells.iter().filter(|cell| !cell.is_empty()).map(|cell| Label::of_unit(cell)).collect();
            mentions.iter().any(|one| matches!(one, Mention::Known(..)))
                && mentions
                    .iter()
                    .zip(cells.iter().filter(|cell| !cell.is_empty()))
                    .all(|(one, cell)| matches!(one, Mention::Known(..)) || cell.chars().count() < 4 && !is_named(cell))
        };
        let mut first = lines.next();
        let mut units = None;
        if let Some((line, cells)) = first.take_if(|(_, cells)| is_units(cells)) {
            let above = lines.next();
            // A line of single letters alone names the columns.
            if above.is_none() && cells.iter().all(|cell| cell.chars().count() < 2) {
                first = Some((line, cells));
            } else {
                (first, units) = (above, Some((line, cells)));
            }
        }
        let mut names = first;
        if names.as_ref().is_some_and(|(_, cells)| !cells.iter().any(|cell| is_named(cell))) {
            // Types, sources or remarks below the names; and prose above them.
            names = lines.find(|(_, cells)| cells.iter().filter(|cell| is_named(cell)).count() > 1).or(names);
        }
        drop(lines);
        if let Some((line, cells)) = names {
            self.names_line = Some(line);
            self.labels = cells.iter().take(self.width).map(|cell| Label::of(cell)).collect();
        } else if units.is_none() {
            self.misnamed = self.other_names();
        }
        if let Some((line, cells)) = units {
            self.units_line = Some(line);
            for (label, cell) in self.labels.iter_mut().zip(cells) {
                if label.unit == Mention::Absent {
                    label.unit = Label::of_unit(&cell);
                }
            }
        }
    }

    /// The cells of a line of the header, if it has as many as there are columns: in the way of the rows, or in
    /// another.
    fn cells_of_names(&self, text: &str) -> Option<Vec<String>> {
        let others = Separator::ALL.into_iter().filter(|other| *other != self.separator);
        let mut cells = Vec::new();
        for separator in std::iter::once(self.separator).chain(others) {
            separator.split(text, &mut cells);
            let mut names: Vec<String> = cells.iter().map(|cell| unquoted(cell).to_owned()).collect();
            if separator == Separator::WhiteSpace {
                names = with_units(names);
            }
            while names.len() > self.width && names.last().is_some_and(|last| is_remark_name(last)) {
                names.pop();
            }
            if names.len() == self.width && names.iter().any(|name| !name.is_empty()) {
                return Some(names);
            }
        }
        None
    }

    /// The fault of a line right above the numbers that names other columns than there are.
    fn other_names(&self) -> Option<ImportError> {
        let (line, text) = self.header.last()?;
        let mut cells = Vec::new();
        Separator::ALL.into_iter().find_map(|separator| {
            separator.split(text, &mut cells);
            let names = if separator == Separator::WhiteSpace {
                with_units(cells.iter().map(|cell| (*cell).to_owned()).collect())
            } else {
                cells.iter().map(|cell| (*cell).to_owned()).collect()
            };
            let named = names.iter().filter(|name| is_named(name)).count();
            let fault = format!("names {} columns, but the rows have {}", names.len(), self.width);
            (named > 1 && names.len() != self.width).then(|| ImportError::at_line(*line, fault))
        })
    }

    /// Refuses a header that names other columns than there are.
    pub(super) fn check_names(&self) -> Result<(), ImportError> {
        self.misnamed.clone().map_or(Ok(()), Err)
    }

    /// How many rows there are.
    pub(super) fn len(&self) -> usize {
        self.rows.len()
    }

    /// The line of each row.
    pub(super) fn line(&self, row: usize) -> usize {
        self.rows[row].line as usize
    }

    /// The line that names a column, or its unit.
    pub(super) fn line_of_unit(&self, column: usize) -> Option<usize> {
        let is_apart =
            self.units_line.is_some() && matches!(Label::of(&self.labels[column].text).unit, Mention::Absent);
        if is_apart { self.units_line } else { self.names_line }
    }

    /// The name of a column, if it has one.
    pub(super) fn name(&self, column: usize) -> Option<&str> {
        self.labels.get(column).map(|label| label.text.as_str()).filter(|text| !text.is_empty())
    }

    /// Whether any column has a name.
    pub(super) fn has_names(&self) -> bool {
        self.labels.iter().any(|label| !label.text.is_empty())
    }

    /// The column in a sentence.
    pub(super) fn title(&self, column: usize) -> String {
        self.name(column).map_or_else(|| format!("column {}", column + 1), |name| format!("`{name}`"))
    }

    /// The index of a column by its number from 1 on, or by its name in the header, of which the beginning is enough.
    pub(super) fn find(&self, name: &str) -> Option<usize> {
        if let Ok(number) = name.parse::<usize>() {
            return number.checked_sub(1).filter(|index| *index < self.width);
        }
        let name = name.to_lowercase();
        let names: Vec<String> = self.labels.iter().map(|label| label.text.to_lowercase()).collect();
        let equal = names.iter().position(|one| *one == name);
        let bare = || self.labels.iter().position(|label| label.name.to_lowercase() == name);
        equal.or_else(bare).or_else(|| names.iter().position(|one| one.starts_with(&name)))
    }

    /// The texts of a column, with the index of each row.
    pub(super) fn texts(&self, column: usize) -> impl Iterator<Item = &'a str> {
        let mut cells = Vec::new();
        self.rows.iter().map(move |row| {
            self.separator.split(line_of(self.text, *row), &mut cells);
            cells.get(column).map_or("", |cell| unquoted(cell))
        })
    }

    /// The numbers of some columns.
    ///
    /// # Errors
    /// [`ImportError`] at a cell that is no number, or a number that can be read in two ways.
    pub(super) fn numbers(&self, columns: &[usize]) -> Result<Numbers, ImportError> {
        let mut cells = Vec::new();
        let mut evidence = vec![Evidence::default(); columns.len()];
        for (row, place) in self.rows.iter().enumerate() {
            self.separator.split(line_of(self.text, *place), &mut cells);
            for (evidence, column) in evidence.iter_mut().zip(columns) {
                evidence.add(row, cells.get(*column).copied().unwrap_or(""));
            }
        }
        let has = |mark: Mark| evidence.iter().any(|one| one.has_decimal(mark));
        let others = match (has(Mark::Point), has(Mark::Comma)) {
            (true, false) => Some(Mark::Point),
            (false, true) => Some(Mark::Comma),
            _ => None,
        };
        let mut marks = Vec::new();
        for (evidence, column) in evidence.iter().zip(columns) {
            marks.push(evidence.mark(others).map_err(|row| self.ambiguous(row, *column))?);
        }
        let mut found = Numbers {
            columns: columns.iter().map(|_| Vec::with_capacity(self.rows.len())).collect(),
            has_decimal_commas: marks.iter().zip(&evidence).any(|(mark, one)| *mark == Mark::Comma && !one.is_empty()),
            remarks: Vec::new(),
        };
        for (index, place) in self.rows.iter().enumerate() {
            self.separator.split(line_of(self.text, *place), &mut cells);
            let mut fault = None;
            let mut numbers = 0;
            for ((values, column), mark) in found.columns.iter_mut().zip(columns).zip(&marks) {
                let cell = cells.get(*column).copied().unwrap_or("");
                let value = number(cell, *mark);
                numbers += usize::from(value.is_some());
                if value.is_none() && !is_missing(cell) {
                    fault = fault.or(Some((*column, cell)));
                }
                values.push(value.filter(|value| !is_no_value(*value)));
            }
            match fault {
                Some((column, cell)) if numbers > 0 || columns.len() == 1 => {
                    return Err(not_a_number(self.line(index), column, cell));
                }
                Some(_) => {
                    found.columns.iter_mut().for_each(|values| *values.last_mut().expect("just added") = None);
                    found.remarks.push(self.line(index));
                }
                None => {}
            }
        }
        Ok(found)
    }

    fn ambiguous(&self, row: usize, column: usize) -> ImportError {
        let cell = self.texts(column).nth(row).unwrap_or("");
        let fault = format!(
            "the mark in `{cell:.40}` may separate thousands or decimals: write the numbers without separators of \
             thousands"
        );
        ImportError::at(self.line(row), column + 1, fault)
    }
}

enum RowKind {
    Numbers,
    /// Marks of missing numbers alone.
    Missing,
    /// Numbers with a text in this column, which has numbers elsewhere.
    Spoilt(usize),
    Text,
}

/// How a text is written.
struct Dialect {
    separator: Separator,
    width: usize,
    is_text: Vec<bool>,
}

impl Dialect {
    /// The separator and the number of columns with which most lines are rows of numbers.
    fn of(text: &str, all: &[Row]) -> Option<Dialect> {
        let stride = all.len().div_ceil(SAMPLE).max(1);
        let chosen = |index: usize| index < SAMPLE || index.is_multiple_of(stride) || index + 3 > all.len();
        let sample: Vec<&str> = all
            .iter()
            .enumerate()
            .filter(|(index, _)| chosen(*index))
            .map(|(_, row)| line_of(text, *row))
            .filter(|line| !line.trim().is_empty() && !is_comment(line))
            .collect();
        let mut best: Option<(i64, Separator, usize)> = None;
        let mut cells = Vec::new();
        for separator in Separator::ALL {
            // Of each width the number of lines and their score: the width of most lines is that of the rows.
            let mut widths: Vec<(usize, usize, i64)> = Vec::new();
            for line in &sample {
                separator.split(line, &mut cells);
                let numbers = cells.iter().filter(|cell| shape(cell).is_some()).count() as i64;
                let texts = cells.iter().filter(|cell| shape(cell).is_none() && !is_missing(cell)).count() as i64;
                let score = 2 * numbers - texts;
                if numbers < 2 || score < 1 {
                    continue;
                }
                match widths.iter_mut().find(|(width, ..)| *width == cells.len()) {
                    Some((_, lines, sum)) => (*lines, *sum) = (*lines + 1, *sum + score),
                    None => widths.push((cells.len(), 1, score)),
                }
            }
            let most = widths.iter().map(|(_, lines, _)| *lines).max();
            // White space also parts what other separators do, and words of the header besides.
            let least = |score: i64| if separator == Separator::WhiteSpace { score + score / 10 } else { score };
            if let Some((width, _, score)) = widths.iter().find(|(_, lines, _)| Some(*lines) == most)
                && best.is_none_or(|(most, ..)| *score > least(most))
            {
                best = Some((*score, separator, *width));
            }
        }
        let (_, separator, width) = best?;
        let mut counts = vec![(0_usize, 0_usize); width];
        for line in &sample {
            separator.split(line, &mut cells);
            if cells.len() != width || cells.iter().filter(|cell| shape(cell).is_some()).count() < 2 {
                continue;
            }
            for ((numbers, texts), cell) in counts.iter_mut().zip(&cells) {
                *numbers += usize::from(shape(cell).is_some());
                *texts += usize::from(shape(cell).is_none() && !is_missing(cell));
            }
        }
        let is_text = counts.into_iter().map(|(numbers, texts)| texts > numbers).collect();
        Some(Dialect { separator, width, is_text })
    }
}

fn rows_of(text: &str) -> Result<Vec<Row>, ImportError> {
    let too_long = |_| ImportError::of_file("the file is too long: more than 4 GiB of text");
    u32::try_from(text.len()).map_err(too_long)?;
    let place = |line: &str| line.as_ptr() as usize - text.as_ptr() as usize;
    let row = |(number, line): (usize, &str)| {
        let start = place(line);
        Row { line: number as u32, start: start as u32, end: (start + line.len()) as u32 }
    };
    Ok(lines(text).map(row).collect())
}

fn line_of(text: &str, row: Row) -> &str {
    text[row.start as usize..row.end as usize].trim_matches([' ', '\u{feff}'])
}

/// Whether a line is a comment; errors of spreadsheets, such as `#N/A`, begin with the same sign.
fn is_comment(line: &str) -> bool {
    let first = line.split([';', '\t', ',', ' ']).next().unwrap_or("");
    line.starts_with(['#', '%']) && !(first.len() > 1 && is_missing(first))
}

/// Whether a column of this name holds remarks, and may be absent in the rows.
fn is_remark_name(name: &str) -> bool {
    let name = name.to_lowercase();
    name.is_empty() || ["comment", "kommentar", "remark", "bemerkung", "note"].iter().any(|word| name.starts_with(word))
}

/// Whether a cell names a quantity of a scan or a loop.
fn is_named(cell: &str) -> bool {
    let label = Label::of(cell);
    label.name.starts_with(char::is_alphabetic)
        && !label.name.contains(['=', ':'])
        && (!matches!(meaning(&label.name), Meaning::Unknown | Meaning::Other)
            || !matches!(axis(&label.name), Axis::Unknown))
}

/// The words of a line of names; a unit in brackets belongs to the word before it.
fn with_units(words: Vec<String>) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for word in words {
        let is_open = names.last().is_some_and(|name| {
            name.matches(['[', '(']).count() > name.matches([']', ')']).count() || name.ends_with('/')
        });
        match names.last_mut() {
            Some(name) if is_open || word.starts_with(['[', '(', '/']) => *name = format!("{name} {word}"),
            _ => names.push(word),
        }
    }
    names
}

fn not_a_number(line: usize, column: usize, cell: &str) -> ImportError {
    ImportError::at(line, column + 1, format!("`{:.40}` is not a number", unquoted(cell)))
}

/// Why a text has no table: at the first line that begins with a number.
fn no_table(text: &str, all: &[Row]) -> ImportError {
    let mut cells = Vec::new();
    let mut has_column = false;
    for row in all.iter().take(MOST_HEADER) {
        let line = line_of(text, *row);
        for separator in Separator::ALL {
            separator.split(line, &mut cells);
            if cells.len() > 1 && shape(cells[0]).is_some() && !is_comment(line) {
                let fault = cells.iter().position(|cell| shape(cell).is_none() && !is_missing(cell));
                if let Some(column) = fault {
                    return not_a_number(row.line as usize, column, cells[column]);
                }
            }
        }
        has_column |= shape(line).is_some();
    }
    ImportError::of_file(if has_column { ONE_COLUMN } else { "no rows of numbers were found" })
}

/// A number of columns in words.
pub(super) fn columns(count: usize) -> String {
    if count == 1 { "1 column".to_owned() } else { format!("{count} columns") }
}
