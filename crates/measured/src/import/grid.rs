//! Heights with a header of their own, as text: grids of ISO 25178-71 (`.sdf`), of ESRI (`.asc`) and of Surfer
//! (`.grd`), and profiles of ISO 5436-2 (`.smd`).

use super::error::ImportError;
use super::lines::lines;
use super::matrix::thinned;
use super::number::{Mark, is_missing, is_no_value, number};
use super::preview::Preview;
use super::scan::{HEIGHT, LATERAL, Places, ScanFile, Wanted, say_missing};
use super::sheet::LineKind;
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
pub(super) fn read(source: &Source<'_>, wanted: &Wanted<'_>) -> Option<Result<ScanFile, ImportError>> {
    let text = source.text.trim_start_matches('\u{feff}');
    let header = match text.split_whitespace().next()?.to_lowercase().as_str() {
        // The first format by that name, and its successor.
        "aiso-1.0" | "aiso-2.0" | "abcr-1.0" | "abcr-2.0" => iso(text),
        "iso" if text.contains("\nCX ") && text.contains("\nCZ ") => return Some(profile(source, text, wanted)),
        "dsaa" => surfer(text),
        "ncols" => esri(text),
        _ => return None,
    };
    Some(header.and_then(|header| grid(source, text, &header, wanted)))
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

/// ISO 5436-2: records that end with `EOR`, of which the first has the axes, and the third the heights.
fn profile(source: &Source<'_>, text: &str, wanted: &Wanted<'_>) -> Result<ScanFile, ImportError> {
    let all: Vec<(usize, &str)> = lines(text).map(|(line, text)| (line, text.trim())).collect();
    let ends: Vec<usize> = (0..all.len()).filter(|index| all[*index].1.eq_ignore_ascii_case("EOR")).collect();
    let [_, second, third, ..] = ends[..] else {
        return Err(ImportError::of_file("the records of this profile are not closed by `EOR`"));
    };
    // Of an axis: whether its values are there (`A`) or counted (`I`), how many, their unit, and the size of a step.
    let axis = |name: &str| {
        let words = |(line, text): &(usize, &str)| {
            let words: Vec<String> = text.split_whitespace().map(str::to_owned).collect();
            (words.first().map(String::as_str) == Some(name)).then_some((*line, words))
        };
        let missing = || ImportError::of_file(format!("the header has no `{name}`"));
        let (line, words) = all.iter().find_map(words).ok_or_else(missing)?;
        let step = words.get(4).and_then(|step| number(step, Mark::Point)).filter(|step| *step > 0.0);
        let fault = || ImportError::at_line(line, format!("does not say the axis as `{name} A 25 nm 1.0E-2`"));
        let (kind, count) =
            words.get(1).zip(words.get(2).and_then(|count| count.parse::<usize>().ok())).ok_or_else(fault)?;
        Ok::<_, ImportError>((
            kind.clone(),
            count,
            words.get(3).cloned().ok_or_else(fault)?,
            step.ok_or_else(fault)?,
            line,
        ))
    };
    let (kind, _, x_unit, dx, x_line) = axis("CX")?;
    let (_, count, z_unit, dz, z_line) = axis("CZ")?;
    if kind != "I" {
        return Err(ImportError::at_line(x_line, "has places of its own, which are not read: export x and z as CSV"));
    }
    let unit = |needed: super::columns::Needed, said: &str, text: &str, line: usize| match wanted.mapping.unit(said) {
        hint @ Some(_) => Ok(needed.beside(hint)),
        None => needed.named(text, Some(line), None),
    };
    let (x_unit, z_unit) = (unit(LATERAL, "lateral", &x_unit, x_line)?, unit(HEIGHT, "height", &z_unit, z_line)?);
    let (lateral, height) = (Length::nearest(x_unit.unit), Length::nearest(z_unit.unit));
    let mut z = Vec::new();
    for (line, text) in &all[second + 1..third] {
        let value = number(text, Mark::Point).filter(|value| !is_no_value(*value));
        if value.is_none() && !is_missing(text) {
            return Err(ImportError::at_line(*line, format!("`{text:.40}` is not a number")));
        }
        z.push(value.map(|value| z_unit.unit.convert(dz * value, height.unit())));
    }
    if z.len() != count {
        return Err(ImportError::at_line(z_line, format!("says {count} heights, and {} follow", z.len())));
    }
    let stride = if wanted.most == 0 { 1 } else { count.div_ceil(wanted.most).max(1) };
    let x = (0..count).step_by(stride).map(|index| x_unit.unit.convert(dx * index as f64, lateral.unit())).collect();
    let z: Vec<Option<f64>> = z.into_iter().step_by(stride).collect();
    let mut preview = described(source, text, &all, all[second].0, all[third].0, wanted);
    preview.thinned = stride;
    preview.reading.push(format!("{}, ISO 5436-2: a profile of {count} heights.", source.encoding));
    preview.reading.push(format!("Places are {dx} {} apart, and heights counts of {dz} {}.", x_unit.text, z_unit.text));
    say_missing(z.iter().filter(|height| height.is_none()).count(), &mut preview);
    Ok(ScanFile { places: Places::Line { x, z }, lateral, height, preview })
}

/// A preview in which the lines up to one are header, and those from another on a trailer.
fn described(
    source: &Source<'_>,
    text: &str,
    all: &[(usize, &str)],
    header: usize,
    trailer: usize,
    wanted: &Wanted<'_>,
) -> Preview {
    let filled = || all.iter().filter(|(_, text)| !text.trim().is_empty()).map(|(line, _)| *line);
    let mut preview = Preview {
        encoding: source.encoding.clone(),
        separator: "white_space".to_owned(),
        rows: filled().filter(|line| *line > header && *line < trailer).count(),
        header: lines(text).take(header.min(SHOWN)).map(|(_, line)| line.trim().chars().take(200).collect()).collect(),
        rows_left_out: filled().filter(|line| *line <= header || *line >= trailer).collect(),
        thinned: 1,
        mapping: wanted.mapping.entries().join(";"),
        ..Preview::default()
    };
    let is_of = |kind: LineKind, line: usize| match kind {
        LineKind::Preamble => line <= header,
        LineKind::Data => line > header && line < trailer,
        _ => line >= trailer,
    };
    for kind in [LineKind::Preamble, LineKind::Remark, LineKind::Data] {
        let count = filled().filter(|line| is_of(kind, *line)).count();
        preview.lines.extend(filled().find(|line| is_of(kind, *line)).map(|first| (kind, count, first)));
    }
    preview
}

fn grid(source: &Source<'_>, text: &str, header: &Header, wanted: &Wanted<'_>) -> Result<ScanFile, ImportError> {
    let mapping = wanted.mapping;
    let Header { name, is_metric, columns, rows, dx, dy, scale, fill, lines: header_lines } = *header;
    let mut heights: Vec<Option<f64>> = Vec::new();
    let mut trailer = usize::MAX;
    for (line, text) in lines(text).skip_while(|(line, _)| *line <= header_lines) {
        // What follows the heights behind an asterisk is a trailer.
        if text.trim() == "*" && is_metric {
            trailer = line;
            break;
        }
        (wanted.proceed)().then_some(()).ok_or_else(ImportError::stopped)?;
        for (column, word) in text.split_whitespace().enumerate() {
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
    let (lateral_unit, unit) = (LATERAL.beside(mapping.unit("lateral")), HEIGHT.beside(mapping.unit("height")));
    let (mut lateral, mut height) = (Length::nearest(lateral_unit.unit), Length::nearest(unit.unit));
    if is_metric {
        lateral = if lateral_unit.is_assumed { Length::Micrometre } else { lateral };
        height = if unit.is_assumed { Length::Nanometre } else { height };
    }
    let all: Vec<(usize, &str)> = lines(text).collect();
    let mut preview = described(source, text, &all, header_lines, trailer, wanted);
    preview.rows = rows;
    let (dx, dy) = mapping.spacing.map_or((dx, dy), |[dx, dy]| (dx, dy));
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
    let z = thinned(rows, columns, wanted.most, value, &mut preview);
    let stride = preview.thinned as f64;
    Ok(ScanFile { places: Places::Map { dx: stride * step(dx), dy: stride * step(dy), z }, lateral, height, preview })
}
