//! A table of numbers in a text: which lines are its rows, which its head, and what the others are.

use super::clock;
use super::error::{Candidate, ImportError};
use super::head::{self, Head};
use super::label::{Label, Mention};
use super::lines::{Separator, may_separate};
use super::mapping::Mapping;
use super::number::{Evidence, Mark, unquoted};
use super::table::{self, Sort, Table};
use super::units::Unit;

/// Lines before the numbers; a text with more has none.
const MOST_HEADER: usize = 10_000;
/// Rows that are looked at for the decimal mark where no number leaves it open.
const ENOUGH: usize = 1000;
/// Rows of zeros at the end that are an array which was not filled.
const FEWEST_ZEROS: usize = 2;
/// Why a single column is no scan and no loop.
const ONE_COLUMN: &str = "a single column: a scan has x and z or x, y and z, and a loop displacement and force";
/// Words that begin a line of figures below a table whose first column holds texts.
const FIGURES: &str = "mean average avg max maximum min minimum std stdev sd median sum total rms count mittelwert \
    mittel summe standardabweichung anzahl moyenne media variance range ra rz rq rsm";

/// What a line is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum LineKind {
    /// Above the table, and no part of its head.
    Preamble,
    /// Names of the columns.
    Names,
    /// Units of the columns.
    Units,
    /// A line of the head, or between rows, that is neither.
    Remark,
    /// A row.
    Data,
    /// A figure of many rows below them, such as their mean.
    Figure,
    /// A part of another table.
    SecondTable,
    /// A row of zeros at the end, which nobody measured.
    Zeros,
    /// A blank line.
    Blank,
}

impl LineKind {
    /// All of them.
    pub const ALL: [LineKind; 9] = [
        LineKind::Preamble,
        LineKind::Names,
        LineKind::Units,
        LineKind::Remark,
        LineKind::Data,
        LineKind::Figure,
        LineKind::SecondTable,
        LineKind::Zeros,
        LineKind::Blank,
    ];

    /// Its name in a reply.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            LineKind::Preamble => "preamble",
            LineKind::Names => "names",
            LineKind::Units => "units",
            LineKind::Remark => "remark",
            LineKind::Data => "data",
            LineKind::Figure => "figure",
            LineKind::SecondTable => "second_table",
            LineKind::Zeros => "zeros",
            LineKind::Blank => "blank",
        }
    }
}

/// A table of numbers.
pub(super) struct Sheet<'a> {
    pub(super) table: Table<'a>,
    /// What each line with text is.
    pub(super) kinds: Vec<LineKind>,
    /// The lines before the numbers with their numbers, without the marks of a comment.
    pub(super) header: Vec<(usize, &'a str)>,
    rows: Vec<u32>,
    /// How many columns there are.
    pub(super) width: usize,
    /// Whether a column holds texts, such as dates or remarks, and no numbers.
    pub(super) is_text: Vec<bool>,
    /// What the head says of each column.
    pub(super) labels: Vec<Label>,
    pub(super) head: Head,
    has_names: bool,
    /// The unit of columns whose cells have theirs, up to the last of them.
    amounts: Vec<Option<Unit>>,
}

/// The numbers of some columns, and whether they have decimal commas.
pub(super) struct Numbers {
    /// Column by column; `None` is a missing number.
    pub(super) columns: Vec<Vec<Option<f64>>>,
    pub(super) mark: Mark,
    /// Rows without a number in any of them because they hold other texts.
    pub(super) remarks: Vec<usize>,
}

/// Rows one below the other, and the line from which on their head may stand.
#[derive(Default)]
struct Block {
    head: usize,
    rows: Vec<u32>,
}

