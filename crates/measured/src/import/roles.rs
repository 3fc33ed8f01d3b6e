//! Which column of a loop is which quantity: what the client says, or the one that its unit and name make it.

use super::clock::{self, Times};
use super::columns::Needed;
use super::error::{Candidate, ImportError};
use super::label::Mention;
use super::loops::is_rising;
use super::mapping::{Mapping, Origin};
use super::names::{Meaning, meaning};
use super::sheet::Sheet;
use super::units::{Dimension, Unit};

/// Names that a refusal lists.
const LISTED: usize = 12;

/// A quantity of a loop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Role {
    Displacement,
    Force,
    Time,
    Load,
}

impl Role {
    pub(super) const ALL: [Role; 4] = [Role::Displacement, Role::Force, Role::Time, Role::Load];

    /// Its name in a mapping.
    pub(super) fn name(self) -> &'static str {
        match self {
            Role::Displacement => "displacement",
            Role::Force => "force",
            Role::Time => "time",
            Role::Load => "load",
        }
    }

    pub(super) fn needed(self) -> Needed {
        match self {
            Role::Displacement => Needed::length("displacement_unit"),
            Role::Force => Needed::force("force_unit"),
            Role::Time => Needed::time("time_unit"),
            Role::Load => Needed::force("load_unit"),
        }
    }
}

/// The column of each quantity.
pub(super) struct Roles {
    pub(super) displacement: usize,
    pub(super) force: usize,
    pub(super) time: Option<usize>,
    pub(super) load: Option<usize>,
}

/// The columns that may be a quantity, the one that is first.
type Found = Vec<usize>;

/// The column of each quantity.
///
/// # Errors
/// [`ImportError`] if one is not found, or if two columns fit equally: then with a mapping for each.
pub(super) fn of(sheet: &Sheet<'_>, mapping: &Mapping) -> Result<Roles, ImportError> {
    let said = |role: Role| match mapping.origin(role.name()) {
        Some(Origin::Column(name)) => sheet.find_column(name).map(Some).ok_or_else(|| no_column(sheet, name)),
        _ => Ok(None),
    };
    let said: Vec<Option<usize>> = Role::ALL.into_iter().map(said).collect::<Result<_, _>>()?;
    let mut found: Vec<Found> = Vec::new();
    for (role, own) in Role::ALL.into_iter().zip(&said) {
        let is_settled = matches!(mapping.origin(role.name()), Some(Origin::Nothing | Origin::Value(_)));
        let alone = found.iter().filter(|columns| columns.len() == 1).map(|columns| Some(columns[0]));
        let taken: Vec<Option<usize>> = said.iter().copied().chain(alone).collect();
        let columns = match own {
            Some(column) => vec![*column],
            None if is_settled => Vec::new(),
            None => candidates(sheet, role, mapping, &taken)?,
        };
        found.push(columns);
    }
    by_place(sheet, &said, &mut found);
    for (index, role) in Role::ALL.into_iter().enumerate() {
        if found[index].len() > 1 {
            return Err(ambiguous(sheet, mapping, role, &found));
        }
    }
    let one = |role: Role| found[role as usize].first().copied();
    let missing = |role: Role| no_column(sheet, role.name());
    let displacement = one(Role::Displacement).ok_or_else(|| missing(Role::Displacement))?;
    let force = one(Role::Force).ok_or_else(|| missing(Role::Force))?;
    if displacement == force {
        return Err(ImportError::of_file("displacement and force are the same column: choose two in `mapping`"));
    }
    let free = |column: &usize| *column != displacement && *column != force;
    let load = one(Role::Load).filter(free).filter(|load| !sheet.is_text[*load]);
    check_coefficient(sheet, mapping, force)?;
    Ok(Roles { displacement, force, time: one(Role::Time).filter(free), load })
}

