//! A loop in a file: displacement and force, and perhaps the time and the load.

use super::clock;
use super::columns::{Needed, UnitHint};
use super::error::ImportError;
use super::label::Mention;
use super::labview::{self, Clock};
use super::names::{Meaning, meaning};
use super::preview::{ColumnUnit, Preview, said_of};
use super::sheet::Sheet;
use super::source::Source;
use super::units::{Force, Length};

/// How much a load may differ from its mean and still be constant, as a part of it.
const CONSTANT: f64 = 0.05;
/// Names that a refusal lists.
const LISTED: usize = 12;

const DISPLACEMENT: Needed = Needed::length("displacement_unit");
const FORCE: Needed = Needed::force("force_unit");
const TIME: Needed = Needed::time("time_unit");
const LOAD: Needed = Needed::force("load_unit");

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
    pub displacement_unit: Option<UnitHint>,
    /// The unit of forces.
    pub force_unit: Option<UnitHint>,
    /// The unit of times.
    pub time_unit: Option<UnitHint>,
    /// The unit of loads.
    pub load_unit: Option<UnitHint>,
    /// The sheet of a spreadsheet, by its name or its number from 1 on; without it the first with numbers.
    pub sheet: Option<String>,
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
    /// The unit of forces; newtons where neither the file nor a hint names one.
    pub force_unit: Force,
    /// What was taken for what.
    pub preview: Preview,
}

/// Reads a loop from columns of text or of a spreadsheet; a row that lacks one of its numbers is a gap.
///
/// # Errors
/// [`ImportError`] if the bytes are no such table, if a column is not found, with the names of those that are there, or
/// if a unit is not known.
pub fn read_loop(bytes: &[u8], hints: &LoopHints) -> Result<LoopFile, ImportError> {
    let source = Source::of(bytes, hints.sheet.as_deref())?;
    let mut sheet = Sheet::parse(&source.text)?;
    let ticks = labview::describe(&mut sheet);
    sheet.check_names()?;
    let columns = Columns::of(&sheet, hints)?;
    let mut preview = Preview::of(&sheet, &source);
    let displacement = DISPLACEMENT.unit(&sheet, columns.displacement, hints.displacement_unit.as_ref())?;
    let force = FORCE.unit(&sheet, columns.force, hints.force_unit.as_ref())?;
    let mut numeric = vec![columns.displacement, columns.force];
    numeric.extend(columns.load);
    numeric.extend(columns.time.filter(|time| !sheet.is_text[*time]));
    let mut found = sheet.numbers(&numeric)?;
    preview.written(&sheet, found.has_decimal_commas);
    let sentence = |needed: Needed, column: usize, quantity: &str, unit: &ColumnUnit, hint: Option<&UnitHint>| {
        needed.sentence(&sheet, column, &format!("The {quantity}"), unit, hint)
    };
    preview.take(columns.displacement, "displacement", &displacement);
    preview.take(columns.force, "force", &force);
    let hint = hints.displacement_unit.as_ref();
    preview.reading.push(sentence(DISPLACEMENT, columns.displacement, "displacement", &displacement, hint));
    preview.reading.push(sentence(FORCE, columns.force, "force", &force, hints.force_unit.as_ref()));
    let times = times(&sheet, &columns, hints, ticks, &numeric, &mut found.columns, &mut preview)?;
    let loads = columns.load.map_or_else(Vec::new, |_| std::mem::take(&mut found.columns[2]));

    let mut file = LoopFile {
        displacement: Vec::new(),
        force: Vec::new(),
        time: times.as_ref().map(|_| Vec::new()),
        load: None,
        displacement_unit: Length::nearest(displacement.unit),
        force_unit: Force::nearest(force.unit),
        preview: Preview::default(),
    };
    let (length_unit, in_force_unit) = (file.displacement_unit.unit(), file.force_unit.unit());
    let mut gaps = Vec::new();
    let mut kept = Vec::new();
    let remarks = found.remarks;
    for row in 0..sheet.len() {
        let at = times.as_ref().map_or(Some(0.0), |times| times[row]);
        let (Some(u), Some(f), Some(at)) = (found.columns[0][row], found.columns[1][row], at) else {
            if remarks.binary_search(&sheet.line(row)).is_err() {
                gaps.push(sheet.line(row));
            }
            continue;
        };
        file.displacement.push(displacement.unit.convert(u, length_unit));
        file.force.push(force.unit.convert(f, in_force_unit));
        file.time.iter_mut().for_each(|times| times.push(at));
        kept.extend(loads.get(row).copied().flatten());
    }
    preview.leave_out_rows(&remarks, "they hold texts in place of numbers");
    let lack = if gaps.len() == 1 { "it lacks a number and is a gap" } else { "they lack a number and are gaps" };
    preview.leave_out_rows(&gaps, lack);
    if let Some(column) = columns.load {
        file.load = load(&sheet, column, hints, &kept, &mut preview)?;
    }
    for column in 0..sheet.width {
        if preview.columns.get(column).is_some_and(|used| used.quantity.is_none() && used.left_out.is_none()) {
            preview.leave_out(column, reason(&sheet, column));
        }
    }
    preview.reading.extend(source.remark);
    file.preview = preview;
    Ok(file)
}

