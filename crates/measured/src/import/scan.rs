//! A scan in a file: heights along a line, at points, or in a matrix.

use super::encoding::decode;
use super::preview::Preview;
use super::sheet::{ImportError, Sheet};
use super::units::Length;

/// Most columns of a list of places and heights; wider tables are matrices.
const MOST_COLUMNS: usize = 3;

/// What is known of a scan beside its file. It precedes what the file says.
#[derive(Clone, Copy, Debug, Default)]
pub struct ScanHints {
    /// The unit of places.
    pub lateral: Option<Length>,
    /// The unit of heights.
    pub height: Option<Length>,
    /// The distance of neighbours in a matrix, in the unit of places.
    pub spacing: Option<f64>,
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

/// Reads a scan: two columns are x and z of a line, three are x, y and z, and more are a matrix, as Gwyddion exports
/// it. The text format of Zygo's instruments is known by its first line.
///
/// # Errors
/// [`ImportError`] if the bytes are no such table, by line and column.
pub fn read_scan(bytes: &[u8], hints: &ScanHints) -> Result<ScanFile, ImportError> {
    let (text, encoding) = decode(bytes);
    let sheet = Sheet::parse(&text)?;
    let preview = Preview::of(&sheet, encoding);
    match sheet.width() {
        MOST_COLUMNS if sheet.header.first().is_some_and(|line| line.trim().starts_with("Zygo")) => {
            zygo(&sheet, hints, preview)
        }
        width if width <= MOST_COLUMNS => columns(&sheet, hints, preview),
        _ => matrix(&sheet, hints, preview),
    }
}

/// The unit of a column, and a sentence that says where it comes from.
fn unit_of(sheet: &Sheet, column: usize, name: &str, hint: Option<Length>) -> (Length, String) {
    let said = sheet.unit(column, Length::named);
    let title = sheet.name(column).map_or_else(|| format!("column {}", column + 1), |title| format!("`{title}`"));
    let unit = hint.or(said).unwrap_or(Length::Metre);
    let why = match (hint, said) {
        (Some(hint), Some(said)) if hint != said => format!(", as was asked, and not in {}", said.symbol()),
        (None, None) => ", because nothing names another unit".to_owned(),
        _ => String::new(),
    };
    (unit, format!("{name} is {title}, in {}{why}.", unit.symbol()))
}

/// The rows of a list that are kept, and every how manyth that is.
fn kept<'a>(sheet: &'a Sheet, hints: &ScanHints, preview: &mut Preview) -> Vec<(usize, &'a [Option<f64>])> {
    let rows = sheet.lines.len();
    let every = if hints.most == 0 { 1 } else { rows.div_ceil(hints.most).max(1) };
    if every > 1 {
        preview.thinned = every;
        preview.reading.push(format!("Thinned {every} times, to {} of {rows} heights.", rows.div_ceil(every)));
    }
    sheet.numbered().step_by(every).collect()
}

fn place(line: usize, row: &[Option<f64>], column: usize) -> Result<f64, ImportError> {
    row[column].ok_or_else(|| ImportError::at(line, column + 1, "a place is missing"))
}

fn columns(sheet: &Sheet, hints: &ScanHints, mut preview: Preview) -> Result<ScanFile, ImportError> {
    let last = sheet.width() - 1;
    let (lateral, of_x) = unit_of(sheet, 0, "x", hints.lateral);
    let (height, of_z) = unit_of(sheet, last, "z", hints.height);
    let is_assumed = |column, hint: Option<Length>| hint.or(sheet.unit(column, Length::named)).is_none();
    preview.take(0, "x", lateral.symbol(), is_assumed(0, hints.lateral));
    preview.take(last, "z", height.symbol(), is_assumed(last, hints.height));
    preview.reading.push(of_x);
    if last == 2 {
        let (other, of_y) = unit_of(sheet, 1, "y", hints.lateral);
        if other != lateral {
            let units = format!("x is in {} and y in {}: give one unit of places", lateral.symbol(), other.symbol());
            return Err(ImportError::of_file(units));
        }
        preview.take(1, "y", lateral.symbol(), is_assumed(1, hints.lateral));
        preview.reading.push(of_y);
    }
    preview.reading.push(of_z);
    let rows = kept(sheet, hints, &mut preview);
    let axis = |column: usize| rows.iter().map(|(line, row)| place(*line, row, column)).collect::<Result<Vec<_>, _>>();
    let z = rows.iter().map(|(_, row)| row[last]).collect();
    let places =
        if last == 1 { Places::Line { x: axis(0)?, z } } else { Places::Points { x: axis(0)?, y: axis(1)?, z } };
    Ok(ScanFile { places, lateral, height, preview })
}

/// A text of Zygo's MetroPro: pixels and heights in micrometres; the seventh number of the eighth line is the size of a
/// pixel in metres.
fn zygo(sheet: &Sheet, hints: &ScanHints, mut preview: Preview) -> Result<ScanFile, ImportError> {
    let size = sheet.header.get(7).and_then(|line| line.split_whitespace().nth(6)?.parse::<f64>().ok());
    let in_hint = hints.spacing.map(|spacing| spacing * hints.lateral.unwrap_or(Length::Metre).factor());
    let pixel = in_hint.or(size.filter(|size| *size > 0.0)).ok_or_else(|| {
        ImportError::of_file("the size of a pixel is not in the header of this export: give the distance of neighbours")
    })?;
    let height = hints.height.unwrap_or(Length::Micrometre);
    let micrometres = pixel / Length::Micrometre.factor();
    preview.reading.push(format!("Zygo's text format: x and y are pixels of {micrometres:.6} um."));
    preview.reading.push(format!("z is column 3, in {}.", height.symbol()));
    for (column, quantity) in ["x", "y"].into_iter().enumerate() {
        preview.take(column, quantity, "pixel", false);
    }
    preview.take(2, "z", height.symbol(), false);
    let rows = kept(sheet, hints, &mut preview);
    let axis = |column: usize| {
        rows.iter().map(|(line, row)| Ok(pixel * place(*line, row, column)?)).collect::<Result<Vec<_>, ImportError>>()
    };
    let z = rows.iter().map(|(_, row)| row[2]).collect();
    Ok(ScanFile { places: Places::Points { x: axis(0)?, y: axis(1)?, z }, lateral: Length::Metre, height, preview })
}

