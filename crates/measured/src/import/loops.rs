//! A loop in a file: displacement and force, and perhaps the time and the load.

use super::encoding::decode;
use super::preview::Preview;
use super::sheet::{ImportError, Sheet};
use super::units::{Force, Length, Time};

/// How much a load may differ from its mean and still be constant, as a part of it.
const CONSTANT: f64 = 0.05;

/// What headers call the columns, in lower case: the beginning of a word, or a whole word of up to two letters.
const DISPLACEMENTS: [&str; 6] = ["displacement", "position", "stroke", "deflection", "u", "x"];
const FORCES: [&str; 8] = ["force", "friction", "tangential", "lateral force", "shear force", "fx", "ft", "f"];
const TIMES: [&str; 2] = ["time", "t"];
const LOADS: [&str; 4] = ["normal", "load", "fn", "fz"];
/// Names that a refusal lists.
const LISTED: usize = 12;

/// A column by its number from 1 on, or by its name in the header, of which the beginning is enough.
pub type ColumnName = String;

/// What is known of a loop beside its file. It precedes what the file says.
#[derive(Clone, Debug, Default)]
pub struct LoopHints {
    /// The column of displacements; without it the one that is called so.
    pub displacement: Option<ColumnName>,
    /// The column of forces.
    pub force: Option<ColumnName>,
    /// The column of times; without it the one that is called so, if its times rise.
    pub time: Option<ColumnName>,
    /// The column of loads.
    pub load: Option<ColumnName>,
    /// The unit of displacements.
    pub displacement_unit: Option<Length>,
    /// The unit of forces.
    pub force_unit: Option<Force>,
}

/// What was read from a file.
#[derive(Clone, Debug, PartialEq)]
pub struct LoopFile {
    /// Displacements.
    pub displacement: Vec<f64>,
    /// Tangential forces, as many.
    pub force: Vec<f64>,
    /// Times, s, as many, if there is a column of them.
    pub time: Option<Vec<f64>>,
    /// The mean load, N, if there is a column of loads and they are constant.
    pub load: Option<f64>,
    /// The unit of displacements; metres where neither the file nor a hint names one.
    pub displacement_unit: Length,
    /// The unit of forces; newtons likewise.
    pub force_unit: Force,
    /// What was taken for what.
    pub preview: Preview,
}