/// The times of the rows, s: of a column of numbers or dates, or of the ticks of LabVIEW's header.
fn times(
    sheet: &Sheet<'_>,
    columns: &Columns,
    hints: &LoopHints,
    ticks: Option<Clock>,
    numeric: &[usize],
    found: &mut [Vec<Option<f64>>],
    preview: &mut Preview,
) -> Result<Option<Vec<Option<f64>>>, ImportError> {
    let Some(column) = columns.time else {
        let of = |Clock { start, step }: Clock| (0..sheet.len()).map(|row| Some(start + step * row as f64)).collect();
        if let Some(Clock { step, .. }) = ticks {
            preview.reading.push(format!("The rows are {step} s apart, by the header."));
        }
        return Ok(ticks.map(of));
    };
    let is_wanted = hints.time.is_some();
    let title = sheet.title(column);
    let (times, unit, sentence) = if let Some(index) = numeric.iter().position(|one| *one == column) {
        let unit = TIME.unit(sheet, column, hints.time_unit.as_ref())?;
        let times = std::mem::take(&mut found[index]);
        let times: Vec<_> = times.into_iter().map(|time| time.map(|time| unit.unit.to_si(time))).collect();
        let sentence = TIME.sentence(sheet, column, "The time", &unit, hints.time_unit.as_ref());
        (times, unit, sentence)
    } else {
        let Some(times) = clock::seconds(sheet.texts(column)) else {
            if is_wanted {
                return Err(ImportError::of_file(format!("{title} is neither a number nor a date in a known format")));
            }
            preview.leave_out(column, "dates that are not understood, or that can be read in two ways");
            return Ok(None);
        };
        let unit = ColumnUnit { is_assumed: false, ..TIME.beside(None) };
        (times, unit, format!("The time is {title}, dates and times of day, in s from the first."))
    };
    if is_rising(&times) || is_wanted {
        preview.take(column, "time", &unit);
        preview.reading.push(sentence);
        return Ok(Some(times));
    }
    preview.leave_out(column, "times that do not rise");
    preview.reading.push(format!("{title} is the time, and not used, because it does not rise."));
    Ok(None)
}

fn is_rising(times: &[Option<f64>]) -> bool {
    times.iter().flatten().is_sorted_by(|one, next| one < next)
}

