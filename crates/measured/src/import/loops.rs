//! A loop in a file: displacement and force, and perhaps the time and the load.

use super::encoding::decode;
use super::sheet::{ImportError, Sheet};
use super::units::{Force, Length};

/// How much a load may differ from its mean and still be constant, as a part of it.
const CONSTANT: f64 = 0.05;

/// A column by its number from 1 on, or by its name in the header, of which the beginning is enough.
pub type ColumnName = String;

/// What is known of a loop beside its file. It precedes what the file says.
#[derive(Clone, Debug, Default)]
pub struct LoopHints {
    /// The column of displacements; without it the one that is called so.
    pub displacement: Option<ColumnName>,
    /// The column of forces.
    pub force: Option<ColumnName>,
    /// The column of times.
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
    /// Times, as many, if there is a column of them.
    pub time: Option<Vec<f64>>,
    /// The mean load, N, if there is a column of loads and they are constant.
    pub load: Option<f64>,
    /// The unit of displacements; metres where neither the file nor a hint names one.
    pub displacement_unit: Length,
    /// The unit of forces; newtons likewise.
    pub force_unit: Force,
    /// What was taken for what, a sentence each.
    pub reading: Vec<String>,
}

/// Reads a loop from columns of text; a row that lacks one of its numbers is a gap.
///
/// # Errors
/// [`ImportError`] if the bytes are no such table, or if a column is not found, with the names of those that are there.
pub fn read_loop(bytes: &[u8], hints: &LoopHints) -> Result<LoopFile, ImportError> {
    let (text, encoding) = decode(bytes);
    let sheet = Sheet::parse(&text)?;
    let is_nameless = sheet.width() == 2 && find(&sheet, "force").is_none();
    let (displacement, force) = match (&hints.displacement, &hints.force) {
        (None, None) if is_nameless => (0, 1),
        (displacement, force) => (
            column(&sheet, displacement.as_deref().unwrap_or("displacement"))?,
            column(&sheet, force.as_deref().unwrap_or("force"))?,
        ),
    };
    let time = hints.time.as_deref().map(|name| column(&sheet, name)).transpose()?;
    let load = match &hints.load {
        Some(name) => Some(column(&sheet, name)?),
        None => ["normal", "load", "fn", "fz"].iter().find_map(|name| find(&sheet, name)).filter(|one| *one != force),
    };
    let mut file = LoopFile {
        displacement: Vec::new(),
        force: Vec::new(),
        time: time.map(|_| Vec::new()),
        load: None,
        displacement_unit: hints.displacement_unit.or(sheet.unit(displacement, Length::named)).unwrap_or(Length::Metre),
        force_unit: hints.force_unit.or(sheet.unit(force, Force::named)).unwrap_or(Force::Newton),
        reading: vec![format!("{encoding}, {}.", sheet.format())],
    };
    let mut loads = Vec::new();
    for row in &sheet.rows {
        let at = time.map_or(Some(0.0), |time| row[time]);
        let (Some(u), Some(f), Some(at)) = (row[displacement], row[force], at) else { continue };
        file.displacement.push(u);
        file.force.push(f);
        file.time.iter_mut().for_each(|times| times.push(at));
        loads.extend(load.and_then(|load| row[load]));
    }
    let gaps = sheet.rows.len() - file.displacement.len();
    let title =
        |index: usize| sheet.name(index).map_or_else(|| format!("column {}", index + 1), |name| format!("`{name}`"));
    let said = |what: &str, index: usize, unit: &str| format!("The {what} is {}, in {unit}.", title(index));
    file.reading.push(said("displacement", displacement, file.displacement_unit.symbol()));
    file.reading.push(said("force", force, file.force_unit.symbol()));
    file.reading.extend(time.map(|time| said("time", time, "s")));
    if let Some(index) = load.filter(|_| !loads.is_empty()) {
        let unit = sheet.unit(index, Force::named).unwrap_or(Force::Newton);
        let mean = loads.iter().sum::<f64>() / loads.len() as f64;
        let is_constant = loads.iter().all(|one| (one - mean).abs() <= CONSTANT * mean.abs());
        file.load = Some(mean * unit.factor()).filter(|load| is_constant && *load > 0.0);
        let kept = if file.load.is_some() { "its mean is the load" } else { "not used, because it is not constant" };
        file.reading.push(format!("{} is the load, in {}: {kept}.", title(index), unit.symbol()));
    }
    if gaps > 0 {
        file.reading.push(format!("{gaps} rows lack a number and are gaps."));
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

fn column(sheet: &Sheet, name: &str) -> Result<usize, ImportError> {
    find(sheet, name).ok_or_else(|| {
        let names = sheet.names().next().map_or("no names".to_owned(), |names| names.join(", ").to_lowercase());
        ImportError::of_file(format!("there is no column `{name}` among {} columns with {names}", sheet.width()))
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
            assert!(file.reading.iter().any(|said| said.contains("1 rows lack a number")), "{:?}", file.reading);
        }
    }

    #[test]
    fn a_load_that_is_not_constant_is_said_and_not_used() {
        let file = read_loop(b"displacement,force,load\n1,2,3\n2,3,6\n", &LoopHints::default()).unwrap();
        assert_eq!(file.load, None);
        assert!(file.reading.last().unwrap().contains("not constant"), "{:?}", file.reading);
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
