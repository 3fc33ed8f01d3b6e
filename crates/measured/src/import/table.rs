//! The lines of a text and their cells, read once: numbers as numbers, and texts as their places.

use super::clock;
use super::error::ImportError;
use super::lines::{Separator, lines, may_separate};
use super::mapping::amount;
use super::number::{Kind, Mark, kind, number, unquoted};

/// Cells of a file; a matrix of 4096 x 4096 has no more.
const MOST_CELLS: usize = 1 << 24;
/// Lines between two questions whether to go on, and cells.
const BETWEEN: [usize; 2] = [256, 65_536];
/// Lines that are looked at for the separator: the first, and others evenly over the text.
const SAMPLE: usize = 400;
/// Of them, lines that may name the columns.
const MOST_NAMES: usize = 100;

/// A number, or a place in the text, in eight bytes: what is no number is a NaN with its place in it.
#[derive(Clone, Copy)]
pub(super) struct Cell(u64);

/// Bits of a NaN, and what the place in it is of.
const NAN: u64 = 0x7ff8 << 48;
const SIGN: u64 = 1 << 63;
const PLACED: u64 = 1 << 50;
/// Bits of the length of a text.
const LENGTH: u32 = 18;

/// What a cell is, in a word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Sort {
    Missing,
    Number,
    Either,
    Amount,
    Text,
}

impl Cell {
    const MISSING: Cell = Cell(NAN);

    fn new(text: &str, cell: &str, keeps_blanks: bool) -> Cell {
        let tag = match kind(cell, keeps_blanks) {
            Kind::Missing => return Cell::MISSING,
            Kind::Number(value) => return Cell(value.to_bits()),
            Kind::Text => NAN | PLACED,
            Kind::Either => NAN | SIGN,
            Kind::Amount => NAN | SIGN | PLACED,
        };
        let start = cell.as_ptr() as u64 - text.as_ptr() as u64;
        Cell(tag | start << LENGTH | (cell.len() as u64).min((1 << LENGTH) - 1))
    }

    pub(super) fn sort(self) -> Sort {
        match (f64::from_bits(self.0).is_nan(), self.0 & SIGN != 0, self.0 & PLACED != 0) {
            (false, ..) => Sort::Number,
            (true, false, false) => Sort::Missing,
            (true, true, false) => Sort::Either,
            (true, true, true) => Sort::Amount,
            (true, false, true) => Sort::Text,
        }
    }

    /// Whether it is a number, with or without a unit.
    pub(super) fn is_number(self) -> bool {
        matches!(self.sort(), Sort::Number | Sort::Either | Sort::Amount)
    }

    pub(super) fn is_zero(self) -> bool {
        f64::from_bits(self.0) == 0.0
    }

    fn place(self) -> std::ops::Range<usize> {
        let start = (self.0 & (PLACED - 1)) >> LENGTH;
        start as usize..(start + (self.0 & ((1 << LENGTH) - 1))) as usize
    }
}

/// A line with text: its number from 1 on, where it begins, and its first cell.
#[derive(Clone, Copy)]
struct Line {
    number: u32,
    start: u32,
    cell: u32,
}

/// A text as lines of cells.
pub(super) struct Table<'a> {
    text: &'a str,
    pub(super) separator: Separator,
    decimal: Option<Mark>,
    lines: Vec<Line>,
    cells: Vec<Cell>,
    /// Blank lines, and the first of them.
    pub(super) blank: (usize, usize),
    is_comment: Vec<bool>,
}