/// The mean load, N, if the loads are constant. A load that is negative throughout is one in the other direction.
fn load(
    sheet: &Sheet<'_>,
    column: usize,
    hints: &LoopHints,
    loads: &[f64],
    preview: &mut Preview,
) -> Result<Option<f64>, ImportError> {
    let unit = LOAD.unit(sheet, column, hints.load_unit.as_ref())?;
    let title = sheet.title(column);
    if loads.is_empty() {
        preview.leave_out(column, "loads that are all missing");
        return Ok(None);
    }
    let mean = loads.iter().sum::<f64>() / loads.len() as f64;
    let is_constant = loads.iter().all(|one| (one - mean).abs() <= CONSTANT * mean.abs());
    let sentence = match (is_constant, mean) {
        (true, 0.0) => "not used, because it is zero",
        (true, ..0.0) => "it is negative throughout, so its magnitude is the load",
        (true, _) => "its mean is the load",
        (false, _) => "not used, because it is not constant",
    };
    preview.reading.push(format!("{title} is the load, in {}: {sentence}.", unit.text));
    let load = Some(unit.unit.to_si(mean.abs())).filter(|load| is_constant && *load > 0.0);
    match load {
        Some(_) => preview.take(column, "normal_force", &unit),
        None => preview.leave_out(column, if is_constant { "a load of zero" } else { "a load that is not constant" }),
    }
    Ok(load)
}

/// Why a column is left out.
fn reason(sheet: &Sheet<'_>, column: usize) -> String {
    let meaning = meaning(&sheet.labels[column].name);
    let other = match meaning {
        Meaning::Displacement(_) => Some((DISPLACEMENT, "another displacement: choose it by `displacement`")),
        Meaning::Force(_) => Some((FORCE, "another force: choose it by `force`")),
        Meaning::Time => Some((TIME, "another time: choose it by `time`")),
        Meaning::Load => Some((LOAD, "another load: choose it by `load`")),
        _ => None,
    };
    if sheet.is_text[column] {
        return "text".to_owned();
    }
    match other {
        Some((needed, _)) if needed.excludes(&sheet.labels[column].unit) => {
            said_of(&sheet.labels[column].unit).unwrap_or_default()
        }
        Some((_, reason)) => reason.to_owned(),
        None => meaning.reason().to_owned(),
    }
}

/// Which column is what.
struct Columns {
    displacement: usize,
    force: usize,
    time: Option<usize>,
    load: Option<usize>,
}

impl Columns {
    fn of(sheet: &Sheet<'_>, hints: &LoopHints) -> Result<Columns, ImportError> {
        let wanted = |name: &Option<String>| {
            name.as_ref().map(|name| sheet.find(name).ok_or_else(|| no_column(sheet, name))).transpose()
        };
        let (named_displacement, named_force) = (wanted(&hints.displacement)?, wanted(&hints.force)?);
        let (time, load) = (wanted(&hints.time)?, wanted(&hints.load)?);
        let taken: Vec<usize> = [named_displacement, named_force, time, load].into_iter().flatten().collect();
        let by_name = |rank: fn(Meaning) -> Option<u8>, needed: Needed, hint: bool, quantity: &'static str| {
            Candidates { sheet, taken: &taken, rank, needed, has_unit_hint: hint, quantity }
        };
        let mut displacement = named_displacement;
        if displacement.is_none() {
            let hint = hints.displacement_unit.is_some();
            displacement = by_name(displacement_rank, DISPLACEMENT, hint, "displacement").best()?;
        }
        let mut force = named_force;
        if force.is_none() {
            let hint = hints.force_unit.is_some();
            force = by_name(force_rank, FORCE, hint, "force").best()?;
        }
        // Two columns of which names say nothing, or of which one is known.
        let is_open = |column: &usize| {
            !sheet.is_text[*column]
                && meaning_of(sheet, *column) == Meaning::Unknown
                && ![displacement, force].contains(&Some(*column))
                && !taken.contains(column)
        };
        let numeric = sheet.is_text.iter().filter(|is_text| !**is_text).count();
        let mut open = (0..sheet.width).filter(is_open);
        let mut positional = |found: Option<usize>| found.or_else(|| if numeric == 2 { open.next() } else { None });
        let displacement = positional(displacement).ok_or_else(|| no_column(sheet, "displacement"))?;
        let force = positional(force).ok_or_else(|| no_column(sheet, "force"))?;
        let free = |column: &usize| *column != displacement && *column != force;
        let time = match time {
            None => by_name(time_rank, TIME, hints.time_unit.is_some(), "time").first(),
            time => time,
        };
        let load = match load {
            None => by_name(load_rank, LOAD, hints.load_unit.is_some(), "load").first(),
            load => load,
        };
        let load = load.filter(|load| free(load) && !sheet.is_text[*load]);
        Ok(Columns { displacement, force, time: time.filter(free), load })
    }
}

