//! The formats of tables and pictures: their names, and how each is written.

mod table;

use std::fmt::Display;
use std::io;

use serde::Serialize;

use crate::Nanoseconds;
use stickslip_plot::Drawing;

pub use table::{Block, Cells, Column, Table, TableStream};

/// Bytes that a plot takes while it is drawn: its pixels, and the outlines of a rough field.
const PLOT: usize = 32 * 1024 * 1024;
/// The least time that drawing a plot takes.
const PLOT_COST: Nanoseconds = 1_000_000;

/// How a table is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// The JSON document of the endpoint.
    Columns,
    /// A JSON array of flat objects.
    Rows,
    /// Comma-separated values under a line of names; a missing value is an empty cell.
    Csv,
    /// One flat JSON object per line.
    Ndjson,
    /// A stream of Arrow record batches: typed columns, read without parsing.
    Arrow,
    /// A vector plot.
    Svg,
    /// A bitmap plot.
    Png,
}

impl Format {
    /// All formats; the first is the default.
    pub const ALL: [Format; 7] =
        [Format::Columns, Format::Rows, Format::Csv, Format::Ndjson, Format::Arrow, Format::Svg, Format::Png];

    /// The formats of a table that has no plot.
    pub const TABLES: [Format; 5] = [Format::Columns, Format::Rows, Format::Csv, Format::Ndjson, Format::Arrow];

    /// Its name in a query, and its media type.
    const fn names(self) -> (&'static str, &'static str) {
        match self {
            Format::Columns => ("columns", "application/json"),
            Format::Rows => ("rows", "application/vnd.stickslip.rows+json"),
            Format::Csv => ("csv", "text/csv; charset=utf-8"),
            Format::Ndjson => ("ndjson", "application/x-ndjson"),
            Format::Arrow => ("arrow", "application/vnd.apache.arrow.stream"),
            Format::Svg => ("svg", "image/svg+xml"),
            Format::Png => ("png", "image/png"),
        }
    }

    /// Its name in a query.
    pub fn name(self) -> &'static str {
        self.names().0
    }

    /// The format of this name in `formats`.
    pub fn named(name: &str, formats: &[Format]) -> Option<Format> {
        formats.iter().copied().find(|format| format.name() == name)
    }

    /// Its media type.
    pub const fn media_type(self) -> &'static str {
        self.names().1
    }

    /// Whether it is a plot.
    pub fn is_plot(self) -> bool {
        matches!(self, Format::Svg | Format::Png)
    }

    /// Whether it is a table that is read row by row, and can be sent piece by piece.
    pub fn is_stream(self) -> bool {
        matches!(self, Format::Csv | Format::Ndjson | Format::Arrow)
    }

    /// Bytes that writing takes beyond the columns, for `rows` rows of `row` bytes each.
    pub fn bytes(self, rows: usize, row: usize) -> usize {
        match self {
            Format::Columns => 0,
            Format::Svg | Format::Png => PLOT + rows * row,
            Format::Rows | Format::Csv | Format::Ndjson | Format::Arrow => rows * row,
        }
    }

    /// The cost of writing it, beyond the numbers.
    pub fn cost(self) -> Nanoseconds {
        if self.is_plot() { PLOT_COST } else { 0 }
    }

    /// A document in this format, about `length` bytes long as JSON; only the plot or table that this needs is made.
    ///
    /// # Errors
    /// [`Unwritable`], which is a fault of the service, or because `keep_going` has returned false.
    pub fn write<'p>(
        self,
        length: usize,
        document: &impl Serialize,
        picture: impl FnOnce() -> Option<Drawing>,
        table: impl FnOnce() -> Option<Table<'p>>,
        keep_going: &dyn Fn() -> bool,
    ) -> Result<Vec<u8>, Unwritable> {
        if self == Format::Columns {
            // One that is known to be short is written sooner than anybody could ask.
            let is_short = length > CAPACITY && length < PIECE;
            return if is_short { json(length, document) } else { json_while(length, document, keep_going) };
        }
        let none = || Unwritable::new(format_args!("the reply has no {} format", self.name()));
        if self.is_plot() {
            let picture = picture().ok_or_else(none)?;
            if self == Format::Svg { picture.svg() } else { picture.png(keep_going) }.map_err(Unwritable::new)
        } else {
            table().ok_or_else(none)?.write(self, keep_going).map_err(Unwritable::new)
        }
    }
}

/// Capacity, bytes, that a text begins with if its length is not known.
pub const CAPACITY: usize = 128;

/// A reply that cannot be written, which is a fault of the service.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("a reply cannot be written: {0}")]
pub struct Unwritable(String);

impl Unwritable {
    /// From the message of the library.
    pub fn new(error: impl Display) -> Unwritable {
        Unwritable(error.to_string())
    }
}

/// A value as JSON, in a text of this capacity, bytes, from the start: one that grows is copied repeatedly.
///
/// # Errors
/// [`Unwritable`], which is a fault of the service.
pub fn json(capacity: usize, value: &impl Serialize) -> Result<Vec<u8>, Unwritable> {
    let mut text = Vec::with_capacity(capacity);
    serde_json::to_writer(&mut text, value).map_err(Unwritable::new)?;
    Ok(text)
}

/// The same while `keep_going` returns true, which is asked every [`PIECE`].
fn json_while(capacity: usize, value: &impl Serialize, keep_going: &dyn Fn() -> bool) -> Result<Vec<u8>, Unwritable> {
    let mut text = StoppableText { text: Vec::with_capacity(capacity), question: PIECE, keep_going };
    serde_json::to_writer(&mut text, value).map_err(Unwritable::new)?;
    Ok(text.text)
}

/// Bytes of a text that are written between two questions whether to go on.
const PIECE: usize = 256 * 1024;

/// A text that cannot be written any more once `keep_going` has returned false.
struct StoppableText<'a> {
    text: Vec<u8>,
    /// The length from which it is asked next.
    question: usize,
    keep_going: &'a dyn Fn() -> bool,
}

impl io::Write for StoppableText<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.write_all(bytes)?;
        Ok(bytes.len())
    }

    #[inline]
    fn write_all(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.text.extend_from_slice(bytes);
        if self.text.len() >= self.question {
            self.question = self.text.len() + PIECE;
            if !(self.keep_going)() {
                return Err(io::Error::other("it was ended"));
            }
        }
        Ok(())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