/// Two columns of which names say nothing, or of which one is known.
fn by_place(sheet: &Sheet<'_>, said: &[Option<usize>], found: &mut [Found]) {
    if sheet.is_text.iter().filter(|is_text| !**is_text).count() != 2 {
        return;
    }
    let taken: Vec<usize> = found.iter().flatten().copied().chain(said.iter().flatten().copied()).collect();
    let is_open = |column: &usize| {
        !sheet.is_text[*column] && meaning_of(sheet, *column) == Meaning::Unknown && !taken.contains(column)
    };
    let mut open = (0..sheet.width).filter(is_open);
    for columns in &mut found[..2] {
        if columns.is_empty() {
            columns.extend(open.next());
        }
    }
}

/// The meaning of a column; none for one without a name.
pub(super) fn meaning_of(sheet: &Sheet<'_>, column: usize) -> Meaning {
    let label = &sheet.labels[column];
    let is_nameless = label.name.is_empty() && (label.unit != Mention::Absent || !sheet.has_names());
    if is_nameless { Meaning::Unknown } else { meaning(&label.name) }
}

/// How well a column fits a quantity by its name, the best first.
pub(super) fn rank(role: Role, sheet: &Sheet<'_>, column: usize) -> Option<u8> {
    match (role, meaning_of(sheet, column)) {
        (Role::Displacement, Meaning::Displacement(rank)) | (Role::Force, Meaning::Force(rank)) => Some(rank),
        (Role::Force, Meaning::Friction) => Some(2),
        (Role::Time, Meaning::Time) | (Role::Load, Meaning::Load) => Some(0),
        // A cell that measures no tangential force may carry the load.
        (Role::Load, Meaning::Force(3)) if sheet.labels[column].name.to_lowercase().contains("cell") => Some(0),
        _ => None,
    }
}

/// The columns that fit a quantity equally, and better than others.
fn candidates(sheet: &Sheet<'_>, role: Role, mapping: &Mapping, taken: &[Option<usize>]) -> Result<Found, ImportError> {
    let needed = role.needed();
    let has_hint = mapping.unit(role.name()).is_some();
    let unit = |column: usize| &sheet.labels[column].unit;
    let is_mass = |column: usize| matches!(unit(column), Mention::Known(unit, _) if unit.dimension == Dimension::MASS);
    let is_usable = |column: usize| !sheet.is_text[column] || role == Role::Time;
    let free = (0..sheet.width).filter(|column| !taken.contains(&Some(*column)) && is_usable(*column));
    let named: Vec<(u8, usize)> =
        free.clone().filter_map(|column| Some((rank(role, sheet, column)?, column))).collect();
    let fits = |column: usize| has_hint || !needed.excludes(unit(column)) || role == Role::Load && is_mass(column);
    let mut fitting: Vec<(u8, usize)> = named.iter().copied().filter(|(_, column)| fits(*column)).collect();
    if named.is_empty() && role != Role::Load {
        let is_unit = |column: &usize| {
            matches!(unit(*column), Mention::Known(unit, _) if unit.dimension == needed.dimension)
                && meaning_of(sheet, *column) == Meaning::Unknown
        };
        fitting = free.filter(is_unit).map(|column| (0, column)).collect();
    }
    let Some(best) = fitting.iter().map(|(rank, _)| *rank).min() else {
        // Its unit is the fault, of the one that fits best by its name.
        let nearest = named.iter().min().filter(|_| matches!(role, Role::Displacement | Role::Force));
        return nearest.map_or(Ok(Vec::new()), |(_, column)| needed.unit(sheet, *column, None).map(|_| vec![*column]));
    };
    let columns: Vec<usize> = fitting.into_iter().filter(|(rank, _)| *rank == best).map(|(_, column)| column).collect();
    Ok(if role == Role::Time { one_clock(sheet, columns) } else { columns })
}

