//! A scan in a file: heights along a line, at points, or in a matrix.

use super::columns::Needed;
use super::error::{Candidate, ImportError};
use super::grid;
use super::label::Mention;
use super::mapping::{Mapping, Origin};
use super::matrix;
use super::names::{Axis, axis};
use super::number::{Mark, number};
use super::preview::{ColumnUnit, Preview};
use super::roles::{base, settled};
use super::sheet::Sheet;
use super::source::Source;
use super::units::Length;

/// Most columns of a list of places and heights without names; wider tables are matrices.
pub(super) const MOST_COLUMNS: usize = 3;

/// Numbers that stand for no height, by custom: of grids, and the ends of whole numbers.
const FILLS: [f64; 8] = [-9999.0, -99999.0, -999.0, 9999.0, 99999.0, -32768.0, 32767.0, -2_147_483_648.0];
/// How many times the range of the heights such a number is away from them.
const FAR: f64 = 10.0;

pub(super) const LATERAL: Needed = Needed::length("lateral");
pub(super) const HEIGHT: Needed = Needed::length("height");

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
    /// The unit of places; metres where neither the file nor a mapping names one.
    pub lateral: Length,
    /// The unit of heights.
    pub height: Length,
    /// What was taken for what.
    pub preview: Preview,
}

/// What was read of the places: the mapping, the largest number of heights (zero: no bound), and whom to ask whether to
/// go on.
pub(super) struct Wanted<'a> {
    pub(super) mapping: &'a Mapping,
    pub(super) most: usize,
    pub(super) proceed: &'a dyn Fn() -> bool,
}

/// Reads a scan: columns with places and heights, by their names or in the order x, z or x, y, z; or a matrix of
/// heights, as Gwyddion exports it, perhaps with its places in the first row and column. The text formats of Zygo's
/// instruments, of ISO 25178-71, of ISO 5436-2 and of grids (ESRI, Surfer) are known by their first line. What
/// `mapping` says precedes what the file says. A file with more than `most` heights is thinned (zero: never). Work ends
/// as soon as `proceed` says no.
///
/// # Errors
/// [`ImportError`] if the bytes are no such table, by line and column, or if the file may mean several things.
pub fn read_scan(
    bytes: &[u8],
    mapping: &Mapping,
    most: usize,
    proceed: &dyn Fn() -> bool,
) -> Result<ScanFile, ImportError> {
    let sources = Source::all(bytes, mapping.sheet.as_deref())?;
    let wanted = Wanted { mapping, most, proceed };
    super::sheets::one_of(&sources, mapping, proceed, |source| of_source(source, &wanted))
}

fn of_source(source: &Source<'_>, wanted: &Wanted<'_>) -> Result<ScanFile, ImportError> {
    if let Some(grid) = grid::read(source, wanted) {
        return grid;
    }
    let mut sheet = Sheet::parse(&source.text, source.sheet.is_some(), wanted.mapping, wanted.proceed)?;
    let mut preview = Preview::of(&sheet, source);
    let is_zygo = sheet.header.first().is_some_and(|(_, line)| line.starts_with("Zygo"));
    let mut entries = Vec::new();
    let found = if is_zygo && sheet.width == MOST_COLUMNS {
        zygo(&mut sheet, wanted, &mut preview)
    } else if let Some(columns) = Columns::of(&mut sheet, wanted.mapping)? {
        list(&mut sheet, wanted, &columns, &mut preview, &mut entries)
    } else {
        matrix::read(&mut sheet, wanted, &mut preview, &mut entries)
    };
    let (places, lateral, height) = found.map_err(|error| settled(error, wanted.mapping))?;
    preview.account(&sheet, source, entries);
    // Its places are pixels, which no mapping says.
    if is_zygo {
        preview.mapping = wanted.mapping.entries().join(";");
    }
    Ok(ScanFile { places, lateral, height, preview })
}