fn displacement_rank(meaning: Meaning) -> Option<u8> {
    if let Meaning::Displacement(rank) = meaning { Some(rank) } else { None }
}

fn force_rank(meaning: Meaning) -> Option<u8> {
    match meaning {
        Meaning::Force(rank) => Some(rank),
        Meaning::Friction => Some(2),
        _ => None,
    }
}

fn time_rank(meaning: Meaning) -> Option<u8> {
    (meaning == Meaning::Time).then_some(0)
}

fn load_rank(meaning: Meaning) -> Option<u8> {
    (meaning == Meaning::Load).then_some(0)
}

/// The meaning of a column; none for one without a name.
fn meaning_of(sheet: &Sheet<'_>, column: usize) -> Meaning {
    let label = &sheet.labels[column];
    let is_nameless = label.name.is_empty() && (label.unit != Mention::Absent || !sheet.has_names());
    if is_nameless { Meaning::Unknown } else { meaning(&label.name) }
}

/// The columns that may be a quantity.
struct Candidates<'a> {
    sheet: &'a Sheet<'a>,
    taken: &'a [usize],
    rank: fn(Meaning) -> Option<u8>,
    needed: Needed,
    has_unit_hint: bool,
    quantity: &'static str,
}

impl Candidates<'_> {
    /// Those with their rank: by name, or by the unit alone.
    fn ranked(&self) -> Vec<(u8, usize)> {
        let free = (0..self.sheet.width).filter(|column| !self.taken.contains(column));
        let named = |column: usize| Some(((self.rank)(meaning_of(self.sheet, column))?, column));
        let named: Vec<_> = free.clone().filter_map(named).collect();
        if !named.is_empty() {
            return named;
        }
        let has_unit = |column: &usize| {
            let unit = &self.sheet.labels[*column].unit;
            let is_unit = matches!(unit, Mention::Known(unit, _) if unit.dimension == self.needed.dimension);
            is_unit && meaning_of(self.sheet, *column) == Meaning::Unknown
        };
        free.filter(has_unit).map(|column| (0, column)).collect()
    }

    fn fits(&self, column: usize) -> bool {
        self.has_unit_hint || !self.needed.excludes(&self.sheet.labels[column].unit)
    }

    /// The first of those that fit: one with its unit, or with numbers, or with dates that rise.
    fn first(&self) -> Option<usize> {
        let ranked = self.ranked();
        let mut fitting = ranked.iter().map(|(_, column)| *column).filter(|column| self.fits(*column));
        let known = fitting.clone().find(|column| matches!(self.sheet.labels[*column].unit, Mention::Known(..)));
        let numeric = fitting.clone().find(|column| !self.sheet.is_text[*column]);
        let rises = |column: &usize| {
            let seconds = clock::seconds(self.sheet.texts(*column)).unwrap_or_default();
            !seconds.is_empty() && is_rising(&seconds)
        };
        known.or(numeric).or_else(|| fitting.clone().find(rises)).or_else(|| fitting.next())
    }

    /// The one that fits best.
    ///
    /// # Errors
    /// [`ImportError`] if two fit equally, if none has a unit of the quantity, or if it may be a coefficient.
    fn best(&self) -> Result<Option<usize>, ImportError> {
        let mut ranked = self.ranked();
        ranked.retain(|(_, column)| !self.sheet.is_text[*column]);
        ranked.sort_unstable();
        let fitting: Vec<_> = ranked.iter().filter(|(_, column)| self.fits(*column)).collect();
        let Some((rank, column)) = fitting.first() else {
            return match ranked.first() {
                // Its unit is the fault.
                Some((_, column)) => self.needed.unit(self.sheet, *column, None).map(|_| Some(*column)),
                None => Ok(None),
            };
        };
        let sheet = self.sheet;
        let quantity = self.quantity;
        if let Some((_, other)) = fitting.get(1).filter(|(other, _)| other == rank) {
            return Err(ImportError::of_file(format!(
                "{} (column {}) and {} (column {}) may both be the {quantity}: choose one by `{quantity}`",
                sheet.title(*column),
                column + 1,
                sheet.title(*other),
                other + 1
            )));
        }
        let is_named = self.has_unit_hint || sheet.labels[*column].unit != Mention::Absent;
        if meaning_of(sheet, *column) == Meaning::Friction && !is_named {
            let title = sheet.title(*column);
            return Err(ImportError::of_file(format!(
                "{title} (column {}) may be a force or a coefficient: name the unit of the force by `force_unit`",
                column + 1
            )));
        }
        Ok(Some(*column))
    }
}