/// Of several times the one to take where they say the same: one with its unit, or with numbers, or with dates.
fn one_clock(sheet: &Sheet<'_>, columns: Vec<usize>) -> Found {
    if columns.len() < 2 {
        return columns;
    }
    let texts = |column: usize| sheet.texts(column).collect::<Vec<_>>().into_iter();
    let times = |column: usize| -> Option<Vec<Option<f64>>> {
        if sheet.is_text[column] {
            return match clock::seconds(texts(column), None) {
                Times::Read(seconds, _) => Some(seconds),
                _ => None,
            };
        }
        let unit = if let Mention::Known(unit, _) = &sheet.labels[column].unit { *unit } else { Unit::parse("s")? };
        let read = (0..sheet.len()).map(|row| sheet.table.value(sheet.row(row), column, super::number::Mark::Point));
        let read: Vec<Option<f64>> = read.map(|time| time.map(|time| unit.to_si(time))).collect();
        let first = read.iter().flatten().next().copied()?;
        Some(read.into_iter().map(|time| time.map(|time| time - first)).collect())
    };
    let rising: Vec<(usize, Vec<Option<f64>>)> = columns
        .iter()
        .filter_map(|column| Some((*column, times(*column)?)))
        .filter(|(_, times)| is_rising(times))
        .collect();
    let Some((first, read)) = rising.first() else { return vec![columns[0]] };
    let span = read.iter().flatten().next_back().copied().unwrap_or(0.0);
    let is_same = |other: &[Option<f64>]| {
        let near = |(one, two): (&Option<f64>, &Option<f64>)| {
            one.zip(*two).is_none_or(|(one, two)| (one - two).abs() <= (1e-3 * span).max(1.0).min(0.02 * span + 1e-3))
        };
        read.iter().zip(other).all(near)
    };
    let has_unit = |column: usize| matches!(sheet.labels[column].unit, Mention::Known(..));
    if rising.iter().all(|(_, other)| is_same(other)) {
        let known = rising.iter().find(|(column, _)| has_unit(*column));
        let numeric = || rising.iter().find(|(column, _)| !sheet.is_text[*column]);
        return vec![known.or_else(numeric).map_or(*first, |(column, _)| *column)];
    }
    rising.into_iter().map(|(column, _)| column).collect()
}

/// Refuses a friction without a unit, which may be a coefficient.
fn check_coefficient(sheet: &Sheet<'_>, mapping: &Mapping, force: usize) -> Result<(), ImportError> {
    let is_named = mapping.unit("force").is_some()
        || matches!(mapping.origin("force"), Some(Origin::Column(_)))
        || sheet.labels[force].unit != Mention::Absent;
    if meaning_of(sheet, force) != Meaning::Friction || is_named {
        return Ok(());
    }
    let title = sheet.title(force);
    let fault = format!(
        "{title} (column {}) may be a force or a coefficient: name the unit of the force by `force_unit` or `mapping`",
        force + 1
    );
    let of = |unit: &str| Candidate {
        quantity: "force",
        column: Some(force + 1),
        name: format!("a force in {unit}"),
        values: sheet.first_values(force),
        mapping: base(mapping, &[], &format!("force:{}:{unit}", force + 1)),
    };
    Err(ImportError { column: Some(force + 1), ..ImportError::ambiguous(fault, vec![of("N")]) })
}

