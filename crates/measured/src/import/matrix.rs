//! A matrix of heights: its size from its header, from its places in the first row and column, or from the client.

use super::columns::Needed;
use super::error::{Candidate, ImportError};
use super::label::{Label, Mention};
use super::number::{Mark, number};
use super::preview::{ColumnUnit, Preview};
use super::scan::{Found, HEIGHT, LATERAL, Places, Wanted, fill_value, say_missing};
use super::sheet::Sheet;
use super::table::Sort;
use super::units::Length;

/// How far places may be from even ones that are as many, as a part of their distance: they are rounded.
const UNEVEN: f64 = 0.03;
/// Keys of the header before the unit of the heights, the distance of neighbours, and the sizes.
const HEIGHT_UNITS: [&str; 8] =
    ["Value units", "Werteinheiten", "Werteinheit", "Z unit", "Z-unit", "Height unit", "Units", "Unit"];
const DISTANCES: [&str; 7] = [
    "XY calibration",
    "Pixel size",
    "Lateral resolution",
    "Lateral spacing",
    "Spacing",
    "Pixelgr\u{f6}\u{df}e",
    "Step",
];
const WIDTHS: [&str; 2] = ["Width", "Breite"];
const HEIGHTS: [&str; 2] = ["Height", "H\u{f6}he"];

/// Places in the first row and column.
struct Places2 {
    /// The distances of neighbours, none if places count rows and columns.
    steps: Option<[f64; 2]>,
    /// The unit in the corner.
    corner: Mention,
    /// Whether the places of the columns are a row of the table.
    has_row: bool,
}

/// What stands behind one of some keys in the header: its line, and the text, cells joined by blanks.
fn field(sheet: &Sheet<'_>, names: &[&str]) -> Option<(usize, String)> {
    sheet.header.iter().find_map(|(line, text)| {
        let text = text.trim_start_matches('"');
        let of = |name: &&str| {
            text.get(..name.len()).filter(|begin| begin.eq_ignore_ascii_case(name)).map(|_| &text[name.len()..])
        };
        let rest = names.iter().find_map(of)?.trim_start_matches('"').trim_start();
        let rest = rest.strip_prefix([':', '=', ',', ';', '\t', '|'])?;
        let plain: Vec<&str> =
            rest.split(['"', ';', '\t', '|', ' ']).filter(|part| !part.is_empty() && *part != ",").collect();
        let plain = plain.join(" ");
        Some((*line, plain.trim().to_owned())).filter(|(_, text)| !text.is_empty())
    })
}

/// A length in the header, as in `Width: 10.0 um`.
fn measure(sheet: &Sheet<'_>, names: &[&str]) -> Result<Option<(f64, ColumnUnit)>, ImportError> {
    let Some((line, value)) = field(sheet, names) else { return Ok(None) };
    let (digits, unit) = value.split_once(char::is_whitespace).unwrap_or((&value, ""));
    let mark = if digits.contains(',') { Mark::Comma } else { Mark::Point };
    match number(digits, mark).filter(|size| *size > 0.0) {
        Some(size) if !unit.is_empty() => {
            Ok(Some((size, LATERAL.named(unit.trim().trim_matches(['[', ']', '(', ')']), Some(line), None)?)))
        }
        _ => Ok(None),
    }
}

/// The distance of neighbours if places are even, and whether they only count.
fn step(places: &[Option<f64>]) -> Option<(f64, bool)> {
    let all: Vec<f64> = places.iter().copied().collect::<Option<_>>()?;
    let count = all.len();
    let step = (all.get(count.checked_sub(1)?)? - all[0]) / (count - 1) as f64;
    let is_even = all
        .iter()
        .enumerate()
        .all(|(index, place)| (place - all[0] - step * index as f64).abs() <= UNEVEN * step.abs());
    let counts = is_even && (step - 1.0).abs() < 1e-9 && [0.0, 1.0].contains(&all[0]);
    (count > 2 && is_even && step != 0.0).then_some((step.abs(), counts))
}

