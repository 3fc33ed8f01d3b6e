//! A loop in a file: displacement and force, and perhaps the time and the load.

use super::clock::{self, Format, Times};
use super::error::{Candidate, ImportError};
use super::label::Mention;
use super::labview::{self, Clock};
use super::mapping::{Mapping, Origin};
use super::preview::{ColumnUnit, Preview, said_of};
use super::roles::{self, Role, Roles};
use super::sheet::Sheet;
use super::source::Source;
use super::units::{Dimension, Force, Length};

/// How much a load may differ from its mean and still be constant, as a part of it.
const CONSTANT: f64 = 0.05;
/// Days since 1899 or year zero of dates between 1970 and 2100, as spreadsheets and MATLAB write dates.
const DAYS: [std::ops::Range<f64>; 2] = [25_569.0..73_050.0, 719_529.0..767_009.0];
/// Stamps of computers: from 2001 on to 2100 in s since 1970, and the unit of those a thousand times larger.
const STAMPS: std::ops::Range<f64> = 1e9..4.2e9;
const FASTER: [(&str, f64); 3] = [("ms", 1e3), ("us", 1e6), ("ns", 1e9)];

/// What was read from a file.
#[derive(Clone, Debug, PartialEq)]
pub struct LoopFile {
    /// Displacements.
    pub displacement: Vec<f64>,
    /// Tangential forces, as many.
    pub force: Vec<f64>,
    /// Times, s, as many, if there is a column of them. They do not fall.
    pub time: Option<Vec<f64>>,
    /// The mean load, N, if there is a column of loads and they are constant, or the client says it.
    pub load: Option<f64>,
    /// The unit of displacements; metres where neither the file nor a mapping names one.
    pub displacement_unit: Length,
    /// The unit of forces; newtons where neither the file nor a mapping names one.
    pub force_unit: Force,
    /// What was taken for what.
    pub preview: Preview,
}

/// Reads a loop from columns of text or of a spreadsheet; a row that lacks one of its numbers is a gap. What `mapping`
/// says precedes what the file says. Work ends as soon as `proceed` says no.
///
/// # Errors
/// [`ImportError`] if the bytes are no such table, if a column is not found, with the names of those that are there, if
/// a unit is not known, or if the file may mean several things, with a mapping for each.
pub fn read_loop(bytes: &[u8], mapping: &Mapping, proceed: &dyn Fn() -> bool) -> Result<LoopFile, ImportError> {
    let sources = Source::all(bytes, mapping.sheet.as_deref())?;
    super::sheets::one_of(&sources, mapping, proceed, |source| of_source(source, mapping, proceed))
}