/// The unit of an axis that is said: its own, or that of all.
pub(super) fn unit_said<'a>(mapping: &'a Mapping, axis: &str, all: &str) -> Option<&'a super::UnitHint> {
    mapping.unit(axis).or_else(|| mapping.unit(all))
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
    fn of(sheet: &mut Sheet<'_>, mapping: &Mapping) -> Result<Option<Columns>, ImportError> {
        let wanted = |axis: &str| match mapping.origin(axis) {
            Some(Origin::Column(name)) => {
                let fault =
                    || ImportError::of_file(format!("there is no column `{name:.40}` among {} columns", sheet.width));
                sheet.find_column(name).map(Some).ok_or_else(fault)
            }
            _ => Ok(None),
        };
        let (mut x, mut y, mut z) = (wanted("x")?, wanted("y")?, wanted("z")?);
        let has_no_y = mapping.origin("y") == Some(&Origin::Nothing);
        let is_wanted = x.is_some() || z.is_some();
        let axes: Vec<Axis> = (0..sheet.width).map(|column| axis_of(sheet, column)).collect();
        let is_list = axes.contains(&Axis::Z) && axes.contains(&Axis::X);
        let numeric = sheet.is_text.iter().filter(|is_text| !**is_text).count();
        let known = axes.iter().filter(|axis| matches!(axis, Axis::X | Axis::Y | Axis::Z | Axis::Unknown)).count();
        if numeric > MOST_COLUMNS && known > MOST_COLUMNS && !is_list && !is_wanted {
            return Ok(None);
        }
        if x.is_none() || z.is_none() {
            sheet.check_names()?;
        }
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
        // A profile over x whose heights are called y.
        let is_profile =
            z.is_none() && y.is_none() && open.len() == 2 - usize::from(x.is_some()) && !axes.contains(&Axis::Z);
        if is_profile && let Some(at) = open.iter().position(|column| axes[*column] == Axis::Y) {
            z = Some(open.remove(at));
        }
        // A column with the unit of something else is no place and no height while there are others.
        let excluded = |column: &usize| {
            let (axis, all) = if axes[*column] == Axis::Z { ("z", "height") } else { ("x", "lateral") };
            unit_said(mapping, axis, all).is_none() && LATERAL.excludes(&sheet.labels[*column].unit)
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
        if !has_no_y {
            take(&mut y, Axis::Y);
        }
        if x.is_none() {
            take(&mut x, Axis::Unknown);
        }
        if let Some(other) = open
            .iter()
            .find(|column| axes[**column] == Axis::X)
            .filter(|_| y.is_none() && mapping.origin("x").is_none())
        {
            let both = [x.unwrap_or(0), *other];
            let [one, two] = both.map(|column| format!("{} (column {})", sheet.title(column), column + 1));
            let fault = format!("{one} and {two} may both be the place along the line: choose one by `x`");
            return Err(ImportError::ambiguous(
                fault,
                both.map(|column| candidate(sheet, mapping, "x", column)).to_vec(),
            ));
        }
        if z.is_none() {
            z = open.pop();
        }
        // The other of three columns without a name that says otherwise.
        let is_place = |column: &usize| {
            axes[*column] == Axis::Unknown && (!is_list || matches!(sheet.labels[*column].unit, Mention::Known(..)))
        };
        if y.is_none() && !has_no_y && open.len() == 1 && !is_wanted && is_place(&open[0]) {
            y = open.pop();
        }
        let same = |column: &&usize| z.is_some_and(|z| axes[**column] == Axis::Z && are_alike(sheet, z, **column));
        if let (Some(z), Some(other), None) = (z, open.iter().find(same), mapping.origin("z")) {
            let both = [z, *other];
            let [one, two] = both.map(|column| format!("{} (column {})", sheet.title(column), column + 1));
            let fault = format!("{one} and {two} may both be the height: choose one by `z`");
            return Err(ImportError::ambiguous(
                fault,
                both.map(|column| candidate(sheet, mapping, "z", column)).to_vec(),
            ));
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
fn counts_rows(sheet: &mut Sheet<'_>) -> Result<bool, ImportError> {
    let numbers = sheet.numbers(&[0])?.columns.remove(0);
    let first = numbers.first().copied().flatten().filter(|first| [0.0, 1.0].contains(first));
    let counts = |first: f64| numbers.iter().enumerate().all(|(row, number)| *number == Some(first + row as f64));
    Ok(numbers.len() > 2 && first.is_some_and(counts))
}

/// One of the columns that may be an axis.
fn candidate(sheet: &Sheet<'_>, mapping: &Mapping, axis: &'static str, column: usize) -> Candidate {
    let unit =
        if let Mention::Known(_, text) = &sheet.labels[column].unit { format!(":{text}") } else { String::new() };
    Candidate {
        quantity: axis,
        column: Some(column + 1),
        name: sheet.name(column).unwrap_or("").to_owned(),
        values: sheet.first_values(column),
        mapping: base(mapping, &[], &format!("{axis}:{}{unit}", column + 1)),
    }
}

/// Whether two columns have the same name, but for what numbers them.
fn are_alike(sheet: &Sheet<'_>, one: usize, other: usize) -> bool {
    let plain = |column: usize| {
        let name = sheet.labels[column].name.to_lowercase();
        name.trim_end_matches(|letter: char| letter.is_ascii_digit() || " _-#".contains(letter)).to_owned()
    };
    plain(one) == plain(other)
}

/// The rows of a list that are kept, and the stride.
fn stride(rows: usize, most: usize, preview: &mut Preview) -> usize {
    let stride = if most == 0 { 1 } else { rows.div_ceil(most).max(1) };
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
    sheet: &mut Sheet<'_>,
    columns: &[usize],
    wanted: &Wanted<'_>,
    preview: &mut Preview,
) -> Result<Heights, ImportError> {
    let found = sheet.numbers(columns)?;
    preview.written(sheet, found.mark);
    let mut z = found.columns;
    let mut last = z.pop().unwrap_or_default();
    let fill = fill_value(sheet, last.iter().copied().flatten(), preview);
    last.iter_mut().filter(|height| height.is_some() && **height == fill).for_each(|height| *height = None);
    let is_empty = |row: &usize| last[*row].is_none() && z.iter().all(|axis| axis[*row].is_none());
    let empty: Vec<usize> = (0..sheet.len()).filter(is_empty).collect();
    let lines: Vec<usize> = empty.iter().map(|row| sheet.line(*row)).collect();
    preview.leave_out_rows(&lines, "they have no number");
    let rows: Vec<usize> = (0..sheet.len()).filter(|row| empty.binary_search(row).is_err()).collect();
    let step = stride(rows.len(), wanted.most, preview);
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
pub(super) fn fill_value(
    sheet: &Sheet<'_>,
    heights: impl Iterator<Item = f64> + Clone,
    preview: &mut Preview,
) -> Option<f64> {
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

/// Places and heights, and the units of both.
pub(super) type Found = (Places, Length, Length);

fn list(
    sheet: &mut Sheet<'_>,
    wanted: &Wanted<'_>,
    columns: &Columns,
    preview: &mut Preview,
    entries: &mut Vec<String>,
) -> Result<Found, ImportError> {
    let Columns { x, y, z, left_out } = columns;
    let order: Vec<usize> = [Some(*x), *y, Some(*z)].into_iter().flatten().collect();
    let zeros = if wanted.mapping.number("last_line").is_some() { 0 } else { sheet.leave_out_zeros(&order, false) };
    preview.rows = sheet.len();
    let Heights { mut axes, z: heights } = heights(sheet, &order, wanted, preview)?;
    if heights.iter().all(Option::is_none) {
        let fault = format!("{} has no numbers: choose another column by `z` in `mapping`", sheet.title(*z));
        return Err(ImportError { column: Some(z + 1), ..ImportError::of_file(fault) });
    }
    let mut take = |column: usize, axis: &'static str, needed: Needed, all: &str| {
        let hint = unit_said(wanted.mapping, axis, all);
        let unit = needed.unit(sheet, column, hint)?;
        preview.take(column, axis, &unit);
        preview.reading.push(needed.sentence(sheet, column, axis, &unit, hint));
        if unit.is_assumed {
            preview.assumed.push(format!("The unit of {axis} is {}: nothing names another one.", unit.text));
        }
        entries.push(format!("{axis}:{}:{}", column + 1, unit.text));
        Ok::<ColumnUnit, ImportError>(unit)
    };
    let x_unit = take(*x, "x", LATERAL, "lateral")?;
    let y_unit = y.map(|y| take(y, "y", LATERAL, "lateral")).transpose()?;
    let z_unit = take(*z, "z", HEIGHT, "height")?;
    if y.is_none() {
        entries.push("y:none".to_owned());
    }
    if zeros > 0 {
        let first = (0..sheet.kinds.len()).find(|line| sheet.kinds[*line] == super::LineKind::Zeros);
        preview.say_zeros(zeros, first.map_or(0, |line| sheet.table.number(line)));
    }
    if matches!(axis_of(sheet, *z), Axis::Y) {
        preview.assumed.push(format!("{} is the height over x, because there is no other one.", sheet.title(*z)));
    }
    for (column, reason) in left_out {
        preview.leave_out(*column, *reason);
        if *reason != "text" {
            let name = sheet.name(*column).map_or_else(String::new, |name| format!(", `{name}`,"));
            preview.reading.push(format!("Column {}{name} is left out: {reason}.", column + 1));
        }
    }
    let (lateral, height) = (Length::nearest(x_unit.unit), Length::nearest(z_unit.unit));
    for (axis, unit) in axes.iter_mut().zip(std::iter::once(&x_unit).chain(&y_unit)) {
        axis.iter_mut().for_each(|place| *place = unit.unit.convert(*place, lateral.unit()));
    }
    let z = heights.into_iter().map(|value| value.map(|value| z_unit.unit.convert(value, height.unit()))).collect();
    let other = (axes.len() > 1).then(|| axes.pop()).flatten();
    let x = axes.pop().unwrap_or_default();
    let places = match other {
        Some(y) => Places::Points { x, y, z },
        None => Places::Line { x, z },
    };
    Ok((places, lateral, height))
}

/// A text of Zygo's MetroPro: pixels and heights in micrometres; the seventh number of the eighth line is the size of a
/// pixel in metres.
fn zygo(sheet: &mut Sheet<'_>, wanted: &Wanted<'_>, preview: &mut Preview) -> Result<Found, ImportError> {
    let mapping = wanted.mapping;
    let size = sheet.header.get(7).and_then(|(_, line)| line.split_whitespace().nth(6)?.parse::<f64>().ok());
    let in_hint = mapping.spacing.map(|[spacing, _]| LATERAL.beside(mapping.unit("lateral")).unit.to_si(spacing));
    let pixel = in_hint.or(size.filter(|size| *size > 0.0)).ok_or_else(|| {
        ImportError::of_file(
            "the size of a pixel is not in the header of this export: give `spacing`, the distance of neighbours",
        )
    })?;
    let unit = match mapping.unit("height") {
        hint @ Some(_) => HEIGHT.beside(hint),
        None => HEIGHT.named("um", None, None)?,
    };
    let height = Length::nearest(unit.unit);
    preview.reading.push(format!("Zygo's text format: x and y are pixels of {:.6} um.", pixel * 1e6));
    preview.reading.push(format!("z is column 3, in {}.", unit.text));
    for (column, quantity) in ["x", "y"].into_iter().enumerate() {
        preview.take(column, quantity, &ColumnUnit { text: "pixel".to_owned(), ..unit.clone() });
    }
    preview.take(2, "z", &unit);
    let Heights { mut axes, z } = heights(sheet, &[0, 1, 2], wanted, preview)?;
    axes.iter_mut().flatten().for_each(|place| *place *= pixel);
    let z = z.into_iter().map(|value| value.map(|value| unit.unit.convert(value, height.unit()))).collect();
    let (y, x) = (axes.pop().unwrap_or_default(), axes.pop().unwrap_or_default());
    Ok((Places::Points { x, y, z }, Length::Metre, height))
}