/// The places in the first row and column, if they are there.
fn places(sheet: &mut Sheet<'_>) -> Result<Option<Places2>, ImportError> {
    let width = sheet.width;
    let first = sheet.row(0);
    let even = |row: usize| {
        let line = sheet.row(row);
        let places: Vec<Option<f64>> = (1..width).map(|column| sheet.table.value(line, column, Mark::Point)).collect();
        step(&places).is_some()
    };
    // A number in the corner stands above places if the heights below are no even steps themselves.
    let is_numbered = sheet.len() > 3 && width > 3 && even(0) && !even(1) && !even(2);
    let has_row = sheet.table.cell(first, 0).sort() == Sort::Missing || is_numbered;
    let line = if has_row { Some(first) } else { first.checked_sub(1) };
    let Some(line) = line.filter(|_| sheet.len() > 3 && width > 3) else { return Ok(None) };
    let cells = sheet.table.cells(line);
    let is_row = cells.len() >= width && (1..width).all(|column| cells[column].is_number());
    if !is_row || !has_row && cells[0].is_number() {
        return Ok(None);
    }
    let found = sheet.numbers(&[0])?;
    let down = &found.columns[0][usize::from(has_row)..];
    let across: Vec<Option<f64>> = (1..width).map(|column| sheet.table.value(line, column, found.mark)).collect();
    let corner = Label::of(sheet.table.text(line, 0)).unit;
    Ok(step(&across).zip(step(down)).map(|((dx, is_count), (dy, counts))| {
        let steps = (!is_count || !counts).then_some([dx, dy]);
        Places2 { steps, corner, has_row }
    }))
}