impl<'a> Table<'a> {
    /// Reads a text.
    ///
    /// # Errors
    /// [`ImportError`] if it has more cells than a file may have, or if `proceed` says no.
    pub(super) fn read(
        text: &'a str,
        separator: Separator,
        decimal: Option<Mark>,
        proceed: &dyn Fn() -> bool,
    ) -> Result<Table<'a>, ImportError> {
        let mut table = Table {
            text,
            separator,
            decimal,
            lines: Vec::new(),
            cells: Vec::with_capacity(separator.count(text).min(MOST_CELLS)),
            blank: (0, 0),
            is_comment: Vec::new(),
        };
        let (mut cells, mut asked) = (Vec::new(), 0);
        for (index, (number, line)) in lines(text).enumerate() {
            if index.is_multiple_of(BETWEEN[0]) || table.cells.len() > asked + BETWEEN[1] {
                asked = table.cells.len();
                proceed().then_some(()).ok_or_else(ImportError::stopped)?;
            }
            let start = (line.as_ptr() as usize - text.as_ptr() as usize) as u32;
            let line = line.trim_matches([' ', '\u{feff}']);
            if line.trim().is_empty() {
                table.blank = (table.blank.0 + 1, if table.blank.0 == 0 { number } else { table.blank.1 });
                continue;
            }
            table.lines.push(Line { number: number as u32, start, cell: table.cells.len() as u32 });
            table.is_comment.push(is_comment(line));
            separator.split(line, &mut cells);
            if table.cells.len() + cells.len() > MOST_CELLS {
                let fault = format!(
                    "has the {MOST_CELLS} cells (columns x rows) behind it that a file may have: leave out columns or \
                     rows"
                );
                return Err(ImportError::at_line(number, fault));
            }
            let keeps_blanks = separator != Separator::WhiteSpace;
            table.cells.extend(cells.iter().map(|cell| Cell::new(text, cell, keeps_blanks)));
        }
        Ok(table)
    }

    /// How many lines with text there are.
    pub(super) fn len(&self) -> usize {
        self.lines.len()
    }

    /// The number of a line, from 1 on.
    pub(super) fn number(&self, line: usize) -> usize {
        self.lines[line].number as usize
    }

    /// Whether a line is a comment.
    pub(super) fn is_comment(&self, line: usize) -> bool {
        self.is_comment[line]
    }

    /// The text of a line, without the marks of a comment.
    pub(super) fn line(&self, line: usize) -> &'a str {
        let end = self.lines.get(line + 1).map_or(self.text.len(), |next| next.start as usize);
        let text = &self.text[self.lines[line].start as usize..end];
        text.trim_start_matches(['\u{feff}', ' '])
            .trim_start_matches(['#', '%'])
            .trim_matches([' ', '\r', '\n', '\u{1a}', '\0'])
    }

    /// The cells of a line.
    pub(super) fn cells(&self, line: usize) -> &[Cell] {
        let end = self.lines.get(line + 1).map_or(self.cells.len(), |next| next.cell as usize);
        &self.cells[self.lines[line].cell as usize..end]
    }

    /// A cell of a line; missing behind its last.
    pub(super) fn cell(&self, line: usize, column: usize) -> Cell {
        self.cells(line).get(column).copied().unwrap_or(Cell::MISSING)
    }

    /// The texts of a line, cell by cell.
    pub(super) fn split(&self, line: usize) -> Vec<&'a str> {
        let mut cells = Vec::new();
        self.separator.split(self.line_as_it_is(line), &mut cells);
        cells
    }

    fn line_as_it_is(&self, line: usize) -> &'a str {
        let end = self.lines.get(line + 1).map_or(self.text.len(), |next| next.start as usize);
        let text = &self.text[self.lines[line].start as usize..end];
        text.trim_matches([' ', '\u{feff}', '\r', '\n', '\u{1a}', '\0'])
    }

    /// The text of a cell, without its quotes; of a number that is not kept as text, that of its line.
    pub(super) fn text(&self, line: usize, column: usize) -> &'a str {
        let cell = self.cell(line, column);
        match cell.sort() {
            Sort::Either | Sort::Amount | Sort::Text => unquoted(&self.text[cell.place()]),
            Sort::Missing | Sort::Number => unquoted(self.split(line).get(column).copied().unwrap_or("")),
        }
    }

    /// The number of a cell, with its decimal mark where both are possible; a number with a unit is in SI.
    pub(super) fn value(&self, line: usize, column: usize, mark: Mark) -> Option<f64> {
        let cell = self.cell(line, column);
        match cell.sort() {
            Sort::Number => Some(f64::from_bits(cell.0)),
            Sort::Either => number(&self.text[cell.place()], self.decimal.unwrap_or(mark)),
            Sort::Amount => amount(unquoted(&self.text[cell.place()])).map(|(value, unit)| unit.to_si(value)),
            Sort::Missing | Sort::Text => None,
        }
    }

    /// The decimal mark that was asked for.
    pub(super) fn decimal(&self) -> Option<Mark> {
        self.decimal
    }
}

/// Whether a line is a comment; errors of spreadsheets, such as `#N/A`, begin with the same sign.
fn is_comment(line: &str) -> bool {
    let first = line.split([';', '\t', ',', ' ']).next().unwrap_or("");
    line.starts_with(['#', '%']) && !(first.len() > 1 && kind(first, false) == Kind::Missing)
}

