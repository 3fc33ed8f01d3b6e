//! The formats of tables and pictures: their names, and how each is written.

#[cfg(feature = "arrow")]
mod arrow;
mod table;

use std::fmt::Display;
use std::io;

use serde::Serialize;

use crate::Nanoseconds;
use stickslip_plot::Drawing;

pub use table::{Block, Blocks, Cells, Column, Table, TableStream};

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
    #[cfg(not(feature = "arrow"))]
    pub const ALL: [Format; 6] = [Format::Columns, Format::Rows, Format::Csv, Format::Ndjson, Format::Svg, Format::Png];
    /// All formats; the first is the default.
    #[cfg(feature = "arrow")]
    pub const ALL: [Format; 7] =
        [Format::Columns, Format::Rows, Format::Csv, Format::Ndjson, Format::Arrow, Format::Svg, Format::Png];

    /// The formats of a table that has no plot.
    #[cfg(not(feature = "arrow"))]
    pub const TABLES: [Format; 4] = [Format::Columns, Format::Rows, Format::Csv, Format::Ndjson];
    /// The formats of a table that has no plot.
    #[cfg(feature = "arrow")]
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
        document: &dyn Json,
        picture: &dyn Fn() -> Option<Drawing>,
        table: &dyn Fn() -> Option<Table<'p>>,
        keep_going: &dyn Fn() -> bool,
    ) -> Result<Vec<u8>, Unwritable> {
        if self == Format::Columns {
            // One that is known to be short is written sooner than anybody could ask.
            let is_short = length > CAPACITY && length < PIECE;
            let question = if is_short { usize::MAX } else { PIECE };
            let mut text = StoppableText { text: Vec::with_capacity(length), question, keep_going };
            document.write(&mut text).map_err(Unwritable::new)?;
            return Ok(text.text);
        }
        let none = || Unwritable::new(format_args!("the reply has no {} format", self.name()));
        if self.is_plot() {
            let picture = picture().ok_or_else(none)?;
            if self == Format::Svg { picture.svg() } else { picture.png(keep_going) }.map_err(Unwritable::new)
        } else {
            table().ok_or_else(none)?.write(self, keep_going)
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

/// A JSON document without its type.
pub trait Json {
    /// Writes it.
    ///
    /// # Errors
    /// Why it cannot be written, or that it was ended.
    fn write(&self, text: &mut StoppableText<'_>) -> serde_json::Result<()>;
}

impl<T: Serialize> Json for T {
    fn write(&self, text: &mut StoppableText<'_>) -> serde_json::Result<()> {
        serde_json::to_writer(text, self)
    }
}

/// The text of a JSON document in lines for human readers, each member and element indented by two spaces a level.
pub fn indented(json: &[u8]) -> Vec<u8> {
    let mut lines = Vec::with_capacity(2 * json.len());
    let (mut level, mut in_string, mut is_escaped) = (0_usize, false, false);
    let mut bytes = json.iter().copied().peekable();
    while let Some(byte) = bytes.next() {
        if in_string {
            lines.push(byte);
            in_string = is_escaped || byte != b'"';
            is_escaped = !is_escaped && byte == b'\\';
            continue;
        }
        let new_line = |lines: &mut Vec<u8>, level: usize| {
            lines.push(b'\n');
            lines.resize(lines.len() + 2 * level, b' ');
        };
        if matches!(byte, b'}' | b']') {
            level = level.saturating_sub(1);
            if !matches!(lines.last(), Some(b'{' | b'[')) {
                new_line(&mut lines, level);
            }
        }
        lines.push(byte);
        match byte {
            b'"' => in_string = true,
            b':' => lines.push(b' '),
            b',' => new_line(&mut lines, level),
            b'{' | b'[' => {
                level += 1;
                if !matches!(bytes.peek(), Some(b'}' | b']')) {
                    new_line(&mut lines, level);
                }
            }
            _ => {}
        }
    }
    lines
}

/// Bytes of a text that are written between two questions whether to go on.
const PIECE: usize = 256 * 1024;

/// A text that cannot be written any more once `keep_going` has returned false.
pub struct StoppableText<'a> {
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

#[cfg(test)]
mod tests {
    use super::indented;

    #[test]
    fn lines_are_those_of_the_library() {
        for text in [
            r#"{"a":[1,0.0025,null],"b":{},"c":[],"d":{"e":"x, {y}: [z]"},"f":[[],{}],"g\"h":"\\"}"#,
            "[]",
            "{}",
            "3",
            r#""{\"""#,
            r#"[{"a":1},{"b":[true,false]}]"#,
        ] {
            let value: serde_json::Value = serde_json::from_str(text).unwrap();
            assert_eq!(String::from_utf8(indented(text.as_bytes())).unwrap(), format!("{value:#}"), "{text}");
        }
    }
}
