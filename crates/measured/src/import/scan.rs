//! A scan in a file: heights along a line, at points, or in a matrix.

use super::columns::{Needed, UnitHint};
use super::error::ImportError;
use super::grid;
use super::label::Mention;
use super::loops::ColumnName;
use super::names::{Axis, axis};
use super::number::{Mark, number};
use super::preview::{ColumnUnit, Preview};
use super::sheet::Sheet;
use super::source::Source;
use super::units::Length;

/// Most columns of a list of places and heights without names; wider tables are matrices.
const MOST_COLUMNS: usize = 3;

/// Numbers that stand for no height, by custom: of grids, and the ends of whole numbers.
const FILLS: [f64; 8] = [-9999.0, -99999.0, -999.0, 9999.0, 99999.0, -32768.0, 32767.0, -2_147_483_648.0];
/// How many times the range of the heights such a number is away from them.
const FAR: f64 = 10.0;

pub(super) const LATERAL: Needed = Needed::length("lateral");
pub(super) const HEIGHT: Needed = Needed::length("height");

/// What is known of a scan beside its file. It precedes what the file says.
#[derive(Clone, Debug, Default)]
pub struct ScanHints {
    /// The unit of places.
    pub lateral: Option<UnitHint>,
    /// The unit of heights.
    pub height: Option<UnitHint>,
    /// The distance of neighbours in a matrix, in the unit of places.
    pub spacing: Option<f64>,
    /// The column of places along the line, or along the one axis.
    pub x: Option<ColumnName>,
    /// The column of places along the other axis.
    pub y: Option<ColumnName>,
    /// The column of heights.
    pub z: Option<ColumnName>,
    /// The sheet of a spreadsheet, by its name or its number from 1 on; without it the first with numbers.
    pub sheet: Option<String>,
    /// The largest number of heights; a file with more is thinned. Zero: no bound.
    pub most: usize,
}

/// The heights of a scan, `None` where one is missing, in the units of its [`ScanFile`].
#[derive(Clone, Debug, PartialEq)]
pub enum Places {
    /// Along a line.
    Line {
        /// Places.
        x: Vec<f64>,
        /// Heights.
        z: Vec<Option<f64>>,
    },
    /// At points of the surface.
    Points {
        /// Places along the one axis.
        x: Vec<f64>,
        /// Places along the other.
        y: Vec<f64>,
        /// Heights.
        z: Vec<Option<f64>>,
    },
    /// In rows of a matrix.
    Map {
        /// The distance of neighbours in a row.
        dx: f64,
        /// The distance of rows.
        dy: f64,
        /// Rows of heights.
        z: Vec<Vec<Option<f64>>>,
    },
}

/// What was read from a file.
#[derive(Clone, Debug, PartialEq)]
pub struct ScanFile {
    /// The heights and their places.
    pub places: Places,
    /// The unit of places; metres where neither the file nor a hint names one.
    pub lateral: Length,
    /// The unit of heights.
    pub height: Length,
    /// What was taken for what.
    pub preview: Preview,
}

/// Reads a scan: columns with places and heights, by their names or in the order x, z or x, y, z; or a matrix of
/// heights, as Gwyddion exports it. The text formats of Zygo's instruments, of ISO 25178-71 and of grids (ESRI, Surfer)
/// are known by their first line.
///
/// # Errors
/// [`ImportError`] if the bytes are no such table, by line and column.
pub fn read_scan(bytes: &[u8], hints: &ScanHints) -> Result<ScanFile, ImportError> {
    let source = Source::of(bytes, hints.sheet.as_deref())?;
    if let Some(grid) = grid::read(&source, hints) {
        return grid;
    }
    let sheet = Sheet::parse(&source.text)?;
    let preview = Preview::of(&sheet, &source);
    let is_zygo = sheet.header.first().is_some_and(|(_, line)| line.starts_with("Zygo"));
    let mut file = if is_zygo && sheet.width == MOST_COLUMNS {
        zygo(&sheet, hints, preview)?
    } else if let Some(columns) = Columns::of(&sheet, hints)? {
        list(&sheet, hints, &columns, preview)?
    } else {
        matrix(&sheet, hints, preview)?
    };
    file.preview.reading.extend(source.remark);
    Ok(file)
}

