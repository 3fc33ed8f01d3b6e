//! Tables of named columns, and how they are written in each format, whole or block by block.
//!
//! A cell is computed when it is written, so that the text of a large table is never in memory at once.

use std::fmt::{self, Write as _};
use std::ops::Range;

use jiff::Timestamp;
use serde_json::{Number, Value};

#[cfg(feature = "arrow")]
use super::arrow;
use super::{Format, Unwritable};

/// Rows of a block.
const BLOCK: usize = 512;

/// A table.
pub struct Table<'a> {
    rows: usize,
    columns: Vec<Column<'a>>,
    /// What surrounds the columns in [`Format::Columns`].
    envelope: [String; 2],
}

/// A column of a table.
pub struct Column<'a> {
    pub(super) name: String,
    /// Its name as JSON, which is written with every row.
    key: String,
    #[cfg_attr(not(feature = "arrow"), expect(dead_code, reason = "Arrow alone has units"))]
    pub(super) unit: Option<&'static str>,
    pub(super) cells: Cells<'a>,
    /// Whether cells may be missing.
    #[cfg_attr(not(feature = "arrow"), expect(dead_code, reason = "Arrow alone has types"))]
    pub(super) nullable: bool,
}

/// A piece of the written table.
pub type Block = Result<Vec<u8>, Unwritable>;
/// The pieces of a written table, in order.
pub type Blocks<'a> = Box<dyn Iterator<Item = Block> + Send + 'a>;

type ByRow<'a, T> = Box<dyn Fn(usize) -> T + Send + 'a>;

/// The cells of a column by their row, where there is one.
pub enum Cells<'a> {
    /// Numbers.
    Numbers(ByRow<'a, Option<Number>>),
    /// Whole numbers.
    Counts(ByRow<'a, Option<u64>>),
    /// Moments.
    Times(ByRow<'a, Option<Timestamp>>),
    /// Words without commas and quotes.
    Words(ByRow<'a, Option<&'a str>>),
}

impl<'a> Column<'a> {
    /// A column of which cells may be missing; its unit is written in Arrow's metadata.
    pub fn new(name: &str, unit: Option<&'static str>, cells: Cells<'a>) -> Column<'a> {
        Column { name: name.to_owned(), key: Value::from(name).to_string(), unit, cells, nullable: true }
    }

    /// A column of floats; a number that is not finite counts as missing.
    pub fn floats<T: Into<Option<f64>>>(
        name: &str,
        unit: &'static str,
        value: impl Fn(usize) -> T + Send + 'a,
    ) -> Column<'a> {
        let number = move |row| value(row).into().and_then(Number::from_f64);
        Column::new(name, Some(unit), Cells::Numbers(Box::new(number)))
    }

    /// A column of words without commas and quotes.
    pub fn words(name: &str, value: impl Fn(usize) -> &'static str + Send + 'a) -> Column<'a> {
        let words = Cells::Words(Box::new(move |row| Some(value(row))));
        Column { nullable: false, ..Column::new(name, Some(""), words) }
    }

    /// A column of whole numbers without a unit.
    pub fn counts(name: &str, value: impl Fn(usize) -> u64 + Send + 'a) -> Column<'a> {
        let counts = Cells::Counts(Box::new(move |row| Some(value(row))));
        Column { nullable: false, ..Column::new(name, Some("1"), counts) }
    }

    fn write_cell(&self, row: usize, format: Format, text: &mut String) -> fmt::Result {
        let (none, quote) = if format == Format::Csv { ("", "") } else { ("null", "\"") };
        let written = match &self.cells {
            Cells::Numbers(at) => at(row).map(|number| write!(text, "{number}")),
            Cells::Counts(at) => at(row).map(|count| write!(text, "{count}")),
            Cells::Times(at) => at(row).map(|time| write!(text, "{quote}{time}{quote}")),
            Cells::Words(at) => at(row).map(|word| write!(text, "{quote}{word}{quote}")),
        };
        written.unwrap_or_else(|| text.write_str(none))
    }
}

