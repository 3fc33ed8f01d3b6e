//! Grids of heights with a header of their own: ISO 25178-71 (`.sdf`), ESRI (`.asc`) and Surfer (`.grd`) as text.

use super::error::ImportError;
use super::lines::lines;
use super::number::{Mark, is_missing, is_no_value, number};
use super::preview::Preview;
use super::scan::{HEIGHT, LATERAL, Places, ScanFile, ScanHints, thinned};
use super::source::Source;
use super::units::Length;

/// Lines of a header that are shown.
const SHOWN: usize = 20;

/// What the header of a grid says.
#[derive(Default)]
struct Header {
    name: &'static str,
    /// Whether lengths are in metres for certain.
    is_metric: bool,
    columns: usize,
    rows: usize,
    dx: f64,
    dy: f64,
    /// The height of one count.
    scale: f64,
    /// The number that stands where a height is missing.
    fill: Option<f64>,
    /// Lines of the header.
    lines: usize,
}

/// Reads a grid; none if the first line does not begin one.
pub(super) fn read(source: &Source, hints: &ScanHints) -> Option<Result<ScanFile, ImportError>> {
    let text = source.text.trim_start_matches('\u{feff}');
    let header = match text.split_whitespace().next()?.to_lowercase().as_str() {
        "aiso-1.0" => iso(text),
        "dsaa" => surfer(text),
        "ncols" => esri(text),
        _ => return None,
    };
    Some(header.and_then(|header| grid(source, text, &header, hints)))
}

/// The value behind a name in the header, with its line.
fn value(text: &str, name: &str) -> Result<(usize, f64), ImportError> {
    let found = lines(text).take(SHOWN).find_map(|(line, text)| {
        let (key, value) = text.trim().split_once(|letter: char| letter.is_whitespace() || letter == '=')?;
        let value = value.trim_start_matches([' ', '\t', '=']).trim();
        key.eq_ignore_ascii_case(name).then_some((line, value))
    });
    let (line, value) = found.ok_or_else(|| ImportError::of_file(format!("the header has no `{name}`")))?;
    let value = number(value, Mark::Point)
        .ok_or_else(|| ImportError::at_line(line, format!("has no number after `{name}`: `{value:.40}`")))?;
    Ok((line, value))
}

/// A value that is above zero.
fn size(text: &str, name: &str) -> Result<f64, ImportError> {
    let (line, size) = value(text, name)?;
    let positive = |size: &f64| *size > 0.0 && size.is_finite();
    Some(size)
        .filter(positive)
        .ok_or_else(|| ImportError::at_line(line, format!("has a `{name}` that is not above zero")))
}

/// A number of rows or columns.
fn count(text: &str, name: &str) -> Result<usize, ImportError> {
    let count = size(text, name)?;
    let is_whole = count.fract() < f64::EPSILON && count < 1e9;
    is_whole
        .then_some(count as usize)
        .ok_or_else(|| ImportError::of_file(format!("`{name}` is not a number of points")))
}

/// ISO 25178-71: lengths in metres, heights in counts of `Zscale`, and a line with an asterisk behind the header.
fn iso(text: &str) -> Result<Header, ImportError> {
    let end = lines(text).find(|(_, line)| line.trim() == "*").map(|(line, _)| line);
    Ok(Header {
        name: "ISO 25178-71",
        is_metric: true,
        columns: count(text, "NumPoints")?,
        rows: count(text, "NumProfiles")?,
        dx: size(text, "Xscale")?,
        dy: size(text, "Yscale")?,
        scale: size(text, "Zscale")?,
        fill: None,
        lines: end.ok_or_else(|| ImportError::of_file("the header is not closed by a line with `*`"))?,
    })
}

/// ESRI: places in a unit that is not named, and the value of cells without data.
fn esri(text: &str) -> Result<Header, ImportError> {
    let (dx, dy) = match size(text, "cellsize") {
        Ok(size) => (size, size),
        Err(error) => (size(text, "dx").map_err(|_| error)?, size(text, "dy")?),
    };
    let is_key = |line: &str| line.trim_start().starts_with(char::is_alphabetic);
    Ok(Header {
        name: "ESRI grid",
        is_metric: false,
        columns: count(text, "ncols")?,
        rows: count(text, "nrows")?,
        dx,
        dy,
        scale: 1.0,
        // Without the line it is that.
        fill: Some(value(text, "nodata_value").map_or(-9999.0, |(_, fill)| fill)),
        lines: lines(text).take(SHOWN).take_while(|(_, line)| is_key(line)).count(),
    })
}