fn of_source(source: &Source<'_>, mapping: &Mapping, proceed: &dyn Fn() -> bool) -> Result<LoopFile, ImportError> {
    let mut sheet = Sheet::parse(&source.text, source.sheet.is_some(), mapping, proceed)?;
    let ticks = labview::describe(&mut sheet);
    if mapping.origin("displacement").is_none() || mapping.origin("force").is_none() {
        sheet.check_names()?;
    }
    let Roles { displacement, force, time, load } = roles::of(&sheet, mapping)?;
    let mut preview = Preview::of(&sheet, source);
    let zeros = if mapping.number("last_line").is_some() {
        0
    } else {
        let numeric = |column: &usize| !sheet.is_text[*column];
        let used: Vec<usize> =
            [Some(displacement), Some(force), time, load].into_iter().flatten().filter(numeric).collect();
        sheet.leave_out_zeros(&used, time.is_some_and(|time| !sheet.is_text[time]))
    };
    let mut numeric = vec![displacement, force];
    numeric.extend(load);
    numeric.extend(time.filter(|time| !sheet.is_text[*time]));
    let mut found = sheet.numbers(&numeric).map_err(|error| roles::settled(error, mapping))?;
    preview.rows = sheet.len();
    preview.written(&sheet, found.mark);
    if zeros > 0 {
        let next = (sheet.row(sheet.len() - 1) + 1..sheet.kinds.len())
            .find(|line| sheet.kinds[*line] == super::LineKind::Zeros);
        preview.say_zeros(zeros, next.map_or(0, |line| sheet.table.number(line)));
    }
    let mut entries = Vec::new();
    let mut take = |role: Role, column: usize, sheet: &Sheet<'_>, preview: &mut Preview| {
        let needed = role.needed();
        let unit = needed.unit(sheet, column, mapping.unit(role.name()))?;
        preview.take(column, role.name(), &unit);
        let sentence =
            needed.sentence(sheet, column, &format!("The {}", role.name()), &unit, mapping.unit(role.name()));
        preview.reading.push(sentence);
        if unit.is_assumed {
            preview.assumed.push(format!("The unit of {} is {}: nothing names another one.", role.name(), unit.text));
        }
        entries.push(format!("{}:{}:{}", role.name(), column + 1, unit.text));
        Ok::<ColumnUnit, ImportError>(unit)
    };
    let u_unit = take(Role::Displacement, displacement, &sheet, &mut preview)?;
    let f_unit = take(Role::Force, force, &sheet, &mut preview)?;
    let index = |column: usize| numeric.iter().position(|one| *one == column);
    let times = match time {
        Some(column) => {
            let numbers = index(column).map(|index| std::mem::take(&mut found.columns[index]));
            times(&sheet, column, numbers, mapping, &mut preview, &mut entries)?
        }
        None => {
            let of =
                |Clock { start, step }: Clock| (0..sheet.len()).map(|row| Some(start + step * row as f64)).collect();
            let ticks = ticks.filter(|_| mapping.origin("time").is_none());
            preview
                .reading
                .extend(ticks.map(|Clock { step, .. }| format!("The rows are {step} s apart, by the header.")));
            entries.extend(ticks.is_none().then(|| "time:none".to_owned()));
            ticks.map(of)
        }
    };
    let loads = load.and_then(index).map_or_else(Vec::new, |index| std::mem::take(&mut found.columns[index]));
    let mut file = LoopFile {
        displacement: Vec::new(),
        force: Vec::new(),
        time: times.as_ref().map(|_| Vec::new()),
        load: None,
        displacement_unit: Length::nearest(u_unit.unit),
        force_unit: Force::nearest(f_unit.unit),
        preview: Preview::default(),
    };
    let (length_unit, in_force_unit) = (file.displacement_unit.unit(), file.force_unit.unit());
    let mut gaps = Vec::new();
    let mut kept = Vec::new();
    for row in 0..sheet.len() {
        let at = times.as_ref().map_or(Some(0.0), |times| times[row]);
        let (Some(u), Some(f), Some(at)) = (found.columns[0][row], found.columns[1][row], at) else {
            if found.remarks.binary_search(&sheet.line(row)).is_err() {
                gaps.push(sheet.line(row));
            }
            continue;
        };
        file.displacement.push(u_unit.unit.convert(u, length_unit));
        file.force.push(f_unit.unit.convert(f, in_force_unit));
        file.time.iter_mut().for_each(|times| times.push(at));
        kept.extend(loads.get(row).copied().flatten());
    }
    if file.displacement.is_empty() {
        return Err(empty(&sheet, source, &[displacement, force], &found.columns));
    }
    preview.leave_out_rows(&found.remarks, "they hold texts in place of numbers");
    let lack = if gaps.len() == 1 { "it lacks a number and is a gap" } else { "they lack a number and are gaps" };
    preview.leave_out_rows(&gaps, lack);
    match (load, mapping.origin("load")) {
        (Some(column), _) => file.load = of_loads(&sheet, column, mapping, &kept, &mut preview, &mut entries)?,
        (None, Some(Origin::Value(load))) => {
            file.load = Some(*load);
            preview.reading.push(format!("The load is {load} N, as asked for."));
            entries.push(format!("load:{load:e} N"));
        }
        _ => entries.push("load:none".to_owned()),
    }
    for column in 0..sheet.width {
        if preview.columns.get(column).is_some_and(|used| used.quantity.is_none() && used.left_out.is_none()) {
            preview.leave_out(column, reason(&sheet, column));
        }
    }
    preview.account(&sheet, source, entries);
    file.preview = preview;
    Ok(file)
}