/// A number and a unit behind a name in the header, as in `Width: 10.0 um`.
fn measure(sheet: &Sheet, name: &str) -> Option<(f64, Length)> {
    let line = sheet.header.iter().find_map(|line| line.trim().strip_prefix(name))?;
    let value = line.trim_start_matches([':', '=', ' ', '\t']);
    let number = value.split_whitespace().next()?.replace(',', ".").parse().ok()?;
    Some((number, Length::named(value)?))
}

/// A matrix of heights: its size from the header, or the distance of neighbours from a hint.
fn matrix(sheet: &Sheet, hints: &ScanHints, mut preview: Preview) -> Result<ScanFile, ImportError> {
    let (rows, width) = (sheet.lines.len(), sheet.width());
    let (lateral, dx, dy, why) = match (hints.spacing, measure(sheet, "Width"), measure(sheet, "Height")) {
        (Some(spacing), ..) => {
            let unit = hints.lateral.unwrap_or(Length::Metre);
            (unit, spacing, spacing, format!("Neighbours are {spacing} {} apart, as was asked.", unit.symbol()))
        }
        (None, Some((wide, unit)), Some((high, other))) => {
            let (dx, dy) = (wide / width as f64, high * other.factor() / unit.factor() / rows as f64);
            (unit, dx, dy, format!("{wide} {} by {high} {}, from the header.", unit.symbol(), other.symbol()))
        }
        _ => {
            return Err(ImportError::of_file(format!(
                "{width} columns are a matrix of heights: give the distance of its neighbours, or its `Width` and \
                 `Height` in the header"
            )));
        }
    };
    let said = sheet.header.iter().find_map(|line| line.trim().strip_prefix("Value units"));
    let height = hints.height.or_else(|| Length::named(said?)).unwrap_or(Length::Metre);
    preview.reading.push(format!("A matrix of {width} x {rows} heights in {}.", height.symbol()));
    preview.reading.push(why);
    let every = thinning(width, rows, hints.most);
    let z: Vec<Vec<Option<f64>>> =
        sheet.rows().step_by(every).map(|row| row.iter().copied().step_by(every).collect()).collect();
    if every > 1 {
        let kept = format!("{} x {}", z[0].len(), z.len());
        preview.thinned = every;
        preview.reading.push(format!("Thinned {every} times along both sides, to {kept} heights."));
    }
    let step = every as f64;
    Ok(ScanFile { places: Places::Map { dx: step * dx, dy: step * dy, z }, lateral, height, preview })
}

/// The smallest step with which a matrix has no more heights than that.
fn thinning(width: usize, rows: usize, most: usize) -> usize {
    let kept = |every: usize| width.div_ceil(every) * rows.div_ceil(every);
    if most == 0 { 1 } else { (1..).find(|every| kept(*every) <= most).unwrap_or(1) }
}

#[cfg(test)]
mod tests {
    use super::{Length, Places, Preview, ScanFile, ScanHints, read_scan};

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
        let hints = ScanHints { height: Some(Length::Millimetre), ..ScanHints::default() };
        let hinted = read_scan(b"X [um];Z [nm]\n1;2\n", &hints).unwrap();
        assert_eq!((hinted.lateral, hinted.height), (Length::Micrometre, Length::Millimetre));
        assert!(hinted.preview.reading[2].contains("as was asked, and not in nm"), "{:?}", hinted.preview.reading);
    }

    #[test]
    fn what_is_no_table_is_refused_by_line_and_column() {
        for (text, said) in [
            ("x,z\n1,2\n3,4,5\n", "line 3 has 3 columns, and the first 2"),
            ("1;2\n3;four\n", "line 2, column 2: `four` is not a number"),
            ("a header\n", "no rows"),
            ("1\n2\n", "1 columns"),
            ("1,2\n,2\n", "line 2, column 1: a place is missing"),
            ("x [um],y [mm],z [nm]\n1,2,3\n", "x is in um and y in mm"),
            ("1 2 3 4\n5 6 7 8\n", "4 columns are a matrix of heights"),
        ] {
            let error = read_scan(text.as_bytes(), &ScanHints::default()).unwrap_err().to_string();
            assert!(error.contains(said), "{text}: {error}");
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
            thinned.preview.reading.last().unwrap().contains("Thinned 2 times along both sides, to 4 x 2 heights"),
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
        assert_eq!(file.preview.reading.last().unwrap(), "Thinned 3 times, to 4 of 10 heights.");
    }

    #[test]
    fn a_preview_says_how_the_file_is_written() {
        let Preview { encoding, separator, has_decimal_commas, rows, header, columns, .. } =
            read("Line 7\nX [um];Z [nm]\n12\n1,5;2\n3,5;No Data\n").preview;
        assert_eq!((encoding, separator, has_decimal_commas, rows), ("UTF-8", "semicolon", true, 2));
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