/// Reads a matrix of heights.
pub(super) fn read(
    sheet: &mut Sheet<'_>,
    wanted: &Wanted<'_>,
    preview: &mut Preview,
    entries: &mut Vec<String>,
) -> Result<Found, ImportError> {
    let mapping = wanted.mapping;
    preview.columns.clear();
    let is_said = mapping.number("first_column").is_some();
    let axes = if is_said { None } else { places(sheet)? };
    if axes.as_ref().is_some_and(|axes| axes.has_row) {
        sheet.drop_rows(1);
    }
    let begin = mapping.number("first_column").map_or(usize::from(axes.is_some()), |column| column - 1);
    let end = mapping.number("last_column").unwrap_or(sheet.width).min(sheet.width);
    let (rows, width) = (sheet.len(), end.saturating_sub(begin));
    if width < 2 || rows < 2 {
        return Err(ImportError::of_file("a matrix of heights has two columns and two rows or more"));
    }
    let hint = mapping.unit("lateral");
    let distance = measure(sheet, &DISTANCES)?;
    let (wide, high) = (measure(sheet, &WIDTHS)?, measure(sheet, &HEIGHTS)?);
    let corner = |needed: Needed| match axes.as_ref().map(|axes| &axes.corner) {
        Some(Mention::Known(_, text)) if hint.is_none() => needed.named(text, Some(sheet.line(0)), Some(1)),
        _ => Ok(needed.beside(hint)),
    };
    let (unit, [dx, dy], why) = if let Some([dx, dy]) = mapping.spacing {
        let unit = LATERAL.beside(hint);
        let why = format!("Neighbours are {dx} {} apart, as asked for.", unit.text);
        (unit, [dx, dy], why)
    } else if let Some(steps) = axes.as_ref().and_then(|axes| axes.steps) {
        let unit = corner(LATERAL)?;
        let why =
            format!("Neighbours are {} by {} {} apart, by the first row and column.", steps[0], steps[1], unit.text);
        (unit, steps, why)
    } else if let Some((distance, unit)) = distance {
        let why = format!("Neighbours are {distance} {} apart, from the header.", unit.text);
        (unit, [distance; 2], why)
    } else if let (Some((wide, unit)), Some((high, other))) = (wide, high) {
        let why = format!("{wide} {} by {high} {}, from the header.", unit.text, other.text);
        let dy = other.unit.convert(high, unit.unit) / rows as f64;
        (unit, [wide / width as f64, dy], why)
    } else {
        return Err(ImportError::of_file(format!(
            "{width} columns are a matrix of heights: give the distance of its neighbours (`spacing`, or \
             `mapping=spacing:5;lateral:um;height:nm`), or its `Width` and `Height` in the header; or choose the \
             columns \
             of a line by `x` and `z`"
        )));
    };
    let z_unit = match field(sheet, &HEIGHT_UNITS) {
        Some((line, text)) if mapping.unit("height").is_none() => HEIGHT.named(&text, Some(line), None)?,
        _ => HEIGHT.beside(mapping.unit("height")),
    };
    // One unit without the other would be metres beside micrometres.
    if unit.is_assumed != z_unit.is_assumed && mapping.unit("lateral").is_none() && mapping.unit("height").is_none() {
        let (what, entry) = if z_unit.is_assumed { ("heights", "height") } else { ("places", "lateral") };
        let of = |symbol: &str| Candidate {
            quantity: if z_unit.is_assumed { "height" } else { "lateral" },
            column: None,
            name: symbol.to_owned(),
            values: Vec::new(),
            mapping: format!("{entry}:{symbol}"),
        };
        let fault = format!("nothing names the unit of {what}: say `{entry}`");
        return Err(ImportError::ambiguous(fault, ["nm", "um", "mm", "m"].map(of).to_vec()));
    }
    let (lateral, height) = (Length::nearest(unit.unit), Length::nearest(z_unit.unit));
    let found = sheet.numbers(&(begin..end).collect::<Vec<_>>())?;
    let fill = fill_value(sheet, found.columns.iter().flatten().copied().flatten(), preview);
    preview.rows = rows;
    preview.written(sheet, found.mark);
    let said = |unit: &ColumnUnit| if unit.is_assumed { ", because nothing names another unit" } else { "" };
    preview.reading.push(format!("A matrix of {width} x {rows} heights in {}{}.", z_unit.text, said(&z_unit)));
    preview.reading.push(why);
    for (what, unit) in [("places", &unit), ("heights", &z_unit)] {
        if unit.is_assumed {
            preview.assumed.push(format!("The unit of {what} is {}: nothing names another one.", unit.text));
        }
    }
    entries
        .push(format!("spacing:{}", if dx.to_bits() == dy.to_bits() { dx.to_string() } else { format!("{dx}:{dy}") }));
    entries.push(format!("lateral:{};height:{}", unit.text, z_unit.text));
    entries.push(format!("first_column:{};last_column:{end}", begin + 1));
    let value = |row: usize, column: usize| {
        let value = found.columns[column][row].filter(|value| Some(*value) != fill);
        value.map(|value| z_unit.unit.convert(value, height.unit()))
    };
    let z = thinned(rows, width, wanted.most, value, preview);
    let scale = preview.thinned as f64;
    let [dx, dy] = [dx, dy].map(|step| scale * unit.unit.convert(step, lateral.unit()));
    Ok((Places::Map { dx, dy, z }, lateral, height))
}

/// The heights of a matrix, thinned along both sides to no more than `most`.
pub(super) fn thinned(
    rows: usize,
    width: usize,
    most: usize,
    value: impl Fn(usize, usize) -> Option<f64>,
    preview: &mut Preview,
) -> Vec<Vec<Option<f64>>> {
    let stride = thinning(width, rows, most);
    let row = |row: usize| (0..width).step_by(stride).map(|column| value(row, column)).collect();
    let z: Vec<Vec<Option<f64>>> = (0..rows).step_by(stride).map(row).collect();
    if stride > 1 {
        let kept = format!("{} x {}", z[0].len(), z.len());
        preview.thinned = stride;
        preview.reading.push(format!("One height in {stride} along each side is kept: {kept} heights."));
    }
    say_missing(z.iter().flatten().filter(|height| height.is_none()).count(), preview);
    z
}

/// The smallest step with which a matrix has no more heights than that.
fn thinning(width: usize, rows: usize, most: usize) -> usize {
    let kept = |every: usize| width.div_ceil(every) * rows.div_ceil(every);
    if most == 0 { 1 } else { (1..).find(|every| kept(*every) <= most).unwrap_or(1) }
}
