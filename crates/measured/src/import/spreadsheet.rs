//! Spreadsheets (`.xlsx`, `.ods`) as text with tabulators: a row is a line.
//!
//! What a file unpacks to is counted before it is read, so that its memory is bounded by its length.

use std::borrow::Cow;
use std::io::{BufReader, Cursor, Read as _, sink};
use std::panic::catch_unwind;

use calamine::{Data, DataRef, ExcelDateTime, Ods, Reader as _, Xlsx};
use quick_xml::events::{BytesStart, Event};
use zip::ZipArchive;

use super::error::ImportError;
use super::kinds;
use super::source::Source;

/// Longest spreadsheet that is read.
const LONGEST: usize = 4 << 20;
/// Bytes that a byte of the file may unpack to, in all.
const UNPACKED: u64 = 60;
/// The same in text, in cells of a sheet of OpenDocument, and in texts that cells share.
const AS_TEXT: usize = 2;
/// What is allowed however short the file is: bytes, cells.
const ALLOWANCE: usize = 16 << 10;
/// Columns and rows for which one may stand in a sheet of OpenDocument: those of the largest sheets.
const MOST_REPEATED: [usize; 2] = [16_384, 1_048_576];
/// Columns of a sheet.
const MOST_COLUMNS: usize = 2048;
/// Where sheets are in the two formats, and texts that cells share.
const WORKBOOK: &str = "xl/workbook.xml";
const CONTENT: &str = "content.xml";
const SHARED: &str = "xl/sharedStrings.xml";

type Archive<'a> = ZipArchive<Cursor<&'a [u8]>>;

/// The sheets, or the one of this name or number.
pub(super) fn read<'a>(bytes: &[u8], wanted: Option<&str>) -> Result<Vec<Source<'a>>, ImportError> {
    let damaged = || ImportError::of_file("this zip archive is damaged: copy the file again");
    let mut archive = ZipArchive::new(Cursor::new(bytes)).map_err(|_| damaged())?;
    let names: Vec<String> = archive.file_names().flatten().map(|name| name.into_owned()).collect();
    let has = |member: &str| names.iter().any(|name| name == member);
    let kind = match (has(WORKBOOK), has(CONTENT)) {
        (true, _) => "xlsx",
        (false, true) => "ods",
        _ => return Err(ImportError::of_file(kinds::archive(names.iter().map(String::as_str)))),
    };
    if bytes.len() > LONGEST {
        return Err(too_large());
    }
    check_unpacked(&mut archive, bytes.len())?;
    // The library is not written for hostile files: what it does not expect there is a damaged file.
    let sheets = catch_unwind(|| if kind == "xlsx" { of_xlsx(bytes) } else { of_ods(bytes) });
    let sheets = sheets.unwrap_or_else(|_| Err(damaged()))?;
    let count = sheets.len();
    let mut sources: Vec<Source<'a>> = Vec::new();
    for (index, (name, text, has_bare_formulas)) in sheets.into_iter().enumerate() {
        let sheet = Some((name, index + 1, count));
        sources.push(Source { text: Cow::Owned(text), encoding: kind.to_owned(), sheet, has_bare_formulas });
    }
    let name = |source: &Source<'_>| source.sheet.as_ref().map_or_else(String::new, |(name, ..)| name.clone());
    if let Some(wanted) = wanted {
        let by_name = sources.iter().position(|source| name(source) == wanted);
        let by_number = || wanted.parse::<usize>().ok()?.checked_sub(1).filter(|index| *index < sources.len());
        let Some(index) = by_name.or_else(by_number) else {
            let names: Vec<String> = sources.iter().map(name).take(20).collect();
            return Err(ImportError::of_file(format!("there is no sheet `{wanted:.40}` among {}", names.join(", "))));
        };
        sources = vec![sources.swap_remove(index)];
    }
    if sources.is_empty() { Err(ImportError::of_file("there are no sheets")) } else { Ok(sources) }
}