fn no_column(sheet: &Sheet<'_>, name: &str) -> ImportError {
    let names = if sheet.has_names() {
        let names: Vec<&str> = (0..sheet.width).map(|column| sheet.name(column).unwrap_or("")).collect();
        let more = if names.len() > LISTED { ", …" } else { "" };
        names[..names.len().min(LISTED)].join(", ").to_lowercase() + more
    } else {
        "no names".to_owned()
    };
    let name: String = name.chars().take(40).collect();
    let advice = if ["displacement", "force"].contains(&name.as_str()) {
        format!(": choose it by `{name}`, with its name or number")
    } else {
        String::new()
    };
    ImportError::of_file(format!("there is no column `{name}` among {} columns with {names}{advice}", sheet.width))
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
                file.preview.reading.iter().any(|sentence| sentence.contains("lacks a number and is a gap")),
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
        let uses: Vec<_> =
            file.preview.columns.iter().map(|column| (column.quantity, column.unit.as_deref())).collect();
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
    fn remains_of_a_unit_are_refused_where_the_column_is_used() {
        for (header, text) in [
            ("Displacement ( m);Force (N)", " m"),
            ("Displacement_in;Force (N)", "in"),
            ("x (um);FORCE (MN)", "FORCE (MN)"),
        ] {
            let error = read_loop(format!("{header}\n1;2\n3;4\n").as_bytes(), &LoopHints::default()).unwrap_err();
            assert_eq!(error.unknown_unit.as_deref(), Some(text), "{error}");
        }
        let found = read_loop(b"Displacement (um);Force (N);Load (?N)\n1;2;3\n3;4;3\n", &LoopHints::default());
        assert_eq!(found.unwrap_err().column, Some(3));
    }

    #[test]
    fn the_time_is_the_column_of_dates_and_times_that_rises() {
        let text = "Date;Time;x;F\n2026-06-01;10:00:00;1;2\n2026-06-01;10:00:01.5;3;4\n";
        assert_eq!(read_loop(text.as_bytes(), &LoopHints::default()).unwrap().time, Some(vec![0.0, 1.5]));
    }

    #[test]
    fn a_column_that_is_not_there_is_named_with_those_that_are() {
        for (text, sentence) in [
            ("a;b;c\n1;2;3\n", "there is no column `displacement` among 3 columns with a, b, c"),
            ("1;2;3\n", "no column `displacement` among 3 columns with no names"),
        ] {
            let error = read_loop(text.as_bytes(), &LoopHints::default()).unwrap_err().to_string();
            assert!(error.contains(sentence), "{error}");
        }
        assert_eq!(read_loop(b"1;2\n3;4\n", &LoopHints::default()).unwrap().force, [2.0, 4.0]);
    }
}