/// Why no row has both numbers.
fn empty(sheet: &Sheet<'_>, source: &Source<'_>, used: &[usize], found: &[Vec<Option<f64>>]) -> ImportError {
    let lacking = used.iter().zip(found).find(|(_, numbers)| numbers.iter().all(Option::is_none));
    let Some((column, _)) = lacking else {
        return ImportError::of_file("no row has both a displacement and a force: choose other columns in `mapping`");
    };
    let fault = if source.has_bare_formulas {
        "has formulas whose values are not stored: open the file in a spreadsheet program and save it, or export CSV"
    } else {
        "has no numbers: choose another column in `mapping`"
    };
    ImportError {
        column: Some(column + 1),
        line: Some(sheet.line(0)),
        ..ImportError::of_file(format!("{} {fault}", sheet.title(*column)))
    }
}

/// The times of the rows, s, of a column of numbers or dates, if they do not fall.
fn times(
    sheet: &Sheet<'_>,
    column: usize,
    numbers: Option<Vec<Option<f64>>>,
    mapping: &Mapping,
    preview: &mut Preview,
    entries: &mut Vec<String>,
) -> Result<Option<Vec<Option<f64>>>, ImportError> {
    let is_wanted = matches!(mapping.origin("time"), Some(Origin::Column(_)));
    let title = sheet.title(column);
    let said = mapping.format.as_deref();
    let candidates = |units: &[String]| {
        let of = |unit: &String| Candidate {
            quantity: "time",
            column: Some(column + 1),
            name: unit.clone(),
            values: sheet.first_values(column),
            mapping: roles::base(mapping, entries, &format!("time:{}:{unit}", column + 1)),
        };
        units.iter().map(of).collect::<Vec<_>>()
    };
    let (times, unit, sentence, text) = if let Some(numbers) = numbers {
        let unit = match unit_of_stamps(sheet, column, &numbers, mapping) {
            Ok(unit) => unit?,
            Err(units) => {
                let fault = format!(
                    "{title} (column {}) may be in {}: say which in `mapping`",
                    column + 1,
                    units.join(" or in ")
                );
                return Err(ImportError::ambiguous(fault, candidates(&units)));
            }
        };
        let first = numbers.iter().flatten().next().copied().unwrap_or(0.0);
        // Of stamps the differences count, and of those alone so many digits are there.
        let from = if first.abs() > 20_000.0 && unit.unit.to_si(first).abs() > STAMPS.start { first } else { 0.0 };
        let times = numbers.into_iter().map(|time| time.map(|time| unit.unit.to_si(time - from)));
        let times: Vec<_> =
            times.map(|time| time.map(|time| if from > 0.0 { (time * 1e6).round() / 1e6 } else { time })).collect();
        let sentence = Role::Time.needed().sentence(sheet, column, "The time", &unit, mapping.unit("time"));
        let text = unit.text.clone();
        (times, unit, sentence, text)
    } else {
        let head = match &sheet.labels[column].unit {
            Mention::Unknown(text) | Mention::Known(_, text) => Format::parse(text),
            Mention::Absent => {
                Format::parse(&sheet.labels[column].text).filter(|_| sheet.labels[column].text.contains(':'))
            }
        };
        let format = match said {
            Some(words) => Some(Format::parse(words).ok_or_else(|| {
                ImportError::of_file(format!(
                    "`{words:.40}` is no unit of time and no format such as `mm:ss` or `dd/mm/yyyy`"
                ))
            })?),
            None => head,
        };
        let (times, format) = match clock::seconds(sheet.texts(column).collect::<Vec<_>>().into_iter(), format) {
            Times::Read(times, format) => (times, format),
            Times::Several(formats) => {
                let words: Vec<String> = formats.into_iter().map(Format::words).collect();
                let shown = sheet.first_values(column).join("`, `");
                let fault = format!(
                    "{title} (column {}: `{shown}`) may be {}: say which in `mapping`",
                    column + 1,
                    words.join(" or ")
                );
                return Err(ImportError::ambiguous(fault, candidates(&words)));
            }
            Times::None if is_wanted => {
                return Err(ImportError::of_file(format!("{title} is neither a number nor a date in a known format")));
            }
            Times::None => {
                preview.leave_out(column, "dates that are not understood");
                preview
                    .reading
                    .push(format!("{title} is the time, and not used, because its dates are not understood."));
                entries.push("time:none".to_owned());
                return Ok(None);
            }
        };
        let unit = ColumnUnit { is_assumed: false, ..Role::Time.needed().beside(None) };
        let sentence =
            format!("The time is {title}, dates and times of day ({}), in s from the first.", format.words());
        (times, unit, sentence, format.words())
    };
    if is_rising(&times) || is_wanted {
        if unit.is_assumed {
            preview.assumed.push("The unit of time is s: nothing names another one.".to_owned());
        }
        preview.take(column, "time", &unit);
        preview.reading.push(sentence);
        entries.push(format!("time:{}:{text}", column + 1));
        return Ok(Some(times));
    }
    if let Some(row) = restart(sheet, &times).filter(|_| mapping.origin("time").is_none()) {
        let last = sheet.len() - 1;
        let part = |begin: usize, end: usize| {
            let lines = format!("first_line:{};last_line:{}", sheet.line(begin), sheet.line(end));
            let values = vec![format!("lines {} to {}", sheet.line(begin), sheet.line(end))];
            let mapping = roles::base(mapping, entries, &lines);
            Candidate { quantity: "table", column: None, name: format!("{} rows", end + 1 - begin), values, mapping }
        };
        let all = Candidate {
            name: "all rows, without times".to_owned(),
            mapping: roles::base(mapping, entries, "time:none"),
            ..part(0, last)
        };
        let fault =
            format!("behind a blank line, at line {}, the time begins again: it may be another table", sheet.line(row));
        return Err(ImportError::ambiguous(fault, vec![part(0, row - 1), part(row, last), all]));
    }
    preview.leave_out(column, "times that do not rise");
    preview.reading.push(format!("{title} is the time, and not used, because it does not rise."));
    entries.push("time:none".to_owned());
    Ok(None)
}