fn too_large() -> ImportError {
    ImportError::of_file("this spreadsheet is too large: save the sheet with the numbers as CSV")
}

/// Unpacks every member without keeping it, to know how long it is.
fn check_unpacked(archive: &mut Archive<'_>, length: usize) -> Result<(), ImportError> {
    let mut left = UNPACKED * length as u64 + ALLOWANCE as u64;
    for index in 0..archive.len() {
        let Ok(member) = archive.by_index(index) else { continue };
        let is_shared = member.name().is_ok_and(|name| name == SHARED);
        let most = if is_shared { ((AS_TEXT * length + ALLOWANCE) as u64).min(left) } else { left };
        let unpacked = std::io::copy(&mut member.take(most + 1), &mut sink()).unwrap_or(0);
        if unpacked > most {
            return Err(too_large());
        }
        left -= unpacked;
    }
    Ok(())
}

/// The rows of a sheet as text.
struct Text {
    text: String,
    most: usize,
    row: usize,
    column: usize,
}

impl Text {
    fn new(length: usize) -> Text {
        Text { text: String::new(), most: AS_TEXT * length + ALLOWANCE, row: 0, column: 0 }
    }

    /// Adds a cell at a place behind the last.
    fn add(&mut self, row: usize, column: usize, cell: &str) -> Result<(), ImportError> {
        let new_rows = row.saturating_sub(self.row);
        let new_columns = if new_rows > 0 { column } else { column.saturating_sub(self.column) };
        if column >= MOST_COLUMNS || self.text.len() + new_rows + new_columns + cell.len() > self.most {
            return Err(too_large());
        }
        self.text.extend(std::iter::repeat_n('\n', new_rows));
        self.text.extend(std::iter::repeat_n('\t', new_columns));
        self.text.extend(cell.chars().map(|letter| match letter {
            '\t' | '\n' | '\r' => ' ',
            '"' => '\u{201d}',
            letter => letter,
        }));
        (self.row, self.column) = (row, column);
        Ok(())
    }
}

fn of_xlsx(bytes: &[u8]) -> Result<Vec<(String, String, bool)>, ImportError> {
    let fault = |error: calamine::XlsxError| ImportError::of_file(format!("this spreadsheet cannot be read: {error}"));
    let mut book: Xlsx<_> = Xlsx::new(Cursor::new(bytes)).map_err(fault)?;
    let mut sheets = Vec::new();
    let mut length = 0;
    for name in book.sheet_names() {
        // A chart has no cells.
        let Ok(mut cells) = book.worksheet_cells_reader(&name) else { continue };
        let mut text = Text::new(bytes.len());
        while let Some(cell) = cells.next_cell().map_err(fault)? {
            let (row, column) = cell.get_position();
            let value = match cell.get_value() {
                DataRef::Empty => continue,
                DataRef::SharedString(text) => (*text).to_owned(),
                DataRef::DateTime(moment) => date(moment),
                value => written(&Data::from(value.clone())),
            };
            text.add(row as usize, column as usize, &value)?;
        }
        drop(cells);
        length += text.text.len();
        if length > text.most {
            return Err(too_large());
        }
        // Formulas whose values nobody stored.
        let formulas = book.worksheet_formula(&name).is_ok_and(|formulas| formulas.used_cells().next().is_some());
        sheets.push((name, text.text, formulas));
    }
    Ok(sheets)
}

fn of_ods(bytes: &[u8]) -> Result<Vec<(String, String, bool)>, ImportError> {
    check_cells(bytes)?;
    let fault = |error: calamine::OdsError| ImportError::of_file(format!("this spreadsheet cannot be read: {error}"));
    let mut book: Ods<_> = Ods::new(Cursor::new(bytes)).map_err(fault)?;
    let mut sheets = Vec::new();
    for name in book.sheet_names() {
        let range = book.worksheet_range(&name).map_err(fault)?;
        let (first_row, first_column) = range.start().unwrap_or((0, 0));
        let mut text = Text::new(bytes.len());
        for (row, column, value) in range.used_cells() {
            text.add(first_row as usize + row, first_column as usize + column, &written(value))?;
        }
        sheets.push((name, text.text, false));
    }
    Ok(sheets)
}

