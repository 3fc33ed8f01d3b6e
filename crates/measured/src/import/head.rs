//! The head of a table: which of its lines name the columns, which their units, and which are remarks.

use std::ops::Range;

use super::error::ImportError;
use super::label::{Label, Mention};
use super::lines::Separator;
use super::names::{Axis, Meaning, axis, meaning};
use super::number::unquoted;
use super::sheet::{LineKind, Sheet};
use super::units::Unit;

/// Lines above the numbers that may name the columns.
const NAMING: usize = 100;
/// Columns of a list with names; wider tables are matrices.
const MOST_NAMED: usize = 1000;
/// Words before the names or units of the columns, in a cell of their own.
const UNIT_KEYS: [&str; 8] = ["unit", "units", "einheit", "einheiten", "unite", "unites", "unidades", "unita"];
const NAME_KEYS: [&str; 14] = [
    "columns",
    "column",
    "fancynames",
    "names",
    "name",
    "channels",
    "channel",
    "signals",
    "signal",
    "variables",
    "fields",
    "kanal",
    "kanaele",
    "bezeichnung",
];

/// What the lines above the rows say.
#[derive(Default)]
pub(super) struct Head {
    /// What is said of each column.
    pub(super) labels: Vec<Label>,
    /// The line that says its unit, for each column.
    pub(super) unit_lines: Vec<Option<usize>>,
    /// What lines of the head are, by their index.
    pub(super) kinds: Vec<(usize, LineKind)>,
    /// Units that were not used, because another one is there: their line, column and text.
    pub(super) unused_units: Vec<(usize, usize, String)>,
    /// Why the names of the columns are not known, if a line names other columns than there are.
    pub(super) misnamed: Option<ImportError>,
}

/// A line of as many cells as there are columns.
struct Row {
    line: usize,
    cells: Vec<String>,
    is_units: bool,
    named: usize,
    score: usize,
}

impl Row {
    fn of(line: usize, cells: Vec<String>) -> Row {
        let filled = || cells.iter().filter(|cell| !cell.is_empty());
        // One word above all columns names none of them.
        let is_one_word = filled().count() > 1 && filled().all(|cell| Some(cell) == filled().next());
        let named = if is_one_word { 0 } else { filled().filter(|cell| is_named(cell) && !is_unit(cell)).count() };
        let bracketed = |cell: &&String| {
            let Label { unit, name, .. } = Label::of(cell);
            matches!(unit, Mention::Known(..)) && !name.is_empty()
        };
        let is_units = filled().any(|cell| is_unit(cell))
            && filled()
                .all(|cell| is_unit(cell) || cell.chars().count() < 4 && !is_named(cell) || is_key(cell, &UNIT_KEYS));
        let score = 2 * named + filled().filter(bracketed).count();
        Row { line, is_units, named, score, cells }
    }
}

/// Reads the head of a sheet in these lines.
pub(super) fn read(sheet: &Sheet<'_>, lines: Range<usize>) -> Head {
    let width = sheet.width;
    let mut head = Head { labels: vec![Label::of(""); width], unit_lines: vec![None; width], ..Head::default() };
    if width > MOST_NAMED {
        return head;
    }
    let first = lines.end;
    let mut rows: Vec<Row> = lines
        .rev()
        .filter(|line| !sheet.table.cells(*line).iter().any(|cell| cell.is_number()))
        .take(NAMING)
        .filter_map(|line| Some(Row::of(line, cells(sheet, line)?)))
        .collect();
    if let Some(row) = shifted(sheet, first, &rows) {
        rows.insert(0, row);
    }
    // A line of single letters alone names the columns.
    let is_short = |row: &Row| row.cells.iter().all(|cell| cell.chars().count() < 2);
    if rows.len() == 1 && rows[0].is_units && is_short(&rows[0]) {
        rows[0].is_units = false;
    }
    let beside_units = |row: &Row| rows.iter().any(|other| other.is_units && other.line.abs_diff(row.line) == 1);
    let best = rows
        .iter()
        .filter(|row| !row.is_units && row.named > 0)
        .map(|row| row.score + usize::from(beside_units(row)))
        .max();
    let is_best = |row: &&Row| row.named > 0 && Some(row.score + usize::from(beside_units(row))) == best;
    // Of lines without any known name the lowest.
    let names = rows.iter().filter(|row| !row.is_units).find(is_best);
    let names = names.or_else(|| rows.iter().find(|row| !row.is_units));
    let is_near = |row: &Row| names.is_none_or(|names| row.line.abs_diff(names.line) <= 4) || first - row.line <= 4;
    for column in 0..width {
        let above: Vec<&Row> = rows.iter().filter(|row| !row.is_units && row.named > 0 && is_near(row)).collect();
        let own = names.map_or("", |names| names.cells[column].as_str());
        let other = || above.iter().map(|row| row.cells[column].as_str()).find(|cell| is_named(cell) && !is_unit(cell));
        let is_bare = own.is_empty() || is_unit(own) && other().is_some();
        let name = if is_bare { other().unwrap_or(own) } else { own };
        let mut label = Label::of(name);
        let line = names.map(|names| sheet.table.number(names.line)).filter(|_| label.unit != Mention::Absent);
        head.unit_lines[column] = line;
        for row in rows.iter().filter(|row| is_near(row)) {
            let cell = row.cells[column].as_str();
            if cell.is_empty() || cell == name || !(row.is_units || is_unit(cell)) || is_key(cell, &UNIT_KEYS) {
                continue;
            }
            let said = Label::of_unit(cell);
            let number = sheet.table.number(row.line);
            match (&label.unit, &said) {
                (Mention::Absent, _) => (label.unit, head.unit_lines[column]) = (said, Some(number)),
                (Mention::Known(one, _), Mention::Known(other, _)) if one == other => {}
                (_, Mention::Known(..)) => head.unused_units.push((number, column, cell.to_owned())),
                _ => {}
            }
        }
        head.labels[column] = label;
    }
    for row in &rows {
        let is_used =
            |column: &usize| !row.cells[*column].is_empty() && head.labels[*column].text == row.cells[*column];
        let kind = match names {
            _ if row.is_units => LineKind::Units,
            Some(names) if names.line == row.line => LineKind::Names,
            _ if row.named > 0 && is_near(row) && (0..width).any(|column| is_used(&column)) => LineKind::Names,
            _ if is_near(row) => LineKind::Remark,
            _ => LineKind::Preamble,
        };
        head.kinds.push((row.line, kind));
    }
    if names.is_none() && !rows.iter().any(|row| row.is_units) {
        head.misnamed = other_names(sheet, first);
    }
    head
}