/// The unit of times that are numbers: what is said, or what their size says where nothing is; or the units that their
/// size leaves open.
fn unit_of_stamps(
    sheet: &Sheet<'_>,
    column: usize,
    numbers: &[Option<f64>],
    mapping: &Mapping,
) -> Result<Result<ColumnUnit, ImportError>, Vec<String>> {
    let hint = mapping.unit("time");
    let needed = Role::Time.needed();
    if hint.is_some() || sheet.labels[column].unit != Mention::Absent {
        return Ok(needed.unit(sheet, column, hint));
    }
    let within =
        |range: &std::ops::Range<f64>, scale: f64| numbers.iter().flatten().all(|time| range.contains(&(time / scale)));
    let unit = |text: &str| Ok(needed.named(text, None, None));
    if DAYS.iter().any(|days| within(days, 1.0)) && numbers.iter().flatten().any(|time| time.fract() > 0.0) {
        let name = sheet.labels[column].name.to_lowercase();
        let is_date = ["date", "datum", "stamp", "fecha", "data", "дата", "日"].iter().any(|word| name.contains(word));
        return if is_date { unit("d") } else { Err(vec!["d".to_owned(), "s".to_owned()]) };
    }
    match FASTER.iter().find(|(_, scale)| within(&STAMPS, *scale)) {
        Some((symbol, _)) => unit(symbol),
        None => Ok(needed.unit(sheet, column, None)),
    }
}