/// Reads a loop from columns of text; a row that lacks one of its numbers is a gap.
///
/// # Errors
/// [`ImportError`] if the bytes are no such table, or if a column is not found, with the names of those that are there.
pub fn read_loop(bytes: &[u8], hints: &LoopHints) -> Result<LoopFile, ImportError> {
    let (text, encoding) = decode(bytes);
    let sheet = Sheet::parse(&text)?;
    let is_nameless = sheet.width() == 2 && called(&sheet, &FORCES).is_none();
    let (displacement, force) = match (&hints.displacement, &hints.force) {
        (None, None) if is_nameless => (0, 1),
        (displacement, force) => (
            column(&sheet, displacement.as_deref(), "displacement", &DISPLACEMENTS)?,
            column(&sheet, force.as_deref(), "force", &FORCES)?,
        ),
    };
    let free = |index: &usize| *index != displacement && *index != force;
    let time = match &hints.time {
        Some(name) => Some(column(&sheet, Some(name), "time", &TIMES)?),
        None => called(&sheet, &TIMES).filter(free),
    };
    let load = match &hints.load {
        Some(name) => Some(column(&sheet, Some(name), "load", &LOADS)?),
        None => called(&sheet, &LOADS).filter(free),
    };
    let mut file = LoopFile {
        displacement: Vec::new(),
        force: Vec::new(),
        time: time.map(|_| Vec::new()),
        load: None,
        displacement_unit: hints.displacement_unit.or(sheet.unit(displacement, Length::named)).unwrap_or(Length::Metre),
        force_unit: hints.force_unit.or(sheet.unit(force, Force::named)).unwrap_or(Force::Newton),
        preview: Preview::of(&sheet, encoding),
    };
    let time_unit = time.and_then(|time| sheet.unit(time, Time::named)).unwrap_or(Time::Second);
    let mut loads = Vec::new();
    for row in sheet.rows() {
        let at = time.map_or(Some(0.0), |time| row[time]);
        let (Some(u), Some(f), Some(at)) = (row[displacement], row[force], at) else { continue };
        file.displacement.push(u);
        file.force.push(f);
        file.time.iter_mut().for_each(|times| times.push(at * time_unit.factor()));
        loads.extend(load.and_then(|load| row[load]));
    }
    let gaps = sheet.lines.len() - file.displacement.len();
    let preview = &mut file.preview;
    let title =
        |index: usize| sheet.name(index).map_or_else(|| format!("column {}", index + 1), |name| format!("`{name}`"));
    let mut said = |quantity: &'static str, index: usize, unit: &'static str, is_assumed: bool| {
        preview.take(index, quantity, unit, is_assumed);
        preview.reading.push(format!("The {quantity} is {}, in {unit}.", title(index)));
    };
    let is_assumed = hints.displacement_unit.or(sheet.unit(displacement, Length::named)).is_none();
    said("displacement", displacement, file.displacement_unit.symbol(), is_assumed);
    let is_assumed = hints.force_unit.or(sheet.unit(force, Force::named)).is_none();
    said("force", force, file.force_unit.symbol(), is_assumed);
    if let Some(index) = time {
        let is_rising = file.time.as_ref().is_some_and(|times| times.is_sorted_by(|one, next| one < next));
        if is_rising || hints.time.is_some() {
            said("time", index, time_unit.symbol(), sheet.unit(index, Time::named).is_none());
        } else {
            file.time = None;
            preview.reading.push(format!("{} is the time, and not used, because it does not rise.", title(index)));
        }
    }
    if let Some(index) = load.filter(|_| !loads.is_empty()) {
        let unit = sheet.unit(index, Force::named).unwrap_or(Force::Newton);
        let mean = loads.iter().sum::<f64>() / loads.len() as f64;
        let is_constant = loads.iter().all(|one| (one - mean).abs() <= CONSTANT * mean.abs());
        file.load = Some(mean * unit.factor()).filter(|load| is_constant && *load > 0.0);
        if file.load.is_some() {
            preview.take(index, "normal_force", unit.symbol(), sheet.unit(index, Force::named).is_none());
        }
        let kept = if file.load.is_some() { "its mean is the load" } else { "not used, because it is not constant" };
        preview.reading.push(format!("{} is the load, in {}: {kept}.", title(index), unit.symbol()));
    }
    if gaps > 0 {
        preview.reading.push(format!("{gaps} rows lack a number and are gaps."));
    }
    Ok(file)
}

/// The index of a column by its number from 1 on, or by its name in the header.
fn find(sheet: &Sheet, name: &str) -> Option<usize> {
    if let Ok(number) = name.parse::<usize>() {
        return number.checked_sub(1).filter(|index| *index < sheet.width());
    }
    let name = name.to_lowercase();
    sheet.names().find_map(|names| {
        let names: Vec<String> = names.iter().map(|name| name.to_lowercase()).collect();
        let equal = names.iter().position(|one| *one == name);
        equal.or_else(|| names.iter().position(|one| one.starts_with(&name)))
    })
}

/// The index of the column that a header calls by one of some names, the first of them first.
fn called(sheet: &Sheet, names: &[&str]) -> Option<usize> {
    sheet.names().find_map(|cells| {
        let cells: Vec<String> = cells.iter().map(|cell| cell.trim().to_lowercase()).collect();
        let is = |cell: &str, name: &str| {
            let end = cell.strip_prefix(name).and_then(|rest| rest.chars().next());
            cell.starts_with(name) && (name.len() > 2 || !end.is_some_and(char::is_alphanumeric))
        };
        names.iter().find_map(|name| cells.iter().position(|cell| is(cell, name)))
    })
}