/// Several columns for one quantity, each with the mapping that chooses it; where others are open too, those in the
/// same order go together.
fn ambiguous(sheet: &Sheet<'_>, mapping: &Mapping, role: Role, found: &[Found]) -> ImportError {
    let all = &found[role as usize];
    let columns = &all[..all.len().min(LISTED)];
    let titles: Vec<String> =
        columns.iter().map(|column| format!("{} (column {})", sheet.title(*column), column + 1)).collect();
    let both = if titles.len() == 2 { "both" } else { "each" };
    let more = if all.len() > LISTED { format!(" and {} others", all.len() - LISTED) } else { String::new() };
    let titles = titles.join(" and ") + &more;
    let fault = format!("{titles} may {both} be the {}: choose one by `{}`", role.name(), role.name());
    let of = |(index, column): (usize, &usize)| {
        let entry = |(other, columns): (Role, &Found)| {
            let column = if other == role { Some(*column) } else { columns.get(index).or(columns.last()).copied() };
            column.map(|column| entry(sheet, mapping, other, column))
        };
        let entries: Vec<String> = Role::ALL.into_iter().zip(found).filter_map(entry).collect();
        Candidate {
            quantity: role.name(),
            column: Some(column + 1),
            name: sheet.name(*column).unwrap_or("").to_owned(),
            values: sheet.first_values(*column),
            mapping: base(mapping, &entries, ""),
        }
    };
    let mut candidates: Vec<Candidate> = columns.iter().enumerate().map(of).collect();
    if role == Role::Load {
        let without = base(mapping, &[], "load:none");
        let values = vec!["a load that the request has".to_owned()];
        candidates.push(Candidate {
            quantity: "load",
            column: None,
            name: "none".to_owned(),
            values,
            mapping: without,
        });
    }
    ImportError { column: None, ..ImportError::ambiguous(fault, candidates) }
}

/// The entry of a column in a mapping, with its unit as far as it is known.
fn entry(sheet: &Sheet<'_>, mapping: &Mapping, role: Role, column: usize) -> String {
    let unit = match (mapping.unit(role.name()), &sheet.labels[column].unit) {
        (Some(hint), _) => format!(":{}", hint.text),
        (None, Mention::Known(unit, text)) if unit.dimension == role.needed().dimension => format!(":{text}"),
        (None, Mention::Known(unit, text)) if role == Role::Load && unit.dimension == Dimension::MASS => {
            format!(":{}", weight(*unit, text))
        }
        _ => String::new(),
    };
    format!("{}:{}{unit}", role.name(), column + 1)
}

/// The unit of the weight of a mass in this unit.
pub(super) fn weight(unit: Unit, text: &str) -> String {
    let is = |symbol: &str| Unit::parse(symbol) == Some(unit);
    let known = [("kg", "kgf"), ("g", "gf"), ("lb", "lbf"), ("oz", "ozf")].into_iter().find(|(mass, _)| is(mass));
    known.map_or_else(|| format!("{text}*9.80665 m/s^2"), |(_, weight)| weight.to_owned())
}

/// A mapping with what the client has said of the file, and these entries.
pub(super) fn base(mapping: &Mapping, entries: &[String], more: &str) -> String {
    let mut all: Vec<String> = entries.to_vec();
    let name = |entry: &str| entry.split(':').next().unwrap_or("").to_owned();
    all.retain(|entry| name(entry) != name(more));
    for said in mapping.entries() {
        if name(&said) != name(more) && all.iter().all(|entry| name(entry) != name(&said)) {
            all.push(said);
        }
    }
    all.extend((!more.is_empty()).then(|| more.to_owned()));
    all.join(";")
}

/// An error with candidates of which each mapping has also what the client has said.
pub(super) fn settled(mut error: ImportError, mapping: &Mapping) -> ImportError {
    for candidate in &mut error.candidates {
        candidate.mapping = base(mapping, &[], &candidate.mapping);
    }
    error
}

pub(super) fn no_column(sheet: &Sheet<'_>, name: &str) -> ImportError {
    let names = if sheet.has_names() {
        let names: Vec<&str> = (0..sheet.width).map(|column| sheet.name(column).unwrap_or("")).collect();
        let more = if names.len() > LISTED { ", …" } else { "" };
        names[..names.len().min(LISTED)].join(", ").to_lowercase() + more
    } else {
        "no names".to_owned()
    };
    let name: String = name.chars().take(40).collect();
    let advice = if ["displacement", "force"].contains(&name.as_str()) {
        format!(": choose it by `{name}`, with its name or number, as in `mapping={name}:2`")
    } else {
        String::new()
    };
    ImportError::of_file(format!("there is no column `{name}` among {} columns with {names}{advice}", sheet.width))
}