impl<'a> Sheet<'a> {
    /// The table in a text, as the mapping says.
    pub(super) fn parse(
        text: &'a str,
        is_spreadsheet: bool,
        mapping: &Mapping,
        proceed: &dyn Fn() -> bool,
    ) -> Result<Sheet<'a>, ImportError> {
        let forced = if is_spreadsheet { Some(Separator::TAB) } else { mapping.separator };
        let separator = forced.or_else(|| table::separator(text)).unwrap_or(Separator::WhiteSpace);
        let table = Table::read(text, separator, mapping.decimal, proceed)?;
        let range = mapping.number("first_line").unwrap_or(1)..=mapping.number("last_line").unwrap_or(usize::MAX);
        let mut sheet = Sheet {
            kinds: vec![LineKind::Preamble; table.len()],
            table,
            header: Vec::new(),
            rows: Vec::new(),
            width: 0,
            is_text: Vec::new(),
            labels: Vec::new(),
            head: Head::default(),
            has_names: false,
            amounts: Vec::new(),
        };
        sheet.find(range, mapping)?;
        if forced.is_none() {
            sheet.check_separator()?
        }
        Ok(sheet)
    }

    /// Asks about a column of texts that are numbers with another sign between them.
    fn check_separator(&self) -> Result<(), ImportError> {
        let is_glued = |row: &u32, column: usize| {
            let cell = self.table.cell(*row as usize, column);
            let text = if cell.sort() == Sort::Text { self.table.text(*row as usize, column) } else { "" };
            table::is_glued(text) && !clock::is_stamp(text)
        };
        let is_open = |column: &usize| {
            let looked_at = self.rows.iter().take(8);
            self.is_text[*column]
                && 2 * looked_at.clone().filter(|row| is_glued(row, *column)).count() > looked_at.len()
        };
        let Some(column) = (0..self.width).find(is_open) else { return Ok(()) };
        let (line, text) = (self.table.line(self.row(0)), self.table.text(self.row(0), column));
        let mut signs: Vec<char> = text.chars().filter(|sign| may_separate(*sign)).collect();
        signs.dedup();
        let separators = signs.into_iter().map(Separator::Sign).chain(std::iter::once(self.table.separator));
        let of = |separator: Separator| Candidate {
            quantity: "separator",
            column: None,
            name: separator.plural(),
            values: vec![line.chars().take(80).collect()],
            mapping: format!("separator:{}", separator.name()),
        };
        let fault = format!("`{text:.40}` may be numbers with a separator between them");
        let candidates = separators.map(of).collect();
        Err(ImportError { candidates, ..ImportError::at(self.line(0), column + 1, fault) })
    }

    /// Finds rows and head among the lines with these numbers.
    fn find(&mut self, range: std::ops::RangeInclusive<usize>, mapping: &Mapping) -> Result<(), ImportError> {
        let is_said = mapping.has_lines() || *range.start() > 1;
        // What stands before a line with a number sign alone is the header of Zygo's export, whatever numbers it has.
        let is_zygo = self.table.len() > 0 && self.table.line(0).starts_with("Zygo");
        let marked = |line: &usize| is_zygo && self.table.line(*line).is_empty();
        let begin = (0..self.table.len()).find(marked).map_or(0, |line| line + 1);
        let within: Vec<bool> =
            (0..self.table.len()).map(|line| line >= begin && range.contains(&self.table.number(line))).collect();
        let inner: Vec<usize> =
            (begin..self.table.len()).filter(|line| within[*line] && !self.table.is_comment(*line)).collect();
        if self.columns_of(&inner).is_none() {
            return Err(self.no_table());
        }
        let (mut blocks, mut spoilt, mut foreign) = (vec![Block::default()], Vec::new(), Vec::new());
        for (line, is_within) in within.into_iter().enumerate() {
            let is_later = blocks.len() > 1;
            let block = blocks.last_mut().expect("the first");
            if !is_within || self.table.is_comment(line) {
                let is_below = self.table.number(line) > *range.end();
                let is_inside = !block.rows.is_empty() && is_within;
                if is_inside && !is_said && self.is_head(line) {
                    blocks.push(Block { head: line, rows: Vec::new() });
                }
                self.kinds[line] = if is_below || is_inside { LineKind::Remark } else { LineKind::Preamble };
                continue;
            }
            let (numbers, texts, missing) = self.counts(line);
            let fits = is_said || self.fits(line);
            let has_rows = !block.rows.is_empty();
            let is_alone = numbers == 1 && self.table.cells(line).len() == 1 && self.width > 1;
            match (numbers, texts) {
                (1.., _) if !fits => foreign.push(line as u32),
                (1.., 0) if !is_alone || has_rows => block.rows.push(line as u32),
                // The rows of another table may have texts where the first has numbers.
                (1.., 1..) if has_rows || is_later => block.rows.push(line as u32),
                (1.., 1..) => spoilt.push(line as u32),
                (0, 0) if missing > 0 && has_rows => block.rows.push(line as u32),
                _ if has_rows && !is_said && self.is_head(line) => {
                    blocks.push(Block { head: line, rows: Vec::new() });
                }
                _ if has_rows => self.kinds[line] = LineKind::Remark,
                _ if line > MOST_HEADER && !is_said => return Err(self.no_table()),
                _ => {}
            }
        }
        self.leave_out_figures(&mut blocks);
        if blocks.first().is_none_or(|block| block.rows.is_empty()) {
            return Err(self.no_table());
        }
        let chosen = match mapping.number("table").filter(|_| !is_said) {
            Some(wanted) => Some(self.of_number(&blocks, wanted)?),
            None => None,
        };
        let block = self.one_table(blocks, chosen)?;
        if chosen.is_some() {
            let rows: Vec<usize> = block.rows.iter().map(|row| *row as usize).collect();
            self.columns_of(&rows);
        }
        self.check_foreign(&foreign, &block, is_said || chosen.is_some())?;
        let first = block.rows[0] as usize;
        self.rows = block.rows;
        self.rows.iter().for_each(|row| self.kinds[*row as usize] = LineKind::Data);
        self.trim();
        if !is_said && chosen.is_none() {
            self.check_first_row()?;
        }
        if self.width < 2 {
            return Err(ImportError::of_file(ONE_COLUMN));
        }
        self.header = (block.head..first).map(|line| (self.table.number(line), self.table.line(line))).collect();
        let head = head::read(self, block.head..first);
        for (line, kind) in &head.kinds {
            self.kinds[*line] = *kind;
        }
        self.labels = head.labels.clone();
        self.has_names = self.labels.iter().any(|label| !label.text.is_empty());
        self.head = head;
        if is_said { Ok(()) } else { self.check_header(&spoilt, first) }
    }

    /// The number of columns of most rows, and which of them hold texts.
    fn columns_of(&mut self, lines: &[usize]) -> Option<()> {
        let mut widths: Vec<(usize, usize)> = Vec::new();
        for line in lines {
            let cells = self.table.cells(*line);
            let numbers = cells.iter().filter(|cell| cell.is_number()).count();
            let texts = cells.iter().filter(|cell| cell.sort() == Sort::Text).count();
            if numbers > 1 && 2 * numbers > texts {
                match widths.iter_mut().find(|(width, _)| *width == cells.len()) {
                    Some((_, count)) => *count += 1,
                    None => widths.push((cells.len(), 1)),
                }
            }
        }
        // Of widths with as many rows the first.
        let most = widths.iter().map(|(_, count)| *count).max()?;
        self.width = widths.iter().find(|(_, count)| *count == most)?.0;
        let mut counts = vec![(0_usize, 0_usize); self.width];
        for line in lines {
            let cells = self.table.cells(*line);
            if cells.len() == self.width && cells.iter().filter(|cell| cell.is_number()).count() > 1 {
                for ((numbers, texts), cell) in counts.iter_mut().zip(cells) {
                    *numbers += usize::from(cell.is_number());
                    *texts += usize::from(cell.sort() == Sort::Text);
                }
            }
        }
        self.is_text = counts.into_iter().map(|(numbers, texts)| texts > numbers).collect();
        Some(())
    }

    /// Numbers and texts in the columns of numbers, and missing numbers.
    fn counts(&self, line: usize) -> (usize, usize, usize) {
        let mut counts = (0, 0, 0);
        for (cell, is_text) in self.table.cells(line).iter().zip(&self.is_text) {
            match cell.sort() {
                Sort::Missing => counts.2 += 1,
                Sort::Text => counts.1 += usize::from(!is_text),
                _ => counts.0 += usize::from(!is_text),
            }
        }
        counts
    }

    /// Whether a line has as many cells as the rows, but for remarks behind the last column and last columns of text.
    fn fits(&self, line: usize) -> bool {
        let cells = self.table.cells(line);
        cells.iter().skip(self.width).all(|cell| !cell.is_number())
            && self.is_text.iter().skip(cells.len()).all(|is_text| *is_text)
            || cells.len() == 1
    }

    /// Whether a line names columns, or their units.
    fn is_head(&self, line: usize) -> bool {
        let Some(cells) = head::cells(self, line) else { return false };
        let texts = self.table.cells(line).iter().filter(|cell| cell.is_number()).count();
        texts == 0 && cells.iter().filter(|cell| head::is_named(cell) || head::is_unit(cell)).count() > 1
    }

    /// Takes lines of figures off the end of each table: a word, and numbers behind it.
    fn leave_out_figures(&mut self, blocks: &mut Vec<Block>) {
        for block in blocks.iter_mut() {
            while let Some(last) = block.rows.last() {
                let line = *last as usize;
                let cells = self.table.cells(line);
                let Some(first) = cells.iter().position(|cell| cell.sort() != Sort::Missing) else { break };
                let word = self.table.text(line, first).to_lowercase();
                let plain = word.trim_matches(|letter: char| !letter.is_alphanumeric());
                let is_word =
                    cells[first].sort() == Sort::Text && !word.contains(|letter: char| letter.is_ascii_digit());
                let is_known = FIGURES.split_whitespace().any(|known| plain == known);
                let is_text = self.is_text.get(first).copied().unwrap_or(false);
                if !(is_word && (is_known || !is_text && word.starts_with(char::is_alphabetic))) {
                    break;
                }
                self.kinds[line] = LineKind::Figure;
                block.rows.pop();
            }
        }
        // A head above figures alone is theirs.
        let first = blocks.first().map_or(0, |block| block.head);
        for block in blocks.iter().filter(|block| block.rows.is_empty() && block.head > first) {
            self.kinds[block.head] = LineKind::Figure;
        }
        let mut is_first = true;
        blocks.retain(|block| std::mem::take(&mut is_first) || !block.rows.is_empty());
    }

    /// The head of a table, to compare it with that of another.
    fn head_of(&self, block: &Block) -> Vec<String> {
        let first = block.rows[0] as usize;
        let lines = (block.head..first).filter_map(|line| head::cells(self, line));
        let known = lines.filter(|cells| cells.iter().any(|cell| head::is_named(cell) || head::is_unit(cell)));
        known.map(|cells| cells.join("\u{1f}").to_lowercase()).collect()
    }

    /// Whether all cells of a line are units.
    fn is_units(&self, line: usize) -> bool {
        head::cells(self, line).is_some_and(|cells| cells.iter().all(|cell| cell.is_empty() || head::is_unit(cell)))
    }

    /// The index of the table with this number, from 1 on.
    fn of_number(&self, blocks: &[Block], wanted: usize) -> Result<usize, ImportError> {
        let missing = || ImportError::of_file(format!("there is no table {wanted} among {}", blocks.len()));
        wanted.checked_sub(1).filter(|index| *index < blocks.len()).ok_or_else(missing)
    }

    /// The chosen one of several tables, or all that have the same head.
    fn one_table(&mut self, blocks: Vec<Block>, chosen: Option<usize>) -> Result<Block, ImportError> {
        if let Some(index) = chosen {
            let mut taken = Block::default();
            for (number, block) in blocks.into_iter().enumerate() {
                if number == index {
                    taken = block;
                } else {
                    let end = block.rows.last().map_or(block.head, |last| *last as usize);
                    self.kinds[block.head..=end].fill(LineKind::SecondTable);
                }
            }
            return Ok(taken);
        }
        let mut blocks = blocks.into_iter();
        let mut first = blocks.next().unwrap_or_default();
        let named = self.head_of(&first);
        let mut others = Vec::new();
        for block in blocks {
            // Numbers of channels above a line of units are a remark of the head.
            if first.rows.len() == 1 && others.is_empty() && self.is_units(block.head) {
                self.kinds[first.rows[0] as usize] = LineKind::Remark;
                first.rows = block.rows;
                continue;
            }
            let head = self.head_of(&block);
            // Each line of a repeated head is one of the first.
            if head.iter().all(|line| named.contains(line)) {
                (block.head..block.rows[0] as usize).for_each(|line| self.kinds[line] = LineKind::Remark);
                first.rows.extend(block.rows);
            } else {
                others.push(block);
            }
        }
        if others.is_empty() {
            return Ok(first);
        }
        let lines = |block: &Block| {
            let last = *block.rows.last().expect("a row") as usize;
            (self.table.number(block.rows[0] as usize), self.table.number(last))
        };
        let mut said = Vec::new();
        let mut candidates = Vec::new();
        for (index, block) in std::iter::once(&first).chain(&others).enumerate() {
            let (begin, end) = lines(block);
            let named = |line: &usize| {
                head::cells(self, *line).map_or(0, |cells| cells.iter().filter(|cell| head::is_named(cell)).count())
            };
            let heads = (block.head..block.rows[0] as usize).rev().filter(|line| self.is_head(*line));
            let head = heads.max_by_key(named);
            let name = head.map_or_else(|| "the same columns".to_owned(), |line| self.table.line(line).to_owned());
            let name: String = name.chars().take(100).collect();
            said.push(format!("lines {begin} to {end} (`{name}`)"));
            let mapping = format!("table:{}", index + 1);
            let values = vec![format!("lines {begin} to {end}")];
            candidates.push(Candidate { quantity: "table", column: None, name, values, mapping });
        }
        let fault = format!("the file has {} tables: {}: choose one by `mapping=table:2`", said.len(), said.join("; "));
        Err(ImportError::ambiguous(fault, candidates))
    }

    /// Lines of numbers of another width: a table of its own if it is apart, or a fault.
    fn check_foreign(&mut self, foreign: &[u32], block: &Block, is_said: bool) -> Result<(), ImportError> {
        let (first, last) = (block.rows[0], block.rows[block.rows.len() - 1]);
        for line in foreign.iter().copied() {
            let at = line as usize;
            let (numbers, texts) =
                (self.counts(at).0, self.table.cells(at).iter().filter(|cell| cell.sort() == Sort::Text).count());
            let is_apart = |from: u32, to: u32| {
                let lines = (from..to).map(|line| self.table.number(line as usize));
                let gaps = lines.zip((from + 1..=to).map(|line| self.table.number(line as usize)));
                let is_gap = gaps.into_iter().any(|(one, next)| next > one + 1);
                is_gap || (from + 1..to).any(|between| self.counts(between as usize).0 == 0)
            };
            let is_word = self.table.cells(at)[0].sort() == Sort::Text
                && self.table.text(at, 0).starts_with(|letter: char| letter.is_alphabetic());
            let is_other = is_said
                || line > last && is_word
                || if line < first {
                    texts > 0 || numbers < 2 || is_apart(line, first)
                } else {
                    line > last && is_apart(last, line)
                };
            if !is_other {
                let (cells, width) = (self.table.cells(at).len(), self.width);
                let fault = format!(
                    "has {}, and the other rows {width}: correct it, or choose the rows by `first_line` and \
                     `last_line` in `mapping`",
                    columns(cells)
                );
                return Err(ImportError::at_line(self.table.number(at), fault));
            }
            self.kinds[at] = if line < first { LineKind::Preamble } else { LineKind::SecondTable };
            if line > last && self.table.cells(at)[0].sort() == Sort::Text {
                self.kinds[at] = LineKind::Figure;
            }
        }
        Ok(())
    }

    /// Drops columns behind the last that has something: a separator at the end of each line is no column.
    fn trim(&mut self) {
        let last = |row: &u32| {
            let cells = self.table.cells(*row as usize);
            cells.iter().take(self.width).rposition(|cell| cell.sort() != Sort::Missing).map_or(0, |last| last + 1)
        };
        let mut widest = 0;
        for row in &self.rows {
            // A column that is missing in all rows is one if it has marks of missing numbers.
            widest = widest.max(last(row));
            if widest == self.width {
                return;
            }
        }
        let mut is_marked = vec![false; self.width];
        for row in self.rows.iter().take(ENOUGH) {
            let cells = self.table.split(*row as usize);
            is_marked.iter_mut().zip(cells).for_each(|(marked, cell)| *marked |= !unquoted(cell).is_empty());
        }
        widest += is_marked[widest..].iter().take_while(|marked| **marked).count();
        self.width = widest;
        self.is_text.truncate(widest);
    }

    /// Asks about a first row that is written otherwise than all that follow, in every column: it may be a line of
    /// scales or of numbers of channels.
    fn check_first_row(&self) -> Result<(), ImportError> {
        let decimals = |row: usize, column: usize| {
            let text = self.table.text(self.row(row), column);
            (!text.is_empty()).then(|| text.find(['.', ',']).map_or(0, |at| text.len() - at))
        };
        let numeric: Vec<usize> = (0..self.width.min(16)).filter(|column| !self.is_text[*column]).collect();
        let (Some(last), true) = (self.len().checked_sub(1).map(|last| last.min(8)), numeric.len() > 1) else {
            return Ok(());
        };
        let has_head = self.row(0) > 0 && !self.table.cells(self.row(0) - 1).iter().any(|cell| cell.is_number());
        let differs = |column: &usize| {
            let next = decimals(1, *column);
            next.is_some_and(|next| next > 0)
                && (1..=last).all(|row| decimals(row, *column) == next)
                && decimals(0, *column) != next
        };
        if last < 4 || !has_head || !numeric.iter().all(differs) {
            return Ok(());
        }
        let of = |row: usize, name: &str| Candidate {
            quantity: "first_line",
            column: None,
            name: name.to_owned(),
            values: vec![self.table.line(self.row(row)).chars().take(80).collect()],
            mapping: format!("first_line:{}", self.line(row)),
        };
        let candidates = vec![of(1, "the rows begin below this line"), of(0, "this line is a row")];
        let fault = "has fewer or more decimals than the rows below: it may be a row, or a line of scales or channels";
        Err(ImportError { candidates, ..ImportError::at_line(self.line(0), fault) })
    }

    /// Refuses a line below the names that looks like a row of numbers.
    fn check_header(&self, spoilt: &[u32], first: usize) -> Result<(), ImportError> {
        for line in spoilt.iter().map(|line| *line as usize).filter(|line| *line < first) {
            let cells = self.table.cells(line);
            let is_text = |column: &usize| {
                cells[*column].sort() == Sort::Text && !self.is_text.get(*column).copied().unwrap_or(false)
            };
            let Some(column) = (0..cells.len().min(self.width)).find(is_text) else { continue };
            let text = self.table.text(line, column);
            // Above the names stand keys with numbers, as in `Samples;41`.
            let has_digits = text.contains(|letter: char| letter.is_ascii_digit());
            let names = self.kinds.iter().position(|kind| *kind == LineKind::Names);
            let is_above = names.map_or(!has_digits, |names| line < names);
            let is_key = column == 0 && text.starts_with(char::is_alphabetic) && is_above;
            let is_axis =
                line + 1 == first && column == 0 && cells.len() > 3 && cells[1..].iter().all(|cell| cell.is_number());
            if is_key || is_axis || cells.len() < 2 {
                continue;
            }
            return Err(self.not_a_number(line, column));
        }
        Ok(())
    }

    /// Marks rows at the end whose numbers are all zero, where such columns are used, as not measured; how many.
    pub(super) fn leave_out_zeros(&mut self, used: &[usize], has_time: bool) -> usize {
        let is_zero = |row: &u32| used.iter().all(|column| self.table.cell(*row as usize, *column).is_zero());
        let count = self.rows.iter().rev().take_while(|row| is_zero(row)).count();
        // Where the time falls to zero with all others, one row says enough.
        if count < if has_time { 1 } else { FEWEST_ZEROS } || count == self.rows.len() || used.len() < 2 {
            return 0;
        }
        let kept = self.rows.len() - count;
        self.rows[kept..].iter().for_each(|row| self.kinds[*row as usize] = LineKind::Zeros);
        self.rows.truncate(kept);
        count
    }

    /// Refuses a header that names other columns than there are.
    pub(super) fn check_names(&self) -> Result<(), ImportError> {
        self.head.misnamed.clone().map_or(Ok(()), Err)
    }

    /// How many rows there are.
    pub(super) fn len(&self) -> usize {
        self.rows.len()
    }

    /// The index among lines of a row.
    pub(super) fn row(&self, row: usize) -> usize {
        self.rows[row] as usize
    }

    /// Takes a row off.
    pub(super) fn drop_rows(&mut self, count: usize) {
        self.rows.drain(..count);
    }

    /// The number of the line of each row.
    pub(super) fn line(&self, row: usize) -> usize {
        self.table.number(self.row(row))
    }

    /// The name of a column, if it has one.
    pub(super) fn name(&self, column: usize) -> Option<&str> {
        self.labels.get(column).map(|label| label.text.as_str()).filter(|text| !text.is_empty())
    }

    /// Whether any column has a name.
    pub(super) fn has_names(&self) -> bool {
        self.has_names
    }

    /// The column in a sentence.
    pub(super) fn title(&self, column: usize) -> String {
        self.name(column).map_or_else(|| format!("column {}", column + 1), |name| format!("`{name}`"))
    }

    /// The index of a column by its number from 1 on, or by its name in the header, of which the beginning is enough.
    pub(super) fn find_column(&self, name: &str) -> Option<usize> {
        if let Ok(number) = name.parse::<usize>() {
            return number.checked_sub(1).filter(|index| *index < self.width);
        }
        let name = name.to_lowercase();
        let names: Vec<String> = self.labels.iter().map(|label| label.text.to_lowercase()).collect();
        let equal = names.iter().position(|one| *one == name);
        let bare = || self.labels.iter().position(|label| label.name.to_lowercase() == name);
        equal.or_else(bare).or_else(|| names.iter().position(|one| one.starts_with(&name)))
    }

    /// The texts of a column.
    pub(super) fn texts(&self, column: usize) -> impl Iterator<Item = &'a str> {
        self.rows.iter().map(move |row| self.table.text(*row as usize, column))
    }

    /// The first texts of a column.
    pub(super) fn first_values(&self, column: usize) -> Vec<String> {
        let shown = |text: &str| text.chars().take(40).collect();
        self.texts(column).filter(|text| !text.is_empty()).take(3).map(shown).collect()
    }

    /// The numbers of some columns.
    ///
    /// # Errors
    /// [`ImportError`] at a cell that is no number, or a number that can be read in two ways.
    pub(super) fn numbers(&mut self, columns: &[usize]) -> Result<Numbers, ImportError> {
        let marks = self.marks(columns)?;
        let mut found = Numbers {
            columns: columns.iter().map(|_| Vec::with_capacity(self.rows.len())).collect(),
            mark: if marks.contains(&Mark::Comma) { Mark::Comma } else { Mark::Point },
            remarks: Vec::new(),
        };
        self.take_units(columns)?;
        for row in &self.rows {
            let line = *row as usize;
            let mut fault = None;
            let mut numbers = 0;
            for ((values, column), mark) in found.columns.iter_mut().zip(columns).zip(&marks) {
                let value = self.table.value(line, *column, *mark);
                numbers += usize::from(value.is_some());
                if value.is_none() && self.table.cell(line, *column).sort() != Sort::Missing {
                    fault = fault.or(Some(*column));
                }
                let unit = self.amounts.get(*column).copied().flatten();
                values.push(value.map(|value| unit.map_or(value, |unit| unit.coherent().convert(value, unit))));
            }
            match fault {
                Some(column) if numbers > 0 || columns.len() == 1 => return Err(self.not_a_number(line, column)),
                Some(_) => {
                    found.columns.iter_mut().for_each(|values| *values.last_mut().expect("just added") = None);
                    found.remarks.push(self.table.number(line));
                }
                None => {}
            }
        }
        Ok(found)
    }

    /// The unit of columns whose cells have theirs: numbers of such a column are in SI units.
    fn take_units(&mut self, columns: &[usize]) -> Result<(), ImportError> {
        for column in columns {
            let is_amount = |row: &&u32| self.table.cell(**row as usize, *column).sort() == Sort::Amount;
            let Some(first) = self.rows.iter().find(is_amount) else { continue };
            let unit = |row: u32| {
                let text = self.table.text(row as usize, *column);
                let end = text.trim_end_matches(|letter: char| !letter.is_ascii_digit()).len();
                Unit::parse(&text[end..])
            };
            let dimension = unit(*first).map(|unit| unit.dimension);
            let differs = |row: &&u32| match self.table.cell(**row as usize, *column).sort() {
                Sort::Amount => unit(**row).map(|unit| unit.dimension) != dimension,
                sort => sort != Sort::Missing,
            };
            if let Some(row) = self.rows.iter().find(differs) {
                let fault = format!(
                    "`{:.40}` is in another unit than the cells above, or in none",
                    self.table.text(*row as usize, *column)
                );
                return Err(ImportError::at(self.table.number(*row as usize), column + 1, fault));
            }
            let text = self.table.text(*first as usize, *column);
            let symbol = text[text.trim_end_matches(|letter: char| !letter.is_ascii_digit()).len()..].trim().to_owned();
            if let Some(unit) = unit(*first) {
                self.amounts.resize(self.width.max(self.amounts.len()), None);
                self.amounts[*column] = Some(unit);
                if self.labels[*column].unit == Mention::Absent {
                    self.labels[*column].unit = Mention::Known(unit, symbol);
                }
            }
        }
        Ok(())
    }

    /// The decimal mark of each of some columns.
    fn marks(&self, columns: &[usize]) -> Result<Vec<Mark>, ImportError> {
        if let Some(mark) = self.table.decimal() {
            return Ok(vec![mark; columns.len()]);
        }
        let mut evidence = vec![Evidence::default(); columns.len()];
        let is_open =
            |row: &u32| columns.iter().any(|column| self.table.cell(*row as usize, *column).sort() == Sort::Either);
        let looked_at = if self.rows.iter().any(is_open) { self.rows.len() } else { ENOUGH };
        for (index, row) in self.rows.iter().take(looked_at).enumerate() {
            let cells = self.table.split(*row as usize);
            for (evidence, column) in evidence.iter_mut().zip(columns) {
                evidence.add(index, cells.get(*column).copied().unwrap_or(""));
            }
        }
        let has = |mark: Mark| evidence.iter().any(|one| one.has_decimal(mark));
        let others = match (has(Mark::Point), has(Mark::Comma)) {
            (true, false) => Some(Mark::Point),
            (false, true) => Some(Mark::Comma),
            _ => None,
        };
        let of = |(evidence, column): (&Evidence, &usize)| {
            let mark = evidence.mark(others).map_err(|row| self.ambiguous(row, *column))?;
            Ok(if evidence.is_empty() { others.unwrap_or(Mark::Point) } else { mark })
        };
        evidence.iter().zip(columns).map(of).collect()
    }

    fn ambiguous(&self, row: usize, column: usize) -> ImportError {
        let cell = self.table.text(self.row(row), column);
        let fault = format!("the mark in `{cell:.40}` may separate thousands or decimals: say `decimal` in `mapping`");
        let of = |name: &str| Candidate {
            quantity: "decimal",
            column: Some(column + 1),
            name: name.to_owned(),
            values: vec![cell.chars().take(40).collect()],
            mapping: format!("decimal:{name}"),
        };
        let candidates = vec![of("comma"), of("point")];
        ImportError { candidates, ..ImportError::at(self.line(row), column + 1, fault) }
    }

    fn not_a_number(&self, line: usize, column: usize) -> ImportError {
        let cell = self.table.text(line, column);
        let fault = format!(
            "`{cell:.40}` is not a number: if this line is no row, say `first_line` or `last_line` in `mapping`"
        );
        ImportError::at(self.table.number(line), column + 1, fault)
    }

    /// Why a text has no table: at the first line that begins with a number.
    fn no_table(&self) -> ImportError {
        let mut has_column = false;
        for line in (0..self.table.len()).take(MOST_HEADER).filter(|line| !self.table.is_comment(*line)) {
            let cells = self.table.cells(line);
            has_column |= cells.len() == 1 && cells[0].is_number();
            let text = cells.iter().position(|cell| cell.sort() == Sort::Text);
            if let (true, true, Some(column)) = (cells.len() > 1, cells[0].is_number(), text) {
                return self.not_a_number(line, column);
            }
        }
        ImportError::of_file(if has_column { ONE_COLUMN } else { "no rows of numbers were found" })
    }
}

/// A number of columns in words.
pub(super) fn columns(count: usize) -> String {
    if count == 1 { "1 column".to_owned() } else { format!("{count} columns") }
}