/// Counts the cells of sheets of OpenDocument, in which a cell and a row may stand for many.
fn check_cells(bytes: &[u8]) -> Result<(), ImportError> {
    let damaged = |_| ImportError::of_file("this spreadsheet cannot be read: its content is damaged");
    let mut archive = ZipArchive::new(Cursor::new(bytes)).map_err(|error| damaged(error.to_string()))?;
    let content = archive.by_name(CONTENT).map_err(|error| damaged(error.to_string()))?;
    let repeats = |element: &BytesStart<'_>, name: &str, most: usize| {
        let value = element.attributes().flatten().find(|attribute| attribute.key.as_ref() == name);
        let count = value.map_or(Ok(1), |value| value.value.trim().parse::<usize>());
        count.ok().filter(|count| *count <= most).ok_or_else(too_large)
    };
    let most = bytes.len() / 2 + ALLOWANCE;
    let (mut cells, mut rows, mut widest) = (0_usize, 0_usize, 0_usize);
    let (mut row, mut open, mut times, mut waiting) = (0_usize, 0_usize, 1, 0_usize);
    let mut reader = quick_xml::Reader::from_reader(BufReader::new(content));
    let mut buffer = Vec::new();
    loop {
        buffer.clear();
        let event = reader.read_event_into(&mut buffer).map_err(|error| damaged(error.to_string()))?;
        match &event {
            Event::Eof => return Ok(()),
            Event::Start(element) | Event::Empty(element) => match element.name().as_ref() {
                "table:table" => (rows, widest) = (0, 0),
                "table:table-row" => {
                    (row, open) = (0, 0);
                    times = repeats(element, "table:number-rows-repeated", MOST_REPEATED[1])?;
                }
                "table:table-cell" | "table:covered-table-cell" => {
                    let count = repeats(element, "table:number-columns-repeated", MOST_REPEATED[0])?;
                    let is_empty = matches!(event, Event::Empty(_)) && element.attributes().count() < 3;
                    (row, open) = if is_empty {
                        (row, open.saturating_add(count))
                    } else {
                        (row.saturating_add(open).saturating_add(count), 0)
                    };
                }
                _ => {}
            },
            Event::End(element) if element.name().as_ref() == "table:table-row" => {
                cells = cells.saturating_add(row);
                // Empty rows count where others follow.
                if row > 0 {
                    rows = rows.saturating_add(waiting).saturating_add(times);
                    waiting = 0;
                } else {
                    waiting = waiting.saturating_add(times);
                }
                widest = widest.max(row);
                if cells.max(rows.saturating_mul(widest)) > most {
                    return Err(too_large());
                }
            }
            _ => {}
        }
    }
}

/// A cell as text. Numbers have an exponent, so that their point can be nothing but the decimal mark.
fn written(value: &Data) -> String {
    match value {
        Data::Empty => String::new(),
        Data::Int(number) => number.to_string(),
        Data::Float(number) => format!("{number:e}"),
        Data::String(text) | Data::DateTimeIso(text) => text.clone(),
        Data::Bool(flag) => flag.to_string(),
        Data::DateTime(moment) => date(moment),
        Data::DurationIso(text) => text.trim_start_matches("PT").trim_end_matches('S').replace(['H', 'M'], ":"),
        _ => "#N/A".to_owned(),
    }
}

fn date(moment: &ExcelDateTime) -> String {
    let (year, month, day, hour, minute, second, milliseconds) = moment.to_ymd_hms_milli();
    let time = format!("{hour:02}:{minute:02}:{second:02}.{milliseconds:03}");
    // A time of day alone is a part of day zero.
    if moment.as_f64() < 1.0 { time } else { format!("{year:04}-{month:02}-{day:02} {time}") }
}