/// The row behind a blank line at which the time falls, and at no other.
fn restart(sheet: &Sheet<'_>, times: &[Option<f64>]) -> Option<usize> {
    let falls = |row: &usize| times[*row - 1].zip(times[*row]).is_some_and(|(one, next)| next < one);
    let mut rows = (1..times.len()).filter(falls);
    let row = rows.next()?;
    let is_blank = sheet.row(row) == sheet.row(row - 1) + 1 && sheet.line(row) > sheet.line(row - 1) + 1;
    (is_blank && rows.next().is_none()).then_some(row)
}

/// Whether times do not fall, and do not stand.
pub(super) fn is_rising(times: &[Option<f64>]) -> bool {
    let (first, last) = (times.iter().flatten().next(), times.iter().flatten().next_back());
    times.iter().flatten().is_sorted() && first < last
}

/// The mean load, N, if the loads are constant. A load that is negative throughout is one in the other direction.
fn of_loads(
    sheet: &Sheet<'_>,
    column: usize,
    mapping: &Mapping,
    loads: &[f64],
    preview: &mut Preview,
    entries: &mut Vec<String>,
) -> Result<Option<f64>, ImportError> {
    let title = sheet.title(column);
    let hint = mapping.unit("load");
    if let (None, Mention::Known(unit, text)) = (hint, &sheet.labels[column].unit)
        && unit.dimension == Dimension::MASS
    {
        let weight = roles::weight(*unit, text);
        let of = |quantity: String, name: &str| Candidate {
            quantity: "load",
            column: Some(column + 1),
            name: name.to_owned(),
            values: sheet.first_values(column),
            mapping: roles::base(mapping, entries, &quantity),
        };
        let candidates = vec![
            of(format!("load:{}:{weight}", column + 1), &format!("the weight, in {weight}")),
            of("load:none".to_owned(), "no load"),
        ];
        let fault = format!(
            "{title} (column {}) is in `{text}`, a mass: say by `load` in `mapping` whether its weight is the load",
            column + 1
        );
        return Err(ImportError {
            line: sheet.head.unit_lines[column],
            column: Some(column + 1),
            ..ImportError::ambiguous(fault, candidates)
        });
    }
    let unit = Role::Load.needed().unit(sheet, column, hint)?;
    let mean = loads.iter().sum::<f64>() / loads.len().max(1) as f64;
    let is_constant = !loads.is_empty() && loads.iter().all(|one| (one - mean).abs() <= CONSTANT * mean.abs());
    let (sentence, left_out) = match (is_constant, mean) {
        _ if loads.is_empty() => ("not used, because all are missing", "loads that are all missing"),
        (true, 0.0) => ("not used, because it is zero", "a load of zero"),
        (true, ..0.0) => ("it is negative throughout, so its magnitude is the load", ""),
        (true, _) => ("its mean is the load", ""),
        (false, _) => ("not used, because it is not constant", "a load that is not constant"),
    };
    preview.reading.push(format!("{title} is the load, in {}: {sentence}.", unit.text));
    if !left_out.is_empty() {
        preview.leave_out(column, left_out);
        entries.push("load:none".to_owned());
        return Ok(None);
    }
    if unit.is_assumed {
        preview.assumed.push(format!("The unit of the load is {}: nothing names another one.", unit.text));
    }
    preview.take(column, "normal_force", &unit);
    entries.push(format!("load:{}:{}", column + 1, unit.text));
    Ok(Some(unit.unit.to_si(mean.abs())))
}

/// Why a column is left out.
fn reason(sheet: &Sheet<'_>, column: usize) -> String {
    let other = Role::ALL.into_iter().find(|role| roles::rank(*role, sheet, column).is_some());
    if sheet.is_text[column] {
        return "text".to_owned();
    }
    match other {
        Some(role) if role.needed().excludes(&sheet.labels[column].unit) => {
            said_of(&sheet.labels[column].unit).unwrap_or_default()
        }
        Some(role) => format!("another {}: choose it by `{}`", role.name(), role.name()),
        None => roles::meaning_of(sheet, column).reason().to_owned(),
    }
}