/// The column of this name or number or, without one, that which is called like the quantity.
fn column(sheet: &Sheet, name: Option<&str>, quantity: &str, names: &[&str]) -> Result<usize, ImportError> {
    let found = name.map_or_else(|| called(sheet, names), |name| find(sheet, name));
    found.ok_or_else(|| {
        let cells = sheet.names().next().map_or("no names".to_owned(), |names| {
            let more = if names.len() > LISTED { ", …" } else { "" };
            names[..names.len().min(LISTED)].join(", ").to_lowercase() + more
        });
        let name: String = name.unwrap_or(quantity).chars().take(40).collect();
        ImportError::of_file(format!("there is no column `{name}` among {} columns with {cells}", sheet.width()))
    })
}

#[cfg(test)]
mod tests {
    use super::{Force, Length, LoopHints, read_loop};

    #[test]
    fn columns_are_found_by_name_and_their_units_in_the_header() {
        let text =
            "Run 7\nTime (s);Displacement (um);Force (mN);Normal force (N)\n0,0;1,5;2;9,9\n1;;3;10\n2;2,5;4;10,1\n";
        let wide: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
        let hints = LoopHints { time: Some("time".to_owned()), ..LoopHints::default() };
        for bytes in [text.as_bytes(), &wide] {
            let file = read_loop(bytes, &hints).unwrap();
            assert_eq!((&file.displacement, &file.force), (&vec![1.5, 2.5], &vec![2.0, 4.0]));
            assert_eq!(file.time, Some(vec![0.0, 2.0]));
            assert_eq!((file.displacement_unit, file.force_unit), (Length::Micrometre, Force::Millinewton));
            assert!((file.load.unwrap() - 10.0).abs() < 1e-12, "{:?}", file.load);
            assert!(
                file.preview.reading.iter().any(|said| said.contains("1 rows lack a number")),
                "{:?}",
                file.preview.reading
            );
        }
    }

    #[test]
    fn other_names_of_the_columns_are_known_and_times_are_in_their_unit() {
        let file = read_loop(b"t [ms];Position [um];Friction [N];Fn [N]\n1;2;3;9\n2;4;5;9\n", &LoopHints::default());
        let file = file.unwrap();
        assert_eq!((&file.displacement, &file.force), (&vec![2.0, 4.0], &vec![3.0, 5.0]));
        assert_eq!((file.time, file.load), (Some(vec![1e-3, 2e-3]), Some(9.0)));
        let uses: Vec<_> = file.preview.columns.iter().map(|column| (column.quantity, column.unit)).collect();
        let used = |quantity, unit| (Some(quantity), Some(unit));
        assert_eq!(
            uses,
            [used("time", "ms"), used("displacement", "um"), used("force", "N"), used("normal_force", "N")]
        );
        // A clock that begins again is no time, unless it is named.
        let again = b"time,displacement,force\n1,2,3\n1,4,5\n";
        assert_eq!(read_loop(again, &LoopHints::default()).unwrap().time, None);
        let hints = LoopHints { time: Some("time".to_owned()), ..LoopHints::default() };
        assert_eq!(read_loop(again, &hints).unwrap().time, Some(vec![1.0, 1.0]));
    }

    #[test]
    fn a_load_that_is_not_constant_is_said_and_not_used() {
        let file = read_loop(b"displacement,force,load\n1,2,3\n2,3,6\n", &LoopHints::default()).unwrap();
        assert_eq!(file.load, None);
        assert!(file.preview.reading.last().unwrap().contains("not constant"), "{:?}", file.preview.reading);
    }

    #[test]
    fn a_column_that_is_not_there_is_named_with_those_that_are() {
        for (text, said) in [
            ("a;b;c\n1;2;3\n", "there is no column `displacement` among 3 columns with a, b, c"),
            ("1;2;3\n", "no column `displacement` among 3 columns with no names"),
        ] {
            let error = read_loop(text.as_bytes(), &LoopHints::default()).unwrap_err().to_string();
            assert!(error.contains(said), "{error}");
        }
        assert_eq!(read_loop(b"1;2\n3;4\n", &LoopHints::default()).unwrap().force, [2.0, 4.0]);
    }
}