/// The separator with which most lines are rows of numbers; none if no line is one.
pub(super) fn separator(text: &str) -> Option<Separator> {
    let total = text.bytes().filter(|byte| matches!(byte, b'\n' | b'\r')).count();
    let stride = total.div_ceil(SAMPLE).max(1);
    let sample: Vec<&str> = lines(text)
        .enumerate()
        .filter(|(index, _)| *index < SAMPLE || index.is_multiple_of(stride) || index + 3 > total)
        .map(|(_, (_, line))| line.trim_matches([' ', '\u{feff}']))
        .filter(|line| !line.trim().is_empty() && !is_comment(line))
        .collect();
    let mut best: Option<(i64, Separator)> = None;
    let mut whole: Vec<(usize, Separator)> = Vec::new();
    let mut cells = Vec::new();
    let mut stamps;
    for separator in Separator::all(&sample) {
        // Of each width the number of lines, of those with texts, and their score.
        let mut widths: Vec<(usize, [usize; 2], i64)> = Vec::new();
        stamps = 0;
        for line in &sample {
            separator.split(line, &mut cells);
            if cells.len() < 2 {
                continue;
            }
            let (mut numbers, mut texts, mut glued) = (0, 0, 0);
            for cell in &cells {
                match kind(cell, separator.keeps_blanks()) {
                    Kind::Number(_) | Kind::Either | Kind::Amount => numbers += 1,
                    Kind::Text if !clock::is_stamp(unquoted(cell)) => {
                        texts += 1;
                        glued += i64::from(is_glued(cell));
                    }
                    Kind::Text => stamps += 1,
                    Kind::Missing => {}
                }
            }
            let score = 2 * numbers - texts;
            if numbers < 2 || score < 1 || glued > 0 && 2 * glued >= numbers {
                continue;
            }
            match widths.iter_mut().find(|(width, ..)| *width == cells.len()) {
                Some((_, lines, sum)) => {
                    lines[0] += 1;
                    lines[1] += usize::from(texts > 0);
                    *sum += score;
                }
                None => widths.push((cells.len(), [1, usize::from(texts > 0)], score)),
            }
        }
        let all: usize = widths.iter().map(|(_, lines, _)| lines[0]).sum();
        let Some((width, lines, score)) = widths.iter().max_by_key(|(_, lines, _)| lines[0]) else { continue };
        // A sign that makes nearly all rows of one width and of numbers alone is no part of them.
        let is_whole = 4 * lines[1] <= lines[0] && 10 * lines[0] >= 9 * all;
        let is_usual = Separator::usual().any(|usual| usual == separator);
        if is_whole && 2 * lines[0] > sample.len().min(8) {
            if stamps == 0 && whole.is_empty() {
                return Some(separator);
            }
            whole.push((*width, separator));
        }
        // White space also parts what other separators do, and words of the header besides.
        let least = |score: i64| if separator == Separator::WhiteSpace { score + score / 10 } else { score };
        if is_usual && best.is_none_or(|(most, _)| *score > least(most)) {
            best = Some((*score, separator));
        }
    }
    // What looks like a time may be the end of a number and the beginning of the next: the line of names decides.
    let has_names = |(width, separator): &&(usize, Separator)| {
        sample.iter().take(MOST_NAMES).any(|line| {
            let mut cells = Vec::new();
            separator.split(line, &mut cells);
            cells.len() == *width && cells.iter().all(|cell| matches!(kind(cell, true), Kind::Text | Kind::Missing))
        })
    };
    let chosen = whole.iter().find(has_names).or(whole.first());
    chosen.map(|(_, separator)| *separator).or(best.map(|(_, separator)| separator))
}

/// Whether a text begins and ends with digits: numbers that another sign separates.
pub(super) fn is_glued(cell: &str) -> bool {
    let cell = unquoted(cell);
    let is_digit = |letter: Option<char>| letter.is_some_and(|letter| letter.is_ascii_digit());
    is_digit(cell.chars().next()) && is_digit(cell.chars().next_back()) && cell.contains(may_separate)
}

impl Separator {
    /// About as many cells as a text has, and at least so many.
    fn count(self, text: &str) -> usize {
        match self {
            Separator::Sign(sign) => text.matches([sign, '\n', '\r']).count() + 1,
            Separator::WhiteSpace => {
                let pairs = text.as_bytes().windows(2);
                pairs.filter(|pair| pair[0].is_ascii_whitespace() && !pair[1].is_ascii_whitespace()).count() + 1
            }
        }
    }
}