/// Which column is what, and why others are left out.
struct Columns {
    x: usize,
    y: Option<usize>,
    z: usize,
    left_out: Vec<(usize, &'static str)>,
}

impl Columns {
    /// The columns of a list; none if the table is a matrix.
    fn of(sheet: &Sheet<'_>, hints: &ScanHints) -> Result<Option<Columns>, ImportError> {
        let wanted = |name: &Option<String>| {
            let missing = |name: &str| {
                let name: String = name.chars().take(40).collect();
                ImportError::of_file(format!("there is no column `{name}` among {} columns", sheet.width))
            };
            name.as_ref().map(|name| sheet.find(name).ok_or_else(|| missing(name))).transpose()
        };
        let (mut x, mut y, mut z) = (wanted(&hints.x)?, wanted(&hints.y)?, wanted(&hints.z)?);
        let is_wanted = x.is_some() || z.is_some();
        let axes: Vec<Axis> = (0..sheet.width).map(|column| axis_of(sheet, column)).collect();
        let is_list = axes.contains(&Axis::Z) && axes.contains(&Axis::X);
        let numeric = sheet.is_text.iter().filter(|is_text| !**is_text).count();
        let known = axes.iter().filter(|axis| matches!(axis, Axis::X | Axis::Y | Axis::Z | Axis::Unknown)).count();
        if numeric > MOST_COLUMNS && known > MOST_COLUMNS && !is_list && !is_wanted {
            return Ok(None);
        }
        sheet.check_names()?;
        let mut left_out: Vec<(usize, &'static str)> = Vec::new();
        let mut open: Vec<usize> = Vec::new();
        for (column, axis) in axes.iter().enumerate().take(sheet.width) {
            if [x, y, z].contains(&Some(column)) {
                continue;
            }
            match *axis {
                _ if sheet.is_text[column] => left_out.push((column, "text")),
                Axis::Left(reason) => left_out.push((column, reason)),
                _ => open.push(column),
            }
        }
        // A row number without a name: no surface is measured at 1, 2, 3 along a line that is nowhere else.
        if !sheet.has_names() && open.len() == MOST_COLUMNS && open[0] == 0 && counts_rows(sheet)? {
            left_out.push((open.remove(0), "a number of rows"));
        }
        // A column with the unit of something else is no place and no height while there are others.
        let excluded = |column: &usize| {
            let hint = if axes[*column] == Axis::Z { &hints.height } else { &hints.lateral };
            hint.is_none() && LATERAL.excludes(&sheet.labels[*column].unit)
        };
        let fitting: Vec<usize> = open.iter().copied().filter(|column| !excluded(column)).collect();
        let lacking = 2 - usize::from(x.is_some()) - usize::from(z.is_some());
        if fitting.len() >= lacking && axes_are_there(&fitting, &axes, x, z) {
            left_out.extend(open.iter().filter(|column| excluded(column)).map(|column| (*column, "not a length")));
            open = fitting;
        }
        let mut take = |wanted: &mut Option<usize>, axis: Axis| {
            if wanted.is_none() {
                *wanted = open.iter().copied().find(|column| axes[*column] == axis);
                open.retain(|column| Some(*column) != *wanted);
            }
        };
        take(&mut x, Axis::X);
        take(&mut z, Axis::Z);
        take(&mut y, Axis::Y);
        if x.is_none() {
            take(&mut x, Axis::Unknown);
        }
        if let Some(other) =
            open.iter().find(|column| axes[**column] == Axis::X).filter(|_| y.is_none() && hints.x.is_none())
        {
            return Err(ImportError::of_file(format!(
                "{} (column {}) and {} (column {}) may both be the place along the line: choose one by `x`",
                x.map_or_else(String::new, |x| sheet.title(x)),
                x.unwrap_or(0) + 1,
                sheet.title(*other),
                other + 1
            )));
        }
        if z.is_none() {
            z = open.pop();
        }
        // The other of three columns without a name that says otherwise.
        let is_place = |column: &usize| {
            axes[*column] == Axis::Unknown && (!is_list || matches!(sheet.labels[*column].unit, Mention::Known(..)))
        };
        if y.is_none() && open.len() == 1 && !is_wanted && is_place(&open[0]) {
            y = open.pop();
        }
        let heights = open.iter().filter(|column| axes[**column] == Axis::Z).copied().collect::<Vec<_>>();
        left_out.extend(open.into_iter().map(|column| {
            let reason = if heights.contains(&column) { "another height: choose it by `z`" } else { "not needed" };
            (column, reason)
        }));
        match (x, z) {
            (Some(x), Some(z)) if x != z && y != Some(x) && y != Some(z) => Ok(Some(Columns { x, y, z, left_out })),
            _ => Err(ImportError::of_file(format!(
                "a line needs two columns of numbers, places and heights, but {}: choose them by `x` and `z`",
                if x.is_none() && z.is_none() { "neither was found" } else { "one of them was not found" }
            ))),
        }
    }
}

/// What a column is called; nothing if it has no name.
fn axis_of(sheet: &Sheet<'_>, column: usize) -> Axis {
    let label = &sheet.labels[column];
    let is_nameless = label.name.is_empty() && (label.unit != Mention::Absent || !sheet.has_names());
    if is_nameless { Axis::Unknown } else { axis(&label.name) }
}

/// Whether places and heights are still among these columns.
fn axes_are_there(fitting: &[usize], axes: &[Axis], x: Option<usize>, z: Option<usize>) -> bool {
    let has = |wanted: Axis| fitting.iter().any(|column| axes[*column] == wanted);
    let had = |wanted: Axis| axes.contains(&wanted);
    (x.is_some() || has(Axis::X) || !had(Axis::X)) && (z.is_some() || has(Axis::Z) || !had(Axis::Z))
}

/// Whether the first column counts the rows, from 0 or 1 on.
fn counts_rows(sheet: &Sheet<'_>) -> Result<bool, ImportError> {
    let numbers = sheet.numbers(&[0])?.columns.remove(0);
    let first = numbers.first().copied().flatten().filter(|first| [0.0, 1.0].contains(first));
    let counts = |first: f64| numbers.iter().enumerate().all(|(row, number)| *number == Some(first + row as f64));
    Ok(numbers.len() > 2 && first.is_some_and(counts))
}

/// The rows of a list that are kept, and the stride.
fn stride(rows: usize, hints: &ScanHints, preview: &mut Preview) -> usize {
    let stride = if hints.most == 0 { 1 } else { rows.div_ceil(hints.most).max(1) };
    if stride > 1 {
        preview.thinned = stride;
        preview.reading.push(format!("One height in {stride} is kept: {} of {rows} heights.", rows.div_ceil(stride)));
    }
    stride
}

/// The places and heights of some columns, the heights last, each in its unit.
struct Heights {
    axes: Vec<Vec<f64>>,
    z: Vec<Option<f64>>,
}

/// Reads the columns of places and, last, of heights. A row without any number is left out.
fn heights(
    sheet: &Sheet<'_>,
    columns: &[usize],
    hints: &ScanHints,
    preview: &mut Preview,
) -> Result<Heights, ImportError> {
    let found = sheet.numbers(columns)?;
    preview.written(sheet, found.has_decimal_commas);
    let mut z = found.columns;
    let mut last = z.pop().unwrap_or_default();
    let fill = fill_value(sheet, last.iter().copied().flatten(), preview);
    last.iter_mut().filter(|height| height.is_some() && **height == fill).for_each(|height| *height = None);
    let is_empty = |row: &usize| last[*row].is_none() && z.iter().all(|axis| axis[*row].is_none());
    let empty: Vec<usize> = (0..sheet.len()).filter(is_empty).collect();
    let lines: Vec<usize> = empty.iter().map(|row| sheet.line(*row)).collect();
    preview.leave_out_rows(&lines, "they have no number");
    let rows: Vec<usize> = (0..sheet.len()).filter(|row| empty.binary_search(row).is_err()).collect();
    let step = stride(rows.len(), hints, preview);
    let rows: Vec<usize> = rows.into_iter().step_by(step).collect();
    let place = |row: usize, axis: usize| {
        let missing = || ImportError::at(sheet.line(row), columns[axis] + 1, "a place is missing");
        z[axis][row].ok_or_else(missing)
    };
    let axes = (0..z.len()).map(|axis| rows.iter().map(|row| place(*row, axis)).collect::<Result<Vec<f64>, _>>());
    let axes = axes.collect::<Result<Vec<_>, _>>()?;
    let z: Vec<Option<f64>> = rows.iter().map(|row| last[*row]).collect();
    say_missing(z.iter().filter(|height| height.is_none()).count(), preview);
    Ok(Heights { axes, z })
}

/// Says how many heights are missing.
pub(super) fn say_missing(missing: usize, preview: &mut Preview) {
    match missing {
        0 => {}
        1 => preview.reading.push("1 height is missing.".to_owned()),
        _ => preview.reading.push(format!("{missing} heights are missing.")),
    }
}

/// The number that stands where nothing was measured: the one that the header names, or a customary one that is far
/// from all heights.
fn fill_value(sheet: &Sheet<'_>, heights: impl Iterator<Item = f64> + Clone, preview: &mut Preview) -> Option<f64> {
    let keys = ["nodata", "fillvalue", "missingvalue", "invalidvalue", "badvalue", "blankvalue", "fehlwert"];
    let named = sheet.header.iter().find_map(|(_, line)| {
        let plain: String = line.to_lowercase().chars().filter(|letter| !" _-".contains(*letter)).collect();
        keys.iter()
            .any(|key| plain.starts_with(key))
            .then(|| line.split([' ', '\t', '=', ':', ';', ',']).next_back())?
    });
    if let Some(value) = named.and_then(|value| number(value, Mark::Point)) {
        preview.reading.push(format!("{value} marks a missing height, by the header."));
        return Some(value);
    }
    let is = |height: f64, value: f64| height.to_bits() == value.to_bits();
    let is_far = |value: f64| {
        let others = heights.clone().filter(|height| !is(*height, value));
        let ends = |(low, high): (f64, f64), height: f64| (low.min(height), high.max(height));
        let (low, high) = others.fold((f64::INFINITY, f64::NEG_INFINITY), ends);
        high > low && (low - value).max(value - high) > FAR * (high - low)
    };
    let is_there = |value: f64| heights.clone().any(|height| is(height, value));
    let value = FILLS.into_iter().find(|value| is_there(*value) && is_far(*value))?;
    preview.reading.push(format!(
        "{value} is taken as a missing height: it is a customary mark of that, and more than {FAR} times as far from \
         all others as they are from each other."
    ));
    Some(value)
}

fn list(
    sheet: &Sheet<'_>,
    hints: &ScanHints,
    columns: &Columns,
    mut preview: Preview,
) -> Result<ScanFile, ImportError> {
    let Columns { x, y, z, left_out } = columns;
    let x_unit = LATERAL.unit(sheet, *x, hints.lateral.as_ref())?;
    let y_unit = y.map(|y| LATERAL.unit(sheet, y, hints.lateral.as_ref())).transpose()?;
    let z_unit = HEIGHT.unit(sheet, *z, hints.height.as_ref())?;
    let places: Vec<(usize, &'static str, &ColumnUnit)> =
        std::iter::once((*x, "x", &x_unit)).chain(y.iter().zip(&y_unit).map(|(y, unit)| (*y, "y", unit))).collect();
    for (column, name, unit) in &places {
        preview.take(*column, name, unit);
        preview.reading.push(LATERAL.sentence(sheet, *column, name, unit, hints.lateral.as_ref()));
    }
    preview.take(*z, "z", &z_unit);
    preview.reading.push(HEIGHT.sentence(sheet, *z, "z", &z_unit, hints.height.as_ref()));
    for (column, reason) in left_out {
        preview.leave_out(*column, *reason);
        if *reason != "text" {
            let name = sheet.name(*column).map_or_else(String::new, |name| format!(", `{name}`,"));
            preview.reading.push(format!("Column {}{name} is left out: {reason}.", column + 1));
        }
    }
    let order: Vec<usize> = places.iter().map(|(column, ..)| *column).chain([*z]).collect();
    let Heights { mut axes, z } = heights(sheet, &order, hints, &mut preview)?;
    let (lateral, height) = (Length::nearest(x_unit.unit), Length::nearest(z_unit.unit));
    for (axis, (_, _, unit)) in axes.iter_mut().zip(&places) {
        axis.iter_mut().for_each(|place| *place = unit.unit.convert(*place, lateral.unit()));
    }
    let z = z.into_iter().map(|height_of| height_of.map(|value| z_unit.unit.convert(value, height.unit()))).collect();
    let other = (axes.len() > 1).then(|| axes.pop()).flatten();
    let x = axes.pop().unwrap_or_default();
    let places = match other {
        Some(y) => Places::Points { x, y, z },
        None => Places::Line { x, z },
    };
    Ok(ScanFile { places, lateral, height, preview })
}

/// A text of Zygo's MetroPro: pixels and heights in micrometres; the seventh number of the eighth line is the size of a
/// pixel in metres.
fn zygo(sheet: &Sheet<'_>, hints: &ScanHints, mut preview: Preview) -> Result<ScanFile, ImportError> {
    let size = sheet.header.get(7).and_then(|(_, line)| line.split_whitespace().nth(6)?.parse::<f64>().ok());
    let in_hint = hints.spacing.map(|spacing| LATERAL.beside(hints.lateral.as_ref()).unit.to_si(spacing));
    let pixel = in_hint.or(size.filter(|size| *size > 0.0)).ok_or_else(|| {
        ImportError::of_file("the size of a pixel is not in the header of this export: give the distance of neighbours")
    })?;
    let unit = match &hints.height {
        Some(_) => HEIGHT.beside(hints.height.as_ref()),
        None => HEIGHT.named("um", None, None)?,
    };
    let height = Length::nearest(unit.unit);
    preview.reading.push(format!("Zygo's text format: x and y are pixels of {:.6} um.", pixel * 1e6));
    preview.reading.push(format!("z is column 3, in {}.", unit.text));
    for (column, quantity) in ["x", "y"].into_iter().enumerate() {
        preview.take(column, quantity, &ColumnUnit { text: "pixel".to_owned(), ..unit.clone() });
    }
    preview.take(2, "z", &unit);
    let Heights { mut axes, z } = heights(sheet, &[0, 1, 2], hints, &mut preview)?;
    axes.iter_mut().flatten().for_each(|place| *place *= pixel);
    let z = z.into_iter().map(|value| value.map(|value| unit.unit.convert(value, height.unit()))).collect();
    let (y, x) = (axes.pop().unwrap_or_default(), axes.pop().unwrap_or_default());
    Ok(ScanFile { places: Places::Points { x, y, z }, lateral: Length::Metre, height, preview })
}

/// A line of the header that begins with one of some names: its number, and what stands behind the name.
fn field<'a>(sheet: &'a Sheet<'_>, names: &[&str]) -> Option<(usize, &'a str)> {
    sheet.header.iter().find_map(|(line, text)| {
        let rest = names.iter().find_map(|name| text.strip_prefix(name))?;
        Some((*line, rest.strip_prefix([':', '='])?.trim()))
    })
}

/// A length in the header, as in `Width: 10.0 um`.
fn measure(sheet: &Sheet<'_>, names: &[&str]) -> Result<Option<(f64, ColumnUnit)>, ImportError> {
    let Some((line, value)) = field(sheet, names) else { return Ok(None) };
    let (digits, unit) = value.split_once(char::is_whitespace).unwrap_or((value, ""));
    let mark = if digits.contains(',') { Mark::Comma } else { Mark::Point };
    match number(digits, mark).filter(|size| *size > 0.0) {
        Some(size) if !unit.is_empty() => Ok(Some((size, LATERAL.named(unit.trim(), Some(line), None)?))),
        _ => Ok(None),
    }
}

/// A matrix of heights: its size from the header, or the distance of neighbours from a hint.
fn matrix(sheet: &Sheet<'_>, hints: &ScanHints, mut preview: Preview) -> Result<ScanFile, ImportError> {
    let (rows, width) = (sheet.len(), sheet.width);
    preview.columns.clear();
    let (lateral, dx, dy, why) = if let Some(spacing) = hints.spacing {
        let unit = LATERAL.beside(hints.lateral.as_ref());
        let lateral = Length::nearest(unit.unit);
        let step = unit.unit.convert(spacing, lateral.unit());
        (lateral, step, step, format!("Neighbours are {spacing} {} apart, as asked for.", unit.text))
    } else {
        let (wide, high) = (measure(sheet, &["Width", "Breite"])?, measure(sheet, &["Height", "H\u{f6}he"])?);
        let (Some((wide, unit)), Some((high, other))) = (wide, high) else {
            return Err(ImportError::of_file(format!(
                "{width} columns are a matrix of heights: give the distance of its neighbours, or its `Width` and \
                 `Height` in the header; or choose the columns of a line by `x` and `z`"
            )));
        };
        let lateral = Length::nearest(unit.unit);
        let dx = unit.unit.convert(wide, lateral.unit()) / width as f64;
        let dy = other.unit.convert(high, lateral.unit()) / rows as f64;
        (lateral, dx, dy, format!("{wide} {} by {high} {}, from the header.", unit.text, other.text))
    };
    let unit = match field(sheet, &["Value units", "Werteinheit", "Werteinheiten"]) {
        Some((line, text)) if hints.height.is_none() => HEIGHT.named(text, Some(line), None)?,
        _ => HEIGHT.beside(hints.height.as_ref()),
    };
    let height = Length::nearest(unit.unit);
    let columns = sheet.numbers(&(0..width).collect::<Vec<_>>())?;
    let fill = fill_value(sheet, columns.columns.iter().flatten().copied().flatten(), &mut preview);
    preview.written(sheet, columns.has_decimal_commas);
    let why_height = if unit.is_assumed { ", because nothing names another unit" } else { "" };
    preview.reading.push(format!("A matrix of {width} x {rows} heights in {}{why_height}.", unit.text));
    preview.reading.push(why);
    let value = |row: usize, column: usize| {
        columns.columns[column][row]
            .filter(|value| Some(*value) != fill)
            .map(|value| unit.unit.convert(value, height.unit()))
    };
    let z = thinned(rows, width, hints.most, value, &mut preview);
    let step = preview.thinned as f64;
    Ok(ScanFile { places: Places::Map { dx: step * dx, dy: step * dy, z }, lateral, height, preview })
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

#[cfg(test)]
mod tests {
    use super::super::units::Dimension;
    use super::{Length, Places, Preview, ScanFile, ScanHints, UnitHint, read_scan};

    fn read(text: &str) -> ScanFile {
        read_scan(text.as_bytes(), &ScanHints::default()).unwrap_or_else(|error| panic!("{text}: {error}"))
    }

    #[test]
    fn instruments_separate_columns_as_they_like() {
        let expected = Places::Line { x: vec![-1.5, 0.0, 2.5], z: vec![Some(0.25), None, Some(1e-3)] };
        for text in [
            "-1.5,0.25\n0,\n2.5,1e-3\n",
            "x [um], z [um]\n-1.5, 0.25\n0, NaN\n2.5, 1e-3",
            "# scan 7\r\nx;z\r\n-1,5;0,25\r\n0;---\r\n2,5;1e-3\r\n",
            "Lateral\tTotal Profile\n-1.5\t0.25\n0.0\tnan\n2.5\t0.001\n",
            "\u{feff}-1,5   0,25\n 0  BAD\n\n2,5 0,001",
            "X [um] Z [um]\n-1.5 0.25\n0 No Data\n2.5 0.001\n",
        ] {
            assert_eq!(read(text).places, expected, "{text}");
        }
        let points = Places::Points { x: vec![1.0], y: vec![2.0], z: vec![Some(3.0)] };
        assert_eq!(read("x,y,z\n1,2,3").places, points);
        // Both axes are in the unit of the first.
        assert_eq!(read("x [mm],y [cm],z [nm]\n1,0.2,3\n").places, points);
    }

    #[test]
    fn a_header_names_the_units_and_a_hint_precedes_it() {
        for header in ["X [um];Z [nm]", "Lateral (µm);Height (nm)", "x;z\num;nm"] {
            let file = read(&format!("{header}\n1;2\n"));
            assert_eq!((file.lateral, file.height), (Length::Micrometre, Length::Nanometre), "{header}");
        }
        let commented = read("Line profile of 3 mm;Stylus of 2 mm\nX [um];Z [nm]\n1;2\n");
        assert_eq!((commented.lateral, commented.height), (Length::Micrometre, Length::Nanometre));
        assert!(
            commented.preview.reading.iter().any(|line| line.contains("`X [um]`")),
            "{:?}",
            commented.preview.reading
        );
        let plain = read("1;2\n");
        assert_eq!((plain.lateral, plain.height), (Length::Metre, Length::Metre));
        assert!(plain.preview.reading[1].contains("because nothing names another unit"), "{:?}", plain.preview.reading);
        let hints = ScanHints { height: UnitHint::of("mm", Dimension::LENGTH).ok(), ..ScanHints::default() };
        let hinted = read_scan(b"X [um];Z [nm]\n1;2\n", &hints).unwrap();
        assert_eq!((hinted.lateral, hinted.height), (Length::Micrometre, Length::Millimetre));
        assert!(hinted.preview.reading[2].contains("as asked for, and not in nm"), "{:?}", hinted.preview.reading);
    }

    #[test]
    fn what_is_no_table_is_refused_by_line_and_column() {
        for (text, expected) in [
            ("x,z\n1,2\n3,4,5\n", "line 3 has 3 columns, and the first 2"),
            ("1;2\n3;four\n", "line 2, column 2: `four` is not a number"),
            ("a header\n", "no rows"),
            ("1\n2\n", "a single column"),
            ("1,2\n,2\n", "line 2, column 1: a place is missing"),
            ("1 2 3 4\n5 6 7 8\n", "4 columns are a matrix of heights"),
        ] {
            let error = read_scan(text.as_bytes(), &ScanHints::default()).unwrap_err().to_string();
            assert!(error.contains(expected), "{text}: {error}");
        }
    }

    #[test]
    fn a_matrix_of_gwyddion_has_its_size_from_the_header_and_is_thinned() {
        let row = |first: usize| (0..8).map(|index| format!("{}e-9", first + index)).collect::<Vec<_>>().join("\t");
        let rows = (0..4).map(row).collect::<Vec<_>>().join("\n");
        let text = format!("# Channel: Height\n# Width: 16.0 µm\n# Height: 0.012 mm\n# Value units: m\n{rows}\n");
        let file = read(&text);
        assert_eq!((file.lateral, file.height), (Length::Micrometre, Length::Metre));
        let Places::Map { dx, dy, z } = &file.places else { panic!("{file:?}") };
        assert!((dx - 2.0).abs() < 1e-12 && (dy - 3.0).abs() < 1e-12 && (z.len(), z[0].len()) == (4, 8));
        let thinned = read_scan(text.as_bytes(), &ScanHints { most: 10, ..ScanHints::default() }).unwrap();
        let Places::Map { dx, dy, z } = &thinned.places else { panic!("{thinned:?}") };
        assert!((dx - 4.0).abs() < 1e-12 && (dy - 6.0).abs() < 1e-12 && (z.len(), z[0].len()) == (2, 4));
        assert_eq!(z[1][1], Some(4e-9));
        assert!(
            thinned.preview.reading.last().unwrap().contains("One height in 2 along each side is kept: 4 x 2 heights"),
            "{:?}",
            thinned.preview.reading
        );
    }

    #[test]
    fn a_list_over_the_limit_is_thinned_and_says_so() {
        let text: String = (0..10).map(|index| format!("{index};{index}\n")).collect();
        let file = read_scan(text.as_bytes(), &ScanHints { most: 4, ..ScanHints::default() }).unwrap();
        assert_eq!(
            file.places,
            Places::Line { x: vec![0.0, 3.0, 6.0, 9.0], z: [0.0, 3.0, 6.0, 9.0].map(Some).to_vec() }
        );
        assert_eq!(file.preview.thinned, 3);
        assert_eq!(file.preview.reading.last().unwrap(), "One height in 3 is kept: 4 of 10 heights.");
    }

    #[test]
    fn a_number_that_stands_for_no_height_is_missing_if_it_is_declared_or_far_from_all() {
        let heights = |text: &str| match read(text).places {
            Places::Line { z, .. } => z,
            other => panic!("{other:?}"),
        };
        let (some, all) = (vec![Some(-1.5), Some(2.0), None], vec![Some(-9000.0), Some(-8000.0), Some(-9999.0)]);
        assert_eq!(heights("x;z\n1;-1.5\n2;2\n3;-9999\n"), some);
        assert_eq!(heights("x;z\n1;-9000\n2;-8000\n3;-9999\n"), all);
        assert_eq!(heights("NODATA_value 77\nx z\n1 -1.5\n2 2\n3 77\n"), some);
    }

    #[test]
    fn a_preview_says_how_the_file_is_written() {
        let Preview { encoding, separator, has_decimal_commas, rows, header, columns, .. } =
            read("Line 7\nX [um];Z [nm]\n12\n1,5;2\n3,5;No Data\n").preview;
        assert_eq!((encoding.as_str(), separator, has_decimal_commas, rows), ("UTF-8", "semicolon", true, 2));
        assert_eq!(header, ["Line 7", "X [um];Z [nm]", "12"]);
        assert_eq!(
            columns.iter().map(|column| column.name.as_deref()).collect::<Vec<_>>(),
            [Some("X [um]"), Some("Z [nm]")]
        );
    }

    #[test]
    fn a_text_of_zygo_has_pixels_micrometres_and_points_without_data() {
        let header = "Zygo XYZ Data File - Format 2\n0 0 0 0 \"\"\n0 0 0 0 0 0\n0 0 2 2\n\"\"\n\"\"\n\"\"\n\
                      0 0.5 6.3e-7 0 1 0 2.5e-6 0\n0 0 0 0 0 0 \"\"\n0 0\n0 0\n0 \"\"\n0 0\n\"\"\n#\n";
        let file = read(&format!("{header}0 0 0.125\n1 0 No Data\n0 1 0.25\n1 1 0.5\n#\n"));
        let z = vec![Some(0.125), None, Some(0.25), Some(0.5)];
        assert_eq!(
            file.places,
            Places::Points { x: vec![0.0, 2.5e-6, 0.0, 2.5e-6], y: vec![0.0, 0.0, 2.5e-6, 2.5e-6], z }
        );
        assert_eq!((file.lateral, file.height), (Length::Metre, Length::Micrometre));
    }
}