impl<'a> Table<'a> {
    /// A table of `rows` rows; `envelope` is the JSON before and after its columns.
    pub fn new(rows: usize, columns: Vec<Column<'a>>, envelope: [String; 2]) -> Table<'a> {
        Table { rows, columns, envelope }
    }

    /// A table whose JSON document is not that of [`Format::Columns`].
    pub fn flat(rows: usize, columns: Vec<Column<'a>>) -> Table<'a> {
        Table::new(rows, columns, ["{".to_owned(), "}".to_owned()])
    }

    /// All of the table in a format, while `keep_going` returns true, which is asked at each block.
    ///
    /// # Errors
    /// [`Unwritable`], also because `keep_going` has returned false.
    pub fn write(self, format: Format, keep_going: &dyn Fn() -> bool) -> Result<Vec<u8>, Unwritable> {
        // Arrow has one batch of all rows.
        let size = if format == Format::Arrow { self.rows.max(1) } else { BLOCK };
        let mut text = Vec::new();
        for block in self.in_blocks(format, size) {
            if !keep_going() {
                return Err(Unwritable::new("it was ended"));
            }
            text.append(&mut block?);
        }
        Ok(text)
    }

    /// The same block by block.
    pub fn blocks(self, format: Format) -> Blocks<'a> {
        self.in_blocks(format, BLOCK)
    }

    fn in_blocks(self, format: Format, size: usize) -> Blocks<'a> {
        let (rows, blocks) = (self.rows, self.rows.div_ceil(size).max(1));
        let range = move |block: usize| block * size..rows.min((block + 1) * size);
        if format.is_stream() {
            let mut stream = TableStream::new(format);
            // Arrow alone has something to end with.
            let pieces = blocks + usize::from(format == Format::Arrow);
            return Box::new((0..pieces).map(move |block| {
                if block < blocks { stream.push_rows(&self, range(block)) } else { Ok(stream.finish()) }
            }));
        }
        let pieces = if format == Format::Columns { blocks * self.columns.len() } else { blocks };
        Box::new((0..pieces).map(move |piece| {
            let mut text = String::new();
            // Writing to a string cannot fail.
            let _ = match format {
                Format::Columns => self.write_column(piece / blocks, range(piece % blocks), &mut text),
                _ => self.write_rows(range(piece), &mut text),
            };
            Ok(text.into_bytes())
        }))
    }

    fn write_column(&self, index: usize, rows: Range<usize>, text: &mut String) -> fmt::Result {
        let column = &self.columns[index];
        if rows.start == 0 {
            text.write_str(if index == 0 { &self.envelope[0] } else { "," })?;
            write!(text, "{}:[", column.key)?;
        }
        let is_last = rows.end == self.rows;
        for row in rows {
            text.write_str(if row > 0 { "," } else { "" })?;
            column.write_cell(row, Format::Columns, text)?;
        }
        if is_last {
            text.push(']');
            text.write_str(if index + 1 == self.columns.len() { &self.envelope[1] } else { "" })?;
        }
        Ok(())
    }

    fn write_rows(&self, rows: Range<usize>, text: &mut String) -> fmt::Result {
        let is_last = rows.end == self.rows;
        text.push_str(if rows.start == 0 { "[" } else { "" });
        self.write_cells(rows, Format::Rows, text)?;
        text.push_str(if is_last { "]" } else { "" });
        Ok(())
    }

    fn csv_names(&self) -> String {
        self.columns.iter().map(|column| csv_name(&column.name)).collect::<Vec<_>>().join(",") + "\n"
    }

    fn write_cells(&self, rows: Range<usize>, format: Format, text: &mut String) -> fmt::Result {
        let (between, end) = match format {
            Format::Csv => ("", "\n"),
            Format::Rows => (",", "}"),
            _ => ("", "}\n"),
        };
        for row in rows {
            text.push_str(if row > 0 { between } else { "" });
            for (index, column) in self.columns.iter().enumerate() {
                text.push_str(if index > 0 { "," } else { "" });
                if format != Format::Csv {
                    text.push_str(if index == 0 { "{" } else { "" });
                    write!(text, "{}:", column.key)?;
                }
                column.write_cell(row, format, text)?;
            }
            text.push_str(end);
        }
        Ok(())
    }
}

/// A table that is written from several of the same columns, one after another: only the rows differ.
pub struct TableStream {
    format: Format,
    begun: bool,
}

impl TableStream {
    /// An empty one, in a format that [is read row by row](Format::is_stream).
    pub fn new(format: Format) -> TableStream {
        TableStream { format, begun: false }
    }

    /// The next rows, after what the format begins with.
    ///
    /// # Errors
    /// [`Unwritable`] if Arrow cannot hold them.
    pub fn push(&mut self, table: &Table<'_>) -> Block {
        self.push_rows(table, 0..table.rows)
    }

    fn push_rows(&mut self, table: &Table<'_>, rows: Range<usize>) -> Block {
        let is_first = !std::mem::replace(&mut self.begun, true);
        #[cfg(feature = "arrow")]
        if self.format == Format::Arrow {
            let mut bytes = if is_first { arrow::schema(&table.columns) } else { Vec::new() };
            bytes.append(&mut arrow::batch(&table.columns, rows)?);
            return Ok(bytes);
        }
        let mut text = if self.format == Format::Csv && is_first { table.csv_names() } else { String::new() };
        // Writing to a string cannot fail.
        let _ = table.write_cells(rows, self.format, &mut text);
        Ok(text.into_bytes())
    }

    /// What the format ends with.
    pub fn finish(&mut self) -> Vec<u8> {
        #[cfg(feature = "arrow")]
        if self.format == Format::Arrow && self.begun {
            return arrow::END.to_vec();
        }
        Vec::new()
    }
}

/// A name in the first line of comma-separated values.
fn csv_name(name: &str) -> String {
    if name.contains([',', '"', '\n', '\r']) { format!("\"{}\"", name.replace('"', "\"\"")) } else { name.to_owned() }
}