/// The cells of a line, if it has as many as there are columns: in the way of the rows, or in another, perhaps with a
/// key before them.
pub(super) fn cells(sheet: &Sheet<'_>, line: usize) -> Option<Vec<String>> {
    let text = sheet.table.line(line);
    let own = sheet.table.separator;
    let mut cells = Vec::new();
    for separator in std::iter::once(own).chain(Separator::usual().filter(|other| *other != own)) {
        separator.split(text, &mut cells);
        let mut names: Vec<String> = cells.iter().map(|cell| unquoted(cell).to_owned()).collect();
        if separator == Separator::WhiteSpace {
            names = with_units(names);
        }
        let is_keyed = |name: &String| name.ends_with(':') || is_key(name, &UNIT_KEYS) || is_key(name, &NAME_KEYS);
        if names.len() == sheet.width + 1 && names.first().is_some_and(is_keyed) {
            names.remove(0);
        }
        while names.len() > sheet.width && names.last().is_some_and(|last| is_remark_name(last)) {
            names.pop();
        }
        if names.len() == sheet.width && names.iter().any(|name| !name.is_empty()) {
            return Some(names);
        }
    }
    None
}

/// Names one fewer than the columns, where the first column counts the rows: R writes none above it.
fn shifted(sheet: &Sheet<'_>, first: usize, rows: &[Row]) -> Option<Row> {
    let line = first.checked_sub(1).filter(|line| rows.iter().all(|row| row.line != *line))?;
    let names: Vec<String> = sheet.table.split(line).iter().map(|cell| unquoted(cell).to_owned()).collect();
    let quoted = (0..sheet.len().min(20)).all(|row| sheet.table.text(sheet.row(row), 0).parse() == Ok(row + 1));
    let is_count = sheet.width > 2 && names.len() + 1 == sheet.width && quoted;
    let row = Row::of(line, std::iter::once(String::new()).chain(names).collect());
    Some(row).filter(|row| is_count && row.named > 0)
}

/// The fault of a line right above the numbers that names other columns than there are.
fn other_names(sheet: &Sheet<'_>, first: usize) -> Option<ImportError> {
    let line = first.checked_sub(1)?;
    let mut cells = Vec::new();
    Separator::usual().find_map(|separator| {
        separator.split(sheet.table.line(line), &mut cells);
        let names: Vec<String> = cells.iter().map(|cell| (*cell).to_owned()).collect();
        let names = if separator == Separator::WhiteSpace { with_units(names) } else { names };
        let named = names.iter().filter(|name| is_named(name)).count();
        let fault = format!(
            "names {} columns, but the rows have {}: name the columns by number in `mapping`",
            names.len(),
            sheet.width
        );
        let number = sheet.table.number(line);
        (named > 1 && names.len() != sheet.width).then(|| ImportError::at_line(number, fault))
    })
}

fn is_key(cell: &str, keys: &[&str]) -> bool {
    let plain: String = cell.chars().filter(|letter| letter.is_alphabetic()).collect::<String>().to_lowercase();
    keys.contains(&plain.replace('é', "e").replace('à', "a").as_str())
}

/// Whether a column of this name holds remarks, and may be absent in the rows.
fn is_remark_name(name: &str) -> bool {
    let name = name.to_lowercase();
    name.is_empty() || ["comment", "kommentar", "remark", "bemerkung", "note"].iter().any(|word| name.starts_with(word))
}

/// Whether a cell is a unit and nothing else.
pub(super) fn is_unit(cell: &str) -> bool {
    // `x / um` is a name with its unit, and no power of ten.
    let lower = cell.trim().to_lowercase();
    if lower.contains(" / ") || lower.starts_with("x/") || lower == "x" {
        return false;
    }
    matches!(Label::of_unit(cell), Mention::Known(..)) && cell.chars().any(|letter| !letter.is_ascii_digit()) || {
        let inner = cell.trim().trim_matches(['[', ']', '(', ')']);
        !inner.is_empty() && inner.len() < cell.trim().len() && Unit::parse(inner).is_some()
    }
}

/// Whether a cell names a quantity of a scan or a loop.
pub(super) fn is_named(cell: &str) -> bool {
    let label = Label::of(cell);
    label.name.starts_with(char::is_alphabetic)
        && !label.name.contains(['=', ':'])
        && (!matches!(meaning(&label.name), Meaning::Unknown | Meaning::Other)
            || !matches!(axis(&label.name), Axis::Unknown | Axis::Left("not needed")))
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