/// Surfer: numbers of points, and the ends of x, y and z.
fn surfer(text: &str) -> Result<Header, ImportError> {
    let numbers: Vec<f64> =
        text.split_whitespace().skip(1).take(6).filter_map(|word| number(word, Mark::Point)).collect();
    match numbers[..] {
        [columns, rows, left, right, low, high] if columns >= 2.0 && rows >= 2.0 && right > left && high > low => {
            let (columns, rows) = (columns as usize, rows as usize);
            let (dx, dy) = ((right - left) / (columns - 1) as f64, (high - low) / (rows - 1) as f64);
            let header =
                Header { name: "Surfer grid", columns, rows, dx, dy, scale: 1.0, lines: 5, ..Header::default() };
            Ok(header)
        }
        _ => Err(ImportError::of_file("the header of this Surfer grid has no numbers of points and ends")),
    }
}

fn grid(source: &Source, text: &str, header: &Header, hints: &ScanHints) -> Result<ScanFile, ImportError> {
    let Header { name, is_metric, columns, rows, dx, dy, scale, fill, lines: header_lines } = *header;
    let mut heights: Vec<Option<f64>> = Vec::new();
    let mut closing = Vec::new();
    for (line, text) in lines(text).skip_while(|(line, _)| *line <= header_lines) {
        for (column, word) in text.split_whitespace().enumerate() {
            if word == "*" {
                closing.push(line);
                continue;
            }
            let height = number(word, Mark::Point).filter(|height| !is_no_value(*height));
            if height.is_none() && number(word, Mark::Point).is_none() && !is_missing(word) {
                return Err(ImportError::at(line, column + 1, format!("`{word:.40}` is not a number")));
            }
            heights.push(height.filter(|height| Some(*height) != fill));
        }
    }
    if columns.checked_mul(rows) != Some(heights.len()) {
        let found = heights.len();
        return Err(ImportError::of_file(format!(
            "the header has {columns} x {rows} heights, and {found} follow: the file is not complete"
        )));
    }
    let (lateral_unit, unit) = (LATERAL.beside(hints.lateral.as_ref()), HEIGHT.beside(hints.height.as_ref()));
    let (mut lateral, mut height) = (Length::nearest(lateral_unit.unit), Length::nearest(unit.unit));
    if is_metric {
        lateral = if lateral_unit.is_assumed { Length::Micrometre } else { lateral };
        height = if unit.is_assumed { Length::Nanometre } else { height };
    }
    let mut preview = Preview {
        encoding: source.encoding.clone(),
        separator: "white_space",
        rows,
        header: lines(text)
            .take(header_lines.min(SHOWN))
            .map(|(_, line)| line.trim().chars().take(200).collect())
            .collect(),
        rows_left_out: (1..=header_lines).chain(closing).collect(),
        thinned: 1,
        ..Preview::default()
    };
    let (dx, dy) = match hints.spacing {
        Some(spacing) => (spacing, spacing),
        None => (dx, dy),
    };
    let assumed = |is_assumed: bool| {
        if is_assumed && !is_metric { ", because nothing names another unit" } else { "" }
    };
    let step = |distance: f64| lateral_unit.unit.convert(distance, lateral.unit());
    let count = unit.unit.convert(scale, height.unit());
    preview.reading.push(format!("{}, {name}: a matrix of {columns} x {rows} heights.", source.encoding));
    preview.reading.push(format!(
        "Neighbours are {} by {} {} apart{}.",
        step(dx),
        step(dy),
        lateral.symbol(),
        assumed(lateral_unit.is_assumed)
    ));
    let of = if is_metric { "counts of" } else { "in units of" };
    preview.reading.push(format!("Heights are {of} {count} {}{}.", height.symbol(), assumed(unit.is_assumed)));
    let value = |row: usize, column: usize| heights[row * columns + column].map(|value| count * value);
    let z = thinned(rows, columns, hints.most, value, &mut preview);
    let stride = preview.thinned as f64;
    Ok(ScanFile { places: Places::Map { dx: stride * step(dx), dy: stride * step(dy), z }, lateral, height, preview })
}
